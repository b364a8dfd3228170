// The class railpatch._core.Course: where a vehicle's wheelsets are on a bent, canted track with
// rails that are not straight. Formulas: wheelset_demo/vehicle, alignment.py, slope.py, system.py.

#include <algorithm>
#include <array>
#include <vector>

#include "convert.hpp"
#include "numeric/elementary.hpp"
#include "vehicle.hpp"

namespace railpatch::python {

namespace {

using Table = nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

enum { kTrack = 7, kRails = 8, kPlacement = 12, kRailRow = 12, kBends = 4, kNewtonSteps = 2 };
enum { kX, kY, kHeading, kCant };
enum { kLateral, kVertical };
enum { kCantAngle, kCurvature, kTwist, kTwistRate };  // of the bends

// a piecewise cubic polynomial of several columns, coefficients as scipy's
template <size_t Columns>
class Spline {
 public:
  Spline(const Values &knots, const Cube &coefficients)
      : knots_(knots.data(), knots.data() + knots.shape(0)),
        values_(coefficients.data(), coefficients.data() + coefficients.size()) {
    const bool fits =
        coefficients.shape(0) == kOrder && coefficients.shape(2) == Columns &&
        (knots_.empty() ? values_.empty()
                        : knots_.size() == coefficients.shape(1) + 1 && coefficients.shape(1) > 0);
    if (!fits) throw nb::value_error("knots and coefficients of a spline do not fit together");
  }

  bool empty() const { return knots_.empty(); }
  double first() const { return knots_.front(); }
  double last() const { return knots_.back(); }

  std::array<double, Columns> at(double s) const {
    const size_t pieces = knots_.size() - 1;
    const auto next = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, s);
    const auto piece = static_cast<size_t>(next - knots_.begin()) - 1;
    const double u = s - knots_[piece];
    std::array<double, Columns> found{};
    double power = 1.0;
    for (size_t k = kOrder; k-- > 0; power *= u) {
      const double *row = values_.data() + (k * pieces + piece) * Columns;
      for (size_t i = 0; i < Columns; ++i) found[i] += row[i] * power;
    }
    return found;
  }

 private:
  static constexpr size_t kOrder = 4;
  std::vector<double> knots_, values_;
};

struct Wheelset {
  size_t x, y;   // columns of its coordinates
  double speed;  // m/s, along the track
  std::array<double, kBends> bends;
};

class Course final : public VehicleCourse {
 public:
  Course(const Values &track_knots, const Cube &track, const Values &rail_knots, const Cube &rails,
         const IndexGrid &columns, double arm, size_t width)
      : track_(track_knots, track), rails_(rail_knots, rails), arm_(arm), width_(width) {
    if (columns.shape(1) != 2) throw nb::value_error("two columns a wheelset");
    for (size_t k = 0; k < columns.shape(0); ++k) {
      const auto x = static_cast<size_t>(columns(k, 0)), y = static_cast<size_t>(columns(k, 1));
      if (x >= width || y >= width) throw nb::index_error();
      wheelsets_.push_back({x, y, 0.0, {}});
    }
    positions_.resize(count());
    slopes_.resize(4 * count());
    for (auto *inputs : {&inputs_, &ahead_, &bend_}) inputs->resize(6 * count());
  }

  void place(const Values &q, const Values &v, Table tracks, Table rails) {
    check(q);
    check(v);
    if (tracks.shape(0) != count() || tracks.shape(1) != kPlacement || rails.shape(0) != count() ||
        rails.shape(1) != kRailRow)
      throw nb::value_error("one row of 12 a wheelset");
    place_all(q.data(), v.data(), tracks.data(), rails.data());
  }

  void place_all(const double *q, const double *v, double *tracks, double *rails) override {
    for (size_t k = 0; k < count(); ++k) {
      Wheelset &w = wheelsets_[k];
      w.speed = hypot(v[w.x], v[w.y]);
      positions_[k] = foot(q[w.x], q[w.y], positions_[k]);
      put_track(w, positions_[k], tracks + k * kPlacement);
      put_rails(k, rails + k * kRailRow);
    }
  }

  void look_ahead(const Values &v, double step) {
    check(v);
    look_ahead_all(v.data(), step);
  }

