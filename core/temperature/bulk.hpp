// Bulk temperature of bodies in a run: each is one mass that the heat of its contacts warms and the
// air cools (report DOT/FRA/ORD-24/18, section 3.1.1, names both flows):
//   C dT/dt = F + G (T_other - T) - H (T - T_air),
// C = mass c, H the conductance to the air, F the body's part of the heat of friction, G what the
// contact lets through by a difference of bulk temperatures (thermal_pair). F and G are held over
// a step, by which the solution of the pair is exact: exponentials towards the balance.
#pragma once

namespace railpatch {

struct bulk_setup {
  double capacity[2] = {0, 0};     // J/K, wheel and rail; 0: the temperature stays what it is
  double conductance[2] = {0, 0};  // W/K
  double air = 0;                  // degrees C
  double start[2] = {0, 0};        // degrees C
  bool stores(int body) const { return capacity[body] > 0; }
};

// What the contacts of one wheel do to it and to its rail.
struct bulk_flow {
  double heat[2] = {0, 0};  // W, into each at the temperatures of the step, all told
  double exchange = 0;      // W/K, G: by how much less a body gets for each K that it is warmer
};

// Moves the temperatures of wheel and rail on by `seconds` of a flow that they began with.
void advance_bulk(const bulk_setup &setup, const bulk_flow &flow, double seconds,
                  double (&temperature)[2]);

// Of the wheels of both sides and their rails or rollers.
class bulk_temperatures {
 public:
  // What later steps depend on, plain numbers.
  struct numbers {
    double temperature[2][2];  // degrees C, [side][wheel, rail]
    bulk_flow flow[2];         // of the last step
    double begun;              // 1 after a step: before the first one no time passes
  };
  explicit bulk_temperatures(const bulk_setup &setup);

  const bulk_setup &setup() const { return setup_; }
  void reset();
  // Temperatures that a step begins with, after `seconds` of the last one's flow. They are taken
  // over by keep, so that a step that failed can be made again.
  void begin(double seconds);
  double now(int side, int body) const { return now_[side][body]; }
  // Whether no body that stores heat is colder than bodies can be, or hotter than any steel.
  bool within_range() const;
  void keep(const bulk_flow (&flow)[2]);
  numbers *kept() { return &kept_; }

 private:
  bulk_setup setup_;
  numbers kept_;
  double now_[2][2];
};

}  // namespace railpatch
