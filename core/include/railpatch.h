/* Railpatch: wheel-rail contact mechanics, C interface. Its structs as lists: railpatch_fields.h.
 *
 * Life cycle: rp_default_config -> rp_create -> (rp_default_input once) rp_step ... -> rp_destroy.
 * rp_create is the only call that allocates, but for the threads of rp_step_many; rp_step allocates
 * nothing, keeps no time of day, prints nothing and touches no global. Different handles may be
 * used on different threads at once; one handle is used by one thread at a time. Equal inputs after
 * equal histories give equal bits.
 *
 * Units: SI throughout (m, N, Pa, rad, s, W, J). Frames and signs (right-handed everywhere):
 *   track frame    x forward along the track centre line, y right, z down; origin in the plane on
 *                  the rails' (rollers') tops. Forward rolling means wheelset pitch_rate < 0 and
 *                  roller pitch rate > 0.
 *   contact frame  origin on the rail surface at the contact reference, x along rolling (track x),
 *                  s lateral along the surface, n the normal pointing down into the rail; the
 *                  contact angle turns about x from track z to n.
 *   forces         act on the wheel; creepages are wheel minus rail over the rolling speed, so a
 *                  positive creepage gives a negative creep force.
 * Index [2] of material data is {wheel, rail}; of sides {RP_LEFT, RP_RIGHT}; of grids and patch
 * vectors {along rolling, lateral}. Left profiles are given as right ones (flange/gauge side at
 * negative y); the core mirrors.
 */
#ifndef RAILPATCH_H
#define RAILPATCH_H

#include <stddef.h>
#include <stdint.h>

#if defined(RP_INSIDE) /* part of another library, which does not export it */
#define RP_API
#elif defined(_WIN32)
#if defined(RP_BUILD)
#define RP_API __declspec(dllexport)
#elif defined(RP_SHARED)
#define RP_API __declspec(dllimport)
#else
#define RP_API
#endif
#else
#define RP_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define RP_VERSION "0.1.0"

enum {
  RP_MAX_PATCHES = 6,
  RP_MESSAGE_SIZE = 320,
  RP_MAX_POINTS = 32,
  RP_MAX_KNOTS = 8,      /* of RP_FLUID_REGIMES */
  RP_ERROR_FEATURES = 23 /* of RP_FIELD_ERROR_FEATURES */
};

/* --- errors: the call was wrong, outputs are untouched ------------------------------------- */
#define RP_ERRORS(X)                                                          \
  X(RP_OK, 0, "ok")                                                           \
  X(RP_ERROR_NULL, 1, "a required pointer is null")                           \
  X(RP_ERROR_NOT_DEFAULTED, 2, "the struct was never filled by rp_default_*") \
  X(RP_ERROR_VALUE, 3, "a value is outside its allowed range")                \
  X(RP_ERROR_PROFILE, 4, "a profile is not usable")                           \
  X(RP_ERROR_MEMORY, 5, "out of memory")                                      \
  X(RP_ERROR_STATE, 6, "the state buffer does not fit this handle")           \
  X(RP_ERROR_NO_FIELD, 7, "the field does not exist in this scene")           \
  X(RP_ERROR_SIZE, 8, "the buffer is too small")                              \
  X(RP_ERROR_INTERNAL, 9, "internal error")                                   \
  X(RP_ERROR_INTERRUPTED, 10, "interrupted")

/* --- solve status: the call was right, this is how the solve ended ------------------------- */
#define RP_STATUSES(X)                                                                          \
  X(RP_CONVERGED, 0, "converged")                                                               \
  X(RP_NO_CONTACT, 1, "no_contact")                                                             \
  X(RP_NOT_CONVERGED, 2, "not_converged")                                                       \
  X(RP_OUT_OF_RANGE, 3, "out_of_range")                                                         \
  /* solved, but the creep force's error estimate is above config.accuracy, or there is none */ \
  X(RP_ACCURACY_NOT_MET, 4, "accuracy_not_met")                                                 \
  /* config.max_work was spent: the result of the height that came nearest to the force */      \
  X(RP_WORK_SPENT, 5, "work_spent")

/* --- why a result is not good, or has no contact though it was asked for; reason_value is of what
 * the text says, NaN where it says nothing ---------------------------------------------------- */
#define RP_REASONS(X)                                                                          \
  X(RP_REASON_NONE, 0, "")                                                                     \
  X(RP_REASON_NORMAL_ITERATIONS, 1,                                                            \
    "the normal problem's residual is still above the tolerance after the allowed "            \
    "iterations: greater method.max_iterations or method.tolerance")                           \
  X(RP_REASON_BORDER, 2,                                                                       \
    "the contact reaches the border of its grid: a larger grid, or a smaller load")            \
  X(RP_REASON_TRACTION_ITERATIONS, 3,                                                          \
    "the tractions' residual is still above the tolerance after the allowed iterations: "      \
    "greater method.max_iterations or method.tolerance, smaller steps")                        \
  X(RP_REASON_THEORY, 4,                                                                       \
    "the contact's ratio of axes a/b is outside the range of the tangential theory: "          \
    "another method.tangential")                                                               \
  X(RP_REASON_LINEAR, 5,                                                                       \
    "the linear theory's creep force, over what friction can carry, is above 1: smaller "      \
    "creepages, or another method.tangential")                                                 \
  X(RP_REASON_PRESCRIBED_FORCE, 6,                                                             \
    "no creepage was found that gives the prescribed tangential force: a smaller force")       \
  X(RP_REASON_HEAT_LOOP, 7,                                                                    \
    "friction and temperature do not agree, by the residual: finer elements, a friction "      \
    "that changes more gently with temperature")                                               \
  X(RP_REASON_COUPLING, 8,                                                                     \
    "pressure and tractions of unlike bodies do not agree, by the residual: greater "          \
    "method.max_iterations")                                                                   \
  X(RP_REASON_FORCE_SEARCH, 9,                                                                 \
    "no height z was found that carries the vertical force, by the relative residual: "        \
    "look at the profiles for steps, or prescribe wheelset.z")                                 \
  X(RP_REASON_TOO_DEEP, 10,                                                                    \
    "no height z within reach carries the vertical force, by the relative residual: a "        \
    "smaller wheelset.vertical_force, stiffer material")                                       \
  X(RP_REASON_NO_OVERLAP, 11,                                                                  \
    "at no height would wheel and rail meet: their profiles lie side by side, see "            \
    "wheelset.y, track.gauge and wheelset.flange_back_distance")                               \
  X(RP_REASON_RAIL_SEARCH, 12,                                                                 \
    "no deflection of the rails balances the contact forces, by the relative residual: "       \
    "smaller steps, stiffer rails")                                                            \
  X(RP_REASON_RAIL_BEYOND, 13,                                                                 \
    "the rails' deflection leads to where a contact force is not known: stiffer rails, a "     \
    "smaller load")                                                                            \
  X(RP_REASON_PROFILE_END, 14,                                                                 \
    "the contact reaches the end of a profile, at this lateral position (m, track): "          \
    "profiles that go on, or another wheelset.y")                                              \
  X(RP_REASON_TOO_MANY_PATCHES, 15,                                                            \
    "the wheel has more patches than it may have: greater wheelset.max_patches, smoother "     \
    "profiles")                                                                                \
  X(RP_REASON_GRID_ROOM, 16,                                                                   \
    "the contact asks for more elements than there is room for: greater grid.max_elements"     \
    " or element_size, or grid.elements")                                                      \
  X(RP_REASON_NO_GRID, 17,                                                                     \
    "no grid covers the contact, which is as narrow as a line or too far off its "             \
    "reference")                                                                               \
  X(RP_REASON_BULK_TEMPERATURE, 18,                                                            \
    "a bulk temperature leaves its range: a greater mass or conductance, shorter steps")       \
  X(RP_REASON_ACCURACY, 19,                                                                    \
    "the creep force's error estimate, over friction times normal force, stays above the "     \
    "accuracy on the finest grid")                                                             \
  X(RP_REASON_NO_ESTIMATE, 20,                                                                 \
    "the creep force has no error estimate that could meet the accuracy")                      \
  X(RP_REASON_DERIVATIVE, 21, "the derivative's equations were not solved to their tolerance") \
  X(RP_REASON_BALANCE, 22,                                                                     \
    "no roll angle or pitch rate was found that balances the wheelset, by the relative "       \
    "residual: another wheelset.y or load, or a number for wheelset.roll or pitch_rate")       \
  X(RP_REASON_WORK, 23,                                                                        \
    "method.max_work was spent before a height z was found that carries the vertical force, "  \
    "by the relative residual: smaller steps, or greater method.max_work")                     \
  X(RP_REASON_FLUID, 24,                                                                       \
    "the liquid's pressure was not found in each row of the contact: finer elements")          \
  X(RP_REASON_TORQUE, 25,                                                                      \
    "wheelset.axle_torque is greater than what friction can carry (N m): a smaller torque, "   \
    "a greater load or friction")                                                              \
  X(RP_REASON_DRIVEN_FORCE, 26,                                                                \
    "wheelset.longitudinal_force is greater than what friction can carry (N): a smaller "      \
    "force, a greater load or friction")

/* --- warnings: bits of what can hardly be meant. X(name, value, text): the bit is 1 << value ---
 */
