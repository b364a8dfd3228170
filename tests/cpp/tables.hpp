// A small creep table in memory, in the form of core/fast/creep_table.hpp: no solved numbers, but
// forces of the right sign and size, and every field in use.
#pragma once

#include <cstring>
#include <vector>

#include "fast/creep_table.hpp"

namespace tables {

// Holds the bytes with the alignment that the core asks for.
struct table {
  std::vector<uint64_t> words;
  const void *data() const { return words.data(); }
  size_t size() const { return words.size() * sizeof(uint64_t); }

  // Makes the checksum fit after a change.
  void seal() {
    const size_t from = offsetof(railpatch::creep_table_header, ratio_count) / sizeof(uint64_t);
    uint64_t hash = 14695981039346656037ull;
    for (size_t i = from; i < words.size(); ++i) hash = (hash ^ words[i]) * 1099511628211ull;
    words[2] = hash;
  }
  railpatch::creep_table_header header() const {
    railpatch::creep_table_header h;
    std::memcpy(&h, words.data(), sizeof h);
    return h;
  }
  void set_header(const railpatch::creep_table_header &h) {
    std::memcpy(words.data(), &h, sizeof h);
    seal();
  }
};

inline table small() {
  railpatch::creep_table_header h{};
  std::memcpy(h.magic, "RPCREEP1", 8);
  h.ratio_count = 5;
  h.psi_count = 6;
  h.theta_count = 7;
  h.t_count = 8;
  for (int i = 0; i < 3; ++i) h.poisson_ratio[i] = 0.25 * i;
  h.log_ratio[0] = -2.0;
  h.log_ratio[1] = 2.0;
  h.radius = 2.5;
  for (double &s : h.remainder_scale) s = 1e-6;
  h.error[0] = h.error[1] = 0.5;
  std::vector<double> scale(3 * 5 * 3, 4.0);
  std::vector<float> linear;
  for (int i = 0; i < 3 * 5 * 8; ++i)
    for (float value : {-0.8f, -0.8f, -0.1f, 0.1f, -0.5f, 0.0f, 0.0f, 0.0f})
      linear.push_back(value);
  std::vector<int16_t> remainder(3 * 5 * 6 * 7 * 8 * 3);
  for (size_t i = 0; i < remainder.size(); ++i)
    remainder[i] = static_cast<int16_t>(static_cast<int>(i * 7919 % 2001) - 1000);
  const auto words = [](size_t bytes) { return (bytes + 7) / 8; };
  const size_t parts[] = {sizeof h / 8, scale.size(), words(linear.size() * sizeof(float)),
                          words(remainder.size() * sizeof(int16_t))};
  table t;
  t.words.resize(parts[0] + parts[1] + parts[2] + parts[3]);
  h.bytes = t.size();
  uint64_t *at = t.words.data() + parts[0];
  std::memcpy(at, scale.data(), scale.size() * sizeof(double));
  std::memcpy(at += parts[1], linear.data(), linear.size() * sizeof(float));
  std::memcpy(at += parts[2], remainder.data(), remainder.size() * sizeof(int16_t));
  t.set_header(h);
  return t;
}

}  // namespace tables
