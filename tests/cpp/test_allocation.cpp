// rp_step allocates nothing: every way to the heap is counted while a step runs.
//
// Release builds interpose the C library's malloc family, through which operator new and FFTW go
// too. Under AddressSanitizer those names belong to the sanitizer, so there only operator new is
// counted and what FFTW takes is not seen.
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <new>

#include "numeric/fft.hpp"
#include "scenes.hpp"
#include "tables.hpp"

namespace {

// constant initialisation: malloc runs before any constructor
constinit std::atomic<bool> counting{false};
constinit std::atomic<int> count{0};

void note() {
  if (counting.load(std::memory_order_relaxed)) count.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

#if defined(__SANITIZE_ADDRESS__)
#define RP_COUNTS_MALLOC 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define RP_COUNTS_MALLOC 0
#endif
#endif
#if !defined(RP_COUNTS_MALLOC) && defined(__GLIBC__)
#define RP_COUNTS_MALLOC 1
#elif !defined(RP_COUNTS_MALLOC)
#define RP_COUNTS_MALLOC 0
#endif

#if RP_COUNTS_MALLOC

extern "C" {
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);

void *malloc(size_t size) noexcept {
  note();
  return __libc_malloc(size);
}
void *calloc(size_t number, size_t size) noexcept {
  note();
  return __libc_calloc(number, size);
}
void *realloc(void *block, size_t size) noexcept {
  note();
  return __libc_realloc(block, size);
}
void *memalign(size_t alignment, size_t size) noexcept {
  note();
  return __libc_memalign(alignment, size);
}
void *aligned_alloc(size_t alignment, size_t size) noexcept {
  note();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void **block, size_t alignment, size_t size) noexcept {
  note();
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}
}

#else

#if defined(__GNUC__) && !defined(__clang__)
// where it inlines one of a pair only, GCC takes a replaced operator for a mismatch
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif

void *operator new(size_t size) {
  note();
  if (void *block = std::malloc(size > 0 ? size : 1)) return block;
  throw std::bad_alloc();
}
void *operator new(size_t size, std::align_val_t alignment) {
  note();
  const auto step = static_cast<size_t>(alignment);
  if (void *block = std::aligned_alloc(step, (size + step) / step * step)) return block;
  throw std::bad_alloc();
}
void *operator new[](size_t size) { return operator new(size); }
void *operator new[](size_t size, std::align_val_t a) { return operator new(size, a); }
void operator delete(void *block) noexcept { std::free(block); }
void operator delete(void *block, size_t) noexcept { std::free(block); }
void operator delete(void *block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void *block, size_t, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void *block) noexcept { std::free(block); }
void operator delete[](void *block, size_t) noexcept { std::free(block); }
void operator delete[](void *block, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void *block, size_t, std::align_val_t) noexcept { std::free(block); }

#endif

namespace {

// Calls f and returns how often it allocated.
template <class F>
int allocations(F &&f) {
  count = 0;
  counting = true;
  f();
  counting = false;
  return count;
}

void *volatile sink;

// --- the counter itself --------------------------------------------------------------------

TEST(Counter, SeesOperatorNew) {
  EXPECT_EQ(allocations([] {
              sink = ::operator new(24);
              ::operator delete(sink);
            }),
            1);
  EXPECT_GE(allocations([] {
              sink = ::operator new[](100, std::align_val_t{64});
              ::operator delete[](sink, std::align_val_t{64});
            }),
            1);
  EXPECT_EQ(allocations([] {}), 0);
}

// a sanitizer owns the C library's malloc: operator new alone is counted there
#if RP_COUNTS_MALLOC
TEST(Counter, SeesTheCLibrary) {
  EXPECT_EQ(allocations([] {
              sink = std::malloc(10);
              std::free(sink);
              sink = std::calloc(2, 10);
              sink = std::realloc(sink, 200);
              std::free(sink);
              sink = std::aligned_alloc(64, 128);
              std::free(sink);
              void *block = nullptr;
              if (posix_memalign(&block, 64, 100) == 0) sink = block;
              std::free(block);
            }),
            5);
}
#endif

TEST(Counter, SeesAnAllocationInsideAStep) {
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 8);
  c.observer = [](void *, rp_stage, int) {
    sink = ::operator new(8);
    ::operator delete(sink);
  };
  scenes::handle contact(c);
  const rp_input in = scenes::patch_input(1e5, 1e-3, 0, 0);
  EXPECT_GT(allocations([&] { contact.step(in); }), 0);
}

TEST(Counter, SeesCreation) {
  const rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 8);
  EXPECT_GT(allocations([&] { scenes::handle contact(c); }), 10);
}

