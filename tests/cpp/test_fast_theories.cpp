// The fast theories of rolling contact against their formulas written out once more: of ellipses,
// of areas of any shape and of rows whose ends the normal theory knows, in both directions.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "fast/fast.hpp"
#include "fast/fastsim.hpp"
#include "fast/polach.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;

// the same formulas in another order
constexpr double rounded = 1e-10;
const elastic_constants steel{8.2e10, 0.28, 0.0};

// --- contacts --------------------------------------------------------------------------------

struct contact {
  std::string name;
  grid g;
  std::vector<double> pressure;
  hertz_contact hertz;
  std::optional<row_contact> rows;
  double force = 0, area = 0;

  fast_patch patch(double mu) const {
    return {g, pressure.data(), hertz, rows ? &*rows : nullptr, force, area, mu, mu};
  }
  double p(int i, int j) const { return pressure[static_cast<size_t>(j * g.nx + i)]; }
  void sum() {
    force = area = 0;
    for (double v : pressure) {
      force += v * g.dx * g.dy;
      area += v > 0 ? g.dx * g.dy : 0.0;
    }
  }
};

contact ellipse(const char *name, double a, double b) {
  contact c;
  c.name = name;
  // elements' places not symmetric about the middle
  c.g = {14, 9, 2.3 * a / 14, 2.2 * b / 9, 0, 0};
  c.g.x0 = -6.3 * c.g.dx;
  c.g.y0 = -4.2 * c.g.dy;
  const double axes[2] = {a, b};
  c.hertz = hertz_from_ellipse(axes, steel.shear_modulus / (1 - steel.poisson_ratio), 9e4);
  for (int j = 0; j < c.g.ny; ++j)
    for (int i = 0; i < c.g.nx; ++i) {
      const double u = c.g.x(i) / a, v = c.g.y(j) / b;
      c.pressure.push_back(c.hertz.max_pressure * std::sqrt(std::max(0.0, 1 - u * u - v * v)));
    }
  c.sum();
  return c;
}

// Two lobes of unlike length, one row of which has a gap, rows without contact at both sides.
contact lobes() {
  contact c;
  c.name = "lobes";
  c.g = {16, 11, 4e-4, 7e-4, -2.9e-3, -4.4e-3};
  for (int j = 0; j < c.g.ny; ++j)
    for (int i = 0; i < c.g.nx; ++i) {
      const double x = i - 6.0 - 0.4 * j, width = j < 5 ? 3.7 : 5.2;
      const bool touches = j > 0 && j < 9 && std::abs(x) < width && !(j == 4 && i == 7);
      c.pressure.push_back(touches ? 1e9 * (1 - 0.03 * x * x) * (0.5 + 0.05 * j) : 0.0);
    }
  // hardly any pressure is contact all the same
  c.pressure[static_cast<size_t>(2 * c.g.nx + 14)] = 0.5;
  c.sum();
  return c;
}

// Contact in every element, as a grid that ends before the contact does.
contact block() {
  contact c;
  c.name = "block";
  c.g = {7, 5, 6e-4, 7e-4, -1.7e-3, -1.5e-3};
  for (int j = 0; j < c.g.ny; ++j)
    for (int i = 0; i < c.g.nx; ++i) c.pressure.push_back(1e8 * (4 + i + 0.3 * j));
  c.sum();
  return c;
}

contact chords() {
  contact c;
  c.name = "chords";
  c.g = {18, 13, 9e-4, 9e-4, -7.2e-3, -5.1e-3};
  std::vector<double> h;
  for (int j = 0; j < c.g.ny; ++j)
    for (int i = 0; i < c.g.nx; ++i) {
      const double x = c.g.x(i) - 0.1 * c.g.y(j), y = c.g.y(j);
      h.push_back((1.1 + 20 * y) * x * x + 1.6 * y * y + 90 * y * y * y);
    }
  c.pressure.resize(h.size());
  c.rows.emplace(RP_NORMAL_KIK_PIOTROWSKI, steel.shear_modulus / (1 - steel.poisson_ratio), 13);
  const row_contact_result r =
      c.rows->solve(c.g, h.data(), {true, 8e4, 0, 0}, {}, c.pressure.data());
  c.force = r.normal_force;
  c.area = r.contact_area;
  return c;
}

