#include "half_space/forces.hpp"

#include <cstddef>

namespace railpatch {

patch_wrench sum_tractions(const grid &g, const double *pressure, const double *px,
                           const double *py) {
  patch_wrench w{};
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const int at = j * g.nx + i;
      const double x = g.x(i), y = g.y(j), p = pressure[at];
      w.force[2] -= p;
      w.moment[0] -= y * p;
      w.moment[1] += x * p;
      if (!px) continue;
      w.force[0] += px[at];
      w.force[1] += py[at];
      w.moment[2] += x * py[at] - y * px[at];
    }
  const double area = g.dx * g.dy;
  for (int k = 0; k < 3; ++k) {
    w.force[k] *= area;
    w.moment[k] *= area;
  }
  return w;
}

void add_depth(double depth, double longitudinal, double lateral, patch_wrench &wrench) {
  wrench.moment[0] -= depth * lateral;
  wrench.moment[1] += depth * longitudinal;
}

void add_inclined(double force, double moment, double s, double height, double across, double along,
                  patch_wrench &wrench) {
  const double lateral = across * force, longitudinal = along * force;
  wrench.force[0] += longitudinal;
  wrench.force[1] += lateral;
  wrench.moment[0] -= height * lateral;
  wrench.moment[1] += height * longitudinal;
  wrench.moment[2] += across * moment - s * longitudinal;
}

namespace {

// use(row, place among the slopes, force, its moment along x, the force's columns summed) of each
// stretch of equal slopes that is loaded.
template <class Use>
void for_loads(const grid &g, const double *pressure, const surface_slopes &slopes, Use use) {
  const double area = g.dx * g.dy;
  for (int j = 0; j < g.ny; ++j) {
    double force = 0, moment = 0, columns = 0;
    for (int i = 0; i < g.nx; ++i) {
      const double load = area * pressure[j * g.nx + i];
      force += load;
      moment += g.x(i) * load;
      columns += i * load;
      if (slopes.columns == 1 && i + 1 < g.nx) continue;
      if (force != 0)
        use(j, slopes.place(j) + (slopes.columns > 1 ? i : 0), force, moment, columns);
      force = moment = columns = 0;
    }
  }
}

}  // namespace

namespace {

// N, of an elliptic pressure between the row's edges.
template <class T>
T load_of_row(const T &half_width, const T &force, const T &y, const T &half) {
  const auto share = [&](const T &at) {
    T t = at / half_width;
    if (t < -1.0) t = -1.0;
    if (t > 1.0) t = 1.0;
    return T(0.75 * (t - t * t * t / 3.0));
  };
  return force * (share(y + half) - share(y - half));
}

}  // namespace

double load_of_row(const grid &g, const double *pressure, int row) {
  double sum = 0;
  for (int i = 0; i < g.nx; ++i) sum += pressure[row * g.nx + i];
  return sum * g.dx * g.dy;
}

double load_of_row(double half_width, double force, const grid &g, int row) {
  return load_of_row<double>(half_width, force, g.y(row), 0.5 * g.dy);
}

void add_inclined_ellipse(double half_width, double force, const grid &g,
                          const surface_slopes &slopes, patch_wrench &wrench) {
  for (int j = 0; j < g.ny; ++j) {
    const double y = g.y(j), load = load_of_row<double>(half_width, force, y, 0.5 * g.dy);
    add_inclined(load, 0, y, slopes.height[j], slopes.across[j], slopes.along[j], wrench);
  }
}

void add_inclined_ellipse_rates(const directed &half_width, const directed &force, const grid &g,
                                const surface_slopes &slopes, const surface_slopes *rates,
                                double origin, double size, patch_wrench &wrench) {
  const auto rate_of = [&](double *surface_slopes::*field, int j) {
    return directed_of((slopes.*field)[j], rates ? (rates->*field)[j] : 0.0);
  };
  for (int j = 0; j < g.ny; ++j) {
    const directed y = directed_of(g.y(j), origin + j * size);
    const directed load =
        load_of_row<directed>(half_width, force, y, directed_of(0.5 * g.dy, 0.5 * size));
    const directed height = rate_of(&surface_slopes::height, j);
    const directed lateral = rate_of(&surface_slopes::across, j) * load;
    const directed longitudinal = rate_of(&surface_slopes::along, j) * load;
    wrench.force[0] += longitudinal.rate[0];
    wrench.force[1] += lateral.rate[0];
    wrench.moment[0] -= (height * lateral).rate[0];
    wrench.moment[1] += (height * longitudinal).rate[0];
    wrench.moment[2] -= (y * longitudinal).rate[0];
  }
}

