#include "numeric/elementary.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <numbers>

namespace railpatch {

namespace {

// a number hi and what it leaves out, lo: the sum of both has twice the digits (Dekker 1971)
struct two_parts {
  double hi, lo;
};

#include "numeric/elementary_table.inc"

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = std::numbers::pi, pi_rest = 1.2246467991473532e-16;
// below this, a power series is its first term
constexpr double tiny = 0x1p-30;

two_parts sum_of(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}

// of numbers of which the first is the greater
two_parts ordered_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

// of numbers below 1e290
two_parts product_of(double a, double b) {
  constexpr double split = 0x1p27 + 1;
  const double p = a * b, s = split * a, t = split * b;
  const double a1 = s - (s - a), a2 = a - a1, b1 = t - (t - b), b2 = b - b1;
  return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

uint64_t bits_of(double x) {
  uint64_t bits;
  std::memcpy(&bits, &x, sizeof x);
  return bits;
}

double number_of(uint64_t bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

double power_of(int n) { return number_of(static_cast<uint64_t>(n + 1023) << 52); }

// v 2^n for v from 1 to 2
double scaled(double v, int n) {
  if (n > 1023) return v * 2.0 * power_of(n - 1);
  return n < -1022 ? v * power_of(n + 60) * 0x1p-60 : v * power_of(n);
}

// e^r - 1 with |r| < ln(2)/128
double expm1_near_zero(double r) {
  const double series = 1.0 / 24 + r * (1.0 / 120 + r * (1.0 / 720));
  return r + r * r * (0.5 + r * (1.0 / 6 + r * series));
}

// x + rest as k ln(2)/64 and what is left of it
struct reduced_power {
  int k;
  double left;
};

reduced_power reduce_power(double x, double rest) {
  // the first part has 36 bits, so that k times it is exact
  constexpr double part = 0x1.62e42fefa0000p-7, after = 2.572804622327669e-14;
  const double k = std::floor(x * 92.33248261689366 + 0.5);
  return {static_cast<int>(k), ((x - k * part) - k * after) + rest};
}

// 2^(k/64) e^r
double from_reduced(int k, double r) {
  const two_parts t = power_of_two[k & 63];
  return scaled(t.hi + (t.lo + t.hi * expm1_near_zero(r)), k >> 6);
}

// e^(x + rest)
double exp_of(double x, double rest) {
  if (!(x < 709.8)) return x + infinity;
  if (x < -745.2) return 0.0;
  const reduced_power r = reduce_power(x, rest);
  return from_reduced(r.k, r.left);
}

// ln(x + rest), x > 0 and finite
two_parts log_of(double x, double rest) {
  constexpr double ln2 = 0x1.62e42fefa2000p-1, ln2_rest = 7.371002565167799e-13;
  int n = 0;
  if (x < std::numeric_limits<double>::min()) {
    x *= 0x1p54;
    n = -54;
  }
  const auto bits = bits_of(x);
  constexpr uint64_t fraction = (uint64_t{1} << 52) - 1, unit = uint64_t{1023} << 52;
  constexpr uint64_t root_of_two = 0x6a09e667f3bcd;  // its fraction
  // without a branch, whose way would be as chance has it
  const uint64_t part = bits & fraction, above = (root_of_two - part) >> 63;
  n += static_cast<int>((bits >> 52) + above) - 1023;
  const double m = number_of(part | (unit - (above << 52)));
  if (rest != 0) rest *= power_of(-n);
  // m = c (1 + r): c has 8 bits and the first part of r 24, so what is left of m is exact
  const double i = std::floor(m * 128 + 0.5), c = i * 0x1p-7;
  const double d = m - c, first = static_cast<float>((d + rest) / c);
  const double second = ((d - first * c) + rest) / c, r = first + second;
  const double series = 1.0 / 4 - r * (1.0 / 5 - r * (1.0 / 6 - r * (1.0 / 7)));
  const double curved = r * r * (-0.5 + r * (1.0 / 3 - r * series));
  const two_parts table = logarithm[static_cast<int>(i) - 90];
  const two_parts coarse = sum_of(n * ln2, table.hi);
  const two_parts fine = sum_of(coarse.hi, first);
  return ordered_sum(fine.hi, fine.lo + coarse.lo + n * ln2_rest + table.lo + second + curved);
}

// angle from the x axis to (x, y), 0 <= y <= x, x > 0 and neither very large nor very small
two_parts angle_below_diagonal(double y, double x) {
  const int i = static_cast<int>(8 * (y / x) + 0.5);
  two_parts num{y, 0}, den{x, 0};
  if (i > 0) {
    // tan(angle - atan(c)) = (y - c x)/(x + c y)
    const two_parts cx = product_of(i * 0.125, x), cy = product_of(i * 0.125, y);
    num = sum_of(y, -cx.hi);
    num.lo -= cx.lo;
    den = ordered_sum(x, cy.hi);
    den.lo += cy.lo;
  }
  const double t = num.hi / den.hi;
  const two_parts back = product_of(t, den.hi);
  const double rest = ((num.hi - back.hi) - back.lo + num.lo - t * den.lo) / den.hi;
  const double s = t * t;
  const double series = 1.0 / 7 - s * (1.0 / 9 - s * (1.0 / 11 - s * (1.0 / 13)));
  const double curved = t * s * (-1.0 / 3 + s * (1.0 / 5 - s * series));
  const two_parts table = arc_tangent[i], a = sum_of(table.hi, t);
  return {a.hi, a.lo + table.lo + rest + curved};
}

// angle from the x axis to (x, y), 0 <= x, y and not both 0
two_parts angle_in_quadrant(double y, double x) {
  const double large = std::max(x, y), small = std::min(x, y);
  if (large == infinity) {
    const double share = small == infinity ? 0.5 : y > x ? 1.0 : 0.0;
    return {share * pi / 2, share * pi_rest / 2};
  }
  two_parts a{small / large, 0.0};
  if (!(a.hi < tiny)) {
    const double scale = large > 1e140 ? 0x1p-600 : large < 1e-140 ? 0x1p600 : 1.0;
    a = angle_below_diagonal(small * scale, large * scale);
  }
  if (y <= x) return a;
  const two_parts turned = ordered_sum(pi / 2, -a.hi);
  return {turned.hi, turned.lo + (pi_rest / 2 - a.lo)};
}

// asin(x), 0 <= x <= 1: the angle to (sqrt(1 - x^2), x), with the root's own rest
two_parts angle_of_sine(double x) {
  const two_parts square = product_of(x, x);
  two_parts under = ordered_sum(1.0, -square.hi);
  under.lo -= square.lo;
  const double root = std::sqrt(std::max(under.hi, 0.0));
  if (root == 0) return {pi / 2, pi_rest / 2};
  two_parts a = angle_in_quadrant(x, root);
  const two_parts back = product_of(root, root);
  a.lo -= x * (((under.hi - back.hi) - back.lo + under.lo) / (2 * root));
  return a;
}

// x as a multiple of pi/2 and what is left, |left| <= pi/4
struct reduced_angle {
  unsigned quarter;
  two_parts left;
};

reduced_angle reduce_angle(double x) {
  if (std::abs(x) <= pi / 4) return {0, {x, 0}};
  if (std::abs(x) > 4e8) x = std::fmod(x, 2 * pi);
  // pi/2 in four parts, 25 bits each but for the last: so often their multiples are exact
  constexpr double parts[] = {0x1.921fb5p+0, 0x1.110b46p-26, 0x1.1a6263p-54, 0x1.8a2e03707344ap-81};
  const double n = std::floor(x * (2 / pi) + 0.5);
  two_parts left = sum_of(x - n * parts[0], -n * parts[1]);
  const two_parts finer = sum_of(left.hi, -n * parts[2]);
  left = ordered_sum(finer.hi, finer.lo + left.lo - n * parts[3]);
  return {static_cast<unsigned>(static_cast<int64_t>(n)) & 3u, left};
}

// Taylor's series at |r| <= pi/4
double sine_of(two_parts r) {
  const double z = r.hi * r.hi;
  double series = -1.0 / 1307674368000 + z * (1.0 / 355687428096000);
  for (const double c : {1.0 / 6227020800, -1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120})
    series = c + z * series;
  return r.hi + (r.lo * (1 - 0.5 * z) + r.hi * z * (-1.0 / 6 + z * series));
}

double cosine_of(two_parts r) {
  const double z = r.hi * r.hi, half = 0.5 * z, w = 1 - half;
  double series = -1.0 / 87178291200 + z * (1.0 / 20922789888000);
  for (const double c : {1.0 / 479001600, -1.0 / 3628800, 1.0 / 40320, -1.0 / 720, 1.0 / 24})
    series = c + z * series;
  return w + (((1 - w) - half) + (z * z * series - r.hi * r.lo));
}

}  // namespace

double exp(double x) { return exp_of(x, 0); }

double exp2(double x) {
  if (!(x < 1024)) return x + infinity;
  if (x < -1075) return 0.0;
  const double k = std::floor(x * 64 + 0.5);
  return from_reduced(static_cast<int>(k), (x - k * 0x1p-6) * std::numbers::ln2);
}

double expm1(double x) {
  if (std::abs(x) < tiny) return x;
  if (!(x < 40)) return exp(x);
  if (x < -40) return -1.0;
  const reduced_power r = reduce_power(x, 0);
  const double p = expm1_near_zero(r.left);
  if (r.k == 0) return p;
  const two_parts t = power_of_two[r.k & 63];
  const double scale = power_of(r.k >> 6);
  const two_parts a = sum_of(t.hi * scale, -1.0);
  return a.hi + (a.lo + scale * (t.lo + t.hi * p));
}

double log(double x) {
  if (!(x > 0)) return x == 0 ? -infinity : not_a_number;
  if (x == infinity) return x;
  const two_parts l = log_of(x, 0);
  return l.hi + l.lo;
}

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1.0;
  if (x != x || y != y) return not_a_number;
  if (std::signbit(x)) {
    const bool whole = y == std::floor(y), odd = std::abs(std::fmod(y, 2.0)) == 1;
    if (!whole && x < 0 && x > -infinity) return not_a_number;
    return odd ? -pow(-x, y) : pow(-x, y);
  }
  if (x == 0 || x == infinity) return (x == 0) == (y > 0) ? 0.0 : infinity;
  const two_parts l = log_of(x, 0);
  // where the product of parts would overflow, the power does
  if (!(std::abs(y) < 1e20)) return exp(y * l.hi);
  const two_parts product = product_of(y, l.hi);
  return exp_of(product.hi, product.lo + y * l.lo);
}

double cbrt(double x) {
  const double size = std::abs(x);
  if (!(size > 0) || size == infinity) return x;
  if (size < std::numeric_limits<double>::min()) return cbrt(x * 0x1p54) * 0x1p-18;
  const auto bits = bits_of(size);
  const int exponent = static_cast<int>(bits >> 52) - 1023;
  const int third = (exponent + 3 * 1024) / 3 - 1024, twos = exponent - 3 * third;
  const double m = size * power_of(-3 * third / 2) * power_of(-3 * third - -3 * third / 2);
  // the parabola errs by 1e-3 at most, Halley's step leaves 1e-9, Newton's less than a rounding
  constexpr double root_of_two[] = {1.0, 1.2599210498948732, 1.5874010519681994};
  const double f = m / (1 << twos);
  double y = (0.625687 + f * (0.433561 - f * 0.0583617)) * root_of_two[twos];
  const double near = y * y * y;
  y *= (near + 2 * m) / (2 * near + m);
  const two_parts square = product_of(y, y), cube = product_of(square.hi, y);
  const double excess = (cube.hi - m) + cube.lo + square.lo * y;
  return std::copysign((y - excess / (3 * square.hi)) * power_of(third), x);
}

double sin(double x) {
  if (!(std::abs(x) < infinity)) return not_a_number;
  if (std::abs(x) < tiny) return x;
  const reduced_angle r = reduce_angle(x);
  const double v = r.quarter & 1 ? cosine_of(r.left) : sine_of(r.left);
  return r.quarter & 2 ? -v : v;
}

double cos(double x) {
  if (!(std::abs(x) < infinity)) return not_a_number;
  const reduced_angle r = reduce_angle(x);
  const double v = r.quarter & 1 ? sine_of(r.left) : cosine_of(r.left);
  return (r.quarter + 1) & 2 ? -v : v;
}

double tan(double x) { return sin(x) / cos(x); }

double asin(double x) {
  const double size = std::abs(x);
  if (!(size <= 1)) return not_a_number;
  if (size < tiny) return x;
  const two_parts a = angle_of_sine(size);
  return std::copysign(a.hi + a.lo, x);
}

double acos(double x) {
  const double size = std::abs(x);
  if (!(size <= 1)) return not_a_number;
  const two_parts a = angle_of_sine(size);
  const double sign = std::copysign(1.0, x);
  const two_parts turned = sum_of(pi / 2, -sign * a.hi);
  return turned.hi + (turned.lo + (pi_rest / 2 - sign * a.lo));
}

double atan(double x) { return atan2(x, 1.0); }

double atan2(double y, double x) {
  if (x != x || y != y) return not_a_number;
  if (y == 0) return std::signbit(x) ? std::copysign(pi, y) : y;
  two_parts a = angle_in_quadrant(std::abs(y), std::abs(x));
  if (std::signbit(x)) {
    const two_parts turned = ordered_sum(pi, -a.hi);
    a = {turned.hi, turned.lo + (pi_rest - a.lo)};
  }
  return std::copysign(a.hi + a.lo, y);
}

double sinh(double x) {
  const double size = std::abs(x);
  if (size < tiny) return x;
  if (size > 40) {
    const double root = exp(0.5 * size);
    return std::copysign(0.5 * root * root, x);
  }
  const double e = expm1(size);
  return std::copysign(0.5 * (e + e / (e + 1)), x);
}

double cosh(double x) {
  const double root = exp(0.5 * std::abs(x)), e = root * root;
  return 0.5 * e + 0.5 / e;
}

double asinh(double x) {
  const double a = std::abs(x);
  if (!(a > tiny) || a == infinity) return x;
  if (a > 1e8) return std::copysign(log(a) + std::numbers::ln2, x);
  const double square = a * a;
  const two_parts one = sum_of(1.0, a),
                  all = ordered_sum(one.hi, square / (1 + std::sqrt(1 + square)));
  const two_parts l = log_of(all.hi, all.lo + one.lo);
  return std::copysign(l.hi + l.lo, x);
}

double erfc(double x) {
  if (x != x) return x;
  if (x < 0) return 2 - erfc(-x);
  if (x > 27.3) return 0.0;
  const double square = x * x;
  if (x < 0.25) {
    double term = x, sum = x;
    for (int n = 1; n < 12; ++n) {
      term *= -square / n;
      sum += term / (2 * n + 1);
    }
    return 1 - 2 * std::numbers::inv_sqrtpi * sum;
  }
  const double t = 2 * (x - 2) / (x + 2);
  double b0 = 0, b1 = 0;
  for (int n = static_cast<int>(std::size(erfc_series)) - 1; n > 0; --n) {
    const double b2 = b1;
    b1 = b0;
    b0 = erfc_series[n] + t * b1 - b2;
  }
  const two_parts exact = product_of(x, x);
  const double scaled_value = (erfc_series[0] + 0.5 * t * b0 - b1) / (1 + 2 * x);
  return exp_of(-exact.hi, -exact.lo) * scaled_value;
}

double scaled_hypot(double x, double y) {
  const double a = std::abs(x), b = std::abs(y), large = std::max(a, b);
  if (a == infinity || b == infinity) return infinity;
  if (!(large > 0)) return a + b;
  const double scale = large > 1 ? 0x1p-600 : 0x1p600;
  const double u = a * scale, v = b * scale;
  return std::sqrt(u * u + v * v) / scale;
}

}  // namespace railpatch
