// The calls of the add-on: error paths of each, refusals by name, sequences, threads.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "contact_addon.h"
#include "registry.hpp"

namespace {

// What is said during a test, in a file.
class Addon : public testing::Test {
 protected:
  void SetUp() override {
    cntc_finalizelast();
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::temp_directory_path() /
              ("contact_addon_" + std::to_string(getpid()) + test);
    std::filesystem::create_directories(folder_);
    start();
  }
  void TearDown() override {
    cntc_finalizelast();
    std::filesystem::remove_all(folder_);
  }
  void start() {
    int version = 0, error = -1, output = 0, length = static_cast<int>(folder_.string().size()),
        one = 1, four = 4;
    cntc_initializefirst(&version, &error, &output, folder_.c_str(), " ", "said", &length, &one,
                         &four);
    ASSERT_EQ(error, 0);
    ASSERT_EQ(version, 2520);
  }
  std::string said() const {
    std::ifstream file(folder_ / "said.out");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::filesystem::path folder_;
};

struct basic_contact {
  int ire, icp = 1;
  explicit basic_contact(int element) : ire(element) {
    flag(1933, 1935);
    int m = 0, four = 4, l = 0, two = 2, kind = 1, six = 6, base = 1;
    double steel[] = {.28, .28, 82e9, 82e9}, mu[] = {.3, .3},
           grid[] = {12, 12, -6e-3, -6e-3, 1e-3, 1e-3};
    double round[] = {1, 0, 1, 0, 0, 0}, force = 40000, speed = 10, chi = 0, dq = 1e-3;
    cntc_setmaterialparameters(&ire, &icp, &m, &four, steel);
    cntc_setfrictionmethod(&ire, &icp, &l, &two, mu);
    cntc_setpotcontact(&ire, &icp, &kind, &six, grid);
    cntc_setundeformeddistc(&ire, &icp, &base, &six, round);
    cntc_setnormalforce(&ire, &icp, &force);
    cntc_setreferencevelocity(&ire, &icp, &speed);
    cntc_setrollingstepsize(&ire, &icp, &chi, &dq);
    creep(1e-3);
  }
  void flag(int code, int value) {
    int one = 1;
    cntc_setflags(&ire, &icp, &one, &code, &value);
  }
  void creep(double vx, double vy = 0, double phi = 0) {
    cntc_setcreepages(&ire, &icp, &vx, &vy, &phi);
  }
  int solve() {
    int error = -1;
    cntc_calculate(&ire, &icp, &error);
    return error;
  }
  std::vector<double> forces() {
    std::vector<double> f(4, 7.0);
    cntc_getcontactforces(&ire, &icp, &f[0], &f[1], &f[2], &f[3]);
    return f;
  }
};

// Every call that names a result element, with the numbers given.
struct named_call {
  const char *name;
  std::function<void(int *ire, int *icp)> run;
};

int zero = 0, one = 1, six = 6, untouched = 77, error_out;
double number = 1, out_a = 77, out_b = 77, out_c = 77, out_d = 77, list[64];
char text[] = "none.prr";

std::vector<named_call> all_calls() {
  const auto n = [] { return &one; };
  return {
      {"cntc_readinpfile",
       [](int *r, int *) { cntc_readinpfile(r, &one, text, &six, &error_out); }},
      {"cntc_setflags", [](int *r, int *c) { cntc_setflags(r, c, &one, &zero, &zero); }},
      {"cntc_setmetadata", [](int *r, int *c) { cntc_setmetadata(r, c, &one, &zero, &number); }},
      {"cntc_setsolverflags",
       [](int *r, int *c) { cntc_setsolverflags(r, c, &one, &zero, &zero, &zero, &number); }},
      {"cntc_setmaterialparameters",
       [](int *r, int *c) { cntc_setmaterialparameters(r, c, &zero, &one, list); }},
      {"cntc_settemperaturedata",
       [](int *r, int *c) { cntc_settemperaturedata(r, c, &zero, &one, list); }},
      {"cntc_settimestep", [](int *r, int *c) { cntc_settimestep(r, c, &number); }},
      {"cntc_setreferencevelocity",
       [](int *r, int *c) { cntc_setreferencevelocity(r, c, &number); }},
      {"cntc_setrollingstepsize",
       [](int *r, int *c) { cntc_setrollingstepsize(r, c, &number, &number); }},
      {"cntc_setfrictionmethod",
       [](int *r, int *c) { cntc_setfrictionmethod(r, c, &zero, &one, list); }},
      {"cntc_sethertzcontact",
       [](int *r, int *c) { cntc_sethertzcontact(r, c, &one, &one, list); }},
      {"cntc_setpotcontact", [](int *r, int *c) { cntc_setpotcontact(r, c, &one, &one, list); }},
      {"cntc_setverticalforce", [](int *r, int *) { cntc_setverticalforce(r, &number); }},
      {"cntc_setpenetration", [](int *r, int *c) { cntc_setpenetration(r, c, &number); }},
      {"cntc_setnormalforce", [](int *r, int *c) { cntc_setnormalforce(r, c, &number); }},
      {"cntc_setundeformeddistc",
       [](int *r, int *c) { cntc_setundeformeddistc(r, c, &zero, &one, list); }},
      {"cntc_setcreepages",
       [](int *r, int *c) { cntc_setcreepages(r, c, &number, &number, &number); }},
      {"cntc_setextrarigidslip",
       [](int *r, int *c) { cntc_setextrarigidslip(r, c, &one, list, list); }},
      {"cntc_settangentialforces",
       [](int *r, int *c) { cntc_settangentialforces(r, c, &number, &number); }},
      {"cntc_setprofileinputfname",
       [](int *r, int *) { cntc_setprofileinputfname(r, text, &six, &zero, &zero, &zero, list); }},
      {"cntc_setprofileinputvalues",
       [](int *r, int *) {
         cntc_setprofileinputvalues(r, &zero, list, &zero, &zero, &zero, list);
       }},
      {"cntc_settrackdimensions",
       [](int *r, int *) { cntc_settrackdimensions(r, &zero, &zero, list); }},
      {"cntc_setwheelsetdimensions",
       [](int *r, int *) { cntc_setwheelsetdimensions(r, &zero, &zero, list); }},
      {"cntc_setwheelsetposition",
       [](int *r, int *) { cntc_setwheelsetposition(r, &zero, &zero, list); }},
      {"cntc_setwheelsetvelocity",
       [](int *r, int *) { cntc_setwheelsetvelocity(r, &zero, &zero, list); }},
      {"cntc_setwheelsetflexibility",
       [](int *r, int *) { cntc_setwheelsetflexibility(r, &zero, &zero, list); }},
      {"subs_addblock",
       [](int *r, int *c) {
         subs_addblock(r, c, &zero, &zero, &zero, &zero, &zero, list, list, list);
       }},
      {"cntc_calculate", [](int *r, int *c) { cntc_calculate(r, c, &error_out); }},
      {"cntc_calculate1", [](int *r, int *) { cntc_calculate1(r, &error_out); }},
      {"cntc_calculate3", [](int *r, int *c) { cntc_calculate3(r, c, &error_out); }},
      {"subs_calculate", [](int *r, int *c) { subs_calculate(r, c, &error_out); }},
      {"cntc_getflags",
       [](int *r, int *c) {
         int code = 1972;
         cntc_getflags(r, c, &one, &code, &untouched);
       }},
      {"cntc_getparameters", [n](int *r, int *c) { cntc_getparameters(r, c, n(), n(), &out_a); }},
      {"cntc_getprofilevalues",
       [n](int *r, int *) {
         cntc_getprofilevalues(r, &zero, &zero, &zero, &zero, list, n(), &out_a);
       }},
      {"cntc_getwheelsetposition",
       [n](int *r, int *) { cntc_getwheelsetposition(r, n(), &out_a); }},
      {"cntc_getwheelsetvelocity",
       [n](int *r, int *) { cntc_getwheelsetvelocity(r, n(), &out_a); }},
      {"cntc_getnumcontactpatches",
       [](int *r, int *) { cntc_getnumcontactpatches(r, &untouched); }},
      {"cntc_getcontactlocation",
       [n](int *r, int *c) { cntc_getcontactlocation(r, c, n(), &out_a); }},
      {"cntc_getglobalforces", [n](int *r, int *c) { cntc_getglobalforces(r, c, n(), &out_a); }},
      {"cntc_getreferencevelocity",
       [](int *r, int *c) { cntc_getreferencevelocity(r, c, &out_a); }},
      {"cntc_gethertzcontact", [n](int *r, int *c) { cntc_gethertzcontact(r, c, n(), &out_a); }},
      {"cntc_getnumelements",
       [](int *r, int *c) { cntc_getnumelements(r, c, &untouched, &untouched); }},
      {"cntc_getgriddiscretization",
       [](int *r, int *c) { cntc_getgriddiscretization(r, c, &out_a, &out_b); }},
      {"cntc_getpotcontact", [n](int *r, int *c) { cntc_getpotcontact(r, c, n(), &out_a); }},
      {"cntc_getpenetration", [](int *r, int *c) { cntc_getpenetration(r, c, &out_a); }},
      {"cntc_getcreepages",
       [](int *r, int *c) { cntc_getcreepages(r, c, &out_a, &out_b, &out_c); }},
      {"cntc_getcontactforces",
       [](int *r, int *c) { cntc_getcontactforces(r, c, &out_a, &out_b, &out_c, &out_d); }},
      {"cntc_getcontactpatchareas",
       [](int *r, int *c) { cntc_getcontactpatchareas(r, c, &out_a, &out_b, &out_c); }},
      {"cntc_getelementdivision",
       [n](int *r, int *c) { cntc_getelementdivision(r, c, n(), &untouched); }},
      {"cntc_getmaximumpressure", [](int *r, int *c) { cntc_getmaximumpressure(r, c, &out_a); }},
      {"cntc_getmaximumtraction", [](int *r, int *c) { cntc_getmaximumtraction(r, c, &out_a); }},
      {"cntc_getmaximumtemperature",
       [](int *r, int *c) { cntc_getmaximumtemperature(r, c, &out_a, &out_b); }},
      {"cntc_getfielddata", [n](int *r, int *c) { cntc_getfielddata(r, c, n(), n(), &out_a); }},
      {"cntc_gettractions",
       [n](int *r, int *c) { cntc_gettractions(r, c, n(), &out_a, &out_b, &out_c); }},
      {"cntc_getmicroslip", [n](int *r, int *c) { cntc_getmicroslip(r, c, n(), &out_a, &out_b); }},
      {"cntc_getdisplacements",
       [n](int *r, int *c) { cntc_getdisplacements(r, c, n(), &out_a, &out_b, &out_c); }},
      {"cntc_getsensitivities",
       [n](int *r, int *c) { cntc_getsensitivities(r, c, n(), n(), &out_a); }},
      {"cntc_getcalculationtime",
       [](int *r, int *c) { cntc_getcalculationtime(r, c, &out_a, &out_b); }},
      {"cntc_resetcalculationtime", [](int *r, int *c) { cntc_resetcalculationtime(r, c); }},
      {"subs_getblocksize",
       [](int *r, int *c) { subs_getblocksize(r, c, &one, &untouched, &untouched, &untouched); }},
      {"subs_getresults",
       [n](int *r, int *c) { subs_getresults(r, c, n(), n(), n(), &one, &out_a); }},
  };
}

TEST_F(Addon, EveryCallNamesAnElementOutOfRangeAndTouchesNoOutput) {
  for (const named_call &call : all_calls())
    for (int ire : {0, 1000, -3}) {
      int icp = 1;
      error_out = 0;
      call.run(&ire, &icp);
      EXPECT_NE(said().find(std::string(call.name) + ": result element " + std::to_string(ire)),
                std::string::npos)
          << call.name;
      if (std::string(call.name).find("calculate") != std::string::npos && call.name[5] == 'c') {
        EXPECT_EQ(error_out, -101) << call.name;
      }
    }
  EXPECT_EQ(untouched, 77);
  for (const double value : {out_a, out_b, out_c, out_d}) EXPECT_EQ(value, 77);
}

TEST_F(Addon, PatchesAndModulesThatDoNotFitAreSaid) {
  int wheels = 1, basic = 2, module = 1, version, error, length = 1, all = -1, patch = 1, ten = 10;
  cntc_initialize(&wheels, &module, &version, &error, " ", &length);
  module = 3;
  cntc_initialize(&basic, &module, &version, &error, " ", &length);
  cntc_calculate(&basic, &all, &error);
  EXPECT_EQ(error, -105);
  cntc_calculate(&wheels, &patch, &error);
  EXPECT_EQ(error, -106);
  cntc_calculate(&basic, &ten, &error);
  EXPECT_EQ(error, -104);
  cntc_calculate1(&basic, &error);
  EXPECT_EQ(error, -103);
  cntc_calculate3(&wheels, &patch, &error);
  EXPECT_EQ(error, -102);
  subs_calculate(&basic, &patch, &error);
  EXPECT_EQ(error, -31);
  module = 2;
  int other = 5;
  cntc_initialize(&other, &module, &version, &error, " ", &length);
  EXPECT_EQ(error, -99);
  cntc_calculate(&wheels, &all, &error);
  EXPECT_EQ(error, -32) << "no profiles";
  EXPECT_EQ(said().find("profile") == std::string::npos, false);
}

TEST_F(Addon, NullPointersAreSaid) {
  cntc_calculate(nullptr, nullptr, nullptr);
  cntc_setflags(nullptr, &one, &one, &one, &one);
  cntc_getcontactforces(&one, &one, nullptr, &out_a, &out_a, &out_a);
  EXPECT_NE(said().find("cntc_calculate: an argument is missing"), std::string::npos);
}

// What has no counterpart here: a change of a good case, the error, and what is named.
struct refused {
  std::function<void(basic_contact &)> change;
  int error;
  const char *named;
};

TEST_F(Addon, WhatHasNoCounterpartIsRefusedByName) {
  const auto flag = [](int code, int value) {
    return [=](basic_contact &c) { c.flag(code, value); };
  };
  const auto material = [](int m, std::vector<double> v) {
    return [=](basic_contact &c) mutable {
      int kind = m, count = static_cast<int>(v.size());
      cntc_setmaterialparameters(&c.ire, &c.icp, &kind, &count, v.data());
    };
  };
  const auto friction = [](int method, std::vector<double> v) {
    return [=](basic_contact &c) mutable {
      int kind = method, count = static_cast<int>(v.size());
      cntc_setfrictionmethod(&c.ire, &c.icp, &kind, &count, v.data());
    };
  };
  const refused cases[] = {
      {flag(1971, 1), -99, "B = 1"},
      {flag(1971, 4), -99, "B = 4"},
      {flag(1971, 2), -99, "need an ellipse"},
      {flag(1970, 1), -99, "P = 1"},
      {flag(1980, 2), -99, "E3"},
      {flag(1974, 3), -99, "F = 3"},
      {[&](basic_contact &c) {
         material(1, {.28, .28, 1e9, 1e9, 1, 1, 1e-3, 1e-3})(c);
         c.flag(1972, 2);
       },
       -99, "M = 1, viscoelastic bodies, is for steady rolling"},
      {material(1, {.28, .28, 1e9, 1e9, 1, 0, 1e-3, 1e-3}), -99, "viscoelastic_ratio"},
      {material(2, {.28, .28, 1, 1, 1, 1, 1, 1}), -99, "M = 2"},
      {material(5, {.28, .28, 1e9, 1e9, 2, 1, 1}), -99, "K0 and ALFA"},
      {material(12, {1, 1, 1, 1}), -99, "M2 = 2"},
      {friction(3, {.3, .1, .1, .1, .1, 1e-3, .1}), -33, "L = 3 with F2"},
      {friction(6, {.3, 0, -.1, 400, 0, 0}), -33, "H = 3"},
      {[](basic_contact &c) {
         double chi = 0.5, dq = 1e-3;
         cntc_setrollingstepsize(&c.ire, &c.icp, &chi, &dq);
       },
       -99, "CHI"},
      {[](basic_contact &c) {
         int kind = 1, count = 6, m = 6, four = 4;
         double grid[] = {12, 1, -6e-3, -6e-3, 1e-3, 12e-3}, steel[] = {.28, .28, 82e9, 82e9};
         cntc_setpotcontact(&c.ire, &c.icp, &kind, &count, grid);
         cntc_setmaterialparameters(&c.ire, &c.icp, &m, &four, steel);
       },
       -99, "distance_shape, of undeformed_distance, must be at least 3"},
      {[](basic_contact &c) {
         int kind = -6, count = 6;
         double ellipse[] = {12, 12, 5e-3, 5e-3, 4e-3, 1.2};
         cntc_sethertzcontact(&c.ire, &c.icp, &kind, &count, ellipse);
       },
       -99, "IPOTCN = -6"},
      {[](basic_contact &c) {
         int h = 3, count = 9;
         double heat[] = {20, 450, 50, 7850, 20, 450, 50, 7850, 1};
         cntc_settemperaturedata(&c.ire, &c.icp, &h, &count, heat);
         c.flag(1972, 2);
       },
       -99, "H = 3"},
  };
  int element = 10;
  for (const refused &it : cases) {
    basic_contact good(++element);
    ASSERT_EQ(good.solve(), 0) << it.named;
    it.change(good);
    EXPECT_EQ(good.solve(), it.error) << it.named;
    EXPECT_NE(said().find(it.named), std::string::npos) << it.named;
    std::vector<double> before(4, 7.0);
    EXPECT_EQ(good.forces(), before) << it.named << ": no old result is handed out";
  }
}

// One row and one column, long enough for their contact: solved, with the load asked for.
TEST_F(Addon, GridsOfOneRowAndOneColumn) {
  for (int along = 0; along < 2; ++along) {
    basic_contact contact(1 + along);
    int kind = 1, count = 6;
    double row[] = {12, 1, -6e-3, -6e-3, 1e-3, 12e-3},
           column[] = {1, 12, -6e-3, -6e-3, 12e-3, 1e-3};
    cntc_setpotcontact(&contact.ire, &contact.icp, &kind, &count, along ? column : row);
    EXPECT_EQ(contact.solve(), 0) << said();
    int mx = 0, my = 0;
    cntc_getnumelements(&contact.ire, &contact.icp, &mx, &my);
    EXPECT_EQ(mx, along ? 1 : 12);
    EXPECT_EQ(my, along ? 12 : 1);
    int n = 12;
    double pn[12], px[12], py[12], sum[2] = {};
    cntc_gettractions(&contact.ire, &contact.icp, &n, pn, px, py);
    for (int i = 0; i < 12; ++i) sum[0] += pn[i] * 12e-6, sum[1] += px[i] * 12e-6;
    const std::vector<double> forces = contact.forces();
    EXPECT_NEAR(sum[0], 40000, 1e-2);
    EXPECT_NEAR(forces[0], 40000, 1e-2);
    EXPECT_NEAR(sum[1], forces[1], 1e-6 * 40000);
    EXPECT_GT(std::fabs(forces[1]), 100);
    EXPECT_EQ(pn[0], 0);
    EXPECT_EQ(pn[11], 0);
  }
}

TEST_F(Addon, WrongCountsChangeNothing) {
  basic_contact contact(1);
  ASSERT_EQ(contact.solve(), 0);
  const auto before = contact.forces();
  int m = 0, three = 3;
  double other[] = {.3, .3, 1e9};
  cntc_setmaterialparameters(&contact.ire, &contact.icp, &m, &three, other);
  double nan = NAN;
  cntc_setnormalforce(&contact.ire, &contact.icp, &nan);
  EXPECT_EQ(contact.solve(), 0);
  EXPECT_EQ(contact.forces(), before);
  EXPECT_NE(said().find("has 3 values, needs 4"), std::string::npos);
}

// Cattaneo's shift in two steps, the second of them twice: P = 3 takes the first one's tractions.
TEST_F(Addon, AStepCanBeRepeated) {
  basic_contact contact(1);
  contact.flag(1972, 1);
  contact.creep(2e-6);
  ASSERT_EQ(contact.solve(), 0);
  contact.flag(1970, 0);
  ASSERT_EQ(contact.solve(), 0);
  const auto second = contact.forces();
  contact.flag(1970, 3);
  ASSERT_EQ(contact.solve(), 0);
  EXPECT_EQ(contact.forces(), second);
  contact.flag(1970, 0);
  ASSERT_EQ(contact.solve(), 0);
  EXPECT_GT(std::fabs(contact.forces()[1]), std::fabs(second[1]));
  int m = 0, four = 4;
  double softer[] = {.28, .28, 8e9, 8e9};
  cntc_setmaterialparameters(&contact.ire, &contact.icp, &m, &four, softer);
  EXPECT_EQ(contact.solve(), -34) << "what is set within a sequence would lose its tractions";
}

// A shift, then rolling over an element at a time, then steady rolling: a sequence, P = 0.
TEST_F(Addon, ARegimeMayChange) {
  basic_contact contact(1);
  contact.flag(1972, 1);
  contact.creep(4e-6);
  ASSERT_EQ(contact.solve(), 0);
  const double shifted = contact.forces()[1];
  contact.flag(1970, 0);
  contact.flag(1972, 2);
  contact.creep(1e-4);
  ASSERT_EQ(contact.solve(), 0);
  const double first = contact.forces()[1];
  EXPECT_GT(std::fabs(first), 0.5 * std::fabs(shifted)) << "the shift's tractions roll along";
  double rolled = first;
  for (int k = 0; k < 60; ++k) {
    ASSERT_EQ(contact.solve(), 0);
    rolled = contact.forces()[1];
  }
  contact.flag(1972, 3);
  ASSERT_EQ(contact.solve(), 0);
  const double steady = contact.forces()[1];
  EXPECT_NEAR(rolled, steady, 5e-3 * std::fabs(steady)) << "of the shift nothing is left";
  // from the steady state, once in a history and once by a case of its own
  contact.flag(1972, 2);
  ASSERT_EQ(contact.solve(), 0);
  const double on = contact.forces()[1];
  EXPECT_NEAR(on, steady, 5e-3 * std::fabs(steady));
  contact.flag(1972, 3);
  contact.flag(1970, 2);
  ASSERT_EQ(contact.solve(), 0);
  EXPECT_NEAR(contact.forces()[1], steady, 1e-4 * std::fabs(steady));
  contact.flag(1972, 2);
  contact.flag(1970, 0);
  ASSERT_EQ(contact.solve(), 0);
  EXPECT_NEAR(contact.forces()[1], on, 1e-4 * std::fabs(on));
  // without tractions there is nothing to lose
  contact.flag(1972, 0);
  EXPECT_EQ(contact.solve(), 0);
}

// Of the same slip everywhere: that of a creepage, body 1 minus body 2, in steady rolling, a shift
// (lengths) and after another; gone with E = 0.
TEST_F(Addon, ExtraRigidSlipIsAddedToCreepages) {
  basic_contact contact(1);
  int count = 144;
  std::vector<double> along(144, 7e-4), across(144, -2e-4);
  const auto near = [&](const std::vector<double> &wanted) {
    const auto found = contact.forces();
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], wanted[k], 1e-4 * 12000) << k;
  };
  for (const int regime : {3, 1}) {
    contact.flag(1972, regime);
    const double unit = regime == 1 ? 1e-3 : 1.0;
    contact.creep(1e-3 * unit, -2e-4 * unit);
    ASSERT_EQ(contact.solve(), 0);
    const auto wanted = contact.forces();
    contact.creep(3e-4 * unit);
    ASSERT_EQ(contact.solve(), 0);
    const auto without = contact.forces();
    for (double &w : along) w = 7e-4 * unit;
    for (double &w : across) w = -2e-4 * unit;
    cntc_setextrarigidslip(&contact.ire, &contact.icp, &count, along.data(), across.data());
    ASSERT_EQ(contact.solve(), 0);
    near(wanted);
    int field = 22;
    std::vector<double> w(144, 7.0);
    cntc_getfielddata(&contact.ire, &contact.icp, &field, &count, w.data());
    EXPECT_NEAR(std::fabs(w[70]), 1e-3 * unit, 1e-12);
    contact.flag(1980, 0);
    ASSERT_EQ(contact.solve(), 0);
    near(without);
  }
}

