// The state that later steps of a handle depend on, as plain bytes.
#include <algorithm>
#include <cstddef>
#include <cstring>

#include "handle/case_fields.hpp"
#include "handle/check.hpp"
#include "handle/checker.hpp"
#include "handle/contact.hpp"
#include "handle/contact_derivative.hpp"
#include "patch/patch_state.hpp"

namespace railpatch {

namespace {

constexpr uint32_t state_magic = 0x52505334;  // "RPS4"

struct state_header {
  uint32_t magic, kind;
  uint64_t bytes, checksum;
  // the checksum covers all that follows
  uint64_t fingerprint;
  double depth, friction_coefficient;
  uint64_t level;
  double excess;
};
// of one patch, at most
constexpr size_t max_state_fields = 16;
constexpr size_t checked_from = offsetof(state_header, fingerprint);

// FNV-1a (Fowler, Noll, Vo 1991)
uint64_t checksum(const unsigned char *data, size_t size) {
  uint64_t hash = 14695981039346656037ull;
  for (size_t i = 0; i < size; ++i) hash = (hash ^ data[i]) * 1099511628211ull;
  return hash;
}

// Tells the states of one config from those of another.
uint64_t fingerprint_of_numbers(const rp_config &c) {
#define RP_NO_FIELD(type, name, count)
#define RP_IS_TOLD(role) \
  (case_role::role != case_role::points && case_role::role != case_role::unmarked)
#define RP_COUNT(type, name, count, role, ...) +(RP_IS_TOLD(role) ? (count) : 0)
#define RP_PUT(type, name, count, role, ...) \
  if (RP_IS_TOLD(role))                      \
    for_each_in(c.name, [&](const auto &v) { values[next++] = static_cast<double>(v); });
  double values[0 RP_CONFIG_FIELDS(RP_COUNT, RP_NO_FIELD)];
  size_t next = 0;
  RP_CONFIG_FIELDS(RP_PUT, RP_NO_FIELD)
  unsigned char bytes[sizeof values];
  std::memcpy(bytes, values, sizeof values);
  return checksum(bytes, sizeof bytes);
}

// The same for the arrays that come with a config.
uint64_t fingerprint_of_arrays(const rp_config &c) {
  uint64_t hash = 0;
  const auto add = [&](const double *values, size_t count) {
    if (!values) return;
    const auto *bytes = reinterpret_cast<const unsigned char *>(values);
    hash = hash * 31 + checksum(bytes, count * sizeof(double));
  };
  const auto add_kinks = [&](const int32_t *values, int32_t count) {
    for (int32_t i = 0; values && i < count; ++i)
      hash = hash * 31 + static_cast<uint64_t>(values[i] != 0);
  };
  if (c.kind == RP_PATCH && c.geometry == RP_UNDEFORMED_DISTANCE)
    add(c.undeformed_distance,
        static_cast<size_t>(c.distance_shape[0]) * static_cast<size_t>(c.distance_shape[1]));
  if (c.own_influence != 0) add(c.influence_coefficients, count_of_own_influence(c));
  const auto points = static_cast<size_t>(c.friction_points);
  add(c.friction_position, points);
  add(c.friction_factor, points);
  const auto along = static_cast<size_t>(c.friction_along_points);
  add(c.friction_along_position, along);
  add(c.friction_along_factor, along);
  const auto viscosities = static_cast<size_t>(c.fluid_viscosity_points);
  add(c.fluid_viscosity_temperature, viscosities);
  add(c.fluid_viscosity_value, viscosities);
  const auto knots = static_cast<size_t>(c.fluid_knots);
  for (const double *values : {c.fluid_knot_rate, c.fluid_knot_k_a, c.fluid_knot_k_s,
                               c.fluid_knot_coefficient, c.fluid_knot_a, c.fluid_knot_b})
    add(values, knots);
  const auto hardening = static_cast<size_t>(c.hardening_points);
  add(c.hardening_displacement, hardening);
  add(c.hardening_stress, hardening);
  if (uses_table(c)) {
    creep_table_header header;
    std::memcpy(&header, c.creep_table, sizeof header);
    hash = hash * 31 + header.checksum;
  }
  if (c.kind == RP_PATCH) return hash;
  const auto add_profile = [&](const rp_profile &p) {
    for (const double *values : {p.arc_length, p.y, p.z, p.dy, p.dz})
      add(values, static_cast<size_t>(std::max(p.count, 0)));
  };
  // only profiles that a wheel is made from have been looked at
  const auto is_used = [&](int side) { return c.kind != RP_WHEEL_RAIL || side == c.side; };
  for (int side = 0; side < 2; ++side)
    if (is_used(side) && c.wheel_section_count[side] == 0) add_profile(c.wheel[side]);
  for (int side = 0; side < 2; ++side)
    if (is_used(side) && c.section_count[side] == 0) add_profile(c.rail[side]);
  for (int side = 0; side < 2; ++side) {
    add(c.runout[side], static_cast<size_t>(c.runout_count[side]));
    add(c.rail_height[side], static_cast<size_t>(c.rail_height_count[side]));
    if (!is_used(side)) continue;
    add(c.section_position[side], static_cast<size_t>(c.section_count[side]));
    add_kinks(c.section_kink[side], c.section_count[side]);
    add_kinks(c.wheel_section_kink[side], c.wheel_section_count[side]);
    for (int k = 0; k < c.section_count[side]; ++k) add_profile(c.rail_sections[side][k]);
    add(c.wheel_section_angle[side], static_cast<size_t>(c.wheel_section_count[side]));
    for (int k = 0; k < c.wheel_section_count[side]; ++k) add_profile(c.wheel_sections[side][k]);
  }
  return hash;
}

}  // namespace

uint64_t contact::fingerprint(const rp_config &c) {
  return fingerprint_of_numbers(c) * 31 + fingerprint_of_arrays(c);
}

size_t contact::state_size() const {
  size_t size = sizeof(state_header) + driver_->kept().all_bytes();
  for (const auto &m : driver_->memories()) {
    const patch_state_head head = head_of(m);
    size += sizeof head;
    for_each_state_field(m, head, [&](const double *, size_t bytes) { size += bytes; });
  }
  return size;
}

void contact::save_state(unsigned char *buffer) const {
  unsigned char *at = buffer + sizeof(state_header);
  const auto put = [&](const void *data, size_t size) {
    if (size) std::memcpy(at, data, size);
    at += size;
  };
  for (const auto &m : driver_->memories()) {
    const patch_state_head head = head_of(m);
    put(&head, sizeof head);
    for_each_state_field(m, head, put);
  }
  const driver::kept_numbers kept = driver_->kept();
  put(kept.more, kept.bytes);
  put(kept.heat, kept.heat_bytes);
  const auto bytes = static_cast<size_t>(at - buffer);
  state_header header{state_magic,
                      static_cast<uint32_t>(config_.kind),
                      bytes,
                      0,
                      fingerprint_,
                      kept.depth ? *kept.depth : 0.0,
                      friction_coefficient(),
                      level_,
                      excess_};
  std::memcpy(buffer, &header, sizeof header);
  header.checksum = checksum(buffer + checked_from, bytes - checked_from);
  std::memcpy(buffer, &header, sizeof header);
}

bool contact::restore_state(const unsigned char *buffer, size_t size) {
  state_header header;
  if (size < sizeof header) return false;
  std::memcpy(&header, buffer, sizeof header);
  const bool ours = header.magic == state_magic &&
                    header.kind == static_cast<uint32_t>(config_.kind) && header.bytes == size &&
                    header.fingerprint == fingerprint_ &&
                    header.checksum == checksum(buffer + checked_from, size - checked_from) &&
                    header.level < levels_.size();
  if (!ours) return false;
  driver &target = *levels_[header.level]->solver;
  if (!state_fits(target, buffer + sizeof header, size - sizeof header)) return false;
  select(header.level);
  excess_ = header.excess;
  const unsigned char *at = buffer + sizeof header;
  const auto take = [&](void *data, size_t bytes) {
    if (bytes) std::memcpy(data, at, bytes);
    at += bytes;
  };
  for (auto &m : driver_->memories()) {
    patch_state_head head;
    take(&head, sizeof head);
    set_head(m, head);
    for_each_state_field(m, head, take);
  }
  const driver::kept_numbers kept = driver_->kept();
  take(kept.more, kept.bytes);
  take(kept.heat, kept.heat_bytes);
  if (kept.depth) *kept.depth = header.depth;
  for (auto &level : levels_)
    level->solver->solver().set_friction_coefficient(header.friction_coefficient);
  if (derivative_) derivative_->solved = false;
  return true;
}

void contact::copy_state(const contact &from) {
  select(from.level_);
  excess_ = from.excess_;
  for (size_t k = 0; k < driver_->memories().size(); ++k) {
    const patch_memory &source = from.driver_->memories()[k];
    patch_memory &m = driver_->memories()[k];
    const patch_state_head head = head_of(source);
    set_head(m, head);
    const double *fields[max_state_fields];
    size_t count = 0, next = 0;
    for_each_state_field(source, head, [&](const double *data, size_t) { fields[count++] = data; });
    for_each_state_field(
        m, head, [&](double *data, size_t bytes) { std::memcpy(data, fields[next++], bytes); });
  }
  const driver::kept_numbers kept = driver_->kept(), source = from.driver_->kept();
  if (kept.bytes) std::memcpy(kept.more, source.more, kept.bytes);
  if (kept.heat_bytes) std::memcpy(kept.heat, source.heat, kept.heat_bytes);
  if (kept.depth) *kept.depth = *source.depth;
  for (auto &level : levels_)
    level->solver->solver().set_friction_coefficient(from.friction_coefficient());
}

// Walks the patches without changing anything: every grid must fit this handle's memory.
bool contact::state_fits(driver &target, const unsigned char *at, size_t size) {
  for (const auto &m : target.memories()) {
    patch_state_head head;
    if (size < sizeof head) return false;
    std::memcpy(&head, at, sizeof head);
    if (!holds(m, head) || !target.solver().fits(head.g)) return false;
    size_t bytes = sizeof head;
    for_each_state_field(m, head, [&](const double *, size_t field) { bytes += field; });
    if (size < bytes) return false;
    at += bytes;
    size -= bytes;
  }
  return size == target.kept().all_bytes();
}

}  // namespace railpatch