const std::vector<contact> &contacts() {
  static const std::vector<contact> all = [] {
    std::vector<contact> v;
    v.push_back(ellipse("wide", 4e-3, 7e-3));
    v.push_back(ellipse("long", 8e-3, 3e-3));
    v.push_back(lobes());
    v.push_back(block());
    v.push_back(chords());
    return v;
  }();
  return all;
}

std::vector<rolling_input> inputs() {
  std::vector<rolling_input> all;
  for (int direction : {1, -1})
    for (double offset : {0.0, 3e-4})
      for (const auto &[xi, eta, phi] : std::vector<std::array<double, 3>>{{4e-4, -3e-4, 0.11},
                                                                           {-1e-3, 2e-3, -0.7},
                                                                           {2e-2, -1e-2, 0.3},
                                                                           {2e-3, 1e-3, 0.0},
                                                                           {0, 0, 0.4},
                                                                           {3e-3, 0, 0},
                                                                           {0, 0, 0}}) {
        rolling_input in;
        in.creepage[0] = xi;
        in.creepage[1] = eta;
        in.spin_creepage = phi;
        in.direction = direction;
        in.spin_offset = offset;
        all.push_back(in);
      }
  return all;
}

// --- the theories once more ------------------------------------------------------------------

struct answer {
  std::vector<double> px, py, sx, sy;
  std::vector<unsigned char> division;
  double friction = 0;
  int slip = 0, stick = 0;
  creep_resultants sums;
  bool converged = true;
  explicit answer(const grid &g = {}) {
    for (auto *v : {&px, &py, &sx, &sy}) v->assign(static_cast<size_t>(g.count()), 0.0);
    division.assign(static_cast<size_t>(g.count()), RP_EXTERIOR);
  }
};

// Of the law of slip velocity, with one term; speed: m/s.
double law_once_more(const slip_velocity_law &law, double speed) {
  const double u = speed / law.halving_speed[0];
  const double f = law.shape == RP_SLIP_EXPONENTIAL ? std::pow(0.5, u)
                   : law.shape == RP_SLIP_RATIONAL  ? 1 / (1 + u)
                                                    : std::max(0.0, 1 - u / 2);
  return law.kinetic + law.amplitude[0] * f;
}

struct setting {
  const contact &c;
  const fast_options &o;
  const rolling_input &in;
  double mu;
  double a = 0, b = 0, x0 = 0, y0 = 0;  // the ellipse, or the one that stands for the contact
  creepage_coefficients k;
  double xi = 0, eta = 0;  // at its centre
  setting(const contact &c_, const fast_options &o_, const rolling_input &in_, double mu_)
      : c(c_), o(o_), in(in_), mu(mu_) {
    if (c.hertz.semi_axes[0] > 0) {
      a = c.hertz.semi_axes[0];
      b = c.hertz.semi_axes[1];
    } else {
      double sum = 0;
      int rows = 0;
      for (int j = 0; j < c.g.ny; ++j) {
        bool any = false;
        for (int i = 0; i < c.g.nx; ++i) {
          sum += c.p(i, j);
          x0 += c.p(i, j) * c.g.x(i);
          y0 += c.p(i, j) * c.g.y(j);
          any = any || c.p(i, j) > 0;
        }
        rows += any;
      }
      x0 /= sum;
      y0 /= sum;
      b = (c.rows ? c.rows->width() : rows * c.g.dy) / 2;
      a = c.area / pi / b;
    }
    k = o.blending == RP_BLENDING_CONTACT ? published_coefficients(a / b, steel.poisson_ratio)
                                          : coefficient_table(steel.poisson_ratio).at(a / b);
    for (double *v : {&k.c11, &k.c22, &k.c23, &k.c33}) *v *= o.coefficient_factor;
    xi = in.creepage[0] - in.spin_creepage * y0;
    eta = in.creepage[1] + in.spin_creepage * x0;
  }
  // beside mu: of a law, of which mu is the scale, by the rigid slip
  double law(double slip) const { return o.law ? law_once_more(*o.law, in.speed * slip) : 1; }
  double law(int i, int j) const {
    const double x = c.g.x(i) + in.spin_offset, y = c.g.y(j), phi = in.spin_creepage;
    return law(std::hypot(in.creepage[0] - phi * y, in.creepage[1] + phi * x));
  }
  double capacity() const {
    if (!o.law || o.theory == RP_TANGENTIAL_POLACH) return mu * law(std::hypot(xi, eta)) * c.force;
    double sum = 0, load = 0;
    for (int j = 0; j < c.g.ny; ++j)
      for (int i = 0; i < c.g.nx; ++i) {
        sum += mu * law(i, j) * c.p(i, j);
        load += c.p(i, j);
      }
    return sum / load * c.force;
  }

