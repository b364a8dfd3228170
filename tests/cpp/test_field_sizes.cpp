// Every field of a step: as many numbers as its patch's grid asks for, none written where there is
// no room for all, and what a state's header says is looked at byte by byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes.hpp"

namespace {

struct expected_size {
  rp_field name;
  int of_grid, of_columns, of_rows;  // per element, column, row
};

void expect_sizes(const scenes::handle &h, int side, const rp_patch_result &p,
                  const std::vector<expected_size> &present) {
  for (int name = 0; name <= RP_FIELD_ERROR_FEATURES; ++name) {
    const auto field = static_cast<rp_field>(name);
    if (field == RP_FIELD_ERROR_FEATURES) continue;
    const auto found = std::find_if(present.begin(), present.end(),
                                    [&](const expected_size &e) { return e.name == field; });
    SCOPED_TRACE(testing::Message() << "field " << name);
    std::vector<double> values(20000, 7.0);
    size_t count = values.size();
    const rp_error error = rp_get_field(h.get(), side, 0, field, values.data(), &count);
    if (found == present.end()) {
      EXPECT_EQ(error, RP_ERROR_NO_FIELD);
      EXPECT_EQ(count, values.size());
      EXPECT_EQ(values[0], 7.0);
      continue;
    }
    ASSERT_EQ(error, RP_OK);
    const size_t size =
        static_cast<size_t>(found->of_grid * p.grid[0] * p.grid[1] + found->of_columns * p.grid[0] +
                            found->of_rows * p.grid[1]);
    EXPECT_EQ(count, size);
    EXPECT_EQ(values[size], 7.0) << "written beyond its end";
    std::fill(values.begin(), values.end(), 7.0);
    count = size - 1;
    EXPECT_EQ(rp_get_field(h.get(), side, 0, field, values.data(), &count), RP_ERROR_SIZE);
    EXPECT_EQ(count, size);
    EXPECT_EQ(values[0], 7.0);
    EXPECT_EQ(rp_get_field(h.get(), side, 0, field, values.data(), &count), RP_OK);
    count = 0;
    EXPECT_EQ(rp_get_field(h.get(), side, 0, field, nullptr, &count), RP_ERROR_SIZE);
    EXPECT_EQ(count, size);
  }
}

const std::vector<expected_size> plain{{RP_FIELD_X, 0, 1, 0},
                                       {RP_FIELD_Y, 0, 0, 1},
                                       {RP_FIELD_UNDEFORMED_DISTANCE, 1, 0, 0},
                                       {RP_FIELD_PRESSURE, 1, 0, 0}};
std::vector<expected_size> with(std::vector<expected_size> all,
                                const std::vector<expected_size> &more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}
const std::vector<expected_size> rolling = with(plain, {{RP_FIELD_TRACTION, 2, 0, 0},
                                                        {RP_FIELD_MICRO_SLIP, 2, 0, 0},
                                                        {RP_FIELD_ELEMENT_DIVISION, 1, 0, 0}});

TEST(FieldSizes, OfPatches) {
  const rp_input in = scenes::patch_input(1e5, 2e-3, 0, 0.1);
  const auto expect = [&](const rp_config &c, const std::vector<expected_size> &present) {
    scenes::handle h(c);
    const rp_patch_result p = h.step(in).side[RP_RIGHT].patch[0];
    ASSERT_EQ(p.status, RP_CONVERGED);
    ASSERT_GT(p.grid[0], 0);
    expect_sizes(h, RP_RIGHT, p, present);
  };
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_NONE, 8);
  c.elements[1] = 11;
  expect(c, plain);
  c.tangential = RP_TANGENTIAL_FULL;
  expect(c, rolling);
  c.friction_law = RP_SLIP_VELOCITY;
  c.friction_kinetic = 0.2;
  c.friction_amplitude[0] = 0.1;
  expect(c, with(rolling, {{RP_FIELD_FRICTION, 1, 0, 0}}));
  c.friction_law = RP_COULOMB;
  c.layer_thickness = 2e-5;
  c.layer_shear_modulus = 8.2e9;
  c.layer_yield_stress = 1e8;
  c.layer_hardening = 3e12;
  {
    scenes::handle h(c);
    const rp_patch_result p = h.step(in).side[RP_RIGHT].patch[0];
    expect_sizes(h, RP_RIGHT, p,
                 with(rolling, {{RP_FIELD_PLASTIC_DISPLACEMENT, 2, 0, 0},
                                {RP_FIELD_PLASTIC_PATH, 1, 0, 0},
                                {RP_FIELD_YIELD_STRESS, 1, 0, 0}}));
    const auto path = h.field(RP_RIGHT, 0, RP_FIELD_PLASTIC_PATH);
    EXPECT_GT(*std::max_element(path.begin(), path.end()), 0);
  }
  c = scenes::heated_patch(RP_STEADY_ROLLING, 8);
  scenes::handle hot(c);
  const rp_patch_result p = hot.step(in).side[RP_RIGHT].patch[0];
  expect_sizes(hot, RP_RIGHT, p,
               with(rolling, {{RP_FIELD_FRICTION, 1, 0, 0}, {RP_FIELD_TEMPERATURE, 2, 0, 0}}));
}

// Of a state not one byte can change unseen.
TEST(StateBytes, EachIsCovered) {
  scenes::handle h(scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 4));
  const rp_input in = scenes::patch_input(1e5, 1e-3, 0, 0);
  h.step(in);
  const std::vector<unsigned char> good = h.state();
  for (size_t i = 0; i < good.size(); ++i)
    for (const int bit : {0, 7}) {
      std::vector<unsigned char> bad = good;
      bad[i] = static_cast<unsigned char>(bad[i] ^ (1 << bit));
      ASSERT_EQ(h.restore(bad), RP_ERROR_STATE) << "byte " << i;
    }
  for (const size_t size : {size_t{0}, size_t{1}, size_t{47}, size_t{48}, good.size() - 1}) {
    EXPECT_EQ(rp_restore_state(h.get(), good.data(), size), RP_ERROR_STATE);
    std::vector<unsigned char> room(good.size(), 9);
    EXPECT_EQ(rp_save_state(h.get(), room.data(), size), RP_ERROR_SIZE);
    EXPECT_TRUE(std::all_of(room.begin(), room.end(), [](unsigned char b) { return b == 9; }));
  }
  EXPECT_EQ(h.restore(good), RP_OK);
}

}  // namespace
