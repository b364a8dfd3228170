// The class railpatch._core.WetRails: see wheelset_demo/vehicle/wet_track.py.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "convert.hpp"
#include "vehicle.hpp"

namespace railpatch::python {

namespace {

enum { kWater = 3 };  // numbers of a wheelset: supply, work on the left and on the right rail

using Writable = nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

class WetRails final : public VehicleWetRails {
 public:
  // cells: none where rails are not cleaned
  WetRails(size_t wheelsets, const Values &borders, const Values &supplies, double cell,
           size_t cells)
      : borders_(borders.data(), borders.data() + borders.shape(0)),
        supplies_(supplies.data(), supplies.data() + supplies.shape(0)),
        cell_(cell),
        cells_(cells) {
    if (supplies_.size() != borders_.size() + 1 || !(cell > 0))
      throw nb::value_error("a supply more than borders");
    work_.resize(2 * cells);
    own_.resize(2 * wheelsets);
    at_.assign(wheelsets, std::numeric_limits<double>::quiet_NaN());
  }

  void begin(const Values &positions) {
    if (positions.shape(0) != count()) throw nb::value_error("a position a wheelset");
    std::copy_n(positions.data(), count(), at_.data());
  }

  void put(const double *positions, double *water) const override {
    for (size_t k = 0; k < count(); ++k) {
      double *to = water + kWater * k;
      if (!borders_.empty()) {
        const auto next = std::upper_bound(borders_.begin(), borders_.end(), positions[k]);
        to[0] = supplies_[static_cast<size_t>(next - borders_.begin())];
      }
      if (cells_ == 0) continue;
      const size_t cell = cell_at(positions[k]);
      // in free rolling the work of a step can be less than nothing by its rounding
      for (size_t side = 0; side < 2; ++side)
        to[1 + side] = std::max(work_[side * cells_ + cell], 0.0);
    }
  }

  void leave(const double *positions, const double *work) override {
    if (cells_ == 0) return;
    for (size_t k = 0; k < count(); ++k) {
      const double way = positions[k] - at_[k];
      if (way > 0)
        for (size_t side = 0; side < 2; ++side)
          spend(2 * k + side, at_[k], positions[k], work[2 * k + side] / way);
      at_[k] = positions[k];
    }
  }

  void put_into(const Values &positions, Writable water) const {
    if (positions.shape(0) != count() || water.shape(0) != count() || water.shape(1) != kWater)
      throw nb::value_error("a position and three numbers a wheelset");
    put(positions.data(), water.data());
  }

  void leave_at(const Values &positions, const Grid &work) {
    if (positions.shape(0) != count() || work.shape(0) != count() || work.shape(1) != 2)
      throw nb::value_error("a position and two works a wheelset");
    leave(positions.data(), work.data());
  }

  size_t count() const { return at_.size(); }
  size_t cells() const { return cells_; }
  double *work() { return work_.data(); }
  double *own() { return own_.data(); }

 private:
  size_t cell_at(double position) const {
    const double found = std::floor(position / cell_);
    if (!(found > 0)) return 0;
    return static_cast<size_t>(std::min(found, static_cast<double>(cells_ - 1)));
  }

  // J/m of a wheel, over a part of its rail; a cell's comes into it when the wheel has left it
  void spend(size_t wheel, double begin, double end, double per_metre) {
    double *cells = work_.data() + wheel % 2 * cells_;
    size_t cell = cell_at(begin);
    for (const size_t last = cell_at(end); cell < last; ++cell) {
      const double border = static_cast<double>(cell + 1) * cell_;
      cells[cell] += (own_[wheel] + per_metre * (border - begin)) / cell_;
      own_[wheel] = 0.0;
      begin = border;
    }
    own_[wheel] += per_metre * (end - begin);
  }

  std::vector<double> borders_, supplies_;
  double cell_;  // m
  size_t cells_;
  // J/m, on left and right rail; J, of the cells that wheels are in; m
  std::vector<double> work_, own_, at_;
};

using Array = nb::ndarray<nb::numpy, double, nb::ndim<2>>;

}  // namespace

void bind_wet_rails(nb::module_ &m) {
  using W = WetRails;
  nb::class_<VehicleWetRails>(m, "VehicleWetRails", "What a vehicle's steps ask of them.");
  nb::class_<W, VehicleWetRails>(m, "WetRails", "Supply of liquid and work along the rails.")
      .def(nb::init<size_t, const Values &, const Values &, double, size_t>(), nb::arg("wheelsets"),
           nb::arg("borders"), nb::arg("supplies"), nb::arg("cell"), nb::arg("cells"),
           "borders: m, where the supply changes; supplies: m^3/s, before, between and after "
           "them, NaN: as the case says; cell: m, of a rail; cells: 0 where none are kept.")
      .def("begin", &W::begin, nb::arg("positions"), "The wheelsets stand there (m).")
      .def("put", &W::put_into, nb::arg("positions"), nb::arg("water"),
           "Writes a force element's array of water.")
      .def("leave", &W::leave_at, nb::arg("positions"), nb::arg("work"),
           "After a step to the positions (m): friction's work in it, J, by left and right wheel.")
      .def_prop_ro(
          "work",
          [](nb::handle_t<W> self) {
            W &found = nb::cast<W &>(self);
            return Array(found.work(), {2, found.cells()}, self);
          },
          "J/m, on left and right rail.")
      .def_prop_ro(
          "own",
          [](nb::handle_t<W> self) {
            W &found = nb::cast<W &>(self);
            return Array(found.own(), {found.count(), 2}, self);
          },
          "J, of the cells that wheels are in.");
}

}  // namespace railpatch::python
