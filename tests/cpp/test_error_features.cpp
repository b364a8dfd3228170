// What the error estimate is made from, told anew from a result and its fields; and the bounds,
// from these by the networks written out. Unlike areas: ellipses, and gaps that are no ellipse.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "fast/coefficients.hpp"
#include "scenes.hpp"

namespace {

using std::numbers::pi;

struct network {
  const double *values;
  int inputs, units;
  double offsets[4];
};
#include "patch/error_model.inc"

double at(const network &net, const std::vector<double> &features, rp_normal_method normal) {
  double sum = net.values[0] + net.offsets[normal];
  for (int k = 0; k < net.units; ++k) {
    // of each kind of number those of all units
    const auto number = [&](int kind) { return net.values[1 + kind * net.units + k]; };
    double t = number(1);
    for (int i = 0; i < net.inputs; ++i) t += number(2 + i) * features[static_cast<size_t>(i)];
    sum += number(0) * t / (1 + std::fabs(t));
  }
  return sum;
}

// The contact's numbers from its grid: plain sums over all elements.
struct area {
  double across[2], centre[2], spread[2], count = 0;
  area(const std::vector<double> &p, const std::vector<double> &x, const std::vector<double> &y,
       const double size[2]) {
    double sum = 0, first[2] = {0, 0}, second[2] = {0, 0};
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (size_t i = 0; i < p.size(); ++i) {
      if (!(p[i] > 0)) continue;
      ++count;
      sum += p[i];
      const double at[2] = {x[i % x.size()], y[i / x.size()]};
      for (int k = 0; k < 2; ++k) {
        first[k] += p[i] * at[k];
        second[k] += p[i] * at[k] * at[k];
        low[k] = std::min(low[k], at[k]);
        high[k] = std::max(high[k], at[k]);
      }
    }
    for (int k = 0; k < 2; ++k) {
      across[k] = std::round((high[k] - low[k]) / size[k]) + 1;
      centre[k] = first[k] / sum;
      const double variance = second[k] / sum - centre[k] * centre[k] + size[k] * size[k] / 12;
      spread[k] = 20 * variance / std::pow(across[k] * size[k], 2);
    }
  }
};

struct scene {
  std::string name;
  rp_config config;
  const network *force, *pressure;
};

std::vector<scene> all_scenes(const std::vector<double> &gap) {
  std::vector<scene> all;
  const auto add = [&](const char *name, const rp_config &c, const network *force) {
    const network *pressure = c.normal == RP_NORMAL_HALF_SPACE ? half_space_pressure_errors
                              : c.normal == RP_NORMAL_ANALYN   ? analyn_pressure_errors
                              : c.normal == RP_NORMAL_KIK_PIOTROWSKI
                                  ? kik_piotrowski_pressure_errors
                                  : nullptr;
    all.push_back({name, c, force, pressure});
  };
  const auto by = [&](rp_tangential_method method) -> const network * {
    for (const auto &theory : fast_errors)
      if (theory.method == method) return theory.errors;
    return nullptr;
  };
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 13);
  c.semi_axes[0] *= 1.7;
  add("full", c, uniform_errors);
  c.fitted[0] = 9;
  c.fitted[1] = 11;
  add("fitted rows", c, fitted_errors);
  c.fitted[0] = c.fitted[1] = 27;
  add("finer rows", c, fitted_errors);
  for (const rp_normal_method normal : {RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_ANALYN})
    add("full on rows", scenes::patch(normal, RP_TANGENTIAL_FULL, 12), uniform_approximate_errors);
  add("full on Hertz", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL, 12), uniform_errors);
  c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 14);
  c.layer_thickness = 2e-4;
  c.layer_shear_modulus = 1e10;
  c.shear_modulus[0] *= 0.6;
  c.shear_modulus[1] *= 0.6;
  add("layer", c, uniform_errors);
  for (const rp_normal_method normal : {RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_ANALYN})
    for (const rp_tangential_method method : {RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_FASTRIP})
      add("rows", scenes::patch(normal, method, 20), by(method));
  for (const rp_tangential_method method : {RP_TANGENTIAL_LINEAR, RP_TANGENTIAL_POLACH})
    add("closed forms", scenes::patch(RP_NORMAL_HERTZ, method), by(method));
  c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 0);
  c.geometry = RP_UNDEFORMED_DISTANCE;
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = 1e-3;
  c.element_size[1] = 8e-4;
  c.undeformed_distance = gap.data();
  c.distance_shape[0] = 24;
  c.distance_shape[1] = 20;
  add("gap", c, uniform_errors);
  return all;
}

rp_error error_of(const scenes::handle &h, size_t count) {
  std::vector<double> values(count);
  return rp_get_field(h.get(), RP_RIGHT, 0, RP_FIELD_ERROR_FEATURES, values.data(), &count);
}