// --- scenes --------------------------------------------------------------------------------

struct outcome {
  int allocated = 0;
  int greatest_patches = 0;
  bool lifted = false;
  std::vector<double> heights;
};

template <class Inputs>
outcome run(const rp_config &config, const Inputs &inputs) {
  scenes::handle contact(config);
  outcome o;
  auto result = std::make_unique<rp_result>();
  for (const rp_input &in : inputs) {
    rp_error error = RP_OK;
    rp_message message{};
    const int n = allocations([&] { error = rp_step(contact.get(), &in, result.get(), &message); });
    EXPECT_EQ(error, RP_OK) << message.text;
    EXPECT_NE(result->status, RP_NOT_CONVERGED);
    o.allocated += n;
    for (const rp_side_result &side : result->side)
      o.greatest_patches = std::max(o.greatest_patches, static_cast<int>(side.patch_count));
    o.heights.push_back(result->z);
    o.lifted |= result->status == RP_NO_CONTACT;
  }
  return o;
}

std::vector<rp_input> patch_inputs() {
  std::vector<rp_input> all;
  for (double force : {1e4, 3e4, 1e5, 1.1e5, 5e3})
    for (double creepage : {0.0, 2e-4, 5e-3}) {
      all.push_back(scenes::patch_input(force, creepage, -0.3 * creepage, 200 * creepage));
      all.back().direction = force > 5e4 ? -1 : 1;
    }
  return all;
}

TEST(Step, OfAPatchAllocatesNothing) {
  for (rp_normal_method normal : {RP_NORMAL_HERTZ, RP_NORMAL_HALF_SPACE, RP_NORMAL_KIK_PIOTROWSKI,
                                  RP_NORMAL_KIK_PIOTROWSKI_CORRECTED, RP_NORMAL_ANALYN})
    for (rp_tangential_method tangential :
         {RP_TANGENTIAL_NONE, RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_FULL, RP_TANGENTIAL_LINEAR,
          RP_TANGENTIAL_POLACH, RP_TANGENTIAL_FASTRIP})
      for (int elements : {7, 16, 31})
        EXPECT_EQ(run(scenes::patch(normal, tangential, elements), patch_inputs()).allocated, 0)
            << "normal " << normal << " tangential " << tangential << " elements " << elements;
}

TEST(Step, OfHeatedPatchesAllocatesNothing) {
  for (rp_regime regime : {RP_STEADY_ROLLING, RP_TRANSIENT_ROLLING}) {
    std::vector<rp_input> inputs = patch_inputs();
    for (size_t i = 0; i < inputs.size(); ++i) {
      inputs[i].distance = 3e-4 * static_cast<double>(1 + i % 4);
      inputs[i].rolling_speed = i % 5 == 4 ? 500.0 : 10.0;  // the columns' modes move
    }
    EXPECT_EQ(run(scenes::heated_patch(regime), inputs).allocated, 0) << regime;
  }
}

TEST(Step, OfFittedRowsAllocatesNothing) {
  for (rp_normal_method normal :
       {RP_NORMAL_HERTZ, RP_NORMAL_HALF_SPACE, RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_ANALYN})
    for (int nodes : {3, 8, 17}) {
      rp_config c = scenes::patch(normal, RP_TANGENTIAL_FULL, 16);
      c.fitted[0] = nodes;
      c.fitted[1] = nodes + 2;
      EXPECT_EQ(run(c, patch_inputs()).allocated, 0) << "normal " << normal << " nodes " << nodes;
    }
}

TEST(Step, ThatGoesOnToFinerGridsAllocatesNothing) {
  for (int nodes : {0, 6}) {
    rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 8);
    c.fitted[0] = c.fitted[1] = nodes;
    c.accuracy = 0.01;
    c.finer_grids = 2;
    EXPECT_EQ(run(c, patch_inputs()).allocated, 0) << "nodes " << nodes;
  }
}