  // Polach's: the creepage that saturates
  double eta_c() const {
    const double with = eta + in.direction * in.spin_creepage * a;
    return std::fabs(with) > std::fabs(eta) ? with : eta;
  }
  double gradient() const {
    const double nu = std::hypot(xi, eta_c());
    if (nu == 0) return 0;
    const double cjj = std::sqrt(std::pow(k.c11 * xi / nu, 2) + std::pow(k.c22 * eta_c() / nu, 2));
    return steel.shear_modulus * pi * a * b * cjj * nu / (4 * capacity());
  }

  std::array<double, 3> flexibility() const {
    const double g = steel.shear_modulus;
    std::array<double, 3> l{8 * a / (3 * g * k.c11), 8 * a / (3 * g * k.c22),
                            pi * a * std::sqrt(a / b) / (4 * g * k.c23)};
    const double turn = 3 * pi / 32 * a * std::fabs(in.spin_creepage);
    if (o.blending != RP_BLENDING_NONE && (xi != 0 || eta != 0 || turn != 0)) {
      // the creepage at which the linear theory's force is the bound
      const double s1 = capacity() / (g * a * b * k.c11), s2 = capacity() / (g * a * b * k.c22);
      const double w =
          std::min(1.0, std::sqrt(xi * xi + eta * eta) / (3 * std::sqrt(s1 * s1 + s2 * s2)));
      const double one = (xi * xi + eta * eta + turn * turn) /
                         (xi * xi / l[0] + eta * eta / l[1] + turn * turn / l[2]);
      for (double &v : l) v = (1 - w) * v + w * one;
    }
    const stiffness_reduction &r = o.reduction;
    // the program CONTACT's is that of the stiffness times k0
    const double e = (o.blending == RP_BLENDING_CONTACT ? r.k0 : 1.0) * gradient();
    const double factor = r.beta > 0 ? r.k0 * (r.alpha + (1 - r.alpha) / (1 + r.beta * e)) : r.k0;
    for (double &v : l) v /= factor;
    return l;
  }

  std::vector<double> bound() const {
    std::vector<double> g = bound_at_rest();
    for (int j = 0; j < c.g.ny && o.law; ++j)
      for (int i = 0; i < c.g.nx; ++i) g[static_cast<size_t>(j * c.g.nx + i)] *= law(i, j);
    return g;
  }
  // without what a law makes of it
  std::vector<double> bound_at_rest() const {
    const bool is_ellipse = c.hertz.semi_axes[0] > 0;
    const bool by_default = is_ellipse && o.blending == RP_BLENDING_CONTACT;
    bool squares = o.bound == RP_BOUND_PARABOLIC || (o.bound == RP_BOUND_AUTOMATIC && by_default);
    if (o.theory == RP_TANGENTIAL_FASTRIP) squares = false;
    std::vector<double> g = c.pressure;
    double sum = 0;
    for (double p : c.pressure) sum += p * p * c.g.dx * c.g.dy;
    for (double &v : g) v = squares ? mu * v * v * c.force / sum : mu * v;
    if (!is_ellipse || o.blending != RP_BLENDING_CONTACT) return g;
    // mu times the pressure of Hertz, or the paraboloid of the same volume
    const double volume = mu * 9e4;
    for (int j = 0; j < c.g.ny; ++j)
      for (int i = 0; i < c.g.nx; ++i) {
        const double u = c.g.x(i) / a, v = c.g.y(j) / b, level = std::max(0.0, 1 - u * u - v * v);
        g[static_cast<size_t>(j * c.g.nx + i)] =
            squares ? 2 * volume / (pi * a * b) * level
                    : 1.5 * volume / (pi * a * b) * std::sqrt(level);
      }
    return g;
  }