  void look_ahead_all(const double *v, double step) override {
    for (size_t k = 0; k < count(); ++k) {
      const Wheelset &w = wheelsets_[k];
      const double speed = hypot(v[w.x], v[w.y]), squared = (step * speed) * (step * speed);
      double slopes[4];
      deviations(k, positions_[k] + step * speed, speed, ahead_.data(), slopes);
      const double off = w.bends[kCurvature] * squared, cant = w.bends[kCantAngle];
      const double turned = arm_ * w.bends[kTwistRate] * squared;
      double *bend = bend_.data() + 4 * k;
      bend[kLateral] = bend[2 + kLateral] = off * cos(cant);
      const double down = -off * sin(cant);
      bend[kVertical] = down - turned;
      bend[2 + kVertical] = down + turned;
    }
  }

  double middle() const override {
    double sum = 0;
    for (const double s : positions_) sum += s;
    return sum / static_cast<double>(count());
  }
  bool level() const override {
    return std::all_of(slopes_.begin(), slopes_.end(), [](double s) { return s == 0; });
  }

  size_t count() const override { return wheelsets_.size(); }
  size_t width() const override { return width_; }
  size_t sloped() const { return 4 * count(); }
  size_t known() const { return 6 * count(); }
  double *positions() override { return positions_.data(); }
  double *slopes() override { return slopes_.data(); }
  double *inputs() override { return inputs_.data(); }
  double *ahead() override { return ahead_.data(); }
  double *bend() override { return bend_.data(); }

 private:
  void check(const Values &state) const {
    if (state.shape(0) != width_) throw nb::value_error("a state of another size");
  }

  double foot(double x, double y, double s) const {
    for (int step = 0; step < kNewtonSteps; ++step) {
      const auto found = track_.at(s);
      s = s + cos(found[kHeading]) * (x - found[kX]) + sin(found[kHeading]) * (y - found[kY]);
    }
    return s;
  }

  void put_track(Wheelset &w, double s, double *to) const {
    const auto found = track_.at(s);
    const double c = cos(found[kHeading]), t = sin(found[kHeading]);
    const double cc = cos(found[kCant]), sc = sin(found[kCant]);
    const double placement[kPlacement] = {c,   -t * cc, t * sc, t,         c * cc,    -c * sc,
                                          0.0, sc,      cc,     found[kX], found[kY], 0.0};
    std::copy_n(placement, kPlacement, to);
    std::copy_n(found.begin() + kCant, kBends, w.bends.begin());
  }

  // of the irregularities at s: a wheelset's places in the inputs, its slopes by side
  void deviations(size_t k, double s, double speed, double *inputs, double *slopes) const {
    std::fill_n(slopes, 4, 0.0);
    if (rails_.empty()) return;
    const double low = rails_.first(), high = rails_.last();
    const double inside = s < low ? low : s > high ? high : s;
    const auto found = rails_.at(inside);
    for (size_t i = 0; i < 4; ++i) {
      inputs[4 * k + i] = found[i];
      slopes[i] = found[4 + i] * (inside == s ? 1.0 : 0.0);
    }
    for (size_t side = 0; side < 2; ++side)
      inputs[4 * count() + 2 * k + side] = speed * slopes[2 * side + kVertical];
  }

  void put_rails(size_t k, double *to) {
    const Wheelset &w = wheelsets_[k];
    double *slopes = slopes_.data() + 4 * k;
    deviations(k, positions_[k], w.speed, inputs_.data(), slopes);
    // a change of cant lifts the one rail and lowers the other
    const double twist = arm_ * w.bends[kTwist];
    slopes[kVertical] -= twist;
    slopes[2 + kVertical] += twist;
    for (size_t side = 0; side < 2; ++side) {
      to[3 * side + 1] = inputs_[4 * k + 2 * side + kLateral];
      to[3 * side + 2] = inputs_[4 * k + 2 * side + kVertical];
      to[6 + 3 * side + 2] = w.speed * slopes[2 * side + kVertical];
    }
  }