#define RP_WARNINGS(X)                                                                             \
  X(RP_WARNING_STIFFNESS, 0, "shear_modulus is outside 1e8 to 1e12 Pa")                            \
  X(RP_WARNING_FRICTION, 1, "friction is above 1")                                                 \
  X(RP_WARNING_LOAD, 2, "a normal force is outside 100 N to 500 kN")                               \
  X(RP_WARNING_HIGH_PRESSURE, 3, "max_pressure is above 5 GPa")                                    \
  X(RP_WARNING_LOW_PRESSURE, 4, "max_pressure is below 10 MPa, between bodies as stiff as steel")  \
  X(RP_WARNING_CREEPAGE, 5, "a creepage is above 0.1")                                             \
  X(RP_WARNING_TURNING, 6, "pitch_rate: the wheel is locked or turns against its way")             \
  X(RP_WARNING_ONE_WHEEL, 7, "one wheel of the wheelset carries nothing")                          \
  X(RP_WARNING_RADIUS, 8, "the wheel's radius is outside 1 to 8 times the width of its profile")   \
  X(RP_WARNING_FLANGE, 9, "y is beyond 25 mm: the flange would be on top of the rail, or past it") \
  X(RP_WARNING_LAYER, 10, "the layer is thicker than the contact is long or wide")                 \
  X(RP_WARNING_COARSE, 11, "a grid has fewer than 8 elements across")                              \
  X(RP_WARNING_SPIN, 12, "a spin creepage is above 20 rad/m")                                      \
  X(RP_WARNING_SIZE, 13, "a contact is wider than a circle of 60 mm")                              \
  X(RP_WARNING_LAYER_STIFFNESS, 14, "layer.shear_modulus is outside 1e6 to 1e12 Pa")               \
  X(RP_WARNING_GAUGE, 15, "gauge is not 40 to 120 mm wider than flange_back_distance")             \
  X(RP_WARNING_HEIGHTS, 16,                                                                        \
    "other heights nearly or quite carry the vertical force too: forces jump near this position")  \
  X(RP_WARNING_WATER, 17, "water as a liquid is warmer than 100 or colder than 0 degrees C")       \
  X(RP_WARNING_FILM_GRID, 18,                                                                      \
    "the grid is too coarse for the film that was found: more elements along rolling")             \
  X(RP_WARNING_SHIFT, 19, "regime shift: creepage is the way of the step, in m; it is above 1 mm") \
  X(RP_WARNING_DISTANCE, 20, "transient rolling: a step is longer than 100 mm")                    \
  X(RP_WARNING_SPEED, 21, "a speed is above 200 m/s")                                              \
  X(RP_WARNING_CURVATURES, 22,                                                                     \
    "a radius of the bodies is outside 2 mm to 20 m: greatest of "                                 \
    "curvatures, in 1/m, or line_contact_radius, in m")                                            \
  X(RP_WARNING_THICK_FILM, 23,                                                                     \
    "a film is thicker than 0.1 mm, beyond what its formula is of: fluid.viscosity, in Pa s")      \
  X(RP_WARNING_YIELD, 24,                                                                          \
    "layer: a yield stress (yield_stress, hardening_table) is outside 1e4 to 1e10 Pa, the "        \
    "hardening outside 1e7 to 1e17 Pa/m, either way, or a table's displacement above 100 mm")      \
  X(RP_WARNING_TEMPERATURE, 25,                                                                    \
    "a temperature of wheel, rail, air or liquid is given outside -60 to 250 degrees C, which is " \
    "their unit")                                                                                  \
  X(RP_WARNING_SUPPLY, 26,                                                                         \
    "of a liquid water_rate is above 1e-3 m^3/s (1 l/s), or oil_film above 5e-4 m")                \
  X(RP_WARNING_SLIP_LAW, 27,                                                                       \
    "friction: halving_speed, or ln(2)/polach_b, is outside 1e-5 to 100 m/s, or memory_distance "  \
    "above 20 mm")                                                                                 \
  X(RP_WARNING_FILM_REACH, 28,                                                                     \
    "the liquid's film begins before the grid, which must reach farther ahead of the contact")     \
  X(RP_WARNING_LIQUID, 29,                                                                         \
    "of a liquid roughness is above 5e-5 m, a viscosity outside 1e-4 to 100 Pa s, eyring_stress "  \
    "outside 1e5 to 1e9 Pa, hardness outside 1e8 to 1e11 Pa, mean_pressure outside 1e7 to 5e9 "    \
    "Pa, or boundary_friction above the coefficient of the dry contact")                           \
  X(RP_WARNING_SLIPPERY, 30,                                                                       \
    "effective_friction of a wet contact is below 0.001: the liquid carries all of the load, see " \
    "viscosity, in Pa s, and roughness, in m")

#define RP_ENUM_ENTRY(name, value, text) name = value,
typedef enum rp_error { RP_ERRORS(RP_ENUM_ENTRY) } rp_error;
typedef enum rp_status { RP_STATUSES(RP_ENUM_ENTRY) } rp_status;
typedef enum rp_reason { RP_REASONS(RP_ENUM_ENTRY) } rp_reason;
typedef enum rp_warning { RP_WARNINGS(RP_ENUM_ENTRY) } rp_warning;

/* --- choices: X(enumerator, value, word); the words are those of case files and results. What a
 * comment says of a choice stands beside it or above ---------------------------------------- */
#define RP_SIDES(X)     \
  X(RP_LEFT, 0, "left") \
  X(RP_RIGHT, 1, "right")
typedef enum rp_side { RP_SIDES(RP_ENUM_ENTRY) } rp_side;

#define RP_KINDS(X)                 \
  X(RP_PATCH, 0, "patch")           \
  X(RP_WHEEL_RAIL, 1, "wheel_rail") \
  X(RP_WHEELSET, 2, "wheelset")
typedef enum rp_kind { RP_KINDS(RP_ENUM_ENTRY) } rp_kind;

#define RP_GEOMETRIES(X)                                         \
  /* ellipse known, curvatures follow from the load (Hertz) */   \
  X(RP_SEMI_AXES, 0, "semi_axes")                                \
  /* undeformed distance c0 x^2 + c1 y^2 */                      \
  X(RP_CURVATURES, 1, "curvatures")                              \
  /* cylinder, plane strain, force per length = force / width */ \
  X(RP_LINE_CONTACT, 2, "line_contact_radius")                   \
  /* any smooth shape, given on the grid */                      \
  X(RP_UNDEFORMED_DISTANCE, 3, "undeformed_distance")
typedef enum rp_geometry { RP_GEOMETRIES(RP_ENUM_ENTRY) } rp_geometry;

#define RP_LOADS(X)                                                         \
  /* normal_force (patch) or vertical_force (wheel, wheelset) prescribed */ \
  X(RP_FORCE, 0, "force")                                                   \
  X(RP_POSITION, 1, "position") /* approach (patch) or z (wheel, wheelset) prescribed */
typedef enum rp_load { RP_LOADS(RP_ENUM_ENTRY) } rp_load;

#define RP_REGIMES(X)                                                   \
  X(RP_REGIME_NONE, 0, "none")                                          \
  X(RP_STEADY_ROLLING, 1, "steady_rolling")                             \
  /* Cattaneo: displacement without rolling, step by step */            \
  X(RP_SHIFT, 2, "shift")                                               \
  /* each step rolls input.distance on from the last one's tractions */ \
  X(RP_TRANSIENT_ROLLING, 3, "transient_rolling")
typedef enum rp_regime { RP_REGIMES(RP_ENUM_ENTRY) } rp_regime;

#define RP_FRICTION_LAWS(X)                                       \
  X(RP_COULOMB, 0, "coulomb")                                     \
  /* mu(s), s the micro-slip's speed: rp_slip_law, with memory */ \
  X(RP_SLIP_VELOCITY, 1, "slip_velocity")                         \
  X(RP_TEMPERATURE, 2, "temperature") /* mu(T), T the greater surface temperature */
typedef enum rp_friction_law { RP_FRICTION_LAWS(RP_ENUM_ENTRY) } rp_friction_law;

/* mu(s) = friction_kinetic + sum over i of friction_amplitude[i] f(s/friction_halving_speed[i]) */
#define RP_SLIP_LAWS(X)                                      \
  /* f(u) = 2^-u; Polach 2005: mu0 A, mu0 (1 - A), ln 2/B */ \
  X(RP_SLIP_EXPONENTIAL, 0, "exponential")                   \
  X(RP_SLIP_RATIONAL, 1, "rational") /* f(u) = 1/(1 + u) */  \
  X(RP_SLIP_LINEAR, 2, "linear")     /* f(u) = max(0, 1 - u/2) */
typedef enum rp_slip_law { RP_SLIP_LAWS(RP_ENUM_ENTRY) } rp_slip_law;

/* how the plastic displacement of the layer accumulates */
#define RP_PLASTIC_RULES(X)                                        \
  X(RP_PLASTIC_PATH, 0, "path")           /* length of the path */ \
  X(RP_PLASTIC_MAGNITUDE, 1, "magnitude") /* magnitude of the vector sum */
typedef enum rp_plastic_rule { RP_PLASTIC_RULES(RP_ENUM_ENTRY) } rp_plastic_rule;

#define RP_NORMAL_METHODS(X)                                     \
  X(RP_NORMAL_HERTZ, 0, "hertz")                                 \
  X(RP_NORMAL_HALF_SPACE, 1, "half_space")                       \
  /* Piotrowski and Kik 2008, by virtual interpenetration */     \
  X(RP_NORMAL_KIK_PIOTROWSKI, 2, "kik_piotrowski")               \
  /* Sichani, Enblom and Berg 2014, by an assumed deformation */ \
  X(RP_NORMAL_ANALYN, 3, "analyn")                               \
  /* Kik-Piotrowski, corrected so that an ellipse is Hertz's */  \
  X(RP_NORMAL_KIK_PIOTROWSKI_CORRECTED, 4, "kik_piotrowski_corrected")
typedef enum rp_normal_method { RP_NORMAL_METHODS(RP_ENUM_ENTRY) } rp_normal_method;

