// The class railpatch._core.Support: see wheelset_demo/vehicle/support.py.

#include <algorithm>
#include <cmath>
#include <vector>

#include "convert.hpp"
#include "vehicle.hpp"

namespace railpatch::python {

namespace {

enum { kRails = 4, kRailRow = 12, kWays = 2, kParts = 3 };
// of a wheel's row
enum { kFy = 1 };

using Writable = nb::ndarray<double, nb::c_contig, nb::device::cpu>;

class Support final : public VehicleSupport {
 public:
  Support(size_t wheelsets, const Grid &rows, const Values &stiffness, const Values &damping,
          const Values &masses)
      : count_(wheelsets), width_(masses.shape(0)), rows_(rows.shape(0)) {
    const bool fits = rows.shape(1) == width_ && stiffness.shape(0) == rows_ &&
                      damping.shape(0) == rows_ && width_ >= kRails && rows_ >= kRails;
    if (!fits) throw nb::value_error("arrays of a support do not fit together");
    by_place_.assign(rows.data(), rows.data() + rows_ * width_);
    stiffness_.assign(stiffness.data(), stiffness.data() + rows_);
    damping_.assign(damping.data(), damping.data() + rows_);
    masses_.assign(masses.data(), masses.data() + width_);
    place_.resize(count());
    rate_.resize(count());
    forces_.resize(count_ * rows_);
    greatest_.resize(kParts * kWays);
    for (auto *to : {&by_places_, &by_rates_}) {
      to->resize(width_ * width_);
      const std::vector<double> &factor = to == &by_places_ ? stiffness_ : damping_;
      for (size_t i = 0; i < width_; ++i)
        for (size_t j = 0; j < width_; ++j) {
          double sum = 0;
          for (size_t r = 0; r < rows_; ++r) sum += part(r, i) * factor[r] * part(r, j);
          (*to)[i * width_ + j] = -sum / masses_[i];
        }
    }
  }

  void put_rails(const double *place, const double *rate, double *rails) override {
    std::copy_n(place, count(), place_.data());
    std::copy_n(rate, count(), rate_.data());
    for (size_t k = 0; k < count_; ++k)
      for (size_t side = 0; side < 2; ++side) {
        const double *moved = place + k * width_ + 2 * side, *moving = rate + k * width_ + 2 * side;
        double *to = rails + k * kRailRow + 3 * side;
        to[1] += moved[0];
        to[2] += moved[1];
        // nothing else moves a rail sideways
        to[7] = moving[0];
        to[8] += moving[1];
      }
  }

  double find_rates(const double *wheels, size_t row, double *found) override {
    damping_power_ = 0;
    double power = 0;
    for (size_t k = 0; k < count_; ++k) {
      const double *place = place_.data() + k * width_, *rate = rate_.data() + k * width_;
      double *sum = found + k * width_, *forces = forces_.data() + k * rows_;
      std::fill_n(sum, width_, 0.0);
      for (size_t side = 0; side < 2; ++side)
        for (size_t i = 0; i < kWays; ++i) {
          const double on_rail = -wheels[(2 * k + side) * row + kFy + i];
          sum[2 * side + i] = on_rail;
          power += on_rail * rate[2 * side + i];
        }
      for (size_t r = 0; r < rows_; ++r) {
        double length = 0, lengthens = 0;
        for (size_t i = 0; i < width_; ++i) {
          length += part(r, i) * place[i];
          lengthens += part(r, i) * rate[i];
        }
        const double damped = damping_[r] * lengthens;
        damping_power_ += damped * lengthens;
        forces[r] = stiffness_[r] * length + damped;
        for (size_t i = 0; i < width_; ++i) sum[i] -= part(r, i) * forces[r];
      }
      for (size_t i = 0; i < width_; ++i) sum[i] /= masses_[i];
    }
    return power;
  }

  // by size, of rails' places, of forces in pads and in ballast, lateral and vertical
  void meet() override {
    for (size_t k = 0; k < count_; ++k) {
      for (size_t i = 0; i < kRails; ++i) raise(0, i, place_[k * width_ + i]);
      for (size_t r = 0; r < rows_; ++r) raise(r < kRails ? 1 : 2, r, forces_[k * rows_ + r]);
    }
  }