// M = 1: of no second springs as M = 0, of springs that yield at once as bodies of G/(1 + FG).
TEST_F(Addon, ViscoelasticBodies) {
  const auto forces_of = [](int m, double shear, double ratio, double time) {
    static int element = 1;
    basic_contact contact(element++);
    int count = m == 1 ? 8 : 4;
    double values[] = {.28, .28, shear, shear, ratio, ratio, time, time};
    cntc_setmaterialparameters(&contact.ire, &contact.icp, &m, &count, values);
    EXPECT_EQ(contact.solve(), 0);
    return contact.forces();
  };
  const auto hard = forces_of(0, 320e9, 0, 0), none = forces_of(1, 320e9, 0, 0.5);
  for (size_t k = 0; k < 4; ++k) EXPECT_EQ(hard[k], none[k]);
  const auto soft = forces_of(0, 160e9, 0, 0), slow = forces_of(1, 320e9, 1, 1e-12);
  // of the order of V VT/DX, and EPS
  for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(soft[k], slow[k], 1e-4 * 12000) << k;
  const auto between = forces_of(1, 320e9, 1, 5e-4);
  EXPECT_GT(std::fabs(between[1] - soft[1]), 10);
  EXPECT_GT(std::fabs(between[1] - hard[1]), 10);
}

