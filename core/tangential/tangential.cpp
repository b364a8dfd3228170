#include "tangential/tangential.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"
#include "railpatch.h"

namespace railpatch {

namespace {

// of the preconditioner across the contact
constexpr int strips = 8;

}  // namespace

// Steady rolling: s = B p.
class tangential_solver::grid_operator final : public rolling_operator {
 public:
  grid_operator(tangential_solver &solver, const tangential_problem &problem)
      : elements_(solver.elements_),
        strips_(solver.strips_),
        a_(solver.products(problem)),
        dx_(problem.g.dx),
        direction_(problem.input.direction) {
    strips_.set(a_, elements_.product_grid(problem.g), elements_.rows());
  }

  void product(const double *p, double *s) override {
    elements_.product(p, s, [&](double *px, double *py, double *sx, double *sy) {
      stored_ = a_.rolling_product(px, py, direction_, sx, sy);
    });
  }
  // p . A p of the last product
  double stored() const { return stored_; }
  void product_single(const double *p, double *s) override {
    elements_.product(p, s, [&](double *px, double *py, double *sx, double *sy) {
      a_.rolling_product_single(px, py, direction_, sx, sy);
    });
  }
  void row_matrices(int row, double *bxx, double *byy) const override {
    strips_.matrices(elements_, row, direction_, bxx, byy);
  }
  int common_row(const rolling_problem &) const override { return elements_.common_row(); }
  // makes r B of unit size on the diagonal
  double projection_scale(int) const override {
    return 2.0 / (entry(kernel::xx) + entry(kernel::yy));
  }

 private:
  double entry(kernel k) const {
    return (a_.coefficient(k, 0, 0) - a_.coefficient(k, direction_, 0)) / dx_;
  }

  row_elements &elements_;
  row_strips &strips_;
  influence &a_;
  double dx_;
  int direction_;
  double stored_ = 0;
};

// The same of viscoelastic bodies.
class tangential_solver::viscous_operator final : public rolling_operator {
 public:
  viscous_operator(tangential_solver &solver, const tangential_problem &problem)
      : elements_(solver.elements_),
        strips_(solver.strips_),
        a_(*problem.viscous),
        dx_(problem.g.dx) {
    strips_.set([&](kernel k, int ahead, int j) { return a_.coefficient(k, ahead, j); }, problem.g,
                elements_.rows());
  }

  void product(const double *p, double *s) override {
    elements_.product(p, s, [&](double *px, double *py, double *sx, double *sy) {
      a_.rolling_product(px, py, sx, sy);
    });
  }
  void row_matrices(int row, double *bxx, double *byy) const override {
    strips_.matrices(elements_, row, a_.direction(), bxx, byy);
  }
  int common_row(const rolling_problem &) const override { return elements_.common_row(); }
  double projection_scale(int) const override {
    return 2.0 / (entry(kernel::xx) + entry(kernel::yy));
  }

 private:
  double entry(kernel k) const {
    return (a_.coefficient(k, 0, 0) - a_.coefficient(k, -1, 0)) / dx_;
  }

