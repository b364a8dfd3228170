// What configs and inputs may be: for each rule a case just inside, and one just outside that is
// told in the rule's own words.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <numeric>

#include "handle/check.hpp"
#include "scenes.hpp"
#include "tables.hpp"

namespace {

using namespace railpatch;
using change = std::function<void(rp_config &)>;

std::string said_of(const rp_config &c) {
  rp_message message{};
  const rp_error error = check_config(c, &message);
  EXPECT_EQ(error != RP_OK, message.text[0] != '\0');
  EXPECT_EQ(check_config(c, nullptr), error);
  return message.text;
}

class Checks : public testing::Test {
 protected:
  void accepts(const change &spoil = [](rp_config &) {}) const {
    rp_config c = base;
    spoil(c);
    EXPECT_EQ(said_of(c), "");
  }
  void refuses(const char *words, const change &spoil) const {
    rp_config c = base;
    spoil(c);
    const std::string said = said_of(c);
    EXPECT_NE(said.find(words), std::string::npos) << "'" << said << "' and not '" << words << "'";
  }
  // A number's range; an open end is refused itself.
  void ranges(const char *name, const std::function<double &(rp_config &)> &at, double low,
              double high, bool open_low = false) const {
    const auto with = [&](double v) { return [&at, v](rp_config &c) { at(c) = v; }; };
    const double inf = std::numeric_limits<double>::infinity();
    if (open_low) {
      refuses(name, with(low));
      accepts(with(std::nextafter(low, inf)));
    } else {
      accepts(with(low));
      refuses(name, with(std::nextafter(low, -inf)));
    }
    accepts(with(high));
    refuses(name, with(std::nextafter(high, inf)));
    refuses(name, with(std::nan("")));
  }

