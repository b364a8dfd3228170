// asinh of many numbers: elementary.cpp's steps, without branches, for several numbers at once.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "numeric/elementary.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

namespace {

struct two_parts {
  double hi, lo;
};

#include "numeric/elementary_table.inc"

// at once, and within what the steps below hold
constexpr int most = 64;
constexpr double least = 0x1p-30, greatest = 1e8;

RAILPATCH_INLINE uint64_t bits_of(double x) {
  uint64_t bits;
  std::memcpy(&bits, &x, sizeof x);
  return bits;
}

RAILPATCH_INLINE double number_of(uint64_t bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

RAILPATCH_INLINE bool is_inside(double a) { return a > least && a <= greatest; }

// 1 + a + a^2/(1 + sqrt(1 + a^2)) = 2^n c (1 + r), c = place/128, r of a first and a second part
RAILPATCH_INLINE void reduce(double size, double &n, double &place, double &first, double &second) {
  const double a = is_inside(size) ? size : 1.0, square = a * a;
  const double one = 1.0 + a, t = one - 1.0;
  const double one_rest = (1.0 - (one - t)) + (a - t);
  const double beyond = square / (1 + std::sqrt(1 + square));
  const double all = one + beyond;
  const double all_rest = (beyond - (all - one)) + one_rest;
  constexpr uint64_t fraction = (uint64_t{1} << 52) - 1, unit = uint64_t{1023} << 52;
  constexpr uint64_t root_of_two = 0x6a09e667f3bcd;  // its fraction
  const uint64_t bits = bits_of(all), part = bits & fraction;
  const uint64_t above = (root_of_two - part) >> 63;
  const double m = number_of(part | (unit - (above << 52)));
  const uint64_t exponent = (bits >> 52) + above;
  // a whole number in the last digits of one of 2^52
  n = number_of(exponent | (uint64_t{1075} << 52)) - (0x1p52 + 1023.0);
  const double rest = all_rest * number_of((uint64_t{2046} - exponent) << 52);
  place = std::floor(m * 128 + 0.5);
  const double c = place * 0x1p-7, d = m - c;
  first = static_cast<float>((d + rest) / c);
  second = ((d - first * c) + rest) / c;
}

// n ln 2 + ln c + ln(1 + r), with ln c of two parts
RAILPATCH_INLINE double logarithm_of(double n, double first, double second, double hi, double lo) {
  constexpr double ln2 = 0x1.62e42fefa2000p-1, ln2_rest = 7.371002565167799e-13;
  const double r = first + second;
  const double series = 1.0 / 4 - r * (1.0 / 5 - r * (1.0 / 6 - r * (1.0 / 7)));
  const double curved = r * r * (-0.5 + r * (1.0 / 3 - r * series));
  const double whole = n * ln2, coarse = whole + hi, s = coarse - whole;
  const double coarse_rest = (whole - (coarse - s)) + (hi - s);
  const double fine = coarse + first, t = fine - coarse;
  const double fine_rest = (coarse - (fine - t)) + (first - t);
  const double rest = fine_rest + coarse_rest + n * ln2_rest + lo + second + curved;
  const double sum = fine + rest, left = rest - (sum - fine);
  return sum + left;
}

// within this file: what chooses the clone would be seen from outside
RAILPATCH_DISPATCH void find_asinh(double *values, int count) {
  double size[most], n[most], place[most], first[most], second[most], hi[most], lo[most];
  for (int from = 0; from < count; from += most) {
    const int here = std::min(most, count - from);
    double *at = values + from;
    for (int k = 0; k < here; ++k) size[k] = std::abs(at[k]);
    for (int k = 0; k < here; ++k) reduce(size[k], n[k], place[k], first[k], second[k]);
    for (int k = 0; k < here; ++k) {
      const two_parts table = logarithm[static_cast<int>(place[k]) - 90];
      hi[k] = table.hi;
      lo[k] = table.lo;
    }
    for (int k = 0; k < here; ++k)
      size[k] = std::copysign(logarithm_of(n[k], first[k], second[k], hi[k], lo[k]), at[k]);
    for (int k = 0; k < here; ++k) at[k] = is_inside(std::abs(at[k])) ? size[k] : asinh(at[k]);
  }
}

}  // namespace

void asinh_of(double *values, int count) { find_asinh(values, count); }

}  // namespace railpatch
