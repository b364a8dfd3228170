// The steps of a patch that is given directly: by its ellipse, its curvatures, as a line contact or
// by its undeformed distance.
#pragma once

#include <optional>

#include "patch/driver.hpp"
#include "patch/patch_grid.hpp"

namespace railpatch {

struct single_patch_setup {
  rp_geometry geometry = RP_SEMI_AXES;
  bool force_given = true;
  double semi_axes[2] = {0, 0}, curvatures[2] = {0, 0};  // m, 1/m
  double line_contact_radius = 0, width = 0;             // m
  bool has_grid = true;
  grid_rules grid;
  grid_size largest;
  const double *distance = nullptr;  // m, [ny][nx] of the largest grid; copied
};

class single_patch final : public driver {
 public:
  single_patch(const single_patch_setup &setup, const patch_scene &scene, const fft_plans &plans,
               stage_marks marks);

  void step(const rp_input &input, rp_result &result) override;
  const patch_memory *find(int side, int patch) const override;
  void differentiate(const rp_input &direction, const rp_input &input, const rp_result &result,
                     rp_result &change) override;
  const char *geometry_reason() const override;
  size_t geometry_bytes() const override { return distance_.bytes(); }
  size_t derivative_bytes() const override;

 private:
  // The last step's problem and rates of what is on its grid, in scenes with exact derivatives.
  struct rates {
    patch_problem problem;
    aligned_buffer<double> distance, row_friction;
  };
  patch_memory &memory() { return memory_.front(); }
  motion regime_of(const rp_input &input) const;
  rolling_input motion_of(const rp_input &input) const;
  bool is_apart(const rp_input &input) const;
  double approach_apart(const rp_input &input) const;
  hertz_contact hertz_of(const rp_input &input) const;
  hertz_contact hertz_rate(const hertz_contact &hertz, const rp_input &direction) const;
  grid hertz_grid(const hertz_contact &hertz, const rp_input &input) const;
  void reach_ahead(const hertz_contact &hertz, const rp_input &input, grid &g) const;
  bool set_grid(const rp_input &input, const patch_memory &m, patch_problem &problem) const;
  bool pose(const rp_input &input, const patch_memory &m, patch_problem &problem) const;
  void set_distance(const patch_problem &problem, patch_memory &m) const;
  static void sum_up(const rp_result &value, rp_result &sum);
  void vary_shape(const rp_input &direction, patch_variation &v);

  single_patch_setup setup_;
  hertz_shape shape_{};              // of curvatures that are given
  hertz_ellipse ellipse_{};          // of semi-axes that are given
  aligned_buffer<double> distance_;  // m, of the case
  std::optional<rates> rates_;
};

}  // namespace railpatch
