#include "patch/error_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;

// values: w0, then of all units w, of all v0, and of all v, input by input; offsets: by theory of
// the normal problem
struct network {
  static constexpr int most_units = 16;
  const double *values;
  int inputs, units;
  double offsets[4];
  double at(const double *features, rp_normal_method normal) const {
    const double *w = values + 1, *v = w + units;
    double t[most_units];
    std::copy_n(v, units, t);
    for (int i = 0; i < inputs; ++i) {
      v += units;
      // an ellipse has but a third of the features
      if (features[i] == 0) continue;
      for (int k = 0; k < units; ++k) t[k] += v[k] * features[i];
    }
    for (int k = 0; k < units; ++k) t[k] = w[k] * t[k] / (1.0 + std::abs(t[k]));
    double sum = values[0] + offsets[normal];
    for (int k = 0; k < units; ++k) sum += t[k];
    return sum;
  }
};

#include "patch/error_model.inc"

bool has_exact_pressure(rp_normal_method normal) {
  return normal == RP_NORMAL_HERTZ || normal == RP_NORMAL_HALF_SPACE;
}

// Networks of force and moment, or null where the theory has none.
const network *model_of(const estimated_patch &patch) {
  if (patch.tangential == RP_TANGENTIAL_FULL) {
    if (has_exact_pressure(patch.normal)) return patch.fitted ? fitted_errors : uniform_errors;
    return patch.fitted ? fitted_approximate_errors : uniform_approximate_errors;
  }
  for (const auto &theory : fast_errors)
    if (theory.method == patch.tangential) return theory.errors;
  return nullptr;
}

const network *pressure_model_of(rp_normal_method normal) {
  switch (normal) {
    case RP_NORMAL_HALF_SPACE:
      return half_space_pressure_errors;
    case RP_NORMAL_KIK_PIOTROWSKI:
      return kik_piotrowski_pressure_errors;
    case RP_NORMAL_ANALYN:
      return analyn_pressure_errors;
    default:
      return nullptr;
  }
}

// relative, of Hertz's closed form; and of mu Fn, of the results that models are fitted to
constexpr double rounding = 1e-10, force_floor = 3e-4;

// scaled creepage and spin up to which models are fitted: beyond, all slides
constexpr double farthest[2] = {16.0, 4.0};

// of a number of elements, 0 for what has none
double fineness(int count) { return count > 0 ? log(count / 16.0) : 0.0; }

// elements across, of uniform grids and of fitted rows, up to which models are fitted, and the
// order that errors fall with on finer ones
struct finest_grid {
  int across;
  double order;
};
constexpr finest_grid finest_uniform{40, 1.0}, finest_rows{24, 1.5};

// The finenesses either way at the finest that models know, by their mean. Returns by how much it
// is exceeded.
double limit_fineness(int across, double *fineness_of) {
  const double beyond = 0.5 * (fineness_of[0] + fineness_of[1]) - fineness(across);
  if (!(beyond > 0)) return 0;
  for (int k = 0; k < 2; ++k) fineness_of[k] -= beyond;
  return beyond;
}

// Of errors on a grid by those on the finest that models know. What a theory of the normal problem
// or a fast one errs by itself does not shrink with the grid.
double shrinkage(const estimated_patch &patch, double *fineness_of) {
  const finest_grid &finest = patch.fitted ? finest_rows : finest_uniform;
  const double beyond = limit_fineness(finest.across, fineness_of);
  const bool exact = patch.tangential == RP_TANGENTIAL_FULL && has_exact_pressure(patch.normal);
  return exact ? exp(-finest.order * beyond) : 1.0;
}

}  // namespace

