// The parts of the temperature by their definitions: integrals by quadrature, rows one by one, heat
// along the path of each column, and the stage as the sum of its parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "temperature/stage.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;

// a smooth integrand
template <class F>
double midpoints(double from, double to, F &&f, int n = 20000) {
  double sum = 0;
  for (int k = 0; k < n; ++k) sum += f(from + (k + 0.5) * (to - from) / n);
  return sum * (to - from) / n;
}

thermal_body steel(double bulk = 0) { return {50.0, 450.0, 7850.0, bulk}; }
thermal_body cast_iron(double bulk = 0) { return {30.0, 540.0, 7200.0, bulk}; }

// --- closed forms ----------------------------------------------------------------------------

TEST(HeatParts, ConstantFluxIsItsIntegral) {
  for (double age : {0.3, 1.0, 7.0})
    for (double depth : {0.0, 0.05, 0.6, 2.0, 5.0}) {
      // s = v^2
      const double wanted = midpoints(0, std::sqrt(age), [&](double v) {
        return 2 / std::sqrt(pi) * std::exp(-depth * depth / (4 * v * v));
      });
      EXPECT_NEAR(constant_flux(age, depth), wanted, 1e-8) << age << " " << depth;
    }
  EXPECT_EQ(constant_flux(0, 0.1), 0);
  EXPECT_EQ(constant_flux(-1, 0), 0);
}

TEST(HeatParts, LevelledIsItsIntegral) {
  for (double since : {0.5, 1.0, 40.0})
    for (double share : {1e-3, 0.2, 0.7, 0.97, 0.9999, 1.0, 1.5})
      for (double depth : {0.0, 0.03, 0.4, 1.3, 6.0}) {
        const double end = std::asin(std::sqrt(std::min(share, 1.0)));
        const double wanted = 2 / pi * midpoints(0, end, [&](double angle) {
                                const double c = std::cos(angle);
                                return std::exp(-depth * depth / (4 * since * c * c));
                              });
        EXPECT_NEAR(levelled(share * since, since, depth), wanted, 2e-8)
            << share << " " << since << " " << depth;
      }
  EXPECT_EQ(levelled(0, 1, 0), 0);
  EXPECT_EQ(levelled(-1, 1, 0.2), 0);
}

TEST(HeatParts, BodiesShareByEffusivity) {
  const thermal_pair pair{{steel(100), cast_iron(20)}};
  const double w = std::sqrt(50.0 * 450 * 7850), r = std::sqrt(30.0 * 540 * 7200);
  EXPECT_NEAR(pair.body[0].effusivity(), w, 1e-9);
  EXPECT_NEAR(pair.body[1].diffusivity(), 30.0 / (540 * 7200), 1e-18);
  EXPECT_NEAR(pair.effusivity(), w + r, 1e-9);
  EXPECT_NEAR(pair.share(0), w / (w + r), 1e-14);
  EXPECT_TRUE(pair.exchanges());
  EXPECT_FALSE((thermal_pair{{steel(20), cast_iron(20)}}).exchanges());
  EXPECT_NEAR(pair.surface(0, 0.3, 7), 100 - 80 * r / (w + r) * 0.3 + 7, 1e-11);
  EXPECT_NEAR(pair.surface(1, 0.3, 7), 20 + 80 * w / (w + r) * 0.3 + 7, 1e-11);
}

TEST(HeatParts, LawAndItsSlope) {
  const temperature_law law{0.3, -0.18, 20, 400};
  for (double t = -100; t < 600; t += 7) {
    const double wanted = t < 20 ? 0.3 : t > 420 ? 0.12 : 0.3 - 0.18 * (t - 20) / 400;
    EXPECT_NEAR(law.coefficient(t), wanted, 1e-15);
    EXPECT_NEAR(law.slope(t), t < 20 || t > 420 ? 0 : -0.18 / 400, 1e-18);
  }
  // of the linear piece at both of its ends
  EXPECT_NEAR(law.slope(20), -0.18 / 400, 1e-18);
  EXPECT_NEAR(law.slope(420), -0.18 / 400, 1e-18);
}

