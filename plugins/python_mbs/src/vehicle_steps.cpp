// The class railpatch._core.VehicleSteps: a vehicle's equations of motion and their time steps,
// see wheelset_demo/vehicle/steppers.py.

#include <nanobind/nanobind.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "convert.hpp"
#include "vehicle.hpp"
#include "vehicle_equations.hpp"

namespace railpatch::python {

namespace {

// Solves M x = b with M square, kept by rows: elimination with the greatest of a column first.
class Elimination {
 public:
  explicit Elimination(size_t n) : n_(n), matrix_(n * n), order_(n) {}

  double *matrix() { return matrix_.data(); }

  void factor() {
    for (size_t k = 0; k < n_; ++k) {
      size_t best = k;
      for (size_t i = k + 1; i < n_; ++i)
        if (std::abs(at(i, k)) > std::abs(at(best, k))) best = i;
      order_[k] = best;
      if (best != k) std::swap_ranges(row(k), row(k) + n_, row(best));
      const double pivot = 1.0 / at(k, k), *from = row(k);
      for (size_t i = k + 1; i < n_; ++i) {
        double *to = row(i);
        if (to[k] == 0) continue;
        const double factor = to[k] *= pivot;
        for (size_t j = k + 1; j < n_; ++j) to[j] -= factor * from[j];
      }
    }
  }

  void solve(double *x) const {
    for (size_t k = 0; k < n_; ++k) std::swap(x[k], x[order_[k]]);
    for (size_t i = 0; i < n_; ++i)
      for (size_t j = 0; j < i; ++j) x[i] -= matrix_[i * n_ + j] * x[j];
    for (size_t i = n_; i-- > 0;) {
      for (size_t j = i + 1; j < n_; ++j) x[i] -= matrix_[i * n_ + j] * x[j];
      x[i] /= matrix_[i * n_ + i];
    }
  }

 private:
  double &at(size_t i, size_t j) { return matrix_[i * n_ + j]; }
  double *row(size_t i) { return matrix_.data() + i * n_; }

