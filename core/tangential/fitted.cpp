#include "tangential/fitted.hpp"

#include <algorithm>

#include "railpatch.h"

namespace railpatch {

fitted_solver::fitted_solver(const elastic_constants &elastic, double layer_flexibility, bool line,
                             bool forced, const contact_rows &rows)
    : operator_(elastic, layer_flexibility, line, rows),
      newton_(rows.nodes(), rows.strips(), forced) {
  const auto strips = static_cast<size_t>(rows.strips());
  const size_t n = strips * static_cast<size_t>(rows.nodes());
  row_start_ = aligned_buffer<int>(strips + 1);
  bound_ = aligned_buffer<double>(n);
  area_ = aligned_buffer<double>(n);
  for (auto *b : {&rigid_, &p_, &s_}) *b = aligned_buffer<double>(2 * n);
}

size_t fitted_solver::bytes() const {
  return operator_.bytes() + newton_.bytes() + row_start_.bytes() + 2 * bound_.bytes() +
         3 * p_.bytes();
}

template <class F>
void fitted_solver::for_each_node(const contact_rows &rows, int direction, F &&f) const {
  const int nodes = rows.nodes();
  for (int row = 0; row < rows.count(); ++row)
    for (int k = 0; k < nodes; ++k) {
      const int column = direction > 0 ? nodes - 1 - k : k;
      f(row, k, static_cast<size_t>(row * nodes + k), static_cast<size_t>(2 * row * nodes + k),
        static_cast<size_t>((2 * row + 1) * nodes + k),
        static_cast<size_t>(rows[row].strip * nodes + column));
    }
}

tangential_result fitted_solver::solve(const contact_rows &rows, double friction_coefficient,
                                       const rolling_input &input,
                                       const tangential_options &options, fitted_fields fields) {
  operator_.set(rows, input);
  collect(rows, friction_coefficient, input, fields);
  const rolling_problem problem{rows.count(),  row_start_.data(), bound_.data(), area_.data(),
                                rigid_.data(), p_.data(),         s_.data(),     input.force};
  // the last solution under another load may lead Newton's steps astray where none at all does not
  const auto size = static_cast<size_t>(2 * problem.count());
  const bool warm = std::any_of(p_.data(), p_.data() + size, [](double p) { return p != 0; });
  const bool twice = warm && !input.force && options.max_iterations > 1;
  const int most = twice ? options.max_iterations / 2 : options.max_iterations;
  tangential_result result =
      newton_.solve(operator_, problem, {options.tolerance, most, options.ask});
  if (twice && !result.converged) {
    const tangential_result first = result;
    std::fill_n(p_.data(), size, 0.0);
    result = newton_.solve(
        operator_, problem,
        {options.tolerance, options.max_iterations - first.newton_iterations, options.ask});
    result.newton_iterations += first.newton_iterations;
    result.products += first.products;
  }
  release(rows, input.direction, fields);
  return result;
}

void fitted_solver::collect(const contact_rows &rows, double friction_coefficient,
                            const rolling_input &input, const fitted_fields &fields) {
  for (int row = 0; row <= rows.count(); ++row)
    row_start_[static_cast<size_t>(row)] = row * rows.nodes();
  for_each_node(
      rows, input.direction, [&](int row, int k, size_t element, size_t ix, size_t iy, size_t at) {
        const double x = rows[row].x + input.direction * rows[row].half_length * rows.cosine(k);
        const double pressure = rows.pressure(row, k);
        bound_[element] = friction_coefficient * pressure;
        area_[element] = rows.area(row, k);
        rigid_[ix] = input.slip(0, x, rows[row].y);
        rigid_[iy] = input.slip(1, x, rows[row].y);
        // the last solution grows with the pressure
        const double before = fields.pressure[at];
        p_[ix] = before > 0 ? fields.traction.px[at] / before * pressure : 0.0;
        p_[iy] = before > 0 ? fields.traction.py[at] / before * pressure : 0.0;
      });
}

void fitted_solver::release(const contact_rows &rows, int direction, fitted_fields fields) const {
  const tangential_fields &t = fields.traction;
  const int count = rows.strips() * rows.nodes();
  for (double *field : {fields.x, fields.pressure, t.px, t.py, t.sx, t.sy})
    std::fill_n(field, count, 0.0);
  std::fill_n(fields.y, rows.strips(), 0.0);
  std::fill_n(fields.height, rows.strips(), 0.0);
  std::fill_n(t.division, count, static_cast<unsigned char>(RP_EXTERIOR));
  for_each_node(rows, direction,
                [&](int row, int k, size_t element, size_t ix, size_t iy, size_t at) {
                  fields.x[at] = rows[row].x + direction * rows[row].half_length * rows.cosine(k);
                  fields.y[rows[row].strip] = rows[row].y;
                  fields.height[rows[row].strip] = rows[row].height;
                  fields.pressure[at] = rows.pressure(row, k);
                  t.px[at] = p_[ix];
                  t.py[at] = p_[iy];
                  t.sx[at] = s_[ix];
                  t.sy[at] = s_[iy];
                  const bool stick = newton_.sticks(static_cast<int>(element));
                  t.division[at] = static_cast<unsigned char>(stick ? RP_STICK : RP_SLIP);
                });
}

double fitted_solver::elastic_energy(const contact_rows &rows) const {
  // where nothing drives a traction the operator was not asked for a slip
  const bool loaded = std::any_of(p_.data(), p_.data() + 2 * rows.count() * rows.nodes(),
                                  [](double p) { return p != 0; });
  return loaded ? operator_.elastic_energy(rows, p_.data()) : 0.0;
}

patch_wrench fitted_solver::creep_wrench(const contact_rows &rows,
                                         const fitted_fields &fields) const {
  patch_wrench w{};
  // node areas are symmetric about the middle of a row, so that the direction does not matter
  for_each_node(rows, 1, [&](int row, int k, size_t, size_t, size_t, size_t at) {
    const double area = rows.area(row, k), px = fields.traction.px[at];
    const double py = fields.traction.py[at];
    w.force[0] += area * px;
    w.force[1] += area * py;
    w.moment[2] += area * (fields.x[at] * py - rows[row].y * px);
  });
  return w;
}

}  // namespace railpatch