TEST(HeatParts, FrictionHeat) {
  const std::vector<double> friction{5e8 * 5e-3, 1e8 * 1e-2}, w{2e6, 0};
  std::vector<double> q(2);
  friction_heat(2, 20, friction.data(), nullptr, 0.4, q.data());
  EXPECT_NEAR(q[0], 20 * 5e8 * 5e-3, 1e-6);
  EXPECT_NEAR(q[1], 20 * 1e8 * 1e-2, 1e-6);
  friction_heat(2, 20, friction.data(), w.data(), 0.4, q.data());
  EXPECT_NEAR(q[0], 20 * 5e8 * 5e-3 + 0.4 * 2e6, 1e-6);
  EXPECT_NEAR(q[1], 20 * 1e8 * 1e-2, 1e-6);
}

// --- the kernel ------------------------------------------------------------------------------

std::vector<double> waves(size_t n, double f) {
  std::vector<double> v(n);
  for (size_t i = 0; i < n; ++i) v[i] = 1e7 * (1.5 + std::sin(f * static_cast<double>(i)));
  return v;
}

TEST(HeatKernel, WeightsOfAnyDistance) {
  const double dx = 3e-4, speed = 12;
  for (double elements : {0.2, 0.5, 0.8, 1.0, 2.3, 7.5, 100.0})
    for (double depth : {0.0, 1e-4, 2e-3}) {
      heat_kernel kernel(10);
      kernel.set({10, 1, dx, 1, speed}, elements * dx, depth);
      double last = 0;
      int count = 0;
      for (int m = 0; m < 10; ++m) {
        // the centre of element 0 looks ahead: half an element of its own, then whole ones
        const double end = std::min(m + 0.5, elements) * dx / speed;
        if (end <= last) break;
        const double wanted = constant_flux(end, depth) - constant_flux(last, depth);
        EXPECT_NEAR(kernel.weight(m), wanted, 1e-12 * constant_flux(end, 0)) << m;
        last = end;
        ++count;
      }
      EXPECT_EQ(kernel.count(), count) << elements;
    }
  heat_kernel kernel(10);
  kernel.set({10, 1, dx, 1, 0.0}, dx);
  EXPECT_EQ(kernel.count(), 0);
  kernel.set({10, 1, dx, 1, speed}, 0.0);
  EXPECT_EQ(kernel.count(), 0);
}

TEST(HeatKernel, SumsRowByRow) {
  for (int direction : {1, -1}) {
    const heat_rows rows{9, 4, 3e-4, direction, 12};
    heat_kernel kernel(9);
    kernel.set(rows, 5.2 * rows.dx);
    std::vector<double> q = waves(36, 1.7), known = waves(36, 0.9), y(36, 1.0), z(36), w = known;
    std::fill_n(q.begin() + 9, 9, 0.0);
    kernel.apply(rows, q.data(), nullptr, y.data());
    kernel.apply(rows, q.data(), known.data(), z.data());
    kernel.apply(rows, q.data(), w.data(), w.data());
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 9; ++i) {
        double sum = 0;
        for (int m = 0; m < kernel.count(); ++m) {
          const int k = i + direction * m;
          if (k >= 0 && k < 9) sum += kernel.weight(m) * q[static_cast<size_t>(9 * j + k)];
        }
        const auto at = static_cast<size_t>(9 * j + i);
        EXPECT_NEAR(y[at], sum, 1e-13 * 1e6) << at;
        EXPECT_NEAR(z[at], known[at] + sum, 1e-13 * 1e8) << at;
        EXPECT_EQ(w[at], z[at]) << at;
      }
  }
}

TEST(SteadyRows, ExchangeIsThatOfEachRow) {
  for (int direction : {1, -1})
    for (double depth : {0.0, 0.7}) {
      const heat_rows all{14, 3, 3e-4, direction, 12}, one{14, 1, 3e-4, direction, 12};
      std::vector<double> p(42), e(42), single(14);
      for (size_t i : {3u, 4u, 5u, 20u, 23u, 24u, 25u}) p[i] = 1;
      steady_temperature t(14, true);
      t.set(all);
      t.exchange(p.data(), e.data(), depth);
      for (size_t j = 0; j < 3; ++j) {
        t.set(one);
        t.exchange(p.data() + 14 * j, single.data(), depth);
        for (size_t i = 0; i < 14; ++i) {
          EXPECT_EQ(e[14 * j + i], single[i]);
          // where the row has not met anything yet there is no change
          const bool met = [&] {
            for (size_t k = 0; k < 14; ++k)
              if (p[14 * j + k] > 0 && (direction > 0 ? k >= i : k <= i)) return true;
            return false;
          }();
          EXPECT_EQ(single[i] > 0, met) << j << " " << i;
          if (p[14 * j + i] > 0 && depth == 0) {
            EXPECT_NEAR(single[i], 1, 1e-12);
          }
        }
      }
    }
}

