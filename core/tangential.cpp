#include "tangential.hpp"

#include <algorithm>
#include <cmath>

#include "railpatch.h"

namespace railpatch {

namespace {

constexpr int krylov_size = 40;
constexpr double inner_tolerance = 1e-2;
constexpr int max_inner_products = 200;

double norm(const double *v, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; ++i) sum += v[i] * v[i];
  return std::sqrt(sum);
}

}  // namespace

// Vectors hold, row after row of the grid, the row's p_x and then its p_y: element k of row j with
// first element b and n elements has its components at 2b + (k - b) and 2b + n + (k - b).
template <class F>
void tangential_solver::for_each_element(F &&f) const {
  for (int row = 0; row < rows_; ++row) {
    const int begin = row_start_[static_cast<size_t>(row)];
    const int n = row_start_[static_cast<size_t>(row) + 1] - begin;
    for (int k = 0; k < n; ++k)
      f(static_cast<size_t>(begin + k), static_cast<size_t>(2 * begin + k),
        static_cast<size_t>(2 * begin + n + k));
  }
}

tangential_solver::tangential_solver(int max_nx, int max_ny)
    : blocks_(max_nx, max_ny), linear_solver_(2 * max_nx * max_ny, krylov_size) {
  const auto n = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  column_ = aligned_buffer<int>(n);
  row_of_ = aligned_buffer<int>(n);
  row_start_ = aligned_buffer<int>(static_cast<size_t>(max_ny) + 1);
  bound_ = aligned_buffer<double>(n);
  linear_ = aligned_buffer<element_linearisation>(n);
  for (auto *b : {&rigid_, &p_, &s_, &f_, &step_, &right_, &trial_p_, &trial_s_, &trial_f_})
    *b = aligned_buffer<double>(2 * n);
  for (auto *b : {&grid_px_, &grid_py_, &grid_sx_, &grid_sy_}) *b = aligned_buffer<double>(n);
}

size_t tangential_solver::bytes() const {
  return blocks_.bytes() + linear_solver_.bytes() + 9 * p_.bytes() + 5 * bound_.bytes() +
         linear_.bytes() + 2 * column_.bytes();
}

tangential_result tangential_solver::solve(influence &a, const grid &g, const double *pressure,
                                           const double *bound, const rolling_input &input,
                                           const tangential_options &options,
                                           tangential_fields fields) {
  tangential_result result;
  collect(g, pressure, bound, input, fields);
  // r makes r B of unit size on the diagonal
  r_ = 2.0 * dx_ /
       (a.coefficient(kernel::xx, 0, 0) - a.coefficient(kernel::xx, 1, 0) +
        a.coefficient(kernel::yy, 0, 0) - a.coefficient(kernel::yy, 1, 0));
  std::fill_n(grid_px_.data(), g.count(), 0.0);
  std::fill_n(grid_py_.data(), g.count(), 0.0);
  const double size = scale();
  if (size > 0) {
    project(p_.data());
    micro_slip(a, p_.data(), s_.data());
    ++result.products;
    double error = residual(p_.data(), s_.data(), f_.data());
    for (; error > options.tolerance * size && result.newton_iterations < options.max_iterations;
         ++result.newton_iterations) {
      linearise(a, p_.data(), s_.data());
      for (size_t i = 0; i < vector_size(); ++i) right_[i] = -f_[i];
      const auto inner = linear_solver_.solve(
          vector_size(), right_.data(), step_.data(), inner_tolerance, max_inner_products,
          [&](const double *v, double *out) { apply_jacobian(a, v, out); },
          [&](double *v) { blocks_.solve(row_start_.data(), rows_, v); });
      result.products += inner.products;
      ++result.products;
      error = line_search(a, error, result.products);
    }
    result.residual = error / size;
    result.converged = error <= options.tolerance * size;
  } else {
    // nothing drives a traction: no creepage, no friction or no contact
    std::fill_n(p_.data(), vector_size(), 0.0);
    std::copy_n(rigid_.data(), vector_size(), s_.data());
    result.converged = true;
  }
  release(g, fields, result);
  return result;
}

