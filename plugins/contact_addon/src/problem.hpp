// What callers have said of a contact problem, in SI, and what its last case gave. Body 1 is the
// rail (index 0 of pairs here), body 2 the wheel; railpatch.h has them the other way round.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "flags.hpp"
#include "profile.hpp"
#include "railpatch.h"
#include "slices.hpp"
#include "units.hpp"

namespace contact_addon {

struct material_data {
  int method = 0;  // M
  double poisson[2] = {0.28, 0.28};
  double shear[2] = {1e6, 1e6};  // Pa
  double k0 = 1, alpha = 1, beta = 1;
  double flexibility[2] = {0, 0};  // of M = 1: -; of M = 2 the first, m^3/N
  double relaxation[2] = {0, 0};   // s, of M = 1
  double layer_shear = 0, layer_thickness = 0, yield_stress = 0, hardening = 0;
  bool damping = false;                     // M2
  double damping_values[4] = {0, 0, 0, 0};  // s, s, N/s, N/s
};

struct friction_set {
  double place = 0;  // rad or m
  double values[7] = {0.3, 0.3, 0, 0, 0, 0, 0};
};

struct friction_data {
  int law = 0, variation = 0;  // L, V
  std::vector<friction_set> sets{friction_set{}};
};

struct heat_data {
  bool on = false;
  double bulk[2] = {0, 0}, capacity[2] = {450, 450}, conductivity[2] = {50, 50};
  double density[2] = {7850, 7850}, plastic_fraction = 1;
};

struct solver_data {
  int method = 0;  // G
  int max_iterations = 999;
  double tolerance = 1e-5;
};

// Potential contact of a basic problem: centre of the first element, size, counts.
struct grid_data {
  int ipotcn = 1, mx = 0, my = 0;
  double x0 = 0, y0 = 0, dx = 0, dy = 0;  // m, ipotcn > 0
  double hertz[4] = {0, 0, 0, 0};         // ipotcn < 0: the values behind mx, my, in SI
};

struct distance_data {
  int ibase = 1;
  std::vector<double> values{1, 0, 1, 0, 0, 0};  // as given, in SI
};

// Of a wheel on its rail.
struct wheel_data {
  double dx = 5e-4, ds = 5e-4, separation_angle = 3.141592653589793;
  double combination[3] = {8e-3, 4e-3, 12e-3};  // m: D_SEP, D_COMB, D_TURN
  bool misses = false;                          // G_MISS was said
  double step_ratio = 1;                        // dq over dx
  double gauge = 1.435, gauge_height = 0.014, cant = 0, roller_radius = 0.5, curvature = 0;
  double rail_place[2] = {0, 0};  // m, where gauge_height <= 0
  double rail[6] = {};            // DY DZ DROLL VY VZ VROLL
  double support[4] = {};         // KY FY KZ FZ
  double flange_back_distance = 1.36, flange_back_position = -0.07, nominal_radius = 0.46;
  double position[6] = {};                    // S Y Z ROLL YAW PITCH
  double velocity[6] = {};                    // VS|RPITCH VY VZ VROLL VYAW VPITCH
  double flexibility[12] = {};                // DX DY DZ DROLL DYAW DPITCH, their rates
  double vertical_force = 0;                  // N
  double longitudinal_force = 0;              // N, FX_WS
  profile_curve wheel_profile, rail_profile;  // of slices the first
  profile_points wheel_points, rail_points;
  profile_slices wheel_slices, rail_slices;
  std::shared_ptr<matched_slices> wheel_matched, rail_matched;
  int profile_changes = 0;
};

// Of a contact that is given directly.
struct basic_data {
  double velocity = 1, chi = 0, step = 0;  // m/s, rad, m
  double penetration = 0, normal_force = 0;
  double creepage[3] = {0, 0, 0};  // as set: body 1 minus 2
  double force[2] = {0, 0};        // over FSTAT FN, on body 1
};

struct block {
  int kind = 0, count[3] = {0, 0, 0};
  std::vector<double> x, y, z;  // as given, lengths in m, element numbers as numbers
  int shape[3] = {-1, -1, -1};  // of the points of the last results
  std::vector<double> points;   // m, [n][3]: x, y, z in the contact frame
  std::vector<double> results;  // [n][9]: stresses xx ss nn xs sn nx, displacements
};

struct handle_deleter {
  void operator()(rp_contact *contact) const { rp_destroy(contact); }
};

// A config with the arrays that it points to.
struct mapped_case {
  rp_config config{};
  std::vector<double> distance;
  std::vector<double> slip;  // of each element, wheel minus rail; none: not part of the case
  profile_curve wheel_profile, rail_profile;
  std::shared_ptr<matched_slices> wheel_slices, rail_slices;
  int profile_changes = 0;
  bool on_own_grid = false;     // elements are the caller's
  double offset[2] = {0, 0};    // m, of the grid's middle from the caller's origin
  grid_data grid;               // of a basic problem: what the caller expects
  double hertz[3] = {0, 0, 0};  // A1, B1 (1/m), unused where no ellipse was asked for
};

struct problem {
  std::recursive_mutex busy;  // also of calls that a call is made of
  int module = 0, ire = 0, icp = 0;

  flag_values flags;
  std::array<double, 9> metadata{};
  material_data material;
  friction_data friction;
  heat_data heat;
  solver_data solver;
  grid_data grid;
  distance_data distance;
  basic_data basic;
  wheel_data wheel;
  std::vector<double> extra_slip[2];  // by element, body 1 minus 2; m with T = 1
  // by call: why what was set with it has no counterpart; said when a case is to be solved
  std::array<std::pair<const char *, std::string>, 16> refused{};

  // --- the last case
  bool changed = true;  // since the handle was made
  mapped_case mapped;
  std::unique_ptr<rp_contact, handle_deleter> contact;
  std::vector<char> state_before;  // of steps that remember
  bool solved = false, touching = false;
  int cases = 0;
  rp_input input{};
  rp_result result{};
  std::vector<block> blocks = std::vector<block>(11);  // 1 ... 10
  std::vector<std::vector<block>> block_results;       // by patch, from 1
  double cpu = 0, wall = 0;

  units unit() const { return units_of(flags.get(flag_units)); }
  bool wheel_rail() const { return module == 1; }
  bool left() const { return flags.get(flag_config) == 0 || flags.get(flag_config) == 4; }
  bool roller() const { return flags.get(flag_config) >= 4; }
  int side() const { return wheel_rail() && left() ? RP_LEFT : RP_RIGHT; }
  const rp_side_result &at_side() const { return result.side[side()]; }
  int patches() const {
    return solved && touching ? (wheel_rail() ? at_side().patch_count : 1) : 0;
  }

  // text empty: the call has a counterpart now
  void refuse(const char *call, const std::string &text);
};

}  // namespace contact_addon
