// What the material of one patch remembers on the grid: tractions of the last step in shift and
// transient rolling, plastic displacement of the third-body layer, friction coefficient. Only what
// the scene needs is there.
#pragma once

#include <array>

#include "half_space/physics.hpp"
#include "tangential/tangential.hpp"

namespace railpatch {

struct patch_history;

// Tractions of a wheel's last step, in rows of what a patch remembers, as seen from the grid of a
// problem: its element (0, 0) was at offset from that of the first row.
struct past_tractions {
  const patch_history *history;
  int first_row, rows;
  double offset[2];  // m
};

struct patch_history {
  patch_history() = default;
  // steps: the last step's tractions count; law: null for Coulomb friction without plasticity.
  // moves: of wheels, whose grid moves.
  // curved: rows of a curved reference surface, 0: a plane.
  patch_history(int max_count, bool steps, bool moves, const bound_law *law, int curved);
  bool keeps_steps() const { return has_physics && last_px.size() > 0; }
  bool has_law() const { return has_physics && after.size() > 0; }

  bool begun = false;  // a step has been made on this grid; of wheels: tractions are those of one
  // of wheels, whose grid moves: where last_px and last_py lie, false: nowhere
  bool held = false;
  grid last_grid;
  double last_share = 1;
  std::array<double, 3> last_reference{};  // m, without the rail's offset
  aligned_buffer<double> last_px, last_py;
  aligned_buffer<carried_state> last_states;  // the same of a law
  // J/m^2, elastic energy of the tractions on their elements, and of the last step's
  aligned_buffer<double> energy, last_energy;
  // of wheels: creepages, spin, rolling speed (m/s) and way per second along x at the last step's
  // end
  std::array<double, 5> last_rolling{};
  // Pa, of the last step, where the grid stays, and on a curved reference surface
  aligned_buffer<double> last_pressure;
  // of a curved reference surface: inclinations of the last step's rows (rad, track axes), and what
  // the curve and the pressure added to forces and spin moment
  aligned_buffer<double> last_angle;
  std::array<double, 3> bent{}, last_bent{};
  aligned_buffer<carried_state> before, after;
  aligned_buffer<double> plastic_before[2], plastic[2], yield_stress, friction;

  // Begins a step: what the last one left becomes what was before, moved with the material from
  // x + upstream to x. Also where there is no law. pressure: of the last step, where it is kept.
  void begin(const grid &g, double upstream, const double *px, const double *py,
             const double *pressure = nullptr);
  // The same for wheels: keeps the last step's tractions, and what a law carries, while this one is
  // solved, once or often.
  void remember(const grid &g, const std::array<double, 3> &reference, double share,
                const double *px, const double *py);
  // The same of a curved reference surface, after that.
  void remember_curve(const double *pressure, const double *angle);
  // Of wheels, where there is a law: begins what was before with nothing, and adds what the last
  // step of a patch left where each element's material was then.
  void begin_states(const grid &g);
  void add_states(const grid &g, const past_tractions &past);
  // Sets what is carried as no contact leaves it, for elements that then are in contact to differ.
  // goes_on: of the step; else as of fresh material, as in steady rolling.
  void start_from_before(const grid &g, const bound_law &law, bool goes_on);
  // J/m^2 of the step's plastic displacement, in steady rolling over one element; traction p.
  void plastic_work(const grid &g, int direction, const double *px, const double *py,
                    double *work) const;
  // Nothing has happened yet.
  void clear() { begun = held = false; }
  // The tractions are none of a step.
  void clear_now() { begun = false; }
  inelastic_fields fields(bound_law &law, bool goes_on);
  // f(data, bytes) of what later steps depend on besides the tractions, on a grid of count elements
  template <class F>
  void for_each_kept(size_t count, F &&f) {
    visit(*this, count, f);
  }
  template <class F>
  void for_each_kept(size_t count, F &&f) const {
    visit(*this, count, f);
  }
  // all, and what of it is the last step's and the plastic layer's
  size_t bytes() const;
  size_t step_bytes() const {
    return 4 * last_px.bytes() + before.bytes() + last_states.bytes() +
           2 * plastic_before[0].bytes() + last_angle.bytes() + last_pressure.bytes();
  }
  size_t plastic_bytes() const { return 2 * plastic[0].bytes() + yield_stress.bytes(); }

 private:
  template <class History, class F>
  static void visit(History &h, size_t count, F &&f) {
    // carried states are three numbers each
    static_assert(sizeof(carried_state) == 3 * sizeof(double));
    if (h.energy.size()) f(h.energy.data(), count * sizeof(double));
    if (h.has_law()) f(h.after[0].v, count * sizeof(carried_state));
    for (auto &p : h.plastic)
      if (p.size()) f(p.data(), count * sizeof(double));
  }
  void shift_states(const grid &g, double upstream);
};

}  // namespace railpatch
