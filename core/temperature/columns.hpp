// Surface temperature where contact is transient: columns of material that remember the heat of
// earlier steps and move through the grid as the contact rolls.
//
// Memory: 1/sqrt(pi t) = 2/pi int_0^inf exp(-x^2 t) dx. With x = x0 sinh(u) the integrand over u is
// even and analytic, so the trapezoidal rule gives a sum of exponentials with a relative error of
// 1e-8 over ages from `shortest` to `longest` below (rates from x0 to the last node; step in u by
// the decay of Gamma(1/2 + i y) along the imaginary axis and of the Gaussian: both exp(-19.7)).
// A mode's state y_j = int q exp(-x_j^2 age) is the cosine transform of the temperature over depth,
// so it gives the temperature below the surface as well, and y_0 is the heat stored.
// The heat of the step itself is not put through the modes but through the exact kernel of
// temperature.hpp. Columns sit one element apart and move as a whole by any distance: their common
// offset from the element centres is part of the memory, so that nothing is smeared by repeated
// interpolation; only what earlier steps left is interpolated to the centres, and where a step is a
// whole number of elements not even that. Columns that leave the grid are forgotten, columns that
// enter it have the bulk's temperature.
#pragma once

#include "temperature/temperature.hpp"

namespace railpatch {

class heat_columns {
 public:
  heat_columns() = default;
  heat_columns(int max_nx, int max_ny, bool exchanges);

  // The memory is outside, one block of numbers of this length, so that it can be saved and copied.
  static size_t state_size(int max_nx, int max_ny, bool exchanges);
  size_t state_size() const;
  // All at bulk temperature.
  void reset(double *state) const;

  // Prepares a step of `distance` (m, >= 0), pressure > 0 where the bodies touch during all of it.
  // The state's heat is not changed; a grid of another shape than the last forgets it, and a speed
  // far from that of the modes moves it to other modes (interpolated: 1e-5).
  void begin(const heat_rows &rows, double distance, const double *pressure, double *state);
  // After begin: Y and E at element centres at the step's end; q is the step's flux, constant
  // over each element. y may be evaluated for any number of trial fluxes.
  void rise(const double *q, double *y) const { kernel_.apply(rows_, q, memory_.data(), y); }
  const double *memory() const { return memory_.data(); }  // Y without the step's own heat
  const double *exchanged() const { return exchanges_ ? exchanged_.data() : nullptr; }
  const heat_kernel &kernel() const { return kernel_; }
  // Takes the step over into the state.
  void commit(const double *q, const double *pressure, double *state);

  // After commit: temperature (degrees C) of a body at depth z (m) in each column, [ny][nx]; the
  // columns stand offset(state) (m) from the element centres along x.
  void at_depth(const thermal_pair &pair, int body, double z, const double *state,
                double *temperature);
  // After begin: from columns to element centres; fresh: the value of material that enters.
  void to_centres(const double *columns, double fresh, double *centres) const;
  static double offset(const double *state);
  // J/m^2 of the friction in a column, both bodies together, since it entered.
  double stored(int i, int j, const double *state) const;
  size_t bytes() const;

 private:
  struct exchange_column;
  struct movement {
    double offset = 0;     // m, of the columns at the step's end
    int shift = 0;         // columns by which the material moves along x
    double travelled = 0;  // m, of the column in its last element
    // the same of the flux's elements, and how many of these it is ahead of the column's own
    double heated = 0;
    int ahead = 0;  // -1 or 0
  };
  movement move(double offset) const;
  // f(duration in s, elements ahead of the last one), in order of time; travelled: m, in the last
  template <class F>
  void for_each_interval(double travelled, F &&f) const;
  void heat_rows_of(const double *q, double duration, int ahead, double *state);
  void set_rates(double unit);
  void set_unit(double unit, double *state);
  void convert_modes(double factor, double *modes, const double *flux, int column);
  void set_factors(double duration);
  void shift_columns(double *field) const;
  void remember(double offset, const double *state);
  void exchange(const double *pressure, const double *state);
  exchange_column load(const double *state, int column);
  void store(const exchange_column &c, double *state, int column) const;
  void pass(exchange_column &c, double duration, bool touches);
  double value(const exchange_column &c) const;
  bool touched_by(const double *pressure, int row, int i) const;
  double local_part(double age) const;
  void weigh(double depth);
  size_t flux_at() const;  // blocks of the state
  size_t exchange_at() const;

  int max_nx_ = 0, modes_ = 0;
  size_t capacity_ = 0;
  bool exchanges_ = false;
  heat_rows rows_;
  double distance_ = 0, unit_ = 0, duration_ = -1;
  movement movement_;
  heat_kernel kernel_;
  // nodes and weights of the unit 1; rates (1/s) and weights of the present unit; factors of the
  // present duration
  aligned_buffer<double> node_, node_weight_, rate_, weight_, decay_, gain_, column_, scratch_;
  aligned_buffer<double> sum_, memory_, exchanged_;
};

// Dawson's integral exp(-x^2) int_0^x exp(t^2) dt (Rybicki 1989).
double dawson(double x);

}  // namespace railpatch