TEST(Step, WithACreepTableAllocatesNothing) {
  const tables::table table = tables::small();
  for (rp_normal_method normal :
       {RP_NORMAL_HERTZ, RP_NORMAL_HALF_SPACE, RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_ANALYN}) {
    rp_config c = scenes::patch(normal, RP_TANGENTIAL_TABLE, 16);
    c.creep_table = table.data();
    c.creep_table_size = table.size();
    EXPECT_EQ(run(c, patch_inputs()).allocated, 0) << "normal " << normal;
  }
  const scenes::profile_pair pair;
  rp_config c = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
  c.tangential = RP_TANGENTIAL_TABLE;
  c.creep_table = table.data();
  c.creep_table_size = table.size();
  rp_input in = scenes::running(RP_RAIL);
  in.vertical_force = 1.2e5;
  EXPECT_EQ(run(c, std::vector{in}).allocated, 0);
}

// With slopes from the contacts and by differences.
TEST(Step, OfAWheelsetInBalanceAllocatesNothing) {
  const scenes::profile_pair pair;
  rp_config c = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
  c.roll_balanced = c.axle_free = 1;
  rp_input in = scenes::running(RP_RAIL);
  in.y = 2e-3;
  in.vertical_force = 1.2e5;
  for (rp_tangential_method tangential : {RP_TANGENTIAL_FULL, RP_TANGENTIAL_POLACH}) {
    c.tangential = tangential;
    EXPECT_EQ(run(c, std::vector{in}).allocated, 0) << tangential;
  }
}

// Curvatures with a fixed element size: the grid grows and shrinks with the load.
TEST(Step, OfAGrowingGridAllocatesNothing) {
  for (rp_normal_method normal :
       {RP_NORMAL_HALF_SPACE, RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_ANALYN}) {
    rp_config c = scenes::patch(normal, RP_TANGENTIAL_FULL);
    c.geometry = RP_CURVATURES;
    c.elements[0] = c.elements[1] = 0;
    c.element_size[0] = c.element_size[1] = 8e-4;
    c.max_elements[0] = c.max_elements[1] = 40;
    EXPECT_EQ(run(c, patch_inputs()).allocated, 0) << "normal " << normal;
  }
}

TEST(Step, OfALineContactAllocatesNothing) {
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 60);
  c.geometry = RP_LINE_CONTACT;
  c.elements[1] = 1;
  EXPECT_EQ(run(c, patch_inputs()).allocated, 0);
}

TEST(Step, OfUnlikeBodiesAllocatesNothing) {
  for (rp_geometry geometry : {RP_SEMI_AXES, RP_CURVATURES, RP_LINE_CONTACT}) {
    rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
    c.shear_modulus[0] = 26e9;
    c.poisson_ratio[0] = 0.33;
    c.geometry = geometry;
    if (geometry == RP_LINE_CONTACT) c.elements[1] = 1;
    EXPECT_EQ(run(c, patch_inputs()).allocated, 0) << "geometry " << geometry;
  }
}

TEST(Step, OfViscoelasticBodiesAllocatesNothing) {
  for (const bool force : {false, true}) {
    rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
    c.geometry = RP_CURVATURES;
    c.curvatures[0] = c.curvatures[1] = 1.0;
    for (int k = 0; k < 2; ++k) {
      c.shear_modulus[k] = 1e9;
      c.viscoelastic_ratio[k] = 2.0;
      c.relaxation_time[k] = 1e-4;
      c.force_prescribed[k] = force;
    }
    std::vector<rp_input> inputs = patch_inputs();
    if (force)
      inputs = {scenes::forced_input(1e3, 0.5, 0.3, 0), scenes::forced_input(2e3, 0.2, 2.0, 0)};
    EXPECT_EQ(run(c, inputs).allocated, 0);
  }
}

