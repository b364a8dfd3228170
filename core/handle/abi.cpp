#include <cmath>
#include <cstring>
#include <new>

#include "handle/check.hpp"
#include "handle/contact.hpp"
#include "numeric/nan.hpp"
#include "railpatch.h"

using namespace railpatch;

struct rp_contact {
  explicit rp_contact(const rp_config &config) : scene(config) {}
  contact scene;
};

// No exception leaves this file: creation may run out of memory or meet a bad profile; a step
// throws nothing of its own.

void rp_default_config(rp_config *config) {
  if (!config) return;
  std::memset(config, 0, sizeof *config);
  rp_config &c = *config;
  c.cookie = config_cookie;
  for (int k = 0; k < 2; ++k) {
    c.shear_modulus[k] = 82e9;
    c.poisson_ratio[k] = 0.28;
    c.semi_axes[k] = 0.006;
    c.curvatures[k] = 1.0;
    c.elements[k] = 24;
  }
  c.geometry = RP_SEMI_AXES;
  c.line_contact_radius = 0.5;
  c.width = 1.0;
  c.regime = RP_STEADY_ROLLING;
  c.friction_coefficient = 0.3;
  c.friction_kinetic = c.friction_reference = 0.3;
  for (double &speed : c.friction_halving_speed) speed = 1.0;
  c.friction_memory_speed = 1e-3;
  c.friction_temperature_range = 1.0;
  for (int k = 0; k < 2; ++k) {
    c.conductivity[k] = 50.0;
    c.heat_capacity[k] = 450.0;
    c.density[k] = 7850.0;
  }
  c.plastic_heat_fraction = 0.9;
  c.normal = RP_NORMAL_HALF_SPACE;
  c.tangential = RP_TANGENTIAL_FULL;
  c.tolerance = 1e-5;
  c.max_iterations = 100;
  c.percent_kalker = 100.0;
  c.polach_k_a = c.polach_k_s = 1.0;
  c.fastsim_k0 = c.fastsim_alpha = 1.0;
  c.side = RP_RIGHT;
  c.nominal_radius = 0.46;
  c.flange_back_distance = 1.36;
  c.flange_back_position = -0.07;
  c.gauge = 1.435;
  c.gauge_height = 0.014;
  c.roller_radius = 1.0;
  c.max_patches = RP_MAX_PATCHES;
  c.standstill_speed = 1e-3;
  c.rail_height_spacing = 1e-3;
}

void rp_default_input(rp_input *input) {
  if (!input) return;
  std::memset(input, 0, sizeof *input);
  input->cookie = input_cookie;
  input->normal_force = 1e5;
  input->vertical_force = 1e5;
  input->rolling_speed = 10.0;
  input->direction = 1;
  for (double &bulk : input->bulk_temperature) bulk = railpatch::nan;
}

void rp_default_direction(rp_input *direction) {
  if (!direction) return;
  std::memset(direction, 0, sizeof *direction);
  direction->cookie = input_cookie;
}

rp_error rp_create(const rp_config *config, rp_contact **contact_out, rp_message *message) {
  if (!config || !contact_out) {
    set_message(message, "%s is null", config ? "contact" : "config");
    return RP_ERROR_NULL;
  }
  if (const rp_error error = check_config(*config, message); error != RP_OK) return error;
  try {
    *contact_out = new rp_contact(*config);
    return RP_OK;
  } catch (const profile_error &e) {
    set_message(message, "profile %s %s", e.field, e.reason);
    return RP_ERROR_PROFILE;
  } catch (const std::bad_alloc &) {
    set_message(message, "out of memory: fewer or larger elements, or smaller max_elements");
    return RP_ERROR_MEMORY;
  } catch (...) {
    set_message(message, "internal error in rp_create");
    return RP_ERROR_INTERNAL;
  }
}

void rp_destroy(rp_contact *contact) { delete contact; }

rp_error rp_step(rp_contact *contact, const rp_input *input, rp_result *result,
                 rp_message *message) {
  if (!contact || !input || !result) {
    set_message(message, "%s is null", !contact ? "contact" : (!input ? "input" : "result"));
    return RP_ERROR_NULL;
  }
  const rp_error error =
      check_input(contact->scene.config(), contact->scene.friction_coefficient(), *input, message);
  if (error != RP_OK) return error;
  try {
    contact->scene.step(*input, *result);
    return RP_OK;
  } catch (...) {
    set_message(message, "internal error in rp_step");
    return RP_ERROR_INTERNAL;
  }
}

