// The work of a step: what creepages supply, what friction takes, and where.
//
// Of material that moves by one step from x + dq to x, friction takes -(p + p_before)/2 . s over
// the way: the traction is the mean of both ends, and elements that have just left contact count.
// With s = w + (u - u_before)/dq, tractions symmetric in their displacement (Betti) and a
// displacement that moves with its tractions, sum (p + p_before)/2 . (u - u_before) is the change
// of sum p . u/2: so the work of the rigid slip is that of friction and the change of elastic
// energy, exactly; in steady rolling it is all friction's.
#include <algorithm>
#include <cmath>

#include "numeric/sums.hpp"
#include "patch/tangential_stage.hpp"

namespace railpatch {

namespace {

constexpr double rounding = 1e-14;  // relative, of sums over elements

// What tractions that material brings along do, and hold.
struct carried_work {
  double force[2] = {0, 0}, moment = 0, energy = 0;  // N, N m, J
};

// Rows of the last step, whose first element's material was at x0, y0 then.
void add_rows(const patch_history &history, const grid &g, int first_row, int rows, double x0,
              double y0, double share, carried_work &sum) {
  const double area = share * g.dx * g.dy;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>((first_row + j) * g.nx + i);
      const double px = history.last_px[at], py = history.last_py[at];
      sum.force[0] += area * px;
      sum.force[1] += area * py;
      sum.moment += area * ((x0 + i * g.dx) * py - (y0 + j * g.dy) * px);
      sum.energy += area * history.last_energy[at];
    }
}

carried_work carried_by(const patch_problem &problem, const patch_memory &memory) {
  carried_work sum;
  const grid &g = problem.g;
  if (!problem.past) {
    add_rows(memory.history, g, 0, g.ny, g.x0, g.y0, 1.0, sum);
    return sum;
  }
  for (int k = 0; k < problem.past_count; ++k) {
    const past_tractions &past = problem.past[k];
    add_rows(*past.history, past.history->last_grid, past.first_row, past.rows,
             g.x0 - past.offset[0] + problem.rolled, g.y0 - past.offset[1],
             past.history->last_share, sum);
  }
  return sum;
}

// Where all sticks what is supplied is what is stored, but for what their sums are rounded by.
double beyond_rounding(double taken, double largest) {
  return std::abs(taken) <= rounding * largest ? 0.0 : taken;
}

}  // namespace

// Where tractions go on from the last step's: what creepages supply by the mean of both, and what
// of it friction takes, and the layer by its share.
void tangential_stage::close_step(const patch_problem &problem, const rolling_input &rolling,
                                  patch_memory &memory, tangential_result &t,
                                  traction_outcome &found) {
  if (memory.curved) return close_curved(problem, rolling, memory, t, found);
  const grid &g = problem.g;
  const patch_wrench now =
      sum_tractions(g, memory.pressure.data(), memory.px.data(), memory.py.data());
  const carried_work before = carried_by(problem, memory);
  found.elastic_energy = elastic_energy(problem, memory);
  double work = 0;
  for (int c = 0; c < 2; ++c) {
    const double found_creepage = rolling.force ? rolling.force->creepage[c] : 0.0;
    work += 0.5 * (now.force[c] + before.force[c]) * (rolling.creepage[c] + found_creepage);
  }
  work += 0.5 * (now.moment[2] + before.moment) * rolling.spin_creepage;
  if (problem.slip_field) work += field_work(problem, rolling, memory);
  found.supplied = -work;
  const double grown = (found.elastic_energy - before.energy) / rolling.distance;
  const bool moves = rolling.creepage[0] != 0 || rolling.creepage[1] != 0 ||
                     rolling.spin_creepage != 0 || rolling.force || problem.slip_field;
  if (has_physics && problem.shifts && moves)
    return close_shift(problem, rolling, memory, grown, t, found);
  if (shared_.coupled) {
    close_coupled(problem, rolling, memory, t, found);
    // what is supplied has the spin's slip at the elements themselves, and that of the tractions
    // before where these were
    t.friction += 0.5 * rolling.spin_creepage *
                  ((now.force[1] + before.force[1]) * rolling.spin_offset -
                   before.force[1] * rolling.upstream());
    return;
  }
  const double largest =
      std::max(std::abs(found.supplied), (found.elastic_energy + before.energy) / rolling.distance);
  const double taken = beyond_rounding(found.supplied - grown, largest);
  const double plastic = shared_.scene.yields() ? found.plastic_power : 0.0;
  // a step in which traction turns round may give work back, which no plastic displacement does
  if (!(plastic > 0) || taken <= 0) {
    if (plastic > 0) found.plastic_power = 0;
    t.friction = taken;
    return;
  }
  const double factor = taken / (t.friction + plastic);
  t.friction *= factor;
  found.plastic_power *= factor;
}