#define RP_TANGENTIAL_METHODS(X)                                                       \
  X(RP_TANGENTIAL_NONE, 0, "none")                                                     \
  X(RP_TANGENTIAL_FASTSIM, 1, "fastsim") /* Kalker 1982, three flexibilities */        \
  X(RP_TANGENTIAL_FULL, 2, "full")       /* Kalker's exact theory on the half-space */ \
  /* Kalker 1967, no bound: RP_OUT_OF_RANGE beyond saturation */                       \
  X(RP_TANGENTIAL_LINEAR, 3, "linear")                                                 \
  X(RP_TANGENTIAL_POLACH, 4, "polach")   /* Polach 1999, 2005; no spin moment: 0 */    \
  X(RP_TANGENTIAL_FASTRIP, 5, "fastrip") /* FaStrip, Sichani, Enblom, Berg 2016 */     \
  /* full theory, interpolated for elliptic contacts: config.creep_table */            \
  X(RP_TANGENTIAL_TABLE, 6, "table")
typedef enum rp_tangential_method { RP_TANGENTIAL_METHODS(RP_ENUM_ENTRY) } rp_tangential_method;

/* of FASTSIM; the bound of FaStrip is elliptic */
#define RP_TRACTION_BOUNDS(X)                                                            \
  /* elliptic, of Hertz with flexibility_blending = contact parabolic: what errs less */ \
  X(RP_BOUND_AUTOMATIC, 0, "automatic")                                                  \
  X(RP_BOUND_PARABOLIC, 1, "parabolic") /* as the square of the pressure */              \
  X(RP_BOUND_ELLIPTIC, 2, "elliptic")   /* friction coefficient times pressure */
typedef enum rp_traction_bound { RP_TRACTION_BOUNDS(RP_ENUM_ENTRY) } rp_traction_bound;

/* of FASTSIM and FaStrip: whether the flexibilities become one as sliding becomes full, so that the
 * creep force then points against the creepage */
#define RP_FLEXIBILITY_BLENDINGS(X)                                                          \
  X(RP_BLENDING_SLIDING, 0, "sliding")                                                       \
  X(RP_BLENDING_NONE, 1, "none")                                                             \
  /* FASTSIM as in the program CONTACT: blended, with Kalker's published coefficients, whole \
   * elements as steps and the bound not scaled */                                           \
  X(RP_BLENDING_CONTACT, 2, "contact")
typedef enum rp_flexibility_blending {
  RP_FLEXIBILITY_BLENDINGS(RP_ENUM_ENTRY)
} rp_flexibility_blending;

/* how far upstream of an element its spin term is read, of the way dq of a step: an element in
 * steady rolling, else input.distance or a wheel's way, at most the length of the contact */
#define RP_SPIN_OFFSETS(X)                                                            \
  X(RP_SPIN_OFFSET_NONE, 0, "none")                                                   \
  X(RP_SPIN_OFFSET_SIXTH, 1, "sixth") /* x + dq/6, as the program CONTACT does */     \
  /* a quarter for tangential = full on the uniform grid, but in a shift and with an  \
   * elastic layer; else none */                                                      \
  X(RP_SPIN_OFFSET_AUTOMATIC, 2, "automatic")                                         \
  X(RP_SPIN_OFFSET_QUARTER, 3, "quarter")                                             \
  /* a sixth in steady rolling, none in other steps, as the program CONTACT has it */ \
  X(RP_SPIN_OFFSET_CONTACT, 4, "contact")
typedef enum rp_spin_offset { RP_SPIN_OFFSETS(RP_ENUM_ENTRY) } rp_spin_offset;

/* which parts of contact of a wheel, the stretches where the profiles overlap, are one patch */
#define RP_PATCH_RULES(X)                                                                        \
  /* force without jumps: neighbours go over from one patch to two smoothly; in between both     \
   * solutions count, each with its share. Slip and creep force belong to one point of both      \
   * bodies, pressure acts along the surface's normals: their power balances, docs/power.md */   \
  X(RP_PATCHES_BLENDED, 0, "blended")                                                            \
  /* as in the program CONTACT: one patch below 8 mm, with part of the interaction from 4 mm on, \
   * and angles turned together up to 12 mm; slip by a point on each body, forces at the         \
   * reference, pressure along the frame's normal */                                             \
  X(RP_PATCHES_CONTACT, 1, "contact")
typedef enum rp_patch_rule { RP_PATCH_RULES(RP_ENUM_ENTRY) } rp_patch_rule;

/* x axis of the contact frame where a contact lies ahead of a roller's top, or behind */
#define RP_CONTACT_FRAMES(X)                                                                  \
  /* the track's: with patch_rule = contact the part Fn x/R of the normal force along track x \
   * is left out of force and moment, as in the published results of the program CONTACT */   \
  X(RP_FRAME_TRACK, 0, "track")                                                               \
  X(RP_FRAME_INCLINED, 1, "inclined") /* along the roller's surface */
typedef enum rp_contact_frame { RP_CONTACT_FRAMES(RP_ENUM_ENTRY) } rp_contact_frame;

/* of profiles that vary along the track or round the wheel: knots that belong together */
#define RP_SECTION_MATCHES(X)                                                                   \
  X(RP_SECTIONS_BY_SHARE, 0, "share") /* lie at the same shares of the arc length */            \
  X(RP_SECTIONS_BY_KNOT, 1, "knot")   /* have the same number, wherever they lie: edges go with \
                                         their knots */
typedef enum rp_section_match { RP_SECTION_MATCHES(RP_ENUM_ENTRY) } rp_section_match;

/* what the knots do between two sections */
#define RP_SECTION_BLENDS(X)                                                                    \
  X(RP_SECTIONS_LINEAR, 0, "linear")                                                            \
  X(RP_SECTIONS_CUBIC, 1, "cubic") /* cubics with a continuous slope, that of parabolas through \
                                      three sections but at a section_kink */
typedef enum rp_section_blend { RP_SECTION_BLENDS(RP_ENUM_ENTRY) } rp_section_blend;

/* of the half-space theories for wheels */
#define RP_REFERENCE_SURFACES(X)                                                                   \
  X(RP_REFERENCE_PLANE, 0, "plane") /* tangent to the contact reference */                         \
  /* midway between wheel and rail: rows with normals of their own, for conformal contact. Needs   \
   * normal = half_space, tangential = full or none, a uniform grid, Coulomb friction, like bodies \
   */                                                                                              \
  X(RP_REFERENCE_CURVED, 1, "curved")
typedef enum rp_reference_surface { RP_REFERENCE_SURFACES(RP_ENUM_ENTRY) } rp_reference_surface;

/* liquid between wheel and rail (docs/fluids.md) */
#define RP_FLUID_MODELS(X)                                                                        \
  X(RP_FLUID_NONE, 0, "none")                                                                     \
  /* film of an elliptic contact, share of the load that asperities carry, one coefficient */     \
  X(RP_FLUID_FILM, 1, "film")                                                                     \
  /* pressure of the liquid along each row, the rest on asperities; a bound of their own each */  \
  X(RP_FLUID_STRIP, 2, "strip")                                                                   \
  /* Polach's theory with parameters by water rate, tangential = polach */                        \
  X(RP_FLUID_REGIMES, 3, "regimes")                                                               \
  /* elastohydrodynamic lubrication on the grid: liquid, asperities, deformation and load at once \
   */                                                                                             \
  X(RP_FLUID_EHL, 4, "ehl")
typedef enum rp_fluid_model { RP_FLUID_MODELS(RP_ENUM_ENTRY) } rp_fluid_model;

/* share of the load that asperities carry */
#define RP_FLUID_SHARES(X)                                               \
  /* by film over roughness, Aihara 1987 */                              \
  X(RP_SHARE_FILM_RATIO, 0, "film_ratio")                                \
  /* liquid and asperities bear the load together, plastic truncation */ \
  X(RP_SHARE_LOAD_SHARING, 1, "load_sharing")
typedef enum rp_fluid_share { RP_FLUID_SHARES(RP_ENUM_ENTRY) } rp_fluid_share;

/* viscosity over temperature: fluid_viscosity everywhere; Vogel's equation; that of Roelands from
 * fluid_viscosity at fluid_reference_temperature; a table */
#define RP_LIQUIDS(X)            \
  X(RP_LIQUID_GIVEN, 0, "given") \
  X(RP_LIQUID_WATER, 1, "water") \
  X(RP_LIQUID_OIL, 2, "oil")     \
  X(RP_LIQUID_TABLE, 3, "table")
typedef enum rp_liquid { RP_LIQUIDS(RP_ENUM_ENTRY) } rp_liquid;

#define RP_TRACKS(X)    \
  X(RP_RAIL, 0, "rail") \
  X(RP_ROLLER, 1, "roller")
typedef enum rp_track { RP_TRACKS(RP_ENUM_ENTRY) } rp_track;

#define RP_ELEMENTS(X)          \
  X(RP_EXTERIOR, 0, "exterior") \
  X(RP_STICK, 1, "stick")       \
  X(RP_SLIP, 2, "slip")         \
  X(RP_PLASTIC, 3, "plastic")
typedef enum rp_element { RP_ELEMENTS(RP_ENUM_ENTRY) } rp_element;

/* A smooth profile as a cubic Hermite curve in arc length; a C2 cubic spline is represented
 * exactly. Right-hand profile from the flange or gauge side (-y) to the field side (+y), z down.
 * Arrays of `count` values, copied by rp_create. */
typedef struct rp_profile {
  const double *arc_length; /* m, strictly increasing */
  const double *y, *z;      /* m */
  const double *dy, *dz;    /* -, derivatives with respect to arc length */
  int32_t count;            /* 4 or more */
} rp_profile;

typedef struct rp_contact rp_contact;
typedef struct rp_message {
  char text[RP_MESSAGE_SIZE]; /* names the field, the value and the allowed range */
} rp_message;

