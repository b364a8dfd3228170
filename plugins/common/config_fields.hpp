// The plain fields of rp_config by name, once for every plug-in that writes or reads them.
// Pointers, profiles, the cookie and the observer are not among them.
#pragma once

#define RAILPATCH_CONFIG_FIELDS(X) \
  X(kind)                          \
  X(shear_modulus)                 \
  X(poisson_ratio)                 \
  X(geometry)                      \
  X(semi_axes)                     \
  X(curvatures)                    \
  X(line_contact_radius)           \
  X(width)                         \
  X(distance_shape)                \
  X(load)                          \
  X(elements)                      \
  X(element_size)                  \
  X(max_elements)                  \
  X(fitted)                        \
  X(regime)                        \
  X(friction_coefficient)          \
  X(layer_shear_modulus)           \
  X(layer_thickness)               \
  X(normal)                        \
  X(tangential)                    \
  X(tolerance)                     \
  X(max_iterations)                \
  X(spin_offset)                   \
  X(percent_kalker)                \
  X(traction_bound)                \
  X(flexibility_blending)          \
  X(polach_k_a)                    \
  X(polach_k_s)                    \
  X(fastsim_k0)                    \
  X(fastsim_alpha)                 \
  X(fastsim_beta)                  \
  X(side)                          \
  X(nominal_radius)                \
  X(flange_back_distance)          \
  X(flange_back_position)          \
  X(track)                         \
  X(gauge)                         \
  X(gauge_height)                  \
  X(cant)                          \
  X(curvature)                     \
  X(roller_radius)                 \
  X(max_patches)
