#include "solve.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "log.hpp"
#include "mapping.hpp"
#include "registry.hpp"

namespace contact_addon {

namespace {

bool remembers(const problem &p) { return p.mapped.config.regime_changes == 1; }

void make_contact(problem &p) {
  rp_config config = p.mapped.config;
  config.undeformed_distance = p.mapped.distance.empty() ? nullptr : p.mapped.distance.data();
  if (p.wheel_rail())
    for (int s = 0; s < 2; ++s) {
      config.wheel[s] = p.mapped.wheel_profile.view();
      config.rail[s] = p.mapped.rail_profile.view();
    }
  std::vector<rp_profile> wheels, rails;
  const auto along = [&config](const matched_slices *slices, std::vector<rp_profile> &views,
                               const rp_profile **profiles, const double **places, int32_t *counts,
                               const int32_t **kinks) {
    if (slices == nullptr) return;
    views = slices->views();
    profiles[config.side] = views.data();
    places[config.side] = slices->place.data();
    counts[config.side] = static_cast<int32_t>(views.size());
    kinks[config.side] = slices->kink.data();
  };
  along(p.mapped.wheel_slices.get(), wheels, config.wheel_sections, config.wheel_section_angle,
        config.wheel_section_count, config.wheel_section_kink);
  along(p.mapped.rail_slices.get(), rails, config.rail_sections, config.section_position,
        config.section_count, config.section_kink);
  rp_message message{};
  rp_contact *made = nullptr;
  const rp_error error = rp_create(&config, &made, &message);
  if (error != RP_OK)
    throw refusal{error == RP_ERROR_PROFILE ? error_profile : error_other, message.text};
  p.contact.reset(made);
}

// The last step, of steady rolling and with its slip by element, with the handle that goes on from
// it.
void roll_steadily(problem &p, const std::vector<double> &slip) {
  rp_input in = p.input;
  in.slip_field = slip.empty() ? nullptr : slip.data();
  in.step_regime = RP_STEADY_ROLLING;
  rp_result result;
  rp_message message{};
  if (rp_step(p.contact.get(), &in, &result, &message) != RP_OK)
    throw refusal{error_other, message.text};
}

// The case and its handle, as long as nothing was changed the ones of before.
void prepare(problem &p) {
  if (p.contact && !p.changed) return;
  const int sequence = p.flags.get(flag_sequence);
  const bool goes_on = p.contact && sequence != 2;
  mapped_case mapped = map_case(p, goes_on && remembers(p));
  if (p.contact && same_case(mapped, p.mapped)) {
    p.mapped.grid = mapped.grid;
    p.mapped.slip = std::move(mapped.slip);
    p.changed = false;
    return;
  }
  const bool without = mapped.config.regime == RP_REGIME_NONE;  // nothing to lose
  if (goes_on && remembers(p) && !without)
    throw refusal{error_grid_changed,
                  "settings changed within a sequence (P = " + std::to_string(sequence) +
                      "): its tractions would be lost; P = 2 begins a new one"};
  // what a step of steady rolling left is not known to a case without history: once more
  const bool from_steady = goes_on && p.solved && mapped.config.regime_changes == 1 &&
                           p.mapped.config.regime == RP_STEADY_ROLLING;
  mapped_case before = p.mapped;
  if (from_steady) let_regime_change(before.config);
  const bool same = from_steady && same_case(mapped, before);
  p.mapped = std::move(mapped);
  p.contact.reset();
  p.state_before.clear();
  make_contact(p);
  p.changed = false;
  if (same) roll_steadily(p, before.slip);
}

void begin(problem &p) {
  const int sequence = p.flags.get(flag_sequence);
  if (sequence == 1)
    throw refusal{error_other, "P = 1, a sequence without its tractions, has no counterpart"};
  if (!remembers(p)) {
    if (p.flags.get(flag_start) == 0) rp_reset(p.contact.get());
    return;
  }
  rp_contact *contact = p.contact.get();
  if (sequence == 2) rp_reset(contact);
  if (sequence == 3 && !p.state_before.empty()) {
    rp_restore_state(contact, p.state_before.data(), p.state_before.size());
  } else {
    p.state_before.resize(rp_state_size(contact));
    rp_save_state(contact, p.state_before.data(), p.state_before.size());
  }
}

int elements_at_edge(const problem &p) {
  const rp_patch_result &r = p.result.side[RP_RIGHT].patch[0];
  const std::vector<double> division = field_of(p, p.icp, RP_FIELD_ELEMENT_DIVISION);
  const grid_data g = grid_of(p, r);
  int count = 0;
  for (int j = 0; j < g.my; ++j)
    for (int i = 0; i < g.mx; ++i) {
      const bool edge = i == 0 || j == 0 || i == g.mx - 1 || j == g.my - 1;
      const auto at = static_cast<size_t>(j) * static_cast<size_t>(g.mx) + static_cast<size_t>(i);
      if (edge && at < division.size() && division[at] > 0.5) ++count;
    }
  return count;
}

int code_of(const problem &p) {
  const rp_result &r = p.result;
  if (r.status == RP_CONVERGED || r.status == RP_NO_CONTACT) return error_none;
  switch (r.reason) {
    case RP_REASON_BORDER:
      return p.wheel_rail() ? error_normal : elements_at_edge(p);
    case RP_REASON_NORMAL_ITERATIONS:
    case RP_REASON_COUPLING:
    case RP_REASON_NO_GRID:
      return error_normal;
    case RP_REASON_FORCE_SEARCH:
    case RP_REASON_TOO_DEEP:
    case RP_REASON_RAIL_SEARCH:
    case RP_REASON_RAIL_BEYOND:
    case RP_REASON_WORK:
      return error_total_force;
    case RP_REASON_NO_OVERLAP:
    case RP_REASON_TOO_MANY_PATCHES:
    case RP_REASON_PROFILE_END:
      return error_search;
    case RP_REASON_GRID_ROOM:
      return error_other;
    default:
      return error_tangential;
  }
}

struct stopwatch {
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
  std::clock_t cpu = std::clock();
  void add(problem &p) const {
    p.wall += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
    p.cpu += static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  }
};

}  // namespace

int solve(problem &p, const char *call) {
  if (p.flags.get(flag_return) >= 2) return error_none;  // read, not computed
  const stopwatch watch;
  try {
    prepare(p);
    p.input = map_input(p, p.mapped);
    begin(p);
  } catch (const refusal &why) {
    p.solved = false;
    say(call, why.text);
    return why.code;
  }
  rp_message message{};
  const rp_error error = rp_step(p.contact.get(), &p.input, &p.result, &message);
  ++p.cases;
  p.solved = error == RP_OK;
  p.touching = p.solved && p.result.status != RP_NO_CONTACT;
  watch.add(p);
  if (!p.solved) {
    say(call, message.text);
    return error == RP_ERROR_PROFILE ? error_profile : error_other;
  }
  const int code = code_of(p);
  if (code != error_none) say(call, rp_reason_text(p.result.reason));
  if (p.flags.get(flag_output) >= 1)
    say(call, "case " + std::to_string(p.cases) + " of result element " + std::to_string(p.ire) +
                  ": " + rp_status_text(p.result.status));
  return code;
}

int index_of(const problem &p, int icp) { return p.wheel_rail() ? icp - 1 : 0; }

const rp_patch_result *patch_of(const problem &p, int icp) {
  const int at = index_of(p, icp);
  if (!p.solved || at < 0 || at >= p.patches()) return nullptr;
  return &p.at_side().patch[at];
}

grid_data grid_of(const problem &p, const rp_patch_result &r) {
  if (!p.wheel_rail()) return p.mapped.grid;
  grid_data g;
  g.mx = r.grid[0];
  g.my = r.grid[1];
  g.x0 = r.grid_origin[0];
  g.y0 = r.grid_origin[1];
  g.dx = r.element_size[0];
  g.dy = r.element_size[1];
  return g;
}

const profile_curve &profile_now(const problem &p, bool rail) {
  matched_slices *slices = (rail ? p.mapped.rail_slices : p.mapped.wheel_slices).get();
  if (slices && p.solved) return slice_at(*slices, rail ? p.input.x : p.input.pitch);
  return p.solved ? (rail ? p.mapped.rail_profile : p.mapped.wheel_profile)
                  : (rail ? p.wheel.rail_profile : p.wheel.wheel_profile);
}

std::vector<double> field_of(const problem &p, int icp, rp_field field, int parts) {
  const rp_patch_result *r = patch_of(p, icp);
  if (r == nullptr) return {};
  const auto nx = static_cast<size_t>(r->grid[0]), ny = static_cast<size_t>(r->grid[1]);
  size_t n = nx * ny * static_cast<size_t>(parts);
  std::vector<double> own(n);
  if (rp_get_field(p.contact.get(), p.side(), index_of(p, icp), field, own.data(), &n) != RP_OK)
    return {};
  if (p.wheel_rail() || p.mapped.on_own_grid) return own;
  // Hertz's grid of the core in the caller's: the element that holds the caller's centre
  const grid_data g = p.mapped.grid;
  const bool line = p.mapped.config.geometry == RP_LINE_CONTACT;
  const double wide = line ? p.mapped.config.width : r->element_size[1];
  const auto count = static_cast<size_t>(g.mx) * static_cast<size_t>(g.my);
  std::vector<double> out(count * static_cast<size_t>(parts));
  for (int part = 0; part < parts; ++part)
    for (int j = 0; j < g.my; ++j)
      for (int i = 0; i < g.mx; ++i) {
        const double x = (g.x0 + i * g.dx - r->grid_origin[0]) / r->element_size[0];
        const double y = (g.y0 + j * g.dy - (line ? 0.0 : r->grid_origin[1])) / wide;
        const double k = std::floor(x + 0.5), m = std::floor(y + 0.5);
        if (k < 0 || m < 0 || k >= r->grid[0] || m >= r->grid[1]) continue;
        const size_t from =
            (static_cast<size_t>(part) * ny + static_cast<size_t>(m)) * nx + static_cast<size_t>(k);
        out[static_cast<size_t>(part) * count + static_cast<size_t>(j) * static_cast<size_t>(g.mx) +
            static_cast<size_t>(i)] = own[from];
      }
  return out;
}

double spin_moment_of(const problem &p, const rp_patch_result &r) {
  return r.spin_moment + p.mapped.offset[0] * r.creep_force[1] -
         p.mapped.offset[1] * r.creep_force[0];
}

}  // namespace contact_addon
