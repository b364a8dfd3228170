// Kik-Piotrowski and ANALYN told anew from their equations: integrals over strips by midpoints,
// rows of any curvature and place, a ridge on one side, contact areas apart and together.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "normal/hertz.hpp"
#include "normal/row_contact.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;
constexpr double modulus = 1.14e11;
// Gauss's rules on strips of which some end within the row: root and logarithm, see
// test_row_contact
constexpr double strips = 2e-3;
constexpr int fine = 400;  // midpoints in a row

// made once
const hertz_ratios &table() {
  static const hertz_ratios ratios;
  return ratios;
}

size_t at(int j) { return static_cast<size_t>(j); }
struct surface {
  std::string name;
  grid g;
  std::vector<double> h;
};

// Rows that are parabolas: vertex, curvature and lowest distance by y.
template <class V, class A, class F>
surface parabolas(const char *name, grid g, V &&vertex, A &&curvature, F &&lowest) {
  surface s{name, g, {}};
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double y = g.y(j), x = g.x(i) - vertex(y);
      s.h.push_back(curvature(y) * x * x + lowest(y));
    }
  return s;
}

std::vector<surface> surfaces() {
  const grid g{41, 30, 4e-4, 5e-4, -8.1e-3, -7.4e-3};
  std::vector<surface> all;
  all.push_back(parabolas(
      "cubic", g, [](double y) { return 2e-4 + 0.1 * y; }, [](double y) { return 1.1 + 30 * y; },
      [](double y) { return 1e-5 + 1.7 * y * y + 60 * y * y * y; }));
  all.push_back(parabolas(
      "ridges", g, [](double y) { return 0.05 * y; }, [](double y) { return 0.9 - 20 * y; },
      [](double y) {
        const double l = y + 4.2e-3, r = y - 3.1e-3;
        return std::min(2.5 * l * l, 4 * r * r + 4e-6);
      }));
  // no parabolas along rolling
  surface flat = parabolas(
      "quartic", g, [](double) { return 1e-4; }, [](double) { return 0.3; },
      [](double y) { return 1.2 * y * y; });
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) flat.h[at(j * g.nx + i)] += 4e4 * std::pow(g.x(i), 4);
  all.push_back(flat);
  return all;
}

struct sums {
  double force = 0, area = 0, width = 0, energy = 0, peak = 0;
};
struct once_more {
  const surface &s;
  rp_normal_method method;
  std::vector<double> vertex, lowest, curvature, chord, load, mean_chord, moment;
  const hertz_ratios &ratios = table();

  once_more(const surface &of, rp_normal_method m, double approach) : s(of), method(m) {
    chord.resize(at(s.g.ny));
    load = mean_chord = moment = chord;
    measure(1);
    for (int pass = 0; pass < 3; ++pass) {
      // about the edge of contact, where an overlap half as deep ends: the rows' mean by their
      // squared depth, over that of an ellipse, int (1 - u^2)^(5/2) du / int (1 - u^2)^2 du on [0,
      // 1]
      double edges = 0, weights = 0;
      for (int j = 0; j < s.g.ny; ++j) {
        const double deep = approach - lowest[at(j)];
        if (deep <= 0) continue;
        weights += std::pow(deep, 2);
        edges += std::pow(deep, 2.5) / std::sqrt(2 * curvature[at(j)]);
      }
      const double ellipse = (5 * pi / 32) / (8.0 / 15);
      measure(std::clamp(edges / weights / ellipse / s.g.dx, 1.0, std::floor((s.g.nx - 1) / 2.0)));
    }
  }
  void measure(double reach) {
    vertex.clear();
    lowest.clear();
    curvature.clear();
    const int shorter = static_cast<int>(std::floor(reach));
    const double by = 1 - step(reach - shorter);
    for (int j = 0; j < s.g.ny; ++j) {
      std::array<double, 3> p = about_lowest(j, shorter);
      // the longer one may end beyond the grid where it does not count
      if (by > 0) {
        const std::array<double, 3> longer = about_lowest(j, shorter + 1);
        for (size_t k = 0; k < 3; ++k) p[k] = (1 - by) * p[k] + by * longer[k];
      }
      curvature.push_back(p[0]);
      vertex.push_back(p[1]);
      lowest.push_back(p[2]);
    }
  }
  std::array<double, 3> about_lowest(int j, int reach) const {
    int least = 0;
    for (int i = 0; i < s.g.nx; ++i)
      if (height(i, j) < height(least, j)) least = i;
    const std::array<double, 3> one = about(least, j, reach);
    const int beside = height(least - 1, j) < height(least + 1, j) ? least - 1 : least + 1;
    const std::array<double, 3> other = about(beside, j, reach);
    const double apart = height(beside, j) - height(least, j);
    const double share = step(apart / (0.9 * one[0] * s.g.dx * s.g.dx)) / 2;
    std::array<double, 3> mean{};
    for (size_t k = 0; k < 3; ++k) mean[k] = (1 - share) * one[k] + share * other[k];
    return mean;
  }
  // Newton's form of the parabola about an element: curvature, vertex, lowest distance
  std::array<double, 3> about(int element, int j, int reach) const {
    const int i = std::min(std::max(element, reach), s.g.nx - 1 - reach);
    const double w = reach * s.g.dx, l = height(i - reach, j), m = height(i, j),
                 r = height(i + reach, j);
    const double c = ((r - m) / w - (m - l) / w) / (2 * w), b = (r - l) / (2 * w);
    return {c, s.g.x(i) - b / (2 * c), m - b * b / (4 * c)};
  }
  // 1 ... 0, level and without curvature at both ends
  static double step(double t) {
    const double u = 1 - std::clamp(t, 0.0, 1.0);
    return u * u * u * (u * (6 * u - 15) + 10);
  }
  double height(int i, int j) const { return s.h[at(j * s.g.nx + i)]; }