// Of unlike bodies pressure has its part in the energy: friction and the layer's part are counted
// where they are.
void tangential_stage::close_coupled(const patch_problem &problem, const rolling_input &rolling,
                                     const patch_memory &memory, tangential_result &t,
                                     traction_outcome &found) {
  const grid &g = problem.g;
  find_friction(problem, rolling, memory);
  t.friction = total(shared_.friction.data(), static_cast<size_t>(g.count())) * g.dx * g.dy;
  if (!shared_.scene.yields() || problem.past) return;
  const double plastic = plastic_works(problem, rolling, memory).by_mean;
  found.plastic_power = std::max(plastic, 0.0);
  t.friction += std::min(plastic, 0.0);
}

// In steady rolling too the slip that pressure causes, k, does its work on the mean of both ends'
// tractions, also of elements that have just left contact. By Betti sum (p + p_before)/2 . k is
// then the pressure's on the normal displacement by the tractions, by central differences; and as
// the gap is 0 in contact that is the pressure's on the undeformed distance: what turns the wheel
// against the pressure's moment, but for the gap beside the edge, of second order. By the traction
// of one end alone it was of first order.
void tangential_stage::close_steady(const patch_problem &problem, const rolling_input &rolling,
                                    const patch_memory &memory, tangential_result &t,
                                    traction_outcome &found) {
  const grid &g = problem.g;
  double more = 0;
  for (int c = 0; c < 2; ++c) {
    const double *now = c == 0 ? memory.px.data() : memory.py.data();
    // the rigid slip of elements and rows is in the same array, and does its work at the element
    const double *field = problem.slip_field ? problem.slip_field + c * g.count() : nullptr;
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const int at = j * g.nx + i, upstream = i + rolling.direction;
        const double before = upstream >= 0 && upstream < g.nx ? now[at + rolling.direction] : 0.0;
        double slip = rolling.coupled[c][at];
        if (field) slip -= field[at];
        if (memory.curved) slip -= memory.curved->slip(c, j, g.x(i) + rolling.spin_offset);
        more -= 0.5 * (before - now[at]) * slip;
      }
  }
  more *= g.dx * g.dy;
  const double plastic = shared_.scene.yields() ? found.plastic_power : 0.0;
  if (!(plastic > 0)) {
    // where all sticks there is nothing but the tolerance of the solution
    t.friction = std::max(0.0, t.friction + more);
    return;
  }
  const double factor = std::max(0.0, 1.0 + more / (t.friction + plastic));
  t.friction *= factor;
  found.plastic_power *= factor;
}

