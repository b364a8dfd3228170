#include "temperature/stage.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/nan.hpp"
#include "numeric/sums.hpp"

namespace railpatch {

heat_memory::heat_memory(int max_nx, int max_ny, const heat_scene &scene) {
  const auto n = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  for (auto &t : temperature) t = aligned_buffer<double>(n);
  if (scene.by_temperature) friction = aligned_buffer<double>(n);
  if (scene.transient)
    columns = aligned_buffer<double>(heat_columns::state_size(max_nx, max_ny, scene.exchanges));
}

void heat_memory::clear() {
  std::fill(columns.begin(), columns.end(), 0.0);
  forget_friction();
}

void heat_memory::forget_friction() { std::fill(friction.begin(), friction.end(), 0.0); }

temperature_stage::temperature_stage(const heat_scene &scene, int max_nx, int max_ny)
    : scene_(scene) {
  const auto n = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  const bool exchanges = scene.exchanges;
  if (scene.transient)
    columns_.emplace(max_nx, max_ny, exchanges);
  else
    steady_.emplace(max_nx, exchanges, scene.depth > 0);
  for (auto *b : {&flux_, &rise_}) *b = aligned_buffer<double>(n);
  if (exchanges && !scene.transient) exchanged_ = aligned_buffer<double>(n);
  if (!scene.by_temperature) return;
  background_ = aligned_buffer<double>(n);
  loop_.emplace(static_cast<int>(n));
}

size_t temperature_stage::bytes() const {
  return (steady_ ? steady_->bytes() : columns_->bytes()) + (loop_ ? loop_->bytes() : 0) +
         flux_.bytes() + rise_.bytes() + background_.bytes() + exchanged_.bytes();
}

const double *temperature_stage::exchanged() const {
  if (columns_) return columns_->exchanged();
  return exchanged_.size() ? exchanged_.data() : nullptr;
}

void temperature_stage::begin(const heat_rows &rows, double distance, const double *pressure,
                              heat_memory &memory) {
  rows_ = rows;
  if (columns_) {
    columns_->begin(rows, distance, pressure, memory.columns.data());
  } else {
    steady_->set(rows);
    if (exchanged_.size()) steady_->exchange(pressure, exchanged_.data());
  }
  std::fill_n(flux_.data(), count(), 0.0);
  if (!loop_) return;
  const double *e = exchanged();
  const double per_body = 1.0 / scene_.bodies.effusivity();
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    const double level = e ? e[i] : 0.0, rise = columns_ ? columns_->memory()[i] * per_body : 0.0;
    background_[at] =
        std::max(scene_.bodies.surface(0, level, rise), scene_.bodies.surface(1, level, rise));
    if (!(memory.friction[at] > 0)) memory.friction[at] = scene_.law.coefficient(background_[at]);
  }
}

void temperature_stage::heat(const double *friction, const double *plastic, double *q) const {
  friction_heat(count(), rows_.speed, friction, plastic, scene_.plastic_fraction, q);
}

double temperature_stage::finish(const double *pressure, heat_memory &memory) {
  if (columns_)
    columns_->rise(flux_.data(), rise_.data());
  else
    steady_->rise(flux_.data(), nullptr, rise_.data());
  const double per_body = 1.0 / scene_.bodies.effusivity();
  const double *e = exchanged();
  const bool touches = std::any_of(pressure, pressure + count(), [](double p) { return p > 0; });
  double greatest =
      touches ? -273.15 : std::max(scene_.bodies.body[0].bulk, scene_.bodies.body[1].bulk);
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < count(); ++i) {
      const auto at = static_cast<size_t>(i);
      const double t = scene_.bodies.surface(k, e ? e[i] : 0.0, rise_[at] * per_body);
      memory.temperature[k][at] = t;
      // written so that a temperature that is no number stays visible
      if (pressure[at] > 0 && !(t <= greatest)) greatest = t;
    }
  // no contact, no coefficient
  for (size_t at = 0; at < memory.friction.size() && at < static_cast<size_t>(count()); ++at)
    if (!(pressure[at] > 0)) memory.friction[at] = 0;
  if (columns_) columns_->commit(flux_.data(), pressure, memory.columns.data());
  for (int k = 0; k < 2 && scene_.depth > 0; ++k) {
    double *t = memory.temperature[k].data();
    if (columns_) {
      columns_->at_depth(scene_.bodies, k, scene_.depth, memory.columns.data(), rise_.data());
      columns_->to_centres(rise_.data(), scene_.bodies.body[k].bulk, t);
    } else {
      steady_->at_depth(scene_.bodies, k, scene_.depth, flux_.data(), pressure, t);
    }
  }
  return greatest;
}

double temperature_stage::heat_into(int body, double dy) const {
  const thermal_pair &pair = scene_.bodies;
  const double flux = total(flux_.data(), static_cast<size_t>(count())) * rows_.dx * dy;
  const double own = pair.share(body) * flux;
  if (!pair.exchanges()) return own;
  if (columns_) return nan;
  return own + exchange_conductance(dy) * (pair.body[1 - body].bulk - pair.body[body].bulk);
}

double temperature_stage::exchange_conductance(double dy) const {
  if (!steady_ || !exchanged_.size() || !(rows_.speed > 0)) return 0;
  const thermal_pair &pair = scene_.bodies;
  const double unit = std::sqrt(rows_.dx * rows_.speed);
  return pair.body[0].effusivity() * pair.share(1) * unit * steady_->exchanged_heat() * dy;
}

}  // namespace railpatch
