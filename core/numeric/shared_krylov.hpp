// Linear systems with one matrix and several right sides: generalised conjugate residuals
// (Eisenstat, Elman and Schultz 1983) in one space of search directions that all right sides share.
//
// Each step takes the preconditioned residual of the right side that is worst off as a direction z,
// makes w = J z orthonormal to those before and takes from every residual its part along w. So a
// right side that resembles another one finds most of its solution there. The directions are not
// made to follow w: with J Z = W R the solutions come at the end from the triangular R.
//
// Products need not be exact once the residual is small: a relative error e in w leaves e times the
// residual behind (van den Eshof and Sleijpen 2004). What is reported is formed afresh by exact
// products.
#pragma once

#include <algorithm>
#include <cmath>

#include "numeric/memory.hpp"
#include "numeric/sums.hpp"

namespace railpatch {

class shared_krylov {
 public:
  shared_krylov(int max_size, int directions, int max_sides)
      : directions_(directions), max_sides_(max_sides) {
    const auto n = static_cast<size_t>(max_size), most = static_cast<size_t>(directions);
    // pages that no grid in use reaches are never touched
    z_ = aligned_buffer<double>::uninitialized(n * most);
    w_ = aligned_buffer<double>::uninitialized(n * most);
    residual_ = aligned_buffer<double>::uninitialized(n * static_cast<size_t>(max_sides));
    work_ = aligned_buffer<double>(n);
    sum_ = aligned_buffer<double>(n);
    triangle_ = aligned_buffer<double>(most * most);
    shares_ = aligned_buffer<double>(most * static_cast<size_t>(max_sides));
    size_ = aligned_buffer<double>(static_cast<size_t>(max_sides));
    left_ = aligned_buffer<double>(static_cast<size_t>(max_sides));
    part_ = aligned_buffer<double>(static_cast<size_t>(max_sides));
  }

  struct options {
    double tolerance;    // of each residual, relative to its right side
    double rounding;     // relative error of products that need not be exact
    int max_directions;  // in all
    bool each = true;    // every residual is formed afresh, else that of their sum where it will do
  };
  struct outcome {
    bool converged = false;
    double residual = 0;  // greatest, relative to its right side
    int exact = 0, inexact = 0;
  };

  // Solves J x = b for every right side; b and x hold one after the other, `stride` apart.
  // apply(z, w, exact, side): w = J z, side: of whose solution, -1: of none; precondition(v): v <-
  // about J^-1 v. The last call of a side is that of its solution as it is returned.
  template <class Apply, class Precondition>
  outcome solve(size_t n, int sides, size_t stride, const double *b, double *x, const options &o,
                Apply &&apply, Precondition &&precondition) {
    outcome out;
    n_ = n;
    sides_ = std::min(sides, max_sides_);
    for (int k = 0; k < sides_; ++k) {
      std::copy_n(b + at(k) * stride, n, residual(k));
      std::fill_n(x + at(k) * stride, n, 0.0);
      size_[at(k)] = std::sqrt(dot(residual(k), residual(k), n));
      left_[at(k)] = size_[at(k)] > 0 ? 1.0 : 0.0;
    }
    int made = 0;
    for (int round = 0; round < most_rounds; ++round) {
      int count = 0;
      // half of the tolerance is left to what inexact products did
      while (left_[at(worst())] > 0.5 * o.tolerance && count < directions_ &&
             made < o.max_directions && advance(worst(), count, o, out, apply, precondition)) {
        ++count;
        ++made;
      }
      add_solutions(count, stride, x);
      if (!o.each && sides_ > 1) {
        const double drift = measure_sum(stride, b, x, out, apply);
        out.residual = left_[at(worst())] + drift;
        out.converged = out.residual <= o.tolerance;
        if (out.converged) break;
      }
      for (int k = 0; k < sides_; ++k)
        if (size_[at(k)] > 0) measure(k, b + at(k) * stride, x + at(k) * stride, out, apply);
      out.residual = left_[at(worst())];
      out.converged = out.residual <= o.tolerance;
      if (out.converged || count == 0 || made >= o.max_directions) break;
    }
    return out;
  }

  size_t bytes() const {
    return z_.bytes() + w_.bytes() + residual_.bytes() + 2 * work_.bytes() + triangle_.bytes() +
           shares_.bytes() + 3 * size_.bytes();
  }

