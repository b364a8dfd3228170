// Sums in eight interleaved parts: fast, and in the same order on every machine whatever the width
// of its registers.
#pragma once

#include <cstddef>

namespace railpatch {

double dot(const double *a, const double *b, size_t n);
double total(const double *a, size_t n);
// Of a - b, each to its own last digit.
double total_difference(const double *a, const double *b, size_t n);

// The same for several vectors, `stride` apart: out[m] = a_m . v
void dots(const double *a, size_t stride, int count, const double *v, size_t n, double *out);
// v -= sum over m of factor[m] a_m
void subtract(const double *a, size_t stride, int count, const double *factor, double *v, size_t n);

}  // namespace railpatch
