// Checks of everything that enters through the C interface: each field with its own message, naming
// the field, the value and the allowed range.
#pragma once

#include "railpatch.h"

namespace railpatch {

inline constexpr uint32_t config_cookie = 0x52504331;      // "RPC1"
inline constexpr uint32_t input_cookie = 0x52504931;       // "RPI1"
inline constexpr uint32_t subsurface_cookie = 0x52505331;  // "RPS1"

// Influence coefficients of fitted rows are four numbers for every pair of nodes, here 170 MB.
inline constexpr int max_fitted_nodes = 48 * 48;

// Whether the scene has a uniform grid: closed forms with fitted rows have none.
bool needs_grid(const rp_config &c);
// Whether its creep forces come from a table.
bool uses_table(const rp_config &c);
// Whether a wheel has runout or a rail its height.
bool has_shape(const rp_config &c);

// Each returns RP_OK or the first error found, with its message (which may be null).
rp_error check_config(const rp_config &config, rp_message *message);
rp_error check_friction_coefficient(double value, rp_message *message);
// friction_coefficient: the present one.
rp_error check_input(const rp_config &config, double friction_coefficient, const rp_input &input,
                     rp_message *message);

// Rates of an input: finite, but of a bulk temperature NaN too.
rp_error check_direction(const rp_input &direction, rp_message *message);

// The greatest friction coefficient that the law gives at any place; coefficient: of Coulomb's law.
double most_friction(const rp_config &config, double coefficient);

// Writes a formatted text, cut to size; does nothing where message is null.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void set_message(rp_message *message, const char *format, ...);

}  // namespace railpatch
