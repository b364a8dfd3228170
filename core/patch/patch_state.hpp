// What later steps depend on of one patch, as one list: a head of plain numbers, and the fields
// that go with it. Saving, restoring, copying and the check of sizes all walk it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "half_space/kernel_book.hpp"
#include "patch/patch_memory.hpp"

namespace railpatch {

struct patch_state_head {
  grid g;
  std::array<double, 3> reference;
  std::array<double, 5> rolling;
  double share, rail[2];
  std::array<double, 3> bent;
  // warm: 0 of none, else one more than how many grids were nearly like the ones before
  uint64_t warm, begun;
};

inline patch_state_head head_of(const patch_memory &m) {
  return {m.g,
          m.reference,
          m.rolling,
          m.share,
          {m.rail[0], m.rail[1]},
          m.history.bent,
          m.warm ? 1u + static_cast<uint64_t>(m.followed) : 0u,
          m.history.begun ? 1u : 0u};
}

inline void set_head(patch_memory &m, const patch_state_head &head) {
  m.g = head.g;
  m.reference = head.reference;
  m.rolling = head.rolling;
  m.share = head.share;
  for (int k = 0; k < 2; ++k) m.rail[k] = head.rail[k];
  m.history.bent = head.bent;
  m.warm = head.warm != 0;
  m.followed = m.warm ? static_cast<int>(std::min<uint64_t>(head.warm - 1, kernel_book::lead)) : 0;
  m.history.begun = head.begun != 0;
  m.solved = false;
}

// Whether a memory has room for the fields of a head.
inline bool holds(const patch_memory &m, const patch_state_head &head) {
  return head.g.nx >= 0 && head.g.ny >= 0 && (!head.begun || m.history.keeps_steps());
}

// f(data, bytes) of each field that a patch with this head has.
template <class Memory, class F>
void for_each_state_field(Memory &m, const patch_state_head &head, F &&f) {
  const auto count = static_cast<size_t>(head.g.count());
  const auto put = [&](auto &field, size_t n) {
    if (field.size()) f(field.data(), n * sizeof(double));
  };
  if (m.heat) put(m.heat->columns, m.heat->columns.size());
  if (!head.warm && !head.begun) return;
  if (m.heat) put(m.heat->friction, count);
  put(m.pressure, count);
  if (m.px.size() == 0) return;
  // of fitted rows all nodes, on any grid
  const size_t tractions = m.fitted() ? m.px.size() : count;
  put(m.px, tractions);
  put(m.py, tractions);
  put(m.node_pressure, tractions);
  put(m.creepage, m.creepage.size());
  if (!head.begun) return;
  m.history.for_each_kept(count, f);
  if (m.curved) put(m.curved->angles(), static_cast<size_t>(head.g.ny));
}

}  // namespace railpatch