TEST_F(Addon, UnitsAndSigns) {
  basic_contact contact(1);
  contact.creep(1e-3, 2e-4, 0.1);
  ASSERT_EQ(contact.solve(), 0);
  const auto wheel = contact.forces();
  contact.flag(1933, 1936);
  const auto rail = contact.forces();
  contact.flag(1933, 1934);
  const auto mm = contact.forces();
  for (size_t k = 1; k < 4; ++k) EXPECT_EQ(wheel[k], -rail[k]);
  EXPECT_EQ(wheel[0], mm[0]);
  EXPECT_EQ(rail[1], mm[1]);
  EXPECT_NEAR(mm[3], 1e3 * rail[3], 1e-9 * std::fabs(mm[3]));
  double vx, vy, phi;
  cntc_getcreepages(&contact.ire, &contact.icp, &vx, &vy, &phi);
  EXPECT_NEAR(vx, 1e-3, 1e-15);
  EXPECT_NEAR(vy, 2e-4, 1e-15);
  EXPECT_NEAR(phi, 0.1e-3, 1e-15);
}

// Displacements at the surface close the gap: h - approach + un = 0 under pressure.
TEST_F(Addon, DisplacementsCloseTheGap) {
  basic_contact contact(1);
  ASSERT_EQ(contact.solve(), 0);
  int n = 144, field = 1;
  std::vector<double> un(144), ux(144), uy(144), h(144), pn(144), px(144), py(144);
  double pen;
  cntc_getdisplacements(&contact.ire, &contact.icp, &n, un.data(), ux.data(), uy.data());
  cntc_getfielddata(&contact.ire, &contact.icp, &field, &n, h.data());
  cntc_gettractions(&contact.ire, &contact.icp, &n, pn.data(), px.data(), py.data());
  cntc_getpenetration(&contact.ire, &contact.icp, &pen);
  int touching = 0;
  for (size_t i = 0; i < 144; ++i)
    if (pn[i] > 0) {
      ++touching;
      EXPECT_NEAR(h[i] - pen + un[i], 0, 2e-4 * pen);
    }
  EXPECT_GT(touching, 20);
}