  // The parabola of the rows about row j, at any y: Lagrange's form.
  double of_row(const std::vector<double> &f, int j, double y) const {
    const int m = std::clamp(j, 1, s.g.ny - 2);
    const double t = (y - s.g.y(m)) / s.g.dy;
    return f[at(m - 1)] * t * (t - 1) / 2 + f[at(m)] * (1 - t * t) + f[at(m + 1)] * t * (t + 1) / 2;
  }
  double nearest(const std::vector<double> &f, double y) const {
    const double t = (y - s.g.y0) / s.g.dy;
    const int j = std::clamp(static_cast<int>(std::floor(t)), 0, s.g.ny - 2);
    const double right = std::clamp(t - j, 0.0, 1.0);
    return (1 - right) * of_row(f, j, y) + right * of_row(f, j + 1, y);
  }
  struct place {
    double y, low;
    int row;
  };
  place deepest(const std::vector<double> &f, int begin, int end) const {
    place best{s.g.y(begin), f[at(begin)], begin};
    for (int j = begin; j < end; ++j)
      for (int k = 0; k <= fine; ++k) {
        const double y = s.g.y(j) + (static_cast<double>(k) / fine - 0.5) * s.g.dy;
        if (nearest(f, y) < best.low) best = {y, nearest(f, y), j};
      }
    return best;
  }
  // f(y, row) over the rows' strips
  template <class F>
  double across(int begin, int end, F &&f) const {
    double sum = 0;
    for (int j = begin; j < end; ++j)
      for (int k = 0; k < fine; ++k)
        sum += f(s.g.y(j) + ((k + 0.5) / fine - 0.5) * s.g.dy, j) * s.g.dy / fine;
    return sum;
  }
  double width_below(double level, int begin, int end) const {
    return across(begin, end,
                  [&](double y, int j) { return of_row(lowest, j, y) < level ? 1 : 0; });
  }

