#include "fluid/film.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// of the groups: far outside of all that they describe, and within what numbers hold
constexpr double least_load = 1e-30, least_pressure = 1e-12;
// logarithms of 145, 3.18, 1.29, 1.48
constexpr double ln_145 = 4.976733742420574, ln_3_18 = 1.1568811967920856,
                 ln_1_29 = 0.25464221837358075, ln_1_48 = 0.3920420877760237;

}  // namespace

elliptic_film::elliptic_film(const film_contact &c) {
  const double u = c.viscosity * 2.0 * c.speed / (c.modulus * c.radius[0]);
  const double root = std::sqrt(u), quarter = std::sqrt(root);
  const double n =
      std::max(c.force / (c.modulus * c.radius[0] * c.radius[0]) / (root * quarter), least_load);
  const double l = std::max(c.pressure_coefficient * c.modulus * quarter, least_pressure);
  const double d = c.radius[0] / c.radius[1], log_d = log(d), log_n = log(n), log_l = log(l);
  const double round = 0.63 * exp(4.0 / 7.0 * log_d), k = 1.0 + 0.006 * log_d + round;
  const double log_k = log(k);
  const double wide = 0.796 * exp(14.0 / 15.0 * log_d), width = log(1.0 + wide);
  const double log_rigid = ln_145 - 15.0 / 7.0 * width - log_d - 2.0 * log_n;
  const double log_elastic = ln_3_18 - 14.0 / 25.0 * log_k - log_d / 15.0 - 2.0 / 15.0 * log_n;
  const double log_rp = ln_1_29 - 2.0 / 3.0 * log(1.0 + 0.691 * d) + 2.0 / 3.0 * log_l;
  const double log_ep = ln_1_48 - 7.0 / 20.0 * log_k - log_d / 24.0 - log_n / 12.0 + 0.75 * log_l;
  rigid_ = exp(std::min(1.5 * log_rigid, 600.0));
  elastic_ = exp(-4.0 * log_elastic);
  limit_ = d * d * d * d / (1.8 * 1.8 * 1.8 * 1.8);
  // the smaller of both counts
  const double thinner = std::min(log_rp, log_ep);
  const double of_rp = exp(-8.0 * (log_rp - thinner)), of_ep = exp(-8.0 * (log_ep - thinner));
  of_rigid_ = of_rp / (of_rp + of_ep);
  log_piezo_ = thinner - 0.125 * log(of_rp + of_ep);
  ratio_ = exp(std::min(log_elastic - log_ep, 600.0));
  unit_ = c.radius[0] * root;
  piezoviscous_ = c.pressure_coefficient > 0;
  const double k_by_ratio = (0.006 + 4.0 / 7.0 * round) / k;
  by_ratio_ = {-2.0 * wide / (1.0 + wide) - 1.0, -14.0 / 25.0 * k_by_ratio - 1.0 / 15.0,
               -2.0 / 3.0 * (0.691 * d / (1.0 + 0.691 * d)), -7.0 / 20.0 * k_by_ratio - 1.0 / 24.0};
}

double film_point::thickness() const { return exp(over_unit) * unit; }

film_point elliptic_film::at(double q) const {
  const double root = std::sqrt(q), log_q = q == 1.0 ? 0.0 : log(q);
  const double a = rigid_ / (q * q * std::sqrt(root));
  const double stiff = q == 1.0 ? 1.0 : exp(0.4 * log_q), e = elastic_ * stiff;
  const double both = std::sqrt(std::sqrt(std::sqrt(e + limit_)));  // to the power 1/8
  const double b = 1.0 / (both * both * both);
  const double log_i = 2.0 / 3.0 * log(a + b);
  const double i_by_ri = a / (a + b), i_by_ei = b / (a + b) * (e / (e + limit_));
  const double i_by_limit = 1.0 - i_by_ri - i_by_ei;
  if (!piezoviscous_) {
    const double by_part = -1.5 * i_by_ri - 0.1 * i_by_ei - 0.5;
    return {unit_ / root,
            log_i,
            -2.0 * i_by_ri - 2.0 / 15.0 * i_by_ei,
            1.5 * i_by_ri + 0.1 * i_by_ei + 0.5,
            by_part,
            i_by_ri * by_ratio_.ri + i_by_ei * by_ratio_.ei - i_by_limit};
  }
  const double log_p = log_piezo_ + 0.5 * log_q;
  const double z = 1.2 * ratio_ * (stiff / q), decay = exp(-z);
  const double s = 1.5 * (1.0 + decay), way = log_i - log_p;
  // ln h = ln P + ln(1 + exp(s way))/s, from the greater of both
  const double y = s * way, small = exp(-std::fabs(y)), rest = log(1.0 + small);
  const double sum = std::max(y, 0.0) + rest;
  const double of_i = y > 0 ? 1.0 / (1.0 + small) : small / (1.0 + small);
  // d ln h/d ln I = of_i, by ln P the rest, by s
  const double by_s = (of_i * way - sum / s) / s;
  const double s_by_ratio = -1.5 * decay * z;  // ds/d ln(h_EI/h_EP)
  const double by_ri = of_i * i_by_ri, by_ei = of_i * i_by_ei + by_s * s_by_ratio;
  const double by_rp = (1.0 - of_i) * of_rigid_;
  const double by_ep = (1.0 - of_i) * (1.0 - of_rigid_) - by_s * s_by_ratio;
  film_point found;
  found.unit = unit_ / root;
  found.over_unit = log_p + sum / s;
  found.by_load = -2.0 * by_ri - 2.0 / 15.0 * by_ei - by_ep / 12.0;
  found.by_speed = 1.5 * by_ri + 0.1 * by_ei + by_rp / 6.0 + 0.25 * by_ep + 0.5;
  found.by_part = -1.5 * by_ri - 0.1 * by_ei + 0.5 * (by_rp + by_ep) - 0.5;
  found.by_ratio = by_ri * by_ratio_.ri + by_ei * by_ratio_.ei - of_i * i_by_limit +
                   by_rp * by_ratio_.rp + by_ep * by_ratio_.ep;
  return found;
}

}  // namespace railpatch
