#include "fluid/ehl.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/sums.hpp"

namespace railpatch {

namespace {

constexpr int krylov = 120;
constexpr double linear_tolerance = 1e-4;
// of the unit of films: less that arrives would be lost in the rounding of what passes
constexpr double least_supply = 1e-6;

size_t below_of(int nx, int ny) {
  return ny > 1 ? 4 * static_cast<size_t>(ny) + 2 : 2 * static_cast<size_t>(nx);
}
size_t above_of(int nx, int ny) {
  return ny > 1 ? 2 * static_cast<size_t>(ny) + 4 : 2 * static_cast<size_t>(nx);
}
size_t numbers_of(int nx, int ny) {
  const size_t rows = 2 * static_cast<size_t>(nx) * static_cast<size_t>(ny);
  return rows * (below_of(nx, ny) + above_of(nx, ny) + 1);
}

// Where asperities bear a pressure that they exceed at the gap `least`.
double gap_of(const ehl_roughness &roughness, double pressure, double least) {
  double low = least, high = std::max(least, 0.0) + 10 * roughness.height;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (film_of(roughness, middle).asperity.value > pressure ? low : high) = middle;
  }
  return high;
}

}  // namespace

double greatest_rise(const grid &g, int direction, double pressure_coefficient,
                     const double *pressure) {
  const double alpha = pressure_coefficient;
  double greatest = 0, rise = 0;
  for (int j = 0; j < g.ny; ++j) {
    double last = 0;
    for (int s = 0; s < g.nx; ++s) {
      const int i = direction < 0 ? s : g.nx - 1 - s;
      const double p = pressure[j * g.nx + i];
      const double reduced = alpha > 0 ? (1 - exp(-alpha * p)) / alpha : p;
      rise = std::max(rise, reduced - last);
      greatest = std::max(greatest, reduced);
      last = reduced;
    }
  }
  return greatest > 0 ? rise / greatest : 0.0;
}

ehl_solver::ehl_solver(int max_nx, int max_ny)
    : system_(max_nx * max_ny),
      band_(2 * static_cast<size_t>(max_nx * max_ny), numbers_of(max_nx, max_ny)),
      gmres_(2 * max_nx * max_ny + 1, krylov),
      dry_(max_nx * max_ny) {
  const auto n = static_cast<size_t>(max_nx * max_ny);
  for (auto *field : {&by_gap_, &by_pressure_, &by_empty_, &dry_pressure_, &dry_gap_})
    *field = aligned_buffer<double>(n);
  from_ = aligned_buffer<double>(3 * n + 1);
  for (auto *vector : {&right_, &step_, &column_}) *vector = aligned_buffer<double>(2 * n + 1);
}

double line_film(const ehl_liquid &liquid, double modulus, double half_length, double pressure,
                 double speed) {
  const double radius = 0.5 * modulus * half_length / pressure;
  const double u = liquid.viscosity * speed / (modulus * radius), root = std::sqrt(u);
  const double m = std::numbers::pi * pressure * half_length / 2 / (2 * modulus * radius) / root;
  const double l = liquid.law == ehl_viscosity::constant
                       ? 0.0
                       : liquid.pressure_coefficient * 2 * modulus * std::sqrt(root);
  const double soft = 2.05 * pow(m, -0.2);
  const double hard = l > 0 ? 1.65 * pow(l, 0.75) * pow(m, -0.125) : 0.0;
  return std::max(soft, hard) * root * radius;
}

// Scales, and a film of the right order, from the dry contact: its length along the flow in the
// row of the greatest pressure, and the radius of a line contact with the same length and pressure.
ehl_scales ehl_solver::scales_of(influence &a, const ehl_problem &problem,
                                 const ehl_options &options) {
  const grid &g = problem.area;
  const auto n = static_cast<size_t>(g.count());
  std::fill_n(dry_pressure_.data(), n, 0.0);
  const normal_options dry_options{1e-6, 500, options.ask};
  const normal_result dry = problem.force_given
                                ? dry_.with_force(a, g, problem.distance, problem.force,
                                                  dry_options, dry_pressure_.data())
                                : dry_.with_approach(a, g, problem.distance, problem.approach,
                                                     dry_options, dry_pressure_.data());
  dry_approach_ = dry.approach;
  const double *p = dry_pressure_.data();
  const auto top = static_cast<size_t>(std::max_element(p, p + n) - p);
  const double p0 = p[top];
  const size_t row = top / static_cast<size_t>(g.nx) * static_cast<size_t>(g.nx);
  double length = 0;
  for (int i = 0; i < g.nx; ++i) length += p[row + static_cast<size_t>(i)] > 0 ? g.dx : 0;
  const elastic_constants &e = a.bodies().elastic;
  const double modulus = e.shear_modulus / (1 - e.poisson_ratio);  // E*
  const double film = line_film(problem.liquid, modulus, std::max(0.5 * length, g.dx),
                                std::max(p0, 1.0), std::max(problem.speed, 1e-9));
  film_ = film;
  const double unit = std::max(film, 0.3 * problem.roughness.height);
  const double fastest =
      problem.time_step > 0 ? std::max(problem.speed, g.dx / problem.time_step) : problem.speed;
  return {p0, unit, fastest * g.dy * unit};
}

