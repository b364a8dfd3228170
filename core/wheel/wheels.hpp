// The steps of one wheel or of a wheelset: all wheels at one height, the height found for a
// prescribed vertical force, roll angle and pitch rate found for a balance, rails that deflect.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "numeric/force_search.hpp"
#include "patch/driver.hpp"
#include "tangential/friction_factor.hpp"
#include "temperature/bulk.hpp"
#include "wheel/height_guess.hpp"
#include "wheel/moment_balance.hpp"
#include "wheel/rail_support.hpp"
#include "wheel/wheel_contact.hpp"
#include "wheel/wheel_derivative.hpp"

namespace railpatch {

// What of a wheelset in balance is found, and what its search starts from.
struct balance_setup {
  bool roll = false, axle = false;  // found: roll angle, pitch rate
  bool along = false;        // with the pitch rate: by the longitudinal force, not the torque
  double half_width = 0;     // m, of the track
  double roller_radius = 0;  // m; 0: rails
  double least_speed = 0;    // m/s, of rolling, that steps of the pitch rate are measured with
};

struct wheels_setup {
  std::vector<wheel_setup> wheel;  // of the sides in use
  int max_patches = 1;             // of each
  grid_size largest;
  bool force_given = true;
  double tolerance = 1e-5;         // of the force that is found
  int most_work = 0;               // operator products of a step; 0: as many as it takes
  double nominal_radius = 0;       // m
  friction_factor friction_along;  // by x
  std::optional<support_setup> support;
  std::optional<bulk_setup> bulk;
  std::optional<balance_setup> balance;
  bool whole_forces = true;  // forces hold the pressures' part along x
};

class force_samples;
class joined_forces;

class wheels final : public driver {
 public:
  wheels(const wheels_setup &setup, const patch_scene &scene, const fft_plans &plans,
         stage_marks marks);

  void step(const rp_input &input, rp_result &result) override;
  void reset() override;
  const patch_memory *find(int side, int patch) const override;
  double friction_scale(int side) const override { return scale_[side]; }
  bool mirrors(int side) const override { return side == RP_LEFT; }
  kept_numbers kept() override;
  void differentiate(const rp_input &direction, const rp_input &input, const rp_result &result,
                     rp_result &change) override;
  bool has_jacobian() const override { return true; }
  bool finds_height() const override { return force_given_; }
  bool uniform_along() const override {
    return !friction_along_.varies() &&
           std::all_of(wheels_.begin(), wheels_.end(),
                       [](const wheel_contact &wheel) { return wheel.uniform_along(); });
  }
  void jacobian(const rp_input &input, const rp_result &result, rp_jacobian &out) override;
  const char *geometry_reason() const override;
  size_t geometry_bytes() const override;
  size_t support_bytes() const override { return support_ ? support_->bytes() : 0; }
  size_t derivative_bytes() const override;

 private:
  // Of scenes whose derivatives come from the equations.
  struct rates {
    wheel_derivative wheels;
    std::vector<rp_side_result> changes;  // [side][direction]
  };
  patch_memory *memory_of(size_t wheel) { return memory_.data() + wheel * patches_; }
  const patch_memory *memory_of(size_t wheel) const { return memory_.data() + wheel * patches_; }
  // Rates of the wheels by side.
  using side_rates = std::array<const rp_side_result *, 2>;
  // A state of the wheelset whose balance is searched (balanced_step.cpp).
  struct balanced_state;
  double evaluate(double z, rp_result &result);
  void solve(const rp_input &input, rp_result &result);
  void solve_balanced(rp_input &input, rp_result &result);
  bool touching_roll(rp_input &input);
  double pitch_condition(const rp_input &in, const rp_result &out) const;
  double torque(const rp_input &input, const rp_result &result) const;
  double torque_rate(const rp_input &input, const rp_input &direction, const rp_result &result,
                     const side_rates &rate) const;
  int found_columns(int (&columns)[3]) const;
  double found_rate(int column, const rp_input &input, const rp_input &direction,
                    const rp_result &result, const side_rates &rate) const;
  bool balance_slopes(const rp_input &input, const rp_result &result, balance_slope &slope);
  void finish(const rp_input &input, rp_result &result);
  void set_bulk(int side);
  void keep_heat(const rp_result &result);
  void keep_cleaning(const rp_input &input, const rp_result &result);
  void keep_drying(rp_result &result);
  void find_z(const rp_input &input, rp_result &result);
  double look_deeper(double touch, double depth, double carries, force_samples &samples,
                     rp_result &result);
  bool beyond() const;
  bool falls_while_joining(double depth, double force, const rp_result &out) const;
  void foresee(double touch, double target, std::array<joined_forces, 2> &forces,
               force_search &search) const;
  double carried(const rp_result &result) const;
  double hertzian_slope(const rp_result &result) const;
  void rest_at(double touch, rp_result &result);
  void solve_supported(const rp_input &input, rp_result &result);
  void report_search(const verdict &found, double residual, rp_result &result) const;
  friction_rates friction_rate(const rp_input &direction, const rp_input &input, int side) const;

  std::vector<wheel_contact> wheels_;
  size_t patches_;  // of each wheel
  bool force_given_;
  double tolerance_, nominal_radius_;
  int most_work_;
  bool whole_forces_;
  double depth_ = 0;                   // m, last z found minus first touch; 0: none
  std::optional<height_guess> guess_;  // where profiles vary
  bool along_track_ = false;           // along the track, else round wheels alone
  friction_factor friction_along_;
  double scale_[2] = {1, 1};               // of the law on each wheel, in this step
  std::optional<rail_support> support_;    // where rails are on springs
  std::optional<bulk_temperatures> bulk_;  // where bodies store heat
  // Friction work on each metre of the wheels' circumference, and how fast it grows; by side.
  struct cleaning {
    double work[2] = {0, 0};  // J/m
    double rate[2] = {0, 0};  // J/(m s)
  };
  std::optional<cleaning> cleaning_;  // where friction's work cleans wheels
  // Of the paste on each wheel: -ln of the water that is left, and its rate by work.
  struct drying {
    double dryness[2] = {0, 0};  // -
    double rate[2] = {0, 0};     // 1/s
  };
  std::optional<drying> drying_;          // where it dries
  drying_paste paste_;                    // which
  double dry_[2] = {0, 0};                // -, of this step
  double cleaned_[2] = {0, 0};            // J/m, of this step, with the rail's
  std::optional<balance_setup> balance_;  // where roll angle or pitch rate are found
  std::unique_ptr<rates> rates_;
};

}  // namespace railpatch
