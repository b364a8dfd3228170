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
  X(double, contact_area, 1, number, even, zero, alone, NAN, "m^2",                               \
    "area in contact; with fluid_model = ehl that of the dry contact")                            \
  X(int32_t, elements, 4, count, even, kept, alone, 0, "-", "the element division, counted")      \
  X(double, max_temperature, 1, number, even, own, greatest, NAN, "degrees C",                    \
    "highest surface temperature of the contact")                                                 \
  X(double, friction_power, 1, number, even, zero_rolling, by_share, NAN, "W",                    \
    "power that friction turns into heat")                                                        \
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
    "of an element along rolling, lateral")                                                       \
  X(double, creep_power, 1, number, even, zero_rolling, by_share, NAN, "W",                       \
    "power that the creepages and the spin supply")                                               \
  X(double, wheel_heat, 1, number, even, own, by_share, NAN, "W", "heat into the wheel")          \
  X(double, rail_heat, 1, number, even, own, by_share, NAN, "W", "heat into the rail or roller")  \
  X(double, pressure_energy, 1, number, even, zero, by_share, NAN, "J",                           \
    "elastic energy of the pressure alone")                                                       \
  X(rp_reason, reason, 1, status, even, kept, alone, RP_REASON_NONE, "",                          \
    "why the status is not good")                                                                 \
  X(double, reason_value, 1, estimate, even, kept, alone, NAN, "-",                               \
    "of what the reason says, in its units")                                                      \
  X(double, central_film_thickness, 1, number, even, kept, alone, NAN, "m",                       \
    "central film of the liquid")                                                                 \
  X(double, mean_asperity_share, 1, number, even, kept, alone, NAN, "-",                          \
    "share of the load that asperities carry")                                                    \
  X(double, fluid_temperature, 1, number, even, kept, alone, NAN, "degrees C",                    \
    "temperature of the liquid")                                                                  \
  X(double, effective_friction, 1, number, even, kept, alone, NAN, "-",                           \
    "friction coefficient with the liquid")                                                       \
  X(double, wear_number, 1, number, even, zero_rolling, by_share, NAN, "N",                       \
    "wear number T gamma: sizes of Fx xi, Fy eta, M phi, added")                                  \
  X(double, traction_coefficient, 1, number, even, kept, alone, NAN, "-",                         \
    "creep force over normal force")                                                              \
  X(double, utilised_friction, 1, number, even, kept, alone, NAN, "-",                            \
    "creep force over what friction could carry")                                                 \
  X(double, max_traction, 1, estimate, even, zero_rolling, alone, NAN, "Pa",                      \
    "greatest traction of an element")                                                            \
  X(double, contact_size, 2, number, even, zero, alone, NAN, "m",                                 \
    "extent of the contact along rolling, lateral")                                               \
  X(double, wheel_profile_position, 2, number, even, kept, alone, NAN, "m",                       \
    "contact reference in the axes of the wheel's profile: y, z")                                 \
  X(double, rail_profile_position, 2, number, even, kept, alone, NAN, "m",                        \
    "contact reference in the axes of the rail's profile: y, z")                                  \
  X(double, fluid_power, 1, number, even, own, by_share, NAN, "W",                                \
    "part of the friction power that the liquid's own shear takes")                               \
  X(double, viscous_power, 1, number, even, own, alone, NAN, "W",                                 \
    "power that viscoelastic bodies turn into heat, beside friction")                             \
  X(double, rolling_resistance_moment, 1, number, even, own, alone, NAN, "N m",                   \
    "moment of the pressure about the lateral axis, against rolling")

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
  O(rp_patch_result, patch, RP_MAX_PATCHES)                                              \
  X(double, contact_power, 1, number, even, kept, added, NAN, "W",                       \
    "power of the force and moment on the wheelset")                                     \
  X(double, creep_power, 1, number, even, kept, added, NAN, "W",                         \
    "power that the creepages and the spin supply, of all patches by share")             \
  X(double, friction_power, 1, number, even, kept, added, NAN, "W",                      \
    "power lost in friction, of all patches by share")                                   \
  X(double, plastic_power, 1, number, even, kept, added, NAN, "W",                       \
    "power of the layer's plastic displacement, of all patches by share")                \
  X(double, elastic_energy, 1, number, even, kept, added, NAN, "J",                      \
    "elastic energy, of all patches by share")                                           \
  X(double, max_temperature, 1, number, even, kept, greatest, NAN, "degrees C",          \
    "highest surface temperature of all contacts")                                       \
  X(double, residual, 1, estimate, even, kept, greatest, 0, "-",                         \
    "greatest residual at the end of all patches")                                       \
  X(double, wheel_heat, 1, number, even, kept, added, NAN, "W",                          \
    "heat into the wheel, of all patches by share")                                      \
  X(double, rail_heat, 1, number, even, kept, added, NAN, "W",                           \
    "heat into the rail or roller, of all patches by share")                             \
  X(double, wheel_temperature, 1, number, even, kept, alone, NAN, "degrees C",           \
    "bulk temperature of the wheel")                                                     \
  X(double, rail_temperature, 1, number, even, kept, alone, NAN, "degrees C",            \
    "bulk temperature of the rail or roller")                                            \
  X(double, pressure_energy, 1, number, even, kept, added, NAN, "J",                     \
    "elastic energy of the pressure alone, of all patches by share")                     \
  X(rp_reason, reason, 1, status, even, kept, alone, RP_REASON_NONE, "",                 \
    "why the status is not good")                                                        \
  X(double, reason_value, 1, estimate, even, kept, alone, NAN, "-",                      \
    "of what the reason says, in its units")                                             \
  X(uint32_t, warnings, 1, status, even, kept, alone, 0, "",                             \
    "what can hardly be meant, though it was solved")                                    \
  X(double, wear_number, 1, number, even, kept, added, NAN, "N",                         \
    "wear number T gamma, of all patches by share")                                      \
  X(double, guiding_force, 1, number, even, kept, alone, NAN, "N",                       \
    "Y: lateral force on the rail, track axes, > 0 outward")                             \
  X(double, wheel_load, 1, number, even, kept, alone, NAN, "N",                          \
    "Q: vertical force on the rail, track axes")                                         \
  X(double, derailment_quotient, 1, number, even, kept, alone, NAN, "-", "Y/Q")          \
  X(double, fluid_power, 1, number, even, kept, added, NAN, "W",                         \
    "power that the liquid's own shear takes, of all patches by share")                  \
  X(double, oxide_water, 1, number, even, kept, alone, NAN, "-",                         \
    "part of the paste's water that drying has left on the wheel")

