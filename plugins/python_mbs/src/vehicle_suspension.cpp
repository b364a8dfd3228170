// The class railpatch._core.Suspension: see wheelset_demo/vehicle/suspension.py.

#include <algorithm>
#include <cmath>
#include <vector>

#include "convert.hpp"
#include "numeric/elementary.hpp"
#include "vehicle.hpp"

namespace railpatch::python {

namespace {

enum { kPlaces = 6 };  // of a body: x, y, z, yaw, roll, pitch

struct Point {
  double x, y, z;
};

Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point operator*(double s, Point a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point cross(Point a, Point b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Body {
  size_t columns[kPlaces];  // width of a state: the body does not have it
  double arm;               // m, of the centre, to the right of the joint
  Point origin, centre, ahead, axes[3];
};

struct Element {
  size_t a, b;
  Point at_a, at_b;  // m, in the bodies
  Point point_b, apart;
};

// points of a bump stop's table, displacements that increase
struct Stop {
  std::vector<double> d, force;

  Stop() = default;
  Stop(const Values &at, const Values &forces)
      : d(at.data(), at.data() + at.shape(0)),
        force(forces.data(), forces.data() + forces.shape(0)) {
    if (d.size() < 2 || d.size() != force.size()) throw nb::value_error("two points or more");
  }
};

struct Row {
  size_t element, axis;
  bool about;
  double stiffness, damping, preload;
  double sticking;  // N/m, N m/rad, of its slider's spring
  Stop stop;        // empty: none
};

// dry friction: a spring and a slider in series, whose limit is a force and a share of the load
// that another row carries
struct Friction {
  size_t row, load_row;
  double stiffness, limit, coefficient;
};

struct Series {
  size_t row;
  double stiffness, damping;
};

Point point_of(const Grid &rows, size_t k) {
  const double *from = rows.data() + 3 * k;
  return {from[0], from[1], from[2]};
}

// N/m, of the piece of its table; first: its first point
double piece_of(const Stop &stop, double d, size_t &first) {
  const auto next = std::upper_bound(stop.d.begin() + 1, stop.d.end() - 1, d);
  first = static_cast<size_t>(next - stop.d.begin()) - 1;
  return (stop.force[first + 1] - stop.force[first]) / (stop.d[first + 1] - stop.d[first]);
}

double stop_force(const Stop &stop, double d) {
  if (stop.d.empty()) return 0.0;
  size_t k = 0;
  const double slope = piece_of(stop, d, k);
  return stop.force[k] + slope * (d - stop.d[k]);
}

double stop_slope(const Stop &stop, double d) {
  size_t k = 0;
  return stop.d.empty() ? 0.0 : piece_of(stop, d, k);
}

class Suspension final : public VehicleSuspension {
 public:
  Suspension(size_t width, const IndexGrid &columns, const Values &arms, const IndexGrid &ends,
             const Grid &at_a, const Grid &at_b, const IndexGrid &rows, const Grid &coefficients,
             const Indices &series_rows, const Grid &series, const nb::list &stops,
             const IndexGrid &friction_rows, const Grid &friction)
      : width_(width) {
    const size_t elements = ends.shape(0), count = rows.shape(0);
    const bool fits = columns.shape(1) == kPlaces && arms.shape(0) == columns.shape(0) &&
                      ends.shape(1) == 2 && at_a.shape(1) == 3 && at_b.shape(1) == 3 &&
                      at_a.shape(0) == elements && at_b.shape(0) == elements &&
                      rows.shape(1) == 3 && coefficients.shape(0) == count &&
                      coefficients.shape(1) == 3 && series.shape(0) == series_rows.shape(0) &&
                      series.shape(1) == 2 && friction_rows.shape(1) == 2 &&
                      friction.shape(0) == friction_rows.shape(0) && friction.shape(1) == 3;
    if (!fits) throw nb::value_error("arrays of a suspension do not fit together");
    bodies_.resize(columns.shape(0));
    for (size_t k = 0; k < bodies_.size(); ++k) {
      for (size_t i = 0; i < kPlaces; ++i)
        bodies_[k].columns[i] = columns(k, i) == -1 ? width : below(columns(k, i), width);
      bodies_[k].arm = arms(k);
    }
    for (size_t k = 0; k < elements; ++k)
      elements_.push_back({below(ends(k, 0), bodies_.size()),
                           below(ends(k, 1), bodies_.size()),
                           point_of(at_a, k),
                           point_of(at_b, k),
                           {},
                           {}});
    for (size_t k = 0; k < count; ++k)
      rows_.push_back({below(rows(k, 0), elements),
                       below(rows(k, 1), 3),
                       rows(k, 2) != 0,
                       coefficients(k, 0),
                       coefficients(k, 1),
                       coefficients(k, 2),
                       0.0,
                       {}});
    for (size_t k = 0; k < series_rows.shape(0); ++k)
      series_.push_back({below(series_rows(k), count), series(k, 0), series(k, 1)});
    for (const nb::handle one : stops) add_stop(nb::cast<nb::tuple>(one));
    for (size_t k = 0; k < friction_rows.shape(0); ++k)
      friction_.push_back({below(friction_rows(k, 0), count), below(friction_rows(k, 1), count),
                           friction(k, 0), friction(k, 1), friction(k, 2)});
    for (const Friction &f : friction_) rows_[f.row].sticking += f.stiffness;
    for (auto *of_friction : {&friction_force_, &anchor_}) of_friction->resize(friction_.size());
    matrix_.resize(count * width);
    for (auto *of_rows : {&displacement_, &rate_, &force_}) of_rows->resize(count);
    series_rates_.resize(series_.size());
    generalised_.resize(width);
  }

  // the power of the dampers, W
  double step(const Values &q, const Values &v, const Values &series) {
    if (q.shape(0) != width_ || v.shape(0) != width_ || series.shape(0) != series_.size())
      throw nb::value_error("a state of another size");
    return find_forces(q.data(), v.data(), series.data());
  }

  double find_forces(const double *q, const double *v, const double *series) override {
    for (Body &body : bodies_) place(body, q);
    for (Element &e : elements_) {
      e.point_b = material(bodies_[e.b], e.at_b);
      e.apart = e.point_b - material(bodies_[e.a], e.at_a);
    }
    std::fill(generalised_.begin(), generalised_.end(), 0.0);
    double power = 0;
    for (size_t k = 0; k < rows_.size(); ++k) power += load(k, v);
    for (size_t k = 0; k < series_.size(); ++k) {
      const Series &s = series_[k];
      const double f = series[k];
      force_[s.row] -= f;
      series_rates_[k] = s.stiffness * (rate_[s.row] - f / s.damping);
      power += f * f / s.damping;
    }
    for (size_t k = 0; k < friction_.size(); ++k) power += rub(k);
    for (size_t k = 0; k < rows_.size(); ++k) collect(k);
    return damping_power_ = power;
  }

  // sliders move on to where the last step() has them: once a time step
  void settle() override {
    for (size_t k = 0; k < friction_.size(); ++k)
      anchor_[k] = displacement_[friction_[k].row] - friction_force_[k] / friction_[k].stiffness;
  }

  void add_derivatives(double *to, size_t coordinates) const override {
    const size_t stride = 2 * coordinates + series_.size();
    for (size_t k = 0; k < rows_.size(); ++k) {
      const Row &row = rows_[k];
      const double stiffness = tangent(k);
      const double *rate = matrix_.data() + k * width_;
      each_column(k, [&](size_t i) {
        each_column(k, [&](size_t j) {
          to[i * stride + j] -= stiffness * rate[i] * rate[j];
          to[i * stride + coordinates + j] -= row.damping * rate[i] * rate[j];
        });
      });
    }
    for (size_t k = 0; k < series_.size(); ++k)
      each_column(series_[k].row, [&](size_t i) {
        to[i * stride + 2 * coordinates + k] -= matrix_[series_[k].row * width_ + i];
      });
  }

  void series_derivatives(double *by_v, size_t coordinates, double *by_series) const override {
    for (size_t k = 0; k < series_.size(); ++k) {
      const Series &s = series_[k];
      for (size_t i = 0; i < width_; ++i)
        by_v[k * coordinates + i] = s.stiffness * matrix_[s.row * width_ + i];
      by_series[k] = -s.stiffness / s.damping;
    }
  }

  double damping_power() const { return damping_power_; }
  double *matrix() { return matrix_.data(); }
  double *displacement() { return displacement_.data(); }
  double *rate() { return rate_.data(); }
  double *force() { return force_.data(); }
  double *friction_force() { return friction_force_.data(); }
  double *anchor() { return anchor_.data(); }
  size_t rows() const { return rows_.size(); }
  size_t friction() const { return friction_.size(); }
  double *series_rates() override { return series_rates_.data(); }
  double *generalised() override { return generalised_.data(); }
  size_t series() const override { return series_.size(); }
  size_t width() const override { return width_; }

 private:
  // N/m, N m/rad, of a row as it is displaced, sliders stick
  double tangent(size_t k) const {
    return rows_[k].stiffness + rows_[k].sticking + stop_slope(rows_[k].stop, displacement_[k]);
  }

  // both ends' columns, some of them of both
  template <typename Take>
  void each_column(size_t k, Take &&take) const {
    const Element &e = elements_[rows_[k].element];
    const Body &a = bodies_[e.a], &b = bodies_[e.b];
    for (const size_t column : a.columns)
      if (column < width_) take(column);
    for (const size_t column : b.columns)
      if (column < width_ &&
          std::find(a.columns, a.columns + kPlaces, column) == a.columns + kPlaces)
        take(column);
  }

  static size_t below(int64_t index, size_t count) {
    if (index < 0 || static_cast<size_t>(index) >= count) throw nb::index_error();
    return static_cast<size_t>(index);
  }

  void add_stop(const nb::tuple &given) {
    rows_[below(nb::cast<int64_t>(given[0]), rows_.size())].stop =
        Stop(nb::cast<Values>(given[1]), nb::cast<Values>(given[2]));
  }

  void place(Body &body, const double *q) const {
    double c[3], s[3];  // yaw, roll, pitch
    for (int i = 0; i < 3; ++i) {
      const size_t column = body.columns[3 + i];
      c[i] = column == width_ ? 1.0 : cos(q[column]);
      s[i] = column == width_ ? 0.0 : sin(q[column]);
    }
    body.origin = {q[body.columns[0]], q[body.columns[1]], q[body.columns[2]]};
    body.ahead = {c[0], s[0], 0.0};
    const Point down = {s[0] * s[1], -c[0] * s[1], c[1]};
    body.axes[0] = c[2] * body.ahead - s[2] * down;
    body.axes[1] = {-s[0] * c[1], c[0] * c[1], s[1]};
    body.axes[2] = s[2] * body.ahead + c[2] * down;
    body.centre = body.origin + body.arm * body.axes[1];
  }

  static Point material(const Body &body, Point at) {
    return body.centre + (at.x * body.axes[0] + at.y * body.axes[1] + at.z * body.axes[2]);
  }

  // displacement, rate and force of a row without that in series; the power of its damper
  double load(size_t k, const double *v) {
    const Row &row = rows_[k];
    const Element &e = elements_[row.element];
    const Body &a = bodies_[e.a], &b = bodies_[e.b];
    const Point direction = a.axes[row.axis];
    double d = dot(direction, e.apart);
    if (row.about) {
      const size_t i = (row.axis + 1) % 3, j = (row.axis + 2) % 3;
      d = 0.5 * (dot(a.axes[j], b.axes[i]) - dot(a.axes[i], b.axes[j]));
    }
    const double rate =
        fill(k, a, e.point_b, -1.0 * direction, v) + fill(k, b, e.point_b, direction, v);
    displacement_[k] = d;
    rate_[k] = rate;
    force_[k] = -(row.stiffness * d + row.damping * rate + row.preload) - stop_force(row.stop, d);
    return row.damping * rate * rate;
  }

  // a body's six numbers of the row; what its velocities add to the rate
  double fill(size_t k, const Body &body, Point at, Point u, const double *v) {
    const bool about = rows_[k].about;
    const Point lever = about ? u : cross(at - body.origin, u), moved = about ? Point{} : u;
    const double parts[kPlaces] = {
        moved.x, moved.y, moved.z, lever.z, dot(body.ahead, lever), dot(body.axes[1], lever)};
    double rate = 0;
    for (size_t i = 0; i < kPlaces; ++i) {
      if (body.columns[i] == width_) continue;
      matrix_[k * width_ + body.columns[i]] = parts[i];
      rate += parts[i] * v[body.columns[i]];
    }
    return rate;
  }

  // adds a slider's force to its row's; what it turns into heat, W
  double rub(size_t k) {
    const Friction &f = friction_[k];
    const Row &carries = rows_[f.load_row];
    const double carried = carries.stiffness * displacement_[f.load_row] + carries.preload;
    // springs that have let go press no more
    const double pressed = std::max(0.0, carries.preload < 0 ? -carried : carried);
    const double limit = f.limit + f.coefficient * pressed;
    const double stuck = f.stiffness * (displacement_[f.row] - anchor_[k]);
    const bool slips = std::abs(stuck) > limit;
    friction_force_[k] = slips ? std::copysign(limit, stuck) : stuck;
    force_[f.row] -= friction_force_[k];
    return slips ? std::max(0.0, friction_force_[k] * rate_[f.row]) : 0.0;
  }

  void collect(size_t k) {
    const Element &e = elements_[rows_[k].element];
    for (const size_t body : {e.a, e.b})
      for (const size_t column : bodies_[body].columns)
        if (column != width_) generalised_[column] += force_[k] * matrix_[k * width_ + column];
  }

  size_t width_;
  std::vector<Body> bodies_;
  std::vector<Element> elements_;
  std::vector<Row> rows_;
  std::vector<Series> series_;
  std::vector<Friction> friction_;
  std::vector<double> matrix_, displacement_, rate_, force_, series_rates_, generalised_;
  std::vector<double> friction_force_, anchor_;  // anchor: where a slider's spring has no force
  double damping_power_ = 0;
};

using Array = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

// views of the object's own memory that keep it alive
template <double *(Suspension::*Data)(), size_t (Suspension::*Count)() const>
Array view(nb::handle_t<Suspension> self) {
  Suspension &found = nb::cast<Suspension &>(self);
  return Array((found.*Data)(), {(found.*Count)()}, self);
}

nb::ndarray<nb::numpy, double, nb::ndim<2>> matrix_of(nb::handle_t<Suspension> self) {
  Suspension &found = nb::cast<Suspension &>(self);
  return {found.matrix(), {found.rows(), found.width()}, self};
}

}  // namespace

void bind_suspension(nb::module_ &m) {
  m.def(
      "stop_force",
      [](const Values &at, const Values &forces, double d) { return stop_force({at, forces}, d); },
      nb::arg("at"), nb::arg("forces"), nb::arg("d"),
      "N, of a bump stop whose table has these points, at a displacement (m); on along its first "
      "and last line.");
  using S = Suspension;
  nb::class_<VehicleSuspension>(m, "VehicleSuspension", "What a vehicle's steps ask of one.");
  nb::class_<S, VehicleSuspension>(m, "Suspension",
                                   "Forces of a vehicle's springs, dampers, rods and bump stops.")
      .def(
          nb::init<size_t, const IndexGrid &, const Values &, const IndexGrid &, const Grid &,
                   const Grid &, const IndexGrid &, const Grid &, const Indices &, const Grid &,
                   const nb::list &, const IndexGrid &, const Grid &>(),
          nb::arg("width"), nb::arg("columns"), nb::arg("arms"), nb::arg("ends"), nb::arg("at_a"),
          nb::arg("at_b"), nb::arg("rows"), nb::arg("coefficients"), nb::arg("series_rows"),
          nb::arg("series"), nb::arg("stops"), nb::arg("friction_rows"), nb::arg("friction"),
          "width: number of coordinates; columns: of each body's x, y, z, yaw, roll, pitch, -1: it "
          "has none; arms: m, of its centre, to the right; ends: bodies A and B of each element; "
          "at_a, at_b: m, "
          "in them; rows: element, axis, whether about it; coefficients: of the rows, stiffness, "
          "damping, preload; series_rows, series: rows with a spring and a damper in series, "
          "stiffness and damping; stops: (row, displacements, forces); friction_rows, friction: of "
          "sliders, row and the row whose spring presses them, stiffness, limit, coefficient.")
      .def("settle", &S::settle, "Sliders stay where the last step() moved them to.")
      .def("step", &S::step, nb::arg("q"), nb::arg("v"), nb::arg("series"),
           "Fills the arrays; W, what the dampers turn into heat.")
      .def_prop_ro("damping_power", &S::damping_power, "W, of the last forces.")
      .def_prop_ro("matrix", &matrix_of, "[rows, width], rates of the rows by the velocities.")
      .def_prop_ro("displacement", &view<&S::displacement, &S::rows>, "m, rad, of the rows.")
      .def_prop_ro("rate", &view<&S::rate, &S::rows>, "m/s, rad/s, of the rows.")
      .def_prop_ro("force", &view<&S::force, &S::rows>, "N, N m, of the rows on body B.")
      .def_prop_ro("series_rates", &view<&S::series_rates, &S::series>, "N/s.")
      .def_prop_ro("friction_force", &view<&S::friction_force, &S::friction>, "N, N m, of sliders.")
      .def_prop_ro("anchor", &view<&S::anchor, &S::friction>,
                   "m, rad, of the rows, where a slider's spring has no force; may be written.")
      .def_prop_ro("generalised", &view<&S::generalised, &S::width>, "Generalised force.");
}

}  // namespace railpatch::python
