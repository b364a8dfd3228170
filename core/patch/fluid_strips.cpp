#include "patch/fluid_strips.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fluid/asperities.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

using std::numbers::pi;

namespace {

// Pressures nearer to the hardness close the valleys, which then hold the liquid at any speed: the
// hardness is taken as much above as to leave them open.
constexpr double most_r = 0.55;
// of the nominal pressure that the liquid may bear
constexpr double most_part = 1.0 - 1e-12;
constexpr int steps_of_row = 64;

// Pressure of a run of elements over its greatest: its square is straight between the elements, and
// beyond the last one to the edge, where it would vanish going on as it does, within the element.
class run_of_elements final : public strip_pressure {
 public:
  run_of_elements(const double *first, int count, double dx, bool backwards)
      : first_(first), count_(count), backwards_(backwards) {
    for (int i = 0; i < count; ++i)
      if (value(i) > value(most_)) most_ = i;
    greatest_ = value(most_);
    const auto edge = [&](int last, int before) {
      if (count < 2) return 0.5;
      const double fall = square(before) - square(last);
      return fall > 0 ? std::clamp(square(last) / fall, 0.05, 1.0) : 1.0;
    };
    const double lead = edge(0, 1), trail = edge(count - 1, count - 2);
    over_greatest_ = 1.0 / greatest_;
    over_lead_ = 1.0 / lead;
    over_trail_ = 1.0 / trail;
    front_ = -lead;
    half_ = 0.5 * (count - 1 + lead + trail);
    half_length_ = half_ * dx;
  }
  double half_length() const { return half_length_; }
  double greatest() const { return greatest_; }
  // of an element
  double theta(int i) const { return acos(std::clamp(1.0 - (i - front_) / half_, -1.0, 1.0)); }
  double at(double cosine, double sine, double &slope) const override {
    const double u = front_ + half_ * (1.0 - cosine), moves = half_ * sine;
    const int i = u < 0 ? -1 : std::min(static_cast<int>(u), count_ - 1);
    if (i >= 0 && i + 1 < count_) {
      const double left = square(i), right = square(i + 1);
      const double value = std::sqrt(left + (u - i) * (right - left)) * over_greatest_;
      slope = 0.5 * moves * (right - left) * over_greatest_ * over_greatest_ / value;
      return value;
    }
    const double way = i < 0 ? (u - front_) * over_lead_ : 1.0 - (u - i) * over_trail_;
    const double all = i < 0 ? square(0) : square(i);
    const double value = std::sqrt(all * std::clamp(way, 0.0, 1.0)) * over_greatest_;
    const double rises = all * (i < 0 ? over_lead_ : -over_trail_);
    slope = value > 0 ? 0.5 * moves * rises * over_greatest_ * over_greatest_ / value : 0.0;
    return value;
  }
  double peak() const override { return theta(most_); }

 private:
  // from the leading edge on
  double value(int i) const { return first_[backwards_ ? count_ - 1 - i : i]; }
  double square(int i) const { return value(i) * value(i); }

  const double *first_;
  int count_, most_ = 0;
  bool backwards_;
  double greatest_ = 0, front_ = 0, half_ = 0, half_length_ = 0;
  double over_greatest_ = 0, over_lead_ = 0, over_trail_ = 0;
};

}  // namespace

double strip_liquid::film(double asperities) const {
  const double part = std::clamp(asperities / hardness, 1e-300, most_r);
  return roughness * mean_film(distance_of(part));
}

fluid_strips::fluid_strips(bool elliptic) {
  if (!elliptic) solver_.emplace(steps_of_row);
}

strip_outcome fluid_strips::of_ellipse(const hertz_contact &hertz, const strip_liquid &liquid) {
  strip_outcome found;
  const double s = liquid.s(hertz.semi_axes[0], hertz.max_pressure);
  const double r = std::min(liquid.r(hertz.max_pressure), most_r);
  found.share = strip_table::share_of_ellipse(s, r);
  const double middle = strip_table::at(s, r).pressure(0.5 * pi);
  found.film = liquid.roughness * mean_film(distance_of(r * std::max(1.0 - middle, 1e-12)));
  return found;
}

