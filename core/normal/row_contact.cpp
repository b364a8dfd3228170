#include "normal/row_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;

constexpr double curvature_reach = 0.2;  // of the width at half depth, see the header
constexpr double flattest_row = 0.1;     // of the mean curvature of the overlap
constexpr double force_tolerance = 1e-12;
constexpr double least_depth = 1e-100;  // m
constexpr int max_evaluations = 100;

size_t at(int j) { return static_cast<size_t>(j); }

// A rounded number within bounds; the lower one for what is no number.
int index(double value, int low, int high) {
  const double rounded = std::round(value);
  return rounded > low ? static_cast<int>(std::min(rounded, static_cast<double>(high))) : low;
}

// A place among n > 1 elements: between `first` and the next one, to which its share is due. What
// is put there in these parts has its centre there, so it moves evenly and has no side of its own.
struct between {
  int first;
  double share;
};

between elements_at(double place, int n) {
  const double inside = place > 0 ? std::min(place, n - 1.0) : 0.0;
  const int first = std::min(static_cast<int>(inside), n - 2);
  return {first, inside - first};
}

// The parabola through three rows as a function of y - y(j).
quadratic through(const double *f, const grid &g, int j) {
  const int m = std::clamp(j, 1, g.ny - 2);
  const double rise = (f[m + 1] - f[m - 1]) / (2 * g.dy);
  const double bend = (f[m + 1] - 2 * f[m] + f[m - 1]) / (2 * g.dy * g.dy);
  const double t = (j - m) * g.dy;
  return {f[j], rise + 2 * bend * t, bend};
}

double value_at(const double *f, const grid &g, double y) {
  const int j = index((y - g.y0) / g.dy, 0, g.ny - 1);
  return through(f, g, j).at(y - g.y(j));
}

// Half the second derivative, as seen over a distance to both sides.
double mean_curvature(const double *f, const grid &g, int j, double reach) {
  const double y = g.y(j);
  return 0.5 * (value_at(f, g, y + reach) - 2 * f[j] + value_at(f, g, y - reach)) / (reach * reach);
}

}  // namespace

struct row_contact::totals {
  double force = 0, area = 0, width = 0, energy = 0, max_pressure = 0;
  double weight = 0;  // of this way of taking parts together
};

struct row_contact::deepest_point {
  double y, lowest;  // m
  double depth;      // m, interpenetration
  int row;           // nearest
};

// How the contact of Kik-Piotrowski comes from the overlap of the undeformed bodies.
struct row_contact::overlap {
  double share;     // -, depth of the overlap over the interpenetration
  double stretch2;  // -, squared stretch along rolling; across it is the inverse
};

row_contact::row_contact(rp_normal_method method, double modulus, int max_ny)
    : method_(method), modulus_(modulus) {
  for (auto *b : {&vertex_, &lowest_, &curvature_, &stretched_, &chord_, &load_})
    *b = aligned_buffer<double>(at(max_ny));
}

size_t row_contact::bytes() const { return hertz_.bytes() + 6 * vertex_.bytes(); }

double row_contact::leading_edge(int row, int direction) const {
  return vertex_[at(row)] + direction * std::sqrt(chord_[at(row)]);
}

// The parabola through three points of each row, `reach` elements apart, about its lowest element.
void row_contact::measure_rows(const grid &g, const double *h, int reach) {
  const double length = reach * g.dx, flattest = 1e-9 / (g.nx * g.dx);
  for (int j = 0; j < g.ny; ++j) {
    const double *row = h + j * g.nx;
    const int least = static_cast<int>(std::min_element(row, row + g.nx) - row);
    const int i = std::clamp(least, reach, g.nx - 1 - reach);
    const double rise = 0.5 * (row[i + reach] - row[i - reach]) / length;
    const double bend = 0.5 * (row[i + reach] - 2 * row[i] + row[i - reach]) / (length * length);
    const double a = std::max(bend, flattest);
    const double shift = std::clamp(-0.5 * rise / a, -g.nx * g.dx, g.nx * g.dx);
    vertex_[at(j)] = g.x(i) + shift;
    lowest_[at(j)] = row[i] + (rise + a * shift) * shift;
    curvature_[at(j)] = a;
  }
}

// Elements from the vertex of the deepest row to about the edge of contact.
int row_contact::find_reach(const grid &g, double approach) const {
  const deepest_point deep = find_deepest(g, 0, g.ny);
  const double depth = approach - deep.lowest;
  const double chord = std::sqrt(std::max(0.0, 0.5 * depth / curvature_[at(deep.row)]));
  return index(chord / g.dx, 1, (g.nx - 1) / 2);
}