// By central differences of the calls themselves.
TEST_F(Addon, SensitivitiesAreThoseOfTheForces) {
  basic_contact contact(1);
  int two = 2, g = 0, four = 4, n_one = 1, ints[] = {999, 100, 30, 1};
  double eps[] = {1e-11};
  cntc_setsolverflags(&contact.ire, &contact.icp, &g, &four, ints, &n_one, eps);
  contact.flag(1933, 1936);
  contact.flag(1988, 3);
  contact.creep(3e-4, 1e-4, 0.02);
  ASSERT_EQ(contact.solve(), 0);
  double s[8];
  cntc_getsensitivities(&contact.ire, &contact.icp, &four, &two, s);
  const auto base = contact.forces();
  double change[2][4];
  for (int k = 0; k < 2; ++k) {
    contact.creep(3e-4 + (k ? -1e-7 : 1e-7), 1e-4, 0.02);
    ASSERT_EQ(contact.solve(), 0);
    const auto f = contact.forces();
    for (size_t i = 0; i < 4; ++i) change[k][i] = f[i];
  }
  const double fx = (change[0][1] - change[1][1]) / 2e-7 / (0.3 * base[0]);
  EXPECT_NEAR(s[4 + 1], fx, 2e-3 * std::fabs(fx));
  EXPECT_NEAR(s[0 + 0] > 0, true, 0);
}