#define RP_STAGES(X)                                                        \
  /* placement, contact search, undeformed distance */                      \
  X(RP_STAGE_GEOMETRY, 0, "geometry")                                       \
  X(RP_STAGE_INFLUENCE, 1, "influence")                                     \
  X(RP_STAGE_NORMAL, 2, "normal")                                           \
  X(RP_STAGE_TANGENTIAL, 3, "tangential")                                   \
  X(RP_STAGE_TEMPERATURE, 4, "temperature")                                 \
  X(RP_STAGE_FORCES, 5, "forces")                                           \
  /* normal and tangential problem of unlike bodies, by each other */       \
  X(RP_STAGE_COUPLING, 6, "coupling")                                       \
  /* last step's tractions and states, in shift and transient rolling */    \
  X(RP_STAGE_HISTORY, 7, "history")                                         \
  /* of the third-body layer; its time is that of the tangential problem */ \
  X(RP_STAGE_PLASTICITY, 8, "plasticity")                                   \
  X(RP_STAGE_DERIVATIVES, 9, "derivatives") /* rp_differentiate */          \
  /* rails on springs and dampers; its time is that of the contacts */      \
  X(RP_STAGE_SUPPORT, 10, "rail_support")                                   \
  X(RP_STAGE_FLUID, 11, "fluid") /* liquid between the bodies */
typedef enum rp_stage { RP_STAGES(RP_ENUM_ENTRY) RP_STAGE_COUNT } rp_stage;

/* Called when a stage begins (entering = 1) and ends (0); for time shares. The core has no clock.
 */
typedef void (*rp_observer)(void *user, rp_stage stage, int entering);

/* Asked between iterations whether the step is to end: 0 to go on. */
typedef int (*rp_interrupt)(void *user);

