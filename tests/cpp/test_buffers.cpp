// What the parts of the core say they hold is what they take, each by itself; and none writes
// beyond what it took, at the greatest sizes it was made for.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include "half_space/conformal_coupling.hpp"
#include "half_space/coupling.hpp"
#include "half_space/offset_influence.hpp"
#include "numeric/fixed_point.hpp"
#include "numeric/gmres.hpp"
#include "numeric/pivoted_blocks.hpp"
#include "tangential/coarse_start.hpp"
#include "tangential/contact_rows.hpp"
#include "tangential/fitted.hpp"
#include "tangential/fitted_operator.hpp"
#include "tangential/tangential_derivative.hpp"

namespace {

// live bytes of the core's buffers, which alone ask for an alignment; each block begins with its
// size and ends with a mark
constinit size_t live = 0;
constinit int overrun = 0;
constexpr size_t head = 64, tail = 64;
constexpr int mark = 0x5a;

void *take(size_t size) {
  const size_t whole = (head + size + tail + head - 1) / head * head;
  auto *block = static_cast<char *>(std::aligned_alloc(head, whole));
  if (!block) throw std::bad_alloc();
  std::memcpy(block, &size, sizeof size);
  std::memset(block + head + size, mark, whole - head - size);
  live += size;
  return block + head;
}
void give(void *p) {
  if (!p) return;
  char *block = static_cast<char *>(p) - head;
  size_t size;
  std::memcpy(&size, block, sizeof size);
  live -= size;
  for (size_t i = 0; i < tail; ++i) overrun += block[head + size + i] != mark;
  std::free(block);
}

}  // namespace

void *operator new[](size_t size, std::align_val_t) { return take(size); }
void operator delete[](void *p, std::align_val_t) noexcept { give(p); }
void operator delete[](void *p, size_t, std::align_val_t) noexcept { give(p); }

// The core's large buffers are pages of the system's; here they are watched as the others are.
void *railpatch::take_pages(size_t bytes) {
  void *pages = take(bytes);
  std::memset(pages, 0, bytes);
  return pages;
}
void railpatch::give_pages(void *pages, size_t) { give(pages); }

