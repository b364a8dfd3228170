#include "numeric/sums.hpp"

#include "numeric/simd.hpp"

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

// Dispatched functions have no name outside: the choice between them would be seen of a library
// whose names are hidden otherwise.
RAILPATCH_DISPATCH
double dot_of(const double *a, const double *b, size_t n) {
  return sum(n, [=](size_t i) { return a[i] * b[i]; });
}

RAILPATCH_DISPATCH
double total_of(const double *a, size_t n) {
  return sum(n, [=](size_t i) { return a[i]; });
}

RAILPATCH_DISPATCH
double difference_of(const double *a, const double *b, size_t n) {
  return sum(n, [=](size_t i) { return a[i] - b[i]; });
}

RAILPATCH_DISPATCH
void dots_of(const double *a, size_t stride, int count, const double *v, size_t n, double *out) {
  for (int m = 0; m < count; ++m) {
    const double *own = a + static_cast<size_t>(m) * stride;
    out[m] = sum(n, [=](size_t i) { return own[i] * v[i]; });
  }
}

// vectors at once, so that the one they all change is read once for all of them
constexpr int together = 4;

RAILPATCH_DISPATCH
void subtract_from(const double *a, size_t stride, int count, const double *factor,
                   double *__restrict v, size_t n) {
  int m = 0;
  for (; m + together <= count; m += together) {
    const double *__restrict b = a + static_cast<size_t>(m) * stride;
    const double f[together] = {factor[m], factor[m + 1], factor[m + 2], factor[m + 3]};
    for (size_t i = 0; i < n; ++i)
      v[i] -= (f[0] * b[i] + f[1] * b[stride + i]) +
              (f[2] * b[2 * stride + i] + f[3] * b[3 * stride + i]);
  }
  for (; m < count; ++m) {
    const double *__restrict b = a + static_cast<size_t>(m) * stride;
    for (size_t i = 0; i < n; ++i) v[i] -= factor[m] * b[i];
  }
}

}  // namespace

double dot(const double *a, const double *b, size_t n) { return dot_of(a, b, n); }

double total(const double *a, size_t n) { return total_of(a, n); }

double total_difference(const double *a, const double *b, size_t n) {
  return difference_of(a, b, n);
}

void dots(const double *a, size_t stride, int count, const double *v, size_t n, double *out) {
  dots_of(a, stride, count, v, n, out);
}

void subtract(const double *a, size_t stride, int count, const double *factor, double *__restrict v,
              size_t n) {
  subtract_from(a, stride, count, factor, v, n);
}

}  // namespace railpatch