  // Ends of a row, in x.
  bool ends(int j, double e[2]) const {
    int low = -1, high = -1;
    for (int i = c.g.nx - 1; i >= 0; --i)
      if (c.p(i, j) > 0) low = i;
    for (int i = 0; i < c.g.nx; ++i)
      if (c.p(i, j) > 0) high = i;
    e[0] = e[1] = 0;
    if (low < 0) return false;
    e[0] = c.g.x(low) - c.g.dx / 2;
    e[1] = c.g.x(high) + c.g.dx / 2;
    if (c.hertz.semi_axes[0] > 0) {
      e[1] = a * std::sqrt(1 - c.g.y(j) * c.g.y(j) / (b * b));
      e[0] = -e[1];
    }
    for (int side : {0, 1})
      if (c.rows) {
        const double edge = c.rows->leading_edge(j, side ? 1 : -1);
        if (side ? edge > c.g.x(high) : edge < c.g.x(low)) e[side] = edge;
      }
    return true;
  }
};

// From the leading edge, elastic displacement and traction step by step.
answer fastsim_once_more(const setting &s) {
  const grid &g = s.c.g;
  answer out(g);
  const auto l = s.flexibility();
  const std::vector<double> bound = s.bound();
  const double phi = s.in.spin_creepage;
  const bool whole = s.o.blending == RP_BLENDING_CONTACT;
  for (int j = 0; j < g.ny; ++j) {
    double e[2];
    if (!s.ends(j, e)) continue;
    const double middle = (e[0] + e[1]) / 2;
    double last = s.in.direction > 0 ? e[1] : e[0], t[2] = {0, 0};
    bool begun = false;
    for (int n = 0; n < g.nx; ++n) {
      const int i = s.in.direction > 0 ? g.nx - 1 - n : n;
      const auto at = static_cast<size_t>(j * g.nx + i);
      if (s.c.p(i, j) <= 0) {
        t[0] = t[1] = 0;
        if (begun) last = g.x(i) - s.in.direction * g.dx / 2;
        continue;
      }
      begun = true;
      const double step = whole ? g.dx : std::fabs(last - g.x(i));
      const double x = (whole ? g.x(i) : (last + g.x(i)) / 2) + s.in.spin_offset;
      last = g.x(i);
      const double w[2] = {s.in.creepage[0] - phi * s.y0 - phi * (g.y(j) - s.y0) * l[0] / l[2],
                           s.in.creepage[1] + phi * middle + phi * (x - middle) * l[1] / l[2]};
      // elastic displacement that the rigid slip of the step alone would make
      double trial[2], size = 0;
      for (int k = 0; k < 2; ++k) trial[k] = t[k] - w[k] * step / l[static_cast<size_t>(k)];
      size = std::sqrt(trial[0] * trial[0] + trial[1] * trial[1]);
      const bool slides = size > bound[at];
      double *p[2] = {&out.px[at], &out.py[at]}, *slip[2] = {&out.sx[at], &out.sy[at]};
      for (int k = 0; k < 2; ++k) {
        *p[k] = slides ? trial[k] / size * bound[at] : trial[k];
        // rigid slip plus what the displacement changes over the step
        *slip[k] = slides ? w[k] + l[static_cast<size_t>(k)] * (*p[k] - t[k]) / step : 0.0;
        t[k] = *p[k];
        out.friction -= *p[k] * w[k] * step * g.dy;
      }
      out.division[at] = slides ? RP_SLIP : RP_STICK;
      ++(slides ? out.slip : out.stick);
    }
  }
  return out;
}

