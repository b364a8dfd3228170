// What the stages of a patch found in one step.
#pragma once

#include <optional>

#include "half_space/forces.hpp"
#include "normal/row_contact.hpp"
#include "numeric/nan.hpp"
#include "patch/status.hpp"
#include "railpatch.h"

namespace railpatch {

struct pressure_outcome : verdict {
  bool loaded = false;  // the bodies touch
  double normal_force = 0, approach = 0, max_pressure = 0, contact_area = 0;
  double elastic_energy = 0, residual = 0;
  double size[2] = {0, 0};   // m, of the area in contact
  double viscous_power = 0;  // W, of viscoelastic bodies
  int iterations = 0;
  int exterior = 0;                   // elements
  const row_contact *rows = nullptr;  // where the theory knows the ends of the rows
};

struct traction_outcome : verdict {
  bool converged = false;
  double creepage[2] = {0, 0};  // of the components of a prescribed force
  int exterior = 0, stick = 0, slip = 0, plastic = 0, ambiguous = 0;  // elements
  int newton_iterations = 0, inner_iterations = 0;
  int outer_iterations = 0;  // of friction by temperature, and of unlike bodies
  double residual = 0;
  double friction_power = 0;
  double supplied = nan;  // W, by creepages and spin, where steps go on from the last one's
  double plastic_power = nan;
  double viscous_power = 0;  // W, of viscoelastic bodies
  double elastic_energy = 0, coupling_energy = 0;
  double moment = 0, force[2] = {0, 0};  // of theories without tractions
  double capacity = 0;                   // N, that friction could carry
  double max_traction = nan;             // Pa
  // of the tractions along their own rows, where pressure has its part in the creep force
  std::optional<patch_wrench> own;
  double fluid_power = nan;  // W, where the liquid's shear is part of each bound
};

struct heat_outcome {
  bool found = false;
  double max_temperature = 0;  // degrees C
  double heat[2] = {0, 0};     // W, into wheel and rail
};

struct fluid_outcome {
  bool found = false;
  double film_thickness = 0, asperity_share = 1;  // m, -
  double temperature = 0;                         // degrees C
  double friction = 0;                            // -, without factors of the law
  double shear_part = nan;                        // -, of the friction, of the liquid's own shear
  bool converged = true;
};

}  // namespace railpatch