void tangential_solver::collect(const grid &g, const double *pressure, const double *bound,
                                const rolling_input &input, const tangential_fields &fields) {
  nx_ = g.nx;
  dx_ = g.dx;
  direction_ = input.direction;
  count_ = rows_ = 0;
  for (int j = 0; j < g.ny; ++j) {
    const int begin = count_;
    for (int i = 0; i < g.nx; ++i) {
      const int at = j * g.nx + i;
      if (!(pressure[at] > 0)) continue;
      const auto k = static_cast<size_t>(count_++);
      column_[k] = i;
      row_of_[k] = j;
      bound_[k] = bound[at];
    }
    if (count_ == begin) continue;
    row_start_[static_cast<size_t>(rows_++)] = begin;
  }
  row_start_[static_cast<size_t>(rows_)] = count_;
  for_each_element([&](size_t k, size_t ix, size_t iy) {
    const int at = row_of_[k] * nx_ + column_[k];
    const double x = g.x(column_[k]), y = g.y(row_of_[k]);
    rigid_[ix] = input.slip(0, x, y);
    rigid_[iy] = input.slip(1, x, y);
    p_[ix] = fields.px[at];
    p_[iy] = fields.py[at];
  });
}

// The residual of zero traction: the size against which others are measured.
double tangential_solver::scale() const {
  double sum = 0;
  for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double f = std::min(bound_[k], r_ * std::hypot(rigid_[ix], rigid_[iy]));
    sum += f * f;
  });
  return std::sqrt(sum);
}

// out = B v on the elements of contact.
void tangential_solver::elastic_slip(influence &a, const double *v, double *out) {
  for_each_element([&](size_t k, size_t ix, size_t iy) {
    const auto at = static_cast<size_t>(row_of_[k] * nx_ + column_[k]);
    grid_px_[at] = v[ix];
    grid_py_[at] = v[iy];
  });
  a.rolling_product(grid_px_.data(), grid_py_.data(), direction_, grid_sx_.data(), grid_sy_.data());
  for_each_element([&](size_t k, size_t ix, size_t iy) {
    const auto at = static_cast<size_t>(row_of_[k] * nx_ + column_[k]);
    out[ix] = grid_sx_[at];
    out[iy] = grid_sy_[at];
  });
}

void tangential_solver::micro_slip(influence &a, const double *p, double *s) {
  elastic_slip(a, p, s);
  for (size_t i = 0; i < vector_size(); ++i) s[i] += rigid_[i];
}

double tangential_solver::residual(const double *p, const double *s, double *f) const {
  for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double qx = p[ix] - r_ * s[ix], qy = p[iy] - r_ * s[iy];
    const double q = std::hypot(qx, qy);
    const bool stick = q <= bound_[k];
    f[ix] = stick ? r_ * s[ix] : p[ix] - bound_[k] * qx / q;
    f[iy] = stick ? r_ * s[iy] : p[iy] - bound_[k] * qy / q;
  });
  return norm(f, vector_size());
}

void tangential_solver::project(double *p) const {
  for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double size = std::hypot(p[ix], p[iy]);
    if (size <= bound_[k]) return;
    p[ix] *= bound_[k] / size;
    p[iy] *= bound_[k] / size;
  });
}