  void put(const Values &place, const Values &rate, Writable rails) {
    if (place.shape(0) != count() || rate.shape(0) != count() || rails.size() != count_ * kRailRow)
      throw nb::value_error("a state or rails of another size");
    put_rails(place.data(), rate.data(), rails.data());
  }

  double step(const Cube &wheels, Writable found) {
    if (wheels.shape(0) != count_ || wheels.shape(1) != 2 || wheels.shape(2) < 3 ||
        found.size() != count())
      throw nb::value_error("wheels or rates of another size");
    return find_rates(wheels.data(), wheels.shape(2), found.data());
  }

  double damping_power() const override { return damping_power_; }
  double rail_mass() const override { return masses_[0]; }
  size_t width() const override { return width_; }
  size_t count() const override { return count_ * width_; }
  const double *by_places() const override { return by_places_.data(); }
  const double *by_rates() const override { return by_rates_.data(); }
  size_t wheelsets() const { return count_; }
  size_t rows() const { return rows_; }
  double *place() { return place_.data(); }
  double *rate() { return rate_.data(); }
  double *forces() { return forces_.data(); }
  double *greatest() { return greatest_.data(); }

  enum { kGreatest = kParts, kDirections = kWays };

 private:
  double part(size_t r, size_t i) const { return by_place_[r * width_ + i]; }

  void raise(size_t which, size_t way, double value) {
    double &most = greatest_[which * kWays + way % kWays];
    most = std::max(most, std::abs(value));
  }

  size_t count_, width_, rows_;
  std::vector<double> by_place_, stiffness_, damping_, masses_, by_places_, by_rates_;
  std::vector<double> place_, rate_, forces_, greatest_;
  double damping_power_ = 0;
};

using Array = nb::ndarray<nb::numpy, double, nb::ndim<2>>;

template <double *(Support::*Data)(), size_t (Support::*Columns)() const>
Array view(nb::handle_t<Support> self) {
  Support &found = nb::cast<Support &>(self);
  return Array((found.*Data)(), {found.wheelsets(), (found.*Columns)()}, self);
}

Array greatest_of(nb::handle_t<Support> self) {
  return Array(nb::cast<Support &>(self).greatest(), {Support::kGreatest, Support::kDirections},
               self);
}

}  // namespace

void bind_support(nb::module_ &m) {
  using S = Support;
  nb::class_<VehicleSupport>(m, "VehicleSupport", "What a vehicle's steps ask of one.");
  nb::class_<S, VehicleSupport>(m, "Support", "Track below the rails, under each wheelset.")
      .def(nb::init<size_t, const Grid &, const Values &, const Values &, const Values &>(),
           nb::arg("wheelsets"), nb::arg("rows"), nb::arg("stiffness"), nb::arg("damping"),
           nb::arg("masses"),
           "rows: [rows, width], of the springs' lengths by the coordinates of one wheelset, rails "
           "first; stiffness, damping: of the rows, N/m, N s/m; masses: kg, kg m^2, of the "
           "coordinates.")
      .def("put_rails", &S::put, nb::arg("place"), nb::arg("rate"), nb::arg("rails"),
           "Adds to a force element's rails, which are placed.")
      .def("step", &S::step, nb::arg("wheels"), nb::arg("found"),
           "Fills the arrays and `found`, second derivatives of the coordinates; W, power of the "
           "wheels on the rails.")
      .def("meet", &S::meet, "Takes the last step() into 'greatest'.")
      .def_prop_ro("damping_power", &S::damping_power, "W, of the last step().")
      .def_prop_ro("place", &view<&S::place, &S::width>, "m, rad, of the last put_rails().")
      .def_prop_ro("rate", &view<&S::rate, &S::width>, "m/s, rad/s, likewise.")
      .def_prop_ro("forces", &view<&S::forces, &S::rows>, "N, of springs and dampers.")
      .def_prop_ro("greatest", &greatest_of, "m, N: rails' places, pads, ballast.");
}

}  // namespace railpatch::python
