// FMI 3.0: values of variables, of which vectors are arrays. Types that no scene has are refused.
#include "fmi3_run.hpp"

using namespace railpatch::fmu;
using namespace railpatch::fmu::fmi3;

namespace {

template <class T>
Status check(Instance &i, const Call &call, const fmi3ValueReference *references, size_t count,
             const T *values) {
  if (count == 0) return Status::ok;
  if (references == nullptr) return i.refuse(call, "valueReferences is NULL");
  return values == nullptr ? i.refuse(call, "values is NULL") : Status::ok;
}

template <class T>
fmi3Status get(fmi3Instance instance, const Call &call, Type type,
               const fmi3ValueReference *references, size_t count, T *values, size_t value_count) {
  return call_of(instance, call, [&](Instance &i) {
    Status status = check(i, call, references, count, values);
    if (status == Status::ok) status = i.flatten(call, type, references, count, value_count);
    return status == Status::ok ? i.get(call, type, i.flat().data(), i.flat().size(), values)
                                : status;
  });
}

template <class T>
fmi3Status set(fmi3Instance instance, const Call &call, Type type,
               const fmi3ValueReference *references, size_t count, const T *values,
               size_t value_count) {
  return call_of(instance, call, [&](Instance &i) {
    Status status = check(i, call, references, count, values);
    if (status == Status::ok) status = i.flatten(call, type, references, count, value_count);
    return status == Status::ok ? i.set(call, type, i.flat().data(), i.flat().size(), values)
                                : status;
  });
}

// A scene has no variables of this type.
template <class T>
fmi3Status none(fmi3Instance instance, const char *name, const char *type,
                const fmi3ValueReference *references, size_t count, const T *values,
                size_t value_count) {
  const Call call{name, any};
  return call_of(instance, call, [&](Instance &i) {
    const Status status = check(i, call, references, count, values);
    if (status != Status::ok || count + value_count == 0) return status;
    if (count == 0) return i.refuse(call, "nValues is not 0, but there is no variable");
    return i.refuse(call, std::string("there is no ") + type + " with value reference " +
                              text_of_whole(references[0]));
  });
}

}  // namespace

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, fmi3Float64 values[], size_t nValues) {
  return get(instance, fmi3::get_float64, Type::real, valueReferences, nValueReferences, values,
             nValues);
}

fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, const fmi3Float64 values[], size_t nValues) {
  return set(instance, fmi3::set_float64, Type::real, valueReferences, nValueReferences, values,
             nValues);
}

fmi3Status fmi3GetInt32(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, fmi3Int32 values[], size_t nValues) {
  return get(instance, fmi3::get_int32, Type::integer, valueReferences, nValueReferences, values,
             nValues);
}

fmi3Status fmi3SetInt32(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, const fmi3Int32 values[], size_t nValues) {
  return set(instance, fmi3::set_int32, Type::integer, valueReferences, nValueReferences, values,
             nValues);
}

fmi3Status fmi3GetInt64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, fmi3Int64 values[], size_t nValues) {
  return get(instance, fmi3::get_int64, Type::enumeration, valueReferences, nValueReferences,
             values, nValues);
}

fmi3Status fmi3SetInt64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, const fmi3Int64 values[], size_t nValues) {
  return set(instance, fmi3::set_int64, Type::enumeration, valueReferences, nValueReferences,
             values, nValues);
}

fmi3Status fmi3GetString(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, fmi3String values[], size_t nValues) {
  const Call &call = fmi3::get_string;
  return call_of(instance, call, [&](Instance &i) {
    Status status = check(i, call, valueReferences, nValueReferences, values);
    if (status == Status::ok)
      status = i.flatten(call, Type::text, valueReferences, nValueReferences, nValues);
    return status == Status::ok ? i.get_text(call, i.flat().data(), i.flat().size(), values)
                                : status;
  });
}

fmi3Status fmi3SetString(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, const fmi3String values[], size_t nValues) {
  const Call &call = fmi3::set_string;
  return call_of(instance, call, [&](Instance &i) {
    Status status = check(i, call, valueReferences, nValueReferences, values);
    if (status == Status::ok)
      status = i.flatten(call, Type::text, valueReferences, nValueReferences, nValues);
    return status == Status::ok ? i.set_text(call, i.flat().data(), i.flat().size(), values)
                                : status;
  });
}

fmi3Status fmi3GetFloat32(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, fmi3Float32 values[], size_t nValues) {
  return none(instance, "fmi3GetFloat32", "Float32", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3SetFloat32(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, const fmi3Float32 values[], size_t nValues) {
  return none(instance, "fmi3SetFloat32", "Float32", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3GetInt8(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                       size_t nValueReferences, fmi3Int8 values[], size_t nValues) {
  return none(instance, "fmi3GetInt8", "Int8", valueReferences, nValueReferences, values, nValues);
}

fmi3Status fmi3SetInt8(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                       size_t nValueReferences, const fmi3Int8 values[], size_t nValues) {
  return none(instance, "fmi3SetInt8", "Int8", valueReferences, nValueReferences, values, nValues);
}

fmi3Status fmi3GetUInt8(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, fmi3UInt8 values[], size_t nValues) {
  return none(instance, "fmi3GetUInt8", "UInt8", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3SetUInt8(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, const fmi3UInt8 values[], size_t nValues) {
  return none(instance, "fmi3SetUInt8", "UInt8", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3GetInt16(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, fmi3Int16 values[], size_t nValues) {
  return none(instance, "fmi3GetInt16", "Int16", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3SetInt16(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, const fmi3Int16 values[], size_t nValues) {
  return none(instance, "fmi3SetInt16", "Int16", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3GetUInt16(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, fmi3UInt16 values[], size_t nValues) {
  return none(instance, "fmi3GetUInt16", "UInt16", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3SetUInt16(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, const fmi3UInt16 values[], size_t nValues) {
  return none(instance, "fmi3SetUInt16", "UInt16", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3GetUInt32(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, fmi3UInt32 values[], size_t nValues) {
  return none(instance, "fmi3GetUInt32", "UInt32", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3SetUInt32(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, const fmi3UInt32 values[], size_t nValues) {
  return none(instance, "fmi3SetUInt32", "UInt32", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3GetUInt64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, fmi3UInt64 values[], size_t nValues) {
  return none(instance, "fmi3GetUInt64", "UInt64", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3SetUInt64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, const fmi3UInt64 values[], size_t nValues) {
  return none(instance, "fmi3SetUInt64", "UInt64", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3GetBoolean(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, fmi3Boolean values[], size_t nValues) {
  return get(instance, fmi3::get_boolean, Type::boolean, valueReferences, nValueReferences, values,
             nValues);
}

fmi3Status fmi3SetBoolean(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, const fmi3Boolean values[], size_t nValues) {
  return set(instance, fmi3::set_boolean, Type::boolean, valueReferences, nValueReferences, values,
             nValues);
}

fmi3Status fmi3GetBinary(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, size_t[], fmi3Binary values[], size_t nValues) {
  return none(instance, "fmi3GetBinary", "Binary", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3SetBinary(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, const size_t[], const fmi3Binary values[],
                         size_t nValues) {
  return none(instance, "fmi3SetBinary", "Binary", valueReferences, nValueReferences, values,
              nValues);
}

fmi3Status fmi3GetClock(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, fmi3Clock values[]) {
  return none(instance, "fmi3GetClock", "Clock", valueReferences, nValueReferences, values, 0);
}

fmi3Status fmi3SetClock(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, const fmi3Clock values[]) {
  return none(instance, "fmi3SetClock", "Clock", valueReferences, nValueReferences, values, 0);
}
