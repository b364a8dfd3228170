// A contact scene: configuration, workspace and history of one handle, for a patch given directly
// or for the wheels of a wheelset.
#pragma once

#include <memory>
#include <vector>

#include "patch/patch_contact.hpp"
#include "wheel/rail_support.hpp"
#include "wheel/wheel_contact.hpp"

namespace railpatch {

struct derivative_record;  // contact_derivative.hpp

class contact {
 public:
  // The config has been checked; throws profile_error or std::bad_alloc.
  explicit contact(const rp_config &config);
  ~contact();

  void step(const rp_input &input, rp_result &result);
  void reset();
  // Whether rp_differentiate may be called, and whether there is a step to differentiate.
  bool has_derivatives() const { return derivative_ != nullptr; }
  bool has_solution() const;
  rp_derivative_kind differentiate(const rp_input &direction, rp_result &change);
  // Of wheels.
  void jacobian(rp_jacobian &out);
  double friction_coefficient() const { return solver_.scene().friction_coefficient; }
  void set_friction_coefficient(double value);

  size_t state_size() const;
  void save_state(unsigned char *buffer) const;
  bool restore_state(const unsigned char *buffer, size_t size);

  rp_error field(int side, int patch, rp_field field, double *values, size_t *count) const;
  void describe(rp_stage_info *info) const;
  const rp_config &config() const { return config_; }

 private:
  // Tells the states of one config from those of another.
  static uint64_t fingerprint(const rp_config &config, const aligned_buffer<double> &shape);
  bool has_side(int side) const;
  patch_memory &memory(int side, int patch);
  const patch_memory &memory(int side, int patch) const;
  rolling_input step_of(const rp_input &input) const;
  void step_patch(const rp_input &input, rp_result &result);
  bool pose(const rp_input &in, const patch_memory &m, patch_problem &problem) const;
  bool set_grid(const patch_memory &m, patch_problem &problem) const;
  void set_distance(const patch_problem &problem, patch_memory &m) const;
  void step_wheels(const rp_input &input, rp_result &result);
  template <class Evaluate>
  void find_z(double vertical_force, Evaluate &&evaluate, rp_result &result);
  double evaluate_wheels(double z, rp_result &result);
  void solve_supported(const rp_input &input, rp_result &result);
  void report_search(bool converged, rp_status otherwise, double residual, rp_result &result) const;
  bool state_fits(const unsigned char *patches, size_t size) const;
  // Takes over what later steps of another handle of the same scene depend on.
  void copy_state(const contact &from);
  void begin_record();
  void end_record(const rp_input &input, const rp_result &result);
  void differentiate_patch(const rp_input &direction, rp_result &change);
  void vary_shape(const rp_input &direction, patch_variation &v);
  double friction_rate(const rp_input &direction) const;
  void differentiate_wheels(const rp_input &direction, rp_result &change);
  void exact_jacobian(rp_jacobian &out);
  void jacobian_by_differences(rp_jacobian &out);
  void differentiate_by_differences(const rp_input &direction, rp_result &change);
  size_t derivative_bytes() const;

  rp_config config_;
  fft_plans plans_;
  patch_contact solver_;
  std::vector<patch_memory> memory_;               // of the sides in use, max_patches each
  std::vector<wheel_contact> wheels_;              // of the sides in use
  double depth_ = 0;                               // m, last z found minus first touch; 0: none
  uint64_t scene_ = 0;                             // fingerprint of the config
  aligned_buffer<double> shape_;                   // undeformed distance of the case
  std::unique_ptr<derivative_record> derivative_;  // null: no derivatives
  std::unique_ptr<rail_support> support_;          // where rails are on springs
  friction_factor friction_along_;
};

}  // namespace railpatch
