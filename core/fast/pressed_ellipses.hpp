// Ellipses that stand for a contact area of any shape, each with the load, centre and second
// moments of its part of the pressure: of Hertz's pressure they are the ellipse itself.
//
// Parts lie beside each other across rolling. Where the load of the rows falls between two of them
// to less than `apart` of the lesser one's greatest row, they are apart; above `one` they are one,
// and in between both count. So an interval of parts counts with the share
//   (product of joined over the falls inside) (1 - joined of the fall at its either end),
// as divisions of a wheel's contact do, and forces follow the pressure without jumps.
#pragma once

#include "half_space/influence.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

struct pressed_ellipse {
  double axes[2];    // m, along and across rolling
  double centre[2];  // m
  double load;       // of the whole
  double share;      // with which it counts
};

class pressed_ellipses {
 public:
  static constexpr double apart = 0.3, one = 0.6;
  // Parts beyond these are one with the last.
  static constexpr int most_parts = 6, most = most_parts * (most_parts + 1) / 2;

  pressed_ellipses() = default;
  explicit pressed_ellipses(int max_rows);

  // Of a pressure that is somewhere above 0.
  void set(const grid &g, const double *pressure);
  int count() const { return count_; }
  const pressed_ellipse &operator[](int k) const { return ellipse_[k]; }
  size_t bytes() const { return rows_.bytes() + before_.bytes() + beyond_.bytes(); }

 private:
  // Sums of a row's pressure, and of that times x and times x^2.
  struct row_sums {
    double load, x, xx;
  };
  // A row at which two parts meet.
  struct fall {
    int row;
    double joined;  // 1: one part
    double before;  // part of the row that belongs to the part before, the rest to that beyond
  };
  int find_falls(int ny);
  void add(const grid &g, int first_part, int last_part, int falls, double share);

  aligned_buffer<row_sums> rows_;
  aligned_buffer<double> before_, beyond_;  // greatest row up to each, and from it on
  fall falls_[most_parts];
  pressed_ellipse ellipse_[most];
  int count_ = 0;
  double whole_ = 0, middle_ = 0;  // Pa, of all rows; m, x that sums are about
};

}  // namespace railpatch
