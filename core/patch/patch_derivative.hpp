// Exact derivatives of one patch's solution: normal problem, then tangential problem
// (normal/normal_derivative.hpp, tangential/tangential_derivative.hpp, or a table's own
// interpolation: fast/table_forces.hpp), then what results from both.
//
// They are those of the active sets as the solution has them: elements in contact, in stick and in
// slip stay so. At a solution where an element is about to change, the derivative is one-sided.
#pragma once

#include <optional>

#include "fast/table_forces.hpp"
#include "fluid/mixed.hpp"
#include "half_space/forces.hpp"
#include "normal/hertz.hpp"
#include "normal/normal_derivative.hpp"
#include "tangential/tangential_derivative.hpp"

namespace railpatch {

struct patch_scene;
struct patch_problem;
struct patch_memory;

// Rates of the friction coefficient, of its scale, and of a liquid's supply.
struct friction_rates {
  double coefficient = 0, scale = 0;
  double water_rate = 0, water_temperature = 0, oil_film = 0;  // m^3/s, K, m
};

// One direction: rates of all that a patch's problem is made of, per unit of a parameter.
struct patch_variation {
  const double *distance = nullptr;      // m, [ny][nx]; null: zero
  const double *row_friction = nullptr;  // -, [ny], factor of each row; null: zero
  // m, of dx, dy and of x0, y0: the centre of element i moves by origin + i size
  double size[2] = {0, 0}, origin[2] = {0, 0};
  const surface_slopes *slopes = nullptr;                // rates of those in the memory; null: zero
  double contact_depth = 0, depth_part = 0;              // m, -
  double part_factor[contact_parts::capacity - 1] = {};  // of problem.parts.factor
  hertz_contact hertz;                                   // with normal = hertz, hertz_rate_of_*
  double normal_force = 0, approach = 0;                 // of the one that is prescribed
  double creepage[2] = {0, 0}, spin_creepage = 0;
  double rolling_speed = 0;
  friction_rates friction;
};

// What follows for the patch's wrench, in the contact frame, and for its result.
struct patch_change {
  patch_wrench wrench{};
  double normal_force = 0, approach = 0;
  double creep_force[2] = {0, 0}, spin_moment = 0;
  double creep_force_value[2] = {0, 0};  // N, of which these are the rates
  double creep_size = 0;                 // N, of the creep force's length
  double max_pressure = 0, contact_area = 0;
  double growth[2] = {0, 0};  // -, of the contact's extent along x and s, relative
  double capacity = 0;        // N, that friction could carry
  double friction_power = 0, elastic_energy = 0, pressure_energy = 0;
  turning_energy turning;  // where the scene has it
  film_outcome film;       // of the scene's liquid
  double shear_part = 0;   // -, of the friction, of the liquid's own shear
};

struct derivative_options {
  // of the linear systems, relative to their right sides; 0: as the scene's tolerance asks for
  double tolerance = 0;
  bool energy = true;  // false: elastic_energy is not asked for, and NaN
};

// How the systems ended.
struct derivative_outcome {
  double residual = 0;  // greatest, relative
  bool converged = true;
};

class patch_derivative {
 public:
  // stretches: a grid's dx and dy may change at different rates.
  patch_derivative(const patch_scene &scene, const fft_plans &plans, int max_nx, int max_ny,
                   bool stretches);

  // What has been solved and by what; absent stages are null.
  struct solution {
    const patch_scene &scene;
    const patch_problem &problem;
    const patch_memory &memory;
    influence *a;
    normal_solver *normal;
    row_blocks *blocks;
    const table_forces *tables;
  };
  derivative_outcome solve(const solution &s, const patch_variation *in, int count,
                           const derivative_options &o, patch_change *out);
  size_t bytes() const;

 private:
  void solve_some(const solution &s, const patch_variation *in, int count,
                  const derivative_options &o, bool by_resultants, patch_change *out,
                  derivative_outcome &outcome);
  void differentiate_tractions(const solution &s, const patch_variation *in, int count,
                               const derivative_options &o, bool by_resultants, patch_change *out,
                               derivative_outcome &outcome);
  void differentiate_half_space(const solution &s, const patch_variation *in, int count,
                                const derivative_options &o, patch_change *out,
                                derivative_outcome &outcome);
  void differentiate_hertz(const solution &s, const patch_variation &v, double *rate,
                           patch_change &out) const;
  void add_pressure(const solution &s, const patch_variation &v, const double *rate,
                    patch_change &out) const;
  void complete(const solution &s, const patch_variation &v, const double *rate,
                patch_change &out) const;
  void differentiate_table(const solution &s, const patch_variation &v, const double *rate,
                           patch_change &out);
  void add_creep_forces(const solution &s, const patch_variation &v, const double (&force)[2],
                        double moment, patch_change &out) const;
  void add_tractions(const solution &s, const patch_variation &v, const tangential_change &t,
                     bool energy, patch_change &out) const;
  static double capacity_rate(const solution &s, const patch_variation &v, double friction,
                              const double *rate);
  tangential_point point_of(const solution &s) const;
  double *rate_of(const solution &s, int k);
  // of patch_scene::friction() and its rate, with the liquid's film in out
  static double friction_of(const solution &s);
  static double friction_rate(const solution &s, const patch_variation &v, const double *rate,
                              patch_change &out);

  std::optional<influence> by_length_;
  std::optional<normal_derivative> normal_;
  std::optional<tangential_derivative> tangential_;
  std::optional<pressed_ellipses<directed>> ellipses_;  // of tables
  rolling_input rolling_;
  aligned_buffer<double> pressure_;  // Pa, rates, [direction][ny][nx]
};

}  // namespace railpatch
