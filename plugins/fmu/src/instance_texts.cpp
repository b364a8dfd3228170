// Values that are texts: constants of the scene, and profile files.
#include "instance.hpp"
#include "resource.hpp"

namespace railpatch::fmu {

Status Instance::get_text(const Call &call, const Reference *references, size_t count,
                          const char **values) {
  if (count > 0 && (references == nullptr || values == nullptr))
    return refuse(call, references == nullptr ? "vr is NULL" : "value is NULL");
  for (size_t i = 0; i < count; ++i)
    if (find(call, Type::text, references[i]) < 0) return Status::error;
  for (size_t i = 0; i < count; ++i)
    values[i] = variables_[static_cast<size_t>(index_of(references[i]))].text.c_str();
  return Status::ok;
}

size_t Instance::place_of_file(const Variable &variable) {
  const uint32_t side = variable.side - 1u;
  const bool rail = variable.reference == reference::profiles_rail_left_file + 1000 * side;
  return 2 * (rail ? 1 : 0) + side;
}

Status Instance::load_profile(const Call &call, const SceneVariable &item, const char *path,
                              ProfileFile &file) {
  std::string content, tried, problem;
  file = {};
  if (path[0] == '\0') return Status::ok;
  if (!read_path(path, content, tried))
    return refuse(call, item.name + ": the file cannot be read, tried: " + tried);
  if (parse_profile(path, content, place_of_file(*item.variable) >= 2, file, problem))
    return Status::ok;
  return refuse(call, item.name + ": " + path + " is refused: " + problem);
}

// The files, the names that are read back, and nothing of what was solved with others.
void Instance::take_files(const ProfileFiles &files) {
  files_ = files;
  for (size_t i = 0; i < known_; ++i) {
    SceneVariable &item = variables_[i];
    if (item.variable->type != Type::text) continue;
    item.text = files_[place_of_file(*item.variable)].path;
  }
}

Status Instance::set_text(const Call &call, const Reference *references, size_t count,
                          const char *const *values) {
  if (count > 0 && (references == nullptr || values == nullptr))
    return refuse(call, references == nullptr ? "vr is NULL" : "value is NULL");
  ProfileFiles files = files_;
  for (size_t i = 0; i < count; ++i) {
    const int index = find(call, Type::text, references[i]);
    if (index < 0 || !settable(call, index, 0)) return Status::error;
    if (values[i] == nullptr) return refuse(call, "value is NULL");
    const SceneVariable &item = variables_[static_cast<size_t>(index)];
    const Status status = load_profile(call, item, values[i], files[place_of_file(*item.variable)]);
    if (status != Status::ok) return status;
  }
  take_files(files);
  for (size_t i = 0; i < known_; ++i) {
    const Variable &variable = *variables_[i].variable;
    if (variable.type != Type::text) continue;
    values_[i] = files_[place_of_file(variable)].number;
  }
  changed_ = changed_ || count > 0;
  if (count > 0) largest_known_ = false;
  return Status::ok;
}

}  // namespace railpatch::fmu