  size_t n_;
  std::vector<double> matrix_;
  std::vector<size_t> order_;
};

std::vector<Joint> joints_of(const IndexGrid &kinds, const Grid &placements, const Grid &inertias) {
  const size_t count = kinds.shape(0);
  const bool fits = kinds.shape(1) == 2 && placements.shape(0) == count &&
                    placements.shape(1) == 12 && inertias.shape(0) == count &&
                    inertias.shape(1) == 13;
  if (!fits) throw nb::value_error("arrays of joints do not fit together");
  std::vector<Joint> joints;
  for (size_t k = 0; k < count; ++k) {
    const int64_t parent = kinds(k, 0), kind = kinds(k, 1);
    if (parent < -1 || parent >= static_cast<int64_t>(k) || kind < 0 || kind > 5)
      throw nb::index_error();
    Joint joint{static_cast<int>(parent), static_cast<JointKind>(kind), {}, 0, {}, {}};
    const double *from = placements.data() + 12 * k, *inertia = inertias.data() + 13 * k;
    std::copy_n(from, 9, joint.placement.rotation);
    std::copy_n(from + 9, 3, joint.placement.origin);
    joint.mass = inertia[0];
    std::copy_n(inertia + 1, 3, joint.centre);
    std::copy_n(inertia + 4, 9, joint.inertia);
    joints.push_back(joint);
  }
  return joints;
}

VehicleNumbers numbers_of(const Indices &axles, const Values &radii, const Values &numbers,
                          const Indices &ahead) {
  if (numbers.shape(0) != 4 || ahead.shape(0) != 4 || radii.shape(0) != axles.shape(0))
    throw nb::value_error("a radius a wheelset; arm, hold, gain, speed; x, y, pitch, yaw");
  VehicleNumbers found{numbers(0), {}, numbers(1), numbers(2), numbers(3), {}, {}};
  found.radius.assign(radii.data(), radii.data() + radii.shape(0));
  for (size_t i = 0; i < 4; ++i) found.ahead[i] = static_cast<size_t>(ahead(i));
  for (size_t k = 0; k < axles.shape(0); ++k) found.axle.push_back(static_cast<size_t>(axles(k)));
  return found;
}

class VehicleSteps {
 public:
  VehicleSteps(VehicleContacts &contacts, VehicleCourse &course, VehicleSuspension &suspension,
               const IndexGrid &kinds, const Grid &placements, const Grid &inertias,
               const Values &gravity, const Indices &axles, const Values &radii,
               const Values &numbers, const Indices &ahead, const IndexGrid &watched,
               VehicleSupport *support, VehicleDrives *drives, VehicleWetRails *wet)
      : contacts_(contacts),
        course_(course),
        suspension_(suspension),
        extras_{support, drives, wet},
        equations_(contacts, course, suspension, extras_,
                   Bodies(joints_of(kinds, placements, inertias), gravity.data()),
                   numbers_of(axles, radii, numbers, ahead)),
        left_(equations_.coordinates()) {
    const size_t count = equations_.wheelsets(), size = equations_.size();
    if (watched.shape(0) != count || watched.shape(1) != 2 || gravity.shape(0) != 3)
      throw nb::value_error("two columns a wheelset, gravity of three numbers");
    for (size_t k = 0; k < 2 * count; ++k) {
      watched_.push_back(static_cast<size_t>(watched.data()[k]));
      if (watched_.back() >= equations_.coordinates()) throw nb::index_error();
    }
    for (auto *to : {&values_, &next_, &last_, &older_, &known_, &change_}) to->resize(size);
    for (auto *to : {&older_inputs_, &inputs_, &bend_}) to->resize(equations_.known());
    for (auto *to : {&work_, &powers_}) to->resize(equations_.powers_count());
    rates_.resize(size);
    assumed_.resize(2 * count);
    ages_.resize(count);
    wrong_.reserve(count);
    loss_.resize(equations_.series());
    spent_.resize(2 * count);
  }

  int evaluate(const Values &values) {
    check(values);
    nb::gil_scoped_release unlocked;
    return equations_.evaluate(values.data());
  }

  void differentiate(const Values &values, const Indices &wheelsets) {
    check(values);
    std::vector<size_t> found;
    for (size_t i = 0; i < wheelsets.shape(0); ++i) {
      if (wheelsets(i) < 0 || static_cast<size_t>(wheelsets(i)) >= equations_.wheelsets())
        throw nb::index_error();
      found.push_back(static_cast<size_t>(wheelsets(i)));
    }
    nb::gil_scoped_release unlocked;
    equations_.differentiate(values.data(), found.data(), found.size());
  }

  // of one wheelset's derivatives; the last one takes them all
  void find_column(size_t wheelset, size_t column) {
    if (wheelset >= equations_.wheelsets() || column >= kColumns) throw nb::index_error();
    nb::gil_scoped_release unlocked;
    equations_.find_column(wheelset, column);
    if (column + 1 == kColumns) contacts_.take_columns(wheelset);
  }

  // after the first step: values, works, rates and inputs before it are given
  void begin(const Values &values, const Values &work, const Values &change, const Values &older,
             const Values &older_inputs, double time, double step, size_t every, double surprise) {
    for (const Values *of : {&values, &change, &older}) check(*of);
    if (work.shape(0) != work_.size() || older_inputs.shape(0) != older_inputs_.size() ||
        every == 0)
      throw nb::value_error("works or inputs of another size");
    std::copy_n(values.data(), values_.size(), values_.data());
    std::copy_n(work.data(), work_.size(), work_.data());
    std::copy_n(change.data(), last_.size(), last_.data());
    std::copy_n(older.data(), older_.size(), older_.data());
    std::copy_n(older_inputs.data(), older_inputs_.size(), older_inputs_.data());
    keep_rates();
    time_ = time;
    step_ = step;
    every_ = every;
    surprise_ = surprise;
    wrong_.clear();
    for (size_t k = 0; k < ages_.size(); ++k) wrong_.push_back(k);
    fresh_ = true;
  }

