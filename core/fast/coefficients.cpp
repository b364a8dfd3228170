#include "fast/coefficients.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "numeric/dual.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

#include "fast/kalker_table.inc"

constexpr size_t orders = 5;  // Poisson's ratios of the computed table

// Lagrange polynomials through the Chebyshev-Lobatto points of 0 ... 1/2: the factors of the one of
// each point are the same for every entry of the table
class between_orders {
 public:
  explicit between_orders(double nu) {
    double node[orders];
    for (size_t i = 0; i < orders; ++i)
      node[i] = 0.25 * (1.0 - cos(std::numbers::pi * static_cast<double>(i) / 4.0));
    for (size_t k = 0; k < orders; ++k)
      for (size_t i = 0; i < orders; ++i)
        factor_[k][i] = i == k ? 1.0 : (nu - node[i]) / (node[k] - node[i]);
  }
  double operator()(const double (&values)[orders]) const {
    double sum = 0;
    for (size_t k = 0; k < orders; ++k) {
      double weight = values[k];
      for (double factor : factor_[k]) weight *= factor;
      sum += weight;
    }
    return sum;
  }

 private:
  double factor_[orders][orders];
};

// rows a/b = 0.1 ... 1 and then b/a = 0.9 ... 0.1; columns c11, c22, c23 at nu = 0, 1/4, 1/2
constexpr std::array<std::array<double, 9>, 19> published = {{
    {2.51, 3.31, 4.85, 2.51, 2.52, 2.53, 0.334, 0.473, 0.731},
    {2.59, 3.37, 4.81, 2.59, 2.63, 2.66, 0.483, 0.603, 0.809},
    {2.68, 3.44, 4.80, 2.68, 2.75, 2.81, 0.607, 0.715, 0.889},
    {2.78, 3.53, 4.82, 2.78, 2.88, 2.98, 0.720, 0.823, 0.977},
    {2.88, 3.62, 4.83, 2.88, 3.01, 3.14, 0.827, 0.929, 1.07},
    {2.98, 3.72, 4.91, 2.98, 3.14, 3.31, 0.930, 1.03, 1.18},
    {3.09, 3.81, 4.97, 3.09, 3.28, 3.48, 1.03, 1.14, 1.29},
    {3.19, 3.91, 5.05, 3.19, 3.41, 3.65, 1.13, 1.25, 1.40},
    {3.29, 4.01, 5.12, 3.29, 3.54, 3.82, 1.23, 1.36, 1.51},
    {3.40, 4.12, 5.20, 3.40, 3.67, 3.98, 1.33, 1.47, 1.63},
    {3.51, 4.22, 5.30, 3.51, 3.81, 4.16, 1.44, 1.59, 1.77},
    {3.65, 4.36, 5.42, 3.65, 3.99, 4.39, 1.58, 1.75, 1.94},
    {3.82, 4.54, 5.58, 3.82, 4.21, 4.67, 1.76, 1.95, 2.18},
    {4.06, 4.78, 5.80, 4.06, 4.50, 5.04, 2.01, 2.23, 2.50},
    {4.37, 5.10, 6.11, 4.37, 4.90, 5.56, 2.35, 2.62, 2.96},
    {4.84, 5.57, 6.57, 4.84, 5.48, 6.31, 2.88, 3.24, 3.70},
    {5.57, 6.34, 7.34, 5.57, 6.40, 7.51, 3.79, 4.32, 5.01},
    {6.96, 7.78, 8.82, 6.96, 8.14, 9.79, 5.72, 6.63, 7.89},
    {10.7, 11.7, 12.9, 10.7, 12.8, 16.0, 12.2, 14.6, 18.0},
}};

double published_ratio(size_t row) {
  const double step = 0.1 * static_cast<double>(row + 1);
  return row < 10 ? step : 1.0 / (2.0 - step);
}

// 1/C linear between nu = 0, 1/4, 1/2
double between_poisson_ratios(const double *v, double nu) {
  const double t = 4.0 * nu;
  const int k = t < 1.0 ? 0 : 1;
  return 1.0 / ((1.0 + k - t) / v[k] + (t - k) / v[k + 1]);
}

}  // namespace

coefficient_table::coefficient_table(double poisson_ratio) {
  static_assert(nodes == kalker_nodes);
  const between_orders at_poisson_ratio(poisson_ratio);
  for (size_t i = 0; i < nodes; ++i)
    for (size_t k = 0; k < 4; ++k)
      for (size_t d = 0; d < 2; ++d) values_[i][k][d] = at_poisson_ratio(kalker_values[i][k][d]);
}

template <class T>
void coefficient_table::at(const T &axis_ratio, T c[4]) const {
  const double greatest = log(kalker_greatest_ratio), step = 2.0 * greatest / (nodes - 1);
  T t = log(axis_ratio);
  if (t < -greatest) t = -greatest;
  if (t > greatest) t = greatest;
  const T place = (t + greatest) / step;
  const int node = std::clamp(static_cast<int>(value_of(place)), 0, nodes - 2);
  // cubic Hermite polynomial
  const T u = place - node, v = 1.0 - u;
  const T h0 = v * v * (1.0 + 2.0 * u), h1 = u * u * (1.0 + 2.0 * v);
  const T d0 = step * u * v * v, d1 = -step * u * u * v;
  const auto &left = values_[node], &right = values_[node + 1];
  for (int k = 0; k < 4; ++k)
    c[k] = h0 * left[k][0] + d0 * left[k][1] + h1 * right[k][0] + d1 * right[k][1];
}

template void coefficient_table::at(const double &, double[4]) const;
template void coefficient_table::at(const directed &, directed[4]) const;

creepage_coefficients coefficient_table::at(double axis_ratio) const {
  double c[4];
  at(axis_ratio, c);
  const bool in_range =
      axis_ratio >= 1.0 / kalker_greatest_ratio && axis_ratio <= kalker_greatest_ratio;
  return {c[0], c[1], c[2], c[3], in_range};
}

creepage_coefficients published_coefficients(double axis_ratio, double poisson_ratio) {
  const double clamped = std::clamp(axis_ratio, 0.1, 10.0);
  size_t row = 0;
  while (row + 2 < published.size() && published_ratio(row + 1) < clamped) ++row;
  const double lower = log(published_ratio(row)), upper = log(published_ratio(row + 1));
  const double t = (log(clamped) - lower) / (upper - lower);
  double c[3];
  for (size_t k = 0; k < 3; ++k)
    c[k] = (1.0 - t) * between_poisson_ratios(&published[row][3 * k], poisson_ratio) +
           t * between_poisson_ratios(&published[row + 1][3 * k], poisson_ratio);
  return {c[0], c[1], c[2], 0.0, axis_ratio >= 0.1 && axis_ratio <= 10.0};
}

}  // namespace railpatch
