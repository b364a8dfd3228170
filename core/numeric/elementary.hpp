// Elementary functions that give the same bits on every computer. Those of C's library are chosen
// by the processor and differ from system to system; these are made of nothing but +, -, *, / and
// square roots, which IEEE 754 rounds in one way (no fused multiply-add: -ffp-contract=off).
//
// Errors are units in the last place: docs/same_bits.md says how many, test_elementary holds them.
// Limits and signs of zero are those of C. Names are found in the core before those of C: none is
// written std::.
#pragma once

#include <cmath>

namespace railpatch {

double exp(double x);
double exp2(double x);
double expm1(double x);
double log(double x);
double pow(double x, double y);
double cbrt(double x);
// angles beyond 4e8 count as multiples of the number nearest to 2 pi: less than their own rounding
double sin(double x);
double cos(double x);
double tan(double x);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);
double sinh(double x);
double cosh(double x);
double asinh(double x);
double erfc(double x);

// asinh of each, in its place: the same bits
void asinh_of(double *values, int count);

// lengths whose squares are too large or too small for a number
double scaled_hypot(double x, double y);

inline double hypot(double x, double y) {
  const double square = x * x + y * y;
  return square > 1e-280 && square < 1e300 ? std::sqrt(square) : scaled_hypot(x, y);
}

}  // namespace railpatch