  rp_config base = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  const scenes::profile_pair pair;
};

TEST_F(Checks, NumbersHaveTheirRanges) {
#define RP_AT(name) [](rp_config &c) -> double & { return c.name; }
  ranges(
      "shear_modulus[0]",
      [](rp_config &c) -> double & {
        c.shear_modulus[1] = c.shear_modulus[0];
        return c.shear_modulus[0];
      },
      1, 1e15);
  base.regime = RP_REGIME_NONE;
  ranges("poisson_ratio[1] is", RP_AT(poisson_ratio[1]), 0, 0.5);
  ranges("semi_axes[1] is", RP_AT(semi_axes[1]), 1e-7, 1);
  ranges("friction_coefficient is", RP_AT(friction_coefficient), 0, 10);
  ranges("tolerance is", RP_AT(tolerance), 1e-12, 0.1);
  ranges("temperature_depth is", RP_AT(temperature_depth), 0, 1);
  ranges("plastic_heat_fraction is", RP_AT(plastic_heat_fraction), 0, 1);
  ranges("density[0] is", RP_AT(density[0]), 1e-3, 1e6);
  ranges("percent_kalker is", RP_AT(percent_kalker), 0, 200, true);
  ranges("friction_reference + friction_change is", RP_AT(friction_change), -0.3, 9.7);
  base.layer_shear_modulus = 8e9;
  ranges("layer_thickness is", RP_AT(layer_thickness), 0, 0.1);
  base.layer_thickness = 1e-5;
  ranges("layer_shear_modulus is", RP_AT(layer_shear_modulus), 1, 1e15);
  base.geometry = RP_CURVATURES;
  ranges("curvatures[0] is", RP_AT(curvatures[0]), 1e-9, 1e6);
  base.elements[0] = base.elements[1] = 0;
  base.element_size[0] = base.element_size[1] = 1e-3;
  ranges("element_size[1] is", RP_AT(element_size[1]), 1e-9, 1);
  refuses("shear_modulus[1] is 0, allowed is [1, 1e+15]",
          [](rp_config &c) { c.shear_modulus[1] = 0; });
  refuses("polach_k_a is 0, allowed is (0, 10]", [](rp_config &c) { c.polach_k_a = 0; });
  refuses("elements[0]", [](rp_config &c) {
    c.element_size[0] = c.element_size[1] = 0;
    c.elements[0] = 1;
    c.elements[1] = 2;
  });
  // a layer's modulus counts with a layer only
  accepts([](rp_config &c) { c.layer_thickness = 0, c.layer_shear_modulus = 0; });
}

// What one kind of case does not read is a word of its choice all the same.
TEST_F(Checks, ChoicesAreWordsInEveryCase) {
  const int none = 99;
  for (const bool on_wheels : {false, true}) {
    if (on_wheels) base = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
    refuses("geometry is 99", [&](rp_config &c) { std::memcpy(&c.geometry, &none, sizeof none); });
    refuses("track is 99", [&](rp_config &c) { std::memcpy(&c.track, &none, sizeof none); });
    refuses("slip_law is 99", [&](rp_config &c) { std::memcpy(&c.slip_law, &none, sizeof none); });
  }
}

TEST_F(Checks, IntegersHaveTheirRanges) {
  struct {
    const char *said;
    std::function<int32_t &(rp_config &)> at;
    int low, high;
  } const all[] = {
      {"elements[0] is %d, allowed is 2 ... 1000",
       [](rp_config &c) -> int32_t & { return c.elements[0]; }, 2, 1000},
      {"elements[1] is %d, allowed is 2 ... 1000",
       [](rp_config &c) -> int32_t & { return c.elements[1]; }, 2, 1000},
      {"max_iterations is %d, allowed is 1 ... 100000",
       [](rp_config &c) -> int32_t & { return c.max_iterations; }, 1, 100000},
      {"force_prescribed[1] is %d, allowed is 0 ... 1",
       [](rp_config &c) -> int32_t & { return c.force_prescribed[1]; }, 0, 1},
      {"derivatives is %d, allowed is 0 ... 1",
       [](rp_config &c) -> int32_t & { return c.derivatives; }, 0, 1},
      {"temperature is %d, allowed is 0 ... 1",
       [](rp_config &c) -> int32_t & { return c.temperature; }, 0, 1},
  };
  for (const auto &f : all) {
    for (const int good : {f.low, f.high}) accepts([&](rp_config &c) { f.at(c) = good; });
    for (const int bad : {f.low - 1, f.high + 1}) {
      char words[80];
      std::snprintf(words, sizeof words, f.said, bad);
      refuses(words, [&](rp_config &c) { f.at(c) = bad; });
    }
  }
}

TEST_F(Checks, GridsAreCountedOrSized) {
  const char *one = "exactly one of elements and element_size must be given";
  refuses(one, [](rp_config &c) { c.element_size[1] = 1e-3; });
  refuses(one, [](rp_config &c) { c.element_size[0] = 1e-3; });
  refuses(one, [](rp_config &c) { c.elements[0] = c.elements[1] = 0; });
  refuses("elements[0] is 0", [](rp_config &c) { c.elements[0] = 0; });
  refuses("elements[1] is 0", [](rp_config &c) { c.elements[1] = 0; });
  for (int k = 0; k < 2; ++k) {
    refuses("max_elements must be 0 with elements", [&](rp_config &c) { c.max_elements[k] = 20; });
    const auto capacity = [&](int most) {
      return [=](rp_config &c) {
        for (int i = 0; i < 2; ++i) c.elements[i] = 0, c.element_size[i] = 1e-3;
        c.max_elements[k] = most;
      };
    };
    for (const int good : {0, 1002}) accepts(capacity(good));
    char words[80];
    for (const int bad : {-1, 1003}) {
      std::snprintf(words, sizeof words, "max_elements[%d] is %d, allowed is 0 ... 1002", k, bad);
      refuses(words, capacity(bad));
    }
  }
  // closed forms have none, and say nothing of it
  base.elements[0] = base.elements[1] = 0;
  base.normal = RP_NORMAL_HERTZ;
  accepts([](rp_config &c) { c.tangential = RP_TANGENTIAL_POLACH; });
  accepts([](rp_config &c) { c.fitted[0] = c.fitted[1] = 8; });
  refuses(one, [](rp_config &c) { c.tangential = RP_TANGENTIAL_FASTSIM; });
  refuses(one, [](rp_config &) {});
  refuses(one, [](rp_config &c) { c.regime = RP_REGIME_NONE; });
}

TEST_F(Checks, ParabolasOfRowsNeedThreeElements) {
  base.geometry = RP_CURVATURES;
  base.elements[0] = base.elements[1] = 0;
  base.element_size[0] = base.element_size[1] = 1e-3;
  for (const rp_normal_method method :
       {RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_KIK_PIOTROWSKI_CORRECTED, RP_NORMAL_ANALYN}) {
    base.normal = method;
    for (int k = 0; k < 2; ++k)
      for (const int few : {1, 2})
        refuses("max_elements must be 0 or at least 3", [&](rp_config &c) {
          c.max_elements[0] = c.max_elements[1] = 10;
          c.max_elements[k] = few;
        });
    accepts([](rp_config &c) { c.max_elements[0] = c.max_elements[1] = 3; });
  }
  base.normal = RP_NORMAL_HALF_SPACE;
  accepts([](rp_config &c) { c.max_elements[0] = 10, c.max_elements[1] = 2; });
}

TEST_F(Checks, FittedRowsHaveTheirs) {
  const auto rows = [](int nodes, int across) {
    return [=](rp_config &c) { c.fitted[0] = nodes, c.fitted[1] = across; };
  };
  accepts(rows(3, 3));
  accepts(rows(64, 36));
  accepts(rows(48, 48));
  refuses("fitted[0] * fitted[1] is 2368, allowed is 3 ... 2304", rows(64, 37));
  refuses("fitted[0] is 2, allowed is 3 ... 64", rows(2, 8));
  refuses("fitted[1] is 65, allowed is 3 ... 64", rows(8, 65));
  refuses("fitted[0] is 0", rows(0, 8));
  refuses("fitted[1] is 0", rows(8, 0));
  base.fitted[0] = base.fitted[1] = 8;
  accepts([](rp_config &c) { c.tangential = RP_TANGENTIAL_NONE; });
  refuses("fitted needs tangential = full",
          [](rp_config &c) { c.tangential = RP_TANGENTIAL_FASTSIM; });
  refuses("spin_offset must be automatic or none with fitted",
          [](rp_config &c) { c.spin_offset = RP_SPIN_OFFSET_SIXTH; });
  base.geometry = RP_LINE_CONTACT;
  base.elements[1] = 1;
  accepts([](rp_config &c) { c.fitted[1] = 1; });
  refuses("fitted[1] is 3, allowed is 1 ... 1", [](rp_config &c) { c.fitted[1] = 3; });
}

TEST_F(Checks, PointsOfTablesIncrease) {
  base.friction_points = 3;
  for (int i = 0; i < 3; ++i) base.friction_position[i] = i, base.friction_factor[i] = 1;
  accepts();
  accepts([](rp_config &c) { c.friction_points = 2; });
  accepts([](rp_config &c) {
    c.friction_points = RP_MAX_POINTS;
    for (int i = 0; i < RP_MAX_POINTS; ++i) c.friction_position[i] = i;
  });
  refuses("friction_points is 1", [](rp_config &c) { c.friction_points = 1; });
  refuses("friction_points is", [](rp_config &c) { c.friction_points = RP_MAX_POINTS + 1; });
  for (int i : {1, 2}) {
    const std::string at = std::to_string(i), below = std::to_string(i - 1);
    const std::string words = "friction_position[" + at + "] is " + below +
                              ", allowed is more than friction_position[" + below + "] = " + below;
    refuses(words.c_str(), [i](rp_config &c) { c.friction_position[i] = i - 1; });
  }
  accepts([](rp_config &c) { c.friction_position[2] = std::nextafter(1.0, 2.0); });
  accepts([](rp_config &c) { c.friction_factor[2] = 100; });
  refuses("friction_factor[2] is", [](rp_config &c) { c.friction_factor[2] = 100.1; });
  refuses("friction_factor[0] is", [](rp_config &c) { c.friction_factor[0] = -1e-9; });
  refuses("friction_position[0] is", [](rp_config &c) { c.friction_position[0] = -HUGE_VAL; });
  const char *words = "friction_points must be 0 but with tangential = full and no fitted rows";
  refuses(words, [](rp_config &c) { c.tangential = RP_TANGENTIAL_FASTSIM; });
  refuses(words, [](rp_config &c) { c.fitted[0] = c.fitted[1] = 8; });
  accepts([](rp_config &c) {
    c.regime = RP_REGIME_NONE;
    c.tangential = RP_TANGENTIAL_FASTSIM;
  });
}

TEST_F(Checks, FrictionLaws) {
  const auto remembers = [](double distance, double speed) {
    return [=](rp_config &c) {
      c.friction_memory_distance = distance;
      c.friction_memory_speed = speed;
    };
  };
  const auto law = [](rp_friction_law l) { return [l](rp_config &c) { c.friction_law = l; }; };
  accepts(law(RP_SLIP_VELOCITY));
  refuses("friction_memory_distance must be 0 with friction_law = coulomb", remembers(1e-3, 1e-3));
  base.friction_law = RP_SLIP_VELOCITY;
  accepts(remembers(1e-3, 0.02));
  refuses("friction_memory_speed must be 0.001 with friction_memory_distance = 0",
          remembers(0, 0.02));
  const char *grid =
      "friction_law must be coulomb but with tangential = full and no fitted rows, or "
      "slip_velocity "
      "with tangential = polach or fastsim or fastrip";
  refuses(grid, [](rp_config &c) { c.fitted[0] = c.fitted[1] = 8; });
  refuses(grid, [](rp_config &c) { c.tangential = RP_TANGENTIAL_LINEAR; });
  for (const auto theory : {RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_FASTRIP, RP_TANGENTIAL_POLACH}) {
    accepts([=](rp_config &c) { c.tangential = theory; });
    refuses("friction_memory_distance must be 0 with a fast theory", [=](rp_config &c) {
      c.tangential = theory;
      c.friction_memory_distance = 1e-6;
    });
    refuses(grid, [=](rp_config &c) {
      c.tangential = theory;
      c.friction_law = RP_TEMPERATURE;
      c.temperature = 1;
    });
  }
  const char *below = "friction_kinetic with negative friction_amplitude: the law falls below 0";
  const auto amplitudes = [](double a, double b) {
    return [=](rp_config &c) {
      c.friction_kinetic = 0.25;
      c.friction_amplitude[0] = a;
      c.friction_amplitude[1] = b;
    };
  };
  accepts(amplitudes(-0.25, 0));
  accepts(amplitudes(-0.125, -0.125));
  accepts(amplitudes(-0.25, 3));
  refuses(below, amplitudes(-0.2501, 3));
  refuses(below, amplitudes(-0.125, -0.126));
  base.regime = RP_SHIFT;
  refuses("friction_law must be coulomb with regime = shift", [](rp_config &) {});
  base = scenes::heated_patch(RP_STEADY_ROLLING);
  accepts();
  refuses("friction_memory_distance must be 0 with friction_law = temperature",
          [](rp_config &c) { c.friction_memory_distance = 1e-3; });
  refuses("friction_law = temperature needs temperature = 1",
          [](rp_config &c) { c.temperature = 0; });
  refuses("temperature needs tangential = full and no fitted rows", [](rp_config &c) {
    c.friction_law = RP_COULOMB;
    c.tangential = RP_TANGENTIAL_FASTSIM;
  });
  refuses("temperature needs regime = steady_rolling or transient_rolling", [](rp_config &c) {
    c.friction_law = RP_COULOMB;
    c.regime = RP_SHIFT;
  });
}

TEST_F(Checks, PlasticLayers) {
  base.layer_thickness = 1e-5;
  base.layer_shear_modulus = 8e9;
  base.layer_yield_stress = 2e8;
  accepts();
  const char *grid = "layer_yield_stress must be 0 but with tangential = full and no fitted rows";
  refuses(grid, [](rp_config &c) { c.fitted[0] = c.fitted[1] = 8; });
  refuses(grid, [](rp_config &c) { c.tangential = RP_TANGENTIAL_FASTSIM; });
  accepts([](rp_config &c) { c.tangential = RP_TANGENTIAL_NONE, c.fitted[0] = c.fitted[1] = 8; });
  base.hardening_points = 2;
  base.hardening_displacement[1] = 1e-5;
  base.hardening_stress[0] = 2e8;
  base.hardening_stress[1] = 3e8;
  accepts();
  refuses("hardening_displacement[0] is 1e-06, allowed is [0, 0]",
          [](rp_config &c) { c.hardening_displacement[0] = 1e-6; });
  refuses("layer_yield_stress must equal hardening_stress[0]",
          [](rp_config &c) { c.layer_yield_stress = 2.1e8; });
  refuses("hardening_stress[1] is", [](rp_config &c) { c.hardening_stress[1] = 0; });
}

TEST_F(Checks, Regimes) {
  for (const rp_regime regime : {RP_SHIFT, RP_TRANSIENT_ROLLING}) {
    base.regime = regime;
    accepts();
    const char *full = "regime = shift and transient_rolling need tangential = full and no fitted";
    refuses(full, [](rp_config &c) { c.tangential = RP_TANGENTIAL_FASTSIM; });
    refuses(full, [](rp_config &c) { c.fitted[0] = c.fitted[1] = 8; });
    accepts([](rp_config &c) { c.tangential = RP_TANGENTIAL_NONE; });
    for (const rp_spin_offset offset : {RP_SPIN_OFFSET_SIXTH, RP_SPIN_OFFSET_QUARTER}) {
      const auto shifted = [=](rp_config &c) { c.spin_offset = offset; };
      if (regime == RP_SHIFT)
        refuses("spin_offset must be automatic or none with regime = shift", shifted);
      else
        accepts(shifted);
    }
    const auto sized = [](double size, int most) {
      return [=](rp_config &c) {
        c.geometry = RP_CURVATURES;
        if (size > 0) c.elements[0] = c.elements[1] = 0;
        c.element_size[0] = c.element_size[1] = size;
        c.max_elements[0] = c.max_elements[1] = most;
      };
    };
    accepts(sized(1e-3, 20));
    const char *fixed = "with curvatures need element_size and max_elements: their grid is fixed";
    for (const auto &wrong : {sized(1e-3, 0), sized(0, 0)}) refuses(fixed, wrong);
    for (int k = 0; k < 2; ++k)
      refuses(fixed, [&, k](rp_config &c) {
        sized(1e-3, 20)(c);
        c.max_elements[k] = 0;
      });
  }
  base = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  base.regime = RP_TRANSIENT_ROLLING;
  accepts();
  refuses("needs element_size in place of elements", [](rp_config &c) {
    c.elements[0] = c.elements[1] = 20;
    c.element_size[0] = c.element_size[1] = 0;
  });
  accepts([](rp_config &c) { c.friction_law = RP_SLIP_VELOCITY; });
  refuses("friction_law = coulomb or slip_velocity in this version", [](rp_config &c) {
    c.friction_law = RP_TEMPERATURE;
    c.temperature = 1;
  });
  refuses("layer_yield_stress must be 0 with regime = transient_rolling of wheels",
          [](rp_config &c) { c.layer_yield_stress = 1e8; });
  accepts([](rp_config &c) { c.reference_surface = RP_REFERENCE_CURVED; });
  refuses("temperature must be 0 with regime = transient_rolling of wheels",
          [](rp_config &c) { c.temperature = 1; });
  refuses("needs equal (1-2nu)/G of both bodies", [](rp_config &c) { c.poisson_ratio[0] = 0.1; });
  accepts([](rp_config &c) { c.spin_offset = RP_SPIN_OFFSET_SIXTH; });
}

TEST_F(Checks, SpinIsReadAtElements) {
  for (const rp_spin_offset offset : {RP_SPIN_OFFSET_SIXTH, RP_SPIN_OFFSET_QUARTER}) {
    base.spin_offset = offset;
    for (const rp_tangential_method reads :
         {RP_TANGENTIAL_FULL, RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_FASTRIP})
      accepts([&](rp_config &c) { c.tangential = reads; });
    for (const rp_tangential_method sums : {RP_TANGENTIAL_LINEAR, RP_TANGENTIAL_POLACH})
      refuses("spin_offset must be automatic or none where tangential gives no tractions",
              [&](rp_config &c) { c.tangential = sums; });
    const char *without = "spin_offset must be automatic or none without a tangential problem";
    refuses(without, [](rp_config &c) { c.tangential = RP_TANGENTIAL_NONE; });
    refuses(without, [](rp_config &c) { c.regime = RP_REGIME_NONE; });
  }
}

TEST_F(Checks, FastTheories) {
  base.tangential = RP_TANGENTIAL_FASTSIM;
  accepts();
  const char *polach = "polach_k_a and polach_k_s must be 1";
  refuses(polach, [](rp_config &c) { c.polach_k_a = 0.5; });
  refuses(polach, [](rp_config &c) { c.polach_k_s = 0.5; });
  for (const double rp_config::*reduced :
       {&rp_config::fastsim_k0, &rp_config::fastsim_alpha, &rp_config::fastsim_beta}) {
    const auto with = [&](rp_config &c) { c.*const_cast<double rp_config::*>(reduced) = 0.5; };
    accepts(with);
    rp_config c = base;
    c.tangential = RP_TANGENTIAL_POLACH;
    with(c);
    EXPECT_NE(said_of(c).find("fastsim_k0 and fastsim_alpha must be 1, fastsim_beta 0"),
              std::string::npos);
  }
  accepts([](rp_config &c) { c.traction_bound = RP_BOUND_PARABOLIC; });
  accepts([](rp_config &c) { c.percent_kalker = 60; });
  const tables::table table = tables::small();
  const auto by_table = [&](double percent) {
    return [&table, percent](rp_config &c) {
      c.tangential = RP_TANGENTIAL_TABLE;
      c.creep_table = table.data();
      c.creep_table_size = table.size();
      c.percent_kalker = percent;
    };
  };
  accepts(by_table(100));
  refuses(
      "percent_kalker must be 100 where tangential is not linear or polach or fastsim or "
      "fastrip",
      by_table(60));
  refuses("a fast theory has no third-body layer", [](rp_config &c) {
    c.layer_thickness = 1e-5;
    c.layer_shear_modulus = 8e9;
  });
  refuses("a fast theory has no line contact",
          [](rp_config &c) { c.geometry = RP_LINE_CONTACT, c.elements[1] = 1; });
  base.tangential = RP_TANGENTIAL_FULL;
  refuses("percent_kalker must be 100 with tangential = full",
          [](rp_config &c) { c.percent_kalker = 60; });
  refuses("traction_bound must be automatic",
          [](rp_config &c) { c.traction_bound = RP_BOUND_PARABOLIC; });
  accepts([](rp_config &c) { c.percent_kalker = 60, c.regime = RP_REGIME_NONE; });
}

TEST_F(Checks, WheelsAndTracks) {
  base = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  accepts();
  refuses("contact_frame must be track on rails",
          [](rp_config &c) { c.contact_frame = RP_FRAME_INCLINED; });
  for (int k = 0; k < 2; ++k) {
    const auto rail = [k](double stiffness, double damping) {
      return [=](rp_config &c) { c.rail_stiffness[k] = stiffness, c.rail_damping[k] = damping; };
    };
    accepts(rail(1, 1));
    refuses("rail_stiffness must be 0 or at least 1 N/m", rail(0.999, 0));
    refuses("rail_damping must be 0 in a direction whose rail_stiffness is 0", rail(0, 1e-3));
  }
  base.track = RP_ROLLER;
  base.cant = 0;
  accepts();
  accepts([](rp_config &c) { c.contact_frame = RP_FRAME_INCLINED; });
  refuses("contact_frame must be track with reference_surface = curved", [](rp_config &c) {
    c.contact_frame = RP_FRAME_INCLINED;
    c.reference_surface = RP_REFERENCE_CURVED;
  });
  refuses("cant must be 0 on rollers", [](rp_config &c) { c.cant = 1e-9; });
  refuses("curvature must be 0 on rollers", [](rp_config &c) { c.curvature = -1e-9; });
}

TEST_F(Checks, Shapes) {
  base = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  std::vector<double> v(100, 0.1);
  v[17] = -0.1;
  for (int side = 0; side < 2; ++side) {
    const auto runout = [&, side](rp_config &c) {
      c.runout[side] = v.data();
      c.runout_count[side] = 100;
    };
    const auto height = [&, side](rp_config &c) {
      c.rail_height[side] = v.data();
      c.rail_height_count[side] = 100;
    };
    const char *names[2][2] = {{"runout[0]", "runout[1]"}, {"rail_height[0]", "rail_height[1]"}};
    for (int which = 0; which < 2; ++which) {
      const change shape = which == 0 ? change(runout) : change(height);
      const std::string name = names[which][side];
      accepts(shape);
      for (const double bad : {0.1001, -0.1001}) {
        std::swap(v[99], v[17]);
        const double good = std::exchange(v[99], bad);
        refuses((name + "[99] is").c_str(), shape);
        v[99] = good;
        std::swap(v[99], v[17]);
      }
      refuses((name + " is null").c_str(), [&](rp_config &c) {
        shape(c);
        (which == 0 ? c.runout : c.rail_height)[side] = nullptr;
      });
      refuses("runout and rail_height need normal = half_space", [&](rp_config &c) {
        shape(c);
        c.normal = RP_NORMAL_ANALYN;
      });
      const auto on_rollers = [&](rp_config &c) {
        shape(c);
        c.track = RP_ROLLER;
        c.cant = 0;
      };
      if (which == 0)
        accepts(on_rollers);
      else
        refuses("rail_height_count must be 0 on rollers", on_rollers);
    }
  }
}

TEST_F(Checks, UnlikeBodies) {
  base.shear_modulus[0] = 26e9;
  accepts();
  accepts([](rp_config &c) { c.regime = RP_REGIME_NONE, c.normal = RP_NORMAL_ANALYN; });
  for (const change &wrong : {change([](rp_config &c) { c.normal = RP_NORMAL_HERTZ; }),
                              change([](rp_config &c) { c.tangential = RP_TANGENTIAL_FASTSIM; }),
                              change([](rp_config &c) { c.fitted[0] = c.fitted[1] = 8; })})
    refuses("which needs normal = half_space, tangential = full and no fitted rows", wrong);
  base = scenes::heated_patch(RP_TRANSIENT_ROLLING);
  base.normal = RP_NORMAL_HALF_SPACE;
  accepts();
  base.shear_modulus[0] = 26e9;
  refuses("not equal needs regime = steady_rolling", [](rp_config &) {});
  accepts([](rp_config &c) { c.regime = RP_STEADY_ROLLING; });
}

TEST_F(Checks, Distances) {
  std::vector<double> gap(9, 1.0);
  gap[4] = -1.0;
  base.geometry = RP_UNDEFORMED_DISTANCE;
  base.elements[0] = base.elements[1] = 0;
  base.element_size[0] = base.element_size[1] = 1e-3;
  base.distance_shape[0] = base.distance_shape[1] = 3;
  base.undeformed_distance = gap.data();
  accepts();
  for (int k = 0; k < 2; ++k)
    refuses("max_elements must be 0 with undeformed_distance: distance_shape is the grid",
            [k](rp_config &c) { c.max_elements[k] = 8; });
  refuses("distance_shape[0] is 0", [](rp_config &c) { c.distance_shape[0] = 0; });
  gap[8] = 1.001;
  refuses("undeformed_distance[8] is 1.001", [](rp_config &) {});
  gap[8] = -1.001;
  refuses("undeformed_distance[8] is -1.001", [](rp_config &) {});
  gap[8] = 0;
  refuses("undeformed_distance needs element_size", [](rp_config &c) {
    c.elements[0] = c.elements[1] = 10;
    c.element_size[0] = c.element_size[1] = 0;
  });
}

TEST_F(Checks, ViscoelasticBodies) {
  base.geometry = RP_CURVATURES;
  base.curvatures[0] = base.curvatures[1] = 1.0;
  for (int k = 0; k < 2; ++k) {
    base.viscoelastic_ratio[k] = 2.0;
    base.relaxation_time[k] = 1e-3;
  }
  accepts();
  accepts([](rp_config &c) { c.tangential = RP_TANGENTIAL_NONE; });
  for (double wrong : {-1e-9, 1.0001e4, std::nan("")})
    refuses("viscoelastic_ratio[0] is", [&](rp_config &c) { c.viscoelastic_ratio[0] = wrong; });
  for (int k = 0; k < 2; ++k) {
    const std::string time = "relaxation_time[" + std::to_string(k) + "] must be ";
    refuses((time + "> 0").c_str(), [k](rp_config &c) { c.relaxation_time[k] = 0; });
    refuses((time + "0 with").c_str(), [k](rp_config &c) { c.viscoelastic_ratio[k] = 0; });
  }
  refuses("semi_axes are those of elastic bodies", [](rp_config &c) {
    c.geometry = RP_SEMI_AXES;
    c.semi_axes[0] = c.semi_axes[1] = 5e-3;
  });
  // of these regimes grids are fixed, which another rule asks for
  for (const bool changes : {false, true})
    refuses("needs regime = steady_rolling", [changes](rp_config &c) {
      for (int k = 0; k < 2; ++k) {
        c.elements[k] = 0;
        c.element_size[k] = 1e-3;
        c.max_elements[k] = 20;
      }
      if (changes) c.regime_changes = 1;
      if (!changes) c.regime = RP_SHIFT;
    });
  const std::pair<const char *, change> rules[] = {
      {"needs normal = half_space", [](rp_config &c) { c.normal = RP_NORMAL_HERTZ; }},
      {"needs tangential = full", [](rp_config &c) { c.tangential = RP_TANGENTIAL_FASTSIM; }},
      {"no fitted rows", [](rp_config &c) { c.fitted[0] = c.fitted[1] = 8; }},
      {"temperature must be 0", [](rp_config &c) { c.temperature = 1; }},
      {"accuracy must be 0", [](rp_config &c) { c.accuracy = 0.01; }},
      {"derivatives must be 0", [](rp_config &c) { c.derivatives = 1; }},
      {"bodies with equal (1-2nu)/G", [](rp_config &c) { c.viscoelastic_ratio[1] = 1.0; }},
      {"bodies with equal (1-2nu)/G", [](rp_config &c) { c.shear_modulus[1] *= 0.5; }},
  };
  for (const auto &[words, spoil] : rules) refuses(words, spoil);
  refuses("layer_thickness must be 0", [](rp_config &c) {
    c.layer_thickness = 1e-4;
    c.layer_shear_modulus = 1e9;
  });
  refuses("friction_law must be coulomb", [](rp_config &c) {
    c.friction_law = RP_SLIP_VELOCITY;
    c.friction_kinetic = 0.2;
    c.friction_amplitude[0] = 0.1;
  });
  base = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  refuses("viscoelastic_ratio must be 0 but with kind = patch", [](rp_config &c) {
    c.viscoelastic_ratio[0] = 1.0;
    c.relaxation_time[0] = 1e-3;
  });
}

TEST_F(Checks, OwnInfluence) {
  const int shape[2] = {4, 3}, each = 5 * 3;
  std::vector<double> gap(12, 0.0), own(4 * each, 0.0);
  for (int k = 0; k < 3; ++k) own[static_cast<size_t>(k * each)] = 1e-13;
  base.geometry = RP_UNDEFORMED_DISTANCE;
  base.elements[0] = base.elements[1] = 0;
  base.element_size[0] = base.element_size[1] = 1e-3;
  std::copy_n(shape, 2, base.distance_shape);
  base.undeformed_distance = gap.data();
  base.influence_coefficients = own.data();
  base.own_influence = 1;
  accepts();
  accepts([](rp_config &c) { c.tangential = RP_TANGENTIAL_NONE; });
  accepts([](rp_config &c) { c.regime = RP_SHIFT; });
  refuses("own_influence is 2", [](rp_config &c) { c.own_influence = 2; });
  refuses("influence_coefficients is null",
          [](rp_config &c) { c.influence_coefficients = nullptr; });
  const std::pair<const char *, change> rules[] = {
      {"needs geometry = undeformed_distance",
       [](rp_config &c) {
         c.geometry = RP_CURVATURES;
         c.curvatures[0] = c.curvatures[1] = 1.0;
       }},
      {"needs normal = half_space", [](rp_config &c) { c.normal = RP_NORMAL_ANALYN; }},
      {"needs tangential = full", [](rp_config &c) { c.tangential = RP_TANGENTIAL_FASTSIM; }},
      {"no fitted rows", [](rp_config &c) { c.fitted[0] = c.fitted[1] = 8; }},
      {"needs regime = none", [](rp_config &c) { c.regime = RP_TRANSIENT_ROLLING; }},
      {"regime_changes = 0", [](rp_config &c) { c.regime_changes = 1; }},
      {"accuracy must be 0", [](rp_config &c) { c.accuracy = 0.01; }},
      {"derivatives must be 0", [](rp_config &c) { c.derivatives = 1; }},
      {"bodies with equal (1-2nu)/G", [](rp_config &c) { c.shear_modulus[1] *= 0.5; }},
  };
  for (const auto &[words, spoil] : rules) refuses(words, spoil);
  refuses("layer_thickness must be 0", [](rp_config &c) {
    c.layer_thickness = 1e-4;
    c.layer_shear_modulus = 1e9;
  });
  refuses("viscoelastic_ratio must be 0 with own_influence", [](rp_config &c) {
    for (int k = 0; k < 2; ++k) {
      c.viscoelastic_ratio[k] = 1.0;
      c.relaxation_time[k] = 1e-3;
    }
  });
  const auto with = [&](int at, double value, const char *words) {
    std::vector<double> other = own;
    other[static_cast<size_t>(at)] = value;
    refuses(words, [&](rp_config &c) { c.influence_coefficients = other.data(); });
  };
  with(7, std::nan(""), "influence_coefficients[7] is nan");
  with(4 * each - 1, 1.001, "influence_coefficients[59] is 1.001");
  with(0, 0.0, "influence_coefficients[0][0][0] is 0, must be > 0 and the greatest");
  with(each + 3, -1.1e-13, "influence_coefficients[1][0][0] is 1e-13");
  with(3 * each + 6, 1.1e-13, "influence_coefficients[3] has one above the geometric mean");
  base = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  refuses("own_influence must be 0 but with kind = patch",
          [](rp_config &c) { c.own_influence = 1; });
}

// --- friction's most, inputs and directions ------------------------------------------------------

TEST_F(Checks, MostFriction) {
  EXPECT_EQ(most_friction(base, 0.25), 0.25);
  base.friction_points = 2;
  base.friction_factor[0] = 2;
  base.friction_factor[1] = 0.5;
  EXPECT_EQ(most_friction(base, 0.25), 0.5);
  base.friction_along_points = 2;
  base.friction_along_factor[0] = 1;
  base.friction_along_factor[1] = 3;
  EXPECT_EQ(most_friction(base, 0.25), 1.5);
  base.friction_law = RP_SLIP_VELOCITY;
  base.friction_kinetic = 0.5;
  base.friction_amplitude[0] = -0.25;
  base.friction_amplitude[1] = 0.125;
  EXPECT_EQ(most_friction(base, 0.25), 6 * 0.625);
  base.friction_law = RP_TEMPERATURE;
  base.friction_reference = 0.5;
  for (const double change : {-0.25, 0.25}) {
    base.friction_change = change;
    EXPECT_EQ(most_friction(base, 0.125), 6 * (change > 0 ? 0.75 : 0.5));
  }
}

std::string said_of(const rp_config &c, const rp_input &in) {
  rp_message message{};
  const rp_error error = check_input(c, c.friction_coefficient, in, &message);
  EXPECT_EQ(error != RP_OK, message.text[0] != '\0');
  return message.text;
}

TEST_F(Checks, Inputs) {
  rp_input in = scenes::patch_input(1e5, 0, 0, 0);
  const auto expect = [&](const char *words, const std::function<void(rp_input &)> &spoil) {
    rp_input other = in;
    spoil(other);
    const std::string said = said_of(base, other);
    if (*words)
      EXPECT_NE(said.find(words), std::string::npos) << said;
    else
      EXPECT_EQ(said, "");
  };
  expect("", [](rp_input &) {});
  expect("", [](rp_input &i) { i.direction = -1; });
  expect("direction must be 1 or -1", [](rp_input &i) { i.direction = 0; });
  expect("bulk_temperature must be left NaN", [](rp_input &i) { i.bulk_temperature[1] = 20; });
  expect("tangential_force[0], not in force_prescribed, is 1, allowed is [0, 0]",
         [](rp_input &i) { i.tangential_force[0] = 1; });
  base.force_prescribed[0] = base.force_prescribed[1] = 1;
  in.tangential_force[0] = 1.8e4;
  in.tangential_force[1] = 2.4e4;
  expect("", [](rp_input &) {});
  expect("by the friction coefficient times normal_force",
         [](rp_input &i) { i.tangential_force[1] = 2.4001e4; });
  expect("rolling_speed, with a prescribed tangential_force, is 0, allowed is (0, inf)",
         [](rp_input &i) { i.rolling_speed = 0; });
  expect("creepage[1], found from tangential_force, is 1e-09",
         [](rp_input &i) { i.creepage[1] = 1e-9; });
  base = scenes::heated_patch(RP_STEADY_ROLLING);
  in = scenes::patch_input(1e5, 0, 0, 0);
  expect("", [](rp_input &i) { i.bulk_temperature[0] = 30; });
  base.bulk_temperature[0] = base.bulk_temperature[1] = 20;
  expect("", [](rp_input &i) { i.bulk_temperature[0] = i.bulk_temperature[1] = 30; });
  expect("bulk_temperature (temperature.wheel, temperature.rail) must be equal",
         [](rp_input &i) { i.bulk_temperature[0] = 30; });
  base.heat_exchange = 1;
  expect("", [](rp_input &i) { i.bulk_temperature[0] = 30; });

  base = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  in = scenes::running(RP_RAIL);
  expect("", [](rp_input &) {});
  for (const int axis : {1, 2})
    for (const int side : {0, 1})
      expect("rail_rotation about y and z must be 0",
             [=](rp_input &i) { i.rail_rotation[side][axis] = 1e-6; });
  expect("", [](rp_input &i) { i.time_step = 0; });
  base.regime = RP_TRANSIENT_ROLLING;
  expect("time_step is 0, allowed is (0, inf)", [](rp_input &i) { i.time_step = 0; });
  base.tangential = RP_TANGENTIAL_NONE;
  expect("", [](rp_input &i) { i.time_step = 0; });
}

}  // namespace
