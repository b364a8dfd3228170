// The memory that the stages of a handle say they hold is what rp_create takes: from a small grid
// to a large one both grow by the same number of bytes.
#include <gtest/gtest.h>

#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "scenes.hpp"

namespace {

// live bytes of all but the transforms' plans; operator delete does not know sizes, so each block
// begins with its own
constinit size_t live = 0;
constexpr size_t head = 64;

void *take(size_t size) {
  void *block = std::aligned_alloc(head, (size + 2 * head - 1) / head * head);
  if (!block) throw std::bad_alloc();
  *static_cast<size_t *>(block) = size;
  live += size;
  return static_cast<char *>(block) + head;
}
void give(void *p) {
  if (!p) return;
  void *block = static_cast<char *>(p) - head;
  live -= *static_cast<size_t *>(block);
  std::free(block);
}

}  // namespace

// what the core takes of the system in pages, but for the one more that it shifts a buffer by; with
// the sanitizers it takes none
#if !defined(__SANITIZE_ADDRESS__)
extern "C" void *mmap(void *at, size_t size, int access, int flags, int file,
                      off_t offset) noexcept {
  live += size - 4096;
  return reinterpret_cast<void *>(syscall(SYS_mmap, at, size, access, flags, file, offset));
}
extern "C" int munmap(void *at, size_t size) noexcept {
  live -= size - 4096;
  return static_cast<int>(syscall(SYS_munmap, at, size));
}
#endif

void *operator new(size_t size) { return take(size); }
void *operator new(size_t size, std::align_val_t) { return take(size); }
void *operator new[](size_t size) { return take(size); }
void *operator new[](size_t size, std::align_val_t) { return take(size); }
void operator delete(void *p) noexcept { give(p); }
void operator delete(void *p, size_t) noexcept { give(p); }
void operator delete(void *p, std::align_val_t) noexcept { give(p); }
void operator delete(void *p, size_t, std::align_val_t) noexcept { give(p); }
void operator delete[](void *p) noexcept { give(p); }
void operator delete[](void *p, size_t) noexcept { give(p); }
void operator delete[](void *p, std::align_val_t) noexcept { give(p); }
void operator delete[](void *p, size_t, std::align_val_t) noexcept { give(p); }

namespace {

struct sizes {
  size_t taken, described;
};

sizes of(const rp_config &c) {
  const size_t before = live;
  const scenes::handle h(c);
  rp_stage_info stages[RP_STAGE_COUNT];
  EXPECT_EQ(rp_describe(h.get(), stages), RP_OK);
  size_t sum = 0;
  for (const rp_stage_info &stage : stages) {
    sum += stage.bytes;
    if (!stage.present) {
      EXPECT_EQ(stage.bytes, 0u) << stage.name;
    }
  }
  return {live - before, sum};
}

struct scene {
  std::string name;
  rp_config config;
};

std::vector<scene> patches() {
  std::vector<scene> all;
  const auto add = [&](const char *name, const rp_config &c) { all.push_back({name, c}); };
  const rp_config full = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  add("full", full);
  add("normal alone", scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_NONE));
  add("hertz", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL));
  add("fastsim", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FASTSIM));
  add("fastrip", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FASTRIP));
  add("rows", scenes::patch(RP_NORMAL_KIK_PIOTROWSKI, RP_TANGENTIAL_FASTSIM));
  add("force", scenes::forced_patch());
  rp_config c = full;
  c.accuracy = 0.01;
  c.finer_grids = 1;
  add("finer grids", c);
  c = full;
  c.friction_points = 2;
  c.friction_position[1] = 1e-3;
  c.friction_factor[0] = 1;
  c.friction_factor[1] = 0.5;
  add("friction by row", c);
  c = full;
  c.derivatives = 1;
  add("derivatives", c);
  c = full;
  c.regime = RP_SHIFT;
  add("shift", c);
  c.layer_thickness = 1e-4;
  c.layer_shear_modulus = 1e9;
  c.layer_yield_stress = 1e8;
  add("shift of a plastic layer", c);
  c.regime = RP_STEADY_ROLLING;
  add("plastic layer", c);
  c = full;
  c.friction_law = RP_SLIP_VELOCITY;
  c.friction_kinetic = 0.2;
  c.friction_amplitude[0] = 0.1;
  add("slip velocity", c);
  c = full;
  c.shear_modulus[0] *= 0.5;
  add("unlike bodies", c);
  c = full;
  c.geometry = RP_CURVATURES;
  c.curvatures[0] = c.curvatures[1] = 1.0;
  for (int k = 0; k < 2; ++k) {
    c.viscoelastic_ratio[k] = 2.0;
    c.relaxation_time[k] = 1e-4;
  }
  add("viscoelastic bodies", c);
  add("temperature", scenes::heated_patch(RP_STEADY_ROLLING));
  add("transient with temperature", scenes::heated_patch(RP_TRANSIENT_ROLLING));
  return all;
}

TEST(Memory, OfAPatchGrowsAsItSays) {
  for (scene &s : patches()) {
    SCOPED_TRACE(s.name);
    sizes found[3];
    for (int k = 0; k < 3; ++k) {
      // lines of their own lengths, fine enough for a start from coarser grids
      s.config.elements[0] = k == 1 ? 72 : 44;
      s.config.elements[1] = k == 2 ? 90 : 41;
      found[k] = of(s.config);
    }
    for (int k = 1; k < 3; ++k) {
      EXPECT_GT(found[k].taken, found[0].taken);
      EXPECT_EQ(found[k].described - found[0].described, found[k].taken - found[0].taken) << k;
    }
  }
}