// --- moving columns --------------------------------------------------------------------------

struct step {
  double elements, speed;
  int direction;
};

struct moving {
  heat_rows rows;
  heat_columns columns;
  std::vector<double> state, y;
  moving(const heat_rows &r, bool exchanges)
      : rows(r), columns(r.nx, r.ny, exchanges), state(columns.state_size()) {
    y.resize(static_cast<size_t>(r.nx * r.ny));
  }
  void go(const step &s, const double *q, const double *p) {
    rows.speed = s.speed;
    rows.direction = s.direction;
    columns.begin(rows, s.elements * rows.dx, p, state.data());
    columns.rise(q, y.data());
    columns.commit(q, p, state.data());
  }
  std::vector<double> deep(const thermal_pair &pair, int k, double z) {
    std::vector<double> t(y.size());
    columns.at_depth(pair, k, z, state.data(), t.data());
    return t;
  }
};

const std::vector<step> ride = {{1.3, 8, 1},   {0.4, 8, 1}, {2.0, 10, 1},  {0.7, 12, -1},
                                {0.2, 5, -1},  {3.6, 6, 1}, {0.25, 90, 1}, {1.1, 70, 1},
                                {0.5, 70, -1}, {6.4, 60, 1}};

std::vector<double> touching(const heat_rows &r) {
  std::vector<double> p;
  for (int j = 0; j < r.ny; ++j)
    for (int i = 0; i < r.nx; ++i) p.push_back(i > 4 + j && i < r.nx - 6 + j ? 1.0 : 0.0);
  return p;
}

TEST(Columns, OfNoGridKeepNothing) { EXPECT_EQ(heat_columns().state_size(), 0u); }

TEST(Columns, RowsAreOnTheirOwn) {
  const thermal_pair pair{{steel(90), cast_iron(15)}};
  const heat_rows all{20, 3, 4e-4, 1, 8}, one{20, 1, 4e-4, 1, 8};
  const std::vector<double> q = waves(60, 1.9), p = touching(all);
  moving together(all, true);
  std::vector<moving> alone;
  for (int j = 0; j < 3; ++j) alone.emplace_back(one, true);
  for (const step &s : ride) {
    together.go(s, q.data(), p.data());
    const auto deep = together.deep(pair, 1, 3e-5);
    std::vector<double> centres(60);
    together.columns.to_centres(deep.data(), 15, centres.data());
    for (size_t j = 0; j < 3; ++j) {
      moving &m = alone[j];
      m.go(s, q.data() + 20 * j, p.data() + 20 * j);
      const auto own = m.deep(pair, 1, 3e-5);
      std::vector<double> own_centres(20);
      m.columns.to_centres(own.data(), 15, own_centres.data());
      for (size_t i = 0; i < 20; ++i) {
        EXPECT_EQ(together.y[20 * j + i], m.y[i]);
        EXPECT_EQ(together.columns.exchanged()[20 * j + i], m.columns.exchanged()[i]);
        EXPECT_EQ(deep[20 * j + i], own[i]);
        EXPECT_EQ(centres[20 * j + i], own_centres[i]);
        const int x = static_cast<int>(i), y = static_cast<int>(j);
        EXPECT_EQ(together.columns.stored(x, y, together.state.data()),
                  m.columns.stored(x, 0, m.state.data()));
      }
    }
  }
}

TEST(Columns, MirroredRidesAreMirrorImages) {
  const heat_rows rows{20, 1, 4e-4, 1, 8};
  std::vector<double> q = waves(20, 1.9), p = touching(rows), back = q, pressed = p;
  std::reverse(back.begin(), back.end());
  std::reverse(pressed.begin(), pressed.end());
  moving a(rows, true), b(rows, true);
  for (step s : ride) {
    a.go(s, q.data(), p.data());
    s.direction = -s.direction;
    b.go(s, back.data(), pressed.data());
    EXPECT_NEAR(heat_columns::offset(a.state.data()), -heat_columns::offset(b.state.data()), 1e-12);
    for (size_t i = 0; i < 20; ++i) {
      EXPECT_NEAR(a.y[i], b.y[19 - i], 1e-9 * 1e6) << i;
      EXPECT_NEAR(a.columns.exchanged()[i], b.columns.exchanged()[19 - i], 1e-9) << i;
    }
  }
}

