// Fast normal theories for contact areas of any shape, which build the contact from rows along
// rolling: each row of the undeformed distance is a parabola, lowest + A (x - vertex)^2, each row
// of contact a chord with semi-elliptic pressure  p = k sqrt(l^2 - (x - vertex)^2).
//
// With d the interpenetration at the deepest point y0 and f(y) the rows' lowest distance above it:
//
// Kik-Piotrowski (Piotrowski and Kik 2008, Vehicle System Dynamics 46: equations 7 and 13, and
// their shape correction). Chords where the bodies, moved together by 0.55 d only, overlap:
//   l^2 = (0.55 d - f)/A
// The region of length L and width W is stretched about (vertex, y0), its area kept, until its axis
// ratio is that of the Hertzian ellipse whose interpenetration has the ratio L/W, but never beyond
// the overlap of the undeformed bodies. One k for all rows follows from the displacement d at the
// deepest point; in it all of a row is as far away as its vertex.
//
// Corrected: 0.55 is near what Hertz's circle has, 1/2 (Kik and Piotrowski 1996), and no slender
// ellipse. Hertz's ellipse of the curvatures A and B has A a^2 = e d and B b^2 = (1 - e) d, e a
// function of A/B alone (Johnson 1985, section 4.2, which is the shape's correction too: Ayasse and
// Chollet 2005, Vehicle System Dynamics 43), so its area is that of the overlap of the undeformed
// bodies at the depth sqrt(e (1 - e)) d. That factor stands for 0.55, with A/B = (W/L)^2 of the
// overlap at this depth, found by two passes from a circle's. Quadratic surfaces then have Hertz's
// ellipse, force and pressure.
//
// ANALYN (Sichani, Enblom and Berg 2014, Vehicle System Dynamics 52). The surfaces deform by
// alpha A x^2 + beta f, with alpha, beta and k of each row from the Hertzian contact (a, b, p0) of
// the row's own curvatures A and B = f''/2 at the approach d:
//   l^2 = (d - (1 + beta) f)/((1 + alpha) A),  1 + alpha = d/(A a^2),  1 + beta = d/(B b^2),
//   k = p0/a
// B is taken over a reach of a fifth of the width of the region with f < d/2 to both sides, and not
// below a tenth of the mean curvature of that region: the curvature at a point jumps where a
// profile's arcs join and says little of a measured profile.
//
// Both integrate over a strip of one row's width with f the parabola through three rows, cut where
// contact ends, so force and area do not jump when an edge passes from row to row; for quadratic
// surfaces ANALYN is Hertz's solution on any grid. Contact areas that are parts of one patch
// (contact_parts) are blended from all ways of taking neighbours together or apart, weighted with
// the coupling factors.
#pragma once

#include "normal/hertz_ratios.hpp"
#include "normal/normal.hpp"
#include "normal/strip.hpp"
#include "railpatch.h"

namespace railpatch {

constexpr double virtual_interpenetration = 0.55;  // -, of the interpenetration

struct row_contact_load {
  bool force_given;
  double force;           // N, where given
  double approach;        // m, where given
  double first_approach;  // m, start of the search for the force; 0: none
};

struct row_contact_result {
  bool converged = false;
  bool touches_border = false;  // the contact area reaches the edge of the grid
  double approach = 0;          // m
  double normal_force = 0;      // N
  double max_pressure = 0;      // Pa
  double contact_area = 0;      // m^2
  double elastic_energy = 0;    // J, with the displacement that approach and distance ask for
  double residual = 0;          // -, of the prescribed force
  int iterations = 0;           // evaluations for the prescribed force
};

// Whether a theory is one of these.
inline bool takes_rows(rp_normal_method method) {
  return method == RP_NORMAL_KIK_PIOTROWSKI || method == RP_NORMAL_ANALYN ||
         method == RP_NORMAL_KIK_PIOTROWSKI_CORRECTED;
}

class row_contact {
 public:
  row_contact(rp_normal_method method, double modulus, int max_ny);

  // Fills pressure: samples at element centres that carry the theory's force row by row.
  row_contact_result solve(const grid &g, const double *undeformed_distance,
                           const row_contact_load &load, const contact_parts &parts,
                           double *pressure);
  // Ends of the last contact's chords, x in m, [ny]; direction of rolling 1 or -1. Rows whose
  // middle is not in contact hold their vertex.
  double leading_edge(int row, int direction) const;
  // m, lateral, of all of the last contact.
  double width() const { return width_; }
  size_t bytes() const;

 private:
  struct totals;
  struct deepest_point;
  struct row_parabola {
    double vertex, lowest, curvature;
    row_parabola towards(const row_parabola &other, double share) const {
      return {vertex + share * (other.vertex - vertex), lowest + share * (other.lowest - lowest),
              curvature + share * (other.curvature - curvature)};
    }
  };
  static row_parabola parabola_of(const grid &g, const double *row, int i, int reach);
  static row_parabola measure_row(const grid &g, const double *row, int reach);
  void measure_rows(const grid &g, const double *h, double reach);
  double find_reach(const grid &g, double approach) const;
  double guess_approach(const grid &g, double force) const;
  deepest_point find_deepest(const grid &g, int begin, int end) const;
  double search(const grid &g, const row_contact_load &load, double first,
                const contact_parts &parts, row_contact_result &result);
  totals evaluate(const grid &g, double approach, const contact_parts &parts);
  void evaluate_group(const grid &g, double approach, int begin, int end, totals &way);
  double overlap_width(const grid &g, double level, int begin, int end) const;
  struct overlap;
  struct deepest_places;
  hertz_ratios::values ellipse_of_overlap(const grid &g, const deepest_point &deep,
                                          double curvature, int begin, int end, double depth) const;
  overlap overlap_of(const grid &g, const deepest_point &deep, double curvature, int begin,
                     int end) const;
  double lowest_in_strip(const grid &g, int j, double flattest) const;
  deepest_places find_places(const grid &g, const deepest_point &deep, int begin, int end,
                             double flattest);
  double displacement_at(const grid &g, const quadratic *chords, double place, int of, int begin,
                         int end) const;
  void kik_piotrowski(const grid &g, const deepest_point &deep, int begin, int end, totals &way);
  void analyn(const grid &g, const deepest_point &deep, int begin, int end, totals &way);
  void add_row(const grid &g, int row, const strip &s, const quadratic &chord, const quadratic &f,
               double depth, double factor, totals &way);
  void add_point(const grid &g, int row, double load, double *pressure) const;
  void share_loads(const grid &g);
  void sample(const grid &g, double force, double *pressure, row_contact_result &result);

  rp_normal_method method_;
  double modulus_;
  hertz_ratios hertz_;
  double width_ = 0;
  // by row: the parabola in x, the stretched lowest distance, and of the last contact the squared
  // half chord and the load (N)
  aligned_buffer<double> vertex_, lowest_, curvature_, stretched_, chord_, load_;
  aligned_buffer<double> mean_chord_, centre_;  // of the strip: mean square, load times distance
  // of Kik-Piotrowski: the deepest places' weights, and chords along their strips; then what rows
  // carry
  aligned_buffer<double> weight_;
  aligned_buffer<quadratic> chords_;
};

}  // namespace railpatch