// The dry pressure, of which asperities take the share that Aihara 1987 gives (fluid/mixed.hpp),
// and the gap that goes with it.
void ehl_solver::cold_start(influence &a, const ehl_problem &problem) {
  const grid &g = problem.area;
  a.normal_product(dry_pressure_.data(), dry_gap_.data());
  const double film = film_, sigma = problem.roughness.height;
  const double share =
      sigma > 0 ? std::clamp(exp(-1.8 * pow(film / sigma, 1.2)), 0.3, 1 - 1e-9) : 0.0;
  system_.constant = -dry_approach_ + film;
  for (int s = 0; s < g.nx; ++s)
    for (int j = 0; j < g.ny; ++j) {
      const size_t at = system_.on_grid(s, j), k = static_cast<size_t>(s * g.ny + j);
      const double p = dry_pressure_[at];
      double h = std::max(problem.distance[at] + dry_gap_[at] + system_.constant, film);
      if (p > 0 && sigma > 0 && film_of(problem.roughness, h).asperity.value > share * p)
        h = gap_of(problem.roughness, share * p, h);
      system_.gap[k] = h;
      system_.pressure[k] = std::max(p - film_of(problem.roughness, h).asperity.value, 0.0);
      const bool arrives_torn = problem.inlet_film > 0 && p == 0 &&
                                (problem.inlet_film < film || h > 4 * problem.inlet_film);
      system_.empty[k] = arrives_torn ? std::max(0.0, 1 - problem.inlet_film / h) : 0.0;
    }
  // behind the narrowest place of each row the film tears
  for (int j = 0; j < g.ny; ++j) {
    const auto at = [&](int s) { return static_cast<size_t>(s * g.ny + j); };
    int last = 0;
    for (int s = 0; s < g.nx; ++s)
      if (system_.gap[at(s)] <= system_.gap[at(last)] || system_.pressure[at(s)] > 0) last = s;
    for (int s = last + 1; s < g.nx; ++s)
      system_.empty[at(s)] =
          std::max(system_.empty[at(s)], 1 - system_.gap[at(last)] / system_.gap[at(s)]);
  }
}

bool ehl_solver::precondition_by(influence &a, const ehl_problem &problem) {
  const int nx = problem.area.nx, ny = problem.area.ny;
  const size_t n = system_.count();
  band_.set_size(2 * n, below_of(nx, ny), above_of(nx, ny));
  const double e = system_.elastic_scale();
  const int reach_s = ny > 1 ? 1 : nx - 1, reach_j = ny > 1 ? 1 : 0;
  for (int s = 0; s < nx; ++s)
    for (int j = 0; j < ny; ++j) {
      const auto k = static_cast<size_t>(s * ny + j);
      for (int t = std::max(0, s - reach_s); t <= std::min(nx - 1, s + reach_s); ++t)
        for (int m = std::max(0, j - reach_j); m <= std::min(ny - 1, j + reach_j); ++m) {
          const auto other = static_cast<size_t>(t * ny + m);
          double c = e * a.coefficient(kernel::zz, t - s, m - j);
          if (t != s && m != j) c *= 0.55;
          band_.at(2 * k, 2 * other) -= c * system_.asperity_by_gap(other);
          band_.at(2 * k, 2 * other + 1) -= c * system_.pressure_by_curve(other);
        }
      band_.at(2 * k, 2 * k) += 1;
      const auto put = [&](ehl_system::place at, size_t node) {
        const auto &c = system_.coefficient(k, at);
        band_.at(2 * k + 1, 2 * node) += c.by_gap;
        band_.at(2 * k + 1, 2 * node + 1) += c.by_curve;
      };
      const auto w = static_cast<size_t>(ny);
      put(ehl_system::here, k);
      if (s > 1) put(ehl_system::before_last, k - 2 * w);
      if (s > 0) put(ehl_system::before, k - w);
      if (s + 1 < nx) put(ehl_system::after, k + w);
      if (j > 0) put(ehl_system::left, k - 1);
      if (j + 1 < ny) put(ehl_system::right, k + 1);
    }
  if (!band_.factor()) return false;
  for (size_t k = 0; k < n; ++k) {
    column_[2 * k] = -1;
    column_[2 * k + 1] = 0;
  }
  band_.solve(column_.data());
  column_load_ = load_of(problem, column_.data());
  return true;
}

