// Instances on several threads give the bits that they give one after the other, through steps,
// sub-steps, derivatives, saved states and rollback.
#include <atomic>
#include <thread>

#include "made_fmu.hpp"

namespace {

constexpr int instances = 64, threads = 4, steps = 3;

struct place {
  made::scene scene;
  std::filesystem::path folder;
};

std::vector<place> places(const scenes::profile_pair &pair) {
  std::vector<place> all;
  for (made::scene &s : made::scenes_of(pair)) {
    const auto folder = made::write(s);
    all.push_back({std::move(s), folder});
  }
  return all;
}

void add_outputs(made::slave &slave, const made::scene &s, std::vector<double> &trace) {
  for (const made::variable &v : s.variables)
    if (v.reference > 40) trace.push_back(slave.get(v.reference));
}

// All numbers of one instance's life; number tells its inputs.
std::vector<double> live(const place &p, int number) {
  std::vector<double> trace;
  const made::scene &s = p.scene;
  const bool wheels = s.config.kind != RP_PATCH;
  const fmi2ValueReference moved = wheels ? made::lateral : made::creepage;
  const double size = wheels ? 2e-4 : 3e-4;
  made::slave slave(p.folder);
  slave.initialize();
  if (s.history) {
    EXPECT_EQ(slave.set_integer(made::substeps, 2), fmi2OK);
  }
  for (int k = 0; k < steps; ++k) {
    EXPECT_EQ(slave.set(moved, size * (1 + number % 5 + k)), fmi2OK);
    EXPECT_EQ(slave.set_rate(moved, 0.1 * size / 1e-3), fmi2OK);
    fmi2FMUstate state = nullptr;
    EXPECT_EQ(fmi2GetFMUstate(slave.get(), &state), fmi2OK);
    const double time = slave.time;
    // a step that is rejected, and made again by half its length
    EXPECT_EQ(slave.step(1e-3), fmi2OK) << slave.message;
    add_outputs(slave, s, trace);
    if (s.config.derivatives) trace.push_back(slave.derivative(wheels ? 44 : 2104, moved, size));
    EXPECT_EQ(fmi2SetFMUstate(slave.get(), state), fmi2OK);
    slave.time = time;
    EXPECT_EQ(slave.step(0.5e-3), fmi2OK) << slave.message;
    add_outputs(slave, s, trace);
    EXPECT_EQ(fmi2FreeFMUstate(slave.get(), &state), fmi2OK);
  }
  return trace;
}

TEST(Instances, SixtyFourOnFourThreadsGiveTheBitsOfOneAfterTheOther) {
  const scenes::profile_pair pair;
  const std::vector<place> all = places(pair);
  const auto run = [&](int number) {
    return live(all[static_cast<size_t>(number) % all.size()], number);
  };
  std::vector<std::vector<double>> alone(instances), together(instances);
  for (int i = 0; i < instances; ++i) alone[static_cast<size_t>(i)] = run(i);
  std::atomic<int> next{0};
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t)
    workers.emplace_back([&] {
      for (int i = next++; i < instances; i = next++) together[static_cast<size_t>(i)] = run(i);
    });
  for (std::thread &worker : workers) worker.join();
  for (size_t i = 0; i < instances; ++i) {
    EXPECT_GT(alone[i].size(), steps * 10u);
    EXPECT_TRUE(scenes::same_bits(alone[i], together[i])) << all[i % all.size()].scene.name;
  }
}

// One instance may move between threads as long as one at a time calls it.
TEST(Instances, MayBeHandedOver) {
  const scenes::profile_pair pair;
  const std::vector<place> all = places(pair);
  for (const place &p : all) {
    made::slave one(p.folder), other(p.folder);
    one.initialize();
    other.initialize();
    std::vector<double> here, there;
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(one.step(1e-3), fmi2OK);
      add_outputs(one, p.scene, here);
      std::thread([&] {
        EXPECT_EQ(other.step(1e-3), fmi2OK);
        add_outputs(other, p.scene, there);
      }).join();
    }
    EXPECT_TRUE(scenes::same_bits(here, there)) << p.scene.name;
  }
}

}  // namespace
