// FMI 3.0 under random calls with random arguments, good and bad: nothing may crash, every refused
// call leaves exactly one line in the log, and what is discarded none but that. Seeds are printed
// where it fails. RAILPATCH_FUZZ_SEEDS: how many sequences of 40 calls, for a longer search by
// hand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "checksum.hpp"
#include "fmi3Functions.h"
#include "made_fmu.hpp"

namespace {

// A patch with a given approach, by the fastest theories; creepage and creep force are arrays.
std::filesystem::path write_scene() {
  std::string text = std::string("railpatch-fmu-scene 1\nguid ") + made::guid + "\n";
  text +=
      "set kind 0\nset geometry 1\nset curvatures 1.0 1.5\nset load 1\nset elements 6 6\n"
      "set normal 0\nset tangential 1\nset derivatives 1\n"
      "variable 22 approach 5e-05\nvariable 23 creepage[1] 0.001\nvariable 24 creepage[2] 0.0\n"
      "array 23 2\nvariable 25 spin_creepage 0.0\nvariable 26 rolling_speed 10.0\n"
      "variable 27 direction 1\nvariable 31 friction.coefficient 0.3\nvariable 41 status 0\n"
      "variable 99 time 0\nvariable 2102 normal_force 0\nvariable 2104 creep_force[1] 0\n"
      "variable 2105 creep_force[2] 0\narray 2104 2\nvariable 2112 iterations 0\n";
  char end[32];
  std::snprintf(end, sizeof end, "end %08x\n", railpatch::fmu::crc32(text.data(), text.size()));
  const auto folder = made::own_folder() / "fuzz3 %41 #";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "scene.txt", std::ios::binary) << text << end;
  return folder;
}

struct listener {
  int errors = 0;
};

void hear(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String, fmi3String) {
  if (status == fmi3Error) ++static_cast<listener *>(environment)->errors;
}

bool is_slave(unsigned seed) { return seed % 2 == 0; }

// One instance under random calls.
class fuzzer {
 public:
  fuzzer(unsigned seed, const std::string &location) : random_(seed) {
    instance_ = is_slave(seed)
                    ? fmi3InstantiateCoSimulation("fuzz", made::guid, location.c_str(), fmi3False,
                                                  fmi3True, fmi3False, fmi3False, nullptr, 0,
                                                  &listener_, hear, nullptr)
                    : fmi3InstantiateModelExchange("fuzz", made::guid, location.c_str(), fmi3False,
                                                   fmi3True, &listener_, hear);
  }
  ~fuzzer() { fmi3FreeInstance(instance_); }
  fuzzer(const fuzzer &) = delete;
  fuzzer &operator=(const fuzzer &) = delete;

  int derivatives_found = 0;
  bool made() const { return instance_ != nullptr; }

  // The log's repeats are limited, so that a silent error is one after others only.
  void call() {
    const int before = listener_.errors;
    const fmi3Status status = any();
    ASSERT_GE(status, fmi3OK);
    ASSERT_LE(status, fmi3Error);
    ASSERT_LE(listener_.errors, before + 1);
    if (status == fmi3Error)
      ASSERT_TRUE(listener_.errors == before + 1 || before > 100);
    else
      ASSERT_EQ(listener_.errors, before);
  }

 private:
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  double number() {
    constexpr double kinds[] = {0.0,  -0.0, 1.0,   -1.0,   1e-5,     3e-5,
                                1e-3, 10.0, 1e300, 5e-324, HUGE_VAL, -HUGE_VAL};
    const int at = pick(13);
    return at == 12 ? std::nan("") : kinds[at];
  }

  // mostly one that there is
  fmi3ValueReference reference() {
    constexpr fmi3ValueReference known[] = {22, 23, 24, 25, 26, 27, 31, 2102, 2104, 2112, 41, 99};
    return pick(12) == 0 ? static_cast<fmi3ValueReference>(random_()) : known[pick(12)];
  }

