// Many states on several threads: rp_step_many. Beside the rest of the core, which makes no
// threads, and left out of FMUs.
#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

#include "handle/abi.hpp"
#include "handle/check.hpp"

using namespace railpatch;

namespace {

constexpr int32_t most_threads = 1024;

struct task {
  rp_contact *const *contacts;
  const rp_input *inputs;
  size_t count, length;
  rp_result *results;
  std::atomic<size_t> next{0};
  std::atomic<rp_error> outcome{RP_OK};

  void end_as(rp_error error) {
    rp_error none = RP_OK;
    outcome.compare_exchange_strong(none, error);
  }
  // Takes sequences until there are none: which thread takes which does not matter.
  void run(rp_contact *contact) {
    // a few at once, where they are short
    const size_t batch = length >= 16 ? 1 : 16 / length;
    while (outcome == RP_OK) {
      const size_t first = next.fetch_add(batch);
      if (first >= count) break;
      for (size_t k = first; k < std::min(first + batch, count) && outcome == RP_OK; ++k)
        run_sequence(contact, k);
    }
    rp_reset(contact);
  }
  void run_sequence(rp_contact *contact, size_t k) {
    rp_reset(contact);
    for (size_t i = k * length; i < (k + 1) * length && outcome == RP_OK; ++i) {
      const rp_error error = rp_step(contact, inputs + i, results + i, nullptr);
      if (error != RP_OK) end_as(error);
    }
  }
};

rp_error check_contacts(rp_contact *const *contacts, int32_t threads, rp_message *message) {
  for (int32_t k = 0; k < threads; ++k) {
    if (!contacts[k]) {
      set_message(message, "contacts[%d] is null", static_cast<int>(k));
      return RP_ERROR_NULL;
    }
    for (int32_t j = 0; j < k; ++j) {
      if (contacts[j] != contacts[k]) continue;
      set_message(message, "contacts[%d] is contacts[%d], allowed is one for each thread",
                  static_cast<int>(k), static_cast<int>(j));
      return RP_ERROR_VALUE;
    }
    const contact &first = contacts[0]->handle, &other = contacts[k]->handle;
    const bool same_friction = first.friction_coefficient() == other.friction_coefficient();
    if (first.is_like(other) && same_friction) continue;
    set_message(message, "contacts[%d] has another %s than contacts[0]", static_cast<int>(k),
                first.is_like(other) ? "friction coefficient" : "config");
    return RP_ERROR_VALUE;
  }
  return RP_OK;
}

}  // namespace

rp_error rp_step_many(rp_contact *const *contacts, int32_t threads, const rp_input *inputs,
                      size_t count, size_t length, rp_result *results, size_t *wrong,
                      rp_message *message) {
  if (!contacts || !inputs || !results) {
    set_message(message, "%s is null", !contacts ? "contacts" : (!inputs ? "inputs" : "results"));
    return RP_ERROR_NULL;
  }
  if (threads < 1 || threads > most_threads) {
    set_message(message, "threads is %d, allowed is 1 ... %d", static_cast<int>(threads),
                static_cast<int>(most_threads));
    return RP_ERROR_VALUE;
  }
  if (length < 1) {
    set_message(message, "length is 0, allowed is >= 1");
    return RP_ERROR_VALUE;
  }
  if (const rp_error error = check_contacts(contacts, threads, message); error != RP_OK)
    return error;
  const contact &first = contacts[0]->handle;
  for (size_t i = 0; i < count * length; ++i) {
    const rp_error error =
        check_input(first.config(), first.friction_coefficient(), inputs[i], message);
    if (error == RP_OK) continue;
    if (wrong) *wrong = i;
    return error;
  }
  task all{contacts, inputs, count, length, results};
  std::array<std::thread, most_threads> others;
  int32_t made = 1;
  try {
    for (; made < threads && static_cast<size_t>(made) < count; ++made)
      others[static_cast<size_t>(made)] =
          std::thread([&all, contact = contacts[made]] { all.run(contact); });
  } catch (...) {
    // as many as there are
  }
  all.run(contacts[0]);
  for (auto &other : others)
    if (other.joinable()) other.join();
  const rp_error outcome = all.outcome;
  if (outcome != RP_OK)
    set_message(message, outcome == RP_ERROR_INTERRUPTED ? "rp_step_many was interrupted"
                                                         : "internal error in rp_step_many");
  return outcome;
}
