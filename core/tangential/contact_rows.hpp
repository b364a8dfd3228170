// The contact area as rows along rolling, each a strip in y with its own chord: the fitted
// discretisation of the tangential problem, whose edges lie where the contact's edges are.
// Each of several areas beside each other has strips of its own.
//
// A row carries the pressure p(x) = p_row sqrt(1 - ((x - x_row)/a_row)^2): exact for Hertz
// contact, and the ellipse with the same load, centroid and second moment for any other (the
// pressure of a quadratic overlap is close to it: Kik and Piotrowski 1996). Its n nodes are the
// Gauss-Chebyshev points of the second kind, counted from the leading edge:
//   x_k = x_row + direction a_row cos(k pi/(n+1)),   weights a_row pi/(n+1) sin(k pi/(n+1)),
// with which sums of p over the nodes are exact integrals.
#pragma once

#include "half_space/influence.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

struct contact_row {
  int strip;           // of those across the contact area, from the lowest y
  double y;            // m, middle of the strip
  double height;       // m, of the strip
  double x;            // m, middle of the chord
  double half_length;  // m, of the chord
  double peak;         // Pa, p_row
};

class contact_rows {
 public:
  // strips: across the contact area; max_grid_rows: of the grids given to set_pressure.
  contact_rows(int nodes, int strips, int max_grid_rows);

  // The ellipse about the origin under the force; strips of equal height with their exact loads.
  void set_ellipse(const double semi_axes[2], double normal_force);
  // A line contact of the given width about x: one row.
  void set_line(double half_length, double width, double normal_force, double x = 0);
  // Any pressure on a uniform grid; the rows carry exactly its force. Between the grid's rows load
  // and squared chord are parabolas, as they are of an ellipse.
  void set_pressure(const grid &g, const double *pressure);

  int nodes() const { return nodes_; }
  int strips() const { return strips_; }
  int count() const { return count_; }  // rows: the strips in contact
  const contact_row &operator[](int row) const { return rows_[static_cast<size_t>(row)]; }

  // Of node k = 0 ... nodes - 1, from the leading edge: cosine and sine of its angle.
  double cosine(int k) const { return cosine_[static_cast<size_t>(k)]; }
  double sine(int k) const { return sine_[static_cast<size_t>(k)]; }
  double pressure(int row, int k) const { return (*this)[row].peak * sine(k); }
  double area(int row, int k) const;  // m^2 that the node stands for
  size_t bytes() const;

 private:
  // one grid row's load (N/m), middle (m) and squared half-length (m^2), and where it lies
  struct profile_point {
    double y, load, x, half_length_squared;
  };
  // contact between grid rows without pressure: its points, with both ends
  struct contact_area {
    int first, last;
    double force;   // N
    double weight;  // integral of the strips' density
    double share;   // of the strips
  };
  // m, y where an area begins and ends
  struct area_ends {
    double low, high;
  };
  struct bends {
    double load, squared;
  };
  void collect(const grid &g, const double *pressure);
  void close_area(const grid &g, int first, int last);
  static area_ends ends_of(const profile_point *first, const profile_point *last, double dy);
  static area_ends ends_by_moments(const profile_point *first, const profile_point *last,
                                   double dy);
  static double edge_beyond(const profile_point *first, int step, double dy);
  static void lessen(profile_point *outermost, int step, int rows, double end, double dy);
  bends bend(const contact_area &area, int i) const;
  void share_strips();
  double weigh(contact_area &p, double peak_load);
  double place(const contact_area &p, double weight) const;
  void cut_strips(const contact_area &p, int first_strip, int strips);

  int nodes_, strips_, count_ = 0;
  aligned_buffer<contact_row> rows_;
  aligned_buffer<double> cosine_, sine_;
  aligned_buffer<profile_point> points_;
  aligned_buffer<double> density_, weight_;  // of strips at the points, and its integral
  aligned_buffer<contact_area> areas_;
  int area_count_ = 0;
};

}  // namespace railpatch
