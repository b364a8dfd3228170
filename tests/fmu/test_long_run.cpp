// A long life of one instance: 10,000 steps with rollbacks, serialised states, steps that fail and
// resets; for the sanitizers and valgrind, and the same bits at the end as without all that.
#include "made_fmu.hpp"

namespace {

constexpr int steps = 10000;
constexpr double length = 1e-4;

double creepage_at(int k) { return 2e-3 * std::sin(1e-2 * k); }

// One step of the run.
void plain_step(made::slave &slave, int k) {
  ASSERT_EQ(slave.set(made::creepage, creepage_at(k)), fmi2OK);
  ASSERT_EQ(slave.step(length), fmi2OK) << slave.message;
}

class Busy {
 public:
  explicit Busy(made::slave &slave) : slave_(slave) {}

  void step(int k) {
    if (k % 100 == 50) roll_back(k);
    if (k % 1000 == 500) move_by_bytes();
    if (k % 1000 == 700) fail();
    plain_step(slave_, k);
  }

 private:
  // Steps on, comes back.
  void roll_back(int k) {
    fmi2FMUstate state = nullptr;
    ASSERT_EQ(fmi2GetFMUstate(slave_.get(), &state), fmi2OK);
    const double time = slave_.time;
    for (int i = 0; i < 3; ++i) plain_step(slave_, 7 * k + i);
    ASSERT_EQ(fmi2SetFMUstate(slave_.get(), state), fmi2OK);
    ASSERT_EQ(fmi2FreeFMUstate(slave_.get(), &state), fmi2OK);
    slave_.time = time;
  }

  void move_by_bytes() {
    fmi2FMUstate state = nullptr, copy = nullptr;
    size_t size = 0;
    ASSERT_EQ(fmi2GetFMUstate(slave_.get(), &state), fmi2OK);
    ASSERT_EQ(fmi2SerializedFMUstateSize(slave_.get(), state, &size), fmi2OK);
    std::vector<char> bytes(size);
    ASSERT_EQ(fmi2SerializeFMUstate(slave_.get(), state, bytes.data(), size), fmi2OK);
    ASSERT_EQ(fmi2DeSerializeFMUstate(slave_.get(), bytes.data(), size, &copy), fmi2OK);
    ASSERT_EQ(fmi2Reset(slave_.get()), fmi2OK);
    ASSERT_EQ(fmi2SetFMUstate(slave_.get(), copy), fmi2OK);
    // the states themselves are left to fmi2FreeInstance
  }

  // A step in which the creepage leaves its range.
  void fail() {
    fmi2FMUstate state = nullptr;
    ASSERT_EQ(fmi2GetFMUstate(slave_.get(), &state), fmi2OK);
    ASSERT_EQ(slave_.set_rate(made::creepage, 1e9), fmi2OK);
    ASSERT_EQ(slave_.step(length), fmi2Discard);
    ASSERT_EQ(slave_.step(length), fmi2Error);  // not before a state is restored
    ASSERT_EQ(fmi2SetFMUstate(slave_.get(), state), fmi2OK);
    ASSERT_EQ(fmi2FreeFMUstate(slave_.get(), &state), fmi2OK);
  }

  made::slave &slave_;
};

TEST(LongRun, TenThousandStepsWithRollbackLeaveTheBitsAlone) {
  const scenes::profile_pair pair;
  for (const made::scene &s : made::scenes_of(pair)) {
    if (s.name != "fast" && s.name != "transient") continue;
    made::scene small = s;
    small.config.elements[0] = small.config.elements[1] = 6;
    const auto folder = made::write(small);
    std::vector<double> results[2];
    for (const bool busy : {false, true}) {
      made::slave slave(folder);
      slave.initialize();
      Busy work(slave);
      const int count = s.name == "fast" ? steps : steps / 10;
      for (int k = 0; k < count && !HasFatalFailure(); ++k) {
        busy ? work.step(k) : plain_step(slave, k);
        if (k % 97 == 0)
          for (const fmi2ValueReference output : {2104, 2106, 2109})
            results[busy].push_back(slave.get(output));
      }
    }
    EXPECT_GT(results[0].size(), 3u);
    EXPECT_TRUE(scenes::same_bits(results[0], results[1])) << s.name;
  }
}

}  // namespace
