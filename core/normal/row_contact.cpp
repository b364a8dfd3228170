#include "normal/row_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "normal/row_curve.hpp"
#include "numeric/elementary.hpp"
#include "numeric/fade.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;

constexpr double curvature_reach = 0.2;  // of the width at half depth, see the header
constexpr double flattest_row = 0.1;     // of the mean curvature of the overlap
// of the depth: up to which height above the deepest place another one counts beside it, and how
// far above their neighbours rows still count as such places
constexpr double other_wells = 0.1, still_lowest = 0.01;
// of an ellipse's longest chord: the mean by the squared depth of the overlap
constexpr double mean_chord_of_ellipse = 75 * pi / 256;
// of an element squared: of half a chord that reaches an element's middle wherever it lies
constexpr double shortest_chord = 0.75 * 0.75;
constexpr double force_tolerance = 1e-12;
constexpr double least_depth = 1e-100;  // m
constexpr int max_evaluations = 100;

size_t at(int j) { return static_cast<size_t>(j); }

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

// The deepest places of a group, where Kik and Piotrowski ask for the displacement. There is one
// but on worn shapes, and next to the deepest row: by weights others come in and out without a
// jump.
struct row_contact::deepest_places {
  double y, curvature;  // weighted means
  double sum;           // of the weights
};

// How the contact of Kik-Piotrowski comes from the overlap of the undeformed bodies.
struct row_contact::overlap {
  double share;     // -, depth of the overlap over the interpenetration
  double stretch2;  // -, squared stretch along rolling; across it is the inverse
};

row_contact::row_contact(rp_normal_method method, double modulus, int max_ny)
    : method_(method), modulus_(modulus) {
  for (auto *b : {&vertex_, &lowest_, &curvature_, &stretched_, &chord_, &load_, &mean_chord_,
                  &centre_, &weight_})
    *b = aligned_buffer<double>(at(max_ny));
  chords_ = aligned_buffer<quadratic>(at(max_ny));
}

size_t row_contact::bytes() const { return hertz_.bytes() + 9 * vertex_.bytes() + chords_.bytes(); }

double row_contact::leading_edge(int row, int direction) const {
  return vertex_[at(row)] + direction * std::sqrt(chord_[at(row)]);
}

// Through three points of a row, `reach` elements apart, about element i.
row_contact::row_parabola row_contact::parabola_of(const grid &g, const double *row, int i,
                                                   int reach) {
  const double length = reach * g.dx, flattest = 1e-9 / (g.nx * g.dx);
  const double rise = 0.5 * (row[i + reach] - row[i - reach]) / length;
  const double bend = 0.5 * (row[i + reach] - 2 * row[i] + row[i - reach]) / (length * length);
  const double a = std::max(bend, flattest);
  const double shift = std::clamp(-0.5 * rise / a, -g.nx * g.dx, g.nx * g.dx);
  return {g.x(i) + shift, row[i] + (rise + a * shift) * shift, a};
}

// About a row's lowest element, and about the lower one beside it, by half where both are as low:
// so nothing depends on which of them is found first.
row_contact::row_parabola row_contact::measure_row(const grid &g, const double *row, int reach) {
  const int least = static_cast<int>(std::min_element(row, row + g.nx) - row);
  const int low = std::max(least - 1, 0), high = std::min(least + 1, g.nx - 1);
  const int other = low < least && (high == least || row[low] < row[high]) ? low : high;
  const auto about = [&](int i) {
    return parabola_of(g, row, std::clamp(i, reach, g.nx - 1 - reach), reach);
  };
  const row_parabola p = about(least);
  const double between = 0.9 * p.curvature * g.dx * g.dx;
  const double share = 0.5 * fade((row[other] - row[least]) / between);
  return share > 0 ? p.towards(about(other), share) : p;
}