TEST(Step, OfOwnInfluenceAllocatesNothing) {
  constexpr int n = 12;
  std::vector<double> gap, own(4 * (n + 1) * n, 0.0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      gap.push_back(0.5e-6 * ((i - 5.5) * (i - 5.5) + (j - 5.5) * (j - 5.5)));
  for (size_t k = 0; k < 3; ++k) own[k * (n + 1) * n] = 1e-13;
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  c.geometry = RP_UNDEFORMED_DISTANCE;
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = c.element_size[1] = 1e-3;
  c.distance_shape[0] = c.distance_shape[1] = n;
  c.undeformed_distance = gap.data();
  c.own_influence = 1;
  c.influence_coefficients = own.data();
  EXPECT_EQ(run(c, patch_inputs()).allocated, 0);
}

TEST(Step, WithAPrescribedForceAllocatesNothing) {
  for (int nodes : {0, 7}) {
    rp_config c = scenes::forced_patch(nodes);
    c.friction_coefficient = 0.3;
    std::vector<rp_input> inputs;
    for (double share : {0.0, 0.5, 0.99, 0.2})
      for (double angle : {0.3, 2.0, 5.0})
        inputs.push_back(scenes::forced_input(1e5 * (1 + share), share, angle, angle > 1 ? 0 : .1));
    EXPECT_EQ(run(c, inputs).allocated, 0) << "fitted " << nodes;
  }
}

// Wheelsets by the theories that build the contact from rows.
TEST(Step, OfAWheelsetWithRowsAllocatesNothing) {
  const scenes::profile_pair pair;
  for (rp_normal_method normal :
       {RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_KIK_PIOTROWSKI_CORRECTED, RP_NORMAL_ANALYN})
    for (rp_tangential_method tangential : {RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_FULL}) {
      rp_config c = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
      c.normal = normal;
      c.tangential = tangential;
      std::vector<rp_input> inputs;
      for (double y : {0.0, 2e-3, 5.9e-3, 6.05e-3, -4e-3}) {
        inputs.push_back(scenes::running(RP_RAIL));
        inputs.back().y = y;
        inputs.back().vertical_force = 1.2e5;
      }
      EXPECT_EQ(run(c, inputs).allocated, 0) << "normal " << normal << " tangential " << tangential;
    }
}

TEST(Step, OnATrackThatVariesAllocatesNothing) {
  const scenes::varying_track track;
  for (rp_kind kind : {RP_WHEELSET, RP_WHEEL_RAIL})
    for (rp_load load : {RP_FORCE, RP_POSITION}) {
      rp_config c = scenes::coarse(track.config(kind));
      c.load = load;
      std::vector<rp_input> inputs = scenes::varying_track::inputs();
      for (rp_input &in : inputs) in.z = 1.5e-3;
      EXPECT_EQ(run(c, inputs).allocated, 0) << "kind " << kind << " load " << load;
    }
}

TEST(Step, OnATurnoutAllocatesNothing) {
  const scenes::turnout track;
  for (rp_kind kind : {RP_WHEELSET, RP_WHEEL_RAIL})
    EXPECT_EQ(run(scenes::coarse(track.config(kind)), scenes::turnout::inputs()).allocated, 0);
}

// A flat wheel and a rail with a dip, with patches that move over the rail.
TEST(Step, OfTransientRollingWheelsAllocatesNothing) {
  const scenes::profile_pair pair;
  std::vector<double> runout(1500, 0.0), height(100, 0.0);
  for (int i = 0; i < 20; ++i) runout[static_cast<size_t>(i)] = -1e-5 * i * (20 - i) / 10;
  for (int i = 40; i < 60; ++i) height[static_cast<size_t>(i)] = -1e-4;
  rp_config c = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
  c.regime = RP_TRANSIENT_ROLLING;
  for (int side = 0; side < 2; ++side) {
    c.runout[side] = runout.data();
    c.runout_count[side] = 1500;
    c.rail_height[side] = height.data();
    c.rail_height_count[side] = 100;
  }
  std::vector<rp_input> inputs;
  for (int k = 0; k < 12; ++k) {
    rp_input in = scenes::running(RP_RAIL);
    in.time_step = 1e-4;
    in.x = in.speed * in.time_step * k;
    in.pitch = in.pitch_rate * in.time_step * k + 0.02;
    in.y = 1e-4 * k;
    inputs.push_back(in);
  }
  EXPECT_EQ(run(c, inputs).allocated, 0);
  scenes::set_falling_friction(c);
  EXPECT_EQ(run(c, inputs).allocated, 0);
}

// The transforms alone, in sizes up to grids of 250 elements.
TEST(Transforms, AllocateNothing) {
  std::vector<int> sizes;
  for (int n = 4; n <= 500; n = railpatch::smooth_size(n + 1)) sizes.push_back(n);
  railpatch::aligned_buffer<double> values(500 * 500);
  railpatch::aligned_buffer<std::complex<double>> spectrum(251 * 500);
  for (size_t i = 0; i < sizes.size(); ++i) {
    // each with itself and with a few others
    const std::vector<int> along{sizes[i]}, across{1, sizes[i], sizes[(7 * i + 3) % sizes.size()]};
    for (int ny : across) {
      const railpatch::fft_plans plans(along, {ny});
      EXPECT_EQ(allocations([&] { plans.forward(0, values.data(), spectrum.data()); }), 0)
          << along[0] << " x " << ny;
    }
  }
}

// The larger transforms, where an FFT library may want buffers of its own.
TEST(Step, OfALargeGridAllocatesNothing) {
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_NONE, 200);
  EXPECT_EQ(run(c, std::vector{scenes::patch_input(1e5, 0, 0, 0)}).allocated, 0);
  c.tangential = RP_TANGENTIAL_FULL;
  c.elements[0] = c.elements[1] = 70;
  EXPECT_EQ(run(c, std::vector{scenes::patch_input(1e5, 1e-2, 0, 0)}).allocated, 0);
}

