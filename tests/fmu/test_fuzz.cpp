// Random calls with random arguments, good and bad: nothing may crash, and every refused call
// leaves exactly one line in the log. Seeds are printed where it fails. RAILPATCH_FUZZ_SEEDS: how
// many sequences of 40 calls, for a longer search by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <vector>

#include "checksum.hpp"
#include "fmi2Functions.h"

namespace {

constexpr const char *kGuid = "{00000000-0000-4000-8000-000000000001}";
// The interface of a seed, so that both are tried.
fmi2Type interface_of(unsigned seed) {
  return seed % 2 == 0 ? fmi2CoSimulation : fmi2ModelExchange;
}

constexpr fmi2ValueReference kInputs[] = {22, 23, 24, 25, 26};
constexpr fmi2ValueReference kOutputs[] = {2102, 2104, 2105, 2106, 2107};

// A patch with a given approach, by the fastest theories; written as plugins/fmu/src/scene.hpp
// tells. Its contact is made anew where a profile is chosen, though a patch has none.
std::filesystem::path write_scene() {
  std::ostringstream text;
  text << "railpatch-fmu-scene 1\nguid " << kGuid << "\nset kind 0\nset geometry 1\n"
       << "set curvatures 1.0 1.5\nset load 1\nset elements 6 6\nset normal 0\nset tangential 1\n"
       << "set derivatives 1\n"
       << "choice wheel 2 arc_length 2 0 1\nchoice wheel 2 y 2 0 1\nchoice wheel 2 z 2 0 0\n"
       << "choice wheel 2 dy 2 1 1\nchoice wheel 2 dz 2 0 0\n"
       << "variable 22 approach 5e-05\nvariable 23 creepage[1] 0.001\n"
       << "variable 24 creepage[2] 0.0\nvariable 25 spin_creepage 0.0\n"
       << "variable 26 rolling_speed 10.0\nvariable 27 direction 1\n"
       << "variable 31 friction.coefficient 0.3\nvariable 39 profiles.wheel 1\n"
       << "variable 41 status 0\n";
  for (const auto reference : kOutputs)
    text << "variable " << reference << " output" << reference << " 0\n";
  const std::string body = text.str();
  char end[32];
  std::snprintf(end, sizeof end, "end %08x\n", railpatch::fmu::crc32(body.data(), body.size()));
  // its own, as others may run beside it
  std::string own = (std::filesystem::temp_directory_path() / "railpatch_XXXXXX").string();
  if (mkdtemp(own.data()) == nullptr) std::abort();
  const auto folder = std::filesystem::path(own) / "fuzz %41 #";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "scene.txt", std::ios::binary) << body << end;
  return folder;
}

struct Listener {
  int errors = 0;
};

void hear(fmi2ComponentEnvironment environment, fmi2String, fmi2Status status, fmi2String,
          fmi2String, ...) {
  if (status == fmi2Error) ++static_cast<Listener *>(environment)->errors;
}

// One instance under random calls.
class Fuzzer {
 public:
  Fuzzer(unsigned seed, const std::string &location)
      : random_(seed), functions_{hear, nullptr, nullptr, nullptr, &listener_} {
    slave_ = fmi2Instantiate("fuzz", interface_of(seed), kGuid, location.c_str(), &functions_,
                             fmi2False, fmi2True);
  }
  ~Fuzzer() { fmi2FreeInstance(slave_); }
  Fuzzer(const Fuzzer &) = delete;
  Fuzzer &operator=(const Fuzzer &) = delete;

  int derivatives_found = 0;

  bool made() const { return slave_ != nullptr; }

  // A random call; the log's repeats are limited, so that a silent error is one after others only.
  void call() {
    const int before = listener_.errors;
    const fmi2Status status = any();
    ASSERT_GE(status, fmi2OK);
    ASSERT_LE(status, fmi2Error);
    ASSERT_LE(listener_.errors, before + 1);
    if (status == fmi2Error) {
      silent_ = listener_.errors == before ? silent_ + 1 : 0;
      ASSERT_TRUE(listener_.errors == before + 1 || before > 100);
    } else {
      ASSERT_EQ(listener_.errors, before);
    }
  }