// What a column takes up is the flux of the elements on its way, each for the time in it.
TEST(Columns, StoredHeatIsThatOfThePath) {
  const heat_rows rows{24, 1, 4e-4, 1, 8};
  const std::vector<double> q = waves(24, 1.9), p(24, 1.0);
  moving m(rows, false);
  std::vector<step> done;
  for (const step &s : ride) {
    m.go(s, q.data(), p.data());
    done.push_back(s);
    const double offset = heat_columns::offset(m.state.data()) / rows.dx;
    EXPECT_LE(std::fabs(offset), 0.5);
    for (int i = 0; i < 24; ++i) {
      // back in time from where it is now, in elements from the edge of the first; a jump of speed
      // beyond 8 moves the modes, that of rate 0 but for rounding not
      double x = i + 0.5 + offset, heat = 0;
      bool inside = true;
      for (auto s = done.rbegin(); s != done.rend() && inside; ++s) {
        double left = s->elements;
        while (left > 1e-9) {
          const bool forward = s->direction > 0;
          const double edge = forward ? std::floor(x + 1e-9) + 1 : std::ceil(x - 1e-9) - 1;
          const double part = std::min(left, std::fabs(edge - x));
          const double next = x + (forward ? part : -part), middle = (x + next) / 2;
          inside = middle >= 0 && middle <= 24;
          if (!inside) break;
          heat += q[static_cast<size_t>(middle)] * part * rows.dx / s->speed;
          x = next;
          left -= part;
        }
      }
      // columns that have been outside are forgotten when they leave
      if (!inside) continue;
      EXPECT_NEAR(m.columns.stored(i, 0, m.state.data()), heat, 1e-9 * heat) << i;
    }
  }
}

// One step and two with the same path leave the same columns.
TEST(Columns, StepsCanBeCut) {
  const thermal_pair pair{{steel(90), cast_iron(15)}};
  for (int direction : {1, -1})
    for (const auto &[first, second] : std::vector<std::pair<double, double>>{
             {1.0, 2.0}, {0.3, 0.43}, {0.52, 1.2}, {2.6, 0.13}, {3.7, 4.91}}) {
      const heat_rows rows{20, 1, 4e-4, direction, 8};
      const std::vector<double> q = waves(20, 1.9);
      std::vector<double> p = touching(rows);
      moving whole(rows, true), cut(rows, true);
      for (int k = 0; k < 6; ++k) {
        whole.go({first + second, 8, direction}, q.data(), p.data());
        cut.go({first, 8, direction}, q.data(), p.data());
        cut.go({second, 8, direction}, q.data(), p.data());
        EXPECT_NEAR(heat_columns::offset(whole.state.data()),
                    heat_columns::offset(cut.state.data()), 1e-12);
        const bool split = first == std::floor(first) && second == std::floor(second);
        for (double z : {0.0, 2e-5, 2e-4})
          for (int body : {0, 1}) {
            const auto a = whole.deep(pair, body, z), b = cut.deep(pair, body, z);
            for (size_t i = 0; i < 20; ++i) EXPECT_NEAR(a[i], b[i], 1e-6 * 100) << i << " " << z;
          }
        for (size_t i = 0; i < 20 && split; ++i) {
          EXPECT_NEAR(whole.y[i], cut.y[i], 1e-6 * 1e6) << i;
          EXPECT_NEAR(whole.columns.exchanged()[i], cut.columns.exchanged()[i], 1e-9);
        }
      }
    }
}

// By the passage of an element, heat knows no other unit of time: rises go with its root, exchanges
// stay as they are. Contacts follow each other, so that what is left of one meets the next.
TEST(Columns, InAnyUnitOfTime) {
  const heat_rows rows{24, 1, 4e-4, 1, 8};
  std::vector<double> p(24);
  for (size_t i = 0; i < 24; ++i) p[i] = i % 8 < 5 ? 1.0 : 0.0;
  const std::vector<double> q = waves(24, 1.9);
  for (const double slower : {1e-3, 1e4, 1e6}) {
    moving one(rows, true), other(rows, true);
    for (step s : ride) {
      s.direction = 1;
      one.go(s, q.data(), p.data());
      s.speed /= slower;
      other.go(s, q.data(), p.data());
      for (size_t i = 0; i < 24; ++i) {
        EXPECT_NEAR(one.columns.exchanged()[i], other.columns.exchanged()[i], 1e-10) << i;
        EXPECT_NEAR(other.y[i] / std::sqrt(slower), one.y[i], 1e-10 * 1e6) << i;
      }
    }
  }
}