// int_0^x sqrt(h^2 - x^2) dx, the ends beyond h left out
double cap(double h, double x) {
  if (h <= 0) return 0;
  x = std::min(std::max(x, -h), h);
  const double root = std::sqrt((h - x) * (h + x));
  return (x * root + h * h * std::atan2(x, root)) / 2;
}

answer fastrip_once_more(const setting &s) {
  const grid &g = s.c.g;
  answer out(g);
  const auto l = s.flexibility();
  const std::vector<double> bound = s.bound();
  const double nu = steel.poisson_ratio, half_g = steel.shear_modulus / 2;
  const double f11 = s.k.c11 / (pi * pi / 4 / (1 - nu)), f22 = s.k.c22 / (pi * pi / 4);
  const double f23 = s.k.c23 / (pi * std::sqrt(s.a / s.b) / 3);
  const double f33 = s.k.c33 / (pi * pi * s.b / (16 * (1 - nu) * s.a));
  const int way = s.in.direction;
  const double phi = way * s.in.spin_creepage, xi = way * s.xi;
  for (int j = 0; j < g.ny; ++j) {
    double e[2];
    if (!s.ends(j, e)) continue;
    const double middle = (e[0] + e[1]) / 2, h = (e[1] - e[0]) / 2, y = g.y(j) - s.y0;
    double load = 0;
    for (int i = 0; i < g.nx; ++i) load += bound[static_cast<size_t>(j * g.nx + i)] * g.dx;
    const double k0 = load / (pi / 2 * h * h);
    const double eta = s.in.creepage[1] + s.in.spin_creepage * (middle + s.in.spin_offset);
    const double a = -(f11 * xi - f33 * phi * y) * half_g / (1 - nu), b = -f22 * eta * half_g;
    const double t = f23 * phi * half_g;
    // 1/d: the greater root; none above 1/h: all slips
    const double square = a * a + b * b, q = b * b * t * t - square * (t * t - k0 * k0);
    double d = h;
    if (square == 0)
      d = std::fabs(t) <= k0 ? 0 : h;
    else if (q >= 0 && (b * t + std::sqrt(q)) / square > 1 / h)
      d = square / (b * t + std::sqrt(q));
    const bool sticks = d < h;
    double before = h, p[2] = {0, 0};
    for (int n = 0; n < g.nx; ++n) {
      const int i = way > 0 ? g.nx - 1 - n : n;
      const auto at = static_cast<size_t>(j * g.nx + i);
      if (s.c.p(i, j) <= 0) continue;
      const double x = way * (g.x(i) - middle);
      bool slides = !(sticks && x + g.dx / 2 > 2 * d - h);
      double slip[2] = {0, 0};
      if (slides) {
        const double length = before - x;
        const double w[2] = {xi - phi * y * l[0] / l[2],
                             eta + phi * (before + x) / 2 * l[1] / l[2]};
        double trial[2] = {p[0] - w[0] * length / l[0], p[1] - w[1] * length / l[1]};
        const double size = std::hypot(trial[0], trial[1]);
        for (int k = 0; k < 2; ++k) {
          const double cut = size > 0 ? trial[k] / size * bound[at] : 0;
          if (size > bound[at]) slip[k] = l[static_cast<size_t>(k)] * (cut - trial[k]) / length;
          p[k] = cut;
        }
      } else {
        // means over the element; the first reaches to the leading edge, the last to the trailing
        const double from = x - g.dx > -h ? x - g.dx / 2 : -h;
        const bool first = before == h;
        const double to = first ? h : x + g.dx / 2;
        const double outer = (cap(h, to) - cap(h, from)) / g.dx;
        const double inner = (cap(h - d, to - d) - cap(h - d, from - d)) / g.dx;
        const double kx = d > 0 ? a / d : 0, ky = d > 0 ? b / d : 0;
        p[0] = kx * (outer - inner);
        p[1] = (ky - t) * outer - ky * inner;
        const double size = std::hypot(p[0], p[1]);
        slides = size > bound[at] || x < 2 * d - h;
        for (double &v : p) v *= size > bound[at] ? bound[at] / size : 1;
      }
      before = x;
      out.px[at] = way * p[0];
      out.py[at] = p[1];
      out.sx[at] = way * slip[0];
      out.sy[at] = slip[1];
      const double w[2] = {s.in.creepage[0] - s.in.spin_creepage * g.y(j),
                           s.in.creepage[1] + s.in.spin_creepage * g.x(i)};
      // what the motion supplies, wherever the spin is read
      out.friction -= (out.px[at] * w[0] + out.py[at] * w[1]) * g.dx * g.dy;
      out.division[at] = slides ? RP_SLIP : RP_STICK;
      ++(slides ? out.slip : out.stick);
    }
  }
  return out;
}

