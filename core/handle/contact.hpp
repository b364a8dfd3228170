// What a handle is: a configuration, the driver that its scene asks for, and what the derivatives
// of the last step need.
#pragma once

#include <memory>
#include <vector>

#include "handle/scene_of.hpp"
#include "patch/driver.hpp"

namespace railpatch {

struct derivative_record;  // contact_derivative.hpp

class contact {
 public:
  // The config has been checked; throws profile_error or std::bad_alloc.
  explicit contact(const rp_config &config) : contact(config, scene_of(config)) {}
  ~contact();

  void step(const rp_input &input, rp_result &result);
  void reset();
  // Whether rp_differentiate may be called, and whether there is a step to differentiate.
  bool has_derivatives() const { return derivative_ != nullptr; }
  bool has_solution() const;
  rp_derivative_kind differentiate(const rp_input &direction, rp_result &change);
  bool has_jacobian() const { return driver_->has_jacobian(); }
  void jacobian(rp_jacobian &out);
  double friction_coefficient() const { return patch().friction_coefficient; }
  void set_friction_coefficient(double value);

  size_t state_size() const;
  void save_state(unsigned char *buffer) const;
  bool restore_state(const unsigned char *buffer, size_t size);

  rp_error field(int side, int patch, rp_field field, double *values, size_t *count) const;
  void describe(rp_stage_info *info) const;
  // As the checks of inputs read it; its arrays are gone.
  const rp_config &config() const { return config_; }

 private:
  contact(const rp_config &config, const scene &made);
  const patch_scene &patch() const { return driver_->solver().scene(); }
  // Tells the states of one config from those of another.
  static uint64_t fingerprint(const rp_config &config);
  bool state_fits(const unsigned char *patches, size_t size) const;
  // Takes over what later steps of another handle of the same scene depend on.
  void copy_state(const contact &from);
  void begin_record();
  void end_record(const rp_input &input, const rp_result &result);
  void jacobian_by_differences(rp_jacobian &out);
  void differentiate_by_differences(const rp_input &direction, rp_result &change);
  size_t derivative_bytes() const;

  rp_config config_;
  uint64_t fingerprint_;
  fft_plans plans_;
  std::unique_ptr<driver> driver_;
  double tolerance_;
  double bulk_temperature_[2];                     // degrees C, where a step says nothing else
  std::unique_ptr<derivative_record> derivative_;  // null: no derivatives
};

}  // namespace railpatch
