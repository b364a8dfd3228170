// Values that are texts: constants of the scene, and profile files.
#include "instance.hpp"

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

Status Instance::set_text(const Call &call, const Reference *references, size_t count,
                          const char *const *values) {
  if (count > 0 && (references == nullptr || values == nullptr))
    return refuse(call, references == nullptr ? "vr is NULL" : "value is NULL");
  for (size_t i = 0; i < count; ++i) {
    const int index = find(call, Type::text, references[i]);
    if (index < 0 || !settable(call, index, 0)) return Status::error;
    if (values[i] == nullptr) return refuse(call, "value is NULL");
  }
  return Status::ok;
}

}  // namespace railpatch::fmu
