// The curved reference surface of one patch: a curve across the rolling direction, midway between
// the undeformed wheel and rail (where the deformed surfaces of like bodies meet), and along x as
// it is. Rows of elements are equally spaced on it in arc length; each has its own frame: x, its
// own s along the curve and its own normal n.
//
// The curve's point on the line along n through the patch's reference has arc length 0. Positions
// of rows are given in the frame of the patch from that point, as if it were the reference, which
// it is but for half the approach; so a straight curve gives the plane's results.
#pragma once

#include "geometry/geometry.hpp"
#include "geometry/patch.hpp"
#include "half_space/forces.hpp"
#include "half_space/influence.hpp"

namespace railpatch {

class conformal_rows {
 public:
  explicit conformal_rows(int max_rows);

  // Begins a patch; its bounds along s become arc lengths. false where the curve does not reach.
  bool begin(const side_geometry &side, patch_region &region);
  // Places the rows of a grid and measures the undeformed distance along their normals, [ny][nx].
  // slopes: filled with those of the rail in each row's frame, where pressure acts along its
  // normals.
  void place(const side_geometry &side, const grid &g, double *distance,
             const surface_slopes &slopes = {});
  // Rigid slip of each row at the depth that the wheel's surface has at the reference, relative to
  // the patch's rolling speed (m/s).
  void set_slip(const side_geometry &side, double depth, double rolling_speed);

  // Of a step that goes on from the last one: slips become those of the mean motion, as the
  // reference's do. Creepages, spin, rolling speed (m/s), at the step's end and their mean.
  void take_mean(const grid &g, const double now[4], const double mean[4]);

  // Rigid slip at x (m) in a row.
  double slip(int component, int row, double x) const {
    const auto j = static_cast<size_t>(row);
    return component == 0 ? xi_[j] : eta_[j] + phi_[j] * x;
  }
  // The same between rows, and straight on beyond them.
  double slip(int component, double row, double x) const;
  // rad/m, of each row
  const double *spin() const { return phi_.data(); }
  // In the frame of the patch; pressure acts along the rows' normals, or along the rail's.
  patch_wrench sum_tractions(const grid &g, const double *pressure, const double *px,
                             const double *py) const;
  const double *cosine() const { return cos_.data(); }
  const double *sine() const { return sin_.data(); }
  // Track axes.
  contact_frame frame(int row) const;
  bool valid(int row) const { return valid_[static_cast<size_t>(row)] > 0; }
  double angle(int row) const { return angle_[static_cast<size_t>(row)]; }
  aligned_buffer<double> &angles() { return angle_; }
  const aligned_buffer<double> &angles() const { return angle_; }
  // From track axes to those of the cosines and sines.
  double turned(double angle) const { return angle - reference_.contact_angle; }
  // Arc length of a distance along the reference's s, or that where the curve ends.
  double arc_of(const side_geometry &side, double s) const;
  double y(int row) const { return y_[static_cast<size_t>(row)]; }
  double z(int row) const { return z_[static_cast<size_t>(row)]; }
  size_t bytes() const { return 12 * y_.bytes(); }

 private:
  struct point {
    double y = 0, z = 0, angle = 0;
    bool valid = false;        // both surfaces are there
    double start[2] = {0, 0};  // arc lengths of the profiles, for the next search
  };
  point step(const side_geometry &side, const point &from, double length, double bend) const;
  bool arc_length(const side_geometry &side, double &s) const;
  void keep(int row, const point &p);

  contact_frame reference_;
  point first_;
  double height_ = 0;      // m, of the curve's point along n from the reference
  double lift_ = 0;        // m, the same where rows are seen from there
  surface_slopes slopes_;  // of the rail against the rows' frames; null: not asked for
  int rows_ = 0;
  aligned_buffer<double> y_, z_, angle_, s_, n_, cos_, sin_, xi_, eta_, phi_, valid_, below_;
};

}  // namespace railpatch