rp_error rp_differentiate(rp_contact *contact, const rp_input *direction, rp_result *change,
                          rp_derivative_kind *kind, rp_message *message) {
  if (!contact || !direction || !change) {
    set_message(message, "%s is null",
                !contact ? "contact" : (!direction ? "direction" : "change"));
    return RP_ERROR_NULL;
  }
  if (!contact->scene.has_derivatives()) {
    set_message(message, "derivatives is 0, rp_differentiate needs 1");
    return RP_ERROR_VALUE;
  }
  if (const rp_error error = check_direction(*direction, message); error != RP_OK) return error;
  if (!contact->scene.has_solution()) {
    set_message(message,
                "rp_differentiate needs a step since rp_create, rp_reset or "
                "rp_restore_state");
    return RP_ERROR_STATE;
  }
  try {
    const rp_derivative_kind found = contact->scene.differentiate(*direction, *change);
    if (kind) *kind = found;
    return RP_OK;
  } catch (...) {
    set_message(message, "internal error in rp_differentiate");
    return RP_ERROR_INTERNAL;
  }
}

rp_error rp_get_jacobian(rp_contact *contact, rp_jacobian *out, rp_message *message) {
  if (!contact || !out) {
    set_message(message, "%s is null", contact ? "out" : "contact");
    return RP_ERROR_NULL;
  }
  const rp_config &config = contact->scene.config();
  if (!contact->scene.has_derivatives() || config.kind == RP_PATCH) {
    set_message(message, config.kind == RP_PATCH
                             ? "kind is patch, rp_get_jacobian needs wheel_rail or wheelset"
                             : "derivatives is 0, rp_get_jacobian needs 1");
    return RP_ERROR_VALUE;
  }
  if (!contact->scene.has_solution()) {
    set_message(message,
                "rp_get_jacobian needs a step since rp_create, rp_reset or rp_restore_state");
    return RP_ERROR_STATE;
  }
  try {
    contact->scene.jacobian(*out);
    return RP_OK;
  } catch (...) {
    set_message(message, "internal error in rp_get_jacobian");
    return RP_ERROR_INTERNAL;
  }
}

rp_error rp_set_friction_coefficient(rp_contact *contact, double value, rp_message *message) {
  if (!contact) {
    set_message(message, "contact is null");
    return RP_ERROR_NULL;
  }
  const rp_error error = check_friction_coefficient(value, message);
  if (error == RP_OK) contact->scene.set_friction_coefficient(value);
  return error;
}

void rp_reset(rp_contact *contact) {
  if (contact) contact->scene.reset();
}

rp_error rp_get_field(const rp_contact *contact, int side, int patch, rp_field field,
                      double *values, size_t *count) {
  if (!contact || !count) return RP_ERROR_NULL;
  return contact->scene.field(side, patch, field, values, count);
}

size_t rp_state_size(const rp_contact *contact) {
  return contact ? contact->scene.state_size() : 0;
}

rp_error rp_save_state(const rp_contact *contact, void *buffer, size_t size) {
  if (!contact || !buffer) return RP_ERROR_NULL;
  if (size < contact->scene.state_size()) return RP_ERROR_SIZE;
  contact->scene.save_state(static_cast<unsigned char *>(buffer));
  return RP_OK;
}

rp_error rp_restore_state(rp_contact *contact, const void *buffer, size_t size) {
  if (!contact || !buffer) return RP_ERROR_NULL;
  const bool restored =
      contact->scene.restore_state(static_cast<const unsigned char *>(buffer), size);
  return restored ? RP_OK : RP_ERROR_STATE;
}

rp_error rp_describe(const rp_contact *contact, rp_stage_info *info) {
  if (!contact || !info) return RP_ERROR_NULL;
  contact->scene.describe(info);
  return RP_OK;
}

const char *rp_version(void) { return RP_VERSION; }
const char *rp_fft_backend(void) { return fft_plans::backend(); }

#define RP_TEXT(name, value, text) \
  case name:                       \
    return text;

const char *rp_error_text(rp_error error) {
  switch (error) { RP_ERRORS(RP_TEXT) }
  return "unknown error";
}

const char *rp_status_text(rp_status status) {
  switch (status) { RP_STATUSES(RP_TEXT) }
  return "unknown status";
}
