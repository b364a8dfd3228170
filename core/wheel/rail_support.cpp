#include "wheel/rail_support.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

constexpr int most_evaluations = 120;
constexpr int most_rejected = 24;       // of one iterate, with slopes found there
constexpr double lateral_limit = 5e-3;  // m, of one step
// of a difference: m, and as creepage where the rail's velocity depends on it
constexpr double lateral_difference = 1e-6, creepage_difference = 3e-5;
// -, creepage by vertical velocities on treads is smaller by the contact angle's sine
constexpr double normal_share = 30;
constexpr double most_residual = 1e-3;  // of a start for the next step
constexpr double searched = 1e-3;       // residual that a search is to have first

}  // namespace

rail_support::rail_support(const support_setup &setup)
    : count_(setup.wheels),
      stiffness_(setup.stiffness),
      damping_(setup.damping),
      tolerance_(setup.tolerance),
      modulus_(setup.modulus),
      radius_(setup.radius) {}

void rail_support::reset() { rails_ = {}; }

double rail_support::total(std::size_t k) const {
  return stiffness_[k] + (load_.time_step > 0 ? damping_[k] / load_.time_step : 0.0);
}

double rail_support::carried(std::size_t wheel, std::size_t k) const {
  return load_.time_step > 0 ? damping_[k] / load_.time_step * before_[wheel][k] : 0.0;
}

// The equations at one place of the rails and the wheelset.
bool rail_support::evaluate(supported_wheels &wheels, trial &t) {
  ++evaluations_;
  for (std::size_t w = 0; w < at(count_); ++w)
    for (std::size_t k = 0; k < 2; ++k)
      rails_[w].rate[k] =
          load_.time_step > 0 ? (t.deflection[w][k] - before_[w][k]) / load_.time_step : 0.0;
  const std::array<lateral_vertical, 2> rates{rails_[0].rate, rails_[1].rate};
  wheels.move_rails(t.deflection.data(), rates.data());
  if (!wheels.evaluate(t.z, t.wheel.data())) return false;
  double squares = 0, carrying = 0;
  t.residual = 0;
  for (std::size_t w = 0; w < at(count_); ++w) {
    const lateral_vertical &force = t.wheel[w].force;
    carrying += force[1];
    for (std::size_t k = 0; k < 2; ++k) {
      if (rigid(k)) continue;
      const double elastic = total(k) * t.deflection[w][k], before = carried(w, k);
      const double gap = t.gap[w][k] = elastic - before - force[k];
      const double size =
          length(force) + rounding / tolerance_ * (std::fabs(elastic) + std::fabs(before));
      squares += gap * gap;
      if (gap != 0) t.residual = std::max(t.residual, std::fabs(gap) / size);
    }
  }
  if (load_.prescribed) {
    t.missing = carrying - load_.force;
    squares += t.missing * t.missing;
    if (t.missing != 0) t.residual = std::max(t.residual, std::fabs(t.missing) / load_.force);
  }
  t.merit = std::sqrt(squares);
  return std::isfinite(t.merit);
}

// Depth of a contact with F = c depth^1.5 on the rail's spring, wheelset at z.
double rail_support::guessed_depth(std::size_t wheel, double z) const {
  const double way = z - touch_[wheel];
  if (!(way > 0) && rigid(1)) return 0;
  if (rigid(1)) return way;
  const double k = total(1), before = carried(wheel, 1), c = rails_[wheel].hertz;
  // springs at rest or on their way back may leave the wheel
  double low = 0, high = way - before / k;
  if (!(high > 0)) return 0;
  for (int i = 0; i < 60; ++i) {
    const double depth = 0.5 * (low + high);
    const bool too_deep = c * depth * std::sqrt(depth) > k * (way - depth) - before;
    (too_deep ? high : low) = depth;
  }
  return 0.5 * (low + high);
}

// Where rails on springs under Hertzian contacts would be.
rail_support::trial rail_support::first_guess() const {
  trial t;
  t.z = load_.z;
  const auto force = [&](double z) {
    double sum = 0;
    for (std::size_t w = 0; w < at(count_); ++w)
      if (touch_[w] < nowhere) sum += rails_[w].hertz * pow(guessed_depth(w, z), 1.5);
    return sum;
  };
  if (load_.prescribed) {
    double low = nowhere;
    for (std::size_t w = 0; w < at(count_); ++w)
      low = std::min(low, touch_[w] + (rigid(1) ? 0.0 : carried(w, 1) / total(1)));
    double high = low + 1e-6;
    while (force(high) < load_.force && high < low + 1e3) high = low + 2 * (high - low);
    for (int i = 0; i < 60; ++i) {
      const double z = 0.5 * (low + high);
      (force(z) < load_.force ? low : high) = z;
    }
    t.z = 0.5 * (low + high);
  }
  for (std::size_t w = 0; w < at(count_); ++w) {
    t.deflection[w][0] = lateral_[w];
    if (rigid(1)) continue;
    const double depth = touch_[w] < nowhere ? guessed_depth(w, t.z) : 0;
    const double pressed = rails_[w].hertz * depth * std::sqrt(depth);
    t.deflection[w][1] = (pressed + carried(w, 1)) / total(1);
  }
  return t;
}

