// rp_step_many: the bits of a plain loop for any number of threads; what it refuses; interruption.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "scenes.hpp"

namespace {

struct group {
  std::vector<std::unique_ptr<scenes::handle>> handles;
  std::vector<rp_contact *> contacts;
  group(const rp_config &config, int count) {
    for (int k = 0; k < count; ++k) {
      handles.push_back(std::make_unique<scenes::handle>(config));
      contacts.push_back(handles.back()->get());
    }
  }
};

std::vector<rp_input> patch_states(size_t count) {
  std::vector<rp_input> inputs;
  for (size_t i = 0; i < count; ++i) {
    const double k = static_cast<double>(i);
    inputs.push_back(scenes::patch_input(2e4 + 1e3 * k, 3e-5 * k, -1e-5 * k, 0.01 * k));
  }
  return inputs;
}

// each sequence from rp_reset
std::vector<rp_result> loop(const rp_config &config, const std::vector<rp_input> &inputs,
                            size_t length) {
  scenes::handle contact(config);
  std::vector<rp_result> results;
  for (size_t i = 0; i < inputs.size(); ++i) {
    if (i % length == 0) rp_reset(contact.get());
    results.push_back(contact.step(inputs[i]));
  }
  return results;
}

void expect_loop(const rp_config &config, const std::vector<rp_input> &inputs) {
  for (size_t length : {size_t{1}, size_t{3}, size_t{20}}) {
    const size_t count = inputs.size() / length;
    const std::vector<rp_input> taken(inputs.begin(),
                                      inputs.begin() + static_cast<long>(count * length));
    const std::vector<rp_result> wanted = loop(config, taken, length);
    for (int threads : {1, 2, 3}) {
      group g(config, threads);
      // what was solved before does not matter
      (void)g.handles[0]->step(inputs.back());
      std::vector<rp_result> found(taken.size());
      rp_message message{};
      ASSERT_EQ(rp_step_many(g.contacts.data(), threads, taken.data(), count, length, found.data(),
                             nullptr, &message),
                RP_OK)
          << message.text;
      for (size_t i = 0; i < taken.size(); ++i)
        ASSERT_EQ(scenes::difference(found[i], wanted[i]), "")
            << "state " << i << ", length " << length << ", " << threads << " threads";
      // and they end as after rp_reset
      EXPECT_EQ(scenes::difference(g.handles.back()->step(taken[0]), wanted[0]), "");
    }
  }
}

TEST(StepMany, GivesTheBitsOfALoop) {
  expect_loop(scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 12), patch_states(60));
}

TEST(StepMany, GivesTheBitsOfALoopOnWheels) {
  const scenes::profile_pair pair;
  const rp_config config = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
  std::vector<rp_input> inputs;
  for (int i = 0; i < 20; ++i) {
    inputs.push_back(scenes::running(RP_RAIL));
    inputs.back().y = 2e-4 * i;
  }
  expect_loop(config, inputs);
}

TEST(StepMany, NoStatesAreDone) {
  group g(scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_POLACH, 12), 2);
  const std::vector<rp_input> inputs = patch_states(1);
  rp_result result;
  EXPECT_EQ(rp_step_many(g.contacts.data(), 2, inputs.data(), 0, 1, &result, nullptr, nullptr),
            RP_OK);
}

TEST(StepMany, RefusesByName) {
  const rp_config config = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_POLACH, 12);
  group g(config, 2);
  std::vector<rp_input> inputs = patch_states(8);
  std::vector<rp_result> results(8);
  for (rp_result &r : results) r.status = RP_OUT_OF_RANGE;
  rp_message message{};
  size_t wrong = 99;
  const auto call = [&](rp_contact *const *contacts, int threads, size_t length) {
    return rp_step_many(contacts, threads, inputs.data(), 8 / std::max(length, size_t{1}), length,
                        results.data(), &wrong, &message);
  };
  EXPECT_EQ(call(nullptr, 2, 1), RP_ERROR_NULL);
  EXPECT_STREQ(message.text, "contacts is null");
  EXPECT_EQ(call(g.contacts.data(), 0, 1), RP_ERROR_VALUE);
  EXPECT_STREQ(message.text, "threads is 0, allowed is 1 ... 1024");
  EXPECT_EQ(call(g.contacts.data(), 2, 0), RP_ERROR_VALUE);
  EXPECT_STREQ(message.text, "length is 0, allowed is >= 1");
  rp_contact *twice[] = {g.contacts[0], g.contacts[0]};
  EXPECT_EQ(call(twice, 2, 1), RP_ERROR_VALUE);
  EXPECT_STREQ(message.text, "contacts[1] is contacts[0], allowed is one for each thread");
  rp_contact *with_null[] = {g.contacts[0], nullptr};
  EXPECT_EQ(call(with_null, 2, 1), RP_ERROR_NULL);
  EXPECT_STREQ(message.text, "contacts[1] is null");
  rp_config harder = config;
  for (double &v : harder.shear_modulus) v *= 2;
  group other(harder, 1);
  rp_contact *unlike[] = {g.contacts[0], other.contacts[0]};
  EXPECT_EQ(call(unlike, 2, 1), RP_ERROR_VALUE);
  EXPECT_STREQ(message.text, "contacts[1] has another config than contacts[0]");
  ASSERT_EQ(rp_set_friction_coefficient(g.contacts[1], 0.2, nullptr), RP_OK);
  EXPECT_EQ(call(g.contacts.data(), 2, 1), RP_ERROR_VALUE);
  EXPECT_STREQ(message.text, "contacts[1] has another friction coefficient than contacts[0]");
  ASSERT_EQ(rp_set_friction_coefficient(g.contacts[0], 0.2, nullptr), RP_OK);
  EXPECT_EQ(wrong, 99U);
  inputs[5].normal_force = -1;
  EXPECT_EQ(call(g.contacts.data(), 2, 2), RP_ERROR_VALUE);
  EXPECT_EQ(wrong, 5U);
  EXPECT_NE(std::string(message.text).find("normal_force is -1"), std::string::npos);
  for (const rp_result &r : results) EXPECT_EQ(r.status, RP_OUT_OF_RANGE);
}

TEST(StepMany, IsInterrupted) {
  std::atomic<int> asked{0};
  rp_config config = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 16);
  config.interrupt = [](void *user) -> int {
    return ++*static_cast<std::atomic<int> *>(user) > 40 ? 1 : 0;
  };
  config.interrupt_user = &asked;
  group g(config, 2);
  const std::vector<rp_input> inputs = patch_states(500);
  std::vector<rp_result> results(inputs.size());
  rp_message message{};
  EXPECT_EQ(rp_step_many(g.contacts.data(), 2, inputs.data(), inputs.size(), 1, results.data(),
                         nullptr, &message),
            RP_ERROR_INTERRUPTED);
  EXPECT_STREQ(message.text, "rp_step_many was interrupted");
  EXPECT_LT(asked, 100);
  // and they can be used afterwards
  asked = -1000000;
  config.interrupt = nullptr;
  EXPECT_EQ(scenes::difference(g.handles[1]->step(inputs[7]), loop(config, {inputs[7]}, 1)[0]), "");
}

}  // namespace