 private:
  static constexpr int most_rounds = 6;  // of directions, each with fresh residuals
  static size_t at(int k) { return static_cast<size_t>(k); }
  double *residual(int k) { return residual_.data() + at(k) * n_; }
  double *direction(int i) { return z_.data() + at(i) * n_; }
  double *image(int i) { return w_.data() + at(i) * n_; }
  // of R, column by column; of the residuals along the images, side by side
  double &triangle(int i, int j) { return triangle_[at(j * directions_ + i)]; }
  double &share(int i, int k) { return shares_[at(k * directions_ + i)]; }

  int worst() const {
    int k = 0;
    for (int i = 1; i < sides_; ++i)
      if (left_[at(i)] > left_[at(k)]) k = i;
    return k;
  }

  template <class Apply, class Precondition>
  bool advance(int k, int count, const options &o, outcome &out, Apply &&apply,
               Precondition &&precondition) {
    double *z = direction(count), *w = image(count);
    std::copy_n(residual(k), n_, z);
    precondition(z);
    const bool exact = o.rounding * left_[at(k)] > 0.1 * o.tolerance;
    apply(z, w, exact, -1);
    ++(exact ? out.exact : out.inexact);
    dots(w_.data(), n_, count, w, n_, &triangle(0, count));
    subtract(w_.data(), n_, count, &triangle(0, count), w, n_);
    const double length = std::sqrt(dot(w, w, n_));
    triangle(count, count) = length;
    if (!(length > 0)) return false;
    const double scale = 1.0 / length;
    for (size_t i = 0; i < n_; ++i) w[i] *= scale;
    dots(residual_.data(), n_, sides_, w, n_, part_.data());
    for (int side = 0; side < sides_; ++side) {
      share(count, side) = part_[at(side)];
      subtract(w, n_, 1, &part_[at(side)], residual(side), n_);
      const double left = std::sqrt(dot(residual(side), residual(side), n_));
      left_[at(side)] = size_[at(side)] > 0 ? left / size_[at(side)] : 0.0;
    }
    return true;
  }

  // The residual as it is.
  template <class Apply>
  void measure(int k, const double *b, const double *x, outcome &out, Apply &&apply) {
    apply(x, work_.data(), true, k);
    ++out.exact;
    double *r = residual(k);
    for (size_t i = 0; i < n_; ++i) r[i] = b[i] - work_[i];
    left_[at(k)] = std::sqrt(dot(r, r, n_)) / size_[at(k)];
  }

  // By how much the residual of the sum of all systems, each over its size, is not what the single
  // ones say: what inexact products did to all of them.
  template <class Apply>
  double measure_sum(size_t stride, const double *b, const double *x, outcome &out, Apply &&apply) {
    double *sum = work_.data(), *image = sum_.data();
    std::fill_n(sum, n_, 0.0);
    for (int k = 0; k < sides_; ++k)
      for (size_t i = 0; i < n_ && size_[at(k)] > 0; ++i)
        sum[i] += x[at(k) * stride + i] / size_[at(k)];
    apply(sum, image, true, -1);
    ++out.exact;
    for (int k = 0; k < sides_; ++k)
      for (size_t i = 0; i < n_ && size_[at(k)] > 0; ++i)
        image[i] -= (b[at(k) * stride + i] - residual(k)[i]) / size_[at(k)];
    return std::sqrt(dot(image, image, n_));
  }

  // x += Z R^-1 W^T b
  void add_solutions(int count, size_t stride, double *x) {
    for (int k = 0; k < sides_; ++k) {
      double *to = x + at(k) * stride;
      for (int i = count - 1; i >= 0; --i) {
        double y = share(i, k);
        // what is subtracted has the other sign
        for (int j = i + 1; j < count; ++j) y += triangle(i, j) * share(j, k);
        share(i, k) = -y / triangle(i, i);
      }
      subtract(z_.data(), n_, count, &share(0, k), to, n_);
    }
  }

  int directions_, max_sides_, sides_ = 0;
  size_t n_ = 0;
  aligned_buffer<double> z_, w_, residual_, work_, sum_, triangle_, shares_, size_, left_, part_;
};

}  // namespace railpatch
