// What the film of a liquid takes of a patch: the ellipse it forms on, its motion, and the rates of
// both (fluid/mixed.hpp).
#pragma once

#include "fluid/mixed.hpp"
#include "normal/hertz.hpp"
#include "patch/patch_memory.hpp"
#include "patch/patch_scene.hpp"

namespace railpatch {

struct patch_variation;

// Hertz's ellipse under the force, or where the surfaces are not quadratic the one whose pressure
// has the same variances along and across rolling.
hertz_contact wet_ellipse(const patch_scene &scene, const patch_problem &problem,
                          const double *pressure, double force);

// Over the semi-axis along rolling: how far ahead of the middle a grid must reach, that the film
// has its inlet on it. From there on Hertz's gap is `full_inlet` times the film, so that what
// stays outside costs the film 1 % or so (measured: docs/ehl.md).
double inlet_reach(const patch_scene &scene, const hertz_contact &hertz, double speed);

double supplied_temperature(const patch_scene &scene);  // degrees C, before the contact

wet_contact film_contact_of(const patch_scene &scene, const patch_problem &problem,
                            const hertz_contact &ellipse);

// Of film and friction in a direction. pressure: its rates, force: of the whole.
film_outcome film_rates_of(const patch_scene &scene, const patch_problem &problem,
                           const patch_memory &memory, const patch_variation &v,
                           const double *pressure, double force);

}  // namespace railpatch