typedef struct rp_config {
  uint32_t cookie; /* set by rp_default_config */
  rp_kind kind;

  double shear_modulus[2]; /* Pa, > 0 */
  double poisson_ratio[2]; /* -, 0 ... 0.5 */

  /* patch */
  rp_geometry geometry;
  double semi_axes[2];               /* m, along rolling, lateral */
  double curvatures[2];              /* 1/m, c0 and c1: half of 1/R_wheel + 1/R_rail */
  double line_contact_radius;        /* m */
  double width;                      /* m, of the line contact */
  const double *undeformed_distance; /* m, [distance_shape[1]][distance_shape[0]], copied */
  int32_t distance_shape[2];         /* elements along rolling, lateral */

  rp_load load;

  /* grid: elements across the contact's bounding box, or the element size; the other zero */
  int32_t elements[2];
  double element_size[2];  /* m */
  int32_t max_elements[2]; /* with element_size: capacity of one patch's grid, in shift and
                              transient rolling of a patch the grid itself; 0: chosen, and with
                              undeformed_distance, whose shape is the grid; by curvatures 130,
                              along a line contact 1002: a contact that needs more is
                              RP_OUT_OF_RANGE */
  int32_t fitted[2];       /* nodes along rolling and rows of the tangential problem on rows fitted
                              to the contact area, 2304 nodes in all at most; 0: tangential
                              problem on the grid above */

  /* motion and friction */
  rp_regime regime;
  int32_t force_prescribed[2]; /* longitudinal, lateral; 1: the creep force's component is given
                                  (tangential_force) and its creepage found, else 0 (kind RP_PATCH,
                                  tangential = full) */
  rp_friction_law friction_law;
  double friction_coefficient;      /* -, Coulomb, >= 0 */
  rp_slip_law slip_law;             /* of the slip-velocity law */
  double friction_kinetic;          /* -, at high speed */
  double friction_amplitude[2];     /* -, at rest above the kinetic one; 0: no such term */
  double friction_halving_speed[2]; /* m/s, > 0 */
  double friction_memory_distance;  /* m slipped, over which mu follows mu(s); 0: at once */
  double friction_memory_speed;     /* m/s, > 0, least speed of following; 1e-3 without distance */
  double friction_reference;        /* -, of the temperature law, below its first temperature */
  double friction_change;           /* -, from there to the end of the range */
  double friction_reference_temperature; /* degrees C */
  double friction_temperature_range;     /* K, > 0 */
  /* factor of the friction law over the lateral position (kind RP_PATCH, m) or the angle of the
   * rail's surface (wheels, rad, > 0 towards the gauge face on either side); linear between the
   * points, constant beyond */
  int32_t friction_points;                 /* 0: none, else 2 ... RP_MAX_POINTS */
  double friction_position[RP_MAX_POINTS]; /* m or rad, increasing */
  double friction_factor[RP_MAX_POINTS];   /* -, >= 0 */
  /* factor of the friction law along the track, by input.x (wheels, any method), beside the one
   * above; linear between the points, constant beyond */
  int32_t friction_along_points;                 /* 0: none, else 2 ... RP_MAX_POINTS */
  double friction_along_position[RP_MAX_POINTS]; /* m, increasing */
  double friction_along_factor[RP_MAX_POINTS];   /* -, >= 0 */

  /* third-body layer: elastic where its thickness is not 0, plastic where it has a yield stress */
  double layer_shear_modulus; /* Pa */
  double layer_thickness;     /* m */
  double layer_yield_stress;  /* Pa, tau_c0; 0: not plastic */
  double layer_hardening;     /* Pa/m, of tau_c over the plastic displacement; any sign */
  int32_t hardening_points;   /* 0: the two values above, else 2 ... RP_MAX_POINTS */
  double hardening_displacement[RP_MAX_POINTS]; /* m, increasing from 0 */
  double hardening_stress[RP_MAX_POINTS];       /* Pa, > 0; the last one holds beyond */
  rp_plastic_rule plastic_rule;

  /* surface temperature */
  int32_t temperature;          /* 1: computed, 0: no such stage */
  double bulk_temperature[2];   /* degrees C, where an input has none */
  int32_t heat_exchange;        /* 1: bodies of unequal bulk temperature may come into contact, as
                                   they may where those above are unequal; 0: equal ones only */
  double conductivity[2];       /* W/(m K) */
  double heat_capacity[2];      /* J/(kg K) */
  double density[2];            /* kg/m^3 */
  double temperature_depth;     /* m, below the surface, of the temperatures given; 0: surface */
  double plastic_heat_fraction; /* -, of the plastic work, 0 ... 1 */

  /* method */
  rp_normal_method normal;
  rp_tangential_method tangential;
  double tolerance;       /* -, relative, 1e-12 ... 1e-1 */
  int32_t max_iterations; /* of each solver */
  rp_spin_offset spin_offset;
  rp_reference_surface reference_surface;
  double percent_kalker; /* %, 0 < ... 200: of the creepage coefficients of the fast theories */
  rp_traction_bound traction_bound;
  rp_flexibility_blending flexibility_blending;
  double polach_k_a, polach_k_s; /* -, 0 < ... 10: reduction of adhesion and of slip area */
  double fastsim_k0;             /* -, 0 < ... 10: stiffness k0 (alpha + (1-alpha)/(1+beta e)) */
  double fastsim_alpha;          /* -, 0 ... 1 */
  double fastsim_beta;           /* -, 0 ... 1000 */
  /* table of creep forces, made by `railpatch table`, for tangential = RP_TANGENTIAL_TABLE. Used in
   * place, not copied: it must stay there, unchanged, until rp_destroy; any number of handles on
   * any threads may share it. Aligned to 8 bytes. */
  const void *creep_table;
  size_t creep_table_size;
  int32_t derivatives; /* 1: rp_differentiate may be called, 0: it has no memory */

  /* wheel_rail, wheelset */
  int32_t side;                /* RP_LEFT or RP_RIGHT, kind = RP_WHEEL_RAIL */
  double nominal_radius;       /* m */
  double flange_back_distance; /* m */
  double flange_back_position; /* m, of the flange back on the profile's y axis */
  rp_track track;
  double gauge, gauge_height;   /* m */
  double gauge_widening;        /* m, > 0: each rail or roller lies half of it further out */
  double cant;                  /* rad, rail; > 0 leans both rails towards the track centre */
  double curvature;             /* 1/m, right-hand curve > 0, rail */
  double roller_radius;         /* m, roller */
  rp_profile wheel[2], rail[2]; /* by side; the roller's profile as rail */
  int32_t max_patches;          /* solved on one wheel, 1 ... RP_MAX_PATCHES */
  rp_patch_rule patch_rule;
  rp_contact_frame contact_frame; /* rollers; derivatives with an inclined one are by differences */
  double standstill_speed; /* m/s, 0 ... 1, V0: below it creepages are slip over (V^2 + V0^2)/(2 V0)
                              instead of the rolling speed V, and spin_creepage fades as the heading
                              turns, so that forces pass through standstill without a jump. 0: slip
                              over V, and at V = 0 no creep force */
  /* a rail's profile along the track, by input.x: by side, section_count profiles (0: the one
   * above, else 1 or more; copied) at increasing positions (m). All have as many knots, at the same
   * shares of the arc length (but see section_match); between two sections the knots are
   * interpolated linearly (but see section_blend), beyond the ends the profile is constant. The
   * rail's place follows from the profile at x. */
  const rp_profile *rail_sections[2];
  const double *section_position[2];
  int32_t section_count[2];
  /* rails or rollers on springs and dampers without mass; lateral, vertical. A deflection u adds to
   * rail_offset, its rate to rail_velocity; k u + c (u - that of the last step)/time_step is the
   * force of the wheel in that direction, without the second term where time_step is 0 */
  double rail_stiffness[2]; /* N/m, 0: rigid in this direction */
  double rail_damping[2];   /* N s/m, 0 in a rigid direction */
  /* shape along rolling by side, copied; C2 splines. The wheel's radius at its lowest point is that
   * of its profile plus runout at the input's pitch (a rotation about y of its deviation added) */
  const double *runout[2];      /* m, at pitch angles 2 pi i/runout_count, > 0: greater radius */
  int32_t runout_count[2];      /* 0: round, else 8 ... 1000000 */
  const double *rail_height[2]; /* m, of the running surface at x = rail_height_start + i
                                   rail_height_spacing, > 0 up, constant beyond; rails only */
  int32_t rail_height_count[2]; /* 0: level, else 4 ... 10000000 */
  double rail_height_start, rail_height_spacing; /* m; > 0 */

  rp_observer observer; /* may be null */
  void *observer_user;

  /* bulk temperatures that heat raises and the air takes away, of each wheel and its rail or
   * roller: mass heat_capacity dT/dt = heat - air_conductance (T - air_temperature). They begin at
   * bulk_temperature and go on by input.time_step: with the last step's heat of friction, and with
   * what flows between the bodies, that changes with their temperatures, exactly;
   * kinds RP_WHEEL_RAIL and RP_WHEELSET, RP_STEADY_ROLLING. Part of the state */
  double bulk_mass[2];       /* kg, 0: the bulk temperature stays as given */
  double air_conductance[2]; /* W/K, 0 where bulk_mass is 0 */
  double air_temperature;    /* degrees C */

  /* a promise for every result: a step whose error estimate of the creep force, of any patch, is
   * above this share of friction coefficient times normal force is solved again on a finer grid,
   * from the tractions found. The next step begins on the grid of the last one, or on a coarser one
   * where that is good enough by far. What is above it on the finest grid, or has no estimate, ends
   * as RP_ACCURACY_NOT_MET. 0: one grid; else steady rolling */
  double accuracy;     /* -, 0 ... 1 */
  int32_t finer_grids; /* allotted beside the grid above, each with 1.4 times its elements, nodes
                          and rows either way, as far as fitted allows; only with accuracy. With
                          tangential = RP_TANGENTIAL_TABLE they are those of the full theory,
                          beginning with fitted itself, and the table is asked first */

  /* wheels in balance: what each step finds in place of an input, which then is not read.
   * Derivatives are those of the balance, which follows. Not with rp_get_jacobian */
  int32_t roll_balanced; /* 1: the roll angle at which the contact forces have no moment about the
                            track's x through the wheelset's centre (RP_WHEELSET) */
  int32_t axle_free;     /* 1: the pitch rate at which axle_torque is the input's, 0 without drive
                            and brake; with a tangential problem */

  /* may be null. Where it asks for the end rp_step returns RP_ERROR_INTERRUPTED within the time of
   * some products of the influence coefficients: the result is untouched, the handle as after
   * rp_reset. rp_differentiate and rp_get_jacobian by differences leave the handle as it was */
  rp_interrupt interrupt;
  void *interrupt_user;

  /* operator products of a step after which no further height is tried for the vertical force,
   * load = RP_FORCE: each patch solved counts 1 and its normal and inner iterations. The result is
   * that of the height that came nearest, solved once more where it was not the last, and ends as
   * RP_WORK_SPENT; the next step begins where the search would have gone on. 0: no limit */
  int32_t max_work;

  /* liquid between wheel and rail: where there is a tangential problem, with friction_law =
   * RP_COULOMB. The coefficient of each patch follows from speed, load and liquid; friction_factor
   * and friction_along_factor multiply it. docs/fluids.md */
  rp_fluid_model fluid_model;
  rp_fluid_share fluid_share;
  double fluid_roughness;         /* m, combined standard deviation of both surfaces */
  double fluid_boundary_friction; /* -, of asperities that the liquid wets; NaN: as dry ones, whose
                                     is friction_coefficient */
  double fluid_hardness;          /* Pa, of the softer body; with RP_SHARE_LOAD_SHARING */
  double fluid_mean_pressure;     /* Pa, nominal, of RP_SHARE_LOAD_SHARING; 0: the contact's */
  rp_liquid fluid_liquid;
  double fluid_viscosity;                            /* Pa s */
  double fluid_reference_temperature;                /* degrees C, of fluid_viscosity of oil */
  double fluid_roelands_slope;                       /* -, S_0 of oil */
  int32_t fluid_viscosity_points;                    /* of the table: 2 ... RP_MAX_POINTS, else 0 */
  double fluid_viscosity_temperature[RP_MAX_POINTS]; /* degrees C, increasing */
  double fluid_viscosity_value[RP_MAX_POINTS];       /* Pa s */
  double fluid_pressure_coefficient;                 /* 1/Pa, alpha of exp(alpha p) */
  double fluid_inlet_conductivity; /* W/(m K), of the liquid: its shear in the inlet heats it and
                                      makes the film thinner; 0: it does not. RP_FLUID_EHL: its
                                      shear in the contact, which falls as the film warms */
  double fluid_starvation;         /* -, 0 < ... 1: factor of the film */
  double fluid_eyring_stress;      /* Pa, of the liquid's own friction; 0: none */
  double fluid_limiting_friction;  /* -, which that does not exceed */
  double fluid_oxide_content;      /* -, share of solids in the liquid's volume */
  double fluid_oxide_exponent;     /* -, k: viscosity times exp(k content) */
  /* where an input says nothing else; NaN: the temperature is the mean of the bulk temperatures, or
   * 20, and the contact is flooded */
  double fluid_temperature; /* degrees C, of the liquid before the contact */
  double fluid_water_rate;  /* m^3/s, spread over the width of each patch */
  double fluid_oil_film;    /* m, layer of the liquid on the surfaces before the contact */
  /* RP_FLUID_REGIMES, of which fluid_water_rate says where it is: knots of Polach's parameters at
   * increasing water rates; 0: dry, damp and flooded ones, see docs/fluids.md */
  int32_t fluid_knots;                  /* 0, else 2 ... RP_MAX_KNOTS */
  double fluid_knot_rate[RP_MAX_KNOTS]; /* m^3/s, increasing from 0 */
  double fluid_knot_k_a[RP_MAX_KNOTS], fluid_knot_k_s[RP_MAX_KNOTS]; /* - */
  double fluid_knot_coefficient[RP_MAX_KNOTS];                       /* -, mu_0 */
  double fluid_knot_a[RP_MAX_KNOTS], fluid_knot_b[RP_MAX_KNOTS];     /* -, s/m */
  double fluid_reference_rate; /* m^3/s, q_0: forces are interpolated over ln(rate + q_0) */
  double fluid_recovery; /* 1/N, tau: work of friction cleans wheel and rail, the forces go over to
                            those of the first knot by 1 - exp(-tau W), W of rail_work and of what
                            the wheel has had on each metre of its circumference, part of the state
                            of wheels, which goes on by time_step; 0: nothing recovers */

  /* rail_sections and wheel_sections: which knots belong together, and how they go over */
  rp_section_match section_match;
  rp_section_blend section_blend;
  /* a wheel's profile round it: by side, wheel_section_count profiles (0: the one above, else 1 or
   * more; copied) at increasing pitch angles (rad, 0 ... < 2 pi) and so on after a turn. The wheel
   * is of revolution with the profile at the input's pitch (a rotation about y of its deviation
   * added); what its radius does within the contact is runout's */
  const rp_profile *wheel_sections[2];
  const double *wheel_section_angle[2];
  int32_t wheel_section_count[2];
  /* m, by side: where the rail's profile has its origin, in track axes (left y < 0, z down), about
   * which cant turns it: of sections whose heights and places are to be taken as they are. NaN:
   * gauge says where it lies, its top being at z = 0. Both or neither; rails only */
  double rail_origin_y[2], rail_origin_z[2];
  /* by side, of each section: 1 where section_blend = RP_SECTIONS_CUBIC has no continuous slope, as
   * where a part of the profile begins; null: nowhere. Copied */
  const int32_t *section_kink[2], *wheel_section_kink[2];

  int32_t regime_changes; /* 1: a step may have another regime than the last one, from whose
                             tractions it goes on (rp_input.step_regime); where the method is
                             tangential = full on the uniform grid, without temperature and liquid.
                             Of wheels steady and transient rolling */

  int32_t longitudinal_prescribed; /* 1: wheels in balance, see axle_free, which is then 0: the
                                      pitch rate at which their contact forces along the track's x
                                      are rp_input.longitudinal_force */

  int32_t slip_by_element; /* 1: steps read rp_input.slip_field; of a patch with
                              RP_UNDEFORMED_DISTANCE, tangential = full and no fitted rows, without
                              liquid, accuracy and derivatives. creep_power is then what the whole
                              rigid slip supplies, and there are no error estimates */

  /* fluid_oxide_content > 0 of wheels with RP_FLUID_FILM, not with bulk_mass: the paste on each
   * wheel dries. Of its water exp(-X) is left, X = t/fluid_drying_time + W/fluid_drying_work, t the
   * sum of time_step, W friction's work on each metre of the circumference: part of the state,
   * docs/fluids.md; 0: it does not dry by that */
  double fluid_drying_time; /* s */
  double fluid_drying_work; /* J/m */

  /* Viscoelastic bodies, of a patch in RP_STEADY_ROLLING with normal = half_space and tangential =
   * full or none, Coulomb's law, alike in (1-2nu)/G where there are tractions; docs/physics.md has
   * what else it is refused with. Creep compliance of wheel, rail
   * (1 + viscoelastic_ratio (1 - exp(-t/relaxation_time)))/shear_modulus. With curvatures and a
   * line contact elements and capacity are those across the contact of bodies with all time to
   * yield */
  double viscoelastic_ratio[2]; /* -, >= 0, flexibility of the second spring over that of the first;
                                   0: elastic */
  double relaxation_time[2];    /* s, at constant stress; 0 of elastic bodies, else > 0 */

  /* Influence coefficients in place of the half-space's, of RP_PATCH with undeformed_distance,
   * normal = half_space, tangential = full or none, in steady rolling, shift or at rest;
   * docs/physics.md has what they are refused with. influence_coefficients: m/Pa, displacement
   * difference by unit pressure or traction on one element,
   * [4][distance_shape[1]][distance_shape[0] + 1]: of normal displacement by pressure, longitudinal
   * and lateral displacement by traction along it, longitudinal by lateral traction, each at
   * offsets 0, 1, ... elements, observer minus source, lateral [..][offset][..] and along rolling.
   * The first three are even in both offsets, the last one is odd. They make a positive definite
   * operator, which is up to the caller. Copied. Without tangential problem the first is read alone
   */
  int32_t own_influence; /* 1: given, 0: the half-space's */
  const double *influence_coefficients;
} rp_config;