#define RP_RESULT_FIELDS(X, O)                                                                   \
  X(rp_status, status, 1, status, even, kept, alone, RP_CONVERGED, "", "how the solution ended") \
  X(double, z, 1, number, even, kept, alone, NAN, "m", "vertical position of the wheelset")      \
  X(double, force, 3, number, vector, kept, alone, 0, "N", "sum of the wheels' contact forces")  \
  X(double, moment, 3, number, axial, kept, alone, 0, "N m",                                     \
    "their moment about the wheelset's centre")                                                  \
  X(int32_t, evaluations, 1, count, even, kept, alone, 0, "-",                                   \
    "contact evaluations of each wheel spent on finding z")                                      \
  O(rp_side_result, side, 2)                                                                     \
  X(double, contact_power, 1, number, even, kept, alone, NAN, "W",                               \
    "power of the force and moment on the wheelset")                                             \
  X(double, creep_power, 1, number, even, kept, alone, NAN, "W",                                 \
    "power that the creepages and the spin supply, of all patches by share")                     \
  X(double, friction_power, 1, number, even, kept, alone, NAN, "W",                              \
    "power lost in friction, of all patches by share")                                           \
  X(double, plastic_power, 1, number, even, kept, alone, NAN, "W",                               \
    "power of the layer's plastic displacement, of all patches by share")                        \
  X(double, elastic_energy, 1, number, even, kept, alone, NAN, "J",                              \
    "elastic energy, of all patches by share")                                                   \
  X(double, max_temperature, 1, number, even, kept, alone, NAN, "degrees C",                     \
    "highest surface temperature of all contacts")                                               \
  X(double, residual, 1, estimate, even, kept, alone, 0, "-",                                    \
    "greatest residual at the end of all patches")                                               \
  X(double, wheel_heat, 1, number, even, kept, alone, NAN, "W", "heat into the wheels")          \
  X(double, rail_heat, 1, number, even, kept, alone, NAN, "W", "heat into the rails or rollers") \
  X(double, pressure_energy, 1, number, even, kept, alone, NAN, "J",                             \
    "elastic energy of the pressure alone, of all patches by share")                             \
  X(double, roll, 1, number, odd, kept, alone, NAN, "rad", "roll angle of the wheelset")         \
  X(double, pitch_rate, 1, number, even, kept, alone, NAN, "rad/s", "about the axle")            \
  X(double, axle_torque, 1, number, even, kept, alone, NAN, "N m",                               \
    "torque of the contact forces about the axle")                                               \
  X(rp_reason, reason, 1, status, even, kept, alone, RP_REASON_NONE, "",                         \
    "why the status is not good")                                                                \
  X(double, reason_value, 1, estimate, even, kept, alone, NAN, "-",                              \
    "of what the reason says, in its units")                                                     \
  X(uint32_t, warnings, 1, status, even, kept, alone, 0, "",                                     \
    "what can hardly be meant, though it was solved")                                            \
  X(int32_t, work, 1, count, even, kept, alone, 0, "-", "operator products of all evaluations")  \
  X(double, wear_number, 1, number, even, kept, alone, NAN, "N",                                 \
    "wear number T gamma, of all patches by share")                                              \
  X(double, rolling_radius_difference, 1, number, odd, kept, alone, NAN, "m",                    \
    "of the right wheel minus the left one's")                                                   \
  X(double, conicity, 1, number, even, kept, alone, NAN, "-",                                    \
    "rolling radius difference over twice the lateral position")                                 \
  X(double, fluid_power, 1, number, even, kept, alone, NAN, "W",                                 \
    "power that the liquid's own shear takes, of all patches by share")

/* --- inputs: X(type, name, count, role, where, start, bounds, low, high, unit, text) ---------
 * role      choice: an enumeration; number; integer; side: RP_LEFT or RP_RIGHT; points: numbers of
 *           which another member says how many count; unmarked: no state depends on it
 * where     its range is checked: always, for kind patch, for wheels; own: under a condition
 * start     by default, each number of it
 * bounds    of its range, "[" or "]": the end belongs to it, "(" or ")": it does not; "": none
 */
