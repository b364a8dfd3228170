// A saved state as plain bytes: header, values of all variables, the contact's own state. The same
// bytes are what fmi2SerializeFMUstate gives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace railpatch::fmu {

using Snapshot = std::vector<unsigned char>;

struct SnapshotHeader {
  char mark[8];
  uint32_t version, checksum;  // the checksum covers all that follows it
  uint64_t content;            // of the FMU: a state of another one is refused
  // bytes in all, number of values, bytes of the contact's state, and of profiles read at run time
  uint64_t size, values, core, files;
  double time, start, stop;
  uint32_t mode, stop_defined, changed;
  uint16_t interface;
  uint8_t solved, largest_known;
};

// Fills mark, version, sizes and checksum; the other fields are the caller's.
Snapshot pack(SnapshotHeader header, const std::vector<double> &values,
              const std::vector<unsigned char> &core, const std::vector<unsigned char> &files);

// Null if good, else what is wrong. values: how many there must be.
const char *check(const unsigned char *bytes, size_t size, uint64_t content, size_t values);

// Of checked bytes.
SnapshotHeader header_of(const unsigned char *bytes);
const unsigned char *values_of(const unsigned char *bytes);
const unsigned char *core_of(const unsigned char *bytes);
const unsigned char *files_of(const unsigned char *bytes);

}  // namespace railpatch::fmu
