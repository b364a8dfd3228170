// Numbers that carry their rates of change: forward-mode differentiation.
//
// value + rate[0] e_0 + ... + rate[n-1] e_(n-1) with e_i e_j = 0 (Clifford 1873; Griewank and
// Walther 2008, chapter 3). A root found in plain numbers is differentiated by one Newton step in
// these: its value stays, its rates become those of the implicit function.
#pragma once

#include <array>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

template <int n>
struct dual {
  double value = 0;
  std::array<double, n> rate{};

  constexpr dual() = default;
  constexpr dual(double v) : value(v) {}  // a constant

  dual &operator+=(const dual &b) {
    value += b.value;
    for (size_t k = 0; k < n; ++k) rate[k] += b.rate[k];
    return *this;
  }
  dual &operator-=(const dual &b) {
    value -= b.value;
    for (size_t k = 0; k < n; ++k) rate[k] -= b.rate[k];
    return *this;
  }
  dual &operator*=(const dual &b) { return *this = *this * b; }
  dual &operator/=(const dual &b) { return *this = *this / b; }

  friend dual operator+(dual a, const dual &b) { return a += b; }
  friend dual operator-(dual a, const dual &b) { return a -= b; }
  friend dual operator-(const dual &a) { return a.through(-a.value, -1.0); }
  friend dual operator*(const dual &a, const dual &b) {
    dual out(a.value * b.value);
    for (size_t k = 0; k < n; ++k) out.rate[k] = a.rate[k] * b.value + a.value * b.rate[k];
    return out;
  }
  friend dual operator/(const dual &a, const dual &b) {
    dual out(a.value / b.value);
    for (size_t k = 0; k < n; ++k) out.rate[k] = (a.rate[k] - out.value * b.rate[k]) / b.value;
    return out;
  }
  friend bool operator<(const dual &a, const dual &b) { return a.value < b.value; }
  friend bool operator>(const dual &a, const dual &b) { return a.value > b.value; }
  friend bool operator<=(const dual &a, const dual &b) { return a.value <= b.value; }
  friend bool operator>=(const dual &a, const dual &b) { return a.value >= b.value; }

  // f of this number, from f and its slope at the value
  dual through(double f, double slope) const {
    dual out(f);
    for (size_t k = 0; k < n; ++k) out.rate[k] = slope * rate[k];
    return out;
  }
};

template <int n>
dual<n> sqrt(const dual<n> &a) {
  const double root = std::sqrt(a.value);
  return a.through(root, root > 0 ? 0.5 / root : 0.0);
}
template <int n>
dual<n> sin(const dual<n> &a) {
  return a.through(sin(a.value), cos(a.value));
}
template <int n>
dual<n> cos(const dual<n> &a) {
  return a.through(cos(a.value), -sin(a.value));
}
template <int n>
dual<n> log(const dual<n> &a) {
  return a.through(log(a.value), 1.0 / a.value);
}
template <int n>
dual<n> fabs(const dual<n> &a) {
  return a.through(std::fabs(a.value), a.value < 0 ? -1.0 : 1.0);
}
template <int n>
dual<n> atan2(const dual<n> &y, const dual<n> &x) {
  const double square = x.value * x.value + y.value * y.value;
  dual<n> out(atan2(y.value, x.value));
  for (size_t k = 0; k < n; ++k) out.rate[k] = (x.value * y.rate[k] - y.value * x.rate[k]) / square;
  return out;
}
template <int n>
dual<n> hypot(const dual<n> &a, const dual<n> &b) {
  const double length = hypot(a.value, b.value);
  dual<n> out(length);
  if (!(length > 0)) return out;
  for (size_t k = 0; k < n; ++k) out.rate[k] = (a.value * a.rate[k] + b.value * b.rate[k]) / length;
  return out;
}
template <int n>
dual<n> pow(const dual<n> &a, double exponent) {
  const double slope = a.value != 0 ? exponent * pow(a.value, exponent - 1) : 0.0;
  return a.through(pow(a.value, exponent), slope);
}

inline double value_of(double a) { return a; }
template <int n>
double value_of(const dual<n> &a) {
  return a.value;
}

// A number with its rate along one direction.
using directed = dual<1>;
inline directed directed_of(double value, double rate) {
  directed a(value);
  a.rate[0] = rate;
  return a;
}

}  // namespace railpatch
