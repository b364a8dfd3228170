// What every fast theory is given and gives: one form of question and answer, so that the table of
// theories (theories.hpp) has one function for each.
#pragma once

#include "fast/coefficients.hpp"
#include "half_space/physics.hpp"
#include "railpatch.h"
#include "tangential/bound_law.hpp"
#include "tangential/tangential.hpp"

namespace railpatch {

class creep_table;

// Reduction factors of the areas of adhesion and of slip; 1: Kalker's slope.
struct polach_factors {
  double adhesion = 1, slip = 1;
};

struct stiffness_reduction {
  double k0 = 1, alpha = 1, beta = 0;
  double at(double gradient) const {
    return k0 * (beta > 0 ? alpha + (1.0 - alpha) / (1.0 + beta * gradient) : 1.0);
  }
};

// Of all fast theories; each reads what its row says.
struct fast_options {
  rp_tangential_method theory = RP_TANGENTIAL_FASTSIM;
  double coefficient_factor = 1;  // of all creepage coefficients
  rp_traction_bound bound = RP_BOUND_AUTOMATIC;
  rp_flexibility_blending blending = RP_BLENDING_SLIDING;
  polach_factors polach;
  stiffness_reduction reduction;
  const void *creep_table = nullptr;    // the caller's, without defect; of theory table
  physics_part<slip_velocity_law> law;  // in place of Coulomb's, without memory
};

struct flexibilities {
  double l1, l2, l3;  // m/Pa
};

// Ends of the contact in each row, [ny], and the lateral centre, m. The spin's part of the rigid
// slip is scaled by L1/L3 and L2/L3 as it grows from the centre and from each row's middle.
struct row_ends {
  const double *leading, *trailing;
  double centre;
};

// Resultants of theories without tractions.
struct creep_resultants {
  double force[2] = {0, 0};  // N on the wheel
  double moment = 0;         // N m on the wheel, about the reference
  double friction = 0;       // N, frictional power over the rolling speed
  double capacity = 0;       // N, that friction could carry
};

struct fast_problem {
  const elastic_constants &elastic;
  const fast_options &options;
  const creep_table *table;  // of theory table, else null
  const double *axes;        // m [2], of the ellipse that is or stands for the contact
  const double *centre;      // m [2], of that ellipse
  double capacity;           // N, friction coefficient times normal force; of a law the mean one
  creepage_coefficients coefficients;  // of theories that read percent_kalker
  rolling_input at_centre;             // creepages at the ellipse's centre
  // of theories with tractions
  const grid &g;
  const double *pressure, *bound;  // Pa, [ny][nx]
  row_ends rows;
  flexibilities l;
  const rolling_input &rolling;  // creepages at the reference
};

}  // namespace railpatch