  Spline<kTrack> track_;
  Spline<kRails> rails_;
  double arm_;
  size_t width_;
  std::vector<Wheelset> wheelsets_;
  std::vector<double> positions_, slopes_, inputs_, ahead_, bend_;
};

// columns of a wheel's row: forces, moments
enum { kFy = 1, kFz = 2, kMx = 3 };

void slope_wrenches(const Cube &wheels, const Grid &normals, const Cube &slopes,
                    const Values &radii, double arm,
                    nb::ndarray<double, nb::ndim<3>, nb::c_contig, nb::device::cpu> to) {
  const size_t count = wheels.shape(0);
  const bool fits = wheels.shape(1) == 2 && wheels.shape(2) > kMx && normals.shape(0) == count &&
                    normals.shape(1) == 2 && slopes.shape(0) == count && slopes.shape(1) == 2 &&
                    slopes.shape(2) == 2 && radii.shape(0) == count && to.shape(0) == count &&
                    to.shape(1) == 2 && to.shape(2) == 3;
  if (!fits) throw nb::value_error("arrays of wheels do not fit together");
  for (size_t k = 0; k < count; ++k)
    for (size_t side = 0; side < 2; ++side)
      slope_wrench(&wheels(k, side, 0), normals(k, side), &slopes(k, side, 0), radii(k),
                   side == 0 ? -arm : arm, &to(k, side, 0));
}

template <double *(Course::*Data)(), size_t (Course::*Count)() const>
nb::ndarray<nb::numpy, double, nb::ndim<1>> view(nb::handle_t<Course> self) {
  Course &found = nb::cast<Course &>(self);
  return {(found.*Data)(), {(found.*Count)()}, self};
}

}  // namespace

void slope_wrench(const double *wheel, double normal, const double *slope, double radius,
                  double place, double *to) {
  const double across = wheel[kFy], down = wheel[kFz];
  const double lateral = slope[kLateral], vertical = slope[kVertical];
  to[0] = -(across * lateral + down * vertical);
  to[1] = -radius * (across - normal) * lateral;
  to[2] = wheel[kMx] * vertical + place * across * lateral;
}

void bind_course(nb::module_ &m) {
  using C = Course;
  nb::class_<VehicleCourse>(m, "VehicleCourse", "What a vehicle's steps ask of a course.");
  nb::class_<C, VehicleCourse>(m, "Course",
                               "Wheelsets of a vehicle on a bent track with rails not straight.")
      .def(nb::init<const Values &, const Cube &, const Values &, const Cube &, const IndexGrid &,
                    double, size_t>(),
           nb::arg("track_knots"), nb::arg("track"), nb::arg("rail_knots"), nb::arg("rails"),
           nb::arg("columns"), nb::arg("arm"), nb::arg("width"),
           "track: coefficients [4, pieces, 7] of x, y, heading, cant angle, curvature, first and "
           "second derivative of the cant angle; rails: [4, pieces, 8], of deviations and slopes, "
           "no knots: straight; columns: of each wheelset's x and y in a state of `width` numbers; "
           "arm: m, half the distance of the contacts.")
      .def("place", &C::place, nb::arg("q"), nb::arg("v"), nb::arg("tracks"), nb::arg("rails"),
           "Finds positions, track frames and rails and writes them into a force element's arrays.")
      .def("look_ahead", &C::look_ahead, nb::arg("v"), nb::arg("step"),
           "Fills 'ahead' and 'bend' for a step (s) on from the last place().")
      .def_prop_ro("positions", &view<&C::positions, &C::count>, "m, along the track.")
      .def_prop_ro("slopes", &view<&C::slopes, &C::sloped>,
                   "Of the rails, by wheelset, side, lateral and vertical.")
      .def_prop_ro("inputs", &view<&C::inputs, &C::known>,
                   "m, deviations, then m/s, their vertical rates.")
      .def_prop_ro("ahead", &view<&C::ahead, &C::known>, "As 'inputs'.")
      .def_prop_ro("bend", &view<&C::bend, &C::known>, "As 'inputs'.")
      .def_prop_ro("middle", &C::middle, "m, mean of the positions.")
      .def_prop_ro("level", &C::level, "Whether no rail has a slope.");
  m.def("slope_wrenches", &slope_wrenches, nb::arg("wheels"), nb::arg("normals"), nb::arg("slopes"),
        nb::arg("radii"), nb::arg("arm"), nb::arg("to"), "See wheelset_demo.vehicle.slope.");
}

}  // namespace railpatch::python
