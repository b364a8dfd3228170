// Restarted GMRES with right preconditioning (Saad and Schultz 1986); all memory made at creation.
#pragma once

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/memory.hpp"
#include "numeric/sums.hpp"

namespace railpatch {

class gmres {
 public:
  gmres(int max_size, int krylov) : krylov_(krylov), max_size_(static_cast<size_t>(max_size)) {
    basis_ = aligned_buffer<double>::uninitialized(max_size_ * static_cast<size_t>(krylov + 1));
    work_ = aligned_buffer<double>(max_size_);
    hessenberg_ = aligned_buffer<double>(static_cast<size_t>((krylov + 1) * krylov));
    for (auto *b : {&cosine_, &sine_, &right_})
      *b = aligned_buffer<double>(static_cast<size_t>(krylov + 1));
  }

  struct outcome {
    int products = 0;
    double residual = 0;  // relative to the right-hand side
  };

  // Solves J x = b to the relative tolerance; x starts at zero. apply(v, out): out = J v;
  // precondition(v): v <- M^-1 v.
  template <class Apply, class Precondition>
  outcome solve(size_t n, const double *b, double *x, double tolerance, int max_products,
                Apply &&apply, Precondition &&precondition) {
    outcome result;
    std::fill_n(x, n, 0.0);
    const double size = norm(b, n);
    if (size == 0) return result;
    result.residual = 1.0;
    bool first = true;
    while (result.products < max_products && result.residual > tolerance) {
      double *v0 = basis(0);
      if (first) {
        std::copy_n(b, n, v0);
      } else {
        apply(x, v0);
        ++result.products;
        for (size_t i = 0; i < n; ++i) v0[i] = b[i] - v0[i];
      }
      first = false;
      const double beta = norm(v0, n);
      if (!(beta > 0)) break;
      for (size_t i = 0; i < n; ++i) v0[i] /= beta;
      std::fill_n(right_.data(), krylov_ + 1, 0.0);
      right_[0] = beta;
      const int steps = arnoldi(n, size, tolerance, max_products, result, apply, precondition);
      if (steps == 0) break;
      update(n, steps, x, precondition);
    }
    return result;
  }

  size_t bytes() const {
    return basis_.bytes() + work_.bytes() + hessenberg_.bytes() + cosine_.bytes() + sine_.bytes() +
           right_.bytes();
  }

 private:
  template <class Apply, class Precondition>
  int arnoldi(size_t n, double size, double tolerance, int max_products, outcome &result,
              Apply &&apply, Precondition &&precondition) {
    int k = 0;
    while (k < krylov_ && result.products < max_products) {
      std::copy_n(basis(k), n, work_.data());
      precondition(work_.data());
      double *v = basis(k + 1);
      apply(work_.data(), v);
      ++result.products;
      double *h = hessenberg_.data() + k * (krylov_ + 1);
      for (int i = 0; i <= k; ++i) {
        const double *e = basis(i);
        h[i] = dot(e, v, n);
        for (size_t m = 0; m < n; ++m) v[m] -= h[i] * e[m];
      }
      h[k + 1] = norm(v, n);
      const bool breakdown = !(h[k + 1] > 0);
      if (!breakdown)
        for (size_t m = 0; m < n; ++m) v[m] /= h[k + 1];
      rotate(h, k);
      ++k;
      result.residual = std::abs(right_[static_cast<size_t>(k)]) / size;
      if (result.residual <= tolerance || breakdown) break;
    }
    return k;
  }

  // Givens rotations keep the least-squares problem triangular.
  void rotate(double *h, int k) {
    for (int i = 0; i < k; ++i) {
      const auto at = static_cast<size_t>(i);
      const double t = cosine_[at] * h[i] + sine_[at] * h[i + 1];
      h[i + 1] = -sine_[at] * h[i] + cosine_[at] * h[i + 1];
      h[i] = t;
    }
    const auto at = static_cast<size_t>(k);
    const double r = hypot(h[k], h[k + 1]);
    cosine_[at] = r > 0 ? h[k] / r : 1.0;
    sine_[at] = r > 0 ? h[k + 1] / r : 0.0;
    h[k] = r;
    right_[at + 1] = -sine_[at] * right_[at];
    right_[at] *= cosine_[at];
  }

  template <class Precondition>
  void update(size_t n, int steps, double *x, Precondition &&precondition) {
    for (int i = steps - 1; i >= 0; --i) {
      double &y = right_[static_cast<size_t>(i)];
      for (int j = i + 1; j < steps; ++j)
        y -= hessenberg_[static_cast<size_t>(j * (krylov_ + 1) + i)] *
             right_[static_cast<size_t>(j)];
      const double pivot = hessenberg_[static_cast<size_t>(i * (krylov_ + 1) + i)];
      y = pivot != 0 ? y / pivot : 0.0;
    }
    std::fill_n(work_.data(), n, 0.0);
    for (int i = 0; i < steps; ++i) {
      const double *e = basis(i);
      const double y = right_[static_cast<size_t>(i)];
      for (size_t m = 0; m < n; ++m) work_[m] += y * e[m];
    }
    precondition(work_.data());
    for (size_t m = 0; m < n; ++m) x[m] += work_[m];
  }

  static double norm(const double *v, size_t n) { return std::sqrt(dot(v, v, n)); }
  double *basis(int k) { return basis_.data() + static_cast<size_t>(k) * max_size_; }

  int krylov_;
  size_t max_size_;
  aligned_buffer<double> basis_, work_, hessenberg_, cosine_, sine_, right_;
};

}  // namespace railpatch
