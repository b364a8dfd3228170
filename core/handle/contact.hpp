// What a handle is: a configuration, the driver that its scene asks for, and what the derivatives
// of the last step need.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "handle/grid_levels.hpp"
#include "handle/scene_of.hpp"
#include "patch/driver.hpp"

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
  bool has_jacobian() const { return driver_->has_jacobian(); }
  void jacobian(rp_jacobian &out);
  double friction_coefficient() const { return patch().friction_coefficient; }
  void set_friction_coefficient(double value);

  size_t state_size() const;
  void save_state(unsigned char *buffer) const;
  bool restore_state(const unsigned char *buffer, size_t size);

  rp_error field(int side, int patch, rp_field field, double *values, size_t *count) const;
  void describe(rp_stage_info *info) const;
  // What a patch's solution left, null where there is none of the last step.
  const patch_memory *solution(int side, int patch) const;
  bool mirrors(int side) const { return driver_->mirrors(side); }
  grid_size largest_grid() const { return largest_; }
  // As the checks of inputs read it; its arrays are gone.
  const rp_config &config() const { return config_; }
  // Whether it was made from the same config, with the same arrays.
  bool is_like(const contact &other) const { return fingerprint_ == other.fingerprint_; }

 private:
  // A grid to solve on, with what is made for it.
  struct grid_level {
    explicit grid_level(const scene &made);
    fft_plans plans;
    std::unique_ptr<driver> solver;
  };
  rp_result solve(const rp_input &input);
  rp_result solve_to_accuracy(const rp_input &input);
  bool solve_closed(const rp_input &input, rp_result &out);
  // What the wheels keep beside the patches, as the present step found it: time goes by once.
  void note_kept();
  void take_noted();
  double excess(const rp_result &result) const;
  std::array<double, 2> friction_of_sides() const;  // -, in the last step
  void select(size_t level);
  void go_on(size_t level);
  const patch_scene &patch() const { return driver_->solver().scene(); }
  // Tells the states of one config from those of another.
  static uint64_t fingerprint(const rp_config &config);
  static bool state_fits(driver &target, const unsigned char *patches, size_t size);
  // Takes over what later steps of another handle of the same scene depend on.
  void copy_state(const contact &from);
  void begin_record();
  void end_record(const rp_input &input, const rp_result &result);
  void jacobian_by_differences(rp_jacobian &out);
  void differentiate_by_differences(const rp_input &direction, rp_result &change);

  rp_config config_;
  uint32_t warnings_ = 0;  // of the case
  uint64_t fingerprint_;
  std::vector<std::unique_ptr<grid_level>>
      levels_;                // from the coarsest; one where no accuracy is asked for
  size_t level_ = 0;          // of the last step
  driver *driver_ = nullptr;  // of that level
  double excess_ = 0;         // of the last step's estimate over what is allowed
  std::vector<unsigned char> noted_;
  grid_size largest_;
  double tolerance_ = 0;
  double bulk_temperature_[2] = {0, 0};            // degrees C, where a step says nothing else
  std::unique_ptr<derivative_record> derivative_;  // null: no derivatives
};

}  // namespace railpatch