// Prepares dF at (p, s) and factors its row blocks.
void tangential_solver::linearise(influence &a, const double *p, const double *s) {
  for_each_element([&](size_t k, size_t ix, size_t iy) {
    element_linearisation &e = linear_[k];
    const double qx = p[ix] - r_ * s[ix], qy = p[iy] - r_ * s[iy];
    const double q = std::hypot(qx, qy);
    if (q <= bound_[k]) {
      e = {{0.0, 0.0, 0.0}, {1.0, 0.0, 1.0}};
      return;
    }
    const double nx = qx / q, ny = qy / q, theta = bound_[k] / q;
    const double t[3] = {theta * (1.0 - nx * nx), -theta * nx * ny, theta * (1.0 - ny * ny)};
    e = {{1.0 - t[0], -t[1], 1.0 - t[2]}, {t[0], t[1], t[2]}};
  });
  blocks_.clear();
  for (int row = 0; row < rows_; ++row) {
    const auto begin = static_cast<size_t>(row_start_[static_cast<size_t>(row)]);
    const int n = row_start_[static_cast<size_t>(row) + 1] - static_cast<int>(begin);
    blocks_.add_row(a, column_.data() + begin, n, direction_, r_ / dx_, linear_.data() + begin);
  }
}

void tangential_solver::apply_jacobian(influence &a, const double *v, double *out) {
  elastic_slip(a, v, out);
  for_each_element([&](size_t k, size_t ix, size_t iy) {
    const element_linearisation &e = linear_[k];
    const double bx = r_ * out[ix], by = r_ * out[iy];
    out[ix] = e.keep[0] * v[ix] + e.keep[1] * v[iy] + e.stiff[0] * bx + e.stiff[1] * by;
    out[iy] = e.keep[1] * v[ix] + e.keep[2] * v[iy] + e.stiff[1] * bx + e.stiff[2] * by;
  });
}

// One trial along the Newton step: p, s and F of the trial, and |F|.
double tangential_solver::try_step(influence &a, double length) {
  for (size_t i = 0; i < vector_size(); ++i) trial_p_[i] = p_[i] + length * step_[i];
  project(trial_p_.data());
  micro_slip(a, trial_p_.data(), trial_s_.data());
  return residual(trial_p_.data(), trial_s_.data(), trial_f_.data());
}

// Takes the longest of the halved Newton steps that lowers |F|; where none does, the whole step, so
// that the active sets move on. Updates p, s and F and returns |F|.
double tangential_solver::line_search(influence &a, double current, int &products) {
  constexpr int halvings = 4;
  double length = 1.0, error = try_step(a, length);
  for (int trial = 0; trial < halvings && error > (1.0 - 1e-3 * length) * current; ++trial) {
    length *= 0.5;
    error = try_step(a, length);
    ++products;
  }
  if (error > (1.0 - 1e-3 * length) * current) error = try_step(a, 1.0);
  std::copy_n(trial_p_.data(), vector_size(), p_.data());
  std::copy_n(trial_s_.data(), vector_size(), s_.data());
  std::copy_n(trial_f_.data(), vector_size(), f_.data());
  return error;
}

void tangential_solver::release(const grid &g, tangential_fields fields,
                                tangential_result &result) {
  std::fill_n(fields.px, g.count(), 0.0);
  std::fill_n(fields.py, g.count(), 0.0);
  std::fill_n(fields.sx, g.count(), 0.0);
  std::fill_n(fields.sy, g.count(), 0.0);
  std::fill_n(fields.division, g.count(), static_cast<unsigned char>(RP_EXTERIOR));
  for_each_element([&](size_t k, size_t ix, size_t iy) {
    const int at = row_of_[k] * nx_ + column_[k];
    fields.px[at] = p_[ix];
    fields.py[at] = p_[iy];
    const bool stick = std::hypot(p_[ix] - r_ * s_[ix], p_[iy] - r_ * s_[iy]) <= bound_[k];
    // in stick the micro-slip is the solver's residual: zero by definition
    fields.sx[at] = stick ? 0.0 : s_[ix];
    fields.sy[at] = stick ? 0.0 : s_[iy];
    fields.division[at] = static_cast<unsigned char>(stick ? RP_STICK : RP_SLIP);
    ++(stick ? result.stick : result.slip);
    result.friction -= (p_[ix] * rigid_[ix] + p_[iy] * rigid_[iy]) * g.dx * g.dy;
  });
}

}  // namespace railpatch