  // One group of rows together; l2(y, row): squared half chord, k(row): p = k sqrt(l2 - x^2).
  template <class L, class K>
  sums add_up(int begin, int end, double weight, double depth, double low, L &&l2, K &&k) {
    sums out;
    for (int j = begin; j < end; ++j) {
      const auto half = [&](double y, int row) { return std::max(0.0, l2(y, row)); };
      const double force = k(j) * pi / 2 * across(j, j + 1, half);
      out.force += force;
      out.area += across(j, j + 1, [&](double y, int row) { return 2 * std::sqrt(half(y, row)); });
      out.width += across(j, j + 1, [&](double y, int row) { return l2(y, row) > 0 ? 1.0 : 0.0; });
      // half of pressure times displacement, int p = pi l^2/2 and int p x^2 = pi l^4/8
      out.energy += k(j) / 2 * across(j, j + 1, [&](double y, int row) {
                      const double l = half(y, row), f = of_row(lowest, row, y) - low;
                      return pi / 2 * l * (depth - f) - pi / 8 * l * l * curvature[at(row)];
                    });
      const double middle = half(s.g.y(j), j);
      out.peak = std::max(out.peak, k(j) * std::sqrt(middle));
      if (force > 0) chord[at(j)] += weight * middle;
      load[at(j)] += weight * force;
      mean_chord[at(j)] += weight * across(j, j + 1, half) / s.g.dy;
      moment[at(j)] += weight * k(j) * pi / 2 * across(j, j + 1, [&](double y, int row) {
                         return (y - s.g.y(row)) * half(y, row);
                       });
    }
    return out;
  }

  sums group(double approach, int begin, int end, double weight) {
    const auto [y0, low, row] = deepest(lowest, begin, end);
    const double d = approach - low;
    if (d <= 0) return {};
    return method == RP_NORMAL_ANALYN ? analyn(y0, low, row, d, begin, end, weight)
                                      : kik(y0, low, row, d, begin, end, weight);
  }

  sums analyn(double, double low, int row, double d, int begin, int end, double weight) {
    const double width = width_below(low + d / 2, begin, end);
    const double reach = std::max(width / 5, s.g.dy);
    std::vector<hertz_ratios::values> hz;
    for (int j = begin; j < end; ++j) {
      const double y = s.g.y(j);
      const double b =
          (nearest(lowest, y + reach) + nearest(lowest, y - reach) - 2 * lowest[at(j)]) /
          (2 * reach * reach);
      hz.push_back(ratios.at(curvature[at(j)], std::max(b, 0.2 * d / (width * width))));
    }
    // at approach d: a^2 = edge d/A, so l^2 = (d - (1 + beta) f) a^2/d
    const auto l2 = [&](double y, int j) {
      const auto &v = hz[at(j - begin)];
      return (d - (of_row(lowest, j, y) - low) / v.edge_across) * v.edge_along / curvature[at(j)];
    };
    const auto k = [&](int j) { return modulus * curvature[at(j)] * hz[at(j - begin)].pressure; };
    sums out = add_up(begin, end, weight, d, low, l2, k);
    const double a = std::sqrt(hz[at(row - begin)].edge_along * d / curvature[at(row)]);
    out.peak = std::max(out.peak, k(row) * a);
    return out;
  }

  // Hertz's ellipse whose bodies overlap over the length and width of these at a depth, with the
  // ratio L/W = sqrt(B/A), at an approach of 1
  struct overlapping {
    hertz_contact ellipse;
    double long_by_wide;
  };
  overlapping overlap(double low, double a0, double part, int begin, int end) const {
    double half_length2 = part / a0;
    for (int j = begin; j < end; ++j)
      half_length2 = std::max(half_length2, (part + low - lowest[at(j)]) / curvature[at(j)]);
    const double width = width_below(low + part, begin, end);
    const double ab[2] = {1 / (4 * half_length2), 1 / (width * width)};
    return {hertz_from_approach(ab, 1.0, 1.0), 2 * std::sqrt(half_length2) / width};
  }

  double low_in(int j, double d, double width) const {
    const double y = s.g.y(j), e = s.g.dy / 4;
    const double rise = (of_row(lowest, j, y + e) - of_row(lowest, j, y - e)) / (2 * e);
    const double bend =
        (of_row(lowest, j, y + e) - 2 * lowest[at(j)] + of_row(lowest, j, y - e)) / (2 * e * e);
    const double least = 0.4 * d / (width * width);
    return y + std::clamp(-rise / (2 * std::max(bend, least)), -s.g.dy / 2, s.g.dy / 2);
  }
  double counts(int j, double d, int begin, int end) const {
    const auto least = [&](int from, int to) {
      return *std::min_element(lowest.begin() + std::max(from, begin),
                               lowest.begin() + std::min(to, end));
    };
    return step((lowest[at(j)] - least(begin, end)) / (0.1 * d)) *
           step((lowest[at(j)] - least(j - 3, j + 4)) / (0.01 * d));
  }