contact_extent extent_of(const grid &g, const double *pressure) {
  contact_extent e;
  int low[2] = {g.nx, g.ny}, high[2] = {-1, -1}, count = 0;
  double sum = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_yy = 0;
  for (int j = 0; j < g.ny; ++j) {
    double row = 0;
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i];
      if (!(p > 0)) continue;
      low[0] = std::min(low[0], i);
      high[0] = std::max(high[0], i);
      row += p;
      sum_x += p * g.x(i);
      sum_xx += p * g.x(i) * g.x(i);
      ++count;
    }
    if (!(row > 0)) continue;
    low[1] = std::min(low[1], j);
    high[1] = j;
    sum += row;
    sum_y += row * g.y(j);
    sum_yy += row * g.y(j) * g.y(j);
  }
  if (count == 0) return e;
  for (int k = 0; k < 2; ++k) e.across[k] = high[k] - low[k] + 1;
  e.centre[0] = sum_x / sum;
  e.centre[1] = sum_y / sum;
  e.width = e.across[1] * g.dy;
  const double size[2] = {g.dx, g.dy}, square[2] = {sum_xx / sum, sum_yy / sum};
  for (int k = 0; k < 2; ++k) {
    // of an ellipse a twentieth of the squared width; elements have their own
    const double variance = square[k] - e.centre[k] * e.centre[k] + size[k] * size[k] / 12.0;
    e.spread[k] = 20.0 * variance / pow(e.across[k] * size[k], 2);
  }
  const double ellipse = 0.25 * pi * e.across[0] * e.across[1];
  e.box_share = count / ellipse;
  return e;
}

// Creepages at the centre of pressure over those that saturate the linear theory, without sign but
// for `coupling`: it tells whether spin adds to the lateral creepage or takes away from it.
struct error_model::scaled_motion {
  double xi = 0, eta = 0, spin = 0, coupling = 0;
  double size() const { return hypot(xi, eta); }
  double sum() const { return size() + spin; }
  // over mu Fn
  double linear_force() const {
    const double turned = coupling < 0 ? eta - spin : eta + spin;
    return hypot(xi, turned);
  }
};

error_model::error_model(const elastic_constants &elastic, double layer_flexibility)
    : elastic_(elastic), layer_flexibility_(layer_flexibility), table_(elastic.poisson_ratio) {}

error_model::scaled_motion error_model::scaled(const estimated_patch &patch, const double axes[2],
                                               double capacity) const {
  const rolling_input &in = patch.rolling;
  const double g = elastic_.shear_modulus;
  if (!(capacity > 0)) return {};
  const double c2 = axes[0] * axes[1], c = std::sqrt(c2);
  const creepage_coefficients k = table_.at(axes[0] / axes[1]);
  // a layer adds its flexibility to that of the bodies, 8 a/(3 C G) (Kalker 1982)
  const auto softer = [&](double value) {
    return value / (1.0 + layer_flexibility_ * 3.0 * value * g / (8.0 * axes[0]));
  };
  const double unit = g * c2 / capacity, c22 = softer(k.c22);
  const double spin = in.direction * in.spin_creepage;
  const double eta = in.creepage[1] + in.spin_creepage * patch.extent.centre[0];
  scaled_motion m;
  m.xi =
      std::abs(in.creepage[0] - in.spin_creepage * patch.extent.centre[1]) * unit * softer(k.c11);
  m.eta = std::abs(eta) * unit * c22;
  m.spin = std::abs(spin) * c * unit * k.c23 * c22 / k.c22;
  m.coupling = eta * spin < 0 ? -m.eta * m.spin : m.eta * m.spin;
  return m;
}

