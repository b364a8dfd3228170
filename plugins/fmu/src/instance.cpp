#include "instance.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "floating_point.hpp"
#include "resource.hpp"

namespace railpatch::fmu {

namespace {

constexpr const char *kSceneFile = "scene.txt";
constexpr const char *kTableFile = "creep_table.bin";

std::string quoted(const std::string &text) { return "\"" + text + "\""; }

// FNV-1a (Fowler, Noll, Vo 1991)
uint64_t hash_of(const std::string &text) {
  uint64_t hash = 14695981039346656037ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

// Reads, parses and compares resources/scene.txt; else says in the log what is wrong.
bool load_scene(const Making &making, const char *token, const char *location, Log &log,
                Scene &scene) {
  const std::string call = std::string(making.call) + ": ";
  if (location == nullptr) {
    log.error(call + making.location + " is NULL, but the scene is in the resources folder");
    return false;
  }
  std::string content, tried, problem;
  if (!read_resource(location, kSceneFile, content, tried)) {
    log.error(call + "the scene cannot be read; " + making.location + " is " + quoted(location) +
              ", tried: " + tried);
    return false;
  }
  if (!parse_scene(content, scene, problem)) {
    log.error(call + kSceneFile + " of the resources cannot be used: " + problem);
    return false;
  }
  if (token == nullptr || scene.guid != token) {
    log.error(call + making.token + " is " + quoted(token != nullptr ? token : "NULL") +
              ", but that of the resources is " + quoted(scene.guid));
    return false;
  }
  return true;
}

// Reads the table of creep forces of a scene that uses one; what is wrong with it the core tells.
bool load_table(const Making &making, const char *location, Log &log, Scene &scene,
                std::string &table) {
  if (scene.config.tangential != RP_TANGENTIAL_TABLE) return true;
  std::string tried;
  if (!read_resource(location, kTableFile, table, tried)) {
    log.error(std::string(making.call) +
              ": the table of creep forces cannot be read, tried: " + tried);
    return false;
  }
  scene.config.creep_table = table.data();
  scene.config.creep_table_size = table.size();
  return true;
}

}  // namespace

std::unique_ptr<Instance> Instance::create(const Making &making, Interface interface,
                                           const char *token, const char *location, Log log) {
  std::unique_ptr<Instance> instance(new Instance(std::move(log)));
  instance->version_ = making.version;
  const std::string call = std::string(making.call) + ": ";
  const DefaultFloatingPoint environment;  // numbers in text are rounded, too
  auto content = std::make_unique<Scene>();
  Scene &scene = *content;
  if (!load_scene(making, token, location, instance->log_, scene)) return nullptr;
  if (!load_table(making, location, instance->log_, scene, instance->table_)) return nullptr;
  if (interface == Interface::model_exchange && scene.options.history != 0) {
    instance->log_.error(call +
                         "model exchange is asked for, but this scene has a history: take "
                         "co-simulation");
    return nullptr;
  }
  rp_contact *contact = nullptr;
  rp_message message = {};
  const rp_error error = rp_create(&scene.config, &contact, &message);
  if (error != RP_OK) {
    instance->log_.error(
        call + "the scene is refused: " +
        std::string(message.text[0] != '\0' ? message.text : rp_error_text(error)));
    return nullptr;
  }
  instance->contact_.reset(contact);
  if (scene.options.friction_sides != 0) rp_set_friction_coefficient(contact, 1, nullptr);
  instance->wheels_ = scene.config.kind != RP_PATCH;
  instance->derivatives_ = scene.config.derivatives != 0;
  if (scene.config.temperature != 0) std::copy_n(scene.config.bulk_temperature, 2, instance->bulk_);
  instance->with_z_ = scene.config.load == RP_POSITION;
  instance->interface_ = interface;
  instance->options_ = scene.options;
  instance->content_ = hash_of(scene.guid);
  instance->variables_ = std::move(scene.variables);
  instance->constants_ = std::move(scene.constants);
  const std::vector<SceneArray> arrays = std::move(scene.variable_arrays);
  if (!scene.choices[0].empty() || !scene.choices[1].empty() || scene.options.profile_files != 0)
    instance->scene_ = std::move(content);
  if (!instance->index_variables() || !instance->index_arrays(arrays)) {
    instance->log_.error(call + "the variables of scene.txt do not belong together");
    return nullptr;
  }
  instance->start_values();
  return instance;
}

bool Instance::index_variables() {
  for (size_t i = 0; i < variables_.size(); ++i) {
    const Variable &variable = *variables_[i].variable;
    if (variable.reference >= index_.size()) index_.resize(variable.reference + 1, -1);
    index_[variable.reference] = static_cast<int16_t>(i);
    if (variable.role != Role::input && variable.role != Role::parameter) continue;
    if (known_ != i) return false;
    ++known_;
  }
  // the step is found from four parameters
  for (uint32_t k = 0; index_of(reference::largest_step) >= 0 && k < 4; ++k)
    if (index_of(reference::wheelset_mass + k) < 0 || !wheels_ || !derivatives_) return false;
  for (size_t i = known_; i < variables_.size(); ++i) {
    const Variable &variable = *variables_[i].variable;
    const int of = variable.mean_of > 0 ? index_of(variable.mean_of) : -1;
    if (of >= 0) means_.emplace_back(i, static_cast<size_t>(of));
  }
  return true;
}

void Instance::start_values() {
  rp_default_input(&input_);
  std::copy_n(bulk_, 2, input_.bulk_temperature);
  std::copy_n(options_.friction_scale, 2, input_.friction_scale);
  values_.clear();
  take_files({});
  for (const SceneVariable &item : variables_) values_.push_back(item.start);
  at_.assign(known_, 0);
  solved_.assign(known_, 0);
  rates_.assign(known_, 0);
  input_derivatives_.assign(orders * known_, 0);
  direction_.clear();
  pending_.clear();
  solution_ = Solution::none;
  largest_known_ = false;
  changed_ = true;
}

bool Instance::allows(const Call &call) {
  if (call.interface != Interface::both && call.interface != interface_) {
    refuse(call, interface_ == Interface::co_simulation ? "is a call of model exchange"
                                                        : "is a call of co-simulation");
    return false;
  }
  if ((call.allowed & static_cast<uint32_t>(mode_)) != 0) return true;
  refuse(call, std::string("is not allowed in the state ") + mode_text(mode_, version_));
  return false;
}

Status Instance::refuse(const Call &call, const std::string &why) {
  log_.error(std::string(call.name) + ": " + why);
  return Status::error;
}

// --- modes -------------------------------------------------------------------------------------

Status Instance::setup(const Call &call, bool tolerance_defined, double tolerance, double start,
                       bool stop_defined, double stop) {
  if (tolerance_defined && !(tolerance > 0 && std::isfinite(tolerance)))
    return refuse(call, "tolerance is " + text_of(tolerance) + ", allowed > 0");
  if (!std::isfinite(start))
    return refuse(call, "startTime is " + text_of(start) + ", allowed a finite number");
  if (stop_defined && !(stop >= start))
    return refuse(call, "stopTime is " + text_of(stop) + ", allowed from " + text_of(start));
  time_ = start_ = start;
  stop_defined_ = stop_defined;
  stop_ = stop_defined ? stop : 0;
  return Status::ok;
}

Status Instance::enter_initialization() {
  mode_ = Mode::initialization;
  return Status::ok;
}

Status Instance::exit_initialization(const Call &call) {
  const Status status = changed_ ? solve(call) : Status::ok;
  // FMI knows no discard here, so a start that cannot be solved is an error, and said as one
  if (status == Status::discard)
    log_.error(std::string(call.name) + ": the start values cannot be solved");
  const Mode next = interface_ == Interface::co_simulation ? Mode::step_complete : Mode::event;
  mode_ = status == Status::ok ? next : Mode::error;
  return status == Status::ok ? Status::ok : Status::error;
}

Status Instance::terminate(const Call &call) {
  // outputs go on following what was set: they can still be read
  if (changed_ && follows()) {
    const Status status = solve(call);
    if (status == Status::error) return status;
  }
  mode_ = Mode::terminated;
  return Status::ok;
}

Status Instance::reset() {
  rp_reset(contact_.get());
  start_values();
  time_ = start_ = stop_ = 0;
  stop_defined_ = false;
  mode_ = Mode::instantiated;
  return Status::ok;
}

Status Instance::go_to(Mode mode) {
  mode_ = mode;
  return Status::ok;
}

Status Instance::set_time(const Call &call, double time) {
  if (!std::isfinite(time))
    return refuse(call, "time is " + text_of(time) + ", allowed a finite number");
  time_ = time;
  return Status::ok;
}

// --- solving -----------------------------------------------------------------------------------

Status Instance::solve(const Call &call) {
  std::copy_n(values_.begin(), known_, at_.begin());
  const Status status = advance(call, time_, options_.time_step);
  if (status == Status::ok) publish();
  return status;
}

Status Instance::advance(const Call &call, double time, double time_step) {
  const Status status = take_profiles(call);
  if (status != Status::ok) return status;
  if (!pending_.empty()) {
    const rp_error error = rp_restore_state(contact_.get(), pending_.data(), pending_.size());
    if (error != RP_OK) return refuse(call, rp_error_text(error));
    pending_.clear();
  }
  // before the first step a result depends on nothing but the values set
  if (mode_ == Mode::initialization) rp_reset(contact_.get());
  return run_contact(call, time, time_step);
}

Status Instance::run_contact(const Call &call, double time, double time_step) {
  solution_ = Solution::none;
  direction_.clear();
  rp_message message = {};
  rp_error error = RP_OK;
  for (size_t i = 0; i < known_ && error == RP_OK; ++i) {
    const Variable &variable = *variables_[i].variable;
    if (variable.role == Role::input) put_input(input_, variable, at_[i]);
    if (variable.reference == reference::friction_coefficient)
      error = rp_set_friction_coefficient(contact_.get(), at_[i], &message);
  }
  input_.time_step = time_step;
  // at standstill nothing rolls on, whatever the distance
  input_.distance = mode_ == Mode::initialization || !(input_.rolling_speed > 0)
                        ? options_.distance
                        : input_.rolling_speed * time_step;
  if (error == RP_OK) {
    error = rp_step(contact_.get(), &input_, &outputs_.result, &message);
    // each input is in its range: what does not fit together, a creep force beyond friction, may
    // fit after a smaller step
    if (error == RP_ERROR_VALUE) {
      log_.say(Status::discard, Category::discard,
               std::string(call.name) + ": at time " + text_of(time) + " " + message.text +
                   ": take a smaller step or other inputs");
      return Status::discard;
    }
  }
  if (error != RP_OK)
    return refuse(call, message.text[0] != '\0' ? message.text : rp_error_text(error));
  const rp_status status = outputs_.result.status;
  if (status == RP_NOT_CONVERGED || status == RP_OUT_OF_RANGE) {
    log_.say(Status::discard, Category::discard,
             std::string(call.name) + ": " + failure(time, outputs_.result));
    return Status::discard;
  }
  warn(time);
  set_rest_temperature(outputs_, input_);
  solution_ = Solution::held;
  return Status::ok;
}

bool Instance::absent(const Variable &variable) const {
  if (!wheels_ || variable.patch == 0) return false;
  return variable.patch > outputs_.result.side[variable.side - 1].patch_count;
}

void Instance::publish() {
  for (size_t i = known_; i < values_.size(); ++i) {
    const Variable &variable = *variables_[i].variable;
    if (variable.role != Role::output) continue;
    values_[i] = absent(variable) ? rest_of(outputs_, variable) : output_of(outputs_, variable);
  }
  solved_ = at_;
  changed_ = false;
  largest_known_ = false;
}

std::string Instance::failure(double time, const rp_result &result) const {
  std::string where;
  for (int side = 0; wheels_ && side < 2; ++side)
    if (result.side[side].status == result.status)
      where += side == RP_LEFT ? " (left wheel)" : " (right wheel)";
  std::string why = rp_reason_text(result.reason);
  if (!std::isnan(result.reason_value)) why += " (" + text_of(result.reason_value) + ")";
  const std::string at = "at time " + text_of(time);
  if (result.status == RP_NOT_CONVERGED)
    return at + " the contact did not converge" + where + ", as " + why +
           ". Take a smaller step, or make the FMU of another scene";
  return at + " the contact is out of its range of validity" + where + ", as " + why +
         ". Take a smaller step or smaller inputs, or make the FMU of another scene";
}

// What can hardly be meant, each once.
void Instance::warn(double time) {
  const uint32_t fresh = outputs_.result.warnings & ~warned_;
  warned_ |= fresh;
#define RP_WARN(name, value, text)      \
  if (fresh & (uint32_t{1} << (value))) \
    log_.say(Status::warning, Category::warning, "at time " + text_of(time) + " " text);
  RP_WARNINGS(RP_WARN)
#undef RP_WARN
}

// --- values ------------------------------------------------------------------------------------

int Instance::index_of(Reference reference) const {
  return reference < index_.size() ? index_[reference] : -1;
}

int Instance::find(const Call &call, Type type, Reference reference) {
  const int index = index_of(reference);
  const auto at = static_cast<size_t>(index);
  if (index >= 0 && among(variables_[at].variable->type, type)) return index;
  refuse(call, index < 0 ? "there is no variable with value reference " + text_of_whole(reference)
                         : variables_[at].name + " is not of this type");
  return -1;
}

template <class T>
Status Instance::get(const Call &call, Type type, const Reference *references, size_t count,
                     T *values) {
  if (count > 0 && (references == nullptr || values == nullptr))
    return refuse(call, references == nullptr ? "vr is NULL" : "value is NULL");
  bool of_output = false, of_largest = false;
  for (size_t i = 0; i < count; ++i) {
    const int index = find(call, type, references[i]);
    if (index < 0) return Status::error;
    const SceneVariable &item = variables_[static_cast<size_t>(index)];
    if (item.variable->role == Role::independent) values_[static_cast<size_t>(index)] = time_;
    if (item.variable->role == Role::output && mode_ == Mode::instantiated)
      return refuse(call, item.name + " is an output, which there is from initialization mode on");
    of_output |= item.variable->role == Role::output;
    of_largest |= references[i] == reference::largest_step;
  }
  if (of_output && changed_ && follows()) {
    const Status status = solve(call);
    if (status != Status::ok) return status;
  }
  const bool of_failed = mode_ == Mode::step_failed || mode_ == Mode::terminated;
  if (of_largest && !largest_known_ && (solution_ != Solution::none || of_failed)) {
    const Status status = find_largest_step(call);
    if (status != Status::ok) return status;
  }
  for (size_t i = 0; i < count; ++i)
    values[i] = static_cast<T>(values_[static_cast<size_t>(index_of(references[i]))]);
  return Status::ok;
}

bool Instance::settable(const Call &call, int index, double value) {
  const SceneVariable &item = variables_[static_cast<size_t>(index)];
  const Variable &variable = *item.variable;
  if (variable.role != Role::input && variable.role != Role::parameter) {
    const char *what = variable.role == Role::output     ? " is an output"
                       : variable.role == Role::constant ? " is a constant"
                                                         : " is the independent variable";
    refuse(call, item.name + what);
    return false;
  }
  if (mode_ == Mode::continuous && !is_input(variable)) {
    refuse(call, item.name + " is a parameter, which may be set in event mode");
    return false;
  }
  if (variable.fixed && mode_ != Mode::instantiated && mode_ != Mode::initialization) {
    refuse(call, item.name + " is fixed: it may be set before and in initialization mode only");
    return false;
  }
  return in_range(call, index, value);
}

bool Instance::in_range(const Call &call, int index, double value) {
  const SceneVariable &item = variables_[static_cast<size_t>(index)];
  const Variable &variable = *item.variable;
  if (variable.reference == reference::direction && value == 0) {
    refuse(call, item.name + " is 0, allowed -1 and 1");
    return false;
  }
  if (item.held && value != 0) {
    refuse(call, item.name + " is " + text_of(value) + ", allowed 0: it is without effect");
    return false;
  }
  // a profile must be one of those that are there
  const bool choice = variable.fixed && variable.type == Type::enumeration;
  const double high = choice ? profile_count(variable) : variable.high;
  if (value >= variable.low && value <= high) return true;
  const std::string unit = *variable.unit == '\0' ? "" : std::string(" ") + variable.unit;
  refuse(call, item.name + " is " + text_of(value) + ", allowed " + text_of(variable.low) +
                   " ... " + text_of(high) + unit);
  return false;
}

template <class T>
Status Instance::set(const Call &call, Type type, const Reference *references, size_t count,
                     const T *values) {
  if (count > 0 && (references == nullptr || values == nullptr))
    return refuse(call, references == nullptr ? "vr is NULL" : "value is NULL");
  for (size_t i = 0; i < count; ++i) {
    const int index = find(call, type, references[i]);
    if (index < 0 || !settable(call, index, static_cast<double>(values[i]))) return Status::error;
  }
  for (size_t i = 0; i < count; ++i)
    values_[static_cast<size_t>(index_of(references[i]))] = static_cast<double>(values[i]);
  changed_ = changed_ || count > 0;
  // its mass and inertia may be among them
  if (count > 0) largest_known_ = false;
  return Status::ok;
}

template Status Instance::get(const Call &, Type, const Reference *, size_t, double *);
template Status Instance::get(const Call &, Type, const Reference *, size_t, int32_t *);
template Status Instance::get(const Call &, Type, const Reference *, size_t, int64_t *);
template Status Instance::get(const Call &, Type, const Reference *, size_t, bool *);
template Status Instance::set(const Call &, Type, const Reference *, size_t, const double *);
template Status Instance::set(const Call &, Type, const Reference *, size_t, const int32_t *);
template Status Instance::set(const Call &, Type, const Reference *, size_t, const int64_t *);
template Status Instance::set(const Call &, Type, const Reference *, size_t, const bool *);

}  // namespace railpatch::fmu