  // Up to as many steps; how many were made, less where the next one's status is refused, a bit of
  // each: then the state is the one before.
  size_t advance(size_t count, uint32_t refused, bool stores, VehicleMeans &means) {
    nb::gil_scoped_release unlocked;
    for (size_t done = 0; done < count; ++done)
      if (!step(refused, stores, means)) return done;
    return count;
  }

  int status() const { return status_; }
  double time() const { return time_; }
  bool differentiating() const { return differentiating_; }
  bool sloped() const { return equations_.sloped; }
  void set_sloped(bool value) { equations_.sloped = value; }
  size_t renewals() const { return equations_.renewals; }
  size_t evaluations() const { return equations_.evaluations; }
  double contact_seconds() const { return equations_.contact_seconds; }
  double derivative_seconds() const { return equations_.derivative_seconds; }

  double *values() { return values_.data(); }
  double *work() { return work_.data(); }
  double *kept_rates() { return rates_.data(); }
  double *kept_powers() { return powers_.data(); }
  double *kept_inputs() { return inputs_.data(); }
  VehicleEquations &equations() { return equations_; }

 private:
  enum { kColumns = 12 };  // of a wheelset's derivatives

  void check(const Values &state) const {
    if (state.shape(0) != equations_.size()) throw nb::value_error("a state of another size");
  }

  void keep_rates() {
    std::copy_n(equations_.rates(), rates_.size(), rates_.data());
    std::copy_n(equations_.powers(), powers_.size(), powers_.data());
    std::copy_n(course_.inputs(), inputs_.size(), inputs_.data());
  }

  // Those whose derivatives are old or known to be wrong; ages are spread over the wheelsets, so
  // that these take turns. Those by differences are found bit by bit in the steps before they are
  // due.
  void keep_fresh() {
    differentiating_ = true;
    const bool spread = every_ >= kColumns * ages_.size();
    bool renewed = false;
    for (size_t k = 0; k < ages_.size(); ++k) {
      if (std::find(wrong_.begin(), wrong_.end(), k) != wrong_.end()) continue;
      const bool by_columns = spread && contacts_.by_differences(k);
      if (by_columns && ages_[k] >= every_) {
        contacts_.take_columns(k);
        ages_[k] = 0;
        renewed = true;
      } else if (ages_[k] >= every_) {
        wrong_.push_back(k);
      } else if (by_columns && ages_[k] + kColumns >= every_) {
        equations_.find_column(k, ages_[k] + kColumns - every_);
      }
    }
    if (!wrong_.empty() || renewed) {
      std::sort(wrong_.begin(), wrong_.end());
      equations_.differentiate(values_.data(), wrong_.data(), wrong_.size());
      factor();
      for (const size_t k : wrong_) ages_[k] = fresh_ ? first_age(k) : 0;
      wrong_.clear();
      fresh_ = false;
    }
    differentiating_ = false;
    for (size_t &age : ages_) ++age;
  }

  // so that the first one is due soonest, and no columns are left out
  size_t first_age(size_t k) const {
    const size_t spread = every_ > kColumns ? every_ - kColumns : every_;
    return k * spread / ages_.size();
  }