typedef struct rp_input {
  uint32_t cookie; /* set by rp_default_input */

  /* patch */
  double normal_force;        /* N, >= 0 (0: no contact), load = RP_FORCE */
  double approach;            /* m, load = RP_POSITION */
  double creepage[2];         /* -, longitudinal, lateral; 0 where the force is prescribed.
                                 RP_SHIFT: m, displacement of the wheel in this step */
  double tangential_force[2]; /* N on the wheel, of the components in force_prescribed, else 0;
                                 together at most friction_coefficient times the normal force */
  double spin_creepage;       /* rad/m; RP_SHIFT: rad, rotation in this step */
  double rolling_speed;       /* m/s, >= 0; 0 is standstill: no creep force */
  int32_t direction;          /* rolling towards +x (1) or -x (-1) */
  double bulk_temperature[2]; /* degrees C; NaN: the config's; of a body with bulk_mass NaN */
  double distance;            /* m, > 0, rolled in this step where regime = RP_TRANSIENT_ROLLING */

  /* wheelset: position, attitude (roll-yaw-pitch) and velocity in track axes */
  double x, pitch;       /* m, along the track; rad, about the axle: for what varies with them */
  double y, z;           /* m; z where load = RP_POSITION */
  double vertical_force; /* N on the wheel or on both, >= 0 (0: no contact), load = RP_FORCE */
  double roll, yaw;      /* rad */
  double speed, vy, vz;  /* m/s, forward (0 on a rig), lateral, vertical */
  double roll_rate, yaw_rate, pitch_rate;          /* rad/s */
  double wheel_offset[2][3], wheel_rotation[2][3]; /* m, rad: from the rigid wheelset, its axes */
  double rail_offset[2][3], rail_rotation[2][3];   /* m, rad: from design, track axes; of the
                                                      rotations only that about x may differ from 0 */
  /* m/s, rad/s: rates of the deviations above, same axes. A wheel turns about its profile's origin
   * (x), and about its axis where the origin's plane meets it (y, z); a rail or roller about its
   * profile's origin, a roller about its axle (y). */
  double wheel_velocity[2][3], wheel_angular_velocity[2][3];
  double rail_velocity[2][3], rail_angular_velocity[2][3];
  double time_step;         /* s, >= 0, since the last step, for rails on dampers (0: at rest),
                               for regime = RP_TRANSIENT_ROLLING (> 0) and for bodies with
                               bulk_mass */
  double roller_pitch_rate; /* rad/s */

  double friction_coefficient; /* -, of a direction (rp_differentiate) only: rate of the coefficient
                                  of Coulomb's law; 0 in a step, see rp_set_friction_coefficient */

  /* of a scene with fluid_model; NaN: the config's */
  double water_rate;        /* m^3/s */
  double water_temperature; /* degrees C, of the liquid */
  double oil_film;          /* m */
  double rail_work[2]; /* J/m, >= 0, friction work that wheels before have spent on each metre of
                          the rail, with fluid_recovery; by side, of a patch RP_RIGHT */
  /* -, 0 ... 100, factor of the friction law on each wheel, beside friction_factor and
   * friction_along_factor; by side, of a patch RP_RIGHT; 1 without a tangential problem */
  double friction_scale[2];

  int32_t step_regime; /* with regime_changes, an rp_regime other than none: of this step, whose
                          tractions the next one goes on from; those of steady rolling do not depend
                          on what was before. -1: the config's */

  double axle_torque;        /* N m, with axle_free: that of the contact forces about the axle; one
                                that drives is above 0 */
  double longitudinal_force; /* N on the wheel or on both, along the track's x, with
                                longitudinal_prescribed */

  const double *slip_field; /* -, with slip_by_element, else null: rigid slip of each element, wheel
                               minus rail over the rolling speed, added to that of creepages and
                               spin; RP_SHIFT: m, of this step. [2][distance_shape[1]]
                               [distance_shape[0]], longitudinal before lateral; read in rp_step
                               alone. null: none */
} rp_input;

/* One patch. Values of stages that the scene leaves out are NaN (element counts 0). Linear theory
 * and Polach know no elements in stick or slip; with Hertz a patch has no grid either: its size is
 * 0. */
typedef struct rp_patch_result {
  rp_status status;
  double normal_force;       /* N, along n at the contact reference */
  double approach;           /* m, greatest rigid interpenetration along n */
  double creep_force[2];     /* N on the wheel, longitudinal, lateral; on a curved reference surface
                                along s at the contact reference, with what pressure adds to it */
  double spin_moment;        /* N m on the wheel about n at the contact reference */
  double max_pressure;       /* Pa */
  double contact_area;       /* m^2; with RP_FLUID_EHL that of the dry contact */
  int32_t elements[4];       /* exterior, stick, slip, plastic; indexed by rp_element */
  double max_temperature;    /* degrees C, of the contact; NaN: not part of the scene */
  double friction_power;     /* W, that friction turns into heat: the part of creep_power that the
                                layer does not take (Polach: without spin) and, of unlike bodies,
                                what the pressure supplies by its moment against rolling; of FASTSIM
                                traction times micro-slip. In transient rolling also less what
                                elastic energy grows by; elsewhere >= 0. RP_SHIFT: J, of elements
                                that slide against their bound once their traction is there */
  double plastic_power;      /* W, >= 0, of the layer's plastic displacement; RP_SHIFT: J */
  double elastic_energy;     /* J; NaN for a line contact on fitted rows */
  int32_t normal_iterations; /* conjugate-gradient steps; evaluations of the fast theories */
  int32_t newton_iterations; /* of the tangential problem */
  int32_t inner_iterations;  /* operator products of the tangential problem */
  int32_t outer_iterations;  /* of normal with tangential problem, friction with temperature */
  int32_t ambiguous_elements; /* whose falling friction law has further solutions: the one next to
                                 the last step's is taken */
  double residual;            /* -, greatest relative residual of the stages */
  double error_estimate[3];   /* N, N m, Pa: bounds that 95 % of the errors of creep force (length
                                 of the vector), spin moment and greatest pressure stay below, by
                                 measured errors of each method; against the exact theory, without
                                 errors of the case. NaN: no solution, no such stage, or not
                                 measured (line contact, force prescribed, unlike bodies, laws beyond
                                 Coulomb's, friction_points, layers that yield, shift, transient
                                 rolling, table but with Hertz, factors of fast theories other than
                                 1, spin_offset) */
  double share;               /* -, 0 < ... 1, of this solution in the wheel's force, moment and
                                 rolling radius: below 1 where patches join or part. All else here
                                 is of the solution itself */
  double position[3];         /* m, contact reference in track axes (wheel kinds) */
  double contact_angle;       /* rad */
  double creepage[2];         /* -; found where the force is prescribed */
  double spin_creepage;       /* rad/m */
  double rolling_speed;       /* m/s, that creepages are slip over: mean V of the two surface
                                 speeds; below standstill_speed V0 (V^2 + V0^2)/(2 V0) */
  int32_t direction;          /* 1 or -1; 0 at standstill */
  int32_t grid[2];            /* elements of the potential contact along rolling, lateral; of
                                 fitted rows the nodes and rows */
  double grid_origin[2];      /* m, centre of element (0, 0) in the contact frame; fitted rows: 0 */
  double element_size[2];     /* m; fitted rows: 0 */
  double creep_power;         /* W, that creepages and spin supply: -(creep_force . creepage +
                                 spin_moment spin_creepage) rolling_speed, by every theory; over the
                                 rolling speed it is T gamma. In transient rolling force and moment
                                 are the means of the step's both ends, and creepage is that of its
                                 middle. RP_SHIFT: J, along a way on which elements stick first and
                                 slide then. What friction and layer take of it: friction_power,
                                 plastic_power; in shift and transient rolling the rest is the
                                 tractions' elastic energy */
  double wheel_heat, rail_heat; /* W, into each body: its part of friction and plastic work by the
                                   effusivities, and what it gets from the other one. NaN: no
                                   temperature in the scene, or exchanged in transient rolling */
  double pressure_energy;       /* J, the part of elastic_energy that the pressure alone stores. In
                                   steady rolling the balance of power with wheel and rail is that of
                                   this one: nothing supplies what tractions store, each step has
                                   those of an endless rolling. NaN as elastic_energy */
  rp_reason reason;             /* why the status is not good */
  double reason_value;          /* of what the reason's text says; NaN: of nothing */
  /* with a liquid, else NaN: its central film, the share of the load that asperities carry, its
   * temperature, and the friction coefficient that follows, factors of the law included */
  double central_film_thickness, mean_asperity_share, fluid_temperature, effective_friction;
  double wear_number;          /* N, T gamma: |Fx xi| + |Fy eta| + |M phi| of creep_force, creepage,
                                  spin_moment and spin_creepage above, of each step as it ends, also
                                  where the regime changes; 0 at rolling_speed 0. Of rolling:
                                  RP_SHIFT: NaN */
  double traction_coefficient; /* -, length of creep_force over normal_force; NaN without contact */
  double utilised_friction; /* -, length of creep_force over what friction could carry: the sum of
                               the elements' friction coefficients times pressure, as solved;
                               NaN where that is 0 */
  double max_traction;      /* Pa, greatest length of an element's traction; NaN: of a theory
                               without tractions. Has no derivative */
  double contact_size[2];   /* m, extent of the area in contact along x and s; of an ellipse twice
                               its semi-axes */
  /* m, y and z of the contact reference in the axes of each profile as it was given (wheel kinds):
   * of the rail's surface, and of the wheel's the approach below it. Shapes along rolling are no
   * part of a profile: z has them */
  double wheel_profile_position[2], rail_profile_position[2];
  double fluid_power;   /* W, the part of friction_power that the shear of the liquid itself takes,
                           the heat of the film; asperities take the rest. NaN: no liquid in the
                           scene, or RP_FLUID_REGIMES, whose curves do not say */
  double viscous_power; /* W, that viscoelastic bodies take up and turn into heat, by pressure and
                           tractions: no part of friction_power. NaN: elastic bodies */
  double rolling_resistance_moment; /* N m about the lateral axis through the grid's origin (that of
                                       curvatures): of the pressure, which leans forward, > 0 holds
                                       the rolling up, whichever way that is; over the rolling
                                       radius it is the rolling resistance. NaN: elastic bodies */
} rp_patch_result;

