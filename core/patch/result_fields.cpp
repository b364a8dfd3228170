#include "patch/result_fields.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "numeric/nan.hpp"
#include "patch/patch_scene.hpp"

namespace railpatch {

namespace {

template <class T>
void turn(T &field, field_mirror how) {
  // a reflection at the plane y = 0: vectors change their y, axial vectors their x and z
  if (how == field_mirror::even || how == field_mirror::origin) return;
  int component = 0;
  for_each_in(field, [&](auto &v) {
    const bool lateral = component++ == 1;
    if constexpr (std::is_floating_point_v<std::remove_reference_t<decltype(v)>>)
      if (how == field_mirror::odd || lateral == (how == field_mirror::vector)) v = -v;
  });
}

#define RP_NONE(type, name, count)
#define RP_TURN(type, name, count, role, mirror, ...) turn(r.name, field_mirror::mirror);

// One reason tells a place.
template <class Result>
void mirror_reason(Result &r) {
  if (r.reason == RP_REASON_PROFILE_END) r.reason_value = -r.reason_value;
}

void mirror(rp_patch_result &r) {
  RP_PATCH_RESULT_FIELDS(RP_TURN, RP_NONE)
  mirror_reason(r);
  r.grid_origin[1] = -(r.grid_origin[1] + (r.grid[1] - 1) * r.element_size[1]);
}

template <class T>
void set_still(T &field, field_role role) {
  for_each_in(field, [&](auto &v) {
    using number = std::remove_reference_t<decltype(v)>;
    if (role == field_role::count) v = {};
    if constexpr (std::is_floating_point_v<number>) {
      if (role == field_role::number) v = std::isnan(v) ? nan : 0.0;
      if (role == field_role::estimate) v = nan;
    }
  });
}

#define RP_STILL(type, name, count, role, ...) set_still(r.name, field_role::role);

void set_still(rp_patch_result &r) { RP_PATCH_RESULT_FIELDS(RP_STILL, RP_NONE) }

void set_still(rp_side_result &r) {
  RP_SIDE_RESULT_FIELDS(RP_STILL, RP_NONE)
  for (auto &patch : r.patch) set_still(patch);
}

}  // namespace

#define RP_START(type, name, count, role, mirror, unloaded, sum, start, ...) \
  for_each_in(r.name, [](auto &v) { v = start; });

namespace {

constexpr rp_patch_result new_patch_result() {
  rp_patch_result r{};
  RP_PATCH_RESULT_FIELDS(RP_START, RP_NONE)
  return r;
}

constexpr rp_side_result new_side_result() {
  rp_side_result r{};
  RP_SIDE_RESULT_FIELDS(RP_START, RP_NONE)
  for (auto &patch : r.patch) patch = new_patch_result();
  return r;
}

constexpr rp_result new_result() {
  rp_result r{};
  RP_RESULT_FIELDS(RP_START, RP_NONE)
  for (auto &side : r.side) side = new_side_result();
  return r;
}

// copied into each step's
constexpr rp_result no_result = new_result();

}  // namespace

rp_patch_result empty_patch_result() { return no_result.side[0].patch[0]; }
rp_side_result empty_side_result() { return no_result.side[0]; }
rp_result empty_result() { return no_result; }

void set_unloaded(const patch_scene &scene, rp_patch_result &result) {
  const bool rolling = scene.tangential != RP_TANGENTIAL_NONE;
  const auto is_zero = [&](field_unloaded how) {
    return how == field_unloaded::zero || (how == field_unloaded::zero_rolling && rolling) ||
           (how == field_unloaded::zero_plastic && rolling && scene.yields());
  };
#define RP_UNLOAD(type, name, count, role, mirror, unloaded, ...) \
  if (is_zero(field_unloaded::unloaded)) for_each_in(result.name, [](auto &v) { v = {}; });
  RP_PATCH_RESULT_FIELDS(RP_UNLOAD, RP_NONE)
  if (rolling) result.error_estimate[0] = result.error_estimate[1] = 0;
  result.error_estimate[2] = 0;
  if (scene.is_viscous()) result.viscous_power = result.rolling_resistance_moment = 0;
  if (scene.fluid && scene.fluid->model != RP_FLUID_REGIMES) result.fluid_power = 0;
  if (!scene.heat) return;
  result.max_temperature =
      std::max(scene.heat->bodies.body[0].bulk, scene.heat->bodies.body[1].bulk);
  result.wheel_heat = result.rail_heat = 0;
}

void mirror(rp_side_result &r) {
  RP_SIDE_RESULT_FIELDS(RP_TURN, RP_NONE)
  for (auto &patch : r.patch) mirror(patch);
}

rp_result rates_of_nothing(const rp_result &result) {
  rp_result r = result;
  RP_RESULT_FIELDS(RP_STILL, RP_NONE)
  for (auto &side : r.side) set_still(side);
  return r;
}

}  // namespace railpatch
