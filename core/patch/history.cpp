#include "patch/history.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

patch_history::patch_history(int max_count, bool steps, bool moves, const bound_law *law,
                             int curved) {
  const auto n = static_cast<size_t>(max_count);
  if (steps && curved > 0) {
    last_angle = aligned_buffer<double>(static_cast<size_t>(curved));
    last_pressure = aligned_buffer<double>(n);
  }
  if (steps && !moves && curved == 0) last_pressure = aligned_buffer<double>(n);
  if (steps)
    for (auto *b : {&last_px, &last_py, &energy, &last_energy}) *b = aligned_buffer<double>(n);
  if (!law) return;
  after = aligned_buffer<carried_state>(n);
  friction = aligned_buffer<double>(n);
  if (steps) before = aligned_buffer<carried_state>(n);
  if (steps && moves) last_states = aligned_buffer<carried_state>(n);
  if (!law->plastic()) return;
  yield_stress = aligned_buffer<double>(n);
  for (int c = 0; c < 2; ++c) {
    plastic[c] = aligned_buffer<double>(n);
    if (steps) plastic_before[c] = aligned_buffer<double>(n);
  }
}

size_t patch_history::bytes() const {
  return step_bytes() + plastic_bytes() + after.bytes() + friction.bytes();
}

void patch_history::begin(const grid &g, double upstream, const double *px, const double *py,
                          const double *pressure) {
  if (!keeps_steps()) return;
  const auto count = static_cast<size_t>(g.count());
  if (!begun) {
    // fresh material everywhere, without traction
    for (auto *b : {&last_px, &last_py, &last_energy}) std::fill_n(b->data(), count, 0.0);
    if (last_pressure.size()) std::fill_n(last_pressure.data(), count, 0.0);
    if (has_law()) std::fill_n(before.data(), count, carried_state{{0, 0, 0}});
    for (auto &p : plastic_before)
      if (p.size()) std::fill_n(p.data(), count, 0.0);
  } else {
    std::copy_n(px, count, last_px.data());
    std::copy_n(py, count, last_py.data());
    std::copy_n(energy.data(), count, last_energy.data());
    if (pressure && last_pressure.size() && last_angle.size() == 0)
      std::copy_n(pressure, count, last_pressure.data());
    if (has_law()) shift_states(g, upstream);
    for (int c = 0; c < 2; ++c)
      if (plastic[c].size())
        shift_field(g, upstream, 0.0, plastic[c].data(), plastic_before[c].data());
  }
  begun = true;
}

void patch_history::remember(const grid &g, const std::array<double, 3> &reference, double share,
                             const double *px, const double *py) {
  held = begun;
  if (!held) return;
  last_grid = g;
  last_reference = reference;
  last_share = share;
  std::copy_n(px, g.count(), last_px.data());
  std::copy_n(py, g.count(), last_py.data());
  std::copy_n(energy.data(), g.count(), last_energy.data());
  if (has_law()) std::copy_n(after.data(), g.count(), last_states.data());
}

void patch_history::remember_curve(const double *pressure, const double *angle) {
  if (!held || last_angle.size() == 0) return;
  std::copy_n(angle, last_grid.ny, last_angle.data());
  std::copy_n(pressure, last_grid.count(), last_pressure.data());
  last_bent = bent;
}

void patch_history::begin_states(const grid &g) {
  if (has_law()) std::fill_n(before.data(), g.count(), carried_state{{0, 0, 0}});
}

