// Memory that ends at any allocation of a handle's creation: each ends as RP_ERROR_MEMORY, gives
// back what was taken, and harms nothing that comes after.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "scenes.hpp"

namespace {

constinit long left = -1;  // allocations until memory ends; < 0: it does not
constinit long live = 0;   // blocks

void *take(std::size_t size, std::size_t alignment) {
  if (left == 0) throw std::bad_alloc();
  if (left > 0) --left;
  void *block = alignment > alignof(std::max_align_t)
                    ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                    : std::malloc(size > 0 ? size : 1);
  if (!block) throw std::bad_alloc();
  ++live;
  return block;
}
void give(void *block) {
  if (!block) return;
  --live;
  std::free(block);
}
std::size_t of(std::align_val_t alignment) { return static_cast<std::size_t>(alignment); }

}  // namespace

void *operator new(std::size_t size) { return take(size, 0); }
void *operator new[](std::size_t size) { return take(size, 0); }
void *operator new(std::size_t size, std::align_val_t a) { return take(size, of(a)); }
void *operator new[](std::size_t size, std::align_val_t a) { return take(size, of(a)); }
void operator delete(void *p) noexcept { give(p); }
void operator delete[](void *p) noexcept { give(p); }
void operator delete(void *p, std::size_t) noexcept { give(p); }
void operator delete[](void *p, std::size_t) noexcept { give(p); }
void operator delete(void *p, std::align_val_t) noexcept { give(p); }
void operator delete[](void *p, std::align_val_t) noexcept { give(p); }
void operator delete(void *p, std::size_t, std::align_val_t) noexcept { give(p); }
void operator delete[](void *p, std::size_t, std::align_val_t) noexcept { give(p); }

namespace {

struct named {
  const char *name;
  rp_config config;
};

std::vector<named> handles(const scenes::profile_pair &pair, const scenes::varying_track &varying,
                           const scenes::turnout &turnout) {
  rp_config patch;
  rp_default_config(&patch);
  patch.geometry = RP_CURVATURES;
  patch.curvatures[0] = 1.0;
  patch.curvatures[1] = 1.5;
  patch.elements[0] = patch.elements[1] = 8;
  rp_config fitted = patch;
  fitted.fitted[0] = fitted.fitted[1] = 6;
  fitted.accuracy = 0.01;
  fitted.finer_grids = 1;
  rp_config transient = patch;
  transient.regime = RP_TRANSIENT_ROLLING;
  transient.elements[0] = transient.elements[1] = 0;
  transient.element_size[0] = transient.element_size[1] = 1e-3;
  transient.max_elements[0] = transient.max_elements[1] = 16;
  transient.layer_thickness = 2e-5;
  transient.layer_shear_modulus = 8e9;
  scenes::set_falling_friction(transient);
  return {{"patch", patch},
          {"fitted rows, finer grids", fitted},
          {"transient, layer, falling friction", transient},
          {"wheelset", scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair))},
          {"rails on springs", scenes::coarse(varying.config(RP_WHEELSET))},
          {"turnout", scenes::coarse(turnout.config(RP_WHEEL_RAIL))}};
}

TEST(OutOfMemory, AnyAllocationOfACreationMayFail) {
  const scenes::profile_pair pair;
  const scenes::varying_track varying;
  long failed = 0;
  const scenes::turnout turnout;
  for (const named &scene : handles(pair, varying, turnout)) {
    SCOPED_TRACE(scene.name);
    // what is made once a process
    rp_contact *first = nullptr;
    rp_message message{};
    ASSERT_EQ(rp_create(&scene.config, &first, &message), RP_OK) << message.text;
    rp_destroy(first);
    long n = 0;
    for (rp_error error = RP_ERROR_MEMORY; error != RP_OK && n < 20000; ++n) {
      rp_contact *contact = nullptr;
      const long before = live;
      left = n;
      error = rp_create(&scene.config, &contact, nullptr);
      left = -1;
      if (error == RP_OK) {
        rp_destroy(contact);
      } else {
        if (error != RP_ERROR_MEMORY || contact) {
          ADD_FAILURE() << "allocation " << n << ": error " << error;
          return;
        }
        ++failed;
      }
      if (live != before) {
        ADD_FAILURE() << "allocation " << n << ": " << live - before << " blocks are left";
        return;
      }
    }
    EXPECT_GT(n, 10);
    EXPECT_LT(n, 20000);
    // as good as new
    const scenes::handle h(scene.config);
  }
  RecordProperty("failed", static_cast<int>(failed));
  EXPECT_GT(failed, 200);
}

}  // namespace