// Derivatives of wheelsets with one and several patches, exact ones and differences.
TEST(Derivatives, OfAWheelsetAllocateNothing) {
  const scenes::profile_pair pair;
  for (rp_patch_rule rule : {RP_PATCHES_BLENDED, RP_PATCHES_CONTACT})
    for (int elements : {0, 10}) {
      rp_config c = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
      c.derivatives = 1;
      c.patch_rule = rule;
      c.elements[0] = c.elements[1] = elements;
      if (elements > 0) c.element_size[0] = c.element_size[1] = 0;
      scenes::handle contact(c);
      int greatest = 0;
      auto result = std::make_unique<rp_result>(), change = std::make_unique<rp_result>();
      rp_jacobian whole{};
      for (double y : {0.0, 5.9e-3, 6e-3}) {
        rp_input in = scenes::running(RP_RAIL);
        in.y = y;
        in.vertical_force = 1.2e5;
        *result = contact.step(in);
        for (const rp_side_result &side : result->side)
          greatest = std::max(greatest, side.patch_count);
        rp_error errors[2] = {RP_ERROR_INTERNAL, RP_ERROR_INTERNAL};
        const int n = allocations([&] {
          errors[0] = rp_get_jacobian(contact.get(), &whole, nullptr);
          errors[1] = rp_differentiate(contact.get(), &in, change.get(), nullptr, nullptr);
        });
        EXPECT_EQ(n, 0) << "rule " << rule << " y " << y;
        for (rp_error error : errors) EXPECT_EQ(error, RP_OK);
      }
      if (rule == RP_PATCHES_BLENDED) {
        EXPECT_GE(greatest, 2);
      }
    }
}

// Sideways until the flange touches, then at the heights found, off the rails and back.
TEST(Step, OfAWheelsetAllocatesNothing) {
  const scenes::profile_pair pair;
  const std::pair<rp_track, rp_reference_surface> scene_of[] = {{RP_RAIL, RP_REFERENCE_PLANE},
                                                                {RP_ROLLER, RP_REFERENCE_PLANE},
                                                                {RP_RAIL, RP_REFERENCE_CURVED}};
  for (const auto &[track, surface] : scene_of) {
    rp_config c = scenes::coarse(scenes::wheels(RP_WHEELSET, track, pair));
    c.reference_surface = surface;
    std::vector<rp_input> inputs;
    for (double y : {0.0, 5e-4, 2e-3, 5e-3, 5.9e-3, 6e-3, 6.05e-3, -4e-3}) {
      rp_input in = scenes::running(track);
      in.y = y;
      in.yaw = 0.002;
      in.vertical_force = 1.2e5;
      inputs.push_back(in);
    }
    const outcome force = run(c, inputs);
    EXPECT_EQ(force.allocated, 0) << "track " << track << " force prescribed";
    EXPECT_FALSE(force.lifted);
    // on rollers the two contacts share one patch
    EXPECT_GE(force.greatest_patches, track == RP_RAIL ? 2 : 1) << "tread and flange at once";

    c.load = RP_POSITION;
    for (size_t i = 0; i < inputs.size(); ++i) inputs[i].z = force.heights[i];
    inputs.push_back(inputs[0]);
    inputs.back().z -= 2e-3;
    inputs.push_back(inputs[0]);
    const outcome position = run(c, inputs);
    EXPECT_EQ(position.allocated, 0) << "track " << track << " position prescribed";
    EXPECT_TRUE(position.lifted);
  }
}

// --- derivatives ---------------------------------------------------------------------------