strip_outcome fluid_strips::solve(const grid &g, const double *pressure, const hertz_contact &hertz,
                                  int direction, const strip_liquid &liquid, double *fluid) {
  const bool ellipse = hertz.semi_axes[0] > 0;
  strip_outcome found;
  std::optional<strip_table::rows_of> rows;
  if (ellipse) {
    found = of_ellipse(hertz, liquid);
    // the same for all rows, as half lengths go with greatest pressures
    rows.emplace(liquid.s(hertz.semi_axes[0], hertz.max_pressure));
  }
  double all = 0, left = 0, greatest = 0, beside = 0;
  off_ = 0;
  for (int j = 0; j < g.ny; ++j) {
    std::fill_n(fluid + j * g.nx, g.nx, 0.0);
    if (ellipse) {
      add_elliptic_row(g, j, pressure, hertz, direction, liquid, *rows, fluid);
    } else {
      for (int i = 0; i < g.nx; ++i) {
        if (!(pressure[j * g.nx + i] > 0)) continue;
        int last = i;
        while (last + 1 < g.nx && pressure[j * g.nx + last + 1] > 0) ++last;
        found.converged =
            add_row(g, j, i, last, pressure, direction, liquid, fluid) && found.converged;
        i = last;
      }
    }
    for (int at = j * g.nx; at < (j + 1) * g.nx; ++at) {
      all += pressure[at];
      left += pressure[at] - fluid[at];
      if (pressure[at] > greatest) greatest = pressure[at], beside = fluid[at];
    }
  }
  if (all > 0) found.share = left / all;
  if (!ellipse) found.film = liquid.film(greatest - beside);
  return found;
}

void fluid_strips::add_elliptic_row(const grid &g, int j, const double *pressure,
                                    const hertz_contact &hertz, int direction,
                                    const strip_liquid &liquid, const strip_table::rows_of &rows,
                                    double *fluid) {
  const double *axes = hertz.semi_axes;
  // rows of elements whose middle lies outside have a sliver of the ellipse
  const double level = std::sqrt(std::max(inside_ellipse(axes, 0.0, g.y(j)), 1e-6));
  const double unit = level * hertz.max_pressure, half = level * axes[0];
  const strip_table::strip row = rows.at(std::min(liquid.r(unit), most_r));
  constexpr int block = 64;
  double from_front[block], found[block];
  int from = 0, to = g.nx;
  while (from < to && !(pressure[j * g.nx + from] > 0)) ++from;
  while (to > from && !(pressure[j * g.nx + to - 1] > 0)) --to;
  for (int begin = from; begin < to; begin += block) {
    const int count = std::min(block, to - begin), first = j * g.nx + begin;
    for (int i = 0; i < count; ++i)
      from_front[i] = std::clamp(-direction * g.x(begin + i) / half, -1.0, 1.0);
    row.pressures(from_front, count, found);
    for (int i = 0; i < count; ++i)
      fluid[first + i] = std::min(unit * found[i], most_part * pressure[first + i]);
  }
}

// Elements first to last of a row.
bool fluid_strips::add_row(const grid &g, int j, int first, int last, const double *pressure,
                           int direction, const strip_liquid &liquid, double *fluid) {
  const int count = last - first + 1;
  // rolling towards +x the leading edge is there
  const run_of_elements run(pressure + j * g.nx + first, count, g.dx, direction > 0);
  const double unit = run.greatest();
  const double number = liquid.s(run.half_length(), unit), r = std::min(liquid.r(unit), most_r);
  const double elliptic = -cos(strip_table::at(number, r).end);
  const strip_solution found = solver_->solve(run, number, r, elliptic + off_, 1e-8);
  off_ = found.cavitation - elliptic;
  const double *theta = solver_->theta(), *p = solver_->liquid();
  const double step = theta[1];
  for (int i = 0; i < count; ++i) {
    const double place = run.theta(i) / step;
    const int k = static_cast<int>(place);
    if (k + 1 >= solver_->nodes()) break;
    const double mean = p[k] + (place - k) * (p[k + 1] - p[k]);
    const int at = j * g.nx + (direction > 0 ? last - i : first + i);
    fluid[at] = std::clamp(unit * mean, 0.0, most_part * pressure[at]);
  }
  return found.converged;
}

}  // namespace railpatch
