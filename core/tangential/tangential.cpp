#include "tangential/tangential.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "railpatch.h"

namespace railpatch {

template <class F>
void tangential_solver::for_each_element(F &&f) const {
  for_each_row_element(rows_, row_start_.data(), [&](size_t element, size_t ix, size_t iy) {
    f(element, static_cast<size_t>(at_[element]), ix, iy);
  });
}

// of the preconditioner across the contact: few enough to hold what neighbouring rows do together,
// enough to follow the edge of slip
constexpr int strips = 8;

// The elements of contact collected in tangential_solver, and the influence coefficients.
class tangential_solver::grid_operator final : public rolling_operator {
 public:
  grid_operator(tangential_solver &solver, influence &a, const grid &g, int direction)
      : solver_(solver), a_(a), g_(g), direction_(direction) {
    std::fill_n(solver_.grid_px_.data(), g.count(), 0.0);
    std::fill_n(solver_.grid_py_.data(), g.count(), 0.0);
    const int strip = 1 + solver_.rows_ / strips;
    set_line(kernel::xx, strip, solver_.line_[0].data() + g.nx);
    set_line(kernel::yy, strip, solver_.line_[1].data() + g.nx);
  }

  void product(const double *p, double *s) override {
    scatter(p);
    tangential_solver &t = solver_;
    a_.rolling_product(t.grid_px_.data(), t.grid_py_.data(), direction_, t.grid_sx_.data(),
                       t.grid_sy_.data());
    gather(s);
  }
  void product_single(const double *p, double *s) override {
    scatter(p);
    tangential_solver &t = solver_;
    a_.rolling_product_single(t.grid_px_.data(), t.grid_py_.data(), direction_, t.grid_sx_.data(),
                              t.grid_sy_.data());
    gather(s);
  }

  // The tractions that a step changes differ little from a row to its neighbours, whose slip one
  // row alone does not see. So the preconditioner's rows are strips: the mean slip in a strip of
  // several rows from tractions that are the same in all of them. xy has no part in it.
  void row_matrices(int row, double *bxx, double *byy) const override {
    const int begin = solver_.row_start_[static_cast<size_t>(row)];
    const int n = solver_.row_start_[static_cast<size_t>(row) + 1] - begin;
    const int *at = solver_.at_.data() + begin;
    // entries by the number of elements that the source lies ahead of the observer
    const double *xx = solver_.line_[0].data() + g_.nx, *yy = solver_.line_[1].data() + g_.nx;
    const bool gapless = std::abs(at[n - 1] - at[0]) == n - 1;
    for (int source = 0; source < n; ++source) {
      double *x = bxx + source * n, *y = byy + source * n;
      if (gapless) {
        std::copy_n(xx - source, n, x);
        std::copy_n(yy - source, n, y);
        continue;
      }
      for (int observer = 0; observer < n; ++observer) {
        const int ahead = direction_ * (at[source] - at[observer]);
        x[observer] = xx[ahead];
        y[observer] = yy[ahead];
      }
    }
  }

  // the longest, where none has a gap
  int common_row(const rolling_problem &problem) const override {
    int longest = 0;
    for (int row = 0; row < problem.rows; ++row) {
      const int begin = problem.row_start[row], n = problem.row_start[row + 1] - begin;
      const int *at = solver_.at_.data() + begin;
      if (std::abs(at[n - 1] - at[0]) != n - 1) return -1;
      if (n > problem.row_start[longest + 1] - problem.row_start[longest]) longest = row;
    }
    return longest;
  }

  // makes r B of unit size on the diagonal
  double projection_scale(int) const override {
    return 2.0 / (entry(kernel::xx, 0) + entry(kernel::yy, 0));
  }

