#include "sums.hpp"

#include "simd.hpp"

namespace railpatch {

namespace {

constexpr size_t parts = 8;

// term(i) is the i-th term
template <class Term>
RAILPATCH_INLINE double sum(size_t n, Term &&term) {
  double s[parts] = {};
  const size_t whole = n / parts * parts;
  for (size_t i = 0; i < whole; i += parts)
    for (size_t k = 0; k < parts; ++k) s[k] += term(i + k);
  for (size_t i = whole; i < n; ++i) s[i - whole] += term(i);
  return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
}

}  // namespace

RAILPATCH_DISPATCH
double dot(const double *a, const double *b, size_t n) {
  return sum(n, [=](size_t i) { return a[i] * b[i]; });
}

RAILPATCH_DISPATCH
double total(const double *a, size_t n) {
  return sum(n, [=](size_t i) { return a[i]; });
}

}  // namespace railpatch
