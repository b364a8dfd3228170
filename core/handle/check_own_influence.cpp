#include <algorithm>
#include <cmath>
#include <cstdio>

#include "half_space/influence.hpp"
#include "half_space/physics.hpp"
#include "handle/checker.hpp"
#include "handle/scene_of.hpp"

namespace railpatch {

namespace {

// What own influence coefficients are not solved with; null: nothing.
const char *not_solved_with(const rp_config &c) {
  if (!has_physics) return "own_influence must be 0: this build has no own influence coefficients";
  if (c.kind != RP_PATCH)
    return "own_influence must be 0 but with kind = patch: grids of wheels follow the contact";
  if (c.geometry != RP_UNDEFORMED_DISTANCE)
    return "own_influence needs geometry = undeformed_distance: a grid that is given";
  if (c.normal != RP_NORMAL_HALF_SPACE) return "own_influence needs normal = half_space";
  if (has_tangential(c) && (c.tangential != RP_TANGENTIAL_FULL || c.fitted[0] > 0))
    return "own_influence needs tangential = full or none and no fitted rows";
  if (has_tangential(c) && (c.regime == RP_TRANSIENT_ROLLING || c.regime_changes != 0))
    return "own_influence needs regime = none, steady_rolling or shift and regime_changes = 0: "
           "between whole elements there are no coefficients";
  if (c.layer_thickness > 0)
    return "layer_thickness must be 0 with own_influence: it is part of the coefficients";
  if (c.fluid_model != RP_FLUID_NONE) return "fluid_model must be none with own_influence";
  if (c.derivatives != 0) return "derivatives must be 0 with own_influence";
  if (c.accuracy > 0) return "accuracy must be 0 with own_influence: there is no error estimate";
  if (viscous_bodies_of(c).any()) return "viscoelastic_ratio must be 0 with own_influence";
  if (has_tangential(c) && is_coupled(combine(c.shear_modulus, c.poisson_ratio)))
    return "own_influence with a tangential problem needs bodies with equal (1-2nu)/G: pressure "
           "moves the surfaces along each other with none of the coefficients";
  if (c.influence_coefficients == nullptr) return "influence_coefficients is null";
  return nullptr;
}

// Of a positive definite operator the coefficient of an element by itself is > 0 and the greatest,
// and those across are no more than the geometric mean of both.
bool bounded(const double *values, int count, double greatest) {
  return greatest > 0 &&
         std::all_of(values, values + count, [&](double v) { return std::abs(v) <= greatest; });
}

}  // namespace

size_t count_of_own_influence(const rp_config &c) {
  const auto columns = static_cast<size_t>(c.distance_shape[0]) + 1;
  return columns * static_cast<size_t>(c.distance_shape[1]) * (has_tangential(c) ? 4 : 1);
}

void check_own_influence(const rp_config &c, checker &check) {
  if (check.error() != RP_OK || c.own_influence == 0) return;
  const char *wrong = not_solved_with(c);
  check.require(wrong == nullptr, wrong ? wrong : "");
  if (check.error() != RP_OK) return;
  check.field("distance_shape", c.distance_shape, config_range::distance_shape);
  if (check.error() != RP_OK) return;
  const auto count = static_cast<int>(count_of_own_influence(c));
  check.numbers("influence_coefficients", c.influence_coefficients, count, {-1, 1, false, false});
  if (check.error() != RP_OK) return;
  const int each = (c.distance_shape[0] + 1) * c.distance_shape[1];
  for (int k = 0; k < std::min(3, count / each); ++k) {
    const double *values = c.influence_coefficients + k * each;
    if (bounded(values, each, values[0])) continue;
    char text[RP_MESSAGE_SIZE];
    std::snprintf(text, sizeof text,
                  "influence_coefficients[%d][0][0] is %g, must be > 0 and the greatest of its "
                  "kind: no others are positive definite",
                  k, values[0]);
    check.require(false, text);
    return;
  }
  if (count == each) return;
  const double *of = c.influence_coefficients;
  check.require(bounded(of + 3 * each, each, std::sqrt(of[each] * of[2 * each])),
                "influence_coefficients[3] has one above the geometric mean of [1][0][0] and "
                "[2][0][0]: no others are positive definite");
}

}  // namespace railpatch