row_contact::deepest_point row_contact::find_deepest(const grid &g, int begin, int end) const {
  const double *f = lowest_.data();
  const int j = static_cast<int>(std::min_element(f + begin, f + end) - f);
  const quadratic q = through(f, g, j);
  const double t = q.c2 > 0 ? std::clamp(-0.5 * q.c1 / q.c2, -0.5 * g.dy, 0.5 * g.dy) : 0.0;
  return {g.y(j) + t, std::min(q.at(t), f[j]), 0.0, j};
}

// Lateral width of where the rows lie below a level.
double row_contact::overlap_width(const grid &g, double level, int begin, int end) const {
  double width = 0;
  for (int j = begin; j < end; ++j)
    width += strip(through(lowest_.data(), g, j) * -1 + level, g.dy).width();
  return width;
}

// Approach at which the Hertzian contact of the deepest point's curvatures carries the force.
double row_contact::guess_approach(const grid &g, double force) const {
  const deepest_point deep = find_deepest(g, 0, g.ny);
  const double a = curvature_[at(deep.row)];
  const double b = std::max(through(lowest_.data(), g, deep.row).c2, 0.01 * a);
  const hertz_ratios::values hz = hertz_.at(a, b);
  // at depth 1: F = 2/3 pi a b p0, and F grows with depth^1.5
  const double size = hz.edge_along / a * std::sqrt(hz.edge_across / b);
  const double unit = 2.0 / 3.0 * pi * modulus_ * a * hz.pressure * size;
  return deep.lowest + pow(force / unit, 2.0 / 3.0);
}

row_contact_result row_contact::solve(const grid &g, const double *h, const row_contact_load &load,
                                      const contact_parts &parts, double *pressure) {
  row_contact_result result;
  double approach = load.approach;
  // the parabolas reach as far as contact does, which for other shapes than parabolas matters
  int reach = 1;
  measure_rows(g, h, reach);
  for (int pass = 0; pass < 3; ++pass) {
    if (load.force_given)
      approach = load.first_approach > 0 ? load.first_approach : guess_approach(g, load.force);
    const int next = find_reach(g, approach);
    if (next == reach) break;
    measure_rows(g, h, reach = next);
  }
  result.converged = true;
  if (load.force_given) approach = search(g, load, approach, parts, result);
  const totals sum = evaluate(g, approach, parts);
  result.converged = result.converged && std::isfinite(sum.force);
  result.approach = approach;
  result.normal_force = load.force_given && result.converged ? load.force : sum.force;
  result.max_pressure = sum.max_pressure;
  result.contact_area = sum.area;
  width_ = sum.width;
  result.elastic_energy = sum.energy;
  sample(g, result.normal_force, pressure, result);
  return result;
}

// Newton's method in the logarithms of force and depth, with slopes by differences, in a bracket.
double row_contact::search(const grid &g, const row_contact_load &load, double first,
                           const contact_parts &parts, row_contact_result &result) {
  const double lowest = find_deepest(g, 0, g.ny).lowest;
  double t = log(std::max(first - lowest, least_depth)), lower = -1e3, upper = 1e3;
  double best = t, last = t, last_error = 0, slope = 1.5;
  result.residual = HUGE_VAL;
  while (result.iterations < max_evaluations) {
    const double ratio = evaluate(g, lowest + exp(t), parts).force / load.force;
    ++result.iterations;
    if (std::abs(ratio - 1) < result.residual) {
      result.residual = std::abs(ratio - 1);
      best = t;
    }
    const double error = log(std::max(ratio, 1e-300));
    (error < 0 ? lower : upper) = t;
    if (result.residual <= force_tolerance || upper - lower < 1e-15 * std::abs(t)) break;
    if (t != last) slope = std::clamp((error - last_error) / (t - last), 0.5, 20.0);
    last = t;
    last_error = error;
    t -= std::clamp(error / slope, -3.0, 3.0);
    if (!(t > lower && t < upper)) t = 0.5 * (lower + upper);
  }
  // a closed bracket leaves what rounding of the approach leaves
  result.converged = result.residual <= 1e-9;
  return lowest + exp(best);
}