namespace {

using namespace railpatch;
using field = std::vector<double>;

template <class Make>
void expect_taken(const char *name, Make &&make, size_t elsewhere = 0) {
  const size_t before = live;
  const auto made = make();
  EXPECT_EQ(made->bytes(), live - before + elsewhere) << name;
}
// of a T made from arguments
template <class T, class... Arguments>
void expect_bytes(const char *name, Arguments &&...arguments) {
  expect_taken(name, [&] { return std::make_unique<T>(arguments...); });
}

const elastic_constants unlike{82e9, 0.28, 0.02};

TEST(Buffers, TakeWhatTheySay) {
  const fft_plans plans({12, 30}, {1, 20});
  expect_bytes<batch_fft<float>>("transforms", 30);
  expect_bytes<batch_fft<double>>("transforms", 30);
  for (bool tangential : {false, true}) {
    expect_bytes<convolution<float>>("products", 30, 18, tangential);
    expect_bytes<convolution<double>>("products", 30, 18, tangential);
    expect_bytes<conformal_influence>("curved", plans, tangential, 1e-14);
    for (bool curved : {false, true}) {
      influence::medium of{unlike, 0, 0, tangential};
      of.curved = curved;
      expect_taken(
          "influence", [&] { return std::make_unique<influence>(of, plans); }, plans.bytes());
    }
  }
  expect_bytes<coupling_influence>("coupling", unlike, false, plans);
  for (bool moves : {false, true}) expect_bytes<offset_influence>("offset", plans, moves);
  influence::medium of{unlike};
  of.curved = true;
  influence a(of, plans);
  expect_bytes<conformal_coupling>("curved coupling", a, 60);
  expect_bytes<fixed_point>("fixed point", 30);
  expect_bytes<gmres>("gmres", 31, 7);
  expect_bytes<shared_krylov>("krylov", 31, 7, 3);
  expect_bytes<pivoted_blocks>("pivoted blocks", 9, 4);
  for (int rows : {1, 4, 9}) expect_bytes<row_blocks>("row blocks", 9, rows);
  expect_bytes<row_elements>("rows of elements", 11, 7);
  expect_bytes<row_strips>("strips", 11, 4);
  expect_bytes<force_constraint>("forces", 77);
  for (int directions : {1, 9}) expect_bytes<tangential_derivative>("rates", 11, 7, directions);
  for (bool forced : {false, true}) {
    expect_bytes<rolling_newton>("newton", 11, 7, forced);
    expect_bytes<inelastic_newton>("inelastic newton", 11, 7, forced);
    const contact_rows rows(9, 7, 12);
    expect_bytes<fitted_solver>("fitted", unlike, 1e-14, false, forced, rows);
    for (int k = 0; k < 16; ++k) {
      tangential_solver::setup s;
      s.forced = forced;
      s.inelastic = k & 1;
      s.plastic = k & 2;
      s.history = k & 4;
      s.transient = k & 8 ? &plans : nullptr;
      s.moves = k & 8;
      expect_bytes<tangential_solver>("solver", 11, 7, s);
    }
  }
  expect_bytes<contact_rows>("contact rows", 9, 7, 12);
  const contact_rows rows(9, 7, 12);
  for (bool line : {false, true})
    for (double layer : {0.0, 1e-14})
      expect_bytes<fitted_operator>("fitted operator", unlike, layer, line, rows);
}

// All elements in contact, on the greatest grid; pressure that leaves some sticking.
struct full_grid {
  grid g;
  field pressure, bound, px, py, sx, sy, ux, uy;
  std::vector<unsigned char> division;
  rolling_input input;
  full_grid(int nx, int ny) : g{nx, ny, 1e-3, 1e-3, -0.5e-3 * (nx - 1), -0.5e-3 * (ny - 1)} {
    const auto n = static_cast<size_t>(g.count());
    for (auto *f : {&px, &py, &sx, &sy, &ux, &uy}) f->assign(n, 0.0);
    division.assign(n, 0);
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const double x = 2 * g.x(i) / (nx * g.dx), y = 2 * g.y(j) / (ny * g.dy);
        pressure.push_back(1e9 * std::sqrt(2.01 - x * x - y * y));
        bound.push_back(0.3 * pressure.back());
      }
    input.creepage[0] = 1e-3;
    input.creepage[1] = 5e-4;
  }
  tangential_fields fields() {
    return {px.data(), py.data(), sx.data(), sy.data(), division.data()};
  }
};

// f, with what it makes, leaves all marks as they were
template <class F>
void expect_within(const char *name, F &&f) {
  overrun = 0;
  f();
  EXPECT_EQ(overrun, 0) << name;
}