 private:
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  double number() {
    constexpr double kinds[] = {0.0,  -0.0, 1.0,   -1.0,   1e-5,     3e-5,
                                1e-3, 10.0, 1e300, 5e-324, HUGE_VAL, -HUGE_VAL};
    const int kind = pick(16);
    if (kind == 15) return std::numeric_limits<double>::quiet_NaN();
    if (kind >= 12) return std::uniform_real_distribution<double>(-1e-4, 1e-4)(random_);
    return kinds[kind];
  }

  fmi2ValueReference reference() {
    const int kind = pick(12);
    if (kind < 5) return kInputs[pick(5)];
    if (kind < 8) return kOutputs[pick(5)];
    if (kind < 10) return static_cast<fmi2ValueReference>(27 + 4 * pick(5));
    return kind == 10 ? static_cast<fmi2ValueReference>(random_()) : 0;
  }

  fmi2Status values(int call) {
    fmi2ValueReference references[4];
    fmi2Real reals[4];
    fmi2Integer integers[4];
    fmi2String strings[4] = {"a", "b", "c", nullptr};
    for (int i = 0; i < 4; ++i) {
      references[i] = reference();
      reals[i] = number();
      integers[i] = pick(5) - 2;
    }
    const auto count = static_cast<size_t>(pick(5));
    const auto *given = pick(20) == 0 ? nullptr : references;
    const bool array = pick(20) != 0;
    switch (call) {
      case 0:
        return fmi2GetReal(slave_, given, count, array ? reals : nullptr);
      case 1:
        return fmi2SetReal(slave_, given, count, array ? reals : nullptr);
      case 2:
        return fmi2GetInteger(slave_, given, count, array ? integers : nullptr);
      case 3:
        return fmi2SetInteger(slave_, given, count, array ? integers : nullptr);
      case 4:
        return fmi2GetBoolean(slave_, given, count, array ? integers : nullptr);
      case 5:
        return fmi2SetString(slave_, given, count, array ? strings : nullptr);
      case 6:
        return fmi2SetRealInputDerivatives(slave_, given, count, integers, reals);
      default:
        return derivatives(given, count, array ? reals : nullptr);
    }
  }

  // Mostly of outputs by inputs.
  fmi2Status derivatives(const fmi2ValueReference *given, size_t count, fmi2Real *reals) {
    fmi2ValueReference known[4], unknown[4];
    fmi2Integer order[4];
    fmi2Real seed[4];
    for (int i = 0; i < 4; ++i) {
      known[i] = pick(10) == 0 ? reference() : kInputs[pick(5)];
      unknown[i] = pick(10) == 0 ? reference() : kOutputs[pick(5)];
      order[i] = pick(10) == 0 ? pick(6) - 1 : 1;
      seed[i] = pick(10) == 0 ? number() : 1e-5;
    }
    switch (pick(4)) {
      case 0:
        return fmi2GetRealOutputDerivatives(slave_, unknown, count, order, reals);
      case 1:
        return fmi2SetRealInputDerivatives(slave_, known, count, order, reals);
      case 2:
        return fmi2GetDirectionalDerivative(slave_, given, count, given, count, reals, reals);
      default:
        const fmi2Status status =
            fmi2GetDirectionalDerivative(slave_, unknown, count, known, count, seed, reals);
        if (status == fmi2OK && count > 0) ++derivatives_found;
        return status;
    }
  }

  fmi2Status exchange() {
    fmi2EventInfo info;
    fmi2Boolean flags[2];
    fmi2Real real;
    const auto count = static_cast<size_t>(pick(10) == 0);
    switch (pick(10)) {
      case 0:
        return fmi2EnterEventMode(slave_);
      case 1:
        return fmi2NewDiscreteStates(slave_, pick(10) == 0 ? nullptr : &info);
      case 2:
      case 3:
        return fmi2EnterContinuousTimeMode(slave_);
      case 4:
        return fmi2CompletedIntegratorStep(slave_, fmi2True, pick(10) == 0 ? nullptr : flags,
                                           flags + 1);
      case 5:
        return fmi2SetTime(slave_, number());
      case 6:
        return fmi2SetContinuousStates(slave_, &real, count);
      case 7:
        return fmi2GetDerivatives(slave_, &real, count);
      case 8:
        return fmi2GetEventIndicators(slave_, &real, count);
      default:
        return pick(2) == 0 ? fmi2GetContinuousStates(slave_, &real, count)
                            : fmi2GetNominalsOfContinuousStates(slave_, &real, count);
    }
  }

