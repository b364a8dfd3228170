// Rails on springs and dampers without mass, lateral and vertical.
//
// Deflection u of a rail, track axes, k its stiffness and c its damping in one direction, F the
// force of the wheel on it:  k u + c (u - u_before)/dt = F  (implicit Euler; dt = 0: k u = F). A
// stiffness of 0 stands for a rigid rail. The unknowns are both deflections of each rail and, where
// the vertical force is prescribed, the wheelset's z. Contact sees z - u_z, so the slopes of F by
// z and by u_z are opposite, and each wheel has a 2 x 2 matrix of slopes. They are found by
// differences, updated by Broyden's rule (Broyden 1965, Math. Comp. 19, eq. 4.5) and kept from step
// to step. A step is taken where it makes the residual smaller; else it is shortened, then the
// slopes are found afresh. Where no shorter step helps, as at a bend of the forces, the place is
// bracketed (rail_support_search.cpp), and Newton's method goes on from there.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "numeric/elementary.hpp"

namespace railpatch {

using lateral_vertical = std::array<double, 2>;

// m; how far wheels without load are lifted off what rounding leaves of a contact: doubled from the
// least up to the most
inline constexpr double least_lift = 1e-14, most_lift = 1e-6;

// The wheels as the support needs them.
class supported_wheels {
 public:
  struct wheel_on_rail {
    lateral_vertical force{};  // N, of the wheel on the rail
    double rolling_speed = 0;  // m/s
    bool known = true;
  };
  virtual ~supported_wheels() = default;
  // Moves the rails: deflection (m) and rate (m/s) of each.
  virtual void move_rails(const lateral_vertical *deflection, const lateral_vertical *rate) = 0;
  // z where this wheel first touches its rail as it stands; false: nowhere.
  virtual bool first_touch(int wheel, double &z) = 0;
  // Solves the contacts at z; false where a force is not known.
  virtual bool evaluate(double z, wheel_on_rail *out) = 0;
};

struct support_load {
  bool prescribed = false;
  double force = 0, z = 0;  // N; m where not prescribed
  double time_step = 0;     // s
};

struct support_result {
  bool converged = false, beyond = false;
  double residual = 0;  // relative
  double z = 0;         // m
};

struct support_setup {
  int wheels = 1;                                // or 2
  std::array<double, 2> stiffness{}, damping{};  // N/m, N s/m: lateral, vertical
  double tolerance = 1e-5;
  double modulus = 0;  // Pa, G/(1 - nu) of the bodies
  double radius = 0;   // m, a typical combined one
};

class rail_support {
 public:
  explicit rail_support(const support_setup &setup);

  support_result solve(supported_wheels &wheels, const support_load &load);
  // Of the last step; rate 0 without a time step.
  const lateral_vertical &deflection(int wheel) const { return reported_[at(wheel)].deflection; }
  const lateral_vertical &rate(int wheel) const { return reported_[at(wheel)].rate; }
  void reset();

  // What later steps depend on: plain numbers.
  struct rail {
    lateral_vertical deflection{}, rate{};
    std::array<lateral_vertical, 2> slope{};  // N/m, force by lateral, vertical deflection
    double hertz = 0;                         // N/m^1.5, of the last contact; 0: none yet
    lateral_vertical difference{};            // m, the slopes were found with
    double time_step = -1;                    // s, of the slopes; < 0: none yet
  };
  rail *rails() { return rails_.data(); }
  const rail *rails() const { return rails_.data(); }
  std::size_t bytes() const { return sizeof *this; }

 private:
  struct trial {
    double z = 0;
    std::array<lateral_vertical, 2> deflection{};
    std::array<supported_wheels::wheel_on_rail, 2> wheel{};
    std::array<lateral_vertical, 2> gap{};  // N, of each rail's equation
    double missing = 0;                     // N, of the prescribed force
    double merit = 0, residual = 0;         // N; relative
    bool nowhere = false;                   // no wheel has a rail below it
  };
  struct both_roots;
  static constexpr double nowhere = HUGE_VAL;
  static constexpr double rounding = 1e-12;   // relative, of k u and c u_before/dt
  static constexpr int most_searched = 6000;  // evaluations of a step that is bracketed
  static std::size_t at(int wheel) { return static_cast<std::size_t>(wheel); }
  static double length(const lateral_vertical &v) { return hypot(v[0], v[1]); }
  // One wheel has all of the prescribed force: its rail's vertical place is known.
  bool load_alone() const { return load_.prescribed && count_ == 1; }
  bool rigid(std::size_t k) const { return !(stiffness_[k] > 0); }
  double total(std::size_t k) const;                       // N/m, k + c/dt
  double carried(std::size_t wheel, std::size_t k) const;  // N, c/dt u_before
  bool evaluate(supported_wheels &wheels, trial &t);
  trial first_guess() const;
  double guessed_depth(std::size_t wheel, double z) const;
  bool start(supported_wheels &wheels, trial &t);
  bool start_beside(supported_wheels &wheels, trial &t);
  support_result let_go(supported_wheels &wheels);
  void stay();
  bool find_slopes(supported_wheels &wheels, const trial &base);
  trial newton_step(const trial &base, double share) const;
  double allowed_part(const trial &base, const std::array<lateral_vertical, 2> &fixed,
                      const std::array<lateral_vertical, 2> &by_z, double dz, double share) const;
  void learn(const trial &base, const trial &next);
  bool improve(supported_wheels &wheels, trial &base);
  bool search(supported_wheels &wheels, trial &t, double tolerance);
  bool search_sideways(supported_wheels &wheels, trial &t, double tolerance);
  bool search_depth(supported_wheels &wheels, trial &t, double tolerance);
  void place(std::size_t wheel, double depth, trial &t) const;
  double guessed_depth_of(std::size_t wheel, double z) const;
  double size_of(const trial &t) const;
  void release_lifted(trial &t) const;
  void keep(const trial &last);

  int count_;
  std::array<double, 2> stiffness_, damping_;
  double tolerance_, modulus_, radius_;
  std::array<rail, 2> rails_{};
  std::array<lateral_vertical, 2> before_{};
  struct motion {
    lateral_vertical deflection{}, rate{};
  };
  std::array<motion, 2> reported_{};
  std::array<double, 2> last_rate_{};  // m/s, lateral
  std::array<double, 2> lateral_{};    // m, first guess
  support_load load_;
  std::array<double, 2> touch_{};  // m, z of first touch with the rail not deflected
  int evaluations_ = 0;
};

}  // namespace railpatch