// With parabolas of both whole numbers of elements beside the reach.
void row_contact::measure_rows(const grid &g, const double *h, double reach) {
  const int whole = static_cast<int>(reach);
  const double share = 1 - fade(reach - whole);
  for (int j = 0; j < g.ny; ++j) {
    const double *row = h + j * g.nx;
    row_parabola p = measure_row(g, row, whole);
    if (share > 0) p = p.towards(measure_row(g, row, whole + 1), share);
    vertex_[at(j)] = p.vertex;
    lowest_[at(j)] = p.lowest;
    curvature_[at(j)] = p.curvature;
  }
}

// Elements from the vertex to about the edge of contact: of all rows, weighted with their depth
// squared, so that it does not jump where another place becomes the deepest.
double row_contact::find_reach(const grid &g, double approach) const {
  double sum = 0, chords = 0;
  for (int j = 0; j < g.ny; ++j) {
    const double depth = std::max(0.0, approach - lowest_[at(j)]), weight = depth * depth;
    sum += weight;
    chords += weight * std::sqrt(0.5 * depth / curvature_[at(j)]);
  }
  const double elements = sum > 0 ? chords / (mean_chord_of_ellipse * sum * g.dx) : 0.0;
  const int most = (g.nx - 1) / 2;
  return elements > 1 ? std::min(elements, 1.0 * most) : 1.0;
}

// Of rows [begin, end) with half a row beyond, on the curve of value_at: the depth does not jump
// when another row becomes the lowest.
row_contact::deepest_point row_contact::find_deepest(const grid &g, int begin, int end) const {
  const double *f = lowest_.data();
  deepest_point deep{g.y(begin), f[begin], 0.0, begin};
  for (int j = std::max(begin - 1, 0); j < std::min(end, g.ny - 1); ++j) {
    double value = 0;
    const double t = lowest_between(f, g, j, j < begin ? 0.5 : 0.0, j + 1 < end ? 1.0 : 0.5, value);
    if (value < deep.lowest)
      deep = {g.y(j) + t * g.dy, value, 0.0, std::clamp(t > 0.5 ? j + 1 : j, begin, end - 1)};
  }
  return deep;
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
  // the parabolas reach as far as contact does, which for other shapes than parabolas matters; not
  // by where the search begins, so that an earlier step does not matter
  double reach = 1;
  measure_rows(g, h, reach);
  for (int pass = 0; pass < 3; ++pass) {
    if (load.force_given) approach = guess_approach(g, load.force);
    const double next = find_reach(g, approach);
    if (next == reach) break;
    measure_rows(g, h, reach = next);
  }
  result.converged = true;
  if (load.force_given) {
    const double first = load.first_approach > 0 ? load.first_approach : approach;
    approach = search(g, load, first, parts, result);
  }
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
  for (auto *b : {&load_, &mean_chord_, &centre_}) std::fill_n(b->data(), at(g.ny), 0.0);
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
void row_contact::add_row(const grid &g, int row, const strip &s, const quadratic &chord,
                          const quadratic &f, double depth, double factor, totals &way) {
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
  const auto squares = [](double, double squared) { return squared; };
  mean_chord_[at(row)] += way.weight * s.integral(squares) / g.dy;
  centre_[at(row)] += way.weight * 0.5 * pi * factor *
                      s.integral([](double t, double squared) { return t * squared; });
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
    if (!s.empty()) add_row(g, j, s, chord, f, deep.depth, factor, way);
  }
}

// Hertz's ellipse whose undeformed bodies overlap over the same length and width at a depth:
// Hertz's a/b = sqrt(B/A edge_along/edge_across) against L/W = sqrt(B/A).
hertz_ratios::values row_contact::ellipse_of_overlap(const grid &g, const deepest_point &deep,
                                                     double curvature, int begin, int end,
                                                     double depth) const {
  double longest = depth / curvature;
  for (int j = begin; j < end; ++j)
    longest = std::max(longest, (depth + deep.lowest - lowest_[at(j)]) / curvature_[at(j)]);
  const double width = overlap_width(g, deep.lowest + depth, begin, end);
  return hertz_.at(width * width, 4 * longest);
}

