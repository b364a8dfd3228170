/* The members of the structs of railpatch.h, in order, as lists: what walks over all of them is
 * made from these. What a list forgets does not compile (core/handle/tied_lists.cpp). Plain C11 and
 * C++20 macros.
 *
 * A list calls X for each number and choice, and O for each other member (cookies, pointers,
 * structs), as O(type, name, count). The count is that of all numbers of an array, else 1. Units
 * are SI: "-" is a number without one, "" is no number.
 */
#ifndef RAILPATCH_FIELDS_H
#define RAILPATCH_FIELDS_H

#include <math.h>

#include "railpatch.h"

/* --- results: X(type, name, count, role, mirror, unloaded, sum, start, unit, text) -----------
 * role      status; number: its rate is a derivative's; count: of work or elements, whose rate is
 *           0; label: kept in a derivative; estimate: has no rate
 * mirror    of a wheel on the other side: even: stays; odd: changes sign; vector, axial: as the
 *           components of one, the second of a pair is lateral; origin: of a grid
 * unloaded  where nothing touches: kept; or zero, in every scene or where it has a tangential
 *           problem (zero_rolling) or a layer that yields (zero_plastic); own: set apart
 * sum       of a wheel's patches: by_share; greatest; alone: none. Of wheels: added
 * start     before anything is solved
 */
#define RP_PATCH_RESULT_FIELDS(X, O)                                                              \
  X(rp_status, status, 1, status, even, kept, alone, RP_CONVERGED, "",                            \
    "how the solution of this patch ended")                                                       \
  X(double, normal_force, 1, number, even, zero, alone, NAN, "N", "normal force, >= 0")           \
  X(double, approach, 1, number, even, kept, alone, NAN, "m", "approach of the bodies")           \
  X(double, creep_force, 2, number, vector, zero_rolling, alone, NAN, "N",                        \
    "longitudinal and lateral creep force")                                                       \
  X(double, spin_moment, 1, number, odd, zero_rolling, alone, NAN, "N m",                         \
    "moment about the normal")                                                                    \
  X(double, max_pressure, 1, number, even, zero, alone, NAN, "Pa", "highest contact pressure")    \
  X(double, contact_area, 1, number, even, zero, alone, NAN, "m^2", "area in contact")            \
  X(int32_t, elements, 4, count, even, kept, alone, 0, "-", "the element division, counted")      \
  X(double, max_temperature, 1, number, even, own, greatest, NAN, "degrees C",                    \
    "highest surface temperature")                                                                \
  X(double, friction_power, 1, number, even, zero_rolling, by_share, NAN, "W",                    \
    "power lost in friction, >= 0")                                                               \
  X(double, plastic_power, 1, number, even, zero_plastic, by_share, NAN, "W",                     \
    "power of the layer's plastic displacement, >= 0")                                            \
  X(double, elastic_energy, 1, number, even, zero, by_share, NAN, "J", "elastic energy")          \
  X(int32_t, normal_iterations, 1, count, even, kept, alone, 0, "-",                              \
    "conjugate-gradient steps of the normal problem; evaluations of the fast theories")           \
  X(int32_t, newton_iterations, 1, count, even, kept, alone, 0, "-",                              \
    "Newton steps of the tangential problem")                                                     \
  X(int32_t, inner_iterations, 1, count, even, kept, alone, 0, "-",                               \
    "operator products of the tangential problem")                                                \
  X(int32_t, outer_iterations, 1, count, even, kept, alone, 0, "-",                               \
    "rounds of stages that act on each other")                                                    \
  X(int32_t, ambiguous_elements, 1, count, even, kept, alone, 0, "-",                             \
    "elements whose friction law has further solutions")                                          \
  X(double, residual, 1, estimate, even, kept, greatest, 0, "-", "residual at the end")           \
  X(double, error_estimate, 3, estimate, even, own, alone, NAN, "N, N m, Pa", "estimated errors") \
  X(double, share, 1, number, even, kept, alone, 1, "-",                                          \
    "share of this solution in the wheel's force")                                                \
  X(double, position, 3, number, vector, kept, alone, NAN, "m", "contact reference")              \
  X(double, contact_angle, 1, number, odd, kept, alone, NAN, "rad",                               \
    "rotation about x from track z to the normal")                                                \
  X(double, creepage, 2, number, vector, kept, alone, NAN, "-",                                   \
    "longitudinal and lateral creepage")                                                          \
  X(double, spin_creepage, 1, number, odd, kept, alone, NAN, "rad/m", "spin creepage")            \
  X(double, rolling_speed, 1, number, even, kept, alone, NAN, "m/s",                              \
    "mean speed of the two surfaces along x")                                                     \
  X(int32_t, direction, 1, label, even, kept, alone, 0, "-",                                      \
    "of rolling: 1 or -1; 0 at standstill")                                                       \
  X(int32_t, grid, 2, label, even, kept, alone, 0, "-",                                           \
    "elements of the potential contact along rolling, lateral")                                   \
  X(double, grid_origin, 2, number, origin, kept, alone, 0, "m",                                  \
    "centre of element (0, 0) in the contact frame")                                              \
  X(double, element_size, 2, number, even, kept, alone, 0, "m",                                   \
    "of an element along rolling, lateral")

#define RP_SIDE_RESULT_FIELDS(X, O)                                                      \
  X(rp_status, status, 1, status, even, kept, alone, RP_NO_CONTACT, "",                  \
    "how the solution of this wheel ended")                                              \
  X(double, force, 3, number, vector, kept, added, 0, "N", "contact force on the wheel") \
  X(double, moment, 3, number, axial, kept, added, 0, "N m",                             \
    "its moment about the wheelset's centre")                                            \
  X(double, rolling_radius, 1, number, even, kept, alone, NAN, "m",                      \
    "radius on which the wheel rolls")                                                   \
  X(double, rail_deflection, 2, number, even, kept, alone, NAN, "m",                     \
    "of an elastic rail: lateral, vertical")                                             \
  X(double, rail_deflection_rate, 2, number, even, kept, alone, NAN, "m/s",              \
    "its rate in the step")                                                              \
  X(int32_t, patch_count, 1, label, even, kept, alone, 0, "-", "contact patches")        \
  X(int32_t, alternative_count, 1, label, even, kept, alone, 0, "-",                     \
    "solutions of other divisions into patches")                                         \
  O(rp_patch_result, patch, RP_MAX_PATCHES)

#define RP_RESULT_FIELDS(X, O)                                                                   \
  X(rp_status, status, 1, status, even, kept, alone, RP_CONVERGED, "", "how the solution ended") \
  X(double, z, 1, number, even, kept, alone, NAN, "m", "vertical position of the wheelset")      \
  X(double, force, 3, number, vector, kept, alone, 0, "N", "sum of the wheels' contact forces")  \
  X(double, moment, 3, number, axial, kept, alone, 0, "N m",                                     \
    "their moment about the wheelset's centre")                                                  \
  X(int32_t, evaluations, 1, count, even, kept, alone, 0, "-",                                   \
    "contact evaluations of each wheel spent on finding z")                                      \
  O(rp_side_result, side, 2)

#endif
