// Surface temperature of wheel and rail in rolling contact (Carslaw and Jaeger 1959, section 2.9;
// Ertz and Knothe 2002; report DOT/FRA/ORD-24/18, section 3.1), on rows of a uniform grid.
//
// Heat flows along the normal only, in columns of material that pass the contact at the rolling
// speed; both bodies are half-spaces. The sliding between the bodies is left out of the transport,
// so a column of the wheel and the column of the rail below it stay together.
// With the flux q per area into both bodies together, since the age t, and the effusivities beta:
//   rise = Y/(beta_w + beta_r),  Y = 1/sqrt(pi) int q(t - s)/sqrt(s) ds  (equal on both surfaces).
// Bodies of unequal bulk temperature exchange heat where they touch. With E the part of the
// difference that is levelled out at the surface (1 in contact; report Eqs. 6-7 behind it):
//   T_w = T_w0 - (T_w0 - T_r0) beta_r/(beta_w+beta_r) E + rise,  T_r likewise with beta_w.
// Ages are counted in passages of one element, dx/V, until the last factor.
#pragma once

#include "half_space/influence.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

struct thermal_body {
  double conductivity = 0;     // W/(m K)
  double heat_capacity = 0;    // J/(kg K)
  double density = 0;          // kg/m^3
  double bulk = 0;             // degrees C
  double effusivity() const;   // W s^0.5/(m^2 K), sqrt(lambda rho c)
  double diffusivity() const;  // m^2/s
};

struct thermal_pair {
  thermal_body body[2];  // wheel, rail
  double effusivity() const { return body[0].effusivity() + body[1].effusivity(); }
  // of the friction's heat; what the exchange changes is the other body's share
  double share(int k) const { return body[k].effusivity() / effusivity(); }
  double mean_bulk() const { return 0.5 * (body[0].bulk + body[1].bulk); }
  bool exchanges() const { return body[0].bulk != body[1].bulk; }
  // Surface temperature of body k (degrees C) from the field E and the rise in K.
  double surface(int k, double exchanged, double rise) const {
    const double other = body[1 - k].bulk;
    return body[k].bulk + (other - body[k].bulk) * share(1 - k) * exchanged + rise;
  }
};

// Friction coefficient over surface temperature, report Eq. 19: constant, then linear over
// `range`, then constant.
struct temperature_law {
  double reference = 0, change = 0;  // -
  double reference_temperature = 0;  // degrees C
  double range = 1;                  // K, > 0
  double coefficient(double temperature) const;
  double slope(double temperature) const;  // 1/K; of the linear piece at both of its ends
};

// int_0^t exp(-d^2/(4 s))/sqrt(pi s) ds = 2 sqrt(t) ierfc(d/(2 sqrt t)): constant flux, seen at
// depth d (in sqrt of kappa times the unit of time).
double constant_flux(double age, double depth);

// The rows' common data.
struct heat_rows {
  int nx = 0, ny = 0;
  double dx = 0;      // m
  int direction = 1;  // rolling towards +x or -x
  double speed = 0;   // m/s; 0: no power, and no rise
  // elements, 0 ... 0.5, by which flux acts upstream of the element that it is counted at
  double upstream = 0;
};

// Y at element centres from flux that is constant over each element, exactly: an element's own flux
// acts over half of it, and counts once; with rows.upstream over that much more.
class heat_kernel {
 public:
  heat_kernel() = default;
  explicit heat_kernel(int max_nx) : weight_(static_cast<size_t>(max_nx)) {}
  // distance: rolled while the flux acted, m; infinite in steady rolling. root_depth: z/sqrt(kappa)
  // of the observer, sqrt(s).
  void set(const heat_rows &rows, double distance, double root_depth = 0);
  // sqrt(s), of the flux m elements ahead of the observer; zero from count on
  double weight(int m) const { return weight_[static_cast<size_t>(m)]; }
  int count() const { return count_; }
  // y = known + K q; known may be null, and may be y.
  void apply(const heat_rows &rows, const double *q, const double *known, double *y) const;
  size_t bytes() const { return weight_.bytes(); }

 private:
  aligned_buffer<double> weight_;
  int count_ = 0;
};

// E of one row in steady rolling. A stretch of contact that the row enters with the difference
// 1 - E = jump gets the flux jump/sqrt(pi t); behind it this leaves jump 2/pi asin sqrt(length/t).
// Where a row touches again, flux constant over each element keeps E = 1 at the centres on top.
class heat_exchange {
 public:
  heat_exchange() = default;
  explicit heat_exchange(int max_nx);
  // touching: pressure > 0, in the order of the grid.
  void set_row(const heat_rows &rows, const double *pressure);
  // k: elements behind the row's leading end; depth in sqrt(kappa dx/V).
  double at(int k, double depth = 0) const;
  // Heat that passes the row, of a body with effusivity 1 and a difference of 1, per passage of
  // sqrt(dx/V).
  double heat() const;
  size_t bytes() const { return stretch_.bytes() + flux_.bytes(); }

 private:
  struct stretch {
    double entry, exit, jump;
  };
  double behind(double t, double depth) const;
  double value(double t, double depth) const;
  aligned_buffer<stretch> stretch_;
  aligned_buffer<double> flux_;
  int stretches_ = 0, nx_ = 0;
  bool again_ = false;  // some row touches again: flux_ is not all zero
};

// 2/pi int_0^asin(sqrt(touched/since)) exp(-depth^2/(4 since cos^2)) dangle: what a contact of the
// duration `touched`, begun `since` ago, has levelled out at a depth; touched = since: erfc.
double levelled(double touched, double since, double depth);

// Flux of the friction, W/m^2: its work over the way rolled (N/m^2) times V, and a fraction of the
// plastic power (null: none).
void friction_heat(int count, double speed, const double *friction, const double *plastic_power,
                   double fraction, double *q);

// Steady rolling: Y and, where the pair exchanges heat, E of whole fields.
class steady_temperature {
 public:
  steady_temperature() = default;
  // deep: for at_depth.
  steady_temperature(int max_nx, bool exchanges, bool deep = false);
  void set(const heat_rows &rows);
  void rise(const double *q, const double *known, double *y) const {
    kernel_.apply(rows_, q, known, y);
  }
  // E, at a depth in sqrt(kappa dx/V).
  void exchange(const double *pressure, double *e, double depth = 0);
  // Temperature (degrees C) of body k at depth z (m), of whole fields.
  void at_depth(const thermal_pair &pair, int k, double z, const double *q, const double *pressure,
                double *temperature);
  const heat_kernel &kernel() const { return kernel_; }
  double exchanged_heat() const { return exchanged_heat_; }  // of all rows at the surface
  size_t bytes() const { return kernel_.bytes() + deep_.bytes() + exchange_.bytes(); }

 private:
  heat_rows rows_;
  heat_kernel kernel_, deep_;
  heat_exchange exchange_;
  double exchanged_heat_ = 0;
};

}  // namespace railpatch