// All ways of taking neighbouring parts together or apart, weighted.
row_contact::totals row_contact::evaluate(const grid &g, double approach,
                                          const contact_parts &parts) {
  totals sum;
  std::fill_n(chord_.data(), at(g.ny), 0.0);
  std::fill_n(load_.data(), at(g.ny), 0.0);
  const int cuts = parts.count - 1;
  for (unsigned apart = 0; apart < 1U << cuts; ++apart) {
    totals way;
    way.weight = 1;
    for (int k = 0; k < cuts; ++k)
      way.weight *= (apart >> k & 1U) != 0 ? 1 - parts.factor[k] : parts.factor[k];
    if (!(way.weight > 0)) continue;
    for (int k = 0, begin = 0; k <= cuts; ++k) {
      if (k < cuts && (apart >> k & 1U) == 0) continue;
      const int end = k < cuts ? parts.first_row[k + 1] : g.ny;
      if (end > begin) evaluate_group(g, approach, begin, end, way);
      begin = end;
    }
    sum.force += way.weight * way.force;
    sum.area += way.weight * way.area;
    sum.width += way.weight * way.width;
    sum.energy += way.weight * way.energy;
    sum.max_pressure += way.weight * way.max_pressure;
  }
  return sum;
}

void row_contact::evaluate_group(const grid &g, double approach, int begin, int end, totals &way) {
  deepest_point deep = find_deepest(g, begin, end);
  deep.depth = approach - deep.lowest;
  if (!(deep.depth > 0)) return;
  method_ == RP_NORMAL_ANALYN ? analyn(g, deep, begin, end, way)
                              : kik_piotrowski(g, deep, begin, end, way);
}

// One row of contact with p = factor sqrt(l^2 - x^2); f: its lowest distance above the deepest.
void row_contact::add_row(int row, const strip &s, const quadratic &chord, const quadratic &f,
                          double depth, double factor, totals &way) {
  const double a = curvature_[at(row)], l2 = std::max(0.0, chord.c0);
  const double load =
      0.5 * pi * factor * s.integral([](double, double squared) { return squared; });
  way.force += load;
  way.area += 2 * s.integral([](double, double squared) { return std::sqrt(squared); });
  way.width += s.width();
  // 1/2 int p (depth - f - A x^2), where int x^2 sqrt(l^2 - x^2) dx = pi l^4/8
  way.energy += 0.25 * pi * factor * s.integral([&](double t, double squared) {
    return squared * (depth - f.at(t) - 0.25 * a * squared);
  });
  way.max_pressure = std::max(way.max_pressure, factor * std::sqrt(l2));
  chord_[at(row)] += way.weight * l2;
  load_[at(row)] += way.weight * load;
}

void row_contact::analyn(const grid &g, const deepest_point &deep, int begin, int end,
                         totals &way) {
  const double width = overlap_width(g, deep.lowest + 0.5 * deep.depth, begin, end);
  const double flattest = flattest_row * 2 * deep.depth / (width * width);
  const double reach = std::max(curvature_reach * width, g.dy);
  for (int j = begin; j < end; ++j) {
    const quadratic f = through(lowest_.data(), g, j) - deep.lowest;
    const double a = curvature_[at(j)];
    const double b = mean_curvature(lowest_.data(), g, j, reach);
    const hertz_ratios::values hz = hertz_.at(a, std::max(b, flattest));
    const double scale = hz.edge_along / a, factor = modulus_ * a * hz.pressure;
    const quadratic chord = (f * (-1 / hz.edge_across) + deep.depth) * scale;
    const strip s(chord, g.dy);
    if (j == deep.row)
      way.max_pressure = std::max(way.max_pressure, factor * std::sqrt(scale * deep.depth));
    if (!s.empty()) add_row(j, s, chord, f, deep.depth, factor, way);
  }
}

// Hertz's ellipse whose undeformed bodies overlap over the same length and width at a depth:
// Hertz's a/b = sqrt(B/A edge_along/edge_across) against L/W = sqrt(B/A).
hertz_ratios::values row_contact::ellipse_of_overlap(const grid &g, const deepest_point &deep,
                                                     int begin, int end, double depth) const {
  double longest = depth / curvature_[at(deep.row)];
  for (int j = begin; j < end; ++j)
    longest = std::max(longest, (depth + deep.lowest - lowest_[at(j)]) / curvature_[at(j)]);
  const double width = overlap_width(g, deep.lowest + depth, begin, end);
  return hertz_.at(width * width, 4 * longest);
}

row_contact::overlap row_contact::overlap_of(const grid &g, const deepest_point &deep, int begin,
                                             int end) const {
  overlap o{virtual_interpenetration, 1.0};
  hertz_ratios::values hz{};
  if (method_ == RP_NORMAL_KIK_PIOTROWSKI_CORRECTED) {
    // of a circle, then of what was found
    o.share = 0.5;
    for (int pass = 0; pass < 2; ++pass) {
      hz = ellipse_of_overlap(g, deep, begin, end, o.share * deep.depth);
      o.share = std::sqrt(hz.edge_along * hz.edge_across);
    }
  } else {
    hz = ellipse_of_overlap(g, deep, begin, end, o.share * deep.depth);
  }
  o.stretch2 = std::sqrt(hz.edge_along / hz.edge_across);
  return o;
}