// A first iterate that can be evaluated; too great a depth is made smaller.
bool rail_support::start(supported_wheels &wheels, trial &t) {
  for (const double share : {1.0, 0.0}) {
    for (std::size_t w = 0; w < at(count_); ++w)
      lateral_[w] = before_[w][0] + share * last_rate_[w] * load_.time_step;
    if (start_beside(wheels, t)) return true;
    if (!(load_.time_step > 0) || t.nowhere) return false;
  }
  return false;
}

bool rail_support::start_beside(supported_wheels &wheels, trial &t) {
  const lateral_vertical still[2] = {};
  const lateral_vertical moved[2] = {{lateral_[0], 0.0}, {lateral_[1], 0.0}};
  wheels.move_rails(moved, still);
  bool anywhere = false;
  for (int w = 0; w < count_; ++w) {
    double z = 0;
    const bool touches = wheels.first_touch(w, z);
    touch_[at(w)] = touches ? z : nowhere;
    anywhere = anywhere || touches;
    // a ball on a plane, with a typical combined radius
    double &hertz = rails_[at(w)].hertz;
    if (!(hertz > 0)) hertz = 4.0 / 3.0 * modulus_ * std::sqrt(radius_);
  }
  t.nowhere = !anywhere;
  if (!anywhere) {
    t.z = load_.z;
    evaluate(wheels, t);
    return false;
  }
  for (int i = 0; i < 12; ++i) {
    t = first_guess();
    if (evaluate(wheels, t)) return true;
    if (rigid(1) && !load_.prescribed) return false;
    for (rail &r : rails_) r.hertz *= 8.0;
  }
  return false;
}

// Slopes of the forces by differences: all wheels at once, for theirs do not depend on each other.
bool rail_support::find_slopes(supported_wheels &wheels, const trial &base) {
  for (std::size_t k = 0; k < 2; ++k) {
    const bool needed = k == 0 ? !rigid(0) : !rigid(1) || load_.prescribed;
    for (rail &r : rails_) r.slope[0][k] = r.slope[1][k] = 0;
    if (!needed) continue;
    trial moved = base;
    for (std::size_t w = 0; w < at(count_); ++w) {
      const double depth = base.z - base.deflection[w][1] - touch_[w];
      const double rolled = base.wheel[w].rolling_speed * load_.time_step;
      double &h = rails_[w].difference[k];
      if (k == 0)
        h = rolled > 0 ? std::min(lateral_difference, creepage_difference * rolled)
                       : lateral_difference;
      else {
        h = std::clamp(20 * tolerance_, 1e-3, 0.1) * std::max(depth, 1e-7);
        // the rail's vertical velocity is creepage too, where the contact is inclined
        if (rolled > 0) h = std::min(h, normal_share * creepage_difference * rolled);
        h = std::max(h, 1e-10);
      }
      moved.deflection[w][k] += h;
    }
    if (!evaluate(wheels, moved)) return false;
    for (std::size_t w = 0; w < at(count_); ++w)
      for (std::size_t i = 0; i < 2; ++i)
        rails_[w].slope[i][k] =
            (moved.wheel[w].force[i] - base.wheel[w].force[i]) / rails_[w].difference[k];
  }
  for (rail &r : rails_) r.time_step = load_.time_step;
  return true;
}

// The part of a step dp = fixed + by_z dz that may be taken at once.
double rail_support::allowed_part(const trial &base, const std::array<lateral_vertical, 2> &fixed,
                                  const std::array<lateral_vertical, 2> &by_z, double dz,
                                  double share) const {
  double part = share;
  for (std::size_t w = 0; w < at(count_); ++w) {
    const double side = std::fabs(fixed[w][0] + by_z[w][0] * dz);
    const double deeper = -(fixed[w][1] + by_z[w][1] * dz);
    const double depth = std::max(base.z - base.deflection[w][1] - touch_[w], 0.0);
    if (part * side > lateral_limit) part = lateral_limit / side;
    if (touch_[w] < nowhere && part * deeper > 2 * depth + 2e-5) part = (2 * depth + 2e-5) / deeper;
  }
  // a prescribed load needs a contact
  const auto deepest = [&](double taken) {
    double most = 0;
    for (std::size_t w = 0; w < at(count_); ++w) {
      const double depth = base.z - base.deflection[w][1] - touch_[w];
      most = std::max(most, depth - taken * (fixed[w][1] + by_z[w][1] * dz));
    }
    return most;
  };
  const double now = deepest(0);
  while (load_.prescribed && now > 0 && deepest(part) < 0.1 * now) part *= 0.5;
  return part;
}