  // 1 - 2/3 h A, whose rows of coordinates say that rates are velocities, by eliminating them, and
  // the forces of dampers, whose own part is a diagonal
  void factor() {
    const size_t n = equations_.coordinates(), m = equations_.series(), size = equations_.size();
    const double h = (2.0 / 3.0) * step_;
    for (size_t k = 0; k < m; ++k) loss_[k] = 1.0 / (1.0 - h * equations_.series_by_series()[k]);
    for (size_t i = 0; i < n; ++i) {
      const double *from = equations_.by_state() + i * size;
      double *to = left_.matrix() + i * n;
      for (size_t j = 0; j < n; ++j) to[j] = (i == j ? 1.0 : 0.0) - h * (from[n + j] + h * from[j]);
      for (size_t k = 0; k < m; ++k) {
        const double factor = h * from[2 * n + k] * loss_[k] * h;
        if (factor == 0) continue;
        const double *by = equations_.series_by_v() + k * n;
        for (size_t j = 0; j < n; ++j) to[j] -= factor * by[j];
      }
    }
    left_.factor();
  }

  // change_ := (1 - 2/3 h A)^-1 change_
  void solve() {
    const size_t n = equations_.coordinates(), m = equations_.series(), size = equations_.size();
    const double h = (2.0 / 3.0) * step_;
    double *q = change_.data(), *v = q + n, *series = v + n;
    for (size_t k = 0; k < m; ++k) series[k] *= loss_[k];
    for (size_t i = 0; i < n; ++i) {
      const double *from = equations_.by_state() + i * size;
      double sum = 0;
      for (size_t j = 0; j < n; ++j) sum += from[j] * q[j];
      for (size_t k = 0; k < m; ++k) sum += from[2 * n + k] * series[k];
      v[i] += h * sum;
    }
    left_.solve(v);
    for (size_t j = 0; j < n; ++j) q[j] += h * v[j];
    for (size_t k = 0; k < m; ++k) {
      const double *by = equations_.series_by_v() + k * n;
      double sum = 0;
      for (size_t j = 0; j < n; ++j) sum += by[j] * v[j];
      series[k] += loss_[k] * h * sum;
    }
  }

  bool step(uint32_t refused, bool stores, VehicleMeans &means) {
    keep_fresh();
    foresee();
    const double *q = values_.data(), *v = q + equations_.coordinates();
    if (extras_.drives != nullptr) extras_.drives->update(time_, q, v);
    // a state that the contacts refuse leaves the last one
    const double before = course_.middle();
    if (stores) contacts_.pass_time(step_);
    status_ = equations_.evaluate(next_.data());
    if (refused >> status_ & 1u) return false;
    for (size_t i = 0; i < work_.size(); ++i)
      work_[i] += 0.5 * step_ * (powers_[i] + equations_.powers()[i]);
    const size_t wheels = work_.size() - spent_.size();
    for (size_t i = 0; i < spent_.size(); ++i)
      spent_[i] = 0.5 * step_ * (powers_[wheels + i] + equations_.powers()[wheels + i]);
    time_ += step_;
    values_.swap(next_);
    last_.swap(change_);
    older_.swap(rates_);
    older_inputs_.swap(inputs_);
    keep_rates();
    watch();
    suspension_.settle();
    means.add_step(course_.middle() - before, contacts_.wheels(), 9);
    if (extras_.wet != nullptr) extras_.wet->leave(course_.positions(), spent_.data());
    if (extras_.support != nullptr) extras_.support->meet();
    return true;
  }

  // next_, change_ and what accelerations the step assumed
  void foresee() {
    const size_t n = equations_.coordinates(), size = equations_.size();
    course_.look_ahead_all(values_.data() + n, step_);
    for (size_t i = 0; i < bend_.size(); ++i)
      bend_[i] = course_.ahead()[i] - 2 * inputs_[i] + older_inputs_[i] + course_.bend()[i];
    for (size_t i = 0; i < size; ++i) known_[i] = 2 * rates_[i] - older_[i];
    for (size_t i = 0; i < n; ++i) {
      const double *by = equations_.by_inputs() + i * bend_.size();
      for (size_t k = 0; k < bend_.size(); ++k) known_[n + i] += by[k] * bend_[k];
    }
    for (size_t i = 0; i < size; ++i) change_[i] = step_ * known_[i] - last_[i];
    solve();
    for (double &value : change_) value *= 2.0 / 3.0;
    for (size_t w = 0; w < watched_.size(); ++w) {
      const double *by = equations_.by_state() + watched_[w] * size;
      assumed_[w] = known_[n + watched_[w]];
      for (size_t i = 0; i < size; ++i) assumed_[w] += by[i] * change_[i];
    }
    for (size_t i = 0; i < size; ++i) {
      change_[i] += last_[i];
      next_[i] = values_[i] + change_[i];
    }
  }