// Features belong to the last step's estimate, and are not there without one.
TEST(ErrorEstimate, HasNoFeaturesWhereItIsNotMade) {
  rp_config c = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL);
  c.max_iterations = 2;
  scenes::handle newton(c);
  const rp_input still = scenes::patch_input(1e5, 0, 0, 0);
  for (int k = 0; k < 2; ++k) {
    ASSERT_EQ(newton.step(still).status, RP_CONVERGED);
    EXPECT_EQ(error_of(newton, RP_ERROR_FEATURES), RP_OK);
    EXPECT_EQ(error_of(newton, RP_ERROR_FEATURES - 1), RP_ERROR_SIZE);
    ASSERT_EQ(newton.step(scenes::patch_input(1e5, 8e-4, -6e-4, 0.4)).status, RP_NOT_CONVERGED);
    EXPECT_EQ(error_of(newton, RP_ERROR_FEATURES), RP_ERROR_NO_FIELD);
    rp_reset(newton.get());
  }
  c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_NONE, 0);
  c.geometry = RP_UNDEFORMED_DISTANCE;
  c.load = RP_POSITION;
  c.element_size[0] = c.element_size[1] = 1e-3;
  std::vector<double> gap(25, 1e-6);
  gap[12] = 0;
  c.undeformed_distance = gap.data();
  c.distance_shape[0] = c.distance_shape[1] = 5;
  scenes::handle lifted(c);
  rp_input in = still;
  in.approach = 1e-7;
  ASSERT_EQ(lifted.step(in).status, RP_CONVERGED);
  EXPECT_EQ(error_of(lifted, RP_ERROR_FEATURES), RP_OK);
  in.approach = -1e-7;
  ASSERT_EQ(lifted.step(in).status, RP_NO_CONTACT);
  EXPECT_EQ(lifted.field(RP_RIGHT, 0, RP_FIELD_PRESSURE), std::vector<double>(25, 0.0));
  EXPECT_EQ(error_of(lifted, RP_ERROR_FEATURES), RP_ERROR_NO_FIELD);
}

