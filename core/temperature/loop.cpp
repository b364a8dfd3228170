#include "temperature/loop.hpp"

namespace railpatch {

temperature_loop::temperature_loop(int max_count) {
  const auto n = static_cast<size_t>(max_count);
  for (auto *b : {&next_, &best_mu_, &heat_, &f_[0], &f_[1], &g_[0], &g_[1]})
    *b = aligned_buffer<double>(n);
}

double consistent_coefficient(const temperature_law &law, double a, double b, double mu) {
  const double cold = law.reference, hot = law.reference + law.change;
  const double begin = law.reference_temperature, end = begin + law.range;
  const bool stays_cold = a + b * cold <= begin, gets_hot = a + b * hot >= end;
  if (stays_cold && gets_hot) return std::fabs(mu - cold) <= std::fabs(mu - hot) ? cold : hot;
  if (stays_cold) return cold;
  if (gets_hot) return hot;
  const double slope = law.change / law.range;
  const double root = (cold + slope * (a - begin)) / (1.0 - slope * b);
  return std::clamp(root, std::min(cold, hot), std::max(cold, hot));
}

// next_ = coefficients consistent with the heat per coefficient of (mu, q).
void temperature_loop::pass(const problem &p, const double *mu, const double *q, bool keep) {
  const int nx = p.rows.nx, ahead = p.rows.direction;
  const double per_body = 1.0 / p.effusivity;
  const heat_kernel &kernel = *p.kernel;
  for (int j = 0; j < p.rows.ny; ++j) {
    const ptrdiff_t row = static_cast<ptrdiff_t>(j) * nx;
    for (int k = 0; k < nx; ++k) {
      const int i = ahead > 0 ? nx - 1 - k : k;
      const auto at = static_cast<size_t>(row + i);
      next_[at] = mu[at];
      heat_[at] = q[at];
      if (!(p.pressure[at] > 0)) continue;
      const double h = mu[at] > 0 ? std::max(q[at], 0.0) / mu[at] : 0.0;
      // what does not go with the coefficient
      const double fixed = q[at] - h * mu[at];
      double temperature = p.background[at];
      for (int m = 1; m <= std::min(k, kernel.count() - 1); ++m)
        temperature +=
            per_body * kernel.weight(m) * heat_[static_cast<size_t>(row + i + ahead * m)];
      const double weight = kernel.count() > 0 ? per_body * kernel.weight(0) : 0.0;
      temperature += weight * fixed;
      const double own = weight * h;
      next_[at] = consistent_coefficient(p.law, temperature, own, keep ? mu[at] : p.law.reference);
      heat_[at] = h * next_[at] + fixed;
    }
  }
}

double temperature_loop::change(int n, const double *mu) const {
  double greatest = 0;
  for (int i = 0; i < n; ++i) {
    const double d = std::fabs(next_[static_cast<size_t>(i)] - mu[i]);
    // written so that a number that is none stays visible
    if (!(d <= greatest)) greatest = d;
  }
  return greatest;
}

// Greatest distance of a coefficient from the law at the temperature that the heat q gives.
double temperature_loop::missed(const problem &p, const double *mu, const double *q) const {
  const int nx = p.rows.nx, ahead = p.rows.direction;
  const double per_body = 1.0 / p.effusivity;
  const heat_kernel &kernel = *p.kernel;
  double greatest = 0;
  for (int j = 0; j < p.rows.ny; ++j)
    for (int k = 0; k < nx; ++k) {
      const int i = j * nx + (ahead > 0 ? nx - 1 - k : k);
      if (!(p.pressure[i] > 0)) continue;
      double rise = 0;
      for (int m = 0; m <= std::min(k, kernel.count() - 1); ++m)
        rise += kernel.weight(m) * q[i + ahead * m];
      const double d = std::fabs(p.law.coefficient(p.background[i] + per_body * rise) - mu[i]);
      if (!(d <= greatest)) greatest = d;
    }
  return greatest;
}

// Anderson's mixing: the combination of this pass and the former two whose changes are least in the
// sum of squares.
void temperature_loop::advance(const problem &p, double *mu) {
  const int n = p.rows.nx * p.rows.ny;
  double a11 = 0, a12 = 0, a22 = 0, b1 = 0, b2 = 0;
  for (int i = 0; i < n && former_ > 0; ++i) {
    const auto at = static_cast<size_t>(i);
    const double f = next_[at] - mu[i];
    const double d1 = f - f_[0][at], d2 = former_ > 1 ? f - f_[1][at] : 0.0;
    a11 += d1 * d1;
    a12 += d1 * d2;
    a22 += d2 * d2;
    b1 += d1 * f;
    b2 += d2 * f;
  }
  double c1 = a11 > 0 ? b1 / a11 : 0.0, c2 = 0;
  const double determinant = a11 * a22 - a12 * a12;
  if (former_ > 1 && determinant > 1e-10 * a11 * a22) {
    c1 = (b1 * a22 - b2 * a12) / determinant;
    c2 = (b2 * a11 - b1 * a12) / determinant;
  }
  // far extrapolation is no better than the pass itself
  if (!(std::fabs(c1) + std::fabs(c2) < 4.0)) c1 = c2 = 0;
  const double low = std::min(p.law.reference, p.law.reference + p.law.change);
  const double high = std::max(p.law.reference, p.law.reference + p.law.change);
  const int kept = former_;
  for (int i = 0; i < n; ++i) {
    const auto at = static_cast<size_t>(i);
    const double f = next_[at] - mu[i], g = next_[at];
    double mixed = g - (1.0 - damping_) * f;
    if (kept > 0) mixed -= c1 * (g - g_[0][at] - (1.0 - damping_) * (f - f_[0][at]));
    if (kept > 1) mixed -= c2 * (g - g_[1][at] - (1.0 - damping_) * (f - f_[1][at]));
    f_[1][at] = f_[0][at];
    g_[1][at] = g_[0][at];
    f_[0][at] = f;
    g_[0][at] = g;
    mu[i] = p.pressure[at] > 0 ? std::clamp(mixed, low, high) : mu[i];
  }
  former_ = std::min(kept + 1, 2);
}

// Back to the best coefficients, with shorter steps and nothing remembered.
void temperature_loop::restart(int n, double *mu) {
  std::copy_n(best_mu_.data(), n, mu);
  damping_ = std::max(0.5 * damping_, 1.0 / 64.0);
  former_ = since_best_ = 0;
}

}  // namespace railpatch
