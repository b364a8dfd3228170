// Saved states: handles, and the way to and from bytes.
#include <algorithm>
#include <cstring>

#include "instance.hpp"

namespace railpatch::fmu {

Snapshot *Instance::known(fmi2FMUstate state) const {
  for (const auto &snapshot : snapshots_)
    if (snapshot.get() == state) return snapshot.get();
  return nullptr;
}

fmi2Status Instance::give_handle(const Call &call, std::unique_ptr<Snapshot> snapshot,
                                 fmi2FMUstate *state) {
  if (*state == nullptr) {
    snapshots_.push_back(std::move(snapshot));
    *state = snapshots_.back().get();
    return fmi2OK;
  }
  // a handle given before is used again
  Snapshot *old = known(*state);
  if (old == nullptr) return refuse(call, "*FMUstate is neither NULL nor a state of this instance");
  old->swap(*snapshot);
  return fmi2OK;
}

std::vector<double> Instance::saved_numbers() const {
  std::vector<double> numbers = values_;
  for (const auto *more : {&solved_, &rates_, &input_derivatives_})
    numbers.insert(numbers.end(), more->begin(), more->end());
  return numbers;
}

fmi2Status Instance::get_state(fmi2FMUstate *state) {
  if (state == nullptr) return refuse(call::get_state, "FMUstate is NULL");
  const fmi2Status status = take_profiles(call::get_state);
  if (status != fmi2OK) return status;
  std::vector<unsigned char> core = pending_;
  if (core.empty()) {
    core.resize(rp_state_size(contact_.get()));
    const rp_error error = rp_save_state(contact_.get(), core.data(), core.size());
    if (error != RP_OK) return refuse(call::get_state, rp_error_text(error));
  }
  SnapshotHeader header = {};
  header.content = content_;
  header.time = time_;
  header.start = start_;
  header.stop = stop_;
  header.mode = static_cast<uint32_t>(mode_);
  header.stop_defined = stop_defined_ ? 1 : 0;
  header.changed = changed_ ? 1 : 0;
  header.interface = static_cast<uint16_t>(interface_);
  header.solved = solution_ != Solution::none ? 1 : 0;
  header.largest_known = largest_known_ ? 1 : 0;
  return give_handle(call::get_state,
                     std::make_unique<Snapshot>(pack(header, saved_numbers(), core)), state);
}

fmi2Status Instance::set_state(fmi2FMUstate state) {
  const Call &call = call::set_state;
  const Snapshot *snapshot = known(state);
  if (snapshot == nullptr) return refuse(call, "FMUstate is not a state of this instance");
  const unsigned char *bytes = snapshot->data();
  const char *problem = check(bytes, snapshot->size(), content_, number_count());
  if (problem != nullptr) return refuse(call, problem);
  const SnapshotHeader header = header_of(bytes);
  if (header.interface != static_cast<uint16_t>(interface_))
    return refuse(call,
                  "the state is one of co-simulation, or of model exchange, where this "
                  "instance is for the other");
  std::vector<double> numbers(number_count());
  if (!numbers.empty())
    std::memcpy(numbers.data(), values_of(bytes), numbers.size() * sizeof(double));
  for (size_t i = 0; i < known_; ++i)
    if (!in_range(call, static_cast<int>(i), numbers[i])) return fmi2Error;
  const Profiles profiles = profiles_of(numbers);
  Contact other;
  if (profiles != made_) {
    const fmi2Status status = make_contact(call, profiles, other);
    if (status != fmi2OK) return status;
  }
  rp_contact *contact = other != nullptr ? other.get() : contact_.get();
  const rp_error error = rp_restore_state(contact, core_of(bytes), header.core);
  if (error != RP_OK) return refuse(call, rp_error_text(error));
  if (other != nullptr) contact_ = std::move(other);
  made_ = profiles;
  const double *from = numbers.data();
  for (auto *to : {&values_, &solved_, &rates_, &input_derivatives_}) {
    std::copy_n(from, to->size(), to->begin());
    from += to->size();
  }
  pending_.clear();
  direction_.clear();
  solution_ = header.solved != 0 ? Solution::lost : Solution::none;
  time_ = header.time;
  start_ = header.start;
  stop_ = header.stop;
  stop_defined_ = header.stop_defined != 0;
  changed_ = header.changed != 0;
  largest_known_ = header.largest_known != 0;
  mode_ = static_cast<Mode>(header.mode);
  return fmi2OK;
}

fmi2Status Instance::free_state(fmi2FMUstate *state) {
  if (state == nullptr) return fmi2OK;
  // some importers give the handle itself instead of its address
  const bool by_value = known(state) != nullptr;
  fmi2FMUstate handle = by_value ? state : *state;
  if (handle == nullptr) return fmi2OK;
  const auto found = std::find_if(snapshots_.begin(), snapshots_.end(),
                                  [&](const auto &own) { return own.get() == handle; });
  if (found == snapshots_.end())
    return refuse(call::free_state, "*FMUstate is not a state of this instance");
  snapshots_.erase(found);
  if (!by_value) *state = nullptr;
  return fmi2OK;
}

fmi2Status Instance::state_size(fmi2FMUstate state, size_t *size) {
  const Call &call = call::state_size;
  const Snapshot *snapshot = known(state);
  if (snapshot == nullptr) return refuse(call, "FMUstate is not a state of this instance");
  if (size == nullptr) return refuse(call, "size is NULL");
  *size = snapshot->size();
  return fmi2OK;
}

fmi2Status Instance::serialize(fmi2FMUstate state, fmi2Byte *bytes, size_t size) {
  const Call &call = call::serialize;
  const Snapshot *snapshot = known(state);
  if (snapshot == nullptr) return refuse(call, "FMUstate is not a state of this instance");
  if (bytes == nullptr) return refuse(call, "serializedState is NULL");
  if (size < snapshot->size())
    return refuse(call, "size is " + text_of_whole(size) + ", allowed from " +
                            text_of_whole(snapshot->size()));
  std::memcpy(bytes, snapshot->data(), snapshot->size());
  return fmi2OK;
}

fmi2Status Instance::deserialize(const fmi2Byte *bytes, size_t size, fmi2FMUstate *state) {
  const Call &call = call::deserialize;
  if (bytes == nullptr) return refuse(call, "serializedState is NULL");
  if (state == nullptr) return refuse(call, "FMUstate is NULL");
  const auto *from = reinterpret_cast<const unsigned char *>(bytes);
  const char *problem = check(from, size, content_, number_count());
  if (problem != nullptr) return refuse(call, problem);
  return give_handle(call, std::make_unique<Snapshot>(from, from + size), state);
}

}  // namespace railpatch::fmu