  // with the number of values that belongs to it, most times
  fmi3Status values() {
    const fmi3ValueReference one = reference();
    const bool pair = one == 23 || one == 2104;
    const size_t count = static_cast<size_t>(pick(12) == 0 ? pick(5) : (pair ? 2 : 1));
    const fmi3ValueReference *const given = pick(20) == 0 ? nullptr : &one;
    fmi3Float64 reals[5];
    fmi3Int32 whole[5];
    fmi3Int64 items[5];
    for (int k = 0; k < 5; ++k) {
      reals[k] = pick(3) == 0 ? number() : 1e-5;
      whole[k] = pick(4) - 2;
      items[k] = pick(4);
    }
    switch (pick(9)) {
      case 0:
      case 1:
        return fmi3GetFloat64(instance_, given, 1, pick(20) == 0 ? nullptr : reals, count);
      case 2:
      case 3:
        return fmi3SetFloat64(instance_, given, 1, pick(20) == 0 ? nullptr : reals, count);
      case 4:
        return fmi3GetInt32(instance_, given, 1, whole, count);
      case 5:
        return fmi3SetInt32(instance_, given, 1, whole, count);
      case 6:
        return fmi3GetInt64(instance_, given, 1, items, count);
      case 7:
        return fmi3SetInt64(instance_, given, 1, items, count);
      default:
        return others(given, count);
    }
  }

  // types that the scene does not have
  fmi3Status others(const fmi3ValueReference *given, size_t count) {
    fmi3Boolean flags[5] = {};
    fmi3String texts[5] = {};
    fmi3Binary bytes[5] = {};
    size_t sizes[5] = {};
    switch (pick(4)) {
      case 0:
        return fmi3GetBoolean(instance_, given, 1, flags, count);
      case 1:
        return fmi3SetString(instance_, given, 1, texts, count);
      case 2:
        return fmi3SetBinary(instance_, given, 1, sizes, bytes, count);
      default:
        return fmi3GetClock(instance_, given, 1, flags);
    }
  }

  fmi3Status derivative() {
    constexpr fmi3ValueReference unknown[] = {2102, 2104}, known[] = {22, 23, 31};
    fmi3Float64 seed[6], found[6];
    for (double &s : seed) s = pick(10) == 0 ? number() : 1.0;
    const size_t few = pick(10) == 0 ? 1 : 0;  // one too few
    const bool wrong = pick(10) == 0;
    fmi3Status status;
    if (pick(2) == 0)
      status = fmi3GetDirectionalDerivative(instance_, wrong ? known : unknown, 2, known, 3, seed,
                                            4 - few, found, 3);
    else
      status =
          fmi3GetAdjointDerivative(instance_, unknown, 2, wrong ? unknown : known, wrong ? 2 : 3,
                                   pick(20) == 0 ? nullptr : seed, 3 - few, found, wrong ? 3 : 4);
    if (status == fmi3OK) ++derivatives_found;
    return status;
  }

  fmi3Status exchange() {
    fmi3Boolean flags[5];
    fmi3Float64 when;
    size_t count;
    const auto some = static_cast<size_t>(pick(10) == 0);
    switch (pick(9)) {
      case 0:
        return fmi3EnterEventMode(instance_);
      case 1:
        return fmi3UpdateDiscreteStates(instance_, flags, flags + 1, flags + 2, flags + 3,
                                        flags + 4, pick(10) == 0 ? nullptr : &when);
      case 2:
      case 3:
        return fmi3EnterContinuousTimeMode(instance_);
      case 4:
        return fmi3CompletedIntegratorStep(instance_, fmi3True, pick(10) == 0 ? nullptr : flags,
                                           flags + 1);
      case 5:
        return fmi3SetTime(instance_, number());
      case 6:
        return fmi3GetContinuousStateDerivatives(instance_, &when, some);
      case 7:
        return fmi3GetNumberOfContinuousStates(instance_, pick(10) == 0 ? nullptr : &count);
      default:
        return fmi3GetEventIndicators(instance_, &when, some);
    }
  }

