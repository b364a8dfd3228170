#include <cstring>
#include <new>

#include "handle/abi.hpp"
#include "handle/case_fields.hpp"
#include "handle/check.hpp"
#include "handle/scene_of.hpp"
#include "numeric/interrupt.hpp"
#include "patch/status.hpp"
#include "railpatch.h"

using namespace railpatch;

// No exception leaves this file: creation may run out of memory or meet a bad profile; a step
// throws nothing of its own.

static rp_error stopped(rp_message *message, const char *call) {
  set_message(message, "%s was interrupted", call);
  return RP_ERROR_INTERRUPTED;
}

#define RP_NO_FIELD(type, name, count)
#define RP_START(type, name, count, role, where, start, ...) \
  for_each_in(to->name, [](auto &v) { v = start; });

void rp_default_config(rp_config *to) {
  if (!to) return;
  std::memset(to, 0, sizeof *to);
  to->cookie = config_cookie;
  RP_CONFIG_FIELDS(RP_START, RP_NO_FIELD)
}

void rp_default_input(rp_input *to) {
  if (!to) return;
  std::memset(to, 0, sizeof *to);
  to->cookie = input_cookie;
  RP_INPUT_FIELDS(RP_START, RP_NO_FIELD)
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
  const rp_error error = check_input(contact->handle.config(),
                                     contact->handle.friction_coefficient(), *input, message);
  if (error != RP_OK) return error;
  try {
    contact->handle.step(*input, *result);
    return RP_OK;
  } catch (const interrupted &) {
    contact->handle.reset();
    return stopped(message, "rp_step");
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
  if (!contact->handle.has_derivatives()) {
    set_message(message, "derivatives is 0, rp_differentiate needs 1");
    return RP_ERROR_VALUE;
  }
  if (const rp_error error = check_direction(*direction, message); error != RP_OK) return error;
  if (!contact->handle.has_solution()) {
    set_message(message,
                "rp_differentiate needs a step since rp_create, rp_reset, rp_restore_state or "
                "rp_set_friction_coefficient");
    return RP_ERROR_STATE;
  }
  try {
    const rp_derivative_kind found = contact->handle.differentiate(*direction, *change);
    if (kind) *kind = found;
    return RP_OK;
  } catch (const interrupted &) {
    return stopped(message, "rp_differentiate");
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
  const bool of_wheels = contact->handle.has_jacobian();
  if (!contact->handle.has_derivatives() || !of_wheels) {
    set_message(message, of_wheels ? "derivatives is 0, rp_get_jacobian needs 1"
                                   : "kind is patch, rp_get_jacobian needs wheel_rail or wheelset");
    return RP_ERROR_VALUE;
  }
  if (is_balanced(contact->handle.config())) {
    set_message(message,
                "roll_balanced, axle_free and longitudinal_prescribed: rp_get_jacobian needs 0");
    return RP_ERROR_VALUE;
  }
  if (!contact->handle.has_solution()) {
    set_message(message,
                "rp_get_jacobian needs a step since rp_create, rp_reset, rp_restore_state or "
                "rp_set_friction_coefficient");
    return RP_ERROR_STATE;
  }
  try {
    contact->handle.jacobian(*out);
    return RP_OK;
  } catch (const interrupted &) {
    return stopped(message, "rp_get_jacobian");
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
  if (error == RP_OK) contact->handle.set_friction_coefficient(value);
  return error;
}

void rp_reset(rp_contact *contact) {
  if (contact) contact->handle.reset();
}

rp_error rp_get_field(const rp_contact *contact, int side, int patch, rp_field field,
                      double *values, size_t *count) {
  if (!contact || !count) return RP_ERROR_NULL;
  return contact->handle.field(side, patch, field, values, count);
}

size_t rp_state_size(const rp_contact *contact) {
  return contact ? contact->handle.state_size() : 0;
}

rp_error rp_save_state(const rp_contact *contact, void *buffer, size_t size) {
  if (!contact || !buffer) return RP_ERROR_NULL;
  if (size < contact->handle.state_size()) return RP_ERROR_SIZE;
  contact->handle.save_state(static_cast<unsigned char *>(buffer));
  return RP_OK;
}

rp_error rp_restore_state(rp_contact *contact, const void *buffer, size_t size) {
  if (!contact || !buffer) return RP_ERROR_NULL;
  const bool restored =
      contact->handle.restore_state(static_cast<const unsigned char *>(buffer), size);
  return restored ? RP_OK : RP_ERROR_STATE;
}

rp_error rp_describe(const rp_contact *contact, rp_stage_info *info) {
  if (!contact || !info) return RP_ERROR_NULL;
  contact->handle.describe(info);
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

rp_status rp_join_status(rp_status a, rp_status b) { return combine_status(a, b); }

const char *rp_status_text(rp_status status) {
  switch (status) { RP_STATUSES(RP_TEXT) }
  return "unknown status";
}

const char *rp_reason_text(rp_reason reason) {
  switch (reason) { RP_REASONS(RP_TEXT) }
  return "unknown reason";
}

const char *rp_warning_text(rp_warning warning) {
  switch (warning) { RP_WARNINGS(RP_TEXT) }
  return "unknown warning";
}
