#include "patch/fluid_strips.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fluid/asperities.hpp"
#include "numeric/elementary.hpp"
#include "numeric/sums.hpp"

namespace railpatch {

using std::numbers::pi;

namespace {

// Pressures nearer to the hardness close the valleys, which then hold the liquid at any speed: the
// hardness is taken as much above as to leave them open.
constexpr double most_r = 0.55;
// of the nominal pressure that the liquid may bear
constexpr double most_part = 1.0 - 1e-12;
constexpr int steps_of_row = 64;

constexpr double precision = 1e-8;  // of the liquid's pressure and where it cavitates

// The liquid's pressure in the elements of a run; at_nodes: P at even steps of theta from the
// leading edge to `end`.
void read_elements(const pressed_run &run, double end, int nodes, const double *at_nodes,
                   const double *pressure, double *fluid, int stride, double *thetas) {
  const double over_step = (nodes - 1) / end;
  run.thetas(thetas);
  for (int i = 0; i < run.count; ++i) {
    const double place = thetas[i] * over_step;
    const int k = static_cast<int>(place);
    if (k + 1 >= nodes) break;
    const double mean = at_nodes[k] + (place - k) * (at_nodes[k + 1] - at_nodes[k]);
    fluid[i * stride] = std::clamp(run.greatest * mean, 0.0, most_part * pressure[i * stride]);
  }
}

// Of a row of the same nominal pressures but for rounding.
void copy_row(const grid &g, int of, int to, const double *pressure, double *fluid) {
  for (int i = 0; i < g.nx; ++i)
    fluid[to * g.nx + i] = std::min(fluid[of * g.nx + i], most_part * pressure[to * g.nx + i]);
}

}  // namespace

double strip_liquid::film(double asperities) const {
  const double part = std::clamp(asperities / hardness, 1e-300, most_r);
  return roughness * mean_film(distance_of(part));
}

fluid_strips::fluid_strips(bool elliptic, int max_nx, int max_ny) {
  if (elliptic) return;
  const auto longest = static_cast<size_t>(max_nx), all = static_cast<size_t>(max_ny);
  rows_.emplace(by_rows{strip_lanes(steps_of_row), strip_solver(steps_of_row),
                        aligned_buffer<element_run>((longest + 1) / 2 * all),
                        aligned_buffer<double>((longest + 2) * strip_lanes::lanes),
                        aligned_buffer<double>(longest)});
}

strip_outcome fluid_strips::of_ellipse(const hertz_contact &hertz, const strip_liquid &liquid) {
  return of_ellipse(hertz, liquid, rows_of_ellipse(hertz, liquid));
}

strip_table::rows_of fluid_strips::rows_of_ellipse(const hertz_contact &hertz,
                                                   const strip_liquid &liquid) {
  // S is the same for all rows, as half lengths go with greatest pressures
  return strip_table::rows_of(liquid.s(hertz.semi_axes[0], hertz.max_pressure));
}

strip_outcome fluid_strips::of_ellipse(const hertz_contact &hertz, const strip_liquid &liquid,
                                       const strip_table::rows_of &rows) {
  strip_outcome found;
  const double r = std::min(liquid.r(hertz.max_pressure), most_r);
  found.share = rows.share_of_ellipse(r);
  const double middle = rows.at(r).pressure(0.5 * pi);
  found.film = liquid.roughness * mean_film(distance_of(r * std::max(1.0 - middle, 1e-12)));
  return found;
}

strip_outcome fluid_strips::solve(const grid &g, const double *pressure, const hertz_contact &hertz,
                                  int direction, const strip_liquid &liquid, double *fluid) {
  std::fill_n(fluid, g.count(), 0.0);
  strip_outcome found;
  const bool ellipse = hertz.semi_axes[0] > 0;
  if (ellipse) {
    const strip_table::rows_of rows = rows_of_ellipse(hertz, liquid);
    found = of_ellipse(hertz, liquid, rows);
    // an ellipse's rows at y and -y are the same
    const bool mirrored = std::fabs(g.y(0) + g.y(g.ny - 1)) < 1e-9 * g.dy;
    for (int j = 0; j < g.ny; ++j)
      if (mirrored && j > g.ny - 1 - j)
        copy_row(g, g.ny - 1 - j, j, pressure, fluid);
      else
        add_elliptic_row(g, j, pressure, hertz, direction, liquid, rows, fluid);
  } else {
    found.converged = add_rows(g, pressure, direction, liquid, fluid);
    const auto greatest = std::max_element(pressure, pressure + g.count()) - pressure;
    found.film = liquid.film(pressure[greatest] - fluid[greatest]);
  }
  const auto count = static_cast<size_t>(g.count());
  const double all = total(pressure, count);
  if (all > 0) found.share = total_difference(pressure, fluid, count) / all;
  return found;
}

void fluid_strips::add_elliptic_row(const grid &g, int j, const double *pressure,
                                    const hertz_contact &hertz, int direction,
                                    const strip_liquid &liquid, const strip_table::rows_of &rows,
                                    double *fluid) {
  const double *axes = hertz.semi_axes;
  int from = 0, to = g.nx;
  while (from < to && !(pressure[j * g.nx + from] > 0)) ++from;
  while (to > from && !(pressure[j * g.nx + to - 1] > 0)) --to;
  if (from == to) return;
  // rows of elements whose middle lies outside have a sliver of the ellipse
  const double level = std::sqrt(std::max(inside_ellipse(axes, 0.0, g.y(j)), 1e-6));
  const double unit = level * hertz.max_pressure, to_front = -direction / (level * axes[0]);
  const strip_table::strip row = rows.at(std::min(liquid.r(unit), most_r));
  constexpr int block = 64;
  double from_front[block], found[block];
  for (int begin = from; begin < to; begin += block) {
    const int count = std::min(block, to - begin), first = j * g.nx + begin;
    for (int i = 0; i < count; ++i)
      from_front[i] = std::min(std::max(to_front * g.x(begin + i), -1.0), 1.0);
    row.pressures(from_front, count, found);
    for (int i = 0; i < count; ++i)
      fluid[first + i] = std::min(unit * found[i], most_part * pressure[first + i]);
  }
}

strip_solution fluid_strips::solve_one(const strip_lanes::strip &strip) {
  return rows_->one.solve(run_pressure(strip.run), strip.s, strip.r, -cos(strip.start), precision);
}

// Each row of elements that touch, or each part of it. A lane has rows that follow each other, and
// begins with the table's X_c, moved as in the row before.
bool fluid_strips::add_rows(const grid &g, const double *pressure, int direction,
                            const strip_liquid &liquid, double *fluid) {
  constexpr int lanes = strip_lanes::lanes;
  element_run *runs = rows_->runs.data();
  int count = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      if (!(pressure[j * g.nx + i] > 0)) continue;
      const int first = i;
      while (i + 1 < g.nx && pressure[j * g.nx + i + 1] > 0) ++i;
      runs[count++] = {j, first, i};
    }
  const int rounds = (count + lanes - 1) / lanes;
  double off[lanes] = {}, *thetas = rows_->thetas.data();
  bool converged = true;
  for (int round = 0; round < rounds; ++round) {
    strip_lanes::strip strips[lanes];
    double likely[lanes];
    int used = 0;
    for (int at = round; used < lanes && at < count; at += rounds, ++used) {
      strip_lanes::strip &strip = strips[used];
      double *squares = rows_->squares.data() + static_cast<size_t>(used * (g.nx + 2));
      // rolling towards +x the leading edge is there
      strip.run = pressed_run::of(pressure + runs[at].row * g.nx + runs[at].first,
                                  runs[at].last - runs[at].first + 1, direction > 0, squares);
      strip.s = liquid.s(strip.run.half * g.dx, strip.run.greatest);
      strip.r = std::min(liquid.r(strip.run.greatest), most_r);
      likely[used] = strip.likely_end();
      strip.start = std::clamp(likely[used] + off[used], 1e-3, pi);
    }
    rows_->lanes.solve(strips, used, precision);
    for (int l = 0, at = round; l < used; at += rounds, ++l) {
      const element_run &of = runs[at];
      const int leading = of.row * g.nx + (direction > 0 ? of.last : of.first);
      const double *p = pressure + leading;
      double *found = fluid + leading;
      const int stride = direction > 0 ? -1 : 1;
      double end = rows_->lanes.end(l);
      if (rows_->lanes.found(l).converged) {
        read_elements(strips[l].run, end, rows_->lanes.nodes(), rows_->lanes.liquid(l), p, found,
                      stride, thetas);
      } else {
        const strip_solution alone = solve_one(strips[l]);
        const strip_solver &one = rows_->one;
        end = one.theta()[one.nodes() - 1];
        read_elements(strips[l].run, end, one.nodes(), one.liquid(), p, found, stride, thetas);
        converged = converged && alone.converged;
      }
      off[l] = end - likely[l];
    }
  }
  return converged;
}

}  // namespace railpatch