  fmi3Status states() {
    fmi3FMUState &state = states_[pick(3)];
    fmi3FMUState wild = reinterpret_cast<fmi3FMUState>(static_cast<uintptr_t>(random_()));
    size_t size = 0;
    fmi3Status status = fmi3OK;
    switch (pick(5)) {
      case 0:
        return fmi3GetFMUState(instance_, pick(20) == 0 ? nullptr : &state);
      case 1:
        return fmi3SetFMUState(instance_, pick(10) == 0 ? wild : state);
      case 2:
        return fmi3FreeFMUState(instance_, pick(10) == 0 ? &wild : &state);
      case 3:
        status = fmi3SerializedFMUStateSize(instance_, state, &size);
        if (status != fmi3OK) return status;
        bytes_.resize(size);
        return fmi3SerializeFMUState(instance_, state, bytes_.data(),
                                     size - (pick(10) == 0 ? 1 : 0));
      default: {
        std::vector<fmi3Byte> bytes = bytes_;
        if (!bytes.empty() && pick(2) == 0)
          bytes[static_cast<size_t>(pick(static_cast<int>(bytes.size())))] ^= 1;
        if (!bytes.empty() && pick(4) == 0) bytes.resize(static_cast<size_t>(pick(200)));
        return fmi3DeserializeFMUState(instance_, bytes.data(), bytes.size(), &state);
      }
    }
  }

  fmi3Status step() {
    fmi3Boolean flags[3];
    fmi3Float64 time = 0, last = 0;
    const fmi3ValueReference clock = 99;
    if (pick(4) == 0)
      return fmi3DoStep(instance_, number(), number(), fmi3False, nullptr, flags, flags + 1,
                        nullptr);
    // mostly as a master does
    const fmi3Status status = fmi3GetFloat64(instance_, &clock, 1, &time, 1);
    return status == fmi3OK
               ? fmi3DoStep(instance_, time, 1e-3, fmi3True, flags, flags + 1, flags + 2, &last)
               : status;
  }

  fmi3Status any() {
    const fmi3String category = pick(2) == 0 ? "logAll" : "none";
    const int call = pick(46);
    if (call < 14) return values();
    if (call < 20) return states();
    if (call < 28) return step();
    if (call < 33) return derivative();
    if (call < 38) return exchange();
    switch (call) {
      case 38:
      case 39:
        return fmi3EnterInitializationMode(instance_, pick(2) == 0, number(), 0.0, fmi3False, 0.0);
      case 40:
      case 41:
        return fmi3ExitInitializationMode(instance_);
      case 42:
        return pick(3) == 0 ? fmi3Terminate(instance_) : fmi3Reset(instance_);
      case 43:
        return pick(2) == 0 ? fmi3EnterConfigurationMode(instance_) : fmi3EnterStepMode(instance_);
      case 44:
        return fmi3GetOutputDerivatives(instance_, nullptr, 0, nullptr, nullptr, 0);
      default:
        return fmi3SetDebugLogging(instance_, fmi3True, 1, &category);
    }
  }

  std::mt19937 random_;
  listener listener_;
  fmi3Instance instance_ = nullptr;
  fmi3FMUState states_[3] = {};
  std::vector<fmi3Byte> bytes_;
};

TEST(Fmi3Fuzz, RandomCallsNeverCrash) {
  const std::string location = write_scene().string() + "/";
  int derivatives_found[2] = {};
  const char *asked = std::getenv("RAILPATCH_FUZZ_SEEDS");
  const unsigned long seeds = asked != nullptr ? std::strtoul(asked, nullptr, 10) : 5000;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    fuzzer one(seed, location);
    ASSERT_TRUE(one.made());
    for (int i = 0; i < 40; ++i) {
      one.call();
      if (HasFatalFailure()) return;
    }
    derivatives_found[is_slave(seed)] += one.derivatives_found;
  }
  // the calls do come far
  EXPECT_GT(derivatives_found[0], 100);
  EXPECT_GT(derivatives_found[1], 100);
}

}  // namespace