#define RP_CONFIG_FIELDS(X, O)                                                                     \
  O(uint32_t, cookie, 1)                                                                           \
  X(rp_kind, kind, 1, choice, always, RP_PATCH, "", 0, 0, "", "kind of case")                      \
  X(double, shear_modulus, 2, number, always, 82e9, "[]", 1, 1e15, "Pa", "shear modulus")          \
  X(double, poisson_ratio, 2, number, always, 0.28, "[]", 0, 0.5, "-", "Poisson's ratio")          \
  X(rp_geometry, geometry, 1, choice, patch, RP_SEMI_AXES, "", 0, 0, "",                           \
    "shape of the undeformed bodies")                                                              \
  X(double, semi_axes, 2, number, own, 0.006, "[]", 1e-7, 1, "m",                                  \
    "semi-axes of the contact ellipse [along rolling, lateral]; the curvatures follow from the "   \
    "load")                                                                                        \
  X(double, curvatures, 2, number, own, 1, "[]", 1e-9, 1e6, "1/m",                                 \
    "[c0, c1] of the undeformed distance c0 x^2 + c1 y^2, half the curvatures: along rolling "     \
    "c0 = (1/R_wheel + 1/R_rail)/2, lateral c1 alike; a sphere of 0.4 m on a plane: [1.25, 1.25]") \
  X(double, line_contact_radius, 1, number, own, 0.5, "[]", 1e-6, 1e6, "m",                        \
    "combined radius 1/(1/R_wheel + 1/R_rail) of a line contact")                                  \
  X(double, width, 1, number, own, 1, "[]", 1e-6, 1e3, "m", "width of the line contact")           \
  O(const double *, undeformed_distance, 1)                                                        \
  X(int32_t, distance_shape, 2, integer, own, 0, "[]", 1, 1000, "-",                               \
    "elements of the undeformed distance [along rolling, lateral]")                                \
  X(rp_load, load, 1, choice, always, RP_FORCE, "", 0, 0, "",                                      \
    "whether the force or the position is given")                                                  \
  X(int32_t, elements, 2, integer, own, 24, "[]", 2, 1000, "-",                                    \
    "elements across the contact's bounding box [along rolling, lateral]")                         \
  X(double, element_size, 2, number, own, 0, "[]", 1e-9, 1, "m",                                   \
    "size of an element [along rolling, lateral]")                                                 \
  X(int32_t, max_elements, 2, integer, own, 0, "[]", 0, 1002, "-",                                 \
    "capacity of one patch's grid [along rolling, lateral]")                                       \
  X(int32_t, fitted, 2, integer, own, 0, "[]", 3, 64, "-",                                         \
    "nodes along rolling and rows of the tangential problem (full) on rows fitted to the contact " \
    "area, at most 2304 nodes in all")                                                             \
  X(rp_regime, regime, 1, choice, always, RP_STEADY_ROLLING, "", 0, 0, "", "kind of motion")       \
  X(int32_t, force_prescribed, 2, integer, always, 0, "[]", 0, 1, "-",                             \
    "whether the creep force's component is given and its creepage found [longitudinal, lateral]") \
  X(rp_friction_law, friction_law, 1, choice, always, RP_COULOMB, "", 0, 0, "", "friction law")    \
  X(double, friction_coefficient, 1, number, always, 0.3, "[]", 0, 10, "-",                        \
    "coefficient of Coulomb's law")                                                                \
  X(rp_slip_law, slip_law, 1, choice, always, RP_SLIP_EXPONENTIAL, "", 0, 0, "",                   \
    "shape of the slip-velocity law")                                                              \
  X(double, friction_kinetic, 1, number, always, 0.3, "[]", 0, 10, "-",                            \
    "coefficient of friction at high micro-slip")                                                  \
  X(double, friction_amplitude, 2, number, always, 0, "[]", -10, 10, "-",                          \
    "at rest above kinetic; one or two terms")                                                     \
  X(double, friction_halving_speed, 2, number, always, 1, "()", 0, HUGE_VAL, "m/s",                \
    "at which a term is half its amplitude; one for each term")                                    \
  X(double, friction_memory_distance, 1, number, always, 0, "[]", 0, 1, "m",                       \
    "way slipped (not rolled) over which the coefficient follows the law; 0: at once")             \
  X(double, friction_memory_speed, 1, number, always, 1e-3, "()", 0, HUGE_VAL, "m/s",              \
    "least speed of slip with which it follows the law")                                           \
  X(double, friction_reference, 1, number, always, 0.3, "[]", 0, 10, "-",                          \
    "of the temperature law up to its first temperature")                                          \
  X(double, friction_change, 1, number, own, 0, "", 0, 0, "-",                                     \
    "from there to the end of its range, linear")                                                  \
  X(double, friction_reference_temperature, 1, number, always, 0, "[]", -273.15, 1e4, "degrees C", \
    "where the temperature law begins")                                                            \
  X(double, friction_temperature_range, 1, number, always, 1, "(]", 0, 1e5, "K",                   \
    "over which it changes")                                                                       \
  X(int32_t, friction_points, 1, integer, own, 0, "[]", 2, RP_MAX_POINTS, "-",                     \
    "points of the factor over the place in the patch")                                            \
  X(double, friction_position, RP_MAX_POINTS, points, own, 0, "()", -HUGE_VAL, HUGE_VAL,           \
    "m or rad", "their places")                                                                    \
  X(double, friction_factor, RP_MAX_POINTS, points, own, 0, "[]", 0, 100, "-",                     \
    "factor of the friction law there")                                                            \
  X(int32_t, friction_along_points, 1, integer, own, 0, "[]", 2, RP_MAX_POINTS, "-",               \
    "points of the factor along the track")                                                        \
  X(double, friction_along_position, RP_MAX_POINTS, points, own, 0, "()", -HUGE_VAL, HUGE_VAL,     \
    "m", "their places")                                                                           \
  X(double, friction_along_factor, RP_MAX_POINTS, points, own, 0, "[]", 0, 100, "-",               \
    "factor of the friction law there")                                                            \
  X(double, layer_shear_modulus, 1, number, own, 0, "[]", 1, 1e15, "Pa",                           \
    "shear modulus of the layer")                                                                  \
  X(double, layer_thickness, 1, number, always, 0, "[]", 0, 0.1, "m",                              \
    "thickness of the layer; 0: no elastic layer")                                                 \
  X(double, layer_yield_stress, 1, number, always, 0, "[]", 0, 1e15, "Pa",                         \
    "at which the layer begins to yield; 0: not plastic")                                          \
  X(double, layer_hardening, 1, number, always, 0, "[]", -1e25, 1e25, "Pa/m",                      \
    "slope of the yield stress over the plastic displacement")                                     \
  X(int32_t, hardening_points, 1, integer, own, 0, "[]", 2, RP_MAX_POINTS, "-",                    \
    "points of the yield stress over the plastic displacement")                                    \
  X(double, hardening_displacement, RP_MAX_POINTS, points, own, 0, "()", -HUGE_VAL, HUGE_VAL, "m", \
    "their displacements")                                                                         \
  X(double, hardening_stress, RP_MAX_POINTS, points, own, 0, "[]", 1e-3, 1e15, "Pa",               \
    "yield stress there")                                                                          \
  X(rp_plastic_rule, plastic_rule, 1, choice, always, RP_PLASTIC_PATH, "", 0, 0, "",               \
    "what the yield stress depends on")                                                            \
  X(int32_t, temperature, 1, integer, always, 0, "[]", 0, 1, "-",                                  \
    "whether surface temperatures are computed")                                                   \
  X(double, bulk_temperature, 2, number, always, 0, "[]", -273.15, 1e4, "degrees C",               \
    "bulk temperature where an input has none")                                                    \
  X(int32_t, heat_exchange, 1, integer, always, 0, "[]", 0, 1, "-",                                \
    "whether bodies of unequal bulk temperature may come into contact")                            \
  X(double, conductivity, 2, number, always, 50, "[]", 1e-6, 1e6, "W/(m K)",                       \
    "thermal conductivity")                                                                        \
  X(double, heat_capacity, 2, number, always, 450, "[]", 1e-3, 1e6, "J/(kg K)",                    \
    "specific heat capacity")                                                                      \
  X(double, density, 2, number, always, 7850, "[]", 1e-3, 1e6, "kg/m^3", "density")                \
  X(double, temperature_depth, 1, number, always, 0, "[]", 0, 1, "m",                              \
    "below the surface, where the temperatures are given")                                         \
  X(double, plastic_heat_fraction, 1, number, always, 0.9, "[]", 0, 1, "-",                        \
    "part of the plastic work that heats the surfaces")                                            \
  X(rp_normal_method, normal, 1, choice, always, RP_NORMAL_HALF_SPACE, "", 0, 0, "",               \
    "theory of the normal problem")                                                                \
  X(rp_tangential_method, tangential, 1, choice, always, RP_TANGENTIAL_FULL, "", 0, 0, "",         \
    "theory of the tangential problem")                                                            \
  X(double, tolerance, 1, number, always, 1e-5, "[]", 1e-12, 0.1, "-",                             \
    "relative tolerance of the solvers")                                                           \
  X(int32_t, max_iterations, 1, integer, always, 100, "[]", 1, 100000, "-",                        \
    "most iterations of each solver")                                                              \
  X(rp_spin_offset, spin_offset, 1, choice, always, RP_SPIN_OFFSET_AUTOMATIC, "", 0, 0, "",        \
    "how far upstream of an element its spin term is read, of the way of a step")                  \
  X(rp_reference_surface, reference_surface, 1, choice, always, RP_REFERENCE_PLANE, "", 0, 0, "",  \
    "plane, or curved between wheel and rail")                                                     \
  X(double, percent_kalker, 1, number, always, 100, "(]", 0, 200, "%",                             \
    "of Kalker's creepage coefficients in the fast theories")                                      \
  X(rp_traction_bound, traction_bound, 1, choice, always, RP_BOUND_AUTOMATIC, "", 0, 0, "",        \
    "how the bound of fastsim follows the pressure")                                               \
  X(rp_flexibility_blending, flexibility_blending, 1, choice, always, RP_BLENDING_SLIDING, "", 0,  \
    0, "", "whether flexibilities become one as sliding becomes full")                             \
  X(double, polach_k_a, 1, number, always, 1, "(]", 0, 10, "-",                                    \
    "k_A of polach, reduction of the area of adhesion; 1: Kalker's slope")                         \
  X(double, polach_k_s, 1, number, always, 1, "(]", 0, 10, "-",                                    \
    "k_S of polach, reduction of the area of slip")                                                \
  X(double, fastsim_k0, 1, number, always, 1, "(]", 0, 10, "-",                                    \
    "k0 of modified fastsim, whose stiffness is that of Kalker times k0 (alpha + (1 - alpha)/(1 "  \
    "+ beta e))")                                                                                  \
  X(double, fastsim_alpha, 1, number, always, 1, "[]", 0, 1, "-", "alpha of modified fastsim")     \
  X(double, fastsim_beta, 1, number, always, 0, "[]", 0, 1000, "-", "beta of modified fastsim")    \
  O(const void *, creep_table, 1)                                                                  \
  O(size_t, creep_table_size, 1)                                                                   \
  X(int32_t, derivatives, 1, unmarked, always, 0, "[]", 0, 1, "-",                                 \
    "whether the contact gives derivatives of its last step")                                      \
  X(int32_t, side, 1, side, wheels, RP_RIGHT, "[]", 0, 1, "", "which wheel of a wheelset")         \
  X(double, nominal_radius, 1, number, wheels, 0.46, "[]", 0.01, 10, "m",                          \
    "wheel radius at the profile's z = 0")                                                         \
  X(double, flange_back_distance, 1, number, wheels, 1.36, "[]", 0.01, 10, "m",                    \
    "between the flange backs")                                                                    \
  X(double, flange_back_position, 1, number, wheels, -0.07, "[]", -1, 1, "m",                      \
    "of the flange back on the profile's y axis: -0.070 for S1002")                                \
  X(rp_track, track, 1, choice, wheels, RP_RAIL, "", 0, 0, "", "rails or rollers")                 \
  X(double, gauge, 1, number, wheels, 1.435, "[]", 0.01, 10, "m", "track gauge")                   \
  X(double, gauge_height, 1, number, wheels, 0.014, "[]", 0, 0.1, "m",                             \
    "height below the rail's top at which the gauge is measured")                                  \
  X(double, gauge_widening, 1, number, wheels, 0, "[]", -0.1, 0.1, "m",                            \
    "each rail lies half of it further out than the gauge says")                                   \
  X(double, cant, 1, number, wheels, 0, "[]", -0.5, 0.5, "rad",                                    \
    "inclination of both rails towards the track's centre (rail)")                                 \
  X(double, curvature, 1, number, wheels, 0, "[]", -0.1, 0.1, "1/m",                               \
    "right-hand curve above 0 (rail)")                                                             \
  X(double, roller_radius, 1, number, own, 1, "[]", 0.01, 100, "m",                                \
    "roller radius at the profile's z = 0 (roller)")                                               \
  O(rp_profile, wheel, 2)                                                                          \
  O(rp_profile, rail, 2)                                                                           \
  X(int32_t, max_patches, 1, integer, wheels, RP_MAX_PATCHES, "[]", 1, RP_MAX_PATCHES, "-",        \
    "capacity: most patches of one wheel")                                                         \
  X(rp_patch_rule, patch_rule, 1, choice, always, RP_PATCHES_BLENDED, "", 0, 0, "",                \
    "how neighbouring areas of contact go over from one patch to two")                             \
  X(rp_contact_frame, contact_frame, 1, choice, always, RP_FRAME_TRACK, "", 0, 0, "",              \
    "x of the contact along the track or along the roller's surface")                              \
  X(double, standstill_speed, 1, number, wheels, 1e-3, "[]", 0, 1, "m/s",                          \
    "of wheels: rolling speed below which creepages tend to finite values, so that forces pass "   \
    "through standstill without a jump; 0: slip over speed, nothing at rest")                      \
  O(const rp_profile *, rail_sections, 2)                                                          \
  O(const double *, section_position, 2)                                                           \
  X(int32_t, section_count, 2, integer, wheels, 0, "[]", 0, 100000, "-",                           \
    "profiles of each rail along the track")                                                       \
  X(double, rail_stiffness, 2, number, wheels, 0, "[]", 0, 1e15, "N/m",                            \
    "of each rail, lateral and vertical; 0: rigid in this direction")                              \
  X(double, rail_damping, 2, number, wheels, 0, "[]", 0, 1e15, "N s/m",                            \
    "of each rail, lateral and vertical")                                                          \
  O(const double *, runout, 2)                                                                     \
  X(int32_t, runout_count, 2, integer, own, 0, "[]", 8, 1000000, "-",                              \
    "values of each wheel's runout; 0: round")                                                     \
  O(const double *, rail_height, 2)                                                                \
  X(int32_t, rail_height_count, 2, integer, own, 0, "[]", 4, 10000000, "-",                        \
    "values of each rail's height; 0: level")                                                      \
  X(double, rail_height_start, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, "m",               \
    "along the track, of the first height")                                                        \
  X(double, rail_height_spacing, 1, number, wheels, 1e-3, "[]", 1e-6, 1e3, "m",                    \
    "along the track, between two heights")                                                        \
  O(rp_observer, observer, 1)                                                                      \
  O(void *, observer_user, 1)                                                                      \
  X(double, bulk_mass, 2, number, always, 0, "[]", 0, 1e9, "kg",                                   \
    "that the contacts' heat warms, of each wheel and its rail or roller; 0: the bulk "            \
    "temperature "                                                                                 \
    "stays as given")                                                                              \
  X(double, air_conductance, 2, number, always, 0, "[]", 0, 1e9, "W/K",                            \
    "of such a body's surface to the air")                                                         \
  X(double, air_temperature, 1, number, always, 20, "[]", -273.15, 1e4, "degrees C", "of the air") \
  X(double, accuracy, 1, number, always, 0, "[]", 0, 1, "-",                                       \
    "error estimate of the creep force over friction coefficient times normal force above which "  \
    "a step goes on to a finer grid; 0: none")                                                     \
  X(int32_t, finer_grids, 1, integer, always, 0, "[]", 0, 8, "-",                                  \
    "grids that steps may go on to, with accuracy")                                                \
  X(int32_t, roll_balanced, 1, integer, always, 0, "[]", 0, 1, "-",                                \
    "whether the roll angle is found at which the contact forces have no roll moment")             \
  X(int32_t, axle_free, 1, integer, always, 0, "[]", 0, 1, "-",                                    \
    "whether the pitch rate is found at which the contact forces have no torque about the axle")   \
  O(rp_interrupt, interrupt, 1)                                                                    \
  O(void *, interrupt_user, 1)                                                                     \
  X(int32_t, max_work, 1, integer, always, 0, "[]", 0, 1000000000, "-",                            \
    "operator products of a step after which no further height is tried for the vertical force; "  \
    "each patch solved counts 1 and its iterations")                                               \
  X(rp_fluid_model, fluid_model, 1, choice, always, RP_FLUID_NONE, "", 0, 0, "",                   \
    "liquid between wheel and rail")                                                               \
  X(rp_fluid_share, fluid_share, 1, choice, always, RP_SHARE_FILM_RATIO, "", 0, 0, "",             \
    "how the share of the load that asperities carry is found")                                    \
  X(double, fluid_roughness, 1, number, always, 1e-6, "[]", 1e-9, 1e-3, "m",                       \
    "combined standard deviation of both surfaces' heights")                                       \
  X(double, fluid_boundary_friction, 1, number, own, NAN, "[]", 0, 10, "-",                        \
    "of asperities that the liquid wets; left out: that of dry ones")                              \
  X(double, fluid_hardness, 1, number, always, 2.8e9, "[]", 1e6, 1e12, "Pa",                       \
    "hardness of the softer body")                                                                 \
  X(double, fluid_mean_pressure, 1, number, always, 6e8, "[]", 0, 1e12, "Pa",                      \
    "nominal pressure that load_sharing finds shares with; 0: that of the contact")                \
  X(rp_liquid, fluid_liquid, 1, choice, always, RP_LIQUID_GIVEN, "", 0, 0, "",                     \
    "which liquid, for its viscosity over temperature")                                            \
  X(double, fluid_viscosity, 1, number, always, 1e-3, "[]", 1e-7, 1e6, "Pa s",                     \
    "viscosity of the liquid")                                                                     \
  X(double, fluid_reference_temperature, 1, number, always, 40, "[]", -100, 400, "degrees C",      \
    "at which an oil has its viscosity")                                                           \
  X(double, fluid_roelands_slope, 1, number, always, 1.1, "[]", 0, 10, "-",                        \
    "S_0 of Roelands' equation; assumed where left out")                                           \
  X(int32_t, fluid_viscosity_points, 1, integer, own, 0, "[]", 2, RP_MAX_POINTS, "-",              \
    "points of the viscosity over temperature")                                                    \
  X(double, fluid_viscosity_temperature, RP_MAX_POINTS, points, own, 0, "()", -HUGE_VAL, HUGE_VAL, \
    "degrees C", "their temperatures")                                                             \
  X(double, fluid_viscosity_value, RP_MAX_POINTS, points, own, 0, "[]", 1e-7, 1e6, "Pa s",         \
    "viscosity there")                                                                             \
  X(double, fluid_pressure_coefficient, 1, number, always, 5e-10, "[]", 0, 1e-6, "1/Pa",           \
    "alpha of the viscosity's growth by exp(alpha p)")                                             \
  X(double, fluid_inlet_conductivity, 1, number, always, 0, "[]", 0, 1e3, "W/(m K)",               \
    "thermal conductivity of the liquid, whose shear in the inlet heats it; 0: it does not")       \
  X(double, fluid_starvation, 1, number, always, 1, "(]", 0, 1, "-",                               \
    "factor of the film by starvation; 1: flooded")                                                \
  X(double, fluid_eyring_stress, 1, number, always, 0, "[]", 0, 1e12, "Pa",                        \
    "Eyring stress of the liquid's own friction; 0: it has none")                                  \
  X(double, fluid_limiting_friction, 1, number, always, 0.07, "[]", 0, 10, "-",                    \
    "coefficient that the liquid's own friction does not exceed; assumed where left out")          \
  X(double, fluid_oxide_content, 1, number, always, 0, "[]", 0, 1, "-",                            \
    "share of solids in the liquid's volume")                                                      \
  X(double, fluid_oxide_exponent, 1, number, always, 10, "[]", 0, 100, "-",                        \
    "of the viscosity's growth by exp(exponent content); assumed where left out")                  \
  X(double, fluid_temperature, 1, number, own, NAN, "[]", -50, 350, "degrees C",                   \
    "of the liquid before the contact")                                                            \
  X(double, fluid_water_rate, 1, number, own, NAN, "[]", 0, 1, "m^3/s",                            \
    "of the liquid, spread over the width of the contact; left out: flooded")                      \
  X(double, fluid_oil_film, 1, number, own, NAN, "[]", 0, 1, "m",                                  \
    "layer of the liquid on the surfaces before the contact; left out: flooded")                   \
  X(int32_t, fluid_knots, 1, integer, own, 0, "[]", 2, RP_MAX_KNOTS, "-",                          \
    "knots of Polach's parameters over the water rate")                                            \
  X(double, fluid_knot_rate, RP_MAX_KNOTS, points, own, 0, "[]", 0, 1, "m^3/s", "their rates")     \
  X(double, fluid_knot_k_a, RP_MAX_KNOTS, points, own, 0, "(]", 0, 10, "-", "k_A there")           \
  X(double, fluid_knot_k_s, RP_MAX_KNOTS, points, own, 0, "(]", 0, 10, "-", "k_S there")           \
  X(double, fluid_knot_coefficient, RP_MAX_KNOTS, points, own, 0, "[]", 0, 10, "-",                \
    "coefficient of friction at rest there")                                                       \
  X(double, fluid_knot_a, RP_MAX_KNOTS, points, own, 0, "[]", 0, 1, "-",                           \
    "A of Polach's law there, friction at high slip over at rest")                                 \
  X(double, fluid_knot_b, RP_MAX_KNOTS, points, own, 0, "[]", 0, 1e6, "s/m",                       \
    "B of Polach's law there")                                                                     \
  X(double, fluid_reference_rate, 1, number, always, 1e-9, "(]", 0, 1, "m^3/s",                    \
    "q0: forces are interpolated over ln(rate + q0); assumed where left out")                      \
  X(double, fluid_recovery, 1, number, always, 0, "[]", 0, 1e6, "1/N",                             \
    "tau: work W of friction on each metre cleans by 1 - exp(-tau W); 0: nothing recovers")        \
  X(rp_section_match, section_match, 1, choice, wheels, RP_SECTIONS_BY_SHARE, "", 0, 0, "",        \
    "which knots of profiles along the track or round the wheel belong together")                  \
  X(rp_section_blend, section_blend, 1, choice, wheels, RP_SECTIONS_LINEAR, "", 0, 0, "",          \
    "how knots go over from one section to the next")                                              \
  O(const rp_profile *, wheel_sections, 2)                                                         \
  O(const double *, wheel_section_angle, 2)                                                        \
  X(int32_t, wheel_section_count, 2, integer, wheels, 0, "[]", 0, 100000, "-",                     \
    "profiles of each wheel round it")                                                             \
  X(double, rail_origin_y, 2, number, own, NAN, "[]", -10, 10, "m",                                \
    "of each rail's profile in track axes; left out: gauge and the rail's top say where it lies")  \
  X(double, rail_origin_z, 2, number, own, NAN, "[]", -1, 1, "m",                                  \
    "of each rail's profile in track axes")                                                        \
  O(const int32_t *, section_kink, 2)                                                              \
  O(const int32_t *, wheel_section_kink, 2)                                                        \
  X(int32_t, regime_changes, 1, integer, always, 0, "[]", 0, 1, "-",                               \
    "whether a step may have another regime than the last one, from whose tractions it goes on")   \
  X(int32_t, longitudinal_prescribed, 1, integer, always, 0, "[]", 0, 1, "-",                      \
    "whether the pitch rate is that at which the longitudinal force is the one given")             \
  X(int32_t, slip_by_element, 1, integer, always, 0, "[]", 0, 1, "-",                              \
    "whether steps read a rigid slip of each element")                                             \
  X(double, fluid_drying_time, 1, number, always, 0, "[]", 0, 1e12, "s",                           \
    "in which the paste's water falls to 1/e; 0: it does not dry by time")                         \
  X(double, fluid_drying_work, 1, number, always, 0, "[]", 0, 1e15, "J/m",                         \
    "of friction on each metre of the circumference, by which the paste's water falls to 1/e; 0: " \
    "it does not dry by work")                                                                     \
  X(double, viscoelastic_ratio, 2, number, always, 0, "[]", 0, 1e4, "-",                           \
    "of viscoelastic bodies: what they yield in time over their elastic strain; 0: elastic")       \
  X(double, relaxation_time, 2, number, always, 0, "[]", 0, 1e6, "s",                              \
    "of viscoelastic bodies, at constant stress; 0 of elastic ones")                               \
  X(int32_t, own_influence, 1, integer, always, 0, "[]", 0, 1, "-",                                \
    "whether influence coefficients are given in place of the half-space's")                       \
  O(const double *, influence_coefficients, 1)

