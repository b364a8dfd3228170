#include "temperature/temperature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/gauss_legendre.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

using std::numbers::inv_sqrtpi;
using std::numbers::pi;

namespace {

// y += w q over a row whose q stands `shift` elements further on
RAILPATCH_DISPATCH void add_shifted(int n, double w, const double *q, double *y) {
  RAILPATCH_INDEPENDENT
  for (int i = 0; i < n; ++i) y[i] += w * q[i];
}

}  // namespace

double thermal_body::effusivity() const {
  return std::sqrt(conductivity * density * heat_capacity);
}
double thermal_body::diffusivity() const { return conductivity / (density * heat_capacity); }

double temperature_law::coefficient(double temperature) const {
  const double u = (temperature - reference_temperature) / range;
  return reference + change * std::clamp(u, 0.0, 1.0);
}

double temperature_law::slope(double temperature) const {
  const double u = (temperature - reference_temperature) / range;
  return u >= 0 && u <= 1 ? change / range : 0.0;
}

double constant_flux(double age, double depth) {
  if (!(age > 0)) return 0.0;
  const double root = std::sqrt(age);
  if (depth == 0) return 2.0 * inv_sqrtpi * root;
  const double u = depth / (2.0 * root);
  return 2.0 * root * (inv_sqrtpi * exp(-u * u) - u * erfc(u));
}

double levelled(double touched, double since, double depth) {
  if (!(touched > 0)) return 0.0;
  if (touched >= since) return erfc(depth / (2.0 * std::sqrt(since)));
  const double end = asin(std::sqrt(touched / since));
  if (depth == 0) return 2.0 / pi * end;
  const double u2 = depth * depth / (4.0 * since);
  const auto term = [&](double angle) {
    const double c = cos(angle);
    return exp(-u2 / (c * c));
  };
  // smooth, but steep towards pi/2: panels that halve towards the end
  double sum = 0, begin = 0;
  for (int panel = 0; panel < 12; ++panel) {
    const double stop = panel < 11 ? begin + 0.5 * (end - begin) : end;
    const double mid = 0.5 * (begin + stop), half = 0.5 * (stop - begin);
    for (int k = 0; k < gauss_legendre::half; ++k)
      sum +=
          half * gauss_legendre::weight[k] *
          (term(mid - half * gauss_legendre::node[k]) + term(mid + half * gauss_legendre::node[k]));
    begin = stop;
  }
  return 2.0 / pi * sum;
}

void heat_kernel::set(const heat_rows &rows, double distance, double root_depth) {
  count_ = 0;
  if (!(rows.speed > 0) || !(distance > 0)) return;
  const double reach = distance / rows.dx;
  const double unit = rows.dx / rows.speed, root = std::sqrt(unit);
  double last = 0;
  for (int m = 0; m < rows.nx; ++m) {
    const double end = std::min(m + 0.5 + rows.upstream, reach);
    const double span = end - last;
    if (!(span > 0)) break;
    // at the surface the difference of roots without cancellation
    weight_[static_cast<size_t>(m)] =
        root_depth > 0
            ? constant_flux(end * unit, root_depth) - constant_flux(last * unit, root_depth)
            : 2.0 * inv_sqrtpi * root * span / (std::sqrt(end) + std::sqrt(last));
    count_ = m + 1;
    last = end;
  }
}

void heat_kernel::apply(const heat_rows &rows, const double *q, const double *known,
                        double *y) const {
  const int nx = rows.nx;
  for (int j = 0; j < rows.ny; ++j) {
    const double *row = q + static_cast<ptrdiff_t>(j) * nx;
    double *out = y + static_cast<ptrdiff_t>(j) * nx;
    if (!known) std::fill_n(out, nx, 0.0);
    if (known && known != y) std::copy_n(known + static_cast<ptrdiff_t>(j) * nx, nx, out);
    if (std::all_of(row, row + nx, [](double v) { return v == 0; })) continue;
    for (int m = 0; m < count_; ++m) {
      const double w = weight_[static_cast<size_t>(m)];
      if (rows.direction > 0)
        add_shifted(nx - m, w, row + m, out);
      else
        add_shifted(nx - m, w, row, out + m);
    }
  }
}

heat_exchange::heat_exchange(int max_nx)
    : stretch_(static_cast<size_t>(max_nx / 2 + 1)), flux_(static_cast<size_t>(max_nx)) {}