 private:
  void scatter(const double *p) {
    solver_.for_each_element([&](size_t, size_t at, size_t ix, size_t iy) {
      solver_.grid_px_[at] = p[ix];
      solver_.grid_py_[at] = p[iy];
    });
  }
  void gather(double *s) const {
    solver_.for_each_element([&](size_t, size_t at, size_t ix, size_t iy) {
      s[ix] = solver_.grid_sx_[at];
      s[iy] = solver_.grid_sy_[at];
    });
  }
  double entry(kernel k, int offset) const {
    return (a_.coefficient(k, offset, 0) - a_.coefficient(k, offset + direction_, 0)) / g_.dx;
  }
  // Entries by the number of elements, -nx ... nx, that the source lies ahead of the observer; rows
  // of a strip that lie j apart are strip - j pairs.
  void set_line(kernel k, int strip, double *line) const {
    std::fill(line - g_.nx, line + g_.nx + 1, 0.0);
    for (int j = 0; j < strip; ++j) {
      const double weight = (j == 0 ? 1.0 : 2.0) * (strip - j) / (strip * g_.dx);
      double before = a_.coefficient(k, g_.nx + 1, j);
      for (int ahead = -g_.nx; ahead <= g_.nx; ++ahead) {
        const double here = a_.coefficient(k, ahead, j);
        line[ahead] += weight * (here - before);
        before = here;
      }
    }
  }

  tangential_solver &solver_;
  influence &a_;
  const grid &g_;
  int direction_;
};

// One step of transient rolling or of a shift: s = A p/dq.
class tangential_solver::step_operator final : public rolling_operator {
 public:
  step_operator(tangential_solver &solver, influence &a, const grid &g, double distance)
      : solver_(solver), a_(a), inverse_(1.0 / distance) {
    std::fill_n(solver_.grid_px_.data(), g.count(), 0.0);
    std::fill_n(solver_.grid_py_.data(), g.count(), 0.0);
  }
  void product(const double *p, double *s) override {
    scatter(p);
    tangential_solver &t = solver_;
    a_.tangential_product(t.grid_px_.data(), t.grid_py_.data(), t.grid_sx_.data(),
                          t.grid_sy_.data());
    gather(s);
  }
  void product_single(const double *p, double *s) override {
    scatter(p);
    tangential_solver &t = solver_;
    a_.tangential_product_single(t.grid_px_.data(), t.grid_py_.data(), t.grid_sx_.data(),
                                 t.grid_sy_.data());
    gather(s);
  }
  void row_matrices(int row, double *bxx, double *byy) const override {
    const int begin = solver_.row_start_[static_cast<size_t>(row)];
    const int n = solver_.row_start_[static_cast<size_t>(row) + 1] - begin;
    const int *at = solver_.at_.data() + begin;
    for (int source = 0; source < n; ++source)
      for (int observer = 0; observer < n; ++observer) {
        const int apart = at[observer] - at[source];
        bxx[source * n + observer] = inverse_ * a_.coefficient(kernel::xx, apart, 0);
        byy[source * n + observer] = inverse_ * a_.coefficient(kernel::yy, apart, 0);
      }
  }
  double projection_scale(int) const override {
    return 2.0 / (inverse_ * (a_.coefficient(kernel::xx, 0, 0) + a_.coefficient(kernel::yy, 0, 0)));
  }

 private:
  void scatter(const double *p) {
    solver_.for_each_element([&](size_t, size_t at, size_t ix, size_t iy) {
      solver_.grid_px_[at] = p[ix];
      solver_.grid_py_[at] = p[iy];
    });
  }
  void gather(double *s) const {
    solver_.for_each_element([&](size_t, size_t at, size_t ix, size_t iy) {
      s[ix] = inverse_ * solver_.grid_sx_[at];
      s[iy] = inverse_ * solver_.grid_sy_[at];
    });
  }

