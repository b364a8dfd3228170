#include "patch/coupled_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numeric/elementary.hpp"
#include "numeric/sums.hpp"

namespace railpatch {

namespace {

constexpr double least_share = 1.0 / 32;
constexpr double least_tolerance = 1e-12;  // that rounding allows to ask for

}  // namespace

coupled_contact::coupled_contact(std::unique_ptr<coupling_operator> coupling, int max_count,
                                 bool keeps_steps)
    : coupling_(std::move(coupling)), outer_(static_cast<size_t>(max_count)) {
  for (auto *b : {&distance_, &slip_[0], &slip_[1], &now_, &next_})
    *b = aligned_buffer<double>(static_cast<size_t>(max_count));
  if (keeps_steps) last_pressure_ = aligned_buffer<double>(static_cast<size_t>(max_count));
}

size_t coupled_contact::bytes() const {
  return coupling_->bytes() + outer_.bytes() + 5 * distance_.bytes() + last_pressure_.bytes();
}

void coupled_contact::begin(const grid &g, const double *distance, const double *px,
                            const double *py) {
  grid_ = g;
  undeformed_ = distance;
  rounds_ = 0;
  coupling_->set_grid(g);
  outer_.begin(static_cast<size_t>(g.count()));
  const auto loaded = [&](const double *p) {
    return std::any_of(p, p + g.count(), [](double v) { return v != 0; });
  };
  moved_ = loaded(px) || loaded(py);
  if (moved_)
    coupling_->from_traction(px, py, now_.data());
  else
    std::fill_n(now_.data(), g.count(), 0.0);
  set_distance();
}

bool coupled_contact::forget() {
  if (!moved_) return false;
  moved_ = false;
  outer_.begin(static_cast<size_t>(grid_.count()));
  std::fill_n(now_.data(), grid_.count(), 0.0);
  set_distance();
  return true;
}

void coupled_contact::set_distance() {
  for (int i = 0; i < grid_.count(); ++i) {
    const auto at = static_cast<size_t>(i);
    distance_[at] = undeformed_[i] + now_[at];
  }
}

void coupled_contact::remember(const grid &g, const double *pressure) {
  if (pressure)
    std::copy_n(pressure, g.count(), last_pressure_.data());
  else
    std::fill_n(last_pressure_.data(), g.count(), 0.0);
}

void coupled_contact::set_slip(const double *pressure, const rolling_input &rolling) {
  double *here[2] = {slip_[0].data(), slip_[1].data()};
  coupling_->from_pressure(0.0, pressure, here[0], here[1]);
  // distance_ is free until the next round
  const bool steady = rolling.regime == motion::steady;
  if (!steady && rolling.before[0]) {
    for (double *u : here)
      for (int i = 0; i < grid_.count(); ++i) u[i] /= rolling.distance;
    return;
  }
  const double upstream = steady ? rolling.direction * grid_.dx : rolling.upstream();
  const double way = rolling.regime == motion::shift ? 1.0 : std::abs(upstream);
  coupling_->from_pressure(upstream, steady ? pressure : last_pressure_.data(), next_.data(),
                           distance_.data());
  for (int i = 0; i < grid_.count(); ++i) {
    const auto at = static_cast<size_t>(i);
    here[0][i] = (here[0][i] - next_[at]) / way;
    here[1][i] = (here[1][i] - distance_[at]) / way;
  }
}

double coupled_contact::error(const double *pressure, const double *px, const double *py,
                              bool force_given) {
  coupling_->from_traction(px, py, next_.data());
  double mean = 0;
  int count = 0;
  for (int i = 0; force_given && i < grid_.count(); ++i) {
    if (!(pressure[i] > 0)) continue;
    mean += next_[static_cast<size_t>(i)] - now_[static_cast<size_t>(i)];
    ++count;
  }
  mean /= std::max(count, 1);
  double worst = 0;
  for (int i = 0; i < grid_.count(); ++i) {
    const auto at = static_cast<size_t>(i);
    const double change = std::abs(next_[at] - now_[at] - mean);
    // written so that a displacement that is no number stays visible
    if (!(change <= worst)) worst = change;
  }
  return scale_ > 0 ? worst / scale_ : worst == 0 ? 0.0 : 1.0;
}

double coupled_contact::tolerance(double whole) const {
  const double share = std::max(0.5 * pow(0.5, rounds_ / 4), least_share);
  return std::max(share * whole, std::min(whole, least_tolerance));
}

void coupled_contact::advance() {
  ++rounds_;
  outer_.advance(now_.data(), next_.data());
  moved_ = true;
  set_distance();
}

double coupled_contact::energy(const double *pressure) const {
  return dot(pressure, next_.data(), static_cast<size_t>(grid_.count())) * grid_.dx * grid_.dy;
}

}  // namespace railpatch
