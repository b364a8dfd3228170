// The numbers of an input that steps change, straight from Python's.
#pragma once

#include <nanobind/nanobind.h>

#include <vector>

#include "railpatch.h"

namespace railpatch::python {

namespace nb = nanobind;

// The interpreter's lock guards it.
class Moves {
 public:
  // name -> (offset in bytes, how many numbers, bounds, low, high)
  void allow(const nb::dict &moves);
  // what the next changes go on from
  void start(const rp_input &input) { input_ = input; }
  // The last input with changes. False where one is not among those allowed, no finite number (of
  // an array: as many of them), or out of its bounds.
  bool moved(const nb::dict &changes, rp_input &to) const;
  // of the last input; raises KeyError
  nb::object now(const char *name) const;

 private:
  struct Move {
    size_t offset;
    Py_ssize_t count;  // 0: one number, no array
    double low, high;
    bool open_low, open_high;
  };

  static bool fill(const Move &move, nb::handle value, rp_input &to);
  static bool place(const Move &move, nb::handle value, double &to);

  nb::dict places_;  // name -> place in moves_
  std::vector<Move> moves_;
  rp_input input_ = {};
};

}  // namespace railpatch::python