TEST_F(Addon, TwoThreadsGiveWhatOneGives) {
  const auto run = [](int element, std::vector<double> &out) {
    basic_contact contact(element);
    for (int i = 0; i < 40; ++i) {
      contact.creep(1e-4 * (i + 1), 5e-5 * i, 1e-2 * i);
      if (contact.solve() != 0) return;
      const auto f = contact.forces();
      out.insert(out.end(), f.begin(), f.end());
    }
  };
  std::vector<double> alone, first, second;
  run(1, alone);
  ASSERT_EQ(alone.size(), 160u);
  std::thread a(run, 2, std::ref(first)), b(run, 3, std::ref(second));
  a.join();
  b.join();
  EXPECT_EQ(first, alone);
  EXPECT_EQ(second, alone);
}

TEST_F(Addon, AContactInUseIsLocked) {
  basic_contact contact(1);
  contact_addon::with_problem("test", 1, 1, contact_addon::modules::basic,
                              contact_addon::patches::settings, true,
                              [&](contact_addon::problem &) {
                                int answer = 0;
                                std::thread([&] { answer = contact.solve(); }).join();
                                EXPECT_EQ(answer, 305);
                                return 0;
                              });
}

TEST_F(Addon, NothingIsWrittenUnlessAFileIsNamed) {
  cntc_finalizelast();
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  int version, error, output = 0, none = 0;
  cntc_initializefirst(&version, &error, &output, "", "", "", &none, &none, &none);
  basic_contact contact(1);
  EXPECT_EQ(contact.solve(), 0);
  contact.flag(1971, 1);
  EXPECT_EQ(contact.solve(), -99);
  std::filesystem::current_path(before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 0);
}