TEST(Columns, AreAsTheBulkWhereNothingHasRolled) {
  const thermal_pair pair{{steel(90), cast_iron(15)}};
  const heat_rows rows{12, 1, 4e-4, 1, 8};
  moving m(rows, true);
  const std::vector<double> q(12, 1e7), p(12, 0.0);
  m.go({1.0, 0, 1}, q.data(), p.data());
  for (const double z : {0.0, 1e-4})
    for (const int k : {0, 1})
      for (const double t : m.deep(pair, k, z)) EXPECT_EQ(t, pair.body[k].bulk);
}

TEST(Columns, KeepNothingWhereThereAreNone) {
  EXPECT_EQ(heat_columns().state_size(), 0u);
  EXPECT_EQ(heat_columns().bytes(), heat_kernel().bytes());
}

// Steady flux, steps of parts of an element: only what lies between two columns is interpolated.
TEST(Columns, UniformFluxInPartialSteps) {
  for (int direction : {1, -1})
    for (double part : {0.37, 0.5, 0.9, 1.6}) {
      const heat_rows rows{30, 1, 4e-4, direction, 8};
      const std::vector<double> q(30, 1e7), p(30, 1.0);
      moving m(rows, false);
      for (int k = 0; k < 90; ++k) {
        m.go({part, 8, direction}, q.data(), p.data());
        if ((k + 1) * part < 31) continue;
        // behind the last element stands no column to interpolate with
        for (int n = 3; n < 29; ++n) {
          const auto i = static_cast<size_t>(direction > 0 ? 29 - n : n);
          const double age = (n + 0.5) * rows.dx / 8, wanted = 2e7 * std::sqrt(age / pi);
          // sqrt's second derivative over one element, 1/(32 n^2), of columns before the step
          EXPECT_NEAR(m.y[i] / wanted, 1, 0.1 / (n * n) + 1e-6) << n << " " << part << " " << k;
        }
      }
    }
}

TEST(Columns, AnotherGridForgets) {
  const heat_rows rows{20, 2, 4e-4, 1, 8};
  const std::vector<double> q = waves(40, 1.9), p = touching(rows);
  moving m(rows, true), fresh(rows, true);
  EXPECT_EQ(m.columns.state_size(), heat_columns::state_size(20, 2, true));
  EXPECT_LT(heat_columns::state_size(20, 2, false), m.columns.state_size());
  m.go(ride[0], q.data(), p.data());
  m.rows.nx = fresh.rows.nx = 18;
  m.y.resize(36);
  fresh.y.resize(36);
  m.go(ride[1], q.data(), p.data());
  fresh.go(ride[1], q.data(), p.data());
  EXPECT_EQ(m.y, fresh.y);
  m.columns.reset(m.state.data());
  for (double v : m.state) EXPECT_EQ(v, 0);
}

// --- the stage -------------------------------------------------------------------------------

struct stage_case {
  bool transient, exchanges, by_temperature;
  double depth;
};

