// Bulk temperature of bodies in a run: each is one mass that the heat of its contacts warms and the
// air cools (report DOT/FRA/ORD-24/18, section 3.1.1, names both flows):
//   C dT/dt = Q - H (T - T_air),  C = mass c, H the conductance to the air.
// Q is held over a step, by which the solution is exact: an exponential towards T_air + Q/H.
#pragma once

namespace railpatch {

struct bulk_setup {
  double capacity[2] = {0, 0};     // J/K, wheel and rail; 0: the temperature stays what it is
  double conductance[2] = {0, 0};  // W/K
  double air = 0;                  // degrees C
  double start[2] = {0, 0};        // degrees C
  bool stores(int body) const { return capacity[body] > 0; }
};

// After `seconds` of the heat flow (W), from a temperature.
double bulk_after(double temperature, double heat, double capacity, double conductance, double air,
                  double seconds);

// Of the wheels of both sides and their rails or rollers.
class bulk_temperatures {
 public:
  // What later steps depend on, plain numbers.
  struct numbers {
    double temperature[2][2];  // degrees C, [side][wheel, rail]
    double heat[2][2];         // W, of the last step
    double begun;              // 1 after a step: before the first one no time passes
  };
  explicit bulk_temperatures(const bulk_setup &setup);

  const bulk_setup &setup() const { return setup_; }
  void reset();
  // Temperatures that a step begins with, after `seconds` of the last one's heat. They are taken
  // over by keep, so that a step that failed can be made again.
  void begin(double seconds);
  double now(int side, int body) const { return now_[side][body]; }
  // Whether no body that stores heat is colder than bodies can be, or hotter than any steel.
  bool within_range() const;
  void keep(const double (&heat)[2][2]);
  numbers *kept() { return &kept_; }

 private:
  bulk_setup setup_;
  numbers kept_;
  double now_[2][2];
};

}  // namespace railpatch