/* X(type, name, count, role, where, start, bounds, low, high, scale, unit, text), as above and
 * role      place: a number whose size says nothing about how fast things change there
 * scale     what changes it by a good part of what matters, of numbers that are zero at rest; 0:
 *           its own size
 */
#define RP_INPUT_FIELDS(X, O)                                                                      \
  O(uint32_t, cookie, 1)                                                                           \
  X(double, normal_force, 1, number, own, 1e5, "[)", 0, HUGE_VAL, 0, "N",                          \
    "normal force; 0: without contact")                                                            \
  X(double, approach, 1, number, own, 0, "()", -HUGE_VAL, HUGE_VAL, 0, "m",                        \
    "approach of the bodies; below 0 they are apart")                                              \
  X(double, creepage, 2, number, patch, 0, "()", -HUGE_VAL, HUGE_VAL, 1e-3, "-",                   \
    "[longitudinal, lateral], wheel minus rail over the rolling speed")                            \
  X(double, tangential_force, 2, number, patch, 0, "()", -HUGE_VAL, HUGE_VAL, 0, "N",              \
    "[longitudinal, lateral] on the wheel, where the creep force is prescribed")                   \
  X(double, spin_creepage, 1, number, patch, 0, "()", -HUGE_VAL, HUGE_VAL, 0.1, "rad/m",           \
    "spin creepage; with shift rad, the rotation")                                                 \
  X(double, rolling_speed, 1, number, patch, 10, "[)", 0, HUGE_VAL, 0, "m/s", "rolling speed")     \
  X(int32_t, direction, 1, integer, own, 1, "", 0, 0, 0, "-",                                      \
    "rolling towards +x (1) or towards -x (-1)")                                                   \
  X(double, bulk_temperature, 2, number, own, NAN, "[]", -273.15, 1e4, 10, "degrees C",            \
    "bulk temperature of wheel and rail")                                                          \
  X(double, distance, 1, number, own, 0, "()", 0, HUGE_VAL, 0, "m",                                \
    "rolled in this step with transient_rolling")                                                  \
  X(double, x, 1, place, wheels, 0, "[]", -1e9, 1e9, 1e-3, "m",                                    \
    "position along the track, for what varies along it")                                          \
  X(double, pitch, 1, place, wheels, 0, "[]", -1e9, 1e9, 1e-3, "rad",                              \
    "about the axle, for what varies around the wheels")                                           \
  X(double, y, 1, number, wheels, 0, "[]", -1, 1, 1e-3, "m",                                       \
    "lateral position of its centre, to the right")                                                \
  X(double, z, 1, number, own, 0, "[]", -1, 1, 1e-4, "m", "vertical position of its centre, down") \
  X(double, vertical_force, 1, number, own, 1e5, "[)", 0, HUGE_VAL, 0, "N",                        \
    "vertical force on the wheel (wheel_rail) or on both wheels together (wheelset); z is then "   \
    "found; 0: the wheels just touch, without contact")                                            \
  X(double, roll, 1, number, wheels, 0, "[]", -1.5, 1.5, 1e-4, "rad", "about x")                   \
  X(double, yaw, 1, number, wheels, 0, "[]", -1.5, 1.5, 1e-3, "rad", "about z")                    \
  X(double, speed, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 1, "m/s",                      \
    "forward speed; 0 on a rig")                                                                   \
  X(double, vy, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 0.01, "m/s", "lateral speed")     \
  X(double, vz, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 0.01, "m/s", "vertical speed")    \
  X(double, roll_rate, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 0.01, "rad/s", "about x")  \
  X(double, yaw_rate, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 0.01, "rad/s", "about z")   \
  X(double, pitch_rate, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 1, "rad/s",               \
    "about the axle; below 0 for rolling forward")                                                 \
  X(double, wheel_offset, 2 * 3, number, wheels, 0, "[]", -1, 1, 1e-4, "m",                        \
    "of each wheel from the rigid wheelset, along x, y, z")                                        \
  X(double, wheel_rotation, 2 * 3, number, wheels, 0, "[]", -1.5, 1.5, 1e-3, "rad",                \
    "of each wheel from the rigid wheelset, about x, y, z")                                        \
  X(double, rail_offset, 2 * 3, number, wheels, 0, "[]", -1, 1, 1e-4, "m",                         \
    "of each rail from its design position, along x, y, z")                                        \
  X(double, rail_rotation, 2 * 3, number, wheels, 0, "[]", -1.5, 1.5, 1e-3, "rad",                 \
    "of each rail from its design position, about x")                                              \
  X(double, wheel_velocity, 2 * 3, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 0.01, "m/s",      \
    "rate of wheel_offset")                                                                        \
  X(double, wheel_angular_velocity, 2 * 3, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 0.01,     \
    "rad/s", "rate of wheel_rotation")                                                             \
  X(double, rail_velocity, 2 * 3, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 0.01, "m/s",       \
    "rate of rail_offset")                                                                         \
  X(double, rail_angular_velocity, 2 * 3, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 0.01,      \
    "rad/s", "rate of rail_rotation")                                                              \
  X(double, time_step, 1, number, own, 0, "[)", 0, HUGE_VAL, 1e-3, "s",                            \
    "since the last step, for rails on dampers (0: at rest), transient rolling (> 0) and bodies "  \
    "that "                                                                                        \
    "store heat")                                                                                  \
  X(double, roller_pitch_rate, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 1, "rad/s",        \
    "about the roller's axle, above 0 forward (roller)")                                           \
  X(double, friction_coefficient, 1, number, own, 0, "", 0, 0, 0.1, "-",                           \
    "rate of the coefficient of Coulomb's law, of a direction only")                               \
  X(double, water_rate, 1, number, own, NAN, "[]", 0, 1, 1e-8, "m^3/s",                            \
    "of the liquid between wheel and rail")                                                        \
  X(double, water_temperature, 1, number, own, NAN, "[]", -50, 350, 10, "degrees C",               \
    "of the liquid between wheel and rail")                                                        \
  X(double, oil_film, 1, number, own, NAN, "[]", 0, 1, 1e-6, "m",                                  \
    "layer of the liquid on the surfaces before the contact")                                      \
  X(double, rail_work, 2, number, own, 0, "[)", 0, HUGE_VAL, 100, "J/m",                           \
    "friction work that wheels before have spent on each metre of the rail")                       \
  X(double, friction_scale, 2, number, own, 1, "[]", 0, 100, 0.1, "-",                             \
    "factor of the friction law on each wheel, [left, right]; of a patch the second")              \
  X(int32_t, step_regime, 1, integer, own, -1, "", 0, 0, 0, "-",                                   \
    "regime of this step where it may change; -1: the case's")                                     \
  X(double, axle_torque, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 100, "N m",              \
    "of the contact forces about the axle, where the pitch rate is found; above 0: a drive")       \
  X(double, longitudinal_force, 1, number, wheels, 0, "()", -HUGE_VAL, HUGE_VAL, 100, "N",         \
    "of the contact forces along the track, on the wheel or on both, where the pitch rate is "     \
    "found")                                                                                       \
  O(const double *, slip_field, 1)