double ehl_solver::load_of(const ehl_problem &problem, const double *v) const {
  double sum = 0;
  for (size_t k = 0; k < system_.count(); ++k)
    sum += system_.asperity_by_gap(k) * v[2 * k] + system_.pressure_by_curve(k) * v[2 * k + 1];
  return sum * scales_.pressure * problem.area.dx * problem.area.dy / problem.force;
}

void ehl_solver::precondition(const ehl_problem &problem, double *v) const {
  const size_t n = system_.count();
  const double load = v[2 * n];
  band_.solve(v);
  double constant = load;
  if (problem.force_given)
    constant = column_load_ != 0 ? (load_of(problem, v) - load) / column_load_ : 0.0;
  for (size_t i = 0; i < 2 * n; ++i) v[i] -= constant * column_[i];
  v[2 * n] = constant;
}

// Greatest part of the step that leaves films and asperities near what was linearised.
double ehl_solver::allowed_part(const ehl_problem &problem) const {
  double part = 1;
  const double sigma = problem.roughness.height;
  for (size_t k = 0; k < system_.count(); ++k) {
    const double h = system_.gap[k], falls = -by_gap_[k];
    const double most = sigma > 0 ? std::max(1.5 * sigma, 0.7 * h) : 0.7 * h;
    if (falls * part > most) part = most / falls;
    const with_slope eta = viscosity_ratio(problem.liquid, std::max(system_.pressure[k], 0.0));
    const double grows = std::abs(by_pressure_[k]) * eta.slope / eta.value;
    if (grows * part > 3) part = 3 / grows;
  }
  return std::max(part, 0.02);
}

void ehl_solver::move(const ehl_problem &problem, double part) {
  const size_t n = system_.count();
  const double sigma = problem.roughness.height;
  for (size_t k = 0; k < n; ++k) {
    const double h = from_[k];
    const double most = sigma > 0 ? std::max(1.5 * sigma, 0.7 * h) : 0.7 * h;
    system_.gap[k] = h + std::max(part * by_gap_[k], -most);
    system_.pressure[k] = from_[n + k] + part * by_pressure_[k];
    system_.empty[k] = std::min(from_[2 * n + k] + part * by_empty_[k], 1 - 1e-9);
  }
  system_.constant = from_[3 * n] + part * step_[2 * n] * scales_.gap;
}

double ehl_solver::merit() const {
  const size_t n = system_.count();
  const double m = dot(system_.residual.data(), system_.residual.data(), 2 * n + 1) +
                   dot(system_.curve.data(), system_.curve.data(), n);
  return std::isfinite(m) ? m : std::numeric_limits<double>::infinity();
}

// Along the step; back again, and false, where the residuals grow too much.
bool ehl_solver::advance(influence &a, const ehl_problem &problem, double *part, double *best) {
  const size_t n = system_.count();
  system_.step_of(step_.data(), by_gap_.data(), by_pressure_.data(), by_empty_.data());
  std::copy_n(system_.gap.data(), n, from_.data());
  std::copy_n(system_.pressure.data(), n, from_.data() + n);
  std::copy_n(system_.empty.data(), n, from_.data() + 2 * n);
  from_[3 * n] = system_.constant;
  const double before = merit();
  *part = allowed_part(problem);
  move(problem, *part);
  system_.evaluate(a);
  if (merit() <= 100 * std::min(before, 100 * *best)) {
    *best = std::min(*best, merit());
    return true;
  }
  std::copy_n(from_.data(), n, system_.gap.data());
  std::copy_n(from_.data() + n, n, system_.pressure.data());
  std::copy_n(from_.data() + 2 * n, n, system_.empty.data());
  system_.constant = from_[3 * n];
  system_.evaluate(a);
  return false;
}

