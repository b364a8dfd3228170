#include "tangential/coarse_start.hpp"

#include <algorithm>

namespace railpatch {

namespace {

// of the coarse problem: its own error of discretisation is greater
constexpr double start_tolerance = 1e-2;

constexpr int half(int n) { return (n + 1) / 2; }

// g's elements by twos, from its first one on
grid coarsened(const grid &g) {
  return {half(g.nx), half(g.ny), 2 * g.dx, 2 * g.dy, g.x0 + 0.5 * g.dx, g.y0 + 0.5 * g.dy};
}

}  // namespace

coarse_start::coarse_start(const influence::medium &of, const fft_plans &plans, int max_nx,
                           int max_ny)
    : plans_(plans.halved()),
      influence_(of, plans_),
      solver_(half(max_nx), half(max_ny), tangential_solver::setup{}) {
  const int nx = half(max_nx), ny = half(max_ny);
  const auto n = static_cast<size_t>(nx) * static_cast<size_t>(ny);
  for (auto *b : {&pressure_, &bound_, &px_, &py_, &sx_, &sy_}) *b = aligned_buffer<double>(n);
  division_ = aligned_buffer<unsigned char>(n);
  if (serves(nx, ny)) coarser_ = std::make_unique<coarse_start>(of, plans_, nx, ny);
}

size_t coarse_start::bytes() const {
  return influence_.bytes() + solver_.bytes() + 6 * pressure_.bytes() + division_.bytes() +
         (coarser_ ? coarser_->bytes() : 0);
}

void coarse_start::find(const grid &g, const double *pressure, const double *bound,
                        const rolling_input &input, const tangential_options &options,
                        tangential_fields fields) {
  const grid coarse = coarsened(g);
  if (!influence_.set_grid(coarse)) return;
  restrict_to(coarse, g, pressure, bound);
  const tangential_fields own{px_.data(), py_.data(), sx_.data(), sy_.data(), division_.data()};
  std::fill_n(own.px, coarse.count(), 0.0);
  std::fill_n(own.py, coarse.count(), 0.0);
  const tangential_options loose{std::max(start_tolerance, options.tolerance),
                                 options.max_iterations, options.ask};
  if (coarser_ && serves(coarse.nx, coarse.ny))
    coarser_->find(coarse, pressure_.data(), bound_.data(), input, loose, own);
  solver_.solve({influence_, coarse, pressure_.data(), bound_.data(), input, loose, own});
  prolong(coarse, g, bound, fields);
}

// Means of four elements, of those beyond the grid zero.
void coarse_start::restrict_to(const grid &coarse, const grid &g, const double *pressure,
                               const double *bound) {
  std::fill_n(pressure_.data(), coarse.count(), 0.0);
  std::fill_n(bound_.data(), coarse.count(), 0.0);
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto to = static_cast<size_t>(j / 2 * coarse.nx + i / 2);
      pressure_[to] += 0.25 * pressure[j * g.nx + i];
      bound_[to] += 0.25 * bound[j * g.nx + i];
    }
}

// Traction over bound, which slip holds at one, is what is interpolated, bilinearly between the
// elements in contact.
void coarse_start::prolong(const grid &coarse, const grid &g, const double *bound,
                           tangential_fields fields) const {
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const int at = j * g.nx + i;
      if (!(bound[at] > 0)) continue;
      double sum[2] = {0, 0}, weights = 0;
      for (int k = 0; k < 4; ++k) {
        // the coarse element that holds this one, and its neighbours on this one's side
        const int column = i / 2 + (k % 2 ? 2 * (i % 2) - 1 : 0);
        const int row = j / 2 + (k / 2 ? 2 * (j % 2) - 1 : 0);
        if (column < 0 || row < 0 || column >= coarse.nx || row >= coarse.ny) continue;
        const auto from = static_cast<size_t>(row * coarse.nx + column);
        if (!(bound_[from] > 0)) continue;
        const double weight = (k % 2 ? 0.25 : 0.75) * (k / 2 ? 0.25 : 0.75);
        sum[0] += weight * px_[from] / bound_[from];
        sum[1] += weight * py_[from] / bound_[from];
        weights += weight;
      }
      fields.px[at] = bound[at] * sum[0] / weights;
      fields.py[at] = bound[at] * sum[1] / weights;
    }
}

}  // namespace railpatch