/* --- choices: Y(type, list of the type's enumerators) -------------------------------------- */
#define RP_CHOICES(Y)                                  \
  Y(rp_side, RP_SIDES)                                 \
  Y(rp_status, RP_STATUSES)                            \
  Y(rp_kind, RP_KINDS)                                 \
  Y(rp_geometry, RP_GEOMETRIES)                        \
  Y(rp_load, RP_LOADS)                                 \
  Y(rp_regime, RP_REGIMES)                             \
  Y(rp_friction_law, RP_FRICTION_LAWS)                 \
  Y(rp_slip_law, RP_SLIP_LAWS)                         \
  Y(rp_plastic_rule, RP_PLASTIC_RULES)                 \
  Y(rp_normal_method, RP_NORMAL_METHODS)               \
  Y(rp_tangential_method, RP_TANGENTIAL_METHODS)       \
  Y(rp_traction_bound, RP_TRACTION_BOUNDS)             \
  Y(rp_flexibility_blending, RP_FLEXIBILITY_BLENDINGS) \
  Y(rp_spin_offset, RP_SPIN_OFFSETS)                   \
  Y(rp_patch_rule, RP_PATCH_RULES)                     \
  Y(rp_contact_frame, RP_CONTACT_FRAMES)               \
  Y(rp_section_match, RP_SECTION_MATCHES)              \
  Y(rp_section_blend, RP_SECTION_BLENDS)               \
  Y(rp_reference_surface, RP_REFERENCE_SURFACES)       \
  Y(rp_track, RP_TRACKS)                               \
  Y(rp_fluid_model, RP_FLUID_MODELS)                   \
  Y(rp_fluid_share, RP_FLUID_SHARES)                   \
  Y(rp_liquid, RP_LIQUIDS)                             \
  Y(rp_element, RP_ELEMENTS)                           \
  Y(rp_stage, RP_STAGES)                               \
  Y(rp_field, RP_FIELDS)                               \
  Y(rp_derivative_kind, RP_DERIVATIVE_KINDS)

