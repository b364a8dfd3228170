// Ellipses that stand for a contact area of any shape, each with the load, centre and second
// moments of its part of the pressure: of Hertz's pressure they are the ellipse itself.
//
// Parts lie beside each other across rolling. Where the load of the rows falls between two of them
// to less than `apart` of the lesser one's greatest row, they are apart; above `one` they are one,
// and in between both count. So an interval of parts counts with the share
//   (product of joined over the falls inside) (1 - joined of the fall at its either end),
// as divisions of a wheel's contact do, and forces follow the pressure without jumps.
#pragma once

#include "fast/pressure_view.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

template <class T>
struct basic_pressed_ellipse {
  T axes[2];    // m, along and across rolling
  T centre[2];  // m
  T load;       // of the whole
  T share;      // with which it counts
};

// T: double, or directed, which tells how they move along a direction.
template <class T>
class pressed_ellipses {
 public:
  static constexpr double apart = 0.3, one = 0.6;
  // Parts beyond these are one with the last.
  static constexpr int most_parts = 6, most = most_parts * (most_parts + 1) / 2;

  pressed_ellipses() = default;
  explicit pressed_ellipses(int max_rows);

  // Of a pressure that is somewhere above 0.
  void set(const pressure_view<T> &pressure);
  int count() const { return count_; }
  const basic_pressed_ellipse<T> &operator[](int k) const { return ellipse_[k]; }
  size_t bytes() const { return rows_.bytes() + before_.bytes() + beyond_.bytes(); }

 private:
  // Sums of a row's pressure, and of that times x and times x^2.
  struct row_sums {
    T load, x, xx;
  };
  // A row at which two parts meet.
  struct fall {
    int row;
    T joined;  // 1: one part
    T before;  // part of the row that belongs to the part before, the rest to that beyond
  };
  int find_falls(int ny);
  void add(const pressure_view<T> &g, int first_part, int last_part, int falls, const T &share);

  aligned_buffer<row_sums> rows_;
  aligned_buffer<T> before_, beyond_;  // greatest row up to each, and from it on
  fall falls_[most_parts];
  basic_pressed_ellipse<T> ellipse_[most];
  int count_ = 0;
  T whole_ = 0, middle_ = 0;  // Pa, of all rows; m, x that sums are about
};

}  // namespace railpatch