answer polach_once_more(const setting &s) {
  answer out;
  const double q = s.capacity(), phi = s.in.spin_creepage, nu = std::hypot(s.xi, s.eta_c());
  if (nu == 0 || q == 0) return out;
  const double e = s.gradient(), ka = s.o.polach.adhesion * e, ks = s.o.polach.slip * e;
  const double f = 2 * q / pi * (ka / (1 + ka * ka) + std::atan(ks));
  out.sums.force[0] = -f * s.xi / nu;
  out.sums.force[1] = -f * s.eta / nu;
  out.friction = f * (s.xi * s.xi + s.eta * s.eta) / nu;
  const double shape = 1 + 6.3 * (1 - std::exp(-s.a / s.b));
  const double es = 8.0 / 3 * steel.shear_modulus * s.b * std::sqrt(s.a * s.b) * s.k.c23 *
                    std::fabs(s.eta_c()) / (q * shape);
  const double d = (es * es - 1) / (es * es + 1);
  const double bracket = es * (d * d * d / 3 - d * d / 2 + 1.0 / 6) - std::pow(1 - d * d, 1.5) / 3;
  out.sums.force[1] += 9.0 / 16 * s.a * q * shape * s.in.direction * phi / nu * bracket;
  out.sums.moment = s.x0 * out.sums.force[1] - s.y0 * out.sums.force[0];
  return out;
}

answer linear_once_more(const setting &s) {
  answer out;
  const double c = std::sqrt(s.a * s.b), g = steel.shear_modulus, phi = s.in.spin_creepage;
  const int way = s.in.direction;
  // as rolling along +x, and back
  const double xi = way * s.xi, turn = way * phi;
  const double fx = -g * c * c * s.k.c11 * xi;
  const double fy = -g * c * c * (s.k.c22 * s.eta + c * s.k.c23 * turn);
  const double mz = g * c * c * c * (s.k.c23 * s.eta - c * s.k.c33 * turn);
  out.friction = -(fx * xi + fy * s.eta + mz * turn);
  out.sums.force[0] = way * fx;
  out.sums.force[1] = fy;
  out.sums.moment = way * mz + s.x0 * fy - s.y0 * way * fx;
  out.converged = fx * fx + fy * fy <= s.capacity() * s.capacity();
  return out;
}

// --- comparison ------------------------------------------------------------------------------

answer solved(const setting &s) {
  answer out(s.c.g);
  fast_solver solver(steel, s.o, s.c.g.nx + 2, s.c.g.ny + 3);
  for (auto *v : {&out.px, &out.py, &out.sx, &out.sy}) std::fill(v->begin(), v->end(), 7.0);
  const tangential_result r = solver.solve(
      s.c.patch(s.mu), s.in,
      {out.px.data(), out.py.data(), out.sx.data(), out.sy.data(), out.division.data()}, out.sums);
  out.friction = r.friction;
  out.slip = r.slip;
  out.stick = r.stick;
  out.converged = r.converged;
  return out;
}

std::string name_of(const setting &s) {
  return s.c.name + " bound " + std::to_string(s.o.bound) + " blending " +
         std::to_string(s.o.blending) + " direction " + std::to_string(s.in.direction) + " xi " +
         std::to_string(s.in.creepage[0]) + " phi " + std::to_string(s.in.spin_creepage);
}