// The same on a curved reference surface. Every row has a rigid slip of its own, and pressure moves
// its elements along too: by u_p, in the energy p . (u + u_p)/2 of the tractions. What their mean
// does by the change of u_p is the change of sum p . u_p/2 and of half of what each step's pressure
// does with the other's tractions, by Betti at the elements of this one.
void tangential_stage::close_curved(const patch_problem &problem, const rolling_input &rolling,
                                    patch_memory &memory, tangential_result &t,
                                    traction_outcome &found) {
  const grid &g = problem.g;
  const auto count = static_cast<size_t>(g.count());
  patch_history &history = memory.history;
  found.elastic_energy = elastic_energy(problem, memory);
  double *u[2] = {shared_.mean[0].data(), shared_.mean[1].data()};
  shared_.coupled->displacement(memory.pressure.data(), u[0], u[1]);
  double pressed = 0, crossed = 0;
  for (size_t i = 0; i < count; ++i) {
    const double own = 0.5 * (memory.px[i] * u[0][i] + memory.py[i] * u[1][i]);
    history.energy[i] += own;
    pressed += own;
    crossed += memory.pressure[i] * before_gap_[i] - memory.px[i] * before_pressed_[0][i] -
               memory.py[i] * before_pressed_[1][i];
  }
  const double area = g.dx * g.dy;
  const carried_work before = carried_by(problem, memory);
  const double stored = found.elastic_energy + pressed * area;
  const double grown = (stored - before.energy + 0.5 * crossed * area) / rolling.distance;
  const double supplied = supplied_to_rows(problem, memory);
  const double largest =
      std::max(std::abs(supplied), (std::abs(stored) + std::abs(before.energy)) / rolling.distance);
  t.friction = beyond_rounding(supplied - grown, largest);
  // creepages are those of the reference, and force and moment what the patch states
  const patch_wrench flat =
      sum_tractions(g, memory.pressure.data(), memory.px.data(), memory.py.data());
  const patch_wrench now =
      memory.curved->sum_tractions(g, memory.pressure.data(), memory.px.data(), memory.py.data());
  history.bent = {now.force[0] - flat.force[0], now.force[1] - flat.force[1],
                  now.moment[2] - flat.moment[2]};
  double last[3] = {before.force[0], before.force[1], before.moment};
  for (int k = 0; k < problem.past_count; ++k) {
    const past_tractions &past = problem.past[k];
    const double part = past.history->last_share * past.rows / past.history->last_grid.ny;
    for (size_t c = 0; c < 3; ++c) last[c] += part * past.history->last_bent[c];
  }
  const rolling_input &moved = problem.rolling;
  found.supplied = -0.5 * ((now.force[0] + last[0]) * moved.creepage[0] +
                           (now.force[1] + last[1]) * moved.creepage[1] +
                           (now.moment[2] + last[2]) * moved.spin_creepage);
}

// N, over the way: what the rigid slip of rows does on the mean of both ends' tractions, the
// earlier ones where they were then.
double tangential_stage::supplied_to_rows(const patch_problem &problem,
                                          const patch_memory &memory) const {
  if (!(problem.rolling_speed > 0)) return 0.0;
  const grid &g = problem.g;
  const conformal_rows &rows = *memory.curved;
  double sum = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>(j * g.nx + i);
      sum += memory.px[at] * rows.slip(0, j, g.x(i)) + memory.py[at] * rows.slip(1, j, g.x(i));
    }
  for (int k = 0; k < problem.past_count; ++k) {
    const past_tractions &past = problem.past[k];
    const patch_history &last = *past.history;
    const double x0 = g.x0 - past.offset[0] + problem.rolled;
    for (int j = 0; j < past.rows; ++j)
      for (int i = 0; i < last.last_grid.nx; ++i) {
        const auto at = static_cast<size_t>((past.first_row + j) * last.last_grid.nx + i);
        const double x = x0 + i * g.dx, row = j - past.offset[1] / g.dy;
        sum += last.last_share *
               (last.last_px[at] * rows.slip(0, row, x) + last.last_py[at] * rows.slip(1, row, x));
      }
  }
  return -0.5 * sum * g.dx * g.dy;
}

// N, over the way: what the slip prescribed of each element does on the mean of both ends'
// tractions, the earlier ones where the material is now.
double tangential_stage::field_work(const patch_problem &problem, const rolling_input &rolling,
                                    const patch_memory &memory) {
  if (!(problem.rolling_speed > 0) && !problem.shifts) return 0.0;
  const grid &g = problem.g;
  const double *now[2] = {memory.px.data(), memory.py.data()};
  const double *last[2] = {memory.history.last_px.data(), memory.history.last_py.data()};
  double *before = shared_.mean[0].data(), sum = 0;
  for (int c = 0; c < 2; ++c) {
    shift_field(g, rolling.upstream(), 0.0, last[c], before);
    for (int i = 0; i < g.count(); ++i)
      sum += (now[c][i] + before[i]) * problem.slip_field[c * g.count() + i];
  }
  return 0.5 * sum * g.dx * g.dy;
}

// N: what creepages, spin and the slip of each element supply in steady rolling.
double tangential_stage::rigid_work(const patch_problem &problem, const rolling_input &rolling,
                                    const prescribed_force &force,
                                    const patch_memory &memory) const {
  const grid &g = problem.g;
  const patch_wrench w =
      sum_tractions(g, memory.pressure.data(), memory.px.data(), memory.py.data());
  double work = w.moment[2] * rolling.spin_creepage;
  for (int c = 0; c < 2; ++c) {
    work += w.force[c] * (rolling.creepage[c] + force.creepage[c]);
    if (!(problem.rolling_speed > 0)) continue;
    const double *p = c == 0 ? memory.px.data() : memory.py.data();
    work +=
        dot(p, problem.slip_field + c * g.count(), static_cast<size_t>(g.count())) * g.dx * g.dy;
  }
  return -work;
}