void add_inclined(const grid &g, const double *pressure, const surface_slopes &slopes,
                  patch_wrench &wrench) {
  for_loads(g, pressure, slopes, [&](int row, auto at, double force, double moment, double) {
    add_inclined(force, moment, g.y(row), slopes.height[at], slopes.across[at], slopes.along[at],
                 wrench);
  });
}

void add_inclined_rates(const grid &g, const double *pressure, const surface_slopes &slopes,
                        const surface_slopes *rates, const double origin[2], const double size[2],
                        patch_wrench &wrench) {
  for_loads(
      g, pressure, slopes, [&](int row, auto at, double force, double moment, double columns) {
        const double z = slopes.height[at], across = slopes.across[at], along = slopes.along[at];
        const double moved = origin[0] * force + size[0] * columns, ds = origin[1] + row * size[1];
        wrench.moment[2] += across * moved - ds * along * force;
        if (!rates) return;
        const double dz = rates->height[at], lateral = rates->across[at] * force,
                     longitudinal = rates->along[at] * force;
        wrench.force[0] += longitudinal;
        wrench.force[1] += lateral;
        wrench.moment[0] -= z * lateral + dz * across * force;
        wrench.moment[1] += z * longitudinal + dz * along * force;
        wrench.moment[2] += rates->across[at] * moment - g.y(row) * longitudinal;
      });
}

// A surface n = f(x, s) against which the plane turns about x changes by -(s + f f_s), so the
// distance h from the rail's f to the wheel's f - h by -(f h_s + h f_s - h h_s); and likewise about
// s.
namespace {

struct turned_distance {
  double f, h;               // the rail's surface, the distance
  double rise[2], slope[2];  // their slopes along x and s

  double value(int k) const { return f * slope[k] + h * rise[k] - h * slope[k]; }
  double rate(int k, const turned_distance &d) const {
    return d.f * slope[k] + f * d.slope[k] + d.h * rise[k] + h * d.rise[k] - d.h * slope[k] -
           h * d.slope[k];
  }
};

double lateral_slope(const grid &g, const double *h, int at) {
  return (h[at + g.nx] - h[at - g.nx]) / (2 * g.dy);
}

double longitudinal_slope(const grid &g, const double *h, int at) {
  return (h[at + 1] - h[at - 1]) / (2 * g.dx);
}

// use(element, place among the slopes, distance there) of all that carry pressure, but for those at
// the grid's ends.
template <class Use>
void for_turned(const grid &g, const double *pressure, const double *h,
                const surface_slopes &slopes, Use use) {
  for (int j = 1; j + 1 < g.ny; ++j)
    for (int i = 1; i + 1 < g.nx; ++i) {
      const int at = j * g.nx + i;
      if (!(pressure[at] > 0)) continue;
      const auto from = slopes.place(j) + (slopes.columns > 1 ? i : 0);
      use(at, from,
          turned_distance{slopes.height[from],
                          h[at],
                          {slopes.along[from], slopes.across[from]},
                          {longitudinal_slope(g, h, at), lateral_slope(g, h, at)}});
    }
}

}  // namespace

turning_energy energy_of_turning(const grid &g, const double *pressure, const double *h,
                                 const surface_slopes &slopes) {
  double sum[2] = {0, 0};
  for_turned(g, pressure, h, slopes, [&](int at, auto, const turned_distance &d) {
    for (int k = 0; k < 2; ++k) sum[k] += pressure[at] * d.value(k);
  });
  const double area = g.dx * g.dy;
  return {sum[1] * area, -sum[0] * area};
}

turning_energy energy_of_turning_rate(const grid &g, const double *pressure,
                                      const double *pressure_rate, const double *h,
                                      const double *distance_rate, const surface_slopes &slopes,
                                      const surface_slopes *slope_rates, const double size[2]) {
  const double growth = size[0] / g.dx + size[1] / g.dy;
  double sum[2] = {0, 0};
  for_turned(g, pressure, h, slopes, [&](int at, auto from, const turned_distance &d) {
    turned_distance change{};
    if (slope_rates) {
      change.f = slope_rates->height[from];
      change.rise[0] = slope_rates->along[from];
      change.rise[1] = slope_rates->across[from];
    }
    change.slope[0] = -d.slope[0] * size[0] / g.dx;
    change.slope[1] = -d.slope[1] * size[1] / g.dy;
    if (distance_rate) {
      change.h = distance_rate[at];
      change.slope[0] += longitudinal_slope(g, distance_rate, at);
      change.slope[1] += lateral_slope(g, distance_rate, at);
    }
    for (int k = 0; k < 2; ++k)
      sum[k] += (pressure_rate[at] + growth * pressure[at]) * d.value(k) +
                pressure[at] * d.rate(k, change);
  });
  const double area = g.dx * g.dy;
  return {sum[1] * area, -sum[0] * area};
}

}  // namespace railpatch
