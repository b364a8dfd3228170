// The full theory converges, and to one result, wherever it starts: a seeded sample of Hertzian
// patches from slender to wide, with creepage from a tenth to twelve times the saturation of the
// linear theory and with spin up to twice it.
#include <cmath>
#include <numbers>
#include <random>

#include "scenes.hpp"

namespace {

constexpr double normal_force = 82e3, tolerance = 1e-6;
// ten times what each solution may be off, for the force's share of it
constexpr double independent = 1e-5;

// Kalker's coefficients C11, C22, C23 of the linear theory at Poisson's ratio 1/4 (Kalker 1990,
// table E3): they scale the sample only.
struct shape {
  double ratio, a, c11, c22, c23;
};
constexpr shape shapes[] = {{0.2, 4e-3, 3.37, 2.63, 0.603},
                            {0.5, 6e-3, 3.62, 3.01, 0.929},
                            {1.0, 9e-3, 4.12, 3.67, 1.47},
                            {2.0, 12e-3, 5.10, 4.90, 2.62},
                            {5.0, 20e-3, 7.78, 8.14, 6.63}};

class Patches : public testing::TestWithParam<int> {};

TEST_P(Patches, ConvergeToOneResultFromAnyStart) {
  std::mt19937_64 random(GetParam());
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (const shape &s : shapes) {
    rp_config config = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, GetParam());
    config.semi_axes[0] = s.a;
    config.semi_axes[1] = s.a / s.ratio;
    config.tolerance = tolerance;
    scenes::handle contact(config);
    const double c = s.a / std::sqrt(s.ratio), bound = config.friction_coefficient * normal_force;
    const double unit = bound / (config.shear_modulus[0] * c * c);
    rp_input input;
    rp_default_input(&input);
    input.normal_force = normal_force;
    const auto draw = [&] {
      const double size = std::exp(uniform(std::log(0.1), std::log(12.0)));
      const double angle = uniform(-0.5, 0.5) * std::numbers::pi;
      input.creepage[0] = size * std::cos(angle) * unit / s.c11;
      input.creepage[1] = size * std::sin(angle) * unit / s.c22;
      input.spin_creepage = uniform(-2, 2) * unit / (c * s.c23);
    };
    rp_patch_result last{};
    for (int k = 0; k < 12; ++k) {
      draw();
      // from the solution of quite another case, then from none, then from its own
      rp_patch_result result[3];
      result[0] = contact.step(input).side[RP_RIGHT].patch[0];
      rp_reset(contact.get());
      result[1] = contact.step(input).side[RP_RIGHT].patch[0];
      result[2] = contact.step(input).side[RP_RIGHT].patch[0];
      for (const rp_patch_result &r : result) {
        SCOPED_TRACE(testing::Message()
                     << "a/b " << s.ratio << ", creepage " << input.creepage[0] << ' '
                     << input.creepage[1] << ", spin " << input.spin_creepage);
        EXPECT_EQ(r.status, RP_CONVERGED) << "residual " << r.residual;
        EXPECT_LE(r.residual, tolerance);
        EXPECT_LE(std::hypot(r.creep_force[0] - result[1].creep_force[0],
                             r.creep_force[1] - result[1].creep_force[1]),
                  independent * bound);
        EXPECT_LE(std::fabs(r.spin_moment - result[1].spin_moment), independent * bound * c);
      }
      // its own solution is a solution: nothing is left to do
      EXPECT_EQ(result[2].newton_iterations, 0);
      EXPECT_NE(result[0].creep_force[0], last.creep_force[0]);
      last = result[0];
    }
  }
}

// Cold, half slipping: the edge of slip has four times as many elements to cross on the fine grid.
int newton_steps(int across, double share) {
  scenes::handle contact(scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, across));
  const rp_input input = scenes::patch_input(normal_force, share * 1e-3, 0.7 * share * 1e-3, 0.0);
  const rp_patch_result result = contact.step(input).side[RP_RIGHT].patch[0];
  EXPECT_EQ(result.status, RP_CONVERGED);
  EXPECT_GT(result.elements[RP_STICK], 0);
  EXPECT_GT(result.elements[RP_SLIP], 0);
  return result.newton_iterations;
}

TEST(Newton, TakesNoMoreStepsOnFinerGrids) {
  const int fine = scenes::sanitized ? 48 : 96;
  for (const double share : {0.3, 0.6, 1.0})
    EXPECT_LE(newton_steps(fine, share), newton_steps(24, share)) << share;
}

std::vector<int> elements_across() {
  if (scenes::sanitized) return {10, 16};
  return {10, 16, 32, 48};
}
INSTANTIATE_TEST_SUITE_P(ElementsAcross, Patches, testing::ValuesIn(elements_across()),
                         testing::PrintToStringParamName());

}  // namespace