void expect_fields(const setting &s, const answer &wanted) {
  const answer found = solved(s);
  SCOPED_TRACE(name_of(s));
  double top = 0, slip = 0;
  for (double v : s.bound()) top = std::max(top, v);
  for (double v : wanted.sx) slip = std::max(slip, std::fabs(v));
  for (double v : wanted.sy) slip = std::max(slip, std::fabs(v));
  for (size_t i = 0; i < found.px.size(); ++i) {
    ASSERT_NEAR(found.px[i], wanted.px[i], rounded * top) << i;
    ASSERT_NEAR(found.py[i], wanted.py[i], rounded * top) << i;
    ASSERT_NEAR(found.sx[i], wanted.sx[i], rounded * slip) << i;
    ASSERT_NEAR(found.sy[i], wanted.sy[i], rounded * slip) << i;
    ASSERT_EQ(found.division[i], wanted.division[i]) << i;
  }
  EXPECT_EQ(found.slip, wanted.slip);
  EXPECT_EQ(found.stick, wanted.stick);
  EXPECT_TRUE(found.converged);
  const double power =
      s.capacity() * std::hypot(s.in.creepage[0], s.in.creepage[1], s.in.spin_creepage * 1e-2);
  EXPECT_NEAR(found.friction, wanted.friction, rounded * power);
}

TEST(FastTheories, FastsimStepByStep) {
  for (const contact &c : contacts())
    for (auto bound : {RP_BOUND_AUTOMATIC, RP_BOUND_ELLIPTIC, RP_BOUND_PARABOLIC})
      for (auto blending : {RP_BLENDING_SLIDING, RP_BLENDING_NONE, RP_BLENDING_CONTACT})
        for (double beta : {0.0, 0.7})
          for (const rolling_input &in : inputs()) {
            fast_options o;
            o.theory = RP_TANGENTIAL_FASTSIM;
            o.bound = bound;
            o.blending = blending;
            o.reduction = {0.8, 0.3, beta};
            o.coefficient_factor = 0.9;
            const setting s(c, o, in, 0.31);
            expect_fields(s, fastsim_once_more(s));
            if (HasFatalFailure()) return;
          }
}

TEST(FastTheories, FastripStripByStrip) {
  for (const contact &c : contacts()) {
    if (c.name == "lobes") continue;  // strips have no gaps
    for (auto blending : {RP_BLENDING_SLIDING, RP_BLENDING_NONE})
      for (const rolling_input &in : inputs()) {
        fast_options o;
        o.theory = RP_TANGENTIAL_FASTRIP;
        o.blending = blending;
        o.coefficient_factor = 0.9;
        const setting s(c, o, in, 0.31);
        expect_fields(s, fastrip_once_more(s));
        if (HasFatalFailure()) return;
      }
  }
}

void expect_sums(const setting &s, const answer &wanted) {
  const answer found = solved(s);
  SCOPED_TRACE(name_of(s));
  const double size = std::hypot(wanted.sums.force[0], wanted.sums.force[1]);
  for (int k : {0, 1}) EXPECT_NEAR(found.sums.force[k], wanted.sums.force[k], rounded * size) << k;
  EXPECT_NEAR(found.sums.moment, wanted.sums.moment,
              rounded * (std::fabs(wanted.sums.moment) + 1e-3 * size));
  EXPECT_NEAR(found.friction, wanted.friction, rounded * wanted.friction);
  EXPECT_EQ(found.sums.friction, found.friction);
  EXPECT_EQ(found.converged, wanted.converged);
}

TEST(FastTheories, PolachInClosedForm) {
  for (const contact &c : contacts())
    for (const rolling_input &in : inputs()) {
      fast_options o;
      o.theory = RP_TANGENTIAL_POLACH;
      o.polach = {0.7, 0.4};
      o.coefficient_factor = 0.9;
      const setting s(c, o, in, 0.31), smooth(c, o, in, 0.0);
      expect_sums(s, polach_once_more(s));
      expect_sums(smooth, polach_once_more(smooth));
    }
}