TEST(Buffers, AreNotOverrun) {
  for (const auto &[nx, ny] : {std::pair{9, 9}, {7, 4}, {12, 5}, {4, 11}, {17, 1}}) {
    SCOPED_TRACE(testing::Message() << nx << " x " << ny);
    full_grid f(nx, ny);
    const size_t n = f.px.size();
    const auto planned = [nx = nx, ny = ny] {
      return fft_plans({smooth_size(2 * nx + 1)}, {ny > 1 ? smooth_size(2 * ny - 1) : 1});
    };
    influence::medium of{unlike};
    for (int curved = 0; curved < 2; ++curved)
      expect_within("products", [&] {
        const fft_plans plans = planned();
        of.curved = curved;
        influence a(of, plans);
        ASSERT_TRUE(a.set_grid(f.g));
        field cosine(n, 0.8), sine(n, 0.6);
        if (curved) a.set_rows(cosine.data(), sine.data());
        for (int direction : {-1, 1}) {
          a.rolling_product(f.bound.data(), f.bound.data(), direction, f.ux.data(), f.uy.data());
          a.rolling_product_single(f.bound.data(), f.bound.data(), direction, f.ux.data(),
                                   f.uy.data());
        }
        a.tangential_product(f.bound.data(), f.bound.data(), f.ux.data(), f.uy.data());
        a.tangential_product_single(f.bound.data(), f.bound.data(), f.ux.data(), f.uy.data());
        a.normal_product(f.bound.data(), f.ux.data());
        a.normal_product_single(f.bound.data(), f.ux.data());
        a.normal_inverse(f.bound.data(), f.ux.data());
        coupling_influence flat(unlike, false, plans);
        conformal_coupling turned(a, f.g.count());
        for (coupling_operator *c :
             {static_cast<coupling_operator *>(&flat), static_cast<coupling_operator *>(&turned)}) {
          if (!curved && c == &turned) continue;
          ASSERT_TRUE(c->set_grid(f.g));
          for (double offset : {0.0, f.g.dx})
            c->from_pressure(offset, f.bound.data(), f.ux.data(), f.uy.data());
          c->from_traction(f.bound.data(), f.bound.data(), f.ux.data());
        }
        if (curved) return;
        offset_influence offset(plans), moved(plans, true);
        const double apart[2] = {f.g.dx, -f.g.dy};
        offset.product(a, f.g, f.g.dx, f.bound.data(), f.bound.data(), f.ux.data(), f.uy.data());
        moved.add_moved(a, f.g, f.g, apart, 1.0, f.bound.data(), f.bound.data(), f.ux.data(),
                        f.uy.data());
      });
    of.curved = false;
    expect_within("solver", [&] {
      const fft_plans plans = planned();
      influence a(of, plans), by_length(of, plans);
      ASSERT_TRUE(a.set_grid(f.g) && by_length.set_grid(f.g));
      tangential_solver solver(f.g.nx, f.g.ny, {});
      for (double size : {0.0, 1e-5, 1e-3, 1e-1}) {
        f.input.creepage[0] = size;
        solver.solve({a, f.g, f.pressure.data(), f.bound.data(), f.input, {1e-6, 50}, f.fields()});
        tangential_derivative derivative(f.g.nx, f.g.ny, 5);
        const tangential_point point{
            a,           &by_length,  *solver.blocks(),  f.g,         f.input,
            0.3,         nullptr,     f.pressure.data(), f.px.data(), f.py.data(),
            f.sx.data(), f.sy.data(), f.division.data()};
        std::vector<tangential_variation> in(5);
        for (auto &v : in) {
          v.pressure = f.pressure.data();
          v.size[0] = v.size[1] = 1;
        }
        std::vector<tangential_change> out(5);
        derivative.solve(point, in.data(), 5, {1e-6, true}, out.data());
        derivative.begin_resultants(point, {1e-6, true});
        derivative.resultants(point, in[0], out[0]);
      }
      prescribed_force force;
      force.component[0] = force.component[1] = true;
      force.force[0] = 1e-4 * 1e9 * 1e-6 * static_cast<double>(n);
      f.input.force = &force;
      f.input.creepage[0] = f.input.creepage[1] = 0;
      tangential_solver::setup setup;
      setup.forced = true;
      tangential_solver forced(f.g.nx, f.g.ny, setup);
      forced.solve({a, f.g, f.pressure.data(), f.bound.data(), f.input, {1e-6, 50}, f.fields()});
      f.input.force = nullptr;
      f.input.creepage[0] = 1e-3;
      coarse_start start(of, plans, f.g.nx, f.g.ny);
      start.find(f.g, f.pressure.data(), f.bound.data(), f.input, {1e-6, 50}, f.fields());
    });
    expect_within("fitted", [&] {
      contact_rows rows(f.g.nx, f.g.ny, 14);
      fitted_solver solver(unlike, 1e-14, false, false, rows);
      const double axes[2] = {5e-3, 4e-3};
      rows.set_ellipse(axes, 8e4);
      field x(n), y(n), h(n), p(n);
      const fitted_fields fitted = {x.data(), y.data(), h.data(), p.data(), f.fields()};
      solver.solve(rows, 0.3, f.input, {1e-6, 50}, fitted);
      field grid_pressure(14 * 14, 1e8);
      rows.set_pressure({14, 14, 1e-3, 1e-3, 0, 0}, grid_pressure.data());
      solver.solve(rows, 0.3, f.input, {1e-6, 50}, fitted);
      // areas beside each other, as many as there can be
      for (size_t k = 0; k < grid_pressure.size(); ++k) grid_pressure[k] = k / 14 % 2 ? 0 : 1e8;
      rows.set_pressure({14, 14, 1e-3, 1e-3, 0, 0}, grid_pressure.data());
    });
  }
}

}  // namespace