// Straight between elements in both directions, nothing beyond. Divisions into patches count with
// their shares, as tractions do: what several of them carry is their mean.
void patch_history::add_states(const grid &g, const past_tractions &past) {
  const patch_history &last = *past.history;
  if (!last.has_law()) return;
  const grid &from = last.last_grid;
  const auto first = static_cast<ptrdiff_t>(past.first_row) * from.nx;
  const carried_state *states = last.last_states.data() + first;
  const int nx = from.nx, ny = past.rows;
  const double place[2] = {past.offset[0] / g.dx, past.offset[1] / g.dy};
  const double whole[2] = {std::floor(place[0]), std::floor(place[1])};
  const double u = place[0] - whole[0], v = place[1] - whole[1];
  const double weight[2][2] = {{(1 - v) * (1 - u), (1 - v) * u}, {v * (1 - u), v * u}};
  const auto within = [](double w, int n) {
    return static_cast<int>(std::clamp(w, -2.0 - n, 2.0 + n));
  };
  const int column = within(whole[0], std::max(nx, g.nx)),
            row = within(whole[1], std::max(ny, g.ny));
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      double *to = before[static_cast<size_t>(j * g.nx + i)].v;
      for (int b = 0; b < 2; ++b)
        for (int a = 0; a < 2; ++a) {
          const int k = column + i + a, l = row + j + b;
          if (k < 0 || l < 0 || k >= nx || l >= ny) continue;
          const double *state = states[l * nx + k].v;
          for (int c = 0; c < 3; ++c) to[c] += last.last_share * weight[b][a] * state[c];
        }
    }
}

void patch_history::shift_states(const grid &g, double upstream) {
  const double elements = upstream / g.dx, whole = std::floor(elements), share = elements - whole;
  const int step = static_cast<int>(std::clamp(whole, -1.0 - g.nx, 1.0 + g.nx));
  const carried_state none{{0, 0, 0}};
  for (int j = 0; j < g.ny; ++j) {
    const carried_state *row = after.data() + j * g.nx;
    for (int i = 0; i < g.nx; ++i) {
      const auto at = [&](int k) -> const carried_state & {
        return k >= 0 && k < g.nx ? row[k] : none;
      };
      const carried_state &a = at(i + step), &b = at(i + step + 1);
      double *to = before[static_cast<size_t>(j * g.nx + i)].v;
      for (int c = 0; c < 3; ++c) to[c] = (1.0 - share) * a.v[c] + share * b.v[c];
    }
  }
}

void patch_history::start_from_before(const grid &g, const bound_law &law, bool goes_on) {
  if (!has_law()) return;
  const auto count = static_cast<size_t>(g.count());
  std::fill_n(friction.data(), count, 0.0);
  for (size_t i = 0; i < count; ++i) {
    after[i] = goes_on ? before[i] : carried_state{{0, 0, 0}};
    after[i].v[0] = 0;
  }
  if (!law.plastic()) return;
  for (int c = 0; c < 2; ++c) {
    if (goes_on)
      std::copy_n(plastic_before[c].data(), count, plastic[c].data());
    else
      std::fill_n(plastic[c].data(), count, 0.0);
  }
  for (size_t i = 0; i < count; ++i) {
    const double *u = after[i].v + 1;
    double slope;
    yield_stress[i] = law.yield.at(law.by_magnitude ? hypot(u[0], u[1]) : u[0], slope);
  }
}

void patch_history::plastic_work(const grid &g, int direction, const double *px, const double *py,
                                 double *work) const {
  std::fill_n(work, g.count(), 0.0);
  for (int j = 0; j < g.ny; ++j) {
    double carried[2] = {0, 0};
    for (int k = 0; k < g.nx; ++k) {
      const auto at = static_cast<size_t>(j * g.nx + (direction > 0 ? g.nx - 1 - k : k));
      const double p[2] = {px[at], py[at]};
      if (p[0] == 0 && p[1] == 0) continue;
      for (int c = 0; c < 2; ++c) {
        const double now = plastic[c][at];
        work[at] += p[c] * (now - (before.size() ? plastic_before[c][at] : carried[c]));
        carried[c] = now;
      }
      // of the sign of p; what is left is rounding
      work[at] = std::max(work[at], 0.0);
    }
  }
}

inelastic_fields patch_history::fields(bound_law &law, bool goes_on) {
  return {&law,
          goes_on ? before.data() : nullptr,
          after.data(),
          plastic[0].data(),
          plastic[1].data(),
          yield_stress.data(),
          friction.data()};
}

}  // namespace railpatch
