#include "snapshot.hpp"

#include <cmath>
#include <cstring>

#include "checksum.hpp"

namespace railpatch::fmu {

namespace {

constexpr char kMark[8] = {'R', 'P', 'F', 'M', 'U', 'S', 'T', '\n'};
constexpr uint32_t kVersion = 3;
constexpr size_t kChecked = offsetof(SnapshotHeader, content);
constexpr size_t kHeader = sizeof(SnapshotHeader);

// exactly one of the states of calls.hpp
bool known_mode(uint32_t mode) { return mode != 0 && mode <= 128 && (mode & (mode - 1)) == 0; }

}  // namespace

static_assert(kHeader == 96, "no padding: every byte of a snapshot is defined");

Snapshot pack(SnapshotHeader header, const std::vector<double> &values,
              const std::vector<unsigned char> &core, const std::vector<unsigned char> &files) {
  const size_t bytes = values.size() * sizeof(double);
  Snapshot snapshot(kHeader + bytes + core.size() + files.size());
  std::memcpy(header.mark, kMark, sizeof kMark);
  header.version = kVersion;
  header.size = snapshot.size();
  header.values = values.size();
  header.core = core.size();
  header.files = files.size();
  unsigned char *at = snapshot.data();
  std::memcpy(at, &header, kHeader);
  if (bytes > 0) std::memcpy(at + kHeader, values.data(), bytes);
  if (!core.empty()) std::memcpy(at + kHeader + bytes, core.data(), core.size());
  if (!files.empty()) std::memcpy(at + kHeader + bytes + core.size(), files.data(), files.size());
  header.checksum = crc32(at + kChecked, snapshot.size() - kChecked);
  std::memcpy(at + offsetof(SnapshotHeader, checksum), &header.checksum, sizeof header.checksum);
  return snapshot;
}

const char *check(const unsigned char *bytes, size_t size, uint64_t content, size_t values) {
  if (size < kHeader) return "the state is cut off";
  const SnapshotHeader header = header_of(bytes);
  if (std::memcmp(header.mark, kMark, sizeof kMark) != 0) return "these bytes are no state";
  if (header.version != kVersion) return "the state is of another version";
  if (header.size != size) return "the state is cut off or too long";
  if (header.checksum != crc32(bytes + kChecked, size - kChecked)) return "the state was altered";
  if (header.content != content) return "the state is of another FMU";
  const size_t rest = size - kHeader;
  if (header.values != values || header.core > rest || header.files > rest - header.core ||
      rest - header.core - header.files != values * sizeof(double))
    return "the state has another size";
  if (!known_mode(header.mode) || !std::isfinite(header.time)) return "the state was altered";
  return nullptr;
}

SnapshotHeader header_of(const unsigned char *bytes) {
  SnapshotHeader header;
  std::memcpy(&header, bytes, kHeader);
  return header;
}

const unsigned char *values_of(const unsigned char *bytes) { return bytes + kHeader; }

const unsigned char *core_of(const unsigned char *bytes) {
  return bytes + kHeader + header_of(bytes).values * sizeof(double);
}

const unsigned char *files_of(const unsigned char *bytes) {
  return core_of(bytes) + header_of(bytes).core;
}

}  // namespace railpatch::fmu
