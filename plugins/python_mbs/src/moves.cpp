#include "moves.hpp"

#include <nanobind/stl/string.h>

#include <cmath>
#include <string>

namespace railpatch::python {

namespace {

double *number_at(rp_input &input, size_t offset) {
  return reinterpret_cast<double *>(reinterpret_cast<char *>(&input) + offset);
}

}  // namespace

void Moves::allow(const nb::dict &moves) {
  places_ = nb::dict();
  moves_.clear();
  for (const auto [name, row] : moves) {
    const auto values = nb::cast<nb::tuple>(row);
    Move move = {};
    move.offset = nb::cast<size_t>(values[0]);
    move.count = nb::cast<Py_ssize_t>(values[1]);
    const auto bounds = nb::cast<std::string>(values[2]);
    move.low = nb::cast<double>(values[3]);
    move.high = nb::cast<double>(values[4]);
    move.open_low = bounds.front() == '(';
    move.open_high = bounds.back() == ')';
    const auto count = static_cast<size_t>(move.count == 0 ? 1 : move.count);
    if (move.offset % sizeof(double) != 0 ||
        move.offset + count * sizeof(double) > sizeof(rp_input))
      throw nb::value_error("allow: a place outside the input");
    places_[name] = static_cast<Py_ssize_t>(moves_.size());
    moves_.push_back(move);
  }
}

bool Moves::moved(const nb::dict &changes, rp_input &to) const {
  to = input_;
  for (const auto [name, value] : changes) {
    PyObject *found = PyDict_GetItem(places_.ptr(), name.ptr());
    if (found == nullptr) return false;
    if (!fill(moves_[PyLong_AsSize_t(found)], value, to)) return false;
  }
  return true;
}

nb::object Moves::now(const char *name) const {
  const Move &move = moves_[nb::cast<size_t>(nb::object(places_[name]))];
  rp_input input = input_;
  const double *values = number_at(input, move.offset);
  if (move.count == 0) return nb::float_(values[0]);
  nb::list list;
  for (Py_ssize_t i = 0; i < move.count; ++i) list.append(values[i]);
  return list;
}

bool Moves::fill(const Move &move, nb::handle value, rp_input &to) {
  double *at = number_at(to, move.offset);
  if (move.count == 0) return place(move, value, *at);
  if (!PySequence_Check(value.ptr()) || PySequence_Size(value.ptr()) != move.count) {
    PyErr_Clear();
    return false;
  }
  for (Py_ssize_t i = 0; i < move.count; ++i) {
    const nb::object item = nb::steal(PySequence_GetItem(value.ptr(), i));
    if (!item.is_valid() || !place(move, item, at[i])) {
      PyErr_Clear();
      return false;
    }
  }
  return true;
}

// numpy's doubles are floats
bool Moves::place(const Move &move, nb::handle value, double &to) {
  if (!PyFloat_Check(value.ptr()) && !PyLong_CheckExact(value.ptr())) return false;
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1.0 && PyErr_Occurred()) {
    PyErr_Clear();
    return false;
  }
  const bool above = move.open_low ? number > move.low : number >= move.low;
  const bool below = move.open_high ? number < move.high : number <= move.high;
  if (!above || !below || !std::isfinite(number)) return false;
  to = number;
  return true;
}

}  // namespace railpatch::python
