// Handles on several threads give the bits that they give one after the other, also while other
// handles are made and destroyed.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "scenes.hpp"

namespace {

struct job {
  rp_config config;
  std::vector<rp_input> inputs;
};

std::vector<job> jobs(const scenes::profile_pair &pair) {
  std::vector<job> all;
  job patch{scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 18), {}};
  for (int i = 0; i < 8; ++i)
    patch.inputs.push_back(scenes::patch_input(5e4 + 1e4 * i, 3e-4 * i, -1e-4 * i, 0.05 * i));
  all.push_back(patch);
  job wheelset{scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair)), {}};
  for (int i = 0; i < 4; ++i) {
    wheelset.inputs.push_back(scenes::running(RP_RAIL));
    wheelset.inputs.back().y = 2e-3 * i;
    wheelset.inputs.back().yaw = -1e-3 * i;
  }
  all.push_back(wheelset);
  return all;
}

// all results of one new handle, with the pressure of the last step
struct trace {
  std::vector<rp_result> results;
  std::vector<double> pressure;
};

trace run(const job &j) {
  trace t;
  scenes::handle contact(j.config);
  for (const rp_input &in : j.inputs) t.results.push_back(contact.step(in));
  t.pressure = contact.field(RP_RIGHT, 0, RP_FIELD_PRESSURE);
  return t;
}

void expect_same(const trace &a, const trace &b) {
  ASSERT_EQ(a.results.size(), b.results.size());
  for (size_t i = 0; i < a.results.size(); ++i)
    EXPECT_EQ(scenes::difference(a.results[i], b.results[i]), "") << "step " << i;
  EXPECT_TRUE(scenes::same_bits(a.pressure, b.pressure));
}

TEST(Threads, GiveTheBitsOfOneThread) {
  const scenes::profile_pair pair;
  for (const job &j : jobs(pair)) {
    const trace alone = run(j);
    for (int round = 0; round < 4; ++round) {
      trace first, second;
      std::thread one([&] { first = run(j); }), two([&] { second = run(j); });
      one.join();
      two.join();
      expect_same(first, alone);
      expect_same(second, alone);
    }
  }
}

TEST(Threads, DoNotDisturbEachOtherWithDifferentScenes) {
  const scenes::profile_pair pair;
  const std::vector<job> all = jobs(pair);
  const trace patch = run(all[0]), wheelset = run(all[1]);
  for (int round = 0; round < 4; ++round) {
    trace first, second;
    std::thread one([&] { first = run(all[0]); }), two([&] { second = run(all[1]); });
    one.join();
    two.join();
    expect_same(first, patch);
    expect_same(second, wheelset);
  }
}

TEST(Threads, MayCreateAndDestroyMeanwhile) {
  const scenes::profile_pair pair;
  const std::vector<job> all = jobs(pair);
  const trace alone = run(all[0]);
  std::atomic<bool> stop{false};
  std::atomic<int> made{0};
  std::vector<std::thread> makers;
  for (int m = 0; m < 2; ++m)
    makers.emplace_back([&, m] {
      // sizes change, so that the FFT library makes and forgets plans all the time
      for (int n = 6 + m; !stop || made < 4; n = 6 + (n + 5) % 23) {
        const scenes::handle contact(scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, n));
        ++made;
      }
    });
  for (int round = 0; round < 5; ++round) expect_same(run(all[0]), alone);
  stop = true;
  for (std::thread &maker : makers) maker.join();
  expect_same(run(all[0]), alone);
  EXPECT_GE(made, 4);
}

// A handle may move between threads as long as one at a time uses it.
TEST(Threads, MayHandOverAHandle) {
  const scenes::profile_pair pair;
  for (const job &j : jobs(pair)) {
    const trace alone = run(j);
    scenes::handle contact(j.config);
    for (size_t i = 0; i < j.inputs.size(); ++i)
      std::thread([&] {
        EXPECT_EQ(scenes::difference(contact.step(j.inputs[i]), alone.results[i]), "");
      }).join();
  }
}

}  // namespace