  // wheelsets that the step was surprised by
  void watch() {
    const size_t n = equations_.coordinates();
    for (size_t w = 0; w < watched_.size(); ++w) {
      const double away = std::abs(rates_[n + watched_[w]] - assumed_[w]);
      if (away > surprise_ && (wrong_.empty() || wrong_.back() != w / 2)) wrong_.push_back(w / 2);
    }
  }

  VehicleContacts &contacts_;
  VehicleCourse &course_;
  VehicleSuspension &suspension_;
  VehicleExtras extras_;
  VehicleEquations equations_;
  Elimination left_;
  std::vector<size_t> watched_, ages_, wrong_;
  std::vector<double> values_, next_, last_, older_, rates_, known_, change_, assumed_, loss_;
  std::vector<double> inputs_, older_inputs_, bend_, work_, powers_, spent_;
  double time_ = 0, step_ = 0, surprise_ = 0;
  size_t every_ = 1;
  int status_ = 0;
  bool fresh_ = true, differentiating_ = false;
};

using Array = nb::ndarray<nb::numpy, double>;

// views of the object's own memory that keep it alive
Array view(nb::handle self, double *data, std::initializer_list<size_t> shape) {
  return Array(data, shape, self);
}

}  // namespace

void bind_steps(nb::module_ &m) {
  using V = VehicleSteps;
  const auto of = [](nb::handle self) -> V & { return nb::cast<V &>(self); };
  nb::class_<V>(m, "VehicleSteps", "A vehicle's equations of motion and its time steps.")
      .def(nb::init<VehicleContacts &, VehicleCourse &, VehicleSuspension &, const IndexGrid &,
                    const Grid &, const Grid &, const Values &, const Indices &, const Values &,
                    const Values &, const Indices &, const IndexGrid &, VehicleSupport *,
                    VehicleDrives *, VehicleWetRails *>(),
           nb::arg("contacts"), nb::arg("course"), nb::arg("suspension"), nb::arg("kinds"),
           nb::arg("placements"), nb::arg("inertias"), nb::arg("gravity"), nb::arg("axles"),
           nb::arg("radii"), nb::arg("numbers"), nb::arg("ahead"), nb::arg("watched"),
           nb::arg("support").none(), nb::arg("drives").none(), nb::arg("wet").none(),
           nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>(), nb::keep_alive<1, 4>(),
           nb::keep_alive<1, 14>(), nb::keep_alive<1, 15>(), nb::keep_alive<1, 16>(),
           "kinds: of each joint, its parent (-1: the world) and whether it moves along x, y, z "
           "(0 to 2) or about them (3 to 5); placements: in the parent, 12 numbers; inertias: "
           "mass, centre, inertia about it, 13 numbers; axles, radii: joints of the wheelsets, m; "
           "numbers: m, half the distance of the contacts, how far below its centre a body is held "
           "at speed, N s/m, m/s; ahead: its x, y, pitch, yaw; watched: of each wheelset, two "
           "coordinates; support, drives, wet: None where there are none.")
      .def("evaluate", &V::evaluate, nb::arg("values"),
           "Fills 'rates' and 'powers'; the contacts' worst status.")
      .def("differentiate", &V::differentiate, nb::arg("values"), nb::arg("wheelsets"),
           "Fills 'by_state' and the others at the state of the last evaluate().")
      .def("find_column", &V::find_column, nb::arg("wheelset"), nb::arg("column"),
           "Of a wheelset's derivatives, for the next differentiate(): all twelve in turn.")
      .def("begin", &V::begin, nb::arg("values"), nb::arg("work"), nb::arg("change"),
           nb::arg("older"), nb::arg("older_inputs"), nb::arg("time"), nb::arg("step"),
           nb::arg("every"), nb::arg("surprise"),
           "The state after a first step, whose rates were the last ones; its change and the rates "
           "and inputs before.")
      .def("advance", &V::advance, nb::arg("count"), nb::arg("refused"), nb::arg("stores"),
           nb::arg("means"),
           "Steps; how many were made before one whose status is among those refused, bits 1 << "
           "status. stores: whether contacts change with time. The interpreter's lock is released.")
      .def_prop_ro("status", &V::status, "Of the contacts, at the last step.")
      .def_prop_ro("renewals", &V::renewals, "Of derivatives, so far.")
      .def_prop_ro("time", &V::time, "s, of the last step made.")
      .def_prop_ro("differentiating", &V::differentiating,
                   "Whether it was derivatives that were not found.")
      .def_prop_ro("contact_seconds", &V::contact_seconds,
                   "CPU time of the calling thread in the contacts.")
      .def_prop_ro("derivative_seconds", &V::derivative_seconds, "The same in derivatives.")
      .def_prop_ro("evaluations", &V::evaluations, "Of rates, so far.")
      .def_prop_rw("sloped", &V::sloped, &V::set_sloped, "Whether slopes of rails have forces.")
      .def_prop_ro("values",
                   [of](nb::handle_t<V> self) {
                     return view(self, of(self).values(), {of(self).equations().size()});
                   })
      .def_prop_ro("work",
                   [of](nb::handle_t<V> self) {
                     return view(self, of(self).work(), {of(self).equations().powers_count()});
                   })
      .def_prop_ro("kept_rates",
                   [of](nb::handle_t<V> self) {
                     return view(self, of(self).kept_rates(), {of(self).equations().size()});
                   })
      .def_prop_ro("kept_powers",
                   [of](nb::handle_t<V> self) {
                     auto &e = of(self).equations();
                     return view(self, of(self).kept_powers(), {e.powers_count()});
                   })
      .def_prop_ro("kept_inputs",
                   [of](nb::handle_t<V> self) {
                     return view(self, of(self).kept_inputs(), {of(self).equations().known()});
                   })
      .def_prop_ro("rates",
                   [of](nb::handle_t<V> self) {
                     auto &e = of(self).equations();
                     return view(self, e.rates(), {e.size()});
                   })
      .def_prop_ro("powers",
                   [of](nb::handle_t<V> self) {
                     auto &e = of(self).equations();
                     return view(self, e.powers(), {e.powers_count()});
                   })
      .def_prop_ro("slope_wrenches",
                   [of](nb::handle_t<V> self) {
                     auto &e = of(self).equations();
                     return view(self, e.slope_wrenches(), {e.wheelsets(), 2, 3});
                   })
      .def_prop_ro("by_state",
                   [of](nb::handle_t<V> self) {
                     auto &e = of(self).equations();
                     return view(self, e.by_state(), {e.coordinates(), e.size()});
                   })
      .def_prop_ro("by_inputs",
                   [of](nb::handle_t<V> self) {
                     auto &e = of(self).equations();
                     return view(self, e.by_inputs(), {e.coordinates(), e.known()});
                   })
      .def_prop_ro("series_by_v",
                   [of](nb::handle_t<V> self) {
                     auto &e = of(self).equations();
                     return view(self, e.series_by_v(), {e.series(), e.coordinates()});
                   })
      .def_prop_ro("series_by_series", [of](nb::handle_t<V> self) {
        auto &e = of(self).equations();
        return view(self, e.series_by_series(), {e.series()});
      });
}

}  // namespace railpatch::python
