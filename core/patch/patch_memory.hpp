// One step's problem of a patch, and what is remembered of the patch from step to step.
#pragma once

#include <array>

#include "half_space/forces.hpp"
#include "half_space/physics.hpp"
#include "normal/hertz.hpp"
#include "normal/normal.hpp"
#include "numeric/nan.hpp"
#include "patch/conformal_rows.hpp"
#include "patch/error_estimate.hpp"
#include "patch/history.hpp"
#include "patch/patch_scene.hpp"
#include "tangential/fitted.hpp"
#include "tangential/tangential.hpp"
#include "temperature/stage.hpp"

namespace railpatch {

// Where a patch lies and how it rolls, as its result states it.
struct patch_place {
  bool on_wheel = false;  // else only the motion is known
  double position[3] = {nan, nan, nan}, contact_angle = nan;
  double on_wheel_profile[2] = {nan, nan}, on_rail_profile[2] = {nan, nan};  // m, in their axes
  double depth = 0;          // m, greatest interpenetration
  double contact_depth = 0;  // m, along n from the position: where creep forces act
  double share = 1;          // in the wheel's force
  double rolling_speed = nan;
  int direction = 0;  // 0: standstill

  // Of the depth, where creep forces act: 1 on a rail.
  double depth_part() const { return depth > 0 ? contact_depth / depth : 1.0; }
};

// One step's problem; the undeformed distance is in patch_memory.
struct patch_problem {
  patch_place place;
  grid g;
  bool force_given = false;
  double force = 0, approach = 0;
  double rolling_speed = 0;  // m/s; 0: standstill, no tangential traction arises
  bool shifts = false;       // regime = shift: all speeds are ways
  rolling_input rolling;
  double tangential_force[2] = {0, 0};  // N, of the components prescribed
  const double *slip_field = nullptr;   // -, prescribed of each element, [2][ny][nx]; null: none
  hertz_contact hertz;                  // where the surfaces are quadratic, else all zero
  contact_parts parts;
  const past_tractions *past = nullptr;  // of wheels in transient rolling, with their number
  int past_count = 0;
  bool follows = false;  // the grid goes on from one nearly like it
  int followed = 0;      // steps in a row in which it did: influence::set_grid()
  double rolled = 0;  // m along x in the step, with it: near standstill not all of rolling.distance
};

// Fields of the last solution, [ny][nx] of the grid or, for what belongs to the tangential problem
// of fitted rows, [strip][node]; with the grid they are also the next start.
struct patch_memory {
  patch_memory() = default;
  // max_count: elements of the greatest grid.
  patch_memory(int max_count, int max_rows, const patch_scene &scene);
  bool solved = false;   // fields belong to the last step
  bool warm = false;     // pressure and traction may serve as a start
  int followed = 0;      // steps in a row whose grid went on from one nearly like it
  bool counted = false;  // whether this step is among them, or none
  bool beyond = false;   // the normal problem left its range: what the patch carries is not known
  grid g;
  double share = 1;         // in the wheel's force
  double rail[2] = {0, 0};  // m, lateral and vertical offset of the rail
  double approach = 0;      // m, of the last step's normal problem on the half-space
  // of wheels in transient rolling, at the step's end: see patch_history::last_rolling
  std::array<double, 5> rolling{};
  std::array<double, 3> reference{};  // m, contact reference, track axes of a right wheel
  aligned_buffer<double> undeformed_distance, pressure, px, py, sx, sy;
  aligned_buffer<unsigned char> division;
  aligned_buffer<double> node_x, node_y, node_height, node_pressure;  // fitted rows only
  aligned_buffer<double> fluid_pressure;                              // Pa, of a liquid by strips
  aligned_buffer<double> fluid_film, fluid_shear;  // m, Pa: of elastohydrodynamic lubrication
  aligned_buffer<double> row_friction;             // factor of each grid row, where it varies
  aligned_buffer<double> slope_fields;             // of slopes
  surface_slopes slopes;                           // where pressure acts along local normals
  turning_energy turning;                          // of the last solution, where it has one
  aligned_buffer<double> creepage;                 // [2], of a prescribed creep force only
  bool estimated = false;                          // the last step's errors, from the features
  std::array<double, error_feature_count> error_features{};
  struct {
    hertz_contact ellipse;
    double friction = 0, shear = 0;
  } wet;  // with a liquid's film: what it formed on, the coefficient without factors and the
          // liquid's own part of it
  // of elastohydrodynamic lubrication: gap where the liquid enters the grid over the film
  double film_entry = HUGE_VAL;
  patch_history history;
  physics_part<heat_memory> heat;
  physics_part<conformal_rows> curved;
  bool fitted() const { return node_x.size() > 0; }
  // elements of the tangential problem along rolling and lateral
  int columns() const { return fitted() ? static_cast<int>(node_x.size() / node_y.size()) : g.nx; }
  int rows() const { return fitted() ? static_cast<int>(node_y.size()) : g.ny; }
  tangential_fields fields() {
    return {px.data(), py.data(), sx.data(), sy.data(), division.data()};
  }
  fitted_fields nodes() {
    return {node_x.data(), node_y.data(), node_height.data(), node_pressure.data(), fields()};
  }
  // No contact: nothing is transferred, and every element of the grid is exterior.
  void unload(const grid &on, const bound_law *law);
  size_t bytes() const;
};

}  // namespace railpatch
