// The class railpatch._core.SlidingMeans: see wheelset_demo/vehicle/means.py.

#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "vehicle.hpp"

namespace railpatch::python {

namespace {

enum { kFy = 1, kFz = 2 };

class SlidingMeans final : public VehicleMeans {
 public:
  SlidingMeans(const Cube &wheels, double length, double least_load)
      : length_(length), least_load_(least_load), wheels_(wheels.shape(0) * wheels.shape(1)) {
    if (wheels.shape(0) == 0 || wheels.shape(1) != 2)
      throw nb::value_error("left and right wheels, one or more");
    for (auto *forces : {&forces_, &means_}) forces->resize(2 * wheels_);
    read(wheels.data(), wheels.shape(2), forces_);
    for (auto &one : extremes_) one.resize(wheels_);
    ways_.assign(kRoom, 0.0);
    integrals_.assign(kRoom * 2 * wheels_, 0.0);
    means_ = forces_;
    forget();
    meet();
  }

  void add(double way, const Cube &wheels) {
    if (wheels.shape(0) * wheels.shape(1) != wheels_) throw nb::value_error("other wheels");
    add_step(way, wheels.data(), wheels.shape(2));
  }

  void add_step(double way, const double *wheels, size_t row) override {
    before_ = forces_;
    read(wheels, row, forces_);
    if (!(way > 0)) return;
    append(way);
    const double now = ways_[place(count_ - 1)], begin = now - length_;
    while (count_ > 2 && ways_[place(1)] <= begin) {
      first_ = place(1);
      --count_;
    }
    const double first = ways_[place(0)], second = ways_[place(1)];
    // the way's begin lies between the first two
    const double share = std::max(0.0, (begin - first) / (second - first));
    if (begin >= 0 && !whole_) {
      whole_ = true;
      forget();
    }
    const double *low = integral(0), *high = integral(1), *last = integral(count_ - 1);
    const double run = now - std::max(begin, first);
    for (size_t i = 0; i < means_.size(); ++i)
      means_[i] = (last[i] - low[i] - share * (high[i] - low[i])) / run;
    meet();
  }

  double ratio() const { return ratio_; }
  double sum() const { return sum_; }
  std::pair<double, double> load_range() const { return {low_, high_}; }
  double *means() { return means_.data(); }
  size_t size() const { return means_.size(); }
  // by kExtremes; of a wheelset's two wheels the same sum
  const std::vector<double> &most(int which) const { return extremes_[which]; }

  enum { kRatio, kSum, kGuiding, kOutward, kLeastLoad, kMostLoad, kExtremes };

 private:
  // rows to begin with: more than a vehicle at speed needs
  static constexpr size_t kRoom = 256;

  // on the rails: outward of all wheels, then down
  void read(const double *wheels, size_t row, std::vector<double> &to) const {
    for (size_t k = 0; k < wheels_; ++k) {
      to[k] = (k % 2 == 0 ? 1.0 : -1.0) * wheels[k * row + kFy];
      to[wheels_ + k] = -wheels[k * row + kFz];
    }
  }

  size_t place(size_t k) const { return (first_ + k) % ways_.size(); }
  double *integral(size_t k) { return integrals_.data() + place(k) * means_.size(); }

  void append(double way) {
    if (count_ == ways_.size()) widen();
    ++count_;
    const double *last = integral(count_ - 2);
    double *next = integral(count_ - 1);
    ways_[place(count_ - 1)] = ways_[place(count_ - 2)] + way;
    for (size_t i = 0; i < means_.size(); ++i)
      next[i] = last[i] + 0.5 * way * (before_[i] + forces_[i]);
  }

  void widen() {
    const auto first = static_cast<std::ptrdiff_t>(first_);
    const auto each = static_cast<std::ptrdiff_t>(first_ * means_.size());
    std::rotate(ways_.begin(), ways_.begin() + first, ways_.end());
    std::rotate(integrals_.begin(), integrals_.begin() + each, integrals_.end());
    first_ = 0;
    ways_.resize(2 * ways_.size());
    integrals_.resize(2 * integrals_.size());
  }

  void forget() {
    ratio_ = -std::numeric_limits<double>::infinity();
    sum_ = 0;
    low_ = -ratio_;
    high_ = ratio_;
    for (int which = 0; which < kExtremes; ++which)
      extremes_[which].assign(wheels_, which == kLeastLoad ? low_ : high_);
  }

  void meet() {
    for (size_t k = 0; k < wheels_; ++k) {
      const double load = means_[wheels_ + k];
      if (load > least_load_) ratio_ = std::max(ratio_, means_[k] / load);
      low_ = std::min(low_, load);
      high_ = std::max(high_, load);
      double &least = extremes_[kLeastLoad][k];
      least = std::min(least, load);
      if (load > least_load_) raise(kRatio, k, means_[k] / load);
      raise(kMostLoad, k, load);
      raise(kGuiding, k, std::abs(means_[k]));
      raise(kOutward, k, means_[k]);
    }
    for (size_t k = 0; k < wheels_; k += 2) {
      const double both = std::abs(means_[k] - means_[k + 1]);
      sum_ = std::max(sum_, both);
      for (size_t i : {k, k + 1}) raise(kSum, i, both);
    }
  }

  void raise(int which, size_t k, double value) {
    double &most = extremes_[which][k];
    most = std::max(most, value);
  }

  double length_, least_load_;
  size_t wheels_, first_ = 0, count_ = 1;
  bool whole_ = false;
  double ratio_, sum_, low_, high_;
  // way (m), and integral of the forces over it (J), a ring
  std::vector<double> ways_, integrals_, forces_, before_, means_;
  std::array<std::vector<double>, kExtremes> extremes_;  // each of all wheels
};

nb::ndarray<nb::numpy, double, nb::ndim<1>> means_of(nb::handle_t<SlidingMeans> self) {
  SlidingMeans &found = nb::cast<SlidingMeans &>(self);
  return {found.means(), {found.size()}, self};
}

}  // namespace

void bind_means(nb::module_ &m) {
  using M = SlidingMeans;
  nb::class_<VehicleMeans>(m, "VehicleMeans", "What a vehicle's steps ask of means.");
  nb::class_<M, VehicleMeans>(m, "SlidingMeans",
                              "Means of a vehicle's wheel forces over its last way.")
      .def(nb::init<const Cube &, double, double>(), nb::arg("wheels"), nb::arg("length"),
           nb::arg("least_load"), "wheels: [wheelsets, 2, n], force first; length: m.")
      .def("add", &M::add, nb::arg("way"), nb::arg("wheels"), "The state after `way` m.")
      .def_prop_ro("ratio", &M::ratio)
      .def_prop_ro("sum", &M::sum)
      .def_prop_ro("load_range", &M::load_range)
      .def_prop_ro("most_ratios", [](const M &self) { return self.most(M::kRatio); })
      .def_prop_ro("most_sums", [](const M &self) { return self.most(M::kSum); })
      .def_prop_ro("most_guiding", [](const M &self) { return self.most(M::kGuiding); })
      .def_prop_ro("most_outward_guiding", [](const M &self) { return self.most(M::kOutward); })
      .def_prop_ro("least_loads", [](const M &self) { return self.most(M::kLeastLoad); })
      .def_prop_ro("most_loads", [](const M &self) { return self.most(M::kMostLoad); })
      .def_prop_ro("means", &means_of, "N, on the rails: outward, then down, of all wheels.");
}

}  // namespace railpatch::python