/* One wheel; on a roller see rp_contact_frame. NaN where a patch could not be solved. */
typedef struct rp_side_result {
  rp_status status;
  double force[3];       /* N on the wheel, track axes */
  double moment[3];      /* N m about the wheelset centre, track axes */
  double rolling_radius; /* m, of the wheel at the mean contact reference; NaN without contact */
  double rail_deflection[2];      /* m, lateral, vertical, track axes; NaN: the scene has none */
  double rail_deflection_rate[2]; /* m/s, in this step; 0 where time_step is 0 */
  /* patch_count patches, and after them alternative_count solutions of other divisions of the same
   * areas, where neighbours join or part: the force is the sum of share times force of all */
  int32_t patch_count, alternative_count;
  rp_patch_result patch[RP_MAX_PATCHES];
  double contact_power; /* W, that force and moment give the wheelset: times its velocity and
                           angular velocity by the input; NaN: kind RP_PATCH */
  /* of the patches and alternatives: sums of share times each, and the greatest of all */
  double creep_power, friction_power, plastic_power, elastic_energy;
  double max_temperature, residual;
  double wheel_heat, rail_heat;
  double wheel_temperature, rail_temperature; /* degrees C, bulk, that the step was solved with;
                                                 NaN: no temperature in the scene */
  double pressure_energy;                     /* J, sum of share times each */
  rp_reason reason; /* why the status is not good: that of the patch, or of the wheel itself */
  double reason_value;
  uint32_t
      warnings; /* bits 1 << RP_WARNING_... of what can hardly be meant, though it was solved */
  double wear_number;   /* N, sum of share times each */
  double guiding_force; /* N, Y of EN 14363: lateral force on the rail, track axes, > 0 outward,
                           as a flange presses; force[1] on the left, -force[1] on the right */
  double wheel_load;    /* N, Q of EN 14363: vertical force on the rail, track axes: -force[2] */
  double derailment_quotient; /* -, Y/Q; NaN where Q is not above 0 */
  double fluid_power;         /* W, sum of share times each */
  double oxide_water; /* -, part of the paste's water that drying has left on the wheel; NaN: no
                         paste that dries */
} rp_side_result;

typedef struct rp_result {
  rp_status status;
  double z;               /* m, given or found (wheel kinds) */
  double force[3];        /* N, sum over the wheels (wheel kinds) */
  double moment[3];       /* N m about the wheelset centre */
  int32_t evaluations;    /* contact evaluations of each wheel spent on finding z */
  rp_side_result side[2]; /* kind RP_PATCH: side[RP_RIGHT].patch[0] */
  /* of the wheels: sums, and the greatest */
  double contact_power, creep_power, friction_power, plastic_power, elastic_energy;
  double max_temperature, residual;
  double wheel_heat, rail_heat;
  double pressure_energy;  /* J, sum of the wheels */
  double roll, pitch_rate; /* rad, rad/s, given or found (wheel kinds) */
  double axle_torque; /* N m, of the contact forces about the axle: their moment; with patch_rule =
                         contact in the track's frame, which leaves the pressures' part along x out,
                         the forces along the wheelset's x times the rolling radii */
  rp_reason reason;   /* why the status is not good: that of the wheel, or of both together */
  double reason_value;
  uint32_t warnings;  /* those of both wheels */
  int32_t work;       /* operator products of all evaluations, as config.max_work counts them (wheel
                         kinds) */
  double wear_number; /* N, sum of the wheels */
  double rolling_radius_difference; /* m, of the right wheel minus the left one's (kind RP_WHEELSET,
                                       both in contact) */
  double conicity;                  /* -, rolling_radius_difference over twice the lateral position
                                       y: of cones the tangent of their angle. NaN for |y| below
                                       1e-5 m. The equivalent conicity of EN 15302 is that of a whole
                                       wave, see docs/profiles.md */
  double fluid_power;               /* W, sum of the wheels */
} rp_result;

#define RP_FIELDS(X)                                                                             \
  /* m, [nx] element centres; fitted rows: [ny][nx] nodes */                                     \
  X(RP_FIELD_X, 0, "x")                                                                          \
  X(RP_FIELD_Y, 1, "y") /* m, [ny] */                                                            \
  /* m, [ny][nx]; not with fitted rows */                                                        \
  X(RP_FIELD_UNDEFORMED_DISTANCE, 2, "undeformed_distance")                                      \
  X(RP_FIELD_PRESSURE, 3, "pressure") /* Pa, [ny][nx] */                                         \
  /* Pa on the wheel, [2][ny][nx] */                                                             \
  X(RP_FIELD_TRACTION, 4, "traction")                                                            \
  /* -, relative to the rolling speed, [2][ny][nx] */                                            \
  X(RP_FIELD_MICRO_SLIP, 5, "micro_slip")                                                        \
  /* rp_element as a double, [ny][nx] */                                                         \
  X(RP_FIELD_ELEMENT_DIVISION, 6, "element_division")                                            \
  /* degrees C, [2][ny][nx], wheel and rail */                                                   \
  X(RP_FIELD_TEMPERATURE, 7, "temperature")                                                      \
  /* -, [RP_ERROR_FEATURES], what the error estimate is made from; not where there is none */    \
  X(RP_FIELD_ERROR_FEATURES, 8, "error_features")                                                \
  /* -, friction coefficient of each element, [ny][nx] */                                        \
  X(RP_FIELD_FRICTION, 9, "friction")                                                            \
  /* m, accumulated vector, [2][ny][nx] */                                                       \
  X(RP_FIELD_PLASTIC_DISPLACEMENT, 10, "plastic_displacement")                                   \
  /* m, what the yield stress depends on, [ny][nx] */                                            \
  X(RP_FIELD_PLASTIC_PATH, 11, "plastic_path")                                                   \
  X(RP_FIELD_YIELD_STRESS, 12, "yield_stress") /* Pa, [ny][nx] */                                \
  /* of a curved reference surface, where y above is its arc length; lateral tractions and slips \
   * act along each row's own s, pressure and undeformed distance along its own n */             \
  /* m, [2][ny], y and z of each row in track axes */                                            \
  X(RP_FIELD_ROW_POSITION, 13, "row_position")                                                   \
  /* rad, [ny], contact angle of each row */                                                     \
  X(RP_FIELD_ROW_ANGLE, 14, "row_angle")                                                         \
  /* of a liquid by strips: Pa, m, -, [ny][nx] */                                                \
  X(RP_FIELD_FLUID_PRESSURE, 15, "fluid_pressure")                                               \
  X(RP_FIELD_FILM_THICKNESS, 16, "film_thickness")                                               \
  X(RP_FIELD_ASPERITY_SHARE, 17, "asperity_share")
typedef enum rp_field { RP_FIELDS(RP_ENUM_ENTRY) } rp_field;

typedef struct rp_stage_info {
  const char *name;   /* "geometry", ... */
  int32_t present;    /* 0: left out */
  const char *reason; /* why it is present or left out */
  size_t bytes;       /* memory held for it by this handle */
} rp_stage_info;

/* Fills every field with a valid default: steel, wheelset of S1002-like size, no profiles. */
RP_API void rp_default_config(rp_config *config);
RP_API void rp_default_input(rp_input *input);
/* An input of zeros, for rp_differentiate: no rate at all. */
RP_API void rp_default_direction(rp_input *direction);

/* Makes the handle; checks every field. On error *contact is untouched and message (may be null)
 * names the field. */
RP_API rp_error rp_create(const rp_config *config, rp_contact **contact, rp_message *message);
RP_API void rp_destroy(rp_contact *contact); /* null is allowed */

/* Solves one state. The last solution is kept as the next start. On error the result and the
 * handle are untouched; see rp_config.interrupt for the one exception. */
RP_API rp_error rp_step(rp_contact *contact, const rp_input *input, rp_result *result,
                        rp_message *message);