  tangential_solver &solver_;
  influence &a_;
  double inverse_;
};

tangential_solver::tangential_solver(int max_nx, int max_ny, const setup &setup) {
  if (setup.inelastic)
    inelastic_.emplace(max_nx, max_ny, setup.forced);
  else
    newton_.emplace(max_nx, max_ny, setup.forced);
  if (setup.transient) offset_.emplace(*setup.transient, setup.moves);
  const auto n = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  at_ = aligned_buffer<int>(n);
  row_start_ = aligned_buffer<int>(static_cast<size_t>(max_ny) + 1);
  for (auto *b : {&bound_, &area_, &grid_px_, &grid_py_, &grid_sx_, &grid_sy_})
    *b = aligned_buffer<double>(n);
  for (auto *b : {&rigid_, &p_, &s_}) *b = aligned_buffer<double>(2 * n);
  for (auto &l : line_) l = aligned_buffer<double>(2 * static_cast<size_t>(max_nx) + 1);
  if (!setup.inelastic) return;
  if (setup.history) before_ = aligned_buffer<carried_state>(n);
  after_ = aligned_buffer<carried_state>(n);
  friction_ = aligned_buffer<double>(n);
  if (setup.plastic)
    for (auto *b : {&plastic_slip_, &yield_stress_}) *b = aligned_buffer<double>(n);
  state_ = aligned_buffer<unsigned char>(n);
}

size_t tangential_solver::bytes() const {
  return (newton_ ? newton_->bytes() : 0) + (inelastic_ ? inelastic_->bytes() : 0) +
         (offset_ ? offset_->bytes() : 0) + before_.bytes() + after_.bytes() +
         2 * plastic_slip_.bytes() + friction_.bytes() + state_.bytes() + 3 * p_.bytes() +
         6 * bound_.bytes() + at_.bytes() + row_start_.bytes() + 2 * line_[0].bytes();
}

tangential_result tangential_solver::solve(influence &a, const grid &g, const double *pressure,
                                           const double *bound, const rolling_input &input,
                                           const tangential_options &options,
                                           tangential_fields fields,
                                           const inelastic_fields *inelastic,
                                           inelastic_sums *sums) {
  collect(g, pressure, bound, input, fields);
  const rolling_problem problem{rows_,         row_start_.data(), bound_.data(), area_.data(),
                                rigid_.data(), p_.data(),         s_.data(),     input.force};
  const auto run = [&](rolling_operator &b) {
    return inelastic_ ? solve_inelastic(b, problem, input, options, *inelastic, *sums)
                      : newton_->solve(b, problem, options);
  };
  tangential_result result;
  if (!has_physics || input.regime == motion::steady) {
    grid_operator b(*this, a, g, input.direction);
    result = run(b);
  } else {
    add_history(a, g, input);
    step_operator b(*this, a, g, input.distance);
    result = run(b);
    // elastic energy changes: what friction takes is what slips against it
    if (!inelastic_) {
      result.friction = 0;
      for_each_element([&](size_t k, size_t, size_t ix, size_t iy) {
        result.friction -= (p_[ix] * s_[ix] + p_[iy] * s_[iy]) * area_[k];
      });
    }
  }
  release(g, fields);
  return result;
}

// The displacement of the last step, as a part of the rigid slip.
void tangential_solver::add_history(influence &a, const grid &g, const rolling_input &input) {
  if (input.before[0]) {
    for_each_element([&](size_t, size_t at, size_t ix, size_t iy) {
      rigid_[ix] -= input.before[0][at] / input.distance;
      rigid_[iy] -= input.before[1][at] / input.distance;
    });
    return;
  }
  if (!input.px) return;
  if (input.upstream() != 0)
    offset_->product(a, g, input.upstream(), input.px, input.py, grid_sx_.data(), grid_sy_.data());
  else
    a.tangential_product(input.px, input.py, grid_sx_.data(), grid_sy_.data());
  for_each_element([&](size_t, size_t at, size_t ix, size_t iy) {
    rigid_[ix] -= grid_sx_[at] / input.distance;
    rigid_[iy] -= grid_sy_[at] / input.distance;
  });
}

tangential_result tangential_solver::solve_inelastic(
    rolling_operator &b, const rolling_problem &problem, const rolling_input &input,
    const tangential_options &options, const inelastic_fields &fields, inelastic_sums &sums) {
  fields.law->step = input.regime == motion::steady ? step_ : input.distance;
  fields.law->speed = input.speed;
  if (fields.before)
    for_each_element([&](size_t k, size_t at, size_t, size_t) { before_[k] = fields.before[at]; });
  const inelastic_problem law{fields.law,           fields.before ? before_.data() : nullptr,
                              after_.data(),        plastic_slip_.data(),
                              yield_stress_.data(), friction_.data(),
                              state_.data()};
  const inelastic_result result = inelastic_->solve(b, problem, law, options);
  sums = {result.plastic, result.ambiguous, result.plastic_work};
  carry_plastic(fields);
  return result.tangential;
}

// Adds the step's plastic displacement to that of the material, and scatters what the law gives.
void tangential_solver::carry_plastic(const inelastic_fields &fields) {
  double row[2] = {0, 0};
  size_t next = 0;
  int index = 0;
  for_each_element([&](size_t k, size_t at, size_t ix, size_t iy) {
    if (k == next) {
      row[0] = row[1] = 0;
      next = static_cast<size_t>(row_start_[static_cast<size_t>(++index)]);
    }
    fields.after[at] = after_[k];
    fields.friction[at] = friction_[k];
    if (!fields.plastic_x) return;
    fields.yield_stress[at] = yield_stress_[k];
    const double size = std::hypot(p_[ix], p_[iy]);
    const double share = size > 0 ? plastic_slip_[k] / size : 0.0;
    double *total[2] = {fields.plastic_x + at, fields.plastic_y + at};
    const double add[2] = {share * p_[ix], share * p_[iy]};
    for (int c = 0; c < 2; ++c) {
      row[c] += add[c];
      *total[c] = fields.before ? *total[c] + add[c] : row[c];
    }
  });
}

void tangential_solver::collect(const grid &g, const double *pressure, const double *bound,
                                const rolling_input &input, const tangential_fields &fields) {
  count_ = rows_ = 0;
  step_ = g.dx;
  for (int j = 0; j < g.ny; ++j) {
    const int begin = count_;
    // rows begin at their leading edge
    for (int k = 0; k < g.nx; ++k) {
      const int at = j * g.nx + (input.direction > 0 ? g.nx - 1 - k : k);
      if (!(pressure[at] > 0)) continue;
      const auto element = static_cast<size_t>(count_++);
      at_[element] = at;
      bound_[element] = bound[at];
      area_[element] = g.dx * g.dy;
    }
    if (count_ == begin) continue;
    row_start_[static_cast<size_t>(rows_++)] = begin;
  }
  row_start_[static_cast<size_t>(rows_)] = count_;
  for_each_element([&](size_t, size_t at, size_t ix, size_t iy) {
    const int i = static_cast<int>(at) % g.nx, j = static_cast<int>(at) / g.nx;
    const double x = g.x(i), y = g.y(j);
    rigid_[ix] = input.slip(0, x, y);
    rigid_[iy] = input.slip(1, x, y);
    p_[ix] = fields.px[at];
    p_[iy] = fields.py[at];
  });
  if (!input.coupled[0]) return;
  for_each_element([&](size_t, size_t at, size_t ix, size_t iy) {
    rigid_[ix] += input.coupled[0][at];
    rigid_[iy] += input.coupled[1][at];
  });
}

void tangential_solver::release(const grid &g, tangential_fields fields) const {
  for (double *field : {fields.px, fields.py, fields.sx, fields.sy})
    std::fill_n(field, g.count(), 0.0);
  std::fill_n(fields.division, g.count(), static_cast<unsigned char>(RP_EXTERIOR));
  for_each_element([&](size_t k, size_t at, size_t ix, size_t iy) {
    fields.px[at] = p_[ix];
    fields.py[at] = p_[iy];
    fields.sx[at] = s_[ix];
    fields.sy[at] = s_[iy];
    const bool stick = newton_ && newton_->sticks(static_cast<int>(k));
    fields.division[at] =
        inelastic_ ? state_[k] : static_cast<unsigned char>(stick ? RP_STICK : RP_SLIP);
  });
}

}  // namespace railpatch
