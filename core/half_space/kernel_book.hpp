// Kernels of grids whose elements change their proportions little by little, as those of a wheel do
// that rolls on: between kept ones, in place of new ones for every grid.
//
// A coefficient is a length along x times a function of dy/dx alone, and so is a spectrum, which is
// a sum of coefficients. These functions are analytic in log(dy/dx) up to a distance of pi/2 (where
// dy/dx = +-i), so that Lagrange's polynomial of eight values in steps of 1/32 is theirs to 1e-12
// of the greatest coefficient by its remainder (tests/cpp/test_influence.cpp; 1.4e-13 are found). A
// kept page is of a whole multiple of the step, whenever it was made: what is read does not depend
// on what was read before.
#pragma once

#include <cstddef>

#include "numeric/memory.hpp"

namespace railpatch {

class kernel_book {
 public:
  static constexpr int points = 8;
  static constexpr double step = 1.0 / 32;  // of log(dy/dx)
  // Grids in a row, each close to the one before, after which kept kernels are read. The ones
  // before make their own, and `each` pages for later: all at once would take longer than a step's
  // solve.
  static constexpr int lead = 9, each = points / (lead - 1);
  // A page's arrays, one behind the other, each of `stride` numbers.
  static constexpr int most_arrays = 6;

  // size: numbers of the greatest array.
  kernel_book(int arrays, std::size_t size);
  // Whether pages of this size are small enough to be kept.
  static bool serves(std::size_t size) { return size <= most_numbers; }

  // Lengths of the transforms that pages are read for from now on.
  void set_size(int nx, int ny) {
    nx_ = nx;
    ny_ = ny;
  }
  // Arrays of dx = 1 m and dy/dx = ratio, the first `count` numbers of each, times `scale`, to
  // out[...]. make(ratio, arrays): writes a page, arrays[k] its array k.
  template <class Make>
  void read(double ratio, double scale, std::size_t count, double *const *out, Make &&make) {
    look_up(ratio, scale);
    collect(points, make);
    mix(count, out);
  }
  // Writes some of the pages that a reading there will take.
  template <class Make>
  void prepare(double ratio, Make &&make) {
    look_up(ratio, 1.0);
    collect(each, make);
  }
  std::size_t bytes() const { return pages_.bytes() + entries_.bytes(); }

 private:
  static constexpr std::size_t most_numbers = 1200;  // of an array, as 30 x 30 elements have
  static constexpr int capacity = 6 * points;        // of several patches
  struct entry {
    int place;       // multiple of the step
    int nx, ny;      // lengths; 0: never written
    long long used;  // when
  };
  static double ratio_of(int place);
  void look_up(double ratio, double scale);
  // Finds the pages that were looked up, and writes as many as are missing, `most` at most.
  template <class Make>
  void collect(int most, Make &&make) {
    for (int k = 0; k < points; ++k) {
      int page = find(first_ + k);
      if (page < 0) {
        if (most-- == 0) return;
        page = free_page(first_ + k);
        double *arrays[most_arrays];
        for (int a = 0; a < arrays_; ++a) arrays[a] = array(page, a);
        make(ratio_of(first_ + k), arrays);
      }
      chosen_[k] = page;
    }
  }
  int find(int place);
  int free_page(int place);
  void mix(std::size_t count, double *const *out) const;
  double *array(int page, int k) {
    return pages_.data() + (static_cast<std::size_t>(page) * static_cast<std::size_t>(arrays_) +
                            static_cast<std::size_t>(k)) *
                               stride_;
  }

  int arrays_;
  std::size_t stride_;
  aligned_buffer<double> pages_;
  aligned_buffer<entry> entries_;
  long long now_ = 0;
  int first_ = 0, nx_ = 0, ny_ = 0;
  int chosen_[points] = {};
  double weight_[points] = {};
};

}  // namespace railpatch