TEST(Stage, IsTheSumOfItsParts) {
  for (const stage_case &c : std::vector<stage_case>{{false, false, false, 0},
                                                     {false, true, true, 0},
                                                     {false, true, false, 3e-5},
                                                     {true, false, true, 0},
                                                     {true, true, true, 0},
                                                     {true, true, false, 3e-5}}) {
    heat_scene scene;
    scene.bodies = {{steel(c.exchanges ? 90 : 15), cast_iron(15)}};
    scene.exchanges = c.exchanges;
    scene.by_temperature = c.by_temperature;
    scene.law = {0.4, -0.2, 20, 150};
    scene.depth = c.depth;
    scene.plastic_fraction = 0.6;
    scene.transient = c.transient;
    const heat_rows rows{20, 2, 4e-4, -1, 8};
    temperature_stage stage(scene, 22, 3);
    heat_memory memory(22, 3, scene);
    EXPECT_EQ(stage.feeds_back(), c.by_temperature);
    EXPECT_GT(stage.bytes(), 0u);
    EXPECT_GT(memory.bytes(), 0u);
    const thermal_pair &pair = scene.bodies;
    const std::vector<double> p = touching(rows), zero(40);
    steady_temperature steady(22, c.exchanges, true);
    heat_columns columns(22, 3, c.exchanges);
    std::vector<double> state(columns.state_size()), heat(40), y(40), e(40), t(40);
    for (int round = 0; round < 3; ++round) {
      const double distance = 1.4 * rows.dx;
      stage.begin(rows, distance, p.data(), memory);
      const double *exchanged = nullptr;
      if (c.transient) {
        columns.begin(rows, distance, p.data(), state.data());
        exchanged = columns.exchanged();
      } else {
        steady.set(rows);
        if (c.exchanges) {
          steady.exchange(p.data(), e.data());
          exchanged = e.data();
        }
      }
      for (size_t i = 0; i < 40; ++i) {
        EXPECT_EQ(stage.flux()[i], 0);
        if (!c.by_temperature || round > 0) continue;
        const double level = exchanged ? exchanged[i] : 0.0;
        const double hot = std::max(pair.surface(0, level, 0), pair.surface(1, level, 0));
        EXPECT_NEAR(memory.friction[i], scene.law.coefficient(hot), 1e-14);
      }
      // some slip behind the leading edge; plastic work
      std::vector<double> friction(40), work(40, 3e5);
      for (size_t i = 0; i < 40; ++i)
        friction[i] = p[i] > 0 ? 2e4 * static_cast<double>(i % 20) : 0.0;
      stage.heat(friction.data(), work.data(), heat.data());
      for (size_t i = 0; i < 40; ++i) EXPECT_NEAR(heat[i], 8 * friction[i] + 0.6 * 3e5, 1e-6);
      std::copy(heat.begin(), heat.end(), stage.flux());
      const double top = stage.finish(p.data(), memory);
      if (c.transient)
        columns.rise(heat.data(), y.data());
      else
        steady.rise(heat.data(), nullptr, y.data());
      double greatest = -1e9;
      std::vector<double> surface[2] = {zero, zero};
      for (int k : {0, 1})
        for (size_t i = 0; i < 40; ++i) {
          const double level = exchanged ? exchanged[i] : 0.0;
          surface[k][i] = pair.surface(k, level, y[i] / pair.effusivity());
          if (p[i] > 0) greatest = std::max(greatest, surface[k][i]);
        }
      EXPECT_NEAR(top, greatest, 1e-11 * greatest);
      if (c.transient) columns.commit(heat.data(), p.data(), state.data());
      for (int k : {0, 1}) {
        if (c.depth > 0 && c.transient) {
          columns.at_depth(pair, k, c.depth, state.data(), t.data());
          columns.to_centres(t.data(), pair.body[k].bulk, surface[k].data());
        } else if (c.depth > 0) {
          steady.at_depth(pair, k, c.depth, heat.data(), p.data(), surface[k].data());
        }
        for (size_t i = 0; i < 40; ++i)
          EXPECT_NEAR(memory.temperature[k][i], surface[k][i], 1e-11 * 500) << k << " " << i;
      }
      for (size_t i = 0; i < 40 && c.by_temperature; ++i)
        EXPECT_EQ(memory.friction[i] > 0, p[i] > 0) << i;
    }
    memory.clear();
    for (double v : memory.friction) EXPECT_EQ(v, 0);
    for (double v : memory.columns) EXPECT_EQ(v, 0);
    stage.set_bulk(0, 300);
    stage.begin(rows, 1.4 * rows.dx, p.data(), memory);
    // bodies that exchange heat come to the mean by their effusivities: Carslaw, Jaeger 1959
    const double b[2] = {std::sqrt(50.0 * 450 * 7850), std::sqrt(30.0 * 540 * 7200)};
    const double common = (b[0] * 300 + b[1] * 15) / (b[0] + b[1]);
    const double contact = c.exchanges ? common : 300;
    EXPECT_NEAR(stage.finish(p.data(), memory), contact, 1e-9 * contact);
    // without a contact nothing is exchanged
    EXPECT_NEAR(stage.finish(zero.data(), memory), 300, 1e-9 * 300);
  }
}

// Colder than ice counts too.
TEST(Stage, GreatestOfColdBodies) {
  heat_scene scene;
  scene.bodies = {{steel(-40), cast_iron(-40)}};
  const heat_rows rows{6, 1, 4e-4, 1, 8};
  temperature_stage stage(scene, 6, 1);
  heat_memory memory(6, 1, scene);
  const std::vector<double> p(6, 1.0);
  stage.begin(rows, 0, p.data(), memory);
  EXPECT_NEAR(stage.finish(p.data(), memory), -40, 1e-12);
}

}  // namespace
