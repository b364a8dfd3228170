// Profiles that were packed beside the scene's own: a contact with those that parameters choose.
#include "instance.hpp"

namespace railpatch::fmu {

namespace {

constexpr uint32_t kReferences[] = {reference::profiles_wheel, reference::profiles_rail};

}  // namespace

double Instance::profile_count(const Variable &variable) const {
  const size_t further =
      scene_ == nullptr ? 0
                        : scene_->choices[variable.reference == reference::profiles_rail].size();
  return static_cast<double>(1 + further);
}

Instance::Profiles Instance::profiles_of(const std::vector<double> &values) const {
  Profiles found = {1, 1, 0, 0, 0, 0};
  for (size_t body = 0; body < 2; ++body) {
    const int index = index_of(kReferences[body]);
    if (index >= 0) found[body] = values[static_cast<size_t>(index)];
  }
  for (size_t i = 0; i < known_; ++i) {
    const Variable &variable = *variables_[i].variable;
    if (variable.type == Type::text) found[2 + place_of_file(variable)] = values[i];
  }
  return found;
}

Status Instance::make_contact(const Call &call, const Profiles &profiles, const ProfileFiles &files,
                              Contact &made) {
  rp_config config = scene_->config;
  for (size_t body = 0; body < 2; ++body)
    for (size_t side = 0; side < 2; ++side) {
      rp_profile &profile = (body == 0 ? config.wheel : config.rail)[side];
      const ProfileFile &file = files[2 * body + side];
      // a side without a wheel has none
      if (profile.count == 0 || (file.number == 0 && profiles[body] == 1)) continue;
      const size_t further = file.number == 0 ? static_cast<size_t>(profiles[body]) - 2 : 0;
      const auto &arrays = file.number != 0 ? file.arrays : scene_->choices[body][further].arrays;
      if (!make_profile(arrays, profile))
        return refuse(call, "the arrays of a profile differ in length");
    }
  rp_contact *contact = nullptr;
  rp_message message = {};
  const rp_error error = rp_create(&config, &contact, &message);
  made.reset(contact);
  if (contact != nullptr && options_.friction_sides != 0)
    rp_set_friction_coefficient(contact, 1, nullptr);
  if (error == RP_OK) return Status::ok;
  return refuse(call, std::string("the contact with these profiles cannot be made: ") +
                          (message.text[0] != '\0' ? message.text : rp_error_text(error)));
}

Status Instance::take_profiles(const Call &call) {
  const Profiles wanted = profiles_of(values_);
  if (wanted == made_) return Status::ok;
  Contact made;
  const Status status = make_contact(call, wanted, files_, made);
  if (status != Status::ok) return status;
  contact_ = std::move(made);
  made_ = wanted;
  pending_.clear();
  direction_.clear();
  solution_ = Solution::none;
  return Status::ok;
}

}  // namespace railpatch::fmu