  row_elements &elements_;
  row_strips &strips_;
  viscous_influence &a_;
  double dx_;
};

// One step of transient rolling or of a shift: s = A p/dq.
class tangential_solver::step_operator final : public rolling_operator {
 public:
  step_operator(tangential_solver &solver, const tangential_problem &problem)
      : elements_(solver.elements_), a_(problem.a), inverse_(1.0 / problem.input.distance) {}
  void product(const double *p, double *s) override {
    elements_.product(p, s, [&](double *px, double *py, double *sx, double *sy) {
      a_.tangential_product(px, py, sx, sy);
    });
    scale(s);
  }
  void product_single(const double *p, double *s) override {
    elements_.product(p, s, [&](double *px, double *py, double *sx, double *sy) {
      a_.tangential_product_single(px, py, sx, sy);
    });
    scale(s);
  }
  void row_matrices(int row, double *bxx, double *byy) const override {
    const int *at = elements_.at(row), n = elements_.length(row);
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
  void scale(double *s) const {
    for (size_t i = 0; i < elements_.vector_size(); ++i) s[i] = inverse_ * s[i];
  }

  row_elements &elements_;
  influence &a_;
  double inverse_;
};

tangential_solver::tangential_solver(int max_nx, int max_ny, const setup &setup)
    : elements_(max_nx, max_ny), strips_(max_nx, strips) {
  if (setup.inelastic)
    inelastic_.emplace(max_nx, max_ny, setup.forced);
  else
    newton_.emplace(max_nx, max_ny, setup.forced);
  if (setup.bodies) boxed_ = std::make_unique<influence>(*setup.bodies, *setup.plans);
  if (setup.transient) offset_.emplace(*setup.transient, setup.moves);
  const auto n = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  for (auto *b : {&bound_, &area_}) *b = aligned_buffer<double>(n);
  for (auto *b : {&rigid_, &p_, &s_}) *b = aligned_buffer<double>(2 * n);
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
         2 * bound_.bytes() + elements_.bytes() + strips_.bytes() +
         (boxed_ ? sizeof(influence) + boxed_->bytes() : 0);
}

tangential_result tangential_solver::solve(const tangential_problem &problem) {
  collect(problem);
  const rolling_input &input = problem.input;
  const rolling_problem rows{elements_.rows(), elements_.row_start(),
                             bound_.data(),    area_.data(),
                             rigid_.data(),    p_.data(),
                             s_.data(),        input.force};
  const auto run = [&](rolling_operator &b) {
    return inelastic_ ? solve_inelastic(b, rows, problem)
                      : newton_->solve(b, rows, problem.options);
  };
  tangential_result result;
  if (has_physics && problem.viscous) {
    viscous_operator b(*this, problem);
    result = run(b);
    take_offset_work(problem, result);
  } else if (!has_physics || input.regime == motion::steady) {
    grid_operator b(*this, problem);
    result = run(b);
    // the last product is that of the solution; laws beyond Coulomb's have others
    result.stored = inelastic_ ? nan : b.stored();
    take_offset_work(problem, result);
  } else {
    add_history(problem);
    step_operator b(*this, problem);
    result = run(b);
  }
  release(problem.g, problem.fields);
  return result;
}

influence &tangential_solver::products(const tangential_problem &problem) {
  if (!boxed_) return problem.a;
  boxed_->set_grid(elements_.product_grid(problem.g), problem.followed);
  return *boxed_;
}

// The place of the spin term belongs to the discretisation: forces and moment, summed at the
// elements, do no work by it, so friction and layer, each by its share, take none.
void tangential_solver::take_offset_work(const tangential_problem &problem,
                                         tangential_result &result) const {
  const rolling_input &input = problem.input;
  if (input.spin_offset == 0) return;
  double sum = 0;
  elements_.for_each([&](size_t k, size_t at, size_t, size_t iy) {
    sum += input.spin_of(static_cast<int>(at) / problem.g.nx) * p_[iy] * area_[k];
  });
  const double more = input.spin_offset * sum;
  const double plastic = problem.sums ? problem.sums->plastic_work : 0.0;
  if (!(plastic > 0)) {
    result.friction += more;
    return;
  }
  const double factor = std::max(0.0, 1.0 + more / (result.friction + plastic));
  result.friction *= factor;
  problem.sums->plastic_work *= factor;
}

void tangential_solver::displacement_before(influence &a, const grid &g, const rolling_input &input,
                                            double *ux, double *uy) {
  if (input.upstream() != 0)
    offset_->product(a, g, input.upstream(), input.px, input.py, ux, uy);
  else
    a.tangential_product(input.px, input.py, ux, uy);
}

// The displacement of the last step, as a part of the rigid slip.
void tangential_solver::add_history(const tangential_problem &problem) {
  const rolling_input &input = problem.input;
  const double *before[2] = {input.before[0], input.before[1]};
  if (!before[0]) {
    if (!input.px) return;
    displacement_before(problem.a, problem.g, input, elements_.x(), elements_.y());
    before[0] = elements_.x();
    before[1] = elements_.y();
  }
  elements_.for_each([&](size_t, size_t at, size_t ix, size_t iy) {
    rigid_[ix] -= before[0][at] / input.distance;
    rigid_[iy] -= before[1][at] / input.distance;
  });
}

tangential_result tangential_solver::solve_inelastic(rolling_operator &b,
                                                     const rolling_problem &rows,
                                                     const tangential_problem &problem) {
  const inelastic_fields &fields = *problem.inelastic;
  const rolling_input &input = problem.input;
  fields.law->step = input.regime == motion::steady ? problem.g.dx : input.distance;
  fields.law->speed = input.speed;
  if (fields.before)
    elements_.for_each(
        [&](size_t k, size_t at, size_t, size_t) { before_[k] = fields.before[at]; });
  const inelastic_problem law{fields.law,           fields.before ? before_.data() : nullptr,
                              after_.data(),        plastic_slip_.data(),
                              yield_stress_.data(), friction_.data(),
                              state_.data()};
  const inelastic_result result = inelastic_->solve(b, rows, law, problem.options);
  *problem.sums = {result.plastic, result.ambiguous, result.plastic_work};
  carry_plastic(fields);
  return result.tangential;
}

// Adds the step's plastic displacement to that of the material, and scatters what the law gives.
void tangential_solver::carry_plastic(const inelastic_fields &fields) {
  double row[2] = {0, 0};
  size_t next = 0;
  int index = 0;
  elements_.for_each([&](size_t k, size_t at, size_t ix, size_t iy) {
    if (k == next) {
      row[0] = row[1] = 0;
      next = static_cast<size_t>(elements_.row_start()[++index]);
    }
    fields.after[at] = after_[k];
    fields.friction[at] = friction_[k];
    if (!fields.plastic_x) return;
    fields.yield_stress[at] = yield_stress_[k];
    const double size = hypot(p_[ix], p_[iy]);
    const double share = size > 0 ? plastic_slip_[k] / size : 0.0;
    double *total[2] = {fields.plastic_x + at, fields.plastic_y + at};
    const double add[2] = {share * p_[ix], share * p_[iy]};
    for (int c = 0; c < 2; ++c) {
      row[c] += add[c];
      *total[c] = fields.before ? *total[c] + add[c] : row[c];
    }
  });
}

void tangential_solver::collect(const tangential_problem &problem) {
  const grid &g = problem.g;
  const rolling_input &input = problem.input;
  const bool steady = !has_physics || input.regime == motion::steady;
  elements_.collect(g, problem.pressure, input.direction, steady && boxed_);
  elements_.for_each([&](size_t k, size_t at, size_t ix, size_t iy) {
    const int i = static_cast<int>(at) % g.nx, j = static_cast<int>(at) / g.nx;
    const double x = g.x(i), y = g.y(j);
    bound_[k] = problem.bound[at];
    area_[k] = g.dx * g.dy;
    rigid_[ix] = input.slip(0, x, y);
    rigid_[iy] = input.slip(1, x, y);
    p_[ix] = problem.fields.px[at];
    p_[iy] = problem.fields.py[at];
  });
  if (!input.coupled[0]) return;
  elements_.for_each([&](size_t, size_t at, size_t ix, size_t iy) {
    rigid_[ix] += input.coupled[0][at];
    rigid_[iy] += input.coupled[1][at];
  });
}

void tangential_solver::release(const grid &g, tangential_fields fields) const {
  for (double *field : {fields.px, fields.py, fields.sx, fields.sy})
    std::fill_n(field, g.count(), 0.0);
  std::fill_n(fields.division, g.count(), static_cast<unsigned char>(RP_EXTERIOR));
  elements_.for_each([&](size_t k, size_t at, size_t ix, size_t iy) {
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