double ehl_solver::greatest_residual() const {
  double worst = 0;
  for (size_t i = 0; i <= 2 * system_.count(); ++i)
    worst = std::max(worst, std::abs(system_.residual[i]));
  for (size_t k = 0; k < system_.count(); ++k) worst = std::max(worst, std::abs(system_.curve[k]));
  return std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

ehl_result ehl_solver::solve(influence &a, const ehl_problem &given, bool warm,
                             const ehl_options &options) {
  scales_ = scales_of(a, given, options);
  ehl_problem problem = given;
  if (given.inlet_film > 0)
    problem.inlet_film = std::max(given.inlet_film, least_supply * scales_.gap);
  const bool by_supply = problem.inlet_film > 0 && problem.area.ny == 1 && !(problem.time_step > 0);
  if (!by_supply) {
    const ehl_result found = solve_from(a, problem, warm, options);
    return found.converged || problem.time_step > 0 ? found : slow_down(a, problem, found, options);
  }
  // beyond what passes of a full gap the liquid heaps up before the line, up to the border
  ehl_problem full = problem;
  full.inlet_film = 0;
  const ehl_result flooded = solve_from(a, full, warm, options);
  const double passes = system_.passing / (problem.speed * problem.area.dy);
  if (flooded.converged && passes <= problem.inlet_film) return flooded;
  ehl_result starved = solve_from(a, problem, false, options);
  starved.iterations += flooded.iterations;
  starved.products += flooded.products;
  return starved;
}

// From a faster rolling, whose liquid bears more, down to the problem's.
ehl_result ehl_solver::slow_down(influence &a, const ehl_problem &problem, ehl_result found,
                                 const ehl_options &options) {
  ehl_problem faster = problem;
  int iterations = found.iterations, products = found.products;
  for (double factor = 64; factor >= 1; factor /= 8) {
    faster.speed = factor * problem.speed;
    scales_ = scales_of(a, faster, options);
    found = solve_from(a, faster, factor < 64, options);
    iterations += found.iterations;
    products += found.products;
    if (!found.converged) break;
  }
  found.iterations = iterations;
  found.products = products;
  found.converged = found.converged && faster.speed == problem.speed;
  return found;
}

ehl_result ehl_solver::solve_from(influence &a, const ehl_problem &problem, bool warm,
                                  const ehl_options &options) {
  system_.set(problem, scales_);
  if (!warm) cold_start(a, problem);
  ehl_result result;
  constexpr double first = 4, least = 0.2, none = 1e8;  // elements passed in a step
  double passed = warm || problem.time_step > 0 ? 10 * none : first;
  double best = std::numeric_limits<double>::infinity();
  system_.evaluate(a);
  for (;;) {
    result.residual = greatest_residual();
    result.converged = result.residual <= options.tolerance;
    if (result.converged || result.iterations >= options.max_iterations ||
        !std::isfinite(result.residual))
      break;
    options.ask.check();
    system_.linearise(passed > none ? 0.0 : 1 / passed);
    system_.right_side(a, right_.data());
    if (!precondition_by(a, problem)) break;
    result.products +=
        gmres_
            .solve(
                2 * system_.count() + 1, right_.data(), step_.data(), linear_tolerance, 2 * krylov,
                [&](const double *v, double *out) { system_.product(a, v, out); },
                [&](double *v) { precondition(problem, v); })
            .products;
    const double before = merit();
    double part = 1;
    if (!advance(a, problem, &part, &best))
      passed = std::max(0.1 * passed, least);
    else if (merit() > before)
      passed = std::max(0.7 * passed, least);
    else
      passed *= std::clamp(part * std::sqrt(before / merit()), 1 + part, 10.0);
    ++result.iterations;
  }
  result.normal_force = system_.load;
  result.fluid_force =
      total(system_.pressure.data(), system_.count()) * problem.area.dx * problem.area.dy;
  result.approach = -system_.constant;
  result.imbalance = system_.imbalance / system_.passing;
  return result;
}

size_t ehl_solver::bytes() const {
  return system_.bytes() + band_.bytes() + gmres_.bytes() + dry_.bytes() + 3 * right_.bytes() +
         5 * by_gap_.bytes();
}

}  // namespace railpatch
