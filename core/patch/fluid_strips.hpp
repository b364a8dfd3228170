// The liquid in the rows of a patch by strips: of an elliptic contact from the table, of any other
// each row solved with its own pressure.
#pragma once

#include <optional>

#include "fluid/strip_lanes.hpp"
#include "fluid/strip_table.hpp"
#include "fluid/wet_strip.hpp"
#include "normal/hertz.hpp"
#include "normal/normal.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

struct strip_liquid {
  double viscosity, speed;     // Pa s, m/s
  double roughness, hardness;  // m, Pa
  // S of a strip of that half length and pressure, and r.
  double s(double half_length, double pressure) const {
    return 12.0 * viscosity * speed * half_length / (roughness * roughness * pressure);
  }
  double r(double pressure) const { return pressure / hardness; }
  // m, of the film where asperities bear that pressure
  double film(double asperities) const;
};

struct strip_outcome {
  double share = 1;  // of asperities
  double film = 0;   // m, in the middle of the ellipse or where the pressure is greatest
  bool converged = true;
};

class fluid_strips {
 public:
  // elliptic: from the table alone
  fluid_strips(bool elliptic, int max_nx, int max_ny);

  // Without a grid: the whole ellipse.
  static strip_outcome of_ellipse(const hertz_contact &hertz, const strip_liquid &liquid);
  // Fills the liquid's pressure of each element. direction: of rolling; hertz: zero axes where the
  // contact is no ellipse.
  strip_outcome solve(const grid &g, const double *pressure, const hertz_contact &hertz,
                      int direction, const strip_liquid &liquid, double *fluid);
  size_t bytes() const { return rows_ ? sizeof(by_rows) + rows_->bytes() : 0; }

 private:
  struct element_run {
    int row, first, last;
  };
  // of contacts that are no ellipse
  struct by_rows {
    strip_lanes lanes;
    strip_solver one;  // for what the lanes leave
    aligned_buffer<element_run> runs;
    aligned_buffer<double> squares;  // [lane][element]
    aligned_buffer<double> thetas;   // of elements of a row
    size_t bytes() const {
      return lanes.bytes() + one.bytes() + runs.bytes() + squares.bytes() + thetas.bytes();
    }
  };
  static strip_table::rows_of rows_of_ellipse(const hertz_contact &hertz,
                                              const strip_liquid &liquid);
  static strip_outcome of_ellipse(const hertz_contact &hertz, const strip_liquid &liquid,
                                  const strip_table::rows_of &rows);
  static void add_elliptic_row(const grid &g, int j, const double *pressure,
                               const hertz_contact &hertz, int direction,
                               const strip_liquid &liquid, const strip_table::rows_of &rows,
                               double *fluid);
  bool add_rows(const grid &g, const double *pressure, int direction, const strip_liquid &liquid,
                double *fluid);
  strip_solution solve_one(const strip_lanes::strip &strip);

  std::optional<by_rows> rows_;
};

}  // namespace railpatch