  fmi2Status states(int call) {
    fmi2FMUstate &state = states_[pick(3)];
    fmi2FMUstate wild = reinterpret_cast<fmi2FMUstate>(static_cast<uintptr_t>(random_()));
    switch (call) {
      case 0:
        return fmi2GetFMUstate(slave_, pick(20) == 0 ? nullptr : &state);
      case 1:
        return fmi2SetFMUstate(slave_, pick(10) == 0 ? wild : state);
      case 2:
        return fmi2FreeFMUstate(slave_, pick(10) == 0 ? &wild : &state);
      case 3:
        return save(state);
      default:
        return load(state);
    }
  }

  fmi2Status save(fmi2FMUstate state) {
    size_t size = 0;
    const fmi2Status status = fmi2SerializedFMUstateSize(slave_, state, &size);
    if (status != fmi2OK) return status;
    bytes_.resize(size);
    return fmi2SerializeFMUstate(slave_, state, bytes_.data(), size - (pick(10) == 0 ? 1 : 0));
  }

  fmi2Status load(fmi2FMUstate &state) {
    std::vector<char> bytes = bytes_;
    if (!bytes.empty() && pick(2) == 0)
      bytes[static_cast<size_t>(pick(static_cast<int>(bytes.size())))] ^= 1;
    if (!bytes.empty() && pick(4) == 0) bytes.resize(static_cast<size_t>(pick(200)));
    return fmi2DeSerializeFMUstate(slave_, bytes.data(), bytes.size(), &state);
  }

  fmi2Status step() {
    // mostly as a master does
    if (pick(4) != 0) {
      fmi2Real time = 0;
      const fmi2Status status = fmi2GetRealStatus(slave_, fmi2LastSuccessfulTime, &time);
      return status == fmi2OK ? fmi2DoStep(slave_, time, 1e-3, fmi2True) : status;
    }
    return fmi2DoStep(slave_, number(), number(), fmi2False);
  }

  fmi2Status any() {
    fmi2Real real;
    fmi2Status status;
    const fmi2String category = pick(2) == 0 ? "logAll" : "none";
    const int call = pick(46);
    if (call >= 40) return exchange();
    if (call < 16) return values(call % 8);
    if (call < 24) return states(call % 5);
    if (call < 32) return step();
    switch (call) {
      case 32:
        return fmi2SetupExperiment(slave_, pick(2), number(), 0.0, 0, 0.0);
      case 33:
      case 34:
        return fmi2EnterInitializationMode(slave_);
      case 35:
      case 36:
        return fmi2ExitInitializationMode(slave_);
      case 37:
        return pick(3) == 0 ? fmi2Terminate(slave_) : fmi2Reset(slave_);
      case 38:
        return pick(2) == 0 ? fmi2CancelStep(slave_)
                            : fmi2GetStatus(slave_, static_cast<fmi2StatusKind>(pick(4)), &status);
      default:
        return pick(2) == 0
                   ? fmi2SetDebugLogging(slave_, fmi2True, 1, &category)
                   : fmi2GetRealStatus(slave_, static_cast<fmi2StatusKind>(pick(4)), &real);
    }
  }

  std::mt19937 random_;
  Listener listener_;
  fmi2CallbackFunctions functions_;
  fmi2Component slave_ = nullptr;
  fmi2FMUstate states_[3] = {};
  std::vector<char> bytes_;
  int silent_ = 0;
};

TEST(Fuzz, RandomCallsNeverCrash) {
  const std::filesystem::path folder = write_scene();
  const std::string location = folder.string();
  int derivatives_found[2] = {};
  const char *asked = std::getenv("RAILPATCH_FUZZ_SEEDS");
  const unsigned long seeds = asked != nullptr ? std::strtoul(asked, nullptr, 10) : 10000;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    Fuzzer fuzzer(seed, location);
    ASSERT_TRUE(fuzzer.made());
    for (int i = 0; i < 40; ++i) {
      fuzzer.call();
      if (HasFatalFailure()) return;
    }
    derivatives_found[interface_of(seed)] += fuzzer.derivatives_found;
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder.parent_path(), ignored);
  // the calls do come far
  EXPECT_GT(derivatives_found[fmi2CoSimulation], 100);
  EXPECT_GT(derivatives_found[fmi2ModelExchange], 100);
}

}  // namespace