slip_velocity_law falling(rp_slip_law shape) {
  slip_velocity_law law;
  law.shape = shape;
  law.kinetic = 0.12;
  law.amplitude[0] = 0.25;
  law.halving_speed[0] = 0.02;
  return law;
}

TEST(FastTheories, FrictionFollowsTheRigidSlip) {
  int count = 0;
  for (const contact &c : contacts())
    for (rolling_input in : inputs()) {
      in.speed = 9.0;
      fast_options o;
      o.law = falling(static_cast<rp_slip_law>(count++ % 3));
      o.reduction = {0.8, 0.3, 0.7};
      for (auto blending : {RP_BLENDING_SLIDING, RP_BLENDING_CONTACT}) {
        o.blending = blending;
        const setting s(c, o, in, 0.9);
        expect_fields(s, fastsim_once_more(s));
        if (HasFatalFailure()) return;
      }
      o.blending = RP_BLENDING_SLIDING;
      o.theory = RP_TANGENTIAL_POLACH;
      const setting polach(c, o, in, 0.9);
      expect_sums(polach, polach_once_more(polach));
      if (c.name == "lobes") continue;
      o.theory = RP_TANGENTIAL_FASTRIP;
      const setting strips(c, o, in, 0.9);
      expect_fields(strips, fastrip_once_more(strips));
      if (HasFatalFailure()) return;
    }
}

TEST(FastTheories, LinearByItsCoefficients) {
  bool inside = false, beyond = false;
  for (const contact &c : contacts())
    for (const rolling_input &in : inputs()) {
      fast_options o;
      o.theory = RP_TANGENTIAL_LINEAR;
      o.coefficient_factor = 0.9;
      const setting s(c, o, in, 0.31);
      const answer wanted = linear_once_more(s);
      expect_sums(s, wanted);
      (wanted.converged ? inside : beyond) = true;
    }
  EXPECT_TRUE(inside && beyond);
}

TEST(FastTheories, WithoutFrictionThereIsNoTraction) {
  for (auto theory : {RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_FASTRIP})
    for (const contact &c : contacts())
      for (const rolling_input &in : inputs()) {
        fast_options o;
        o.theory = theory;
        const setting s(c, o, in, 0.0);
        // and all of the slip is rigid
        expect_fields(
            s, theory == RP_TANGENTIAL_FASTSIM ? fastsim_once_more(s) : fastrip_once_more(s));
        const answer found = solved(s);
        for (size_t i = 0; i < found.px.size(); ++i) {
          EXPECT_EQ(found.px[i], 0);
          EXPECT_EQ(found.py[i], 0);
        }
        EXPECT_TRUE(found.converged);
        EXPECT_EQ(found.friction, 0);
      }
}

// Creepages whose squares are beyond all numbers slide against themselves.
TEST(FastTheories, HugeCreepagesSlide) {
  const contact &c = contacts()[0];
  for (const auto &[xi, eta] : {std::array{1e200, 0.0}, {0.0, -1e200}, {3e200, 4e200}}) {
    fast_options o;
    rolling_input in;
    in.creepage[0] = xi;
    in.creepage[1] = eta;
    const setting s(c, o, in, 0.3);
    const answer found = solved(s);
    const std::vector<double> bound = s.bound();
    const double size = std::hypot(xi, eta);
    for (size_t i = 0; i < bound.size(); ++i) {
      EXPECT_NEAR(found.px[i], -bound[i] * (xi / size), rounded * bound[i]) << i;
      EXPECT_NEAR(found.py[i], -bound[i] * (eta / size), rounded * bound[i]) << i;
    }
  }
}

TEST(FastTheories, OutsideOfTheCoefficientsIsSaid) {
  for (double ratio : {1.0 / 30, 30.0}) {
    const contact c = ellipse("slender", 3e-3 * std::sqrt(ratio), 3e-3 / std::sqrt(ratio));
    for (auto theory : {RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_FASTRIP, RP_TANGENTIAL_POLACH}) {
      fast_options o;
      o.theory = theory;
      EXPECT_FALSE(solved(setting(c, o, inputs()[0], 0.3)).converged);
    }
  }
}

}  // namespace