/* X(name, low, high): numbers of the configuration or the input that can hardly be meant outside of
 * this range, which warnings tell (RP_WARNINGS, whose texts name them). */
#define RP_PLAUSIBLE_RANGES(X)                 \
  X(shear_modulus, 1e8, 1e12)                  \
  X(friction_coefficient, 0.0, 1.0)            \
  X(normal_force, 100.0, 5e5)                  \
  X(creepage, -0.1, 0.1)                       \
  X(spin_creepage, -20.0, 20.0)                \
  X(layer_shear_modulus, 1e6, 1e12)            \
  X(layer_yield_stress, 1e4, 1e10)             \
  X(bulk_temperature, -60.0, 250.0)            \
  X(air_temperature, -60.0, 250.0)             \
  X(fluid_temperature, -60.0, 250.0)           \
  X(fluid_reference_temperature, -60.0, 250.0) \
  X(fluid_water_rate, 0.0, 1e-3)               \
  X(fluid_oil_film, 0.0, 5e-4)                 \
  X(fluid_roughness, 0.0, 5e-5)                \
  X(fluid_viscosity, 1e-4, 100.0)              \
  X(fluid_eyring_stress, 1e5, 1e9)             \
  X(fluid_hardness, 1e8, 1e11)                 \
  X(friction_halving_speed, 1e-5, 100.0)       \
  X(friction_memory_distance, 0.0, 0.02)       \
  X(y, -0.025, 0.025)

#endif
