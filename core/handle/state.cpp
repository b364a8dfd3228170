// The state that later steps of a handle depend on, as plain bytes.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "handle/case_fields.hpp"
#include "handle/check.hpp"
#include "handle/contact.hpp"
#include "handle/contact_derivative.hpp"

namespace railpatch {

namespace {

constexpr uint32_t state_magic = 0x52505332;  // "RPS2"

struct state_header {
  uint32_t magic, kind;
  uint64_t bytes, checksum;
  // the checksum covers all that follows
  uint64_t scene;
  double depth, friction_coefficient;
};
constexpr size_t checked_from = offsetof(state_header, scene);
struct patch_header {
  grid g;
  vec3 reference;
  double share, rail[2];
  uint64_t warm, begun;
};

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
uint64_t fingerprint_of_arrays(const rp_config &c, const aligned_buffer<double> &shape) {
  uint64_t hash = 0;
  const auto add = [&](const double *values, size_t count) {
    if (!values) return;
    const auto *bytes = reinterpret_cast<const unsigned char *>(values);
    hash = hash * 31 + checksum(bytes, count * sizeof(double));
  };
  add(shape.data(), shape.size());
  const auto points = static_cast<size_t>(c.friction_points);
  add(c.friction_position, points);
  add(c.friction_factor, points);
  const auto along = static_cast<size_t>(c.friction_along_points);
  add(c.friction_along_position, along);
  add(c.friction_along_factor, along);
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
  for (const rp_profile *p : {&c.wheel[0], &c.wheel[1], &c.rail[0], &c.rail[1]}) add_profile(*p);
  for (int side = 0; side < 2; ++side) {
    add(c.runout[side], static_cast<size_t>(c.runout_count[side]));
    add(c.rail_height[side], static_cast<size_t>(c.rail_height_count[side]));
    // of a side without a wheel nothing has been looked at
    if (c.kind == RP_WHEEL_RAIL && side != c.side) continue;
    add(c.section_position[side], static_cast<size_t>(c.section_count[side]));
    for (int k = 0; k < c.section_count[side]; ++k) add_profile(c.rail_sections[side][k]);
  }
  return hash;
}

// of both rails, where they are on springs
size_t support_bytes(const std::unique_ptr<rail_support> &support) {
  static_assert(std::is_trivially_copyable_v<rail_support::rail>);
  return support ? 2 * sizeof(rail_support::rail) : 0;
}

// the fields that a later step starts from, at most
constexpr size_t max_start_fields = 16;
template <class Memory, class F>
void for_each_start_field(Memory &m, F &&f) {
  if (m.heat && m.heat->columns.size())
    f(m.heat->columns.data(), m.heat->columns.size() * sizeof(double));
  if (!m.warm && !m.history.begun) return;
  if (m.heat && m.heat->friction.size())
    f(m.heat->friction.data(), static_cast<size_t>(m.g.count()) * sizeof(double));
  if (m.pressure.size()) f(m.pressure.data(), static_cast<size_t>(m.g.count()) * sizeof(double));
  if (m.px.size() == 0) return;
  const auto traction = static_cast<size_t>(m.columns() * m.rows()) * sizeof(double);
  f(m.px.data(), traction);
  f(m.py.data(), traction);
  if (m.fitted()) f(m.node_pressure.data(), traction);
  if (m.creepage.size() > 0) f(m.creepage.data(), m.creepage.size() * sizeof(double));
  if (m.history.begun) m.history.for_each_kept(static_cast<size_t>(m.g.count()), f);
}

}  // namespace

uint64_t contact::fingerprint(const rp_config &c, const aligned_buffer<double> &shape) {
  return fingerprint_of_numbers(c) * 31 + fingerprint_of_arrays(c, shape);
}

size_t contact::state_size() const {
  size_t size =
      sizeof(state_header) + support_bytes(support_) + memory_.size() * sizeof(patch_header);
  for (const auto &m : memory_)
    for_each_start_field(m, [&](const double *, size_t bytes) { size += bytes; });
  return size;
}

void contact::save_state(unsigned char *buffer) const {
  unsigned char *at = buffer + sizeof(state_header);
  const auto put = [&](const void *data, size_t size) {
    std::memcpy(at, data, size);
    at += size;
  };
  for (const auto &m : memory_) {
    const patch_header header{m.g,
                              m.reference,
                              m.share,
                              {m.rail[0], m.rail[1]},
                              m.warm ? 1u : 0u,
                              m.history.begun ? 1u : 0u};
    put(&header, sizeof header);
    for_each_start_field(m, put);
  }
  if (support_) put(support_->rails(), support_bytes(support_));
  const auto bytes = static_cast<size_t>(at - buffer);
  state_header header{state_magic, static_cast<uint32_t>(config_.kind), bytes, 0, scene_,
                      depth_,      solver_.scene().friction_coefficient};
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
                    header.scene == scene_ &&
                    header.checksum == checksum(buffer + checked_from, size - checked_from);
  if (!ours || !state_fits(buffer + sizeof header, size - sizeof header)) return false;
  const unsigned char *at = buffer + sizeof header;
  for (auto &m : memory_) {
    patch_header patch;
    std::memcpy(&patch, at, sizeof patch);
    at += sizeof patch;
    m.g = patch.g;
    m.reference = patch.reference;
    m.share = patch.share;
    for (int k = 0; k < 2; ++k) m.rail[k] = patch.rail[k];
    m.warm = patch.warm != 0;
    m.history.begun = patch.begun != 0;
    m.solved = false;
    for_each_start_field(m, [&](double *data, size_t bytes) {
      std::memcpy(data, at, bytes);
      at += bytes;
    });
  }
  if (support_) std::memcpy(support_->rails(), at, support_bytes(support_));
  depth_ = header.depth;
  solver_.set_friction_coefficient(header.friction_coefficient);
  if (derivative_) derivative_->solved = false;
  return true;
}

void contact::copy_state(const contact &from) {
  for (size_t k = 0; k < memory_.size(); ++k) {
    const patch_memory &source = from.memory_[k];
    patch_memory &m = memory_[k];
    m.g = source.g;
    m.reference = source.reference;
    m.share = source.share;
    std::copy_n(source.rail, 2, m.rail);
    m.warm = source.warm;
    m.history.begun = source.history.begun;
    m.solved = false;
    const double *fields[max_start_fields];
    size_t count = 0, next = 0;
    for_each_start_field(source, [&](const double *data, size_t) { fields[count++] = data; });
    for_each_start_field(
        m, [&](double *data, size_t bytes) { std::memcpy(data, fields[next++], bytes); });
  }
  if (support_) std::memcpy(support_->rails(), from.support_->rails(), support_bytes(support_));
  depth_ = from.depth_;
  solver_.set_friction_coefficient(from.friction_coefficient());
}

// Walks the patches without changing anything: every grid must fit this handle's memory.
bool contact::state_fits(const unsigned char *at, size_t size) const {
  for (const auto &m : memory_) {
    patch_header patch;
    if (size < sizeof patch) return false;
    std::memcpy(&patch, at, sizeof patch);
    const bool fits = patch.g.nx >= 0 && patch.g.ny >= 0 && solver_.fits(patch.g);
    if (!fits) return false;
    const auto count = m.pressure.size() ? static_cast<size_t>(patch.g.count()) : 0;
    const size_t fields = m.fitted() ? 3 * m.px.size() : m.px.size() ? 2 * count : 0;
    const size_t traction = m.creepage.size() + fields;
    if (patch.begun && !m.history.keeps_steps()) return false;
    const bool kept = patch.warm || patch.begun;
    const size_t friction = m.heat && m.heat->friction.size() ? count : 0;
    const size_t columns = m.heat ? m.heat->columns.size() : 0;
    const size_t bytes = sizeof patch + columns * sizeof(double) +
                         (kept ? count + traction + friction : 0) * sizeof(double) +
                         (patch.begun ? m.history.kept_bytes(count) : 0);
    if (size < bytes) return false;
    at += bytes;
    size -= bytes;
  }
  return size == support_bytes(support_);
}

}  // namespace railpatch
