// The add-on's wheels: forces along the track and torques, rails placed by their profile, profiles
// by slices, input files; each also on two threads, and what every call says of a missing argument.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "contact_addon.h"

namespace {

class Wheels : public testing::Test {
 protected:
  void SetUp() override {
    cntc_finalizelast();
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::temp_directory_path() /
              ("contact_addon_" + std::to_string(getpid()) + test);
    std::filesystem::create_directories(folder_);
    write("rail.txt", rail(0));
    write("rail_low.txt", rail(0.5));
    write("wheel.txt", wheel());
    int version = 0, error = -1, output = 0, length = static_cast<int>(folder_.string().size());
    int one = 1, four = 4;
    cntc_initializefirst(&version, &error, &output, folder_.c_str(), " ", "said", &length, &one,
                         &four);
    ASSERT_EQ(error, 0);
  }
  void TearDown() override {
    cntc_finalizelast();
    std::filesystem::remove_all(folder_);
  }
  void write(const std::string &name, const std::string &text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string said() const {
    std::ifstream file(folder_ / "said.out");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // mm: a head of radius 300 with corners of radius 13 down to 20; all lower by a height
  static std::string rail(double low) {
    std::string out;
    const auto point = [&](double y, double z) {
      out += std::to_string(y) + " " + std::to_string(z + low) + "\n";
    };
    const double edge = 22, corner = 13;
    const double top = edge * edge / 600;
    for (double z = 12; z > 0.5; z -= 0.5) point(-edge - corner, top + corner + z);
    for (int k = 0; k <= 30; ++k) {
      const double angle = M_PI / 2 * (1 - k / 30.0) * 0.97;
      point(-edge - corner * std::sin(angle), top + corner * (1 - std::cos(angle)));
    }
    for (double y = -edge + 1; y < edge; y += 1) point(y, y * y / 600);
    for (int k = 0; k <= 30; ++k) {
      const double angle = M_PI / 2 * k / 30.0 * 0.97;
      point(edge + corner * std::sin(angle), top + corner * (1 - std::cos(angle)));
    }
    return out;
  }
  // mm: a tread of 1 : 40 and radius 900, a flange towards -y
  static std::string wheel() {
    std::string out;
    for (double y = -60; y <= 60; y += 1) {
      const double flange = y < -35 ? 28 * std::pow(std::sin(M_PI / 2 * (-35 - y) / 20), 2) : 0;
      out += std::to_string(y) + " " +
             std::to_string((y < -55 ? 28 : flange) - y / 40 + y * y / 1800) + "\n";
    }
    return out;
  }
  std::filesystem::path folder_;
};

// A right wheel of 60 kN at 20 m/s; units of 1936: SI, on the rail.
struct wheel_on_rail {
  int ire, all = -1;
  explicit wheel_on_rail(int element, const char *rail = "rail.txt",
                         const char *wheel = "wheel.txt")
      : ire(element) {
    flag(1933, 1936);
    flag(1967, 1);
    int m = 0, four = 4, two = 2, minus = -1, five = 5, three = 3;
    double steel[] = {.28, .28, 82e9, 82e9}, mu[] = {.3, .3};
    double grid[] = {1e-3, 1e-3, 1.6, 8e-3, 4e-3}, sizes[] = {1.36, -0.07, 0.46};
    cntc_setmaterialparameters(&ire, &all, &m, &four, steel);
    cntc_setfrictionmethod(&ire, &all, &m, &two, mu);
    int iterations[] = {999, 100, 30, 1}, one = 1;
    double tolerance[] = {1e-9};
    cntc_setsolverflags(&ire, &all, &m, &four, iterations, &one, tolerance);
    cntc_setpotcontact(&ire, &all, &minus, &five, grid);
    cntc_setwheelsetdimensions(&ire, &three, &three, sizes);
    track(0.014, 0, 1.435);
    profile(0, rail);
    profile(1, wheel);
    place(0, 0);
    speed(-43.4);
    double load = 6e4;
    cntc_setverticalforce(&ire, &load);
  }
  void flag(int code, int value) {
    int one = 1;
    cntc_setflags(&ire, &all, &one, &code, &value);
  }
  void track(double height, double second, double third) {
    int z = 1, five = 5;
    double values[] = {height, second, third, 0, 0.5};
    cntc_settrackdimensions(&ire, &z, &five, values);
  }
  void profile(int type, const std::string &name) {
    int ints[] = {type, 0, 0, -1}, four = 4, one = 1, length = static_cast<int>(name.size());
    double reals[] = {1.0};
    cntc_setprofileinputfname(&ire, name.c_str(), &length, &four, ints, &one, reals);
  }
  void place(double x, double pitch) {
    int one = 1, six = 6;
    double values[] = {x, 1e-3, 0, 0, 1e-3, pitch};
    cntc_setwheelsetposition(&ire, &one, &six, values);
  }
  void speed(double last) {
    int two = 2, six = 6;
    double values[] = {20, 0, 0, 0, 0, last};
    cntc_setwheelsetvelocity(&ire, &two, &six, values);
  }
  int solve() {
    int error = -1;
    cntc_calculate(&ire, &all, &error);
    return error;
  }
  std::vector<double> forces() {
    std::vector<double> out(24, 7.0);
    int count = 24;
    cntc_getglobalforces(&ire, &all, &count, out.data());
    return out;
  }
  double pitch_rate() {
    double values[6];
    int six = 6;
    cntc_getwheelsetvelocity(&ire, &six, values);
    return values[5];
  }
  std::vector<double> location() {
    std::vector<double> out(38, 7.0);
    int count = 38, first = 1;
    cntc_getcontactlocation(&ire, &first, &count, out.data());
    return out;
  }
};

constexpr double load = 6e4;

void expect_near(const std::vector<double> &found, const std::vector<double> &wanted,
                 double bound) {
  ASSERT_EQ(found.size(), wanted.size());
  for (size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], wanted[k], bound) << k;
}

// The force that was asked for is the one that is found, and the turning that is told with it gives
// the same forces when it is prescribed.
TEST_F(Wheels, AForceAlongTheTrackFindsTheTurning) {
  for (const double wanted : {0.0, 4e3, -9e3}) {
    wheel_on_rail wheel(1);
    wheel.flag(1974, 1);
    double force = wanted, none = 0;
    cntc_settangentialforces(&wheel.ire, &wheel.all, &force, &none);
    ASSERT_EQ(wheel.solve(), 0) << said();
    const auto found = wheel.forces();
    EXPECT_NEAR(found[0], wanted, 1e-6 * load);
    EXPECT_NEAR(found[2], load, 1e-6 * load);
    const double turns = wheel.pitch_rate();
    EXPECT_LT(turns, -40) << "it rolls forward";
    wheel_on_rail again(2);
    again.speed(turns);
    ASSERT_EQ(again.solve(), 0);
    expect_near(again.forces(), found, 1e-6 * load);
  }
}

// The force on the rail across the axle, times the radius that is met, is the torque asked for.
TEST_F(Wheels, ATorqueFindsTheTurning) {
  for (const double wanted : {0.0, 2e3, -3e3}) {
    wheel_on_rail wheel(1);
    wheel.flag(1974, 2);
    wheel.speed(wanted);
    ASSERT_EQ(wheel.solve(), 0) << said();
    const auto found = wheel.forces();
    const auto at = wheel.location();
    // across the axle, by the radius at which the rail is met: of the wheel 0.07 mm more
    const double along = std::cos(1e-3) * found[0] + std::sin(1e-3) * found[1];
    const double about_axle = along * (0.46 + at[11]);
    EXPECT_NEAR(about_axle, wanted, 2e-4 * std::fabs(wanted) + 1e-6 * load);
    wheel_on_rail again(2);
    again.speed(wheel.pitch_rate());
    ASSERT_EQ(again.solve(), 0);
    expect_near(again.forces(), found, 1e-6 * load);
  }
}

TEST_F(Wheels, ForcesNeedATangentialProblemAndAreLimitedByFriction) {
  for (const int f : {1, 2}) {
    wheel_on_rail wheel(f);
    wheel.flag(1974, f);
    wheel.flag(1972, 0);
    EXPECT_EQ(wheel.solve(), -99);
    EXPECT_NE(said().find("F = 1 and 2"), std::string::npos);
    wheel.flag(1972, 3);
    double force = 0.5 * load, none = 0;  // above mu Fz
    cntc_settangentialforces(&wheel.ire, &wheel.all, &force, &none);
    wheel.speed(0.5 * load);
    EXPECT_NE(wheel.solve(), 0) << "no slip carries it";
  }
}

// Placed where its gauge would place it the rail is the same; elsewhere the wheel follows.
TEST_F(Wheels, RailsArePlacedByTheirProfile) {
  wheel_on_rail by_gauge(1);
  ASSERT_EQ(by_gauge.solve(), 0);
  const auto wanted = by_gauge.forces(), at = by_gauge.location();
  wheel_on_rail placed(2);
  placed.track(0, at[25], at[26]);
  ASSERT_EQ(placed.solve(), 0) << said();
  expect_near(placed.forces(), wanted, 1e-9 * load);
  expect_near(placed.location(), at, 1e-9);
  placed.track(-1, at[25], at[26] + 2e-3);
  ASSERT_EQ(placed.solve(), 0);
  double low[6], high[6];
  int six = 6;
  cntc_getwheelsetposition(&placed.ire, &six, low);
  cntc_getwheelsetposition(&by_gauge.ire, &six, high);
  EXPECT_NEAR(low[2] - high[2], 2e-3, 1e-9);
  placed.flag(1967, 5);
  EXPECT_EQ(placed.solve(), -99);
  EXPECT_NE(said().find("GAUGHT <= 0"), std::string::npos);
}

// A rail that falls by 0.5 mm over a metre; a wheel that is the same all round.
TEST_F(Wheels, SlicesAreFollowed) {
  write("falls.slcs",
        "0. 1.\n3\n2\n1\n0. 'rail.txt'\n1000. 'rail_low.txt'\n2000. 'rail_low.txt'\n"
        "0. 20. 60.\n1000. 20. 60.\n2000. 20. 60.\n");
  write("round.slcw", "0 1.\n2\n1\n1\n0. 'wheel.txt'\n180d 'wheel.txt'\n");
  wheel_on_rail one(1);
  one.track(0, 0.76, 0);
  ASSERT_EQ(one.solve(), 0);
  double z0[6], z[6];
  int six = 6;
  cntc_getwheelsetposition(&one.ire, &six, z0);
  wheel_on_rail sliced(2, "falls.slcs", "round.slcw");
  sliced.track(0, 0.76, 0);
  for (const double x : {-1.0, 0.0, 0.5, 1.0, 2.5}) {
    sliced.place(x, 1.3 * x);
    ASSERT_EQ(sliced.solve(), 0) << said();
    cntc_getwheelsetposition(&sliced.ire, &six, z);
    // slopes of the parabola through three slices at the second one, none at the first
    const double t = std::fmin(std::fmax(x, 0.0), 1.0);
    const double slope = t * t * (t - 1) * 0.25 * 0.5e-3;
    const double first = t * (1 - t) * (1 - t) * 0.75 * 0.5e-3;
    double fallen = t * t * (3 - 2 * t) * 0.5e-3;
    // the right wheel of a yawed wheelset is 0.75 m times 1 mrad behind its middle, before the
    // second slice, where the rail falls by half of 0.5 mm a metre
    if (x == 1.0) fallen -= 0.75e-3 * 0.25e-3;
    if (x != 0.5) {
      EXPECT_NEAR(z[2] - z0[2], fallen, 1e-7) << x;
    } else {
      EXPECT_NEAR(z[2] - z0[2], fallen, std::fabs(slope) + first) << x;
    }
    auto at = sliced.forces(), wanted = one.forces();
    if (x != 0.5) expect_near(at, wanted, 2e-3 * load);
  }
  // a wheel by slices that are not there, then one that is
  sliced.profile(1, "none.slcw");
  EXPECT_EQ(sliced.solve(), -32);
  EXPECT_NE(said().find("none.slcw: file not found"), std::string::npos);
  sliced.profile(1, "wheel.txt");
  EXPECT_EQ(sliced.solve(), 0);
}

TEST_F(Wheels, TwoThreadsGiveWhatOneGives) {
  write("falls.slcs", "0. 1.\n2\n1\n1\n0. 'rail.txt'\n1000. 'rail_low.txt'\n");
  const auto run = [](int element, std::vector<double> &out) {
    wheel_on_rail wheel(element, "falls.slcs");
    wheel.track(0, 0.76, 0);
    wheel.flag(1974, element % 2 + 1);
    wheel.speed(0);
    for (int i = 0; i < 8; ++i) {
      wheel.place(0.1 * i, 0);
      if (wheel.solve() != 0) return;
      const auto f = wheel.forces(), at = wheel.location();
      out.insert(out.end(), f.begin(), f.end());
      out.insert(out.end(), at.begin(), at.end());
    }
  };
  std::vector<double> alone[2], both[2];
  run(1, alone[0]);
  run(2, alone[1]);
  std::thread a(run, 3, std::ref(both[0])), b(run, 4, std::ref(both[1]));
  a.join();
  b.join();
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(alone[k].size(), 8u * 62u);
    EXPECT_EQ(both[k], alone[k]);
  }
}

// Every file of points, slices or cases damaged by a byte ends with an answer; also of two threads
// that read the same ones.
TEST_F(Wheels, InputFilesOnTwoThreads) {
  write("case.inp",
        "1 1 MODULE\n1203100\n0022033\n0000211\n500 60 30 1 1e-9\n0.3 0.3\n0.28 0.28 82000. "
        "82000.\n1. 1. 1. 90d 8. 4.\n14. 0 1435. 0.\n'rail.txt' 0 1. 0. -1\n0 0 0 0 0 0\n1360. "
        "-70. 460.\n'wheel.txt' 0 1. 0. -1\n0 1. 60000. 0 1e-3 0\n20000. 0 0 0 0 -43.4\n0\n");
  wheel_on_rail by_calls(1);
  ASSERT_EQ(by_calls.solve(), 0);
  const auto wanted = by_calls.forces();
  const auto run = [&](int element, std::vector<double> &out) {
    for (int i = 0; i < 5; ++i) {
      int ire = element, type = 1988, length = 8, error = -1, all = -1, one = 1, code = 1933,
          si = 1936, count = 24;
      cntc_readinpfile(&ire, &type, "case.inp", &length, &error);
      EXPECT_EQ(error, 0);
      cntc_setflags(&ire, &all, &one, &code, &si);
      cntc_calculate(&ire, &all, &error);
      EXPECT_EQ(error, 0);
      out.assign(24, 0.0);
      cntc_getglobalforces(&ire, &all, &count, out.data());
    }
  };
  std::vector<double> first, second;
  std::thread a(run, 5, std::ref(first)), b(run, 6, std::ref(second));
  a.join();
  b.join();
  EXPECT_EQ(first, second);
  expect_near(first, wanted, 1e-7 * load);
}

template <class... Arguments>
void call_with_nothing(void (*function)(Arguments...)) {
  function(static_cast<Arguments>(nullptr)...);
}

struct missing_call {
  const char *name;
  void (*run)();
};

#define WITH_NOTHING(name) {#name, [] { call_with_nothing(&name); }}
const missing_call with_nothing[] = {
    WITH_NOTHING(cntc_initializefirst),
    WITH_NOTHING(cntc_initialize),
    WITH_NOTHING(cntc_setglobalflags),
    WITH_NOTHING(cntc_getmaxnumthreads),
    WITH_NOTHING(cntc_finalize),
    WITH_NOTHING(cntc_readinpfile),
    WITH_NOTHING(cntc_setflags),
    WITH_NOTHING(cntc_setmetadata),
    WITH_NOTHING(cntc_setsolverflags),
    WITH_NOTHING(cntc_setmaterialparameters),
    WITH_NOTHING(cntc_settemperaturedata),
    WITH_NOTHING(cntc_settimestep),
    WITH_NOTHING(cntc_setreferencevelocity),
    WITH_NOTHING(cntc_setrollingstepsize),
    WITH_NOTHING(cntc_setfrictionmethod),
    WITH_NOTHING(cntc_sethertzcontact),
    WITH_NOTHING(cntc_setpotcontact),
    WITH_NOTHING(cntc_setverticalforce),
    WITH_NOTHING(cntc_setpenetration),
    WITH_NOTHING(cntc_setnormalforce),
    WITH_NOTHING(cntc_setundeformeddistc),
    WITH_NOTHING(cntc_setcreepages),
    WITH_NOTHING(cntc_setextrarigidslip),
    WITH_NOTHING(cntc_settangentialforces),
    WITH_NOTHING(cntc_setprofileinputfname),
    WITH_NOTHING(cntc_setprofileinputvalues),
    WITH_NOTHING(cntc_settrackdimensions),
    WITH_NOTHING(cntc_setwheelsetdimensions),
    WITH_NOTHING(cntc_setwheelsetposition),
    WITH_NOTHING(cntc_setwheelsetvelocity),
    WITH_NOTHING(cntc_setwheelsetflexibility),
    WITH_NOTHING(subs_addblock),
    WITH_NOTHING(cntc_calculate),
    WITH_NOTHING(cntc_calculate1),
    WITH_NOTHING(cntc_calculate3),
    WITH_NOTHING(subs_calculate),
    WITH_NOTHING(cntc_getflags),
    WITH_NOTHING(cntc_getparameters),
    WITH_NOTHING(cntc_getprofilevalues),
    WITH_NOTHING(cntc_getwheelsetposition),
    WITH_NOTHING(cntc_getwheelsetvelocity),
    WITH_NOTHING(cntc_getnumcontactpatches),
    WITH_NOTHING(cntc_getcontactlocation),
    WITH_NOTHING(cntc_getglobalforces),
    WITH_NOTHING(cntc_getreferencevelocity),
    WITH_NOTHING(cntc_gethertzcontact),
    WITH_NOTHING(cntc_getnumelements),
    WITH_NOTHING(cntc_getgriddiscretization),
    WITH_NOTHING(cntc_getpotcontact),
    WITH_NOTHING(cntc_getpenetration),
    WITH_NOTHING(cntc_getcreepages),
    WITH_NOTHING(cntc_getcontactforces),
    WITH_NOTHING(cntc_getcontactpatchareas),
    WITH_NOTHING(cntc_getelementdivision),
    WITH_NOTHING(cntc_getmaximumpressure),
    WITH_NOTHING(cntc_getmaximumtraction),
    WITH_NOTHING(cntc_getmaximumtemperature),
    WITH_NOTHING(cntc_getfielddata),
    WITH_NOTHING(cntc_gettractions),
    WITH_NOTHING(cntc_getmicroslip),
    WITH_NOTHING(cntc_getdisplacements),
    WITH_NOTHING(cntc_getsensitivities),
    WITH_NOTHING(cntc_getcalculationtime),
    WITH_NOTHING(cntc_resetcalculationtime),
    WITH_NOTHING(subs_getblocksize),
    WITH_NOTHING(subs_getresults),
};
#undef WITH_NOTHING

TEST_F(Wheels, EveryCallSaysThatItsArgumentsAreMissing) {
  for (const missing_call &call : with_nothing) {
    call.run();
    EXPECT_NE(said().find(std::string(call.name) + ": an argument is missing"), std::string::npos)
        << call.name;
  }
  // twins, and what has no argument that is read
  call_with_nothing(&cntc_initializefirst_new);
  call_with_nothing(&cntc_getprofilevalues_new);
  call_with_nothing(&cntc_setfileunits);
  cntc_finalizelast();
  EXPECT_EQ(std::size(with_nothing) + 4, 70u);
}

}  // namespace
