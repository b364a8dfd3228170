// Saved states: handles, and the way to and from bytes.
#include <algorithm>
#include <cstring>

#include "instance.hpp"

namespace railpatch::fmu {

Snapshot *Instance::known(StateHandle state) const {
  for (const auto &snapshot : snapshots_)
    if (snapshot.get() == state) return snapshot.get();
  return nullptr;
}

Status Instance::give_handle(const Call &call, std::unique_ptr<Snapshot> snapshot,
                             StateHandle *state) {
  if (*state == nullptr) {
    snapshots_.push_back(std::move(snapshot));
    *state = snapshots_.back().get();
    return Status::ok;
  }
  // a handle given before is used again
  Snapshot *old = known(*state);
  if (old == nullptr) return refuse(call, "*FMUstate is neither NULL nor a state of this instance");
  old->swap(*snapshot);
  return Status::ok;
}

std::vector<double> Instance::saved_numbers() const {
  std::vector<double> numbers = values_;
  for (const auto *more : {&solved_, &rates_, &input_derivatives_})
    numbers.insert(numbers.end(), more->begin(), more->end());
  return numbers;
}

Status Instance::get_state(const Call &call, StateHandle *state) {
  if (state == nullptr) return refuse(call, "FMUstate is NULL");
  const Status status = take_profiles(call);
  if (status != Status::ok) return status;
  std::vector<unsigned char> core = pending_;
  if (core.empty()) {
    core.resize(rp_state_size(contact_.get()));
    const rp_error error = rp_save_state(contact_.get(), core.data(), core.size());
    if (error != RP_OK) return refuse(call, rp_error_text(error));
  }
  std::vector<unsigned char> files;
  if (options_.profile_files != 0) files = bytes_of(files_);
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
  return give_handle(call, std::make_unique<Snapshot>(pack(header, saved_numbers(), core, files)),
                     state);
}

Status Instance::set_state(const Call &call, StateHandle state) {
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
    if (!in_range(call, static_cast<int>(i), numbers[i])) return Status::error;
  ProfileFiles files;
  if (header.files > 0 && !files_of(files_of(bytes), header.files, files))
    return refuse(call, "the profiles in the state cannot be read");
  const Profiles profiles = profiles_of(numbers);
  for (size_t i = 0; i < files.size(); ++i)
    if (profiles[2 + i] != files[i].number)
      return refuse(call, "the profiles in the state are not those that it names");
  Contact other;
  if (profiles != made_) {
    const Status status = make_contact(call, profiles, files, other);
    if (status != Status::ok) return status;
  }
  rp_contact *contact = other != nullptr ? other.get() : contact_.get();
  const rp_error error = rp_restore_state(contact, core_of(bytes), header.core);
  if (error != RP_OK) return refuse(call, rp_error_text(error));
  if (other != nullptr) contact_ = std::move(other);
  made_ = profiles;
  take_files(files);
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
  return Status::ok;
}

Status Instance::free_state(const Call &call, StateHandle *state) {
  if (state == nullptr) return Status::ok;
  // some importers give the handle itself instead of its address
  const bool by_value = known(state) != nullptr;
  StateHandle handle = by_value ? state : *state;
  if (handle == nullptr) return Status::ok;
  const auto found = std::find_if(snapshots_.begin(), snapshots_.end(),
                                  [&](const auto &own) { return own.get() == handle; });
  if (found == snapshots_.end()) return refuse(call, "*FMUstate is not a state of this instance");
  snapshots_.erase(found);
  if (!by_value) *state = nullptr;
  return Status::ok;
}

Status Instance::state_size(const Call &call, StateHandle state, size_t *size) {
  const Snapshot *snapshot = known(state);
  if (snapshot == nullptr) return refuse(call, "FMUstate is not a state of this instance");
  if (size == nullptr) return refuse(call, "size is NULL");
  *size = snapshot->size();
  return Status::ok;
}

Status Instance::serialize(const Call &call, StateHandle state, unsigned char *bytes, size_t size) {
  const Snapshot *snapshot = known(state);
  if (snapshot == nullptr) return refuse(call, "FMUstate is not a state of this instance");
  if (bytes == nullptr) return refuse(call, "serializedState is NULL");
  if (size < snapshot->size())
    return refuse(call, "size is " + text_of_whole(size) + ", allowed from " +
                            text_of_whole(snapshot->size()));
  std::memcpy(bytes, snapshot->data(), snapshot->size());
  return Status::ok;
}

Status Instance::deserialize(const Call &call, const unsigned char *bytes, size_t size,
                             StateHandle *state) {
  if (bytes == nullptr) return refuse(call, "serializedState is NULL");
  if (state == nullptr) return refuse(call, "FMUstate is NULL");
  const char *problem = check(bytes, size, content_, number_count());
  if (problem != nullptr) return refuse(call, problem);
  return give_handle(call, std::make_unique<Snapshot>(bytes, bytes + size), state);
}

}  // namespace railpatch::fmu