// Of every number of the input that the kind reads, after each step.
template <class Inputs>
int allocated_by_derivatives(rp_config config, const Inputs &inputs, rp_derivative_kind expected) {
  config.derivatives = 1;
  scenes::handle contact(config);
  auto change = std::make_unique<rp_result>();
  int sum = 0;
  for (const rp_input &in : inputs) {
    rp_message message{};
    rp_error error = RP_OK;
    sum += allocations([&] { contact.step(in); });
    rp_input direction;
    rp_default_direction(&direction);
    if (config.load == RP_FORCE) direction.normal_force = direction.vertical_force = 1;
    direction.creepage[0] = direction.creepage[1] = direction.spin_creepage = 1;
    direction.y = direction.yaw = direction.speed = direction.approach = 1;
    rp_derivative_kind kind = RP_DERIVATIVE_EXACT;
    sum += allocations([&] {
      error = rp_differentiate(contact.get(), &direction, change.get(), &kind, &message);
    });
    EXPECT_EQ(error, RP_OK) << message.text;
    EXPECT_EQ(kind, expected);
    EXPECT_NE(change->status, RP_NOT_CONVERGED);
  }
  return sum;
}

TEST(Derivatives, OfAPatchAllocateNothing) {
  for (rp_normal_method normal : {RP_NORMAL_HERTZ, RP_NORMAL_HALF_SPACE})
    for (rp_tangential_method tangential : {RP_TANGENTIAL_NONE, RP_TANGENTIAL_FULL})
      for (rp_load load : {RP_FORCE, RP_POSITION})
        for (rp_geometry geometry : {RP_SEMI_AXES, RP_CURVATURES}) {
          rp_config c = scenes::patch(normal, tangential, 14);
          c.load = load;
          c.geometry = geometry;
          std::vector<rp_input> inputs = patch_inputs();
          for (auto &in : inputs) in.approach = 1e-9 * in.normal_force;
          EXPECT_EQ(allocated_by_derivatives(c, inputs, RP_DERIVATIVE_EXACT), 0)
              << "normal " << normal << " tangential " << tangential << " load " << load;
        }
}

TEST(Subsurface, AllocatesNothing) {
  for (const int fitted : {0, 12}) {
    rp_config c = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL, 14);
    if (fitted) c.fitted[0] = c.fitted[1] = fitted;
    scenes::handle contact(c);
    const double depth[] = {0.5e-3, 1e-3, 2e-3};
    rp_subsurface_config config;
    rp_default_subsurface(&config);
    config.depth = depth;
    config.depth_count = 3;
    rp_subsurface *below = nullptr;
    ASSERT_EQ(rp_create_subsurface(contact.get(), &config, &below, nullptr), RP_OK);
    std::vector<double> values(100000);
    auto result = std::make_unique<rp_result>();
    const std::vector<rp_input> inputs = patch_inputs();
    int wrong = 0;
    const int allocated = allocations([&] {
      for (const rp_input &in : inputs) {
        rp_step(contact.get(), &in, result.get(), nullptr);
        if (result->status != RP_CONVERGED) continue;
        for (const int body : {RP_BODY_WHEEL, RP_BODY_RAIL}) {
          wrong += rp_solve_subsurface(below, contact.get(), RP_RIGHT, 0, body, nullptr) != RP_OK;
          for (const rp_subsurface_field field :
               {RP_SUBSURFACE_STRESS, RP_SUBSURFACE_VON_MISES, RP_SUBSURFACE_DANG_VAN}) {
            size_t count = values.size();
            wrong += rp_get_subsurface_field(below, field, values.data(), &count) != RP_OK;
          }
        }
      }
    });
    EXPECT_EQ(allocated, 0) << "fitted " << fitted;
    EXPECT_EQ(wrong, 0);
    rp_destroy_subsurface(below);
  }
}

TEST(Derivatives, ByDifferencesAllocateNothing) {
  rp_config fast = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FASTSIM, 12);
  EXPECT_EQ(allocated_by_derivatives(fast, patch_inputs(), RP_DERIVATIVE_BY_DIFFERENCES), 0);
  rp_config shift = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 12);
  shift.regime = RP_SHIFT;
  std::vector<rp_input> inputs = patch_inputs();
  for (auto &in : inputs) in.creepage[0] *= 1e-3, in.creepage[1] *= 1e-3, in.spin_creepage = 0;
  EXPECT_EQ(allocated_by_derivatives(shift, inputs, RP_DERIVATIVE_BY_DIFFERENCES), 0);
}

}  // namespace