row_contact::overlap row_contact::overlap_of(const grid &g, const deepest_point &deep,
                                             double curvature, int begin, int end) const {
  overlap o{virtual_interpenetration, 1.0};
  hertz_ratios::values hz{};
  if (method_ == RP_NORMAL_KIK_PIOTROWSKI_CORRECTED) {
    // of a circle, then of what was found
    o.share = 0.5;
    for (int pass = 0; pass < 2; ++pass) {
      hz = ellipse_of_overlap(g, deep, curvature, begin, end, o.share * deep.depth);
      o.share = std::sqrt(hz.edge_along * hz.edge_across);
    }
  } else {
    hz = ellipse_of_overlap(g, deep, curvature, begin, end, o.share * deep.depth);
  }
  o.stretch2 = std::sqrt(hz.edge_along / hz.edge_across);
  return o;
}

// Where row j is lowest within its strip, from its middle.
double row_contact::lowest_in_strip(const grid &g, int j, double flattest) const {
  const quadratic f = through(lowest_.data(), g, j);
  return std::clamp(-0.5 * f.c1 / std::max(f.c2, flattest), -0.5 * g.dy, 0.5 * g.dy);
}

// Fills weight_.
row_contact::deepest_places row_contact::find_places(const grid &g, const deepest_point &deep,
                                                     int begin, int end, double flattest) {
  constexpr int neighbours = 3;
  const double *f = lowest_.data(), *last = f + end;
  const double least = *std::min_element(f + begin, last);
  deepest_places places{};
  for (int j = begin; j < end; ++j) {
    const double low = *std::min_element(f + std::max(j - neighbours, begin),
                                         f + std::min(j + neighbours + 1, end));
    const double weight = fade((f[j] - least) / (other_wells * deep.depth)) *
                          fade((f[j] - low) / (still_lowest * deep.depth));
    weight_[at(j)] = weight;
    if (!(weight > 0)) continue;
    places.y += weight * (g.y(j) + lowest_in_strip(g, j, flattest));
    places.curvature += weight * curvature_[at(j)];
    places.sum += weight;
  }
  places.y /= places.sum;
  places.curvature /= places.sum;
  return places;
}

// Displacement at a place in row `of` for a factor 1, times pi E*; its logarithm there, of chords
// 2 l0, is integrated apart.
double row_contact::displacement_at(const grid &g, const quadratic *chords, double place, int of,
                                    int begin, int end) const {
  const double l0 = std::sqrt(std::max(0.0, chords[of].at(place - g.y(of))));
  double displacement = 0;
  for (int j = begin; j < end; ++j) {
    const strip s(chords[j], g.dy);
    if (s.empty()) continue;
    const double y = g.y(j) - place, x = vertex_[at(j)] - vertex_[at(of)];
    if (!(l0 > 0)) {
      displacement += s.integral(
          [&](double t, double squared) { return row_potential(squared, hypot(y + t, x)); });
      continue;
    }
    displacement += s.integral([&](double t, double squared) {
      const double lateral = std::max(std::abs(y + t), 1e-12 * l0);
      return row_potential(squared, hypot(lateral, x)) + 2 * l0 * log(lateral / l0);
    });
    displacement -= 2 * l0 * (s.log_integral(y) - s.width() * log(l0));
  }
  return displacement;
}