// N/m^2 over the way of the step, of each element's material.
void tangential_stage::find_friction(const patch_problem &problem, const rolling_input &rolling,
                                     const patch_memory &memory) {
  const grid &g = problem.g;
  const bool steady = rolling.regime == motion::steady;
  const double *px = memory.px.data(), *py = memory.py.data();
  double *before[2] = {shared_.mean[0].data(), shared_.mean[1].data()};
  const double upstream = steady ? rolling.direction * g.dx : rolling.upstream();
  shift_field(g, upstream, 0.0, steady ? px : memory.history.last_px.data(), before[0]);
  shift_field(g, upstream, 0.0, steady ? py : memory.history.last_py.data(), before[1]);
  // of elements that have left contact: what the tractions add to their slip
  double *moved[2] = {shared_.moved[0].data(), shared_.moved[1].data()};
  if (steady) {
    shared_.influence->rolling_product(px, py, rolling.direction, moved[0], moved[1]);
  } else {
    tangential_->displacement_before(*shared_.influence, g, rolling, moved[0], moved[1]);
    // elastic_energy left the present displacement there
    for (int c = 0; c < 2; ++c)
      for (size_t i = 0; i < static_cast<size_t>(g.count()); ++i)
        moved[c][i] = (shared_.scratch[c][i] - moved[c][i]) / rolling.distance;
  }
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>(j * g.nx + i);
      double slip[2] = {memory.sx[at], memory.sy[at]};
      const bool left = !(memory.pressure[at] > 0) && (before[0][at] != 0 || before[1][at] != 0);
      for (int c = 0; left && c < 2; ++c) {
        slip[c] = rolling.slip(c, g.x(i), g.y(j)) + moved[c][at];
        if (rolling.coupled[c]) slip[c] += rolling.coupled[c][at];
        if (rolling.force) slip[c] += rolling.force->creepage[c];
      }
      shared_.friction[at] =
          -0.5 * ((px[at] + before[0][at]) * slip[0] + (py[at] + before[1][at]) * slip[1]);
    }
}

// No element gives heat back, not where traction has turned round within the step. That, the place
// of the spin term and steps of parts of an element leave the sum a little off what friction takes:
// all of it becomes heat.
void tangential_stage::find_friction_heat(const patch_problem &problem,
                                          const rolling_input &rolling, const patch_memory &memory,
                                          double taken) {
  find_friction(problem, rolling, memory);
  const grid &g = problem.g;
  const auto count = static_cast<size_t>(g.count());
  // written so that what is no number stays visible
  for (size_t i = 0; i < count; ++i)
    if (shared_.friction[i] < 0) shared_.friction[i] = 0;
  const double sum = total(shared_.friction.data(), count) * g.dx * g.dy;
  if (sum == 0) return;
  const double factor = taken < 0 ? 0.0 : taken / sum;
  for (size_t i = 0; i < count; ++i) shared_.friction[i] *= factor;
}

// N, of friction's work over the way, what the shear of the liquid takes: in each element its part
// of the bound; where material has just left the contact, that of the element it comes from.
double tangential_stage::fluid_work(const grid &g, int direction,
                                    const patch_memory &memory) const {
  double sum = 0;
  for (int j = 0; j < g.ny; ++j) {
    const double factor =
        (memory.row_friction.size() ? memory.row_friction[static_cast<size_t>(j)] : 1.0) *
        shared_.scene.friction_scale;
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>(j * g.nx + i);
      const int upstream = i + direction;
      const bool left = !(bound_[at] > 0) && upstream >= 0 && upstream < g.nx;
      const auto of = static_cast<size_t>(j * g.nx + (left ? upstream : i));
      if (bound_[of] > 0)
        sum += shared_.friction[at] * (factor * memory.fluid_shear[of] / bound_[of]);
    }
  }
  return sum * g.dx * g.dy;
}

}  // namespace railpatch