  sums kik(double, double low, int, double d, int begin, int end, double weight) {
    const double span = width_below(low + d, begin, end);
    double counted = 0, y0 = 0, a0 = 0;
    for (int j = begin; j < end; ++j) {
      const double w = counts(j, d, begin, end);
      counted += w;
      y0 += w * low_in(j, d, span);
      a0 += w * curvature[at(j)];
    }
    y0 /= counted, a0 /= counted;
    double share = method == RP_NORMAL_KIK_PIOTROWSKI ? 0.55 : 0.5;
    overlapping o = overlap(low, a0, share * d, begin, end);
    // Hertz's area by an overlap: a b = share d/sqrt(A B), of what a circle's share shows
    for (int pass = 0; pass < 2 && method != RP_NORMAL_KIK_PIOTROWSKI; ++pass) {
      const hertz_contact &e = o.ellipse;
      share = e.semi_axes[0] * e.semi_axes[1] * std::sqrt(e.curvatures[0] * e.curvatures[1]);
      if (pass == 0) o = overlap(low, a0, share * d, begin, end);
    }
    const double part = share * d, ratio = o.ellipse.semi_axes[0] / o.ellipse.semi_axes[1];
    // length and width by r and 1/r: r^2 L/W = a/b
    const double r2 = ratio / o.long_by_wide, r = std::sqrt(r2);
    std::vector<double> f(at(s.g.ny));
    const double first = s.g.y(begin) - s.g.dy / 2, last = s.g.y(end - 1) + s.g.dy / 2;
    for (int j = 0; j < s.g.ny; ++j) {
      const double y = std::min(std::max(y0 + (s.g.y(j) - y0) * r, first), last);
      f[at(j)] = std::max(nearest(lowest, y), low + share * (lowest[at(j)] - low));
    }
    const auto l2 = [&](double y, int j) {
      return (part - (of_row(f, j, y) - low)) * r2 / curvature[at(j)];
    };
    double u = 0, wanted = 0;
    for (int n = begin; n < end; ++n) {
      const double w = counts(n, d, begin, end), at_y = low_in(n, d, span);
      if (w > 0)
        u += w * across(begin, end, [&](double y, int j) {
               if (l2(y, j) <= 0) return 0.0;
               return row_potential(l2(y, j), std::hypot(y - at_y, vertex[at(j)] - vertex[at(n)]));
             });
      wanted += w * std::min(d, d - (of_row(lowest, n, at_y) - low));
    }
    const double k = pi * modulus * wanted / u;
    sums out = add_up(begin, end, weight, d, low, l2, [&](int) { return k; });
    out.peak = std::max(out.peak, k * std::sqrt(part * r2 / a0));
    return out;
  }

  // What the rows' elements carry: strips that end about their middle give to their neighbours.
  std::vector<double> carried() const {
    std::vector<double> sum(load.size(), 0.0);
    for (int j = 1; j + 1 < s.g.ny; ++j) {
      if (!(load[at(j)] > 0)) continue;
      const double place = moment[at(j)] / load[at(j)] / s.g.dy;
      const double given = std::min(std::fabs(place), 0.5) * step(chord[at(j)] / mean_chord[at(j)]);
      sum[at(j)] += (1 - given) * load[at(j)];
      sum[at(std::clamp(place > 0 ? j + 1 : j - 1, 1, s.g.ny - 2))] += given * load[at(j)];
    }
    return sum;
  }

  sums all(double approach, const contact_parts &parts) {
    sums out;
    std::fill(chord.begin(), chord.end(), 0.0);
    load = mean_chord = moment = chord;
    const int cuts = parts.count - 1;
    for (int way = 0; way < 1 << cuts; ++way) {
      double weight = 1;
      std::vector<int> begins = {0};
      for (int k = 0; k < cuts; ++k) {
        const bool apart = way / (1 << k) % 2 == 1;
        weight *= apart ? 1 - parts.factor[k] : parts.factor[k];
        if (apart) begins.push_back(parts.first_row[k + 1]);
      }
      begins.push_back(s.g.ny);
      double peak = 0;
      for (size_t n = 0; n + 1 < begins.size(); ++n) {
        const sums one = group(approach, begins[n], begins[n + 1], weight);
        out.force += weight * one.force;
        out.area += weight * one.area;
        out.width += weight * one.width;
        out.energy += weight * one.energy;
        peak = std::max(peak, one.peak);
      }
      out.peak += weight * peak;
    }
    return out;
  }
};