TEST(Memory, OfOwnInfluenceGrowsAsItSays) {
  for (const bool rolls : {false, true}) {
    sizes found[3];
    for (int k = 0; k < 3; ++k) {
      rp_config c =
          scenes::patch(RP_NORMAL_HALF_SPACE, rolls ? RP_TANGENTIAL_FULL : RP_TANGENTIAL_NONE);
      c.geometry = RP_UNDEFORMED_DISTANCE;
      c.elements[0] = c.elements[1] = 0;
      c.element_size[0] = c.element_size[1] = 1e-3;
      c.distance_shape[0] = k == 1 ? 40 : 24;
      c.distance_shape[1] = k == 2 ? 36 : 21;
      const auto count = static_cast<size_t>(c.distance_shape[0] * c.distance_shape[1]);
      const auto each = count + static_cast<size_t>(c.distance_shape[1]);
      const std::vector<double> gap(count, 0.0);
      std::vector<double> own(4 * each, 0.0);
      for (size_t i = 0; i < 3; ++i) own[i * each] = 1e-13;
      c.undeformed_distance = gap.data();
      c.own_influence = 1;
      c.influence_coefficients = own.data();
      found[k] = of(c);
    }
    for (int k = 1; k < 3; ++k) {
      EXPECT_GT(found[k].taken, found[0].taken);
      EXPECT_EQ(found[k].described - found[0].described, found[k].taken - found[0].taken) << k;
    }
  }
}

TEST(Memory, OfFittedRowsGrowsAsItSays) {
  for (const bool forced : {false, true}) {
    rp_config c =
        forced ? scenes::forced_patch() : scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
    sizes found[3];
    for (int k = 0; k < 3; ++k) {
      c.fitted[0] = k == 1 ? 30 : 16;
      c.fitted[1] = k == 2 ? 32 : 18;
      found[k] = of(c);
    }
    for (int k = 1; k < 3; ++k)
      EXPECT_EQ(found[k].described - found[0].described, found[k].taken - found[0].taken) << k;
  }
}

TEST(Memory, OfWheelsGrowsAsItSays) {
  const scenes::profile_pair pair;
  const scenes::varying_track varying;
  for (int kind = 0; kind < 6; ++kind) {
    SCOPED_TRACE(kind);
    rp_config c = kind == 1 ? varying.config(RP_WHEELSET)
                            : scenes::wheels(RP_WHEELSET, kind == 2 ? RP_ROLLER : RP_RAIL, pair);
    if (kind == 3) c.derivatives = 1;
    if (kind == 4) {
      c.reference_surface = RP_REFERENCE_CURVED;
      c.normal = RP_NORMAL_HALF_SPACE;
    }
    if (kind == 5) c.regime = RP_TRANSIENT_ROLLING;
    sizes found[3];
    for (int k = 0; k < 3; ++k) {
      c.max_elements[0] = k == 1 ? 50 : 36;
      c.max_elements[1] = k == 2 ? 64 : 30;
      found[k] = of(c);
    }
    // a plan more or less in the list of the transforms
    for (int k = 1; k < 3; ++k)
      EXPECT_NEAR(static_cast<double>(found[k].described - found[0].described),
                  static_cast<double>(found[k].taken - found[0].taken), 64)
          << k;
  }
}

size_t tangential_bytes(const rp_config &c) {
  const scenes::handle h(c);
  rp_stage_info stages[RP_STAGE_COUNT];
  EXPECT_EQ(rp_describe(h.get(), stages), RP_OK);
  return stages[RP_STAGE_TANGENTIAL].bytes;
}

// Geometry keeps the profiles of each wheel and rail: the same on either side.
TEST(Memory, GeometryIsThatOfEachWheel) {
  const scenes::profile_pair pair;
  const auto geometry_of = [&](rp_kind kind) {
    const size_t before = live;
    const scenes::handle h(scenes::wheels(kind, RP_RAIL, pair));
    rp_stage_info stages[RP_STAGE_COUNT];
    EXPECT_EQ(rp_describe(h.get(), stages), RP_OK);
    EXPECT_LE(stages[RP_STAGE_GEOMETRY].bytes, live - before);
    return stages[RP_STAGE_GEOMETRY].bytes;
  };
  const size_t one = geometry_of(RP_WHEEL_RAIL);
  // arc length, place and direction of each point
  EXPECT_GE(one, 5 * sizeof(double) * (pair.wheel.s.size() + pair.rail.s.size()));
  EXPECT_EQ(geometry_of(RP_WHEELSET), 2 * one);
}

// In steady rolling the wheels' grids move, but no step is looked back to: beside what each patch
// keeps there is the solver of one patch.
TEST(Memory, WheelsRollSteadilyWithTheSolverOfOnePatch) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  c.max_elements[0] = 30;
  c.max_elements[1] = 26;
  c.max_patches = 1;
  // slopes of the rail for each row, of height, across and along
  const size_t by_slopes = tangential_bytes(c);
  c.patch_rule = RP_PATCHES_CONTACT;
  const size_t two = tangential_bytes(c);
  EXPECT_EQ(by_slopes - two, 2 * 3 * 26 * sizeof(double));
  c.max_patches = 2;
  const size_t four = tangential_bytes(c), each = (four - two) / 2;
  rp_config patch = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  // with one free element around
  patch.elements[0] = 28;
  patch.elements[1] = 24;
  EXPECT_EQ(two - 2 * each, tangential_bytes(patch) - each);
  c.regime = patch.regime = RP_TRANSIENT_ROLLING;
  // m, by the last step's tractions, of either direction
  EXPECT_GE(tangential_bytes(c), four + 2 * 30 * 26 * sizeof(double));
}

}  // namespace
