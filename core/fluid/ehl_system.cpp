#include "fluid/ehl_system.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/sums.hpp"

namespace railpatch {

ehl_system::ehl_system(int max_count) {
  const auto n = static_cast<size_t>(max_count);
  for (auto *field :
       {&gap,          &pressure,      &empty,      &curve,      &content,         &asperity,
        &displacement, &distance_,     &before_,    &thinning_,  &film_,           &film_by_p_,
        &film_by_h_,   &ease_,         &ease_by_p_, &ease_by_h_, &asperity_slope_, &along_pressure_,
        &along_empty_, &off_pressure_, &off_empty_, &grid_in_,   &grid_out_})
    *field = aligned_buffer<double>(n);
  residual = aligned_buffer<double>(2 * n + 1);
  jacobian_ = aligned_buffer<pair>(n * places);
}

void ehl_system::set(const ehl_problem &problem, const ehl_scales &scales) {
  problem_ = problem;
  scales_ = scales;
  nx_ = problem.area.nx;
  ny_ = problem.area.ny;
  count_ = static_cast<size_t>(problem.area.count());
  to_flow(problem.distance, distance_.data());
  if (problem.thinning)
    to_flow(problem.thinning, thinning_.data());
  else
    std::fill_n(thinning_.data(), count_, 1.0);
  if (problem.time_step > 0) to_flow(problem.content_before, before_.data());
}

void ehl_system::to_flow(const double *field, double *v) const {
  for (int s = 0; s < nx_; ++s)
    for (int j = 0; j < ny_; ++j) v[s * ny_ + j] = field[on_grid(s, j)];
}

void ehl_system::to_grid(const double *v, double *field) const {
  for (int s = 0; s < nx_; ++s)
    for (int j = 0; j < ny_; ++j) field[on_grid(s, j)] = v[s * ny_ + j];
}

void ehl_system::evaluate(influence &a) {
  evaluate_elements();
  double *sum = residual.data();  // of both pressures, for now
  for (size_t k = 0; k < count_; ++k) sum[k] = pressure[k] + asperity[k];
  load = total(sum, count_) * problem_.area.dx * problem_.area.dy;
  to_grid(sum, grid_in_.data());
  a.normal_product(grid_in_.data(), grid_out_.data());
  to_flow(grid_out_.data(), displacement.data());
  std::fill_n(residual.data(), 2 * count_ + 1, 0.0);
  for (size_t k = 0; k < count_; ++k) {
    residual[2 * k] = (gap[k] - constant - distance_[k] - displacement[k]) / scales_.gap;
    const double p = pressure[k] / scales_.pressure;
    curve[k] = p + empty[k] - std::sqrt(p * p + empty[k] * empty[k]);
  }
  residual[2 * count_] = problem_.force_given ? load / problem_.force - 1
                                              : (constant + problem_.approach) / scales_.gap;
  evaluate_flows();
}

void ehl_system::evaluate_elements() {
  for (size_t k = 0; k < count_; ++k) {
    const film_of_gap film = film_of(problem_.roughness, gap[k]);
    const with_slope eta = viscosity_ratio(problem_.liquid, pressure[k]);
    const with_slope rho = density_ratio(problem_.liquid, pressure[k]);
    const double flows = 1 / (12 * problem_.liquid.viscosity * thinning_[k] * eta.value);
    film_[k] = rho.value * film.film.value;
    film_by_p_[k] = rho.slope * film.film.value;
    film_by_h_[k] = rho.value * film.film.slope;
    ease_[k] = rho.value * film.cube.value * flows;
    ease_by_h_[k] = rho.value * film.cube.slope * flows;
    ease_by_p_[k] = film.cube.value * flows * (rho.slope - rho.value * eta.slope / eta.value);
    asperity[k] = film.asperity.value;
    asperity_slope_[k] = film.asperity.slope * scales_.gap / scales_.pressure;
    content[k] = film_[k] * (1 - empty[k]);
  }
}

double ehl_system::upstream_content(int j) const {
  const double full =
      nx_ > 1 ? 1.5 * film_[static_cast<size_t>(j)] - 0.5 * film_[static_cast<size_t>(ny_ + j)]
              : film_[static_cast<size_t>(j)];
  return problem_.inlet_film > 0 ? std::min(problem_.inlet_film, full) : full;
}

// What the content on the face downstream of an element has beyond that of the element.
double ehl_system::correction(size_t k, int s) const {
  if (s == 0 || s + 1 == nx_) return 0;
  const auto n = static_cast<size_t>(ny_);
  const double full = (1 - empty[k - n]) * (1 - empty[k]) * (1 - empty[k + n]);
  return full * (2 * film_[k + n] - film_[k] - film_[k - n]) / 6;
}

void ehl_system::evaluate_flows() {
  const double dx = problem_.area.dx, dy = problem_.area.dy;
  const double carried = problem_.speed * dy / scales_.flow;
  const double along = dy / dx / scales_.flow, across = dx / dy / scales_.flow;
  const auto n = static_cast<size_t>(ny_);
  double enters = 0, leaves = 0;
  const auto flow_of = [&](size_t k) -> double & { return residual[2 * k + 1]; };
  for (int j = 0; j < ny_; ++j) {
    const auto first = static_cast<size_t>(j);
    const double in = carried * upstream_content(j) - along * ease_[first] * pressure[first];
    enters += in;
    flow_of(first) -= in;
    for (int s = 0; s < nx_; ++s) {
      const size_t k = static_cast<size_t>(s) * n + first;
      double out = carried * (content[k] + correction(k, s));
      if (s + 1 < nx_) {
        out -= 0.5 * along * (ease_[k] + ease_[k + n]) * (pressure[k + n] - pressure[k]);
        flow_of(k + n) -= out;
      } else {
        out += along * ease_[k] * pressure[k];
        leaves += out;
      }
      flow_of(k) += out;
      if (ny_ == 1) continue;
      if (j == 0) {
        const double side = across * ease_[k] * pressure[k];
        flow_of(k) += side;
        leaves += side;
      }
      double side = across * ease_[k] * pressure[k];
      if (j + 1 < ny_) {
        side = -0.5 * across * (ease_[k] + ease_[k + 1]) * (pressure[k + 1] - pressure[k]);
        flow_of(k + 1) -= side;
      } else {
        leaves += side;
      }
      flow_of(k) += side;
    }
  }
  double stored = 0;
  if (problem_.time_step > 0) {
    const double rate = dx * dy / problem_.time_step / scales_.flow;
    for (size_t k = 0; k < count_; ++k) {
      const double grows = rate * (content[k] - before_[k]);
      flow_of(k) += grows;
      stored += grows;
    }
  }
  passing = enters * scales_.flow;
  imbalance = (enters - leaves - stored) * scales_.flow;
}

void ehl_system::linearise(double delay) {
  std::fill_n(jacobian_.data(), count_ * places, pair{0, 0});
  for (size_t k = 0; k < count_; ++k) {
    const double p = pressure[k] / scales_.pressure, r = std::sqrt(p * p + empty[k] * empty[k]);
    // normal of the curve p + theta = |(p, theta)|; any of its normals where it has no single one
    double a = r > 0 ? 1 - p / r : 1.0, b = r > 0 ? 1 - empty[k] / r : 1.0;
    const double size = std::sqrt(a * a + b * b);
    a /= size;
    b /= size;
    along_pressure_[k] = b;
    along_empty_[k] = -a;
    off_pressure_[k] = -curve[k] / size * a;
    off_empty_[k] = -curve[k] / size * b;
  }
  // what is missing to the curve moves into the residuals
  for (size_t k = 0; k < count_; ++k)
    grid_in_[on_grid(static_cast<int>(k) / ny_, static_cast<int>(k) % ny_)] = off_pressure_[k];
  double missing = 0;
  for (size_t k = 0; k < count_; ++k) missing += off_pressure_[k];
  shift_ = missing;
  double rate = delay * problem_.speed * problem_.area.dy / scales_.flow;
  if (problem_.time_step > 0)
    rate += problem_.area.dx * problem_.area.dy / problem_.time_step / scales_.flow;
  for (int s = 0; s < nx_; ++s)
    for (int j = 0; j < ny_; ++j) {
      linearise_along(s, j);
      if (ny_ > 1) linearise_across(s, j);
      const auto k = static_cast<size_t>(s * ny_ + j);
      if (rate > 0) add(k, here, k, rate * content_slopes(k));
    }
}

ehl_system::slopes ehl_system::content_slopes(size_t k) const {
  const double full = 1 - empty[k];
  return {full * film_by_p_[k], full * film_by_h_[k], -film_[k]};
}

void ehl_system::add(size_t row, place at, size_t node, const slopes &by) {
  pair &to = jacobian_[row * places + static_cast<size_t>(at)];
  const double by_pressure = by.pressure * scales_.pressure;
  to.by_gap += by.gap * scales_.gap;
  to.by_curve += by_pressure * along_pressure_[node] + by.empty * along_empty_[node];
  residual[2 * row + 1] += by_pressure * off_pressure_[node] + by.empty * off_empty_[node];
}

void ehl_system::linearise_along(int s, int j) {
  const auto n = static_cast<size_t>(ny_), k = static_cast<size_t>(s) * n + static_cast<size_t>(j);
  const double carried = problem_.speed * problem_.area.dy / scales_.flow;
  const double along = problem_.area.dy / problem_.area.dx / scales_.flow;
  const auto film_slopes = [&](size_t at, double factor) {
    return slopes{factor * film_by_p_[at], factor * film_by_h_[at], 0};
  };
  const auto ease_slopes = [&](size_t at, double factor) {
    return slopes{factor * ease_by_p_[at], factor * ease_by_h_[at], 0};
  };
  if (s == 0) {
    const double full = nx_ > 1 ? 1.5 * film_[k] - 0.5 * film_[k + n] : film_[k];
    if (!(problem_.inlet_film > 0) || full < problem_.inlet_film) {
      add(k, here, k, film_slopes(k, -carried * (nx_ > 1 ? 1.5 : 1.0)));
      if (nx_ > 1) add(k, after, k + n, film_slopes(k + n, 0.5 * carried));
    }
    slopes out = ease_slopes(k, along * pressure[k]);
    out.pressure += along * ease_[k];
    add(k, here, k, out);
  }
  // of what leaves the element downstream, by those before, here and after it
  slopes by_before{}, by_here = carried * content_slopes(k), by_after{};
  if (s > 0 && s + 1 < nx_) {
    const size_t u = k - n, d = k + n;
    const double fu = 1 - empty[u], f = 1 - empty[k], fd = 1 - empty[d];
    const double bend = carried / 6 * (2 * film_[d] - film_[k] - film_[u]);
    const double full = carried / 6 * fu * f * fd;
    by_before += film_slopes(u, -full);
    by_before.empty -= f * fd * bend;
    by_here += film_slopes(k, -full);
    by_here.empty -= fu * fd * bend;
    by_after += film_slopes(d, 2 * full);
    by_after.empty -= fu * f * bend;
  }
  if (s + 1 < nx_) {
    const double fall = 0.5 * along * (pressure[k + n] - pressure[k]);
    const double mean = 0.5 * along * (ease_[k] + ease_[k + n]);
    by_here += ease_slopes(k, -fall);
    by_here.pressure += mean;
    by_after += ease_slopes(k + n, -fall);
    by_after.pressure -= mean;
  } else {
    by_here += ease_slopes(k, along * pressure[k]);
    by_here.pressure += along * ease_[k];
  }
  add(k, here, k, by_here);
  if (s > 0) add(k, before, k - n, by_before);
  if (s + 1 == nx_) return;
  add(k, after, k + n, by_after);
  add(k + n, before, k, -1.0 * by_here);
  add(k + n, here, k + n, -1.0 * by_after);
  if (s > 0) add(k + n, before_last, k - n, -1.0 * by_before);
}

void ehl_system::linearise_across(int s, int j) {
  const auto k = static_cast<size_t>(s * ny_ + j);
  const double across = problem_.area.dx / problem_.area.dy / scales_.flow;
  const auto edge = [&] {
    const double by = across * pressure[k];
    add(k, here, k, {by * ease_by_p_[k] + across * ease_[k], by * ease_by_h_[k], 0});
  };
  if (j == 0) edge();
  if (j + 1 == ny_) {
    edge();
    return;
  }
  const double fall = 0.5 * across * (pressure[k + 1] - pressure[k]);
  const double mean = 0.5 * across * (ease_[k] + ease_[k + 1]);
  const slopes by_here{-fall * ease_by_p_[k] + mean, -fall * ease_by_h_[k], 0};
  const slopes by_right{-fall * ease_by_p_[k + 1] - mean, -fall * ease_by_h_[k + 1], 0};
  add(k, here, k, by_here);
  add(k, right, k + 1, by_right);
  add(k + 1, left, k, -1.0 * by_here);
  add(k + 1, here, k + 1, -1.0 * by_right);
}

void ehl_system::right_side(influence &a, double *b) {
  a.normal_product(grid_in_.data(), grid_out_.data());
  const double e = elastic_scale();
  const double area = problem_.area.dx * problem_.area.dy;
  for (int s = 0; s < nx_; ++s)
    for (int j = 0; j < ny_; ++j) {
      const auto k = static_cast<size_t>(s * ny_ + j);
      b[2 * k] = -residual[2 * k] + e * grid_out_[on_grid(s, j)];
      b[2 * k + 1] = -residual[2 * k + 1];
    }
  b[2 * count_] = -residual[2 * count_];
  if (problem_.force_given) b[2 * count_] -= shift_ * scales_.pressure * area / problem_.force;
}

void ehl_system::product(influence &a, const double *v, double *out) {
  double sum = 0;
  const auto n = static_cast<size_t>(ny_);
  for (int s = 0; s < nx_; ++s)
    for (int j = 0; j < ny_; ++j) {
      const auto k = static_cast<size_t>(s * ny_ + j);
      const double change = along_pressure_[k] * v[2 * k + 1] + asperity_slope_[k] * v[2 * k];
      grid_in_[on_grid(s, j)] = change;
      sum += change;
    }
  a.normal_product(grid_in_.data(), grid_out_.data());
  const double e = elastic_scale(), constant_change = v[2 * count_];
  for (int s = 0; s < nx_; ++s)
    for (int j = 0; j < ny_; ++j) {
      const auto k = static_cast<size_t>(s * ny_ + j);
      out[2 * k] = v[2 * k] - constant_change - e * grid_out_[on_grid(s, j)];
      const pair *c = jacobian_.data() + k * places;
      const auto term = [&](place at, size_t node) {
        return c[at].by_gap * v[2 * node] + c[at].by_curve * v[2 * node + 1];
      };
      double flow = term(here, k);
      if (s > 1) flow += term(before_last, k - 2 * n);
      if (s > 0) flow += term(before, k - n);
      if (s + 1 < nx_) flow += term(after, k + n);
      if (j > 0) flow += term(left, k - 1);
      if (j + 1 < ny_) flow += term(right, k + 1);
      out[2 * k + 1] = flow;
    }
  out[2 * count_] = problem_.force_given ? sum * scales_.pressure * problem_.area.dx *
                                               problem_.area.dy / problem_.force
                                         : constant_change;
}

void ehl_system::step_of(const double *v, double *by_gap, double *by_pressure,
                         double *by_empty) const {
  for (size_t k = 0; k < count_; ++k) {
    by_gap[k] = v[2 * k] * scales_.gap;
    by_pressure[k] = (along_pressure_[k] * v[2 * k + 1] + off_pressure_[k]) * scales_.pressure;
    by_empty[k] = along_empty_[k] * v[2 * k + 1] + off_empty_[k];
  }
}

size_t ehl_system::bytes() const { return 26 * gap.bytes() + residual.bytes() + jacobian_.bytes(); }

}  // namespace railpatch