class RowTheories : public testing::TestWithParam<rp_normal_method> {
 protected:
  row_contact rows{GetParam(), modulus, 32};
};

std::vector<contact_parts> all_parts(const surface &s) {
  std::vector<contact_parts> all(1);
  if (s.name != "ridges") return all;
  contact_parts two;
  two.count = 2;
  two.first_row[1] = 15;
  two.factor[0] = 0.35;
  contact_parts three = two;
  three.count = 3;
  three.first_row[2] = 22;
  three.factor[1] = 0.8;
  all.push_back(two);
  all.push_back(three);
  return all;
}

TEST_P(RowTheories, EquationsOnceMore) {
  for (const surface &s : surfaces())
    for (const contact_parts &parts : all_parts(s))
      for (double depth : {8e-6, 3e-5}) {
        const double approach = *std::min_element(s.h.begin(), s.h.end()) + depth;
        SCOPED_TRACE(s.name + " " + std::to_string(parts.count) + " " + std::to_string(depth));
        std::vector<double> p(s.h.size(), 5.0);
        const row_contact_result r =
            rows.solve(s.g, s.h.data(), {false, 0, approach, 0}, parts, p.data());
        once_more again(s, GetParam(), approach);
        const sums wanted = again.all(approach, parts);
        EXPECT_TRUE(r.converged);
        EXPECT_EQ(r.approach, approach);
        EXPECT_EQ(r.iterations, 0);
        EXPECT_EQ(r.residual, 0);
        EXPECT_FALSE(r.touches_border);
        EXPECT_NEAR(r.normal_force, wanted.force, strips * wanted.force);
        EXPECT_NEAR(r.contact_area, wanted.area, strips * wanted.area);
        EXPECT_NEAR(r.elastic_energy, wanted.energy, strips * wanted.energy);
        EXPECT_NEAR(r.max_pressure, wanted.peak, strips * wanted.peak);
        // ends of contact to a midpoint
        EXPECT_NEAR(rows.width(), wanted.width, 8 * s.g.dy / fine);
        const std::vector<double> carried = again.carried();
        double sampled = 0;
        for (int j = 0; j < s.g.ny; ++j) {
          double sum = 0;
          for (int i = 0; i < s.g.nx; ++i) {
            const double v = p[at(j * s.g.nx + i)] * s.g.dx * s.g.dy;
            sum += v;
            const double x = s.g.x(i) - again.vertex[at(j)];
            const double inside = again.chord[at(j)] - x * x;
            // a row of less than an element loads the one at its vertex
            if (again.chord[at(j)] > s.g.dx * s.g.dx &&
                std::fabs(inside) > 1e-3 * again.chord[at(j)] + 1e-12) {
              EXPECT_EQ(v > 0, inside > 0) << i << " " << j;
            }
          }
          sampled += sum;
          const double least = carried[at(j)] > 0 ? 0.75 * s.g.dx : 0.0;
          const double half = std::max(least, std::sqrt(again.chord[at(j)]));
          const double room = strips * (half + 2e-3);
          EXPECT_NEAR(rows.leading_edge(j, 1), again.vertex[at(j)] + half, room) << j;
          EXPECT_NEAR(rows.leading_edge(j, -1), again.vertex[at(j)] - half, room) << j;
          EXPECT_NEAR(sum, carried[at(j)], strips * wanted.force) << j;
        }
        EXPECT_NEAR(sampled, r.normal_force, 1e-12 * sampled);
      }
}

TEST_P(RowTheories, ForceIsFound) {
  for (const surface &s : surfaces())
    for (const contact_parts &parts : all_parts(s))
      for (double force : {50.0, 3e5})
        for (double above : {0.0, 1e-7, 2e-4}) {
          const double lowest = *std::min_element(s.h.begin(), s.h.end());
          const double first = above > 0 ? lowest + above : 0.0;
          SCOPED_TRACE(s.name + " " + std::to_string(force) + " " + std::to_string(first));
          std::vector<double> p(s.h.size());
          const row_contact_result r =
              rows.solve(s.g, s.h.data(), {true, force, 0, first}, parts, p.data());
          EXPECT_TRUE(r.converged);
          EXPECT_EQ(r.normal_force, force);
          EXPECT_LE(r.residual, 1e-9);
          EXPECT_GE(r.iterations, 1);
          EXPECT_LE(r.iterations, 60);
          double sum = 0;
          for (double v : p) sum += v * s.g.dx * s.g.dy;
          EXPECT_NEAR(sum, force, 1e-12 * force);
          // the reach of the rows' parabolas is that of the approach they began with
          if (s.name == "quartic") continue;
          const row_contact_result back =
              rows.solve(s.g, s.h.data(), {false, 0, r.approach, 0}, parts, p.data());
          // the approach's rounding, where contact is shallow
          EXPECT_NEAR(back.normal_force, force, 1e-6 * force);
        }
}