/* Many states: `count` sequences of `length` steps each; inputs and results are [count][length]. A
 * sequence begins as after rp_reset and goes on as by rp_step; length 1: states of which none knows
 * of another. So a result is the same to the bit whatever the number of threads and whatever else
 * is solved. contacts: [threads], of one config and with one friction coefficient, none twice, each
 * for a thread of which the caller's is the first; threads are made and joined here (those that the
 * system has not are done without), else nothing is allocated. They end as after rp_reset.
 *
 * All inputs are checked before anything is solved: where one is wrong nothing is done and *wrong
 * (may be null) is its place. RP_ERROR_INTERRUPTED: as soon as one contact's rp_config.interrupt
 * asks for the end, the other threads end with the sequence they are at, and which results are
 * there is not known. Not part of an FMU's library. */
RP_API rp_error rp_step_many(rp_contact *const *contacts, int32_t threads, const rp_input *inputs,
                             size_t count, size_t length, rp_result *results, size_t *wrong,
                             rp_message *message);

/* How a derivative was found. */
#define RP_DERIVATIVE_KINDS(X)                                       \
  /* from the solved conditions, by the implicit function theorem */ \
  X(RP_DERIVATIVE_EXACT, 0, "exact")                                 \
  /* central differences of steps beside the last one */             \
  X(RP_DERIVATIVE_BY_DIFFERENCES, 1, "differences")
typedef enum rp_derivative_kind { RP_DERIVATIVE_KINDS(RP_ENUM_ENTRY) } rp_derivative_kind;

/* Derivative of the last step's result in one direction (rp_default_direction): each double of
 * `direction` holds the rate of that input, its integers are ignored and so is what is NaN of the
 * numbers that rp_default_input leaves NaN. Each double of `change` is the rate of that number of
 * the result: NaN where the number itself is NaN, and of residual and error_estimate; counts of
 * elements and iterations are 0, other counts and statuses those of the result, or
 * RP_NOT_CONVERGED where the rates did not converge. kind (may be null) says how they were found.
 * Needs config.derivatives = 1 and a step since rp_create, rp_reset, rp_restore_state or an
 * rp_set_friction_coefficient that changed it; the state, the last solution and its fields stay as
 * they are.
 *
 * Exact ones are those of the returned solution's active sets: elements in contact, in stick and in
 * slip stay what they are. Where an element is just about to change, that is the one-sided
 * derivative towards the side on which it does not. They exist with normal = half_space or hertz
 * and without a tangential problem, or with tangential = full on the uniform grid in steady
 * rolling, Coulomb's law (friction_points included), bodies alike, a plane reference surface, no
 * prescribed creep force, no layer that yields and no temperature; of wheels besides with
 * patch_rule = blended, contact_frame = track, round wheels and rails that are level, of one
 * profile and not on springs. */
RP_API rp_error rp_differentiate(rp_contact *contact, const rp_input *direction, rp_result *change,
                                 rp_derivative_kind *kind, rp_message *message);

/* Derivatives of the last step of wheels by pose and velocity, columns in this order:
 *   x, y, z, roll, yaw, pitch, speed, vy, vz, roll_rate, yaw_rate, pitch_rate;
 * all other inputs held. They are those of what rp_step returns: where the vertical force is
 * prescribed z follows. NaN where the result is. */
typedef struct rp_jacobian {
  rp_derivative_kind kind;
  rp_status status;      /* of the step, or RP_NOT_CONVERGED where the derivatives are not */
  double side[2][6][12]; /* of force, moment (rp_side_result) of each wheel in use, else 0. Column z
                            with load = RP_FORCE, where z is no input: the wheel's alone, as z moves
                            and the vertical force does not stay; NaN by differences */
  double z[12];          /* of rp_result.z */
  double z_force;        /* m/N, of rp_result.z by the vertical force, load = RP_FORCE, else NaN */
} rp_jacobian;

/* Needs the same as rp_differentiate, and leaves the same as it is. Kinds RP_WHEEL_RAIL and
 * RP_WHEELSET. Costs less than three warm steps where the derivatives are exact. */
RP_API rp_error rp_get_jacobian(rp_contact *contact, rp_jacobian *out, rp_message *message);

/* Changes the coefficient of Coulomb's law (0 ... 10) for the steps that follow; part of the state.
 * Other laws have their own numbers and do not read it. Derivatives of the last step are gone where
 * the coefficient is another. */
RP_API rp_error rp_set_friction_coefficient(rp_contact *contact, double value, rp_message *message);
/* Forgets the warm start: the next step is the same as the first one after rp_create, but for a
 * coefficient set by rp_set_friction_coefficient, which stays. */
RP_API void rp_reset(rp_contact *contact);

/* Copies a field of the last step's patch (row by row, x fastest) as doubles. count: in the
 * capacity of values, out the number written (or needed, with RP_ERROR_SIZE). */
RP_API rp_error rp_get_field(const rp_contact *contact, int side, int patch, rp_field field,
                             double *values, size_t *count);

/* --- below the surface: stresses and displacements in one of the bodies under a patch of the last
 * step, a half-space under the patch's pressure and tractions (elements of uniform load: Love 1929;
 * Johnson 1985, chapter 3). Components along x, s, n of the contact frame, n into the rail; tension
 * > 0. Of a curved reference surface s is its arc length. ---------------------------------------
 */
typedef struct rp_subsurface rp_subsurface;

#define RP_BODIES(X)           \
  X(RP_BODY_WHEEL, 0, "wheel") \
  X(RP_BODY_RAIL, 1, "rail")
typedef enum rp_body { RP_BODIES(RP_ENUM_ENTRY) } rp_body;

typedef struct rp_subsurface_config {
  uint32_t cookie;       /* set by rp_default_subsurface */
  int32_t depth_count;   /* 1 ... 1000 */
  const double *depth;   /* m, 0 ... 1, below the body's own surface */
  int32_t displacements; /* 1: beside the stresses; a line contact has none */
  int32_t
      max_elements[2]; /* >= 0; 0: all that the contact may have; fitted rows: twice the nodes */
  double dang_van;     /* -, 0 ... 3, weight of the hydrostatic stress in Dang Van's criterion:
                          3 t/s - 3/2 by the fatigue limits t in torsion, s in bending */
} rp_subsurface_config;

#define RP_SUBSURFACE_FIELDS(X)                                                         \
  X(RP_SUBSURFACE_X, 0, "x") /* m, [nx] */                                              \
  X(RP_SUBSURFACE_Y, 1, "y") /* m, [ny] */                                              \
  /* Pa, [6][depths][ny][nx]: xx, ss, nn, xs, sn, nx */                                 \
  X(RP_SUBSURFACE_STRESS, 2, "stress")                                                  \
  /* m, [3][depths][ny][nx], against the body far away */                               \
  X(RP_SUBSURFACE_DISPLACEMENT, 3, "displacement")                                      \
  /* Pa, [3][depths][ny][nx], from the greatest */                                      \
  X(RP_SUBSURFACE_PRINCIPAL_STRESS, 4, "principal_stress")                              \
  X(RP_SUBSURFACE_VON_MISES, 5, "von_mises")           /* Pa, [depths][ny][nx] */       \
  X(RP_SUBSURFACE_GREATEST_SHEAR, 6, "greatest_shear") /* Pa, [depths][ny][nx] */       \
  /* Pa, [depths][ny]: greatest shear about the shakedown state plus dang_van times the \
   * hydrostatic stress, the most as a point passes below the contact along x */        \
  X(RP_SUBSURFACE_DANG_VAN, 7, "dang_van")
typedef enum rp_subsurface_field { RP_SUBSURFACE_FIELDS(RP_ENUM_ENTRY) } rp_subsurface_field;

RP_API void rp_default_subsurface(rp_subsurface_config *config);
/* Memory for the patches of a contact, or of others with the same grids and materials. */
RP_API rp_error rp_create_subsurface(const rp_contact *contact, const rp_subsurface_config *config,
                                     rp_subsurface **subsurface, rp_message *message);
RP_API void rp_destroy_subsurface(rp_subsurface *subsurface); /* null is allowed */
/* Of the contact's last step; body: an rp_body. Allocates nothing. RP_ERROR_NO_FIELD: no
 * such patch, or its theories give no pressure element by element. */
RP_API rp_error rp_solve_subsurface(rp_subsurface *subsurface, const rp_contact *contact, int side,
                                    int patch, int body, rp_message *message);
/* Copies a field of the last solution, as rp_get_field does. */
RP_API rp_error rp_get_subsurface_field(rp_subsurface *subsurface, rp_subsurface_field field,
                                        double *values, size_t *count);
/* At any points, [count][3]: m, x and y of the contact frame, depth below the body's surface;
 * values: [count][9]: stresses and displacements, as the fields have them. Costs as much as points
 * times elements. Not of a line contact. */
RP_API rp_error rp_stress_at(const rp_contact *contact, int side, int patch, int body,
                             const double *points, size_t count, double *values,
                             rp_message *message);

/* The state that later steps depend on, as plain bytes with version and checksum. A restored
 * handle (same config) steps to the same bits. */
RP_API size_t rp_state_size(const rp_contact *contact);
RP_API rp_error rp_save_state(const rp_contact *contact, void *buffer, size_t size);
RP_API rp_error rp_restore_state(rp_contact *contact, const void *buffer, size_t size);

/* Which stages this scene has and why; info has RP_STAGE_COUNT entries. */
RP_API rp_error rp_describe(const rp_contact *contact, rp_stage_info *info);

RP_API const char *rp_version(void);
RP_API const char *rp_fft_backend(void);
RP_API const char *rp_error_text(rp_error error);
RP_API const char *rp_status_text(rp_status status);
RP_API const char *rp_reason_text(rp_reason reason);
RP_API const char *rp_warning_text(rp_warning warning);
/* Status of contacts beside each other, wheels or wheelsets: the worse where one is not good, else
 * RP_CONVERGED where one of them has contact. */
RP_API rp_status rp_join_status(rp_status a, rp_status b);

#undef RP_ENUM_ENTRY

#ifdef __cplusplus
}
#endif

#endif