// Settings by chance, good and bad ones, a case and all its results: no crash, no sanitizer's word,
// and every case answered.
TEST_F(Addon, AnySettingsEndWithAnAnswer) {
  std::mt19937 random(20);
  const auto whole = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  const auto real = [&] {
    constexpr double odd[] = {0, 1, -1, 1e-3, 82e9, 1e30, -1e30, NAN, INFINITY, 1e-300, 24, 0.3};
    return odd[whole(0, 11)];
  };
  const int codes[] = {1933, 1967, 1970, 1971, 1972, 1973, 1974, 1977, 1978, 1980, 1983, 1988};
  int answered = 0, good = 0;
  for (int trial = 0; trial < 150; ++trial) {
    basic_contact contact(100 + trial % 20);
    for (int k = whole(0, 4); k > 0; --k) {
      int method = whole(-7, 12), count = whole(0, 9);
      double values[16];
      for (double &value : values) value = whole(0, 2) > 0 ? real() : whole(1, 30);
      switch (whole(0, 8)) {
        case 0:
          contact.flag(codes[whole(0, 11)], whole(-1, 6));
          break;
        case 1:
          cntc_setmaterialparameters(&contact.ire, &contact.icp, &method, &count, values);
          break;
        case 2:
          cntc_setfrictionmethod(&contact.ire, &contact.icp, &method, &count, values);
          break;
        case 3:
          count = 5;
          cntc_sethertzcontact(&contact.ire, &contact.icp, &method, &count, values);
          break;
        case 4:
          count = 6;
          cntc_setpotcontact(&contact.ire, &contact.icp, &method, &count, values);
          break;
        case 5:
          cntc_setundeformeddistc(&contact.ire, &contact.icp, &method, &count, values);
          break;
        case 6:
          contact.creep(values[0], values[1], values[2]);
          break;
        case 7:
          cntc_settemperaturedata(&contact.ire, &contact.icp, &method, &count, values);
          break;
        default:
          cntc_setpenetration(&contact.ire, &contact.icp, values);
      }
    }
    const int error = contact.solve();
    answered += error != -1 ? 1 : 0;
    good += error == 0 ? 1 : 0;
    int n = 150, field = whole(0, 25), block = 1, kind = whole(0, 10), nx = whole(0, 3), ny = 1,
        nz = 2;
    std::vector<double> a(150), b(150), c(150);
    std::vector<int> elements(150);
    cntc_getfielddata(&contact.ire, &contact.icp, &field, &n, a.data());
    cntc_gettractions(&contact.ire, &contact.icp, &n, a.data(), b.data(), c.data());
    cntc_getelementdivision(&contact.ire, &contact.icp, &n, elements.data());
    double places[3] = {real(), 2, 3};
    subs_addblock(&contact.ire, &contact.icp, &block, &kind, &nx, &ny, &nz, places, places, places);
    int answer;
    subs_calculate(&contact.ire, &contact.icp, &answer);
    cntc_finalize(&contact.ire);
    start();
  }
  EXPECT_EQ(answered, 150);
  EXPECT_GT(good, 15);
}

}  // namespace