// Newton's step with the present slopes. With p_z = u_z - z and the slopes S of F by (u_y, p_z):
// (K - S) dp + K e_z dz = -gap for each wheel, and the sum of S_z dp is what is missing of the
// load.
rail_support::trial rail_support::newton_step(const trial &base, double share) const {
  std::array<lateral_vertical, 2> fixed{}, by_z{};  // dp = fixed + by_z dz
  double constant = 0, slope = 0;
  for (std::size_t w = 0; w < at(count_); ++w) {
    // a wheel out of contact has no slopes
    static constexpr std::array<lateral_vertical, 2> none{};
    const auto &s = length(base.wheel[w].force) > 0 ? rails_[w].slope : none;
    double m[2][2] = {{1, 0}, {0, 1}};
    lateral_vertical right{}, right_z{0, -1};
    for (std::size_t k = 0; k < 2; ++k) {
      if (rigid(k)) continue;
      m[k][k] = total(k) - s[k][k];
      m[k][1 - k] = -s[k][1 - k];
      right[k] = -base.gap[w][k];
      if (k == 1) right_z[1] = -total(1);
    }
    double det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    if (!(std::fabs(det) > 1e-9 * (std::fabs(m[0][0] * m[1][1]) + std::fabs(m[0][1] * m[1][0])))) {
      // no slopes to go by: the springs, and sizes
      for (std::size_t k = 0; k < 2; ++k) {
        m[k][1 - k] = 0;
        if (!rigid(k)) m[k][k] = total(k) + std::fabs(s[k][k]);
      }
      det = m[0][0] * m[1][1];
    }
    const auto solved = [&](const lateral_vertical &r) {
      return lateral_vertical{(m[1][1] * r[0] - m[0][1] * r[1]) / det,
                              (m[0][0] * r[1] - m[1][0] * r[0]) / det};
    };
    fixed[w] = solved(right);
    by_z[w] = solved(right_z);
    constant += s[1][0] * fixed[w][0] + s[1][1] * fixed[w][1];
    slope += s[1][0] * by_z[w][0] + s[1][1] * by_z[w][1];
  }
  double dz = 0;
  if (load_.prescribed) {
    dz = -(base.missing + constant) / slope;
    // out of contact: towards it
    if (!(slope > 0)) dz = base.missing < 0 ? 1e-5 : -1e-5;
  }
  const double part = allowed_part(base, fixed, by_z, dz, share);
  trial next = base;
  next.z += part * dz;
  for (std::size_t w = 0; w < at(count_); ++w) {
    if (!rigid(0)) next.deflection[w][0] += part * (fixed[w][0] + by_z[w][0] * dz);
    if (!rigid(1)) next.deflection[w][1] += part * (fixed[w][1] + (by_z[w][1] + 1) * dz);
  }
  return next;
}

// Broyden's update, each direction measured by its difference.
void rail_support::learn(const trial &base, const trial &next) {
  for (std::size_t w = 0; w < at(count_); ++w) {
    if (!(length(base.wheel[w].force) > 0)) continue;
    const lateral_vertical way{next.deflection[w][0] - base.deflection[w][0],
                               next.deflection[w][1] - next.z - base.deflection[w][1] + base.z};
    lateral_vertical scaled{};
    double square = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      if (rails_[w].difference[k] > 0)
        scaled[k] = way[k] / (rails_[w].difference[k] * rails_[w].difference[k]);
      square += scaled[k] * way[k];
    }
    // shorter ways show the errors of the forces
    if (!(square > 1e-4)) continue;
    auto &s = rails_[w].slope;
    for (std::size_t i = 0; i < 2; ++i) {
      const double change = next.wheel[w].force[i] - base.wheel[w].force[i];
      const double error = change - s[i][0] * way[0] - s[i][1] * way[1];
      for (std::size_t k = 0; k < 2; ++k) s[i][k] += error * scaled[k] / square;
    }
  }
}