double heat_exchange::behind(double t, double depth) const {
  double sum = 0;
  for (int s = 0; s < stretches_; ++s) {
    const stretch &c = stretch_[static_cast<size_t>(s)];
    if (t > c.entry) sum += c.jump * levelled(std::min(t, c.exit) - c.entry, t - c.entry, depth);
  }
  return sum;
}

double heat_exchange::value(double t, double depth) const {
  double sum = behind(t, depth);
  for (int l = 0; again_ && l < t; ++l)
    sum += flux_[static_cast<size_t>(l)] *
           (constant_flux(t - l, depth) - constant_flux(t - l - 1, depth));
  return sum;
}

void heat_exchange::set_row(const heat_rows &rows, const double *pressure) {
  nx_ = rows.nx;
  stretches_ = 0;
  again_ = false;
  std::fill_n(flux_.data(), nx_, 0.0);
  bool inside = false;
  for (int k = 0; k < nx_; ++k) {
    const bool touches = pressure[rows.direction > 0 ? nx_ - 1 - k : k] > 0;
    if (touches && !inside) {
      // an open stretch ends far behind
      const double jump = stretches_ == 0 ? 1.0 : 1.0 - value(k, 0.0);
      stretch_[static_cast<size_t>(stretches_++)] = {static_cast<double>(k), nx_ + 1.0, jump};
      again_ = stretches_ > 1;
    }
    if (!touches && inside) stretch_[static_cast<size_t>(stretches_ - 1)].exit = k;
    inside = touches;
    if (inside && again_)
      flux_[static_cast<size_t>(k)] = (1.0 - value(k + 0.5, 0.0)) / constant_flux(0.5, 0.0);
  }
}

double heat_exchange::heat() const {
  double sum = 0;
  for (int s = 0; s < stretches_; ++s) {
    const stretch &c = stretch_[static_cast<size_t>(s)];
    // flux jump/sqrt(pi t) while it touches
    sum += c.jump * 2.0 * inv_sqrtpi * std::sqrt(std::min(c.exit, 1.0 * nx_) - c.entry);
  }
  for (int k = 0; again_ && k < nx_; ++k) sum += flux_[static_cast<size_t>(k)];
  return sum;
}

double heat_exchange::at(int k, double depth) const { return value(k + 0.5, depth); }

void friction_heat(int count, double speed, const double *friction, const double *plastic_power,
                   double fraction, double *q) {
  for (int i = 0; i < count; ++i) q[i] = speed * friction[i];
  if (plastic_power) add_shifted(count, fraction, plastic_power, q);
}

steady_temperature::steady_temperature(int max_nx, bool exchanges, bool deep) : kernel_(max_nx) {
  if (deep) deep_ = heat_kernel(max_nx);
  if (exchanges) exchange_ = heat_exchange(max_nx);
}

void steady_temperature::set(const heat_rows &rows) {
  rows_ = rows;
  kernel_.set(rows, rows.dx * (rows.nx + 1));
}

void steady_temperature::exchange(const double *pressure, double *e, double depth) {
  exchanged_heat_ = 0;
  for (int j = 0; j < rows_.ny; ++j) {
    const ptrdiff_t row = static_cast<ptrdiff_t>(j) * rows_.nx;
    exchange_.set_row(rows_, pressure + row);
    exchanged_heat_ += exchange_.heat();
    for (int k = 0; k < rows_.nx; ++k)
      e[row + (rows_.direction > 0 ? rows_.nx - 1 - k : k)] = exchange_.at(k, depth);
  }
}

void steady_temperature::at_depth(const thermal_pair &pair, int k, double z, const double *q,
                                  const double *pressure, double *temperature) {
  const int n = rows_.nx * rows_.ny;
  const double kappa = pair.body[k].diffusivity();
  // standing still heat has all time to spread: no depth differs from the surface
  const double depth = rows_.speed > 0 ? z / std::sqrt(kappa * rows_.dx / rows_.speed) : 0.0;
  std::fill_n(temperature, n, 0.0);
  if (pair.exchanges()) exchange(pressure, temperature, depth);
  for (int i = 0; i < n; ++i)
    temperature[i] = (pair.surface(k, temperature[i], 0.0)) * pair.effusivity();
  deep_.set(rows_, rows_.dx * (rows_.nx + 1), z / std::sqrt(kappa));
  deep_.apply(rows_, q, temperature, temperature);
  for (int i = 0; i < n; ++i) temperature[i] /= pair.effusivity();
}

}  // namespace railpatch