error_bounds error_model::estimate(const estimated_patch &patch, const rp_patch_result &result,
                                   double *features) const {
  error_bounds bounds;
  const bool hertz = patch.normal == RP_NORMAL_HERTZ;
  std::fill_n(features, error_feature_count, 0.0);
  double axes[2] = {patch.hertz.semi_axes[0], patch.hertz.semi_axes[1]};
  if (!hertz) {
    // the ellipse of the contact's width and area
    axes[1] = 0.5 * patch.extent.width;
    axes[0] = result.contact_area / (pi * axes[1]);
  }
  // a line contact has no axis ratio
  if (!(axes[0] > 0 && axes[1] > 0)) return bounds;
  describe_area(patch, result, axes, features);
  const network *pressure = pressure_model_of(patch.normal);
  bounds.max_pressure =
      result.max_pressure * (pressure ? exp(pressure->at(features, patch.normal)) : rounding);
  const network *model = model_of(patch);
  if (!model) return bounds;
  const double force = patch.friction_coefficient * result.normal_force;
  const double length = std::sqrt(axes[0] * axes[1]);
  const scaled_motion m = scaled(patch, axes, force);
  describe_motion(patch, result, m, force, length, features);
  const double share =
      m.sum() / (1.0 + m.sum()) * shrinkage(patch, features + pressure_feature_count + 8);
  const double least = force_floor * std::min(1.0, m.sum());
  const auto relative = [&](int k) {
    if (patch.states_all) return std::max(least, std::min(1.0, m.sum()) * patch.stated[k]);
    return std::max(least, share * patch.stated[k] * exp(model[k].at(features, patch.normal)));
  };
  bounds.creep_force = force * relative(0);
  bounds.spin_moment = force * length * relative(1);
  return bounds;
}

void error_model::describe_area(const estimated_patch &patch, const rp_patch_result &result,
                                const double axes[2], double *features) const {
  const double ratio = log(axes[0] / axes[1]);
  features[0] = ratio;
  // the moment about the reference has the force's error with this lever
  const double *centre = patch.extent.centre;
  features[1] = hypot(centre[0], centre[1]) / std::sqrt(axes[0] * axes[1]);
  features[2] = elastic_.poisson_ratio - 0.28;
  if (patch.normal == RP_NORMAL_HERTZ) return;
  const contact_extent &e = patch.extent;
  features[3] = fineness(e.across[0]);
  features[4] = fineness(e.across[1]);
  limit_fineness(finest_uniform.across, features + 3);
  // all four zero for an ellipse
  features[5] = log(result.max_pressure * result.contact_area / (1.5 * result.normal_force));
  features[6] = log(e.box_share);
  features[10] = log(e.spread[0]);
  features[11] = log(e.spread[1]);
  features[7] = patch.normal == RP_NORMAL_HALF_SPACE;
  features[8] = patch.normal == RP_NORMAL_KIK_PIOTROWSKI;
  features[9] = patch.normal == RP_NORMAL_ANALYN;
}

void error_model::describe_motion(const estimated_patch &patch, const rp_patch_result &result,
                                  const scaled_motion &m, double force, double length,
                                  double *features) const {
  if (!(force > 0)) return;
  const double square = m.xi * m.xi + m.eta * m.eta, linear = m.linear_force();
  const double *f = result.creep_force, *centre = patch.extent.centre;
  const double moment = result.spin_moment - centre[0] * f[1] + centre[1] * f[0];
  const int stick = result.elements[RP_STICK], slip = result.elements[RP_SLIP];
  double *motion = features + pressure_feature_count;
  motion[0] = log(1.0 + std::min(m.size(), farthest[0]));
  motion[1] = log(1.0 + std::min(m.spin, farthest[1]));
  motion[2] = m.xi * m.xi / (square + 0.0025);
  motion[3] = m.coupling / (0.05 + square + m.spin * m.spin);
  motion[4] = linear / (1.0 + linear);
  motion[5] = hypot(f[0], f[1]) / force;
  motion[6] = std::abs(moment) / (force * length);
  motion[7] = stick + slip > 0 ? static_cast<double>(stick) / (stick + slip) : 0.0;
  motion[8] = fineness(patch.tangential_grid[0]);
  motion[9] = fineness(patch.tangential_grid[1]);
  motion[10] = log(1.0 + 20.0 * layer_flexibility_ * elastic_.shear_modulus / length);
}

}  // namespace railpatch