void row_contact::kik_piotrowski(const grid &g, const deepest_point &deep, int begin, int end,
                                 totals &way) {
  const double span = overlap_width(g, deep.lowest + deep.depth, begin, end);
  const double flattest = flattest_row * 4 * deep.depth / (span * span);
  const deepest_places places = find_places(g, deep, begin, end, flattest);
  const overlap o = overlap_of(g, deep, places.curvature, begin, end);
  const double depth = o.share * deep.depth;
  const double stretch2 = o.stretch2, stretch = std::sqrt(stretch2);
  const double first = g.y(begin) - 0.5 * g.dy, last = g.y(end - 1) + 0.5 * g.dy;
  for (int j = 0; j < g.ny; ++j) {
    const double y = std::clamp(places.y + (g.y(j) - places.y) * stretch, first, last);
    // never beyond the overlap of the undeformed bodies
    stretched_[at(j)] = std::max(value_at(lowest_.data(), g, y),
                                 deep.lowest + o.share * (lowest_[at(j)] - deep.lowest));
  }
  for (int j = begin; j < end; ++j) {
    const quadratic f = through(stretched_.data(), g, j) - deep.lowest;
    chords_[at(j)] = (f * -1 + depth) * (stretch2 / curvature_[at(j)]);
  }
  // the displacement that is asked for over that of a factor 1
  double wanted = 0, displacement = 0;
  for (int j = begin; j < end; ++j) {
    const double weight = weight_[at(j)];
    if (!(weight > 0)) continue;
    const double t = lowest_in_strip(g, j, flattest);
    displacement += weight * displacement_at(g, chords_.data(), g.y(j) + t, j, begin, end);
    const double above = through(lowest_.data(), g, j).at(t) - deep.lowest;
    wanted += weight * (deep.depth - std::max(above, 0.0));
  }
  if (!(displacement > 0)) return;
  const double factor = pi * modulus_ * wanted / displacement;
  way.max_pressure =
      std::max(way.max_pressure, factor * std::sqrt(stretch2 * depth / places.curvature));
  for (int j = begin; j < end; ++j) {
    const quadratic &q = chords_[at(j)];
    const strip s(q, g.dy);
    if (!s.empty())
      add_row(g, j, s, q, through(lowest_.data(), g, j) - deep.lowest, deep.depth, factor, way);
  }
}

// A load at a row's vertex.
void row_contact::add_point(const grid &g, int row, double load, double *pressure) const {
  const between at_vertex = elements_at((vertex_[at(row)] - g.x0) / g.dx, g.nx);
  double *to = pressure + row * g.nx + at_vertex.first;
  to[0] += (1 - at_vertex.share) * load;
  to[1] += at_vertex.share * load;
}

// What rows carry: a strip whose middle is at the end of contact, or outside, gives part of its
// load to the row that the middle of its load is nearer to, so that the load stays where it is.
void row_contact::share_loads(const grid &g) {
  double *to = weight_.data();
  std::fill_n(to, g.ny, 0.0);
  for (int j = 0; j < g.ny; ++j) {
    const double load = load_[at(j)];
    if (!(load > 0)) continue;
    const double place = centre_[at(j)] / (load * g.dy);  // of the load, in strips from the middle
    const int beside = std::clamp(place > 0 ? j + 1 : j - 1, 1, std::max(g.ny - 2, 1));
    const bool margin = j != std::clamp(j, 1, std::max(g.ny - 2, 1));
    const double outside = fade(chord_[at(j)] / mean_chord_[at(j)]);
    const double given = outside * (margin ? 1.0 : std::min(std::abs(place), 0.5));
    to[j] += (1 - given) * load;
    to[beside] += given * load;
  }
}

// Each row's elements carry the row's load, in the shape of its pressure at their centres; the
// chord is taken as long as reaches the elements about its vertex.
void row_contact::sample(const grid &g, double force, double *pressure,
                         row_contact_result &result) {
  std::fill_n(pressure, g.count(), 0.0);
  share_loads(g);
  double sum = 0;
  for (int j = 0; j < g.ny; ++j) {
    const double load = weight_[at(j)];
    if (!(load > 0)) continue;
    const double squared = std::max(chord_[at(j)], shortest_chord * g.dx * g.dx);
    double *row = pressure + j * g.nx, total = 0;
    for (int i = 0; i < g.nx; ++i) {
      const double x = g.x(i) - vertex_[at(j)];
      row[i] = std::sqrt(std::max(0.0, squared - x * x));
      total += row[i];
    }
    for (int i = 0; i < g.nx && total > 0; ++i) row[i] *= load / total;
    if (!(total > 0)) add_point(g, j, load, pressure);
    chord_[at(j)] = squared;
    sum += load;
  }
  if (!(sum > 0) && force > 0) {
    // contact between the middles of two rows
    const between rows = elements_at((find_deepest(g, 0, g.ny).y - g.y0) / g.dy, g.ny);
    add_point(g, rows.first, 1 - rows.share, pressure);
    add_point(g, rows.first + 1, rows.share, pressure);
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
