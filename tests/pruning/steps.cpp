// Solves plain cases, steady rolling of like steels with Coulomb friction, so that their cost can
// be compared between builds: pruning_steps CASE START. What is to be counted runs in
// `measured_step`; the memory held by the handle and the creep forces are printed. Without
// arguments: which field a scene with each further piece of physics is refused for, if it is.
#include <malloc.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "profiles.hpp"
#include "railpatch.h"

extern "C" [[gnu::noinline]] void measured_step(rp_contact *contact, const rp_input *input,
                                                rp_result *result) {
  if (rp_step(contact, input, result, nullptr) != RP_OK) std::abort();
}

namespace {

// bytes that the C library has handed out
size_t allocated() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

struct scene {
  rp_config config;
  rp_input input, neighbour;
};

scene patch(rp_normal_method normal) {
  scene s;
  rp_default_config(&s.config);
  rp_default_input(&s.input);
  s.config.normal = normal;
  s.config.tangential = RP_TANGENTIAL_FULL;
  s.config.elements[0] = s.config.elements[1] = 24;
  s.input.normal_force = 1e5;
  s.input.creepage[0] = 8e-4;
  s.input.creepage[1] = 3e-4;
  s.input.spin_creepage = 0.1;
  s.neighbour = s.input;
  s.neighbour.creepage[0] *= 1.05;
  s.neighbour.normal_force *= 1.02;
  return s;
}

scene wheel(const profiles::curve &wheel, const profiles::curve &rail) {
  scene s;
  rp_default_config(&s.config);
  rp_default_input(&s.input);
  s.config.kind = RP_WHEEL_RAIL;
  s.config.cant = 0.025;
  s.config.elements[0] = s.config.elements[1] = 0;
  s.config.element_size[0] = s.config.element_size[1] = 1e-3;
  for (int side = 0; side < 2; ++side) {
    s.config.wheel[side] = wheel.view();
    s.config.rail[side] = rail.view();
  }
  s.config.load = RP_FORCE;
  s.input.vertical_force = 8e4;
  s.input.speed = 20.0;
  s.input.pitch_rate = -20.005 / 0.46;
  s.neighbour = s.input;
  s.neighbour.y = 2e-4;
  return s;
}

void add(const char *name, double value) { std::printf("%s %.17g\n", name, value); }

// One field more than a plain scene has.
template <class Change>
void try_to_create(const char *feature, Change &&change) {
  rp_config config = patch(RP_NORMAL_HALF_SPACE).config;
  change(config);
  rp_contact *contact = nullptr;
  rp_message message{};
  const rp_error error = rp_create(&config, &contact, &message);
  std::printf("%s: %s\n", feature, error == RP_OK ? "created" : message.text);
  rp_destroy(contact);
}

void try_physics() {
  try_to_create("plain", [](rp_config &) {});
  try_to_create("regime", [](rp_config &c) { c.regime = RP_SHIFT; });
  try_to_create("regime", [](rp_config &c) { c.regime = RP_TRANSIENT_ROLLING; });
  try_to_create("friction_law", [](rp_config &c) { c.friction_law = RP_SLIP_VELOCITY; });
  try_to_create("layer_yield_stress", [](rp_config &c) { c.layer_yield_stress = 1e8; });
  try_to_create("temperature", [](rp_config &c) { c.temperature = 1; });
  try_to_create("shear_modulus", [](rp_config &c) { c.shear_modulus[1] = 1e9; });
  try_to_create("viscoelastic_ratio", [](rp_config &c) {
    c.geometry = RP_CURVATURES;
    c.curvatures[0] = c.curvatures[1] = 1.0;
    for (int k = 0; k < 2; ++k) {
      c.viscoelastic_ratio[k] = 1.0;
      c.relaxation_time[k] = 1e-3;
    }
  });
  try_to_create("own_influence", [](rp_config &c) {
    static const double distance[9] = {};
    static double coefficients[4][3][4] = {};
    for (int k = 0; k < 3; ++k) coefficients[k][0][0] = 1e-13;
    c.geometry = RP_UNDEFORMED_DISTANCE;
    c.undeformed_distance = distance;
    c.own_influence = 1;
    c.influence_coefficients = coefficients[0][0];
    for (int k = 0; k < 2; ++k) {
      c.distance_shape[k] = 3;
      c.elements[k] = 0;
      c.element_size[k] = 1e-3;
    }
  });
}

}  // namespace

int main(int count, char **arguments) {
  if (count == 1) try_physics();
  if (count != 3) return count == 1 ? EXIT_SUCCESS : EXIT_FAILURE;
  const std::string name = arguments[1];
  const bool warm = std::strcmp(arguments[2], "warm") == 0;
  const profiles::curve on_wheel = profiles::wheel(), on_rail = profiles::rail();
  const scene s = name == "wheel_rail"
                      ? wheel(on_wheel, on_rail)
                      : patch(name == "hertz" ? RP_NORMAL_HERTZ : RP_NORMAL_HALF_SPACE);
  const size_t before = allocated();
  rp_contact *contact = nullptr;
  rp_message message{};
  if (rp_create(&s.config, &contact, &message) != RP_OK) {
    std::fprintf(stderr, "%s\n", message.text);
    return EXIT_FAILURE;
  }
  add("allocated", static_cast<double>(allocated() - before));
  rp_stage_info stages[RP_STAGE_COUNT];
  rp_describe(contact, stages);
  double described = 0;
  for (const auto &stage : stages) described += static_cast<double>(stage.bytes);
  add("described", described);
  rp_result result;
  if (warm && rp_step(contact, &s.neighbour, &result, nullptr) != RP_OK) return EXIT_FAILURE;
  measured_step(contact, &s.input, &result);
  const rp_patch_result &solved = result.side[RP_RIGHT].patch[0];
  add("status", result.status);
  add("newton", solved.newton_iterations);
  for (double force : solved.creep_force) add("force", force);
  rp_destroy(contact);
  return EXIT_SUCCESS;
}
