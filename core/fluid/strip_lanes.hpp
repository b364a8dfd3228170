// Liquid along the rows of a contact, several at once: fluid/wet_strip.hpp's march and Newton's
// steps, without branches, for as many strips as there are lanes, so that one instruction of the
// processor serves several. Each lane's numbers are its own: they do not depend on what the other
// lanes hold. A strip that leaves the range of the lanes (films that close, asperities of less
// than 1e-15) or does not settle is not converged: wet_strip's solver then takes it alone.
#pragma once

#include "fluid/wet_strip.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

// Nominal pressure of a run of elements over its greatest, p_0: its square is straight between
// them, and beyond the last one to the edge, where it would vanish going on as it does, within the
// element.
struct pressed_run {
  const double *squares = nullptr;  // [count + 2] from one element before the leading one on
  int count = 0, most = 0;          // elements, and which has p_0, from the leading one on
  double front = 0, half = 0;       // of the edge and of half the length, in elements
  double greatest = 0;              // p_0, Pa
  double lean = 0;                  // k of sqrt(1 - X^2) (1 + k X) with the same centre of pressure

  // first: pressures in the order of x; squares: memory of count + 2
  static pressed_run of(const double *first, int count, bool backwards, double *squares);
  // of an element
  double theta(int i) const;
  void thetas(double *found) const;  // of all, within 2e-8
};

class run_pressure final : public strip_pressure {
 public:
  explicit run_pressure(const pressed_run &run) : run_(run) {}
  double at(double cosine, double sine, double &slope) const override;
  double peak() const override { return run_.theta(run_.most); }

 private:
  pressed_run run_;
};

struct strip_march;  // of all lanes

class strip_lanes {
 public:
  static constexpr int lanes = 8;
  struct strip {
    pressed_run run;
    double s = 0, r = 0;
    double start = 0;  // theta of X_c to begin with
    // where X_c is about: the ellipse's from the table, moved as the pressure leans
    double likely_end() const;
  };

  explicit strip_lanes(int steps);  // from X_c to the leading edge

  // count: 1 to `lanes`; precision: of P and X_c
  void solve(const strip *strips, int count, double precision);
  const strip_solution &found(int lane) const { return found_[lane]; }
  int nodes() const { return steps_ + 1; }
  double end(int lane) const { return end_[lane]; }  // theta of X_c
  // of each node, from the leading edge to X_c in even steps of theta: P
  const double *liquid(int lane) const { return kept_.data() + lane * nodes(); }
  size_t bytes() const { return 5 * liquid_.bytes() + bell_.bytes() + tail_.bytes(); }

 private:
  static size_t at(int node, int lane) { return static_cast<size_t>(node * lanes + lane); }
  void set_lane(int lane, const strip &of, strip_march &task);
  // what the last march found, for X_c a little farther
  void keep(int lane, double by);

  int steps_;
  end_search search_[lanes];
  double end_[lanes] = {};
  strip_solution found_[lanes];
  aligned_buffer<double> liquid_, distance_;            // [node][lane], of d
  aligned_buffer<double> liquid_rate_, distance_rate_;  // by theta of X_c
  aligned_buffer<double> kept_;                         // [lane][node], P
  aligned_buffer<double> bell_, tail_;                  // phi and 1 - Phi at steps of d
};

}  // namespace railpatch