support_result rail_support::solve(supported_wheels &wheels, const support_load &load) {
  load_ = load;
  evaluations_ = 0;
  for (std::size_t w = 0; w < at(count_); ++w) {
    before_[w] = rails_[w].deflection;
    last_rate_[w] = rails_[w].rate[0];
  }
  if (load.prescribed && load.force == 0) return let_go(wheels);
  trial base;
  if (!start(wheels, base)) {
    stay();
    return {false, true, HUGE_VAL, base.z};
  }
  bool last_is_base = improve(wheels, base);
  // a coarse search and Newton's method from there, then a search to the end
  for (const double goal : {std::max(searched, tolerance_), 0.5 * tolerance_}) {
    if (base.residual <= tolerance_) break;
    trial found = base;
    last_is_base = false;
    if (!search(wheels, found, goal)) continue;
    release_lifted(found);
    if (!evaluate(wheels, found)) continue;
    base = found;
    last_is_base = improve(wheels, base);
  }
  // what is kept of the contact belongs to the place that is reported
  if (!last_is_base) evaluate(wheels, base);
  keep(base);
  if (!(base.residual <= std::max(tolerance_, most_residual))) stay();
  return {base.residual <= tolerance_, false, base.residual, base.z};
}

// Newton's method from an iterate that has been evaluated. Returns whether it was the last to be.
bool rail_support::improve(supported_wheels &wheels, trial &base) {
  const int most = evaluations_ + most_evaluations;
  bool fresh = false, last_is_base = true;
  int rejected = 0;
  double share = 1;
  while (base.residual > tolerance_ && evaluations_ < most) {
    const bool other_step = std::any_of(rails_.begin(), rails_.begin() + count_,
                                        [&](rail &r) { return r.time_step != load_.time_step; });
    if (!fresh && (other_step || rejected >= 2)) {
      last_is_base = false;
      if (!find_slopes(wheels, base)) break;
      fresh = true;
      rejected = 0;
      share = 1;
    }
    trial next = newton_step(base, share);
    const bool solved = evaluate(wheels, next);
    last_is_base = false;
    const bool better = solved && next.merit < (1 - 1e-4 * share) * base.merit;
    // along the direction of true slopes a shorter step is better: they are left as they are
    if (solved && (better || !fresh)) learn(base, next);
    if (better) {
      base = next;
      last_is_base = true;
      fresh = false;
      rejected = 0;
      share = 1;
      continue;
    }
    if (++rejected > most_rejected) break;
    share *= 0.5;
  }
  return last_is_base;
}

// Without load the rails go back by themselves, and the wheels just touch them.
support_result rail_support::let_go(supported_wheels &wheels) {
  trial t;
  const auto back = [&](std::size_t w, std::size_t k) {
    return rigid(k) ? 0.0 : carried(w, k) / total(k);
  };
  for (std::size_t w = 0; w < at(count_); ++w) t.deflection[w] = {back(w, 0), back(w, 1)};
  const lateral_vertical still[2] = {};
  wheels.move_rails(t.deflection.data(), still);
  double touch = nowhere;
  for (int w = 0; w < count_; ++w) {
    double z = 0;
    touch_[at(w)] = nowhere;
    if (!wheels.first_touch(w, z)) continue;
    touch_[at(w)] = z - t.deflection[at(w)][1];
    touch = std::min(touch, z);
  }
  bool known = touch < nowhere, apart = false;
  for (double lift = 0; known && !apart && lift < most_lift;
       lift = lift > 0 ? 2 * lift : least_lift) {
    t.z = touch - lift;
    known = evaluate(wheels, t);
    apart = length(t.wheel[0].force) == 0 && length(t.wheel[1].force) == 0;
  }
  if (!known) {
    if (!(touch < nowhere)) evaluate(wheels, t);
    stay();
    return {false, true, HUGE_VAL, t.z};
  }
  keep(t);
  return {apart, false, t.residual, t.z};
}

// What is no solution is no start: the rails stay where they were.
void rail_support::stay() {
  for (std::size_t w = 0; w < at(count_); ++w) {
    rails_[w] = rail{};
    rails_[w].deflection = before_[w];
  }
}

// The start of the next step.
void rail_support::keep(const trial &last) {
  for (std::size_t w = 0; w < at(count_); ++w) {
    rail &r = rails_[w];
    reported_[w] = {r.deflection = last.deflection[w], r.rate};
    const double depth = last.z - last.deflection[w][1] - touch_[w];
    const double hertz = last.wheel[w].force[1] / (depth * std::sqrt(depth));
    if (depth > 1e-7 && hertz > 1e6 && hertz < 1e14) r.hertz = hertz;
  }
}

}  // namespace railpatch
