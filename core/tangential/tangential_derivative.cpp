#include "tangential/tangential_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/sums.hpp"
#include "railpatch.h"

namespace railpatch {

namespace {

// of products in single precision, relative
constexpr double single_rounding = 3e-7;
// directions of search kept, and made at most
constexpr int kept = 96, most = 600;
// of the preconditioner, narrower than the solver's
constexpr int strips = 24;
constexpr int most_weights = 4;

}  // namespace

template <class F>
size_t tangential_derivative::for_each_unknown(F &&f) const {
  return for_each_row_unknown(elements_.rows(), elements_.row_start(), linear_.data(), f);
}

tangential_derivative::tangential_derivative(int max_nx, int max_ny, int directions)
    : directions_(std::max(directions, most_weights)),
      elements_(max_nx, max_ny),
      strips_(max_nx, strips),
      systems_(2 * max_nx * max_ny, kept, directions_) {
  const auto row = static_cast<size_t>(max_nx), n = row * static_cast<size_t>(max_ny);
  const auto sides = static_cast<size_t>(directions_);
  linear_ = aligned_buffer<element_linearisation>(n);
  for (auto &b : normal_) b = aligned_buffer<double>(n);
  for (auto &b : matrix_) b = aligned_buffer<double>::uninitialized(row * row);
  for (auto *b : {&right_, &solution_}) *b = aligned_buffer<double>::uninitialized(2 * n * sides);
  for (auto *b : {&weight_, &dual_, &back_})
    *b = aligned_buffer<double>::uninitialized(2 * n * most_weights);
  for (auto *b : {&known_, &rate_, &work_, &unknown_}) *b = aligned_buffer<double>(2 * n);
  for (auto &b : by_size_) b = aligned_buffer<double>::uninitialized(2 * n);
}

size_t tangential_derivative::bytes() const {
  return elements_.bytes() + strips_.bytes() + linear_.bytes() + 2 * normal_[0].bytes() +
         2 * matrix_[0].bytes() + 2 * right_.bytes() + 3 * weight_.bytes() + 4 * known_.bytes() +
         3 * by_size_[0].bytes() + systems_.bytes();
}

// The solution's elements and their linear equations.
void tangential_derivative::collect(const tangential_point &point) {
  const grid &g = point.g;
  products_ = exact_ = 0;
  sizes_ready_ = false;
  const double scale =
      2.0 * g.dx /
      ((point.a.coefficient(kernel::xx, 0, 0) + point.a.coefficient(kernel::yy, 0, 0)) -
       (point.a.coefficient(kernel::xx, 1, 0) + point.a.coefficient(kernel::yy, 1, 0)));
  elements_.collect(g, point.pressure, point.rolling.direction);
  elements_.for_each([&](size_t e, size_t at, size_t, size_t) {
    const double factor =
        point.row_friction ? point.row_friction[static_cast<int>(at) / g.nx] : 1.0;
    const double bound = point.friction_coefficient * factor * point.pressure[at];
    const double qx = point.px[at] - scale * point.sx[at];
    const double qy = point.py[at] - scale * point.sy[at], q = hypot(qx, qy);
    normal_[0][e] = normal_[1][e] = 0;
    if (bound > 0 && point.division[at] == RP_STICK) {
      linear_[e] = {{1.0, 0.0}, 0.0, scale, true};
    } else if (bound > 0) {
      normal_[0][e] = qx / q;
      normal_[1][e] = qy / q;
      const double theta = bound / q;
      linear_[e] = {{-qy / q, qx / q}, 1.0 - theta, scale * theta, false};
    } else {
      // without friction the traction stays zero; the rate of its bound acts against the slip
      if (q > 0) normal_[0][e] = qx / q, normal_[1][e] = qy / q;
      linear_[e] = {{1.0, 0.0}, 1.0, 0.0, false};
    }
  });
  vector_ = elements_.vector_size();
  unknowns_ =
      for_each_unknown([](const element_linearisation &, size_t, size_t, size_t, size_t) {});
}

void tangential_derivative::factor(const tangential_point &point, bool transposed) {
  double *bxx = matrix_[0].data(), *byy = matrix_[1].data();
  strips_.set(point.a, point.g, elements_.rows(), transposed);
  row_blocks &blocks = point.blocks;
  blocks.start(elements_.rows(), elements_.row_start());
  const int common = elements_.common_row();
  if (common >= 0) {
    strips_.matrices(elements_, common, point.rolling.direction, bxx, byy);
    blocks.share(elements_.length(common), bxx, byy);
  }
  for (int row = 0; row < elements_.rows(); ++row) {
    const element_linearisation *e = linear_.data() + elements_.row_start()[row];
    if (blocks.set_row(row, e)) continue;
    strips_.matrices(elements_, row, point.rolling.direction, bxx, byy);
    blocks.set_row(row, bxx, byy, e);
  }
}

void tangential_derivative::product(const tangential_point &point, const double *v, double *out,
                                    bool transposed, bool exact) {
  const int direction = transposed ? -point.rolling.direction : point.rolling.direction;
  elements_.product(v, out, [&](double *px, double *py, double *sx, double *sy) {
    if (exact)
      point.a.rolling_product(px, py, direction, sx, sy);
    else
      point.a.rolling_product_single(px, py, direction, sx, sy);
  });
  ++products_;
  exact_ += exact;
}

// right = sign S E^T v
void tangential_derivative::restrict_to_unknowns(const double *v, double sign,
                                                 double *right) const {
  for_each_unknown([&](const element_linearisation &e, size_t i, size_t j, size_t ix, size_t iy) {
    right[i] = sign * e.stiff * (e.c[0] * v[ix] + e.c[1] * v[iy]);
    if (e.stick) right[j] = sign * e.stiff * v[iy];
  });
}

void tangential_derivative::expand(const double *z, double *dp) const {
  for_each_unknown([&](const element_linearisation &e, size_t i, size_t j, size_t ix, size_t iy) {
    dp[ix] = e.c[0] * z[i];
    dp[iy] = e.stick ? z[j] : e.c[1] * z[i];
  });
}

double tangential_derivative::solve_systems(const tangential_point &point, int sides,
                                            bool transposed, double tolerance) {
  factor(point, transposed);
  const auto apply = [&](const double *z, double *out, bool exact, int solution) {
    expand(z, work_.data());
    product(point, work_.data(), unknown_.data(), transposed, exact);
    const double *s = unknown_.data();
    if (solution >= 0 && transposed) std::copy_n(s, vector_, side(back_, solution));
    for_each_unknown([&](const element_linearisation &e, size_t i, size_t j, size_t ix, size_t iy) {
      out[i] = e.keep * z[i] + e.stiff * (e.c[0] * s[ix] + e.c[1] * s[iy]);
      if (e.stick) out[j] = e.stiff * s[iy];
    });
  };
  const auto precondition = [&](double *z) {
    for (int row = 0; row < elements_.rows(); ++row) {
      point.blocks.solve(row, z);
      z += point.blocks.size(row);
    }
  };
  return systems_
      .solve(unknowns_, sides, vector_, right_.data(), solution_.data(),
             {tolerance, single_rounding, most, transposed}, apply, precondition)
      .residual;
}

bool tangential_derivative::along_bound(const tangential_point &point,
                                        const tangential_variation &in, double *dp) const {
  if (!in.pressure && !in.row_friction && in.friction_coefficient == 0) {
    std::fill_n(dp, vector_, 0.0);
    return false;
  }
  const double mu = point.friction_coefficient;
  elements_.for_each([&](size_t k, size_t at, size_t ix, size_t iy) {
    const auto j = static_cast<int>(at) / point.g.nx;
    const double factor = point.row_friction ? point.row_friction[j] : 1.0;
    double rate = in.friction_coefficient * factor * point.pressure[at];
    if (in.pressure) rate += mu * factor * in.pressure[at];
    if (in.row_friction) rate += mu * in.row_friction[j] * point.pressure[at];
    dp[ix] = rate * normal_[0][k];
    dp[iy] = rate * normal_[1][k];
  });
  return true;
}

// B p of the bodies, B' p and B p of the layer, of the tractions as they are.
void tangential_derivative::prepare_sizes(const tangential_point &point) {
  if (sizes_ready_) return;
  sizes_ready_ = true;
  const grid &g = point.g;
  const int direction = point.rolling.direction;
  const double layer = point.a.bodies().layer_flexibility / g.dx;
  elements_.for_each([&](size_t, size_t at, size_t ix, size_t iy) {
    const int i = static_cast<int>(at) % g.nx + direction;
    const bool inside = i >= 0 && i < g.nx;
    const auto ahead = static_cast<size_t>(static_cast<int>(at) + direction);
    by_size_[2][ix] = layer * (point.px[at] - (inside ? point.px[ahead] : 0.0));
    by_size_[2][iy] = layer * (point.py[at] - (inside ? point.py[ahead] : 0.0));
  });
  if (!point.by_length) return;
  double *x = elements_.x(), *y = elements_.y();
  point.a.rolling_product(point.px, point.py, direction, x, y);
  elements_.gather(x, y, by_size_[0].data());
  for (size_t i = 0; i < vector_; ++i) by_size_[0][i] -= by_size_[2][i];
  point.by_length->rolling_product(point.px, point.py, direction, x, y);
  elements_.gather(x, y, by_size_[1].data());
  products_ += 2;
  exact_ += 2;
  if (weights_ < 4) return;
  point.by_length->tangential_product(point.px, point.py, x, y);
  stretch_energy_ = 0.5 * g.dx * g.dy *
                    (dot(point.px, x, static_cast<size_t>(g.count())) +
                     dot(point.py, y, static_cast<size_t>(g.count())));
  ++products_;
  ++exact_;
}

// v = dw + dB p
void tangential_derivative::slip_rate(const tangential_point &point, const tangential_variation &in,
                                      double *v) {
  const grid &g = point.g;
  const rolling_input &r = point.rolling;
  elements_.for_each([&](size_t, size_t at, size_t ix, size_t iy) {
    const int i = static_cast<int>(at) % g.nx, j = static_cast<int>(at) / g.nx;
    const double dx = in.origin[0] + i * in.size[0] + in.spin_offset;
    const double dy = in.origin[1] + j * in.size[1];
    v[ix] = in.creepage[0] - in.spin_creepage * g.y(j) - r.spin_creepage * dy;
    v[iy] = in.creepage[1] + in.spin_creepage * (g.x(i) + r.spin_offset) + r.spin_creepage * dx;
  });
  if (in.size[0] == 0 && in.size[1] == 0) return;
  prepare_sizes(point);
  const double along = in.size[0] / g.dx;
  for (size_t i = 0; i < vector_; ++i) v[i] -= along * by_size_[2][i];
  if (!point.by_length) return;
  const double across = in.size[1] / g.dy, stretch = in.size[0] - g.dx * across;
  for (size_t i = 0; i < vector_; ++i)
    v[i] += (across - along) * by_size_[0][i] + stretch * by_size_[1][i];
}

// l of the two forces, the moment and the elastic energy.
void tangential_derivative::set_weights(const tangential_point &point, const options &o) {
  const grid &g = point.g;
  const double area = g.dx * g.dy;
  weights_ = o.energy ? 4 : 3;
  elements_.for_each([&](size_t, size_t at, size_t ix, size_t iy) {
    const int i = static_cast<int>(at) % g.nx, j = static_cast<int>(at) / g.nx;
    side(weight_, 0)[ix] = side(weight_, 1)[iy] = area;
    side(weight_, 0)[iy] = side(weight_, 1)[ix] = 0;
    side(weight_, 2)[ix] = -area * g.y(j);
    side(weight_, 2)[iy] = area * g.x(i);
  });
  if (!o.energy) return;
  const double *ux = elements_.x(), *uy = elements_.y();
  point.a.tangential_product(point.px, point.py, elements_.x(), elements_.y());
  ++products_;
  ++exact_;
  elements_.for_each([&](size_t, size_t at, size_t ix, size_t iy) {
    side(weight_, 3)[ix] = area * ux[at];
    side(weight_, 3)[iy] = area * uy[at];
  });
}

// What the resultants change by where the tractions stay.
void tangential_derivative::add_geometry(const tangential_point &point,
                                         const tangential_variation &in,
                                         tangential_change &out) const {
  const grid &g = point.g;
  if (in.size[0] == 0 && in.size[1] == 0 && in.origin[0] == 0 && in.origin[1] == 0) return;
  const double growth = in.size[0] / g.dx + in.size[1] / g.dy, area = g.dx * g.dy;
  double force[2] = {0, 0}, moment = 0, moved = 0;
  elements_.for_each([&](size_t, size_t at, size_t, size_t) {
    const int i = static_cast<int>(at) % g.nx, j = static_cast<int>(at) / g.nx;
    const double px = point.px[at], py = point.py[at];
    force[0] += px;
    force[1] += py;
    moment += g.x(i) * py - g.y(j) * px;
    moved += (in.origin[0] + i * in.size[0]) * py - (in.origin[1] + j * in.size[1]) * px;
  });
  for (int c = 0; c < 2; ++c) out.force[c] += growth * area * force[c];
  out.moment += area * (growth * moment + moved);
  if (weights_ < 4 || growth == 0) return;
  // 1/2 p . A p dA: A of the bodies grows with the elements, the layer's does not
  const double *u = weight_.data() + 3 * vector_;
  double bodies = 0, layer = 0;
  elements_.for_each([&](size_t, size_t at, size_t ix, size_t iy) {
    const double px = point.px[at], py = point.py[at];
    const double own = area * point.a.bodies().layer_flexibility * (px * px + py * py);
    layer += own;
    bodies += px * u[ix] + py * u[iy] - own;
  });
  out.energy += 0.5 * growth * (bodies + layer);
  const bool line = point.a.bodies().line_width > 0;
  const double scale = line ? in.size[0] / g.dx : in.size[1] / g.dy;
  out.energy += 0.5 * bodies * scale;
  if (point.by_length) out.energy += stretch_energy_ * (in.size[0] - g.dx * scale);
  if (line) {
    const elastic_constants &e = point.a.bodies().elastic;
    const double c = 2.0 / (std::numbers::pi * e.shear_modulus);
    out.energy -= 0.5 * area * c * in.size[0] *
                  ((1.0 - e.poisson_ratio) * force[0] * force[0] + force[1] * force[1]);
  }
}

double tangential_derivative::begin_resultants(const tangential_point &point, const options &o) {
  collect(point);
  set_weights(point, o);
  for (int k = 0; k < weights_; ++k) restrict_to_unknowns(side(weight_, k), 1.0, side(right_, k));
  // products of solutions, B^T m, are left in back_; of l = 0 there is none
  for (int k = 0; k < weights_; ++k) std::fill_n(side(back_, k), vector_, 0.0);
  const double residual = solve_systems(point, weights_, true, o.tolerance);
  for (int k = 0; k < weights_; ++k) {
    double *m = side(dual_, k), *back = side(back_, k);
    expand(side(solution_, k), m);
    const double *l = side(weight_, k);
    for (size_t i = 0; i < vector_; ++i) back[i] = l[i] - back[i];
  }
  return residual;
}

void tangential_derivative::resultants(const tangential_point &point,
                                       const tangential_variation &in, tangential_change &out) {
  out = {};
  slip_rate(point, in, rate_.data());
  const bool bound = along_bound(point, in, known_.data());
  double *to[] = {&out.force[0], &out.force[1], &out.moment, &out.energy};
  for (int k = 0; k < weights_; ++k) {
    *to[k] = -dot(side(dual_, k), rate_.data(), vector_);
    if (bound) *to[k] += dot(side(back_, k), known_.data(), vector_);
  }
  add_geometry(point, in, out);
}

double tangential_derivative::solve(const tangential_point &point, const tangential_variation *in,
                                    int count, const options &o, tangential_change *out) {
  collect(point);
  set_weights(point, o);
  for (int k = 0; k < count; ++k) {
    slip_rate(point, in[k], rate_.data());
    if (along_bound(point, in[k], known_.data())) {
      product(point, known_.data(), work_.data(), false, true);
      for (size_t i = 0; i < vector_; ++i) rate_[i] += work_[i];
    }
    restrict_to_unknowns(rate_.data(), -1.0, side(right_, k));
  }
  const double residual = solve_systems(point, count, false, o.tolerance);
  for (int k = 0; k < count; ++k) {
    expand(side(solution_, k), rate_.data());
    if (along_bound(point, in[k], known_.data()))
      for (size_t i = 0; i < vector_; ++i) rate_[i] += known_[i];
    out[k] = {};
    double *to[] = {&out[k].force[0], &out[k].force[1], &out[k].moment, &out[k].energy};
    for (int w = 0; w < weights_; ++w) *to[w] = dot(side(weight_, w), rate_.data(), vector_);
    add_geometry(point, in[k], out[k]);
  }
  return residual;
}

}  // namespace railpatch