// Of quadratic surfaces Hertz's approach is the start of the search, and ANALYN's end.
TEST(RowContact, QuadraticSurfacesBeginAtHertz) {
  const grid g{41, 31, 4e-4, 4e-4, -8e-3, -6e-3};
  for (double ratio : {0.3, 1.0, 2.5}) {
    const surface s = parabolas(
        "quadratic", g, [](double) { return 0.0; }, [&](double) { return 1.1 * ratio; },
        [](double y) { return 1.1 * y * y; });
    const double curvatures[2] = {1.1 * ratio, 1.1};
    const hertz_contact hertz = hertz_from_force(curvatures, modulus, 3e4);
    row_contact rows(RP_NORMAL_ANALYN, modulus, g.ny);
    std::vector<double> p(s.h.size());
    const row_contact_result r = rows.solve(g, s.h.data(), {true, 3e4, 0, 0}, {}, p.data());
    EXPECT_TRUE(r.converged);
    EXPECT_LE(r.iterations, 3);
    // the table of ratios
    EXPECT_NEAR(r.approach, hertz.approach, 1e-7 * hertz.approach);
    EXPECT_NEAR(r.max_pressure, hertz.max_pressure, 1e-7 * hertz.max_pressure);
    EXPECT_NEAR(rows.width(), 2 * hertz.semi_axes[1], 1e-7 * hertz.semi_axes[1]);
    EXPECT_NEAR(rows.leading_edge(15, 1), hertz.semi_axes[0], 1e-7 * hertz.semi_axes[0]);
    EXPECT_NEAR(rows.leading_edge(15, -1), -hertz.semi_axes[0], 1e-7 * hertz.semi_axes[0]);
    // energy: int F d(approach) with F as approach^1.5
    EXPECT_NEAR(r.elastic_energy, 0.4 * 3e4 * hertz.approach, strips * 3e4 * hertz.approach);
  }
}

TEST_P(RowTheories, BordersAndNothing) {
  const grid g{21, 19, 5e-4, 5e-4, -5e-3, -4.5e-3};
  for (int side = 0; side < 5; ++side) {
    const double x = side == 0 ? g.x(0) : side == 1 ? g.x(20) : 0.0;
    const double y = side == 2 ? g.y(0) : side == 3 ? g.y(18) : 0.0;
    const surface s = parabolas(
        "side", g, [&](double) { return x; }, [](double) { return 2.0; },
        [&](double v) { return 2.0 * (v - y) * (v - y); });
    std::vector<double> p(s.h.size());
    const row_contact_result r = rows.solve(g, s.h.data(), {false, 0, 5e-6, 0}, {}, p.data());
    EXPECT_EQ(r.touches_border, side < 4) << side;
    EXPECT_TRUE(r.converged);
    for (double above : {-1e-9, -1e-6}) {
      const row_contact_result none = rows.solve(g, s.h.data(), {false, 0, above, 0}, {}, p.data());
      EXPECT_EQ(none.normal_force, 0);
      EXPECT_EQ(none.contact_area, 0);
      EXPECT_EQ(none.max_pressure, 0);
      EXPECT_EQ(none.elastic_energy, 0);
      EXPECT_EQ(rows.width(), 0);
      EXPECT_TRUE(none.converged);
      EXPECT_FALSE(none.touches_border);
      for (double v : p) EXPECT_EQ(v, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, RowTheories,
                         testing::Values(RP_NORMAL_KIK_PIOTROWSKI,
                                         RP_NORMAL_KIK_PIOTROWSKI_CORRECTED, RP_NORMAL_ANALYN));

}  // namespace