TEST(ErrorEstimate, IsMadeFromTheResultAndItsFields) {
  // a paraboloid with a ridge beside its middle, aslant
  std::vector<double> gap;
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 24; ++i) {
      const double x = (i - 11.5) * 1e-3, y = (j - 9.5) * 8e-4, ridge = (y + 0.5 * x - 3e-3) / 2e-3;
      gap.push_back(0.9 * x * x + 1.5 * y * y - 1e-5 * std::exp(-ridge * ridge));
    }
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> u(-1, 1);
  for (const scene &s : all_scenes(gap)) {
    scenes::handle h(s.config);
    const double nu = s.config.poisson_ratio[0], g = s.config.shear_modulus[0];
    const double layer = s.config.layer_thickness > 0
                             ? s.config.layer_thickness / s.config.layer_shear_modulus
                             : 0.0;
    const railpatch::coefficient_table table(nu);
    for (int k = 0; k < 6; ++k) {
      SCOPED_TRACE(testing::Message() << s.name << " " << k);
      rp_input in = scenes::patch_input(8e4, 2e-3 * u(random), 2e-3 * u(random), 0.6 * u(random));
      if (k == 5) in.creepage[0] = 0.1;
      in.direction = k % 2 ? 1 : -1;
      const rp_patch_result r = h.step(in).side[RP_RIGHT].patch[0];
      const std::vector<double> found = h.field(RP_RIGHT, 0, RP_FIELD_ERROR_FEATURES);
      ASSERT_EQ(found.size(), 23u);
      std::vector<double> f(23, 0.0);
      double axes[2] = {s.config.semi_axes[0], s.config.semi_axes[1]}, centre[2] = {0, 0};
      double grid[2] = {0, 0};
      const bool hertz = s.config.normal == RP_NORMAL_HERTZ, fitted = s.config.fitted[0] > 0;
      const double size[2] = {r.element_size[0], r.element_size[1]};
      if (!fitted && r.grid[0] > 0 && s.config.tangential != RP_TANGENTIAL_LINEAR &&
          s.config.tangential != RP_TANGENTIAL_POLACH) {
        const area a(h.field(RP_RIGHT, 0, RP_FIELD_PRESSURE), h.field(RP_RIGHT, 0, RP_FIELD_X),
                     h.field(RP_RIGHT, 0, RP_FIELD_Y), size);
        for (int c = 0; c < 2; ++c) grid[c] = a.across[c];
        if (!hertz) {
          for (int c = 0; c < 2; ++c) centre[c] = a.centre[c];
          if (s.config.normal == RP_NORMAL_HALF_SPACE) {
            axes[1] = 0.5 * a.across[1] * size[1];
          } else {
            // rows end between the elements: their width is not in the fields
            axes[1] = std::sqrt(r.contact_area / (pi * std::exp(found[0])));
            EXPECT_NEAR(2 * axes[1], a.across[1] * size[1], 1.01 * size[1]);
          }
          axes[0] = r.contact_area / (pi * axes[1]);
          f[3] = std::log(a.across[0] / 16);
          f[4] = std::log(a.across[1] / 16);
          f[6] = std::log(a.count / (0.25 * pi * a.across[0] * a.across[1]));
          f[10] = std::log(a.spread[0]);
          f[11] = std::log(a.spread[1]);
        }
      } else if (fitted) {
        // the area of the normal problem's grid is not in the fields
        for (size_t i : {0, 1, 3, 4, 6, 10, 11}) f[i] = found[i];
        axes[1] = std::sqrt(r.contact_area / (pi * std::exp(found[0])));
        axes[0] = axes[1] * std::exp(found[0]);
        for (int c = 0; c < 2; ++c) grid[c] = s.config.fitted[c];
      }
      const double length = std::sqrt(axes[0] * axes[1]), force = 0.3 * r.normal_force;
      f[0] = std::log(axes[0] / axes[1]);
      if (!fitted) f[1] = std::hypot(centre[0], centre[1]) / length;
      f[2] = nu - 0.28;
      if (!hertz) {
        f[5] = std::log(r.max_pressure * r.contact_area / (1.5 * r.normal_force));
        f[7] = s.config.normal == RP_NORMAL_HALF_SPACE;
        f[8] = s.config.normal == RP_NORMAL_KIK_PIOTROWSKI;
        f[9] = s.config.normal == RP_NORMAL_ANALYN;
      }
      const auto c = table.at(axes[0] / axes[1]);
      const auto soft = [&](double v) { return v / (1 + 3 * layer * v * g / (8 * axes[0])); };
      const double unit = g * length * length / force, c22 = soft(c.c22);
      const double xi = std::fabs(r.creepage[0] - r.spin_creepage * centre[1]) * unit * soft(c.c11);
      const double lateral = (r.creepage[1] + r.spin_creepage * centre[0]) * unit * c22;
      const double turn = in.direction * r.spin_creepage * length * unit * c.c23 * c22 / c.c22;
      const double eta = std::fabs(lateral), spin = std::fabs(turn);
      const double sum = std::hypot(xi, eta) + spin, square = xi * xi + eta * eta;
      f[12] = std::log(1 + std::min(std::hypot(xi, eta), 16.0));
      f[13] = std::log(1 + std::min(spin, 4.0));
      f[14] = xi * xi / (square + 0.0025);
      f[15] = lateral * turn / (0.05 + square + spin * spin);
      const double linear = std::hypot(xi, lateral * turn < 0 ? eta - spin : eta + spin);
      f[16] = linear / (1 + linear);
      f[17] = std::hypot(r.creep_force[0], r.creep_force[1]) / force;
      f[18] =
          std::fabs(r.spin_moment - centre[0] * r.creep_force[1] + centre[1] * r.creep_force[0]) /
          (force * length);
      const double touching = r.elements[RP_STICK] + r.elements[RP_SLIP];
      f[19] = touching > 0 ? r.elements[RP_STICK] / touching : 0;
      for (size_t i = 0; i < 2; ++i) f[20 + i] = grid[i] > 0 ? std::log(grid[i] / 16) : 0;
      // beyond rows of 24 across errors go on falling with the order 1.5
      const double beyond = fitted ? std::max(0.0, 0.5 * (f[20] + f[21]) - std::log(1.5)) : 0.0;
      for (size_t i : {20, 21}) f[i] -= beyond;
      const double shrinkage = std::exp(-1.5 * beyond);
      f[22] = std::log(1 + 20 * layer * g / length);
      // the centre under fitted rows is known to rounding only
      for (size_t i = 0; i < f.size(); ++i) {
        EXPECT_NEAR(found[i], f[i], (fitted ? 1e-6 : 1e-9) * (1 + std::fabs(f[i])))
            << "feature " << i;
      }
      const double least = 3e-4 * std::min(1.0, sum), close = fitted ? 1e-6 : 1e-9;
      const auto expect = [&](double bound, double expected) {
        EXPECT_NEAR(bound, expected, close * expected);
      };
      const auto relative = [&](const network &net) {
        return std::max(least,
                        sum / (1 + sum) * shrinkage * std::exp(at(net, found, s.config.normal)));
      };
      expect(r.error_estimate[0], force * relative(s.force[0]));
      expect(r.error_estimate[1], force * length * relative(s.force[1]));
      expect(r.error_estimate[2],
             r.max_pressure *
                 (s.pressure ? std::exp(at(*s.pressure, found, s.config.normal)) : 1e-10));
    }
  }
}

}  // namespace
