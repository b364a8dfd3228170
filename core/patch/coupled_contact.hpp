// Normal and tangential problem of unlike bodies (K not 0), or on a curved reference surface,
// together: solved in turn, each with the other's part given (Panagiotopoulos 1975, Ing.-Arch. 44;
// Kalker 1990, section 4.3). What goes around is the normal displacement d from the tractions,
// which the normal problem takes as part of the undeformed distance:
//   d -> pressure(h + d) -> slip from pressure -> traction -> d'.
// All contact conditions hold but the gap's, which errs by d' - d: that over the greatest normal
// displacement is the remaining error. Steps are accelerated (numeric/fixed_point.hpp).
#pragma once

#include <memory>

#include "half_space/coupling_operator.hpp"
#include "numeric/fixed_point.hpp"
#include "tangential/tangential.hpp"

namespace railpatch {

class coupled_contact {
 public:
  coupled_contact(std::unique_ptr<coupling_operator> coupling, int max_count, bool keeps_steps);

  // Starts from the tractions given; distance: undeformed, of the grid.
  void begin(const grid &g, const double *distance, const double *px, const double *py);
  // The same as if there were no tractions; false where that is what was tried.
  bool forget();
  // h + d
  const double *distance() const { return distance_.data(); }
  // The last step's pressure, where that counts; null: none.
  void remember(const grid &g, const double *pressure);
  // Slip that the pressure adds to the rigid slip, [2][ny][nx]; what else does may be added to it.
  double *slip(int component) { return slip_[component].data(); }
  // Of wheels that roll on the last step's part is in rolling.before.
  void set_slip(const double *pressure, const rolling_input &rolling);
  // m, along each other by the pressure
  void displacement(const double *pressure, double *ux, double *uy) {
    coupling_->from_pressure(0.0, pressure, ux, uy);
  }
  // No round of this solution has been finished.
  bool begins() const { return rounds_ == 0; }
  // m, greatest normal displacement from the pressure
  void set_scale(double value) { scale_ = value; }
  // The greatest d' - d over the scale; a constant part counts only where the approach is given.
  double error(const double *pressure, const double *px, const double *py, bool force_given);
  // Of a tolerance, what the problems on the way are solved to: as long as rounds go on, ever more
  // exactly, since their errors come back multiplied.
  double tolerance(double whole) const;
  // Goes on to the next d.
  void advance();
  // J, energy of pressure and traction by each other
  double energy(const double *pressure) const;
  size_t bytes() const;

 private:
  void set_distance();

  std::unique_ptr<coupling_operator> coupling_;
  fixed_point outer_;
  grid grid_;
  const double *undeformed_ = nullptr;
  bool moved_ = false;  // d is not 0
  double scale_ = 0;
  int rounds_ = 0;
  aligned_buffer<double> distance_, slip_[2], now_, next_, last_pressure_;
};

}  // namespace railpatch
