#include "wheel/moment_balance.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

namespace {

// of differences, in parts of the limit
constexpr double difference = 0.02;
constexpr int most_evaluations = 60, most_halvings = 5;

struct point {
  balance_pair at{}, f{};
  double merit = 0;
};

class newton {
 public:
  newton(balanced_wheelset &wheelset, const balance_search &search)
      : wheelset_(wheelset),
        search_(search),
        count_(static_cast<size_t>(search.count)),
        limit_(search.limit) {}

  balance_outcome run();

 private:
  bool evaluate(const balance_pair &at, point &out);
  bool find_slopes(const point &base);
  bool find_differences(const point &base);
  bool step(const point &base, balance_pair &d) const;
  void learn(const point &base, const point &next);
  bool advance(point &base);
  bool come_back(point &base);

  balanced_wheelset &wheelset_;
  const balance_search &search_;
  size_t count_;
  balance_pair limit_;
  balance_slope slope_{};
  int evaluations_ = 0;
  bool exact_ = false, known_ = false;  // slopes: from the contacts; any at all
  bool there_ = false;                  // the state solved last is the base
};

bool newton::evaluate(const balance_pair &at, point &out) {
  ++evaluations_;
  out.at = at;
  there_ = false;
  if (!wheelset_.evaluate(at, out.f)) return false;
  out.merit = 0;
  for (size_t k = 0; k < count_; ++k) {
    if (!std::isfinite(out.f[k])) return false;
    out.merit = std::max(out.merit, std::abs(out.f[k]));
  }
  return true;
}

// What is reported is what the contacts were solved with last.
bool newton::come_back(point &base) {
  const bool solved = there_ || evaluate(base.at, base);
  there_ = true;
  return solved;
}

bool newton::find_slopes(const point &base) {
  exact_ = there_ && wheelset_.slopes(slope_);
  known_ = exact_ || find_differences(base);
  return known_;
}

bool newton::find_differences(const point &base) {
  for (size_t j = 0; j < count_; ++j) {
    point beside;
    bool solved = false;
    double d = difference * search_.limit[j];
    for (int side = 0; side < 2 && !solved; ++side, d = -d) {
      balance_pair at = base.at;
      at[j] += d;
      solved = evaluate(at, beside);
      if (!solved) continue;
      for (size_t i = 0; i < count_; ++i) slope_[i][j] = (beside.f[i] - base.f[i]) / d;
    }
    if (!solved) return false;
  }
  return true;
}

// Newton's step, shortened to the limits; returns whether it is whole.
bool newton::step(const point &base, balance_pair &d) const {
  const balance_slope &s = slope_;
  if (count_ == 1) {
    d[0] = -base.f[0] / s[0][0];
  } else {
    const double det = s[0][0] * s[1][1] - s[0][1] * s[1][0];
    d[0] = (s[0][1] * base.f[1] - s[1][1] * base.f[0]) / det;
    d[1] = (s[1][0] * base.f[0] - s[0][0] * base.f[1]) / det;
  }
  bool whole = true;
  for (size_t k = 0; k < count_; ++k) {
    if (s[k][k] < 0 && std::abs(d[k]) <= limit_[k]) continue;
    d[k] = base.f[k] != 0 ? std::copysign(limit_[k], base.f[k]) : 0.0;
    whole = false;
  }
  return whole;
}

// Broyden's rule, with the unknowns in parts of their limits.
void newton::learn(const point &base, const point &next) {
  if (exact_) return;
  double length = 0;
  balance_pair d{};
  for (size_t k = 0; k < count_; ++k) {
    d[k] = (next.at[k] - base.at[k]) / search_.limit[k];
    length += d[k] * d[k];
  }
  if (!(length > 0)) return;
  for (size_t i = 0; i < count_; ++i) {
    double missed = next.f[i] - base.f[i];
    for (size_t k = 0; k < count_; ++k) missed -= slope_[i][k] * d[k] * search_.limit[k];
    for (size_t k = 0; k < count_; ++k) slope_[i][k] += missed * d[k] / (length * search_.limit[k]);
  }
}

// One step; false: no way on.
bool newton::advance(point &base) {
  balance_pair d{};
  const bool whole = step(base, d);
  for (int halving = 0; halving <= most_halvings && evaluations_ < most_evaluations; ++halving) {
    balance_pair at = base.at;
    for (size_t k = 0; k < count_; ++k) at[k] += d[k];
    point next;
    const bool solved = evaluate(at, next);
    if (solved) {
      learn(base, next);
      if (!whole || next.merit < base.merit) {
        for (size_t k = 0; k < count_ && !whole; ++k)
          if (std::abs(d[k]) >= limit_[k] && base.f[k] * next.f[k] < 0) limit_[k] *= 0.5;
        base = next;
        there_ = true;
        return true;
      }
    }
    for (size_t k = 0; k < count_; ++k) d[k] *= 0.5;
  }
  return false;
}

balance_outcome newton::run() {
  point base;
  balance_outcome out;
  out.unknown = search_.start;
  if (!evaluate(search_.start, base)) return out;
  there_ = true;
  out.known = true;
  int failed = 0;
  while (base.merit > search_.goal && evaluations_ < most_evaluations && failed < 2) {
    const bool renew = exact_ || !known_ || failed > 0;
    if (renew && !(exact_ ? come_back(base) && find_slopes(base) : find_slopes(base))) break;
    if (base.merit <= search_.goal) break;
    failed = advance(base) ? 0 : failed + 1;
    // exact slopes at the same state are the same
    if (failed > 0 && exact_) break;
  }
  come_back(base);
  out.unknown = base.at;
  out.residual = base.merit;
  out.converged = base.merit <= search_.tolerance;
  return out;
}

}  // namespace

balance_outcome find_balance(balanced_wheelset &wheelset, const balance_search &search) {
  return newton(wheelset, search).run();
}

}  // namespace railpatch