void row_contact::kik_piotrowski(const grid &g, const deepest_point &deep, int begin, int end,
                                 totals &way) {
  const overlap o = overlap_of(g, deep, begin, end);
  const double depth = o.share * deep.depth;
  const double stretch2 = o.stretch2, stretch = std::sqrt(stretch2);
  const double first = g.y(begin) - 0.5 * g.dy, last = g.y(end - 1) + 0.5 * g.dy;
  for (int j = 0; j < g.ny; ++j) {
    const double y = std::clamp(deep.y + (g.y(j) - deep.y) * stretch, first, last);
    // never beyond the overlap of the undeformed bodies
    stretched_[at(j)] = std::max(value_at(lowest_.data(), g, y),
                                 deep.lowest + o.share * (lowest_[at(j)] - deep.lowest));
  }
  const auto chord = [&](int j) {
    const quadratic f = through(stretched_.data(), g, j) - deep.lowest;
    return (f * -1 + depth) * (stretch2 / curvature_[at(j)]);
  };
  // displacement at the deepest point for a factor 1, times pi E*; its logarithm there is
  // integrated apart
  const double l0 = std::sqrt(stretch2 * depth / curvature_[at(deep.row)]);
  double displacement = 0;
  for (int j = begin; j < end; ++j) {
    const strip s(chord(j), g.dy);
    if (s.empty()) continue;
    const double y = g.y(j) - deep.y, x = vertex_[at(j)] - vertex_[at(deep.row)];
    displacement += s.integral([&](double t, double squared) {
      const double lateral = std::max(std::abs(y + t), 1e-12 * l0);
      return row_potential(squared, hypot(lateral, x)) + 2 * l0 * log(lateral / l0);
    });
    displacement -= 2 * l0 * (s.log_integral(y) - s.width() * log(l0));
  }
  if (!(displacement > 0)) return;
  const double factor = pi * modulus_ * deep.depth / displacement;
  way.max_pressure = std::max(way.max_pressure, factor * l0);
  for (int j = begin; j < end; ++j) {
    const quadratic q = chord(j);
    const strip s(q, g.dy);
    if (!s.empty())
      add_row(j, s, q, through(lowest_.data(), g, j) - deep.lowest, deep.depth, factor, way);
  }
}

// A load at a row's vertex.
void row_contact::set_point(const grid &g, int row, double load, double *pressure) const {
  const between at_vertex = elements_at((vertex_[at(row)] - g.x0) / g.dx, g.nx);
  double *to = pressure + row * g.nx + at_vertex.first;
  to[0] = (1 - at_vertex.share) * load;
  to[1] = at_vertex.share * load;
}

// Each row's elements carry the row's load, in the shape of its pressure at their centres; what
// lies in strips whose middle is not in contact is shared by all.
void row_contact::sample(const grid &g, double force, double *pressure,
                         row_contact_result &result) const {
  std::fill_n(pressure, g.count(), 0.0);
  double sum = 0;
  for (int j = 0; j < g.ny; ++j) {
    if (!(chord_[at(j)] > 0)) continue;
    double *row = pressure + j * g.nx, total = 0;
    for (int i = 0; i < g.nx; ++i) {
      const double x = g.x(i) - vertex_[at(j)];
      row[i] = std::sqrt(std::max(0.0, chord_[at(j)] - x * x));
      total += row[i];
    }
    if (!(total > 0)) {
      set_point(g, j, 1.0, pressure);
      total = 1;
    }
    for (int i = 0; i < g.nx; ++i) row[i] *= load_[at(j)] / total;
    sum += load_[at(j)];
  }
  if (!(sum > 0) && force > 0) {
    // contact between the middles of two rows
    const between rows = elements_at((find_deepest(g, 0, g.ny).y - g.y0) / g.dy, g.ny);
    set_point(g, rows.first, 1 - rows.share, pressure);
    set_point(g, rows.first + 1, rows.share, pressure);
    sum = 1;
  }
  for (int i = 0; i < g.count() && sum > 0; ++i) pressure[i] *= force / (sum * g.dx * g.dy);
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const bool edge = i == 0 || i == g.nx - 1 || j == 0 || j == g.ny - 1;
      result.touches_border |= edge && pressure[j * g.nx + i] > 0;
    }
}

}  // namespace railpatch
