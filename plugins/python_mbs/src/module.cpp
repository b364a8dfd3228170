// The module railpatch._core: one class around rp_contact. No physics, no checks of values.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "below.hpp"
#include "convert.hpp"
#include "elementary.hpp"
#include "fast/theories.hpp"
#include "force_element.hpp"
#include "lists.hpp"
#include "moves.hpp"
#include "outcome.hpp"
#include "railpatch.h"
#include "timing.hpp"
#include "vehicle.hpp"
#include "watching.hpp"

namespace railpatch::python {

namespace {

using FieldArray = nb::ndarray<nb::numpy, double, nb::ndim<1>>;
// bytes of structs after each other
using Records = nb::ndarray<nb::numpy, uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

// the lock keeps one handle to one thread at a time, as railpatch.h asks for, while the
// interpreter's lock is released
class Contact : public Steppable {
 public:
  Contact(const nb::dict &config, bool timing) {
    Config c;
    fill_config(config, c);
    table_ = c.table;
    slip_.of(c.values);
    if (timing) {
      c.values.observer = StageClock::observe;
      c.values.observer_user = &clock_;
    }
    c.values.interrupt = Signals::ask;
    c.values.interrupt_user = &signals_;
    rp_message message = {};
    rp_contact *contact = nullptr;
    check(rp_create(&c.values, &contact, &message), &message);
    contact_.reset(contact);
  }

  nb::dict step(const nb::dict &values) {
    rp_input input;
    rp_default_input(&input);
    fill_input(values, input);
    slip_.fill(values, input);
    rp_result result;
    step_once(input, result);
    return result_dict(result);
  }

  // step(), whose input step_moved() then goes on from
  std::unique_ptr<Outcome> step_from(const nb::dict &values) {
    rp_input input;
    rp_default_input(&input);
    fill_input(values, input);
    slip_.fill(values, input);
    auto outcome = std::make_unique<Outcome>();
    step_once(input, outcome->values);
    moves_.start(input);
    return outcome;
  }

  // the last input of these with some numbers changed; null, and nothing is done, for a change
  // that is not among those allowed
  std::unique_ptr<Outcome> step_moved(const nb::dict &changes) {
    rp_input input;
    if (!moves_.moved(changes, input)) return nullptr;
    auto outcome = std::make_unique<Outcome>();
    step_once(input, outcome->values);
    moves_.start(input);
    return outcome;
  }

  void allow(const nb::dict &moves) { moves_.allow(moves); }
  nb::object moved(const char *name) const { return moves_.now(name); }

  nb::tuple differentiate(const nb::dict &rates) {
    rp_input direction;
    rp_default_direction(&direction);
    fill_input(rates, direction);
    rp_result change;
    rp_derivative_kind kind = RP_DERIVATIVE_EXACT;
    rp_message message = {};
    rp_error code = RP_OK;
    {
      nb::gil_scoped_release unlocked;
      std::lock_guard<std::mutex> guard(mutex_);
      const Signals::Watch watch(signals_);
      code = rp_differentiate(contact_.get(), &direction, &change, &kind, &message);
    }
    raise(code, message);
    return nb::make_tuple(result_dict(change), kind == RP_DERIVATIVE_EXACT);
  }

  nb::dict jacobian() {
    rp_jacobian found;
    rp_message message = {};
    rp_error code = RP_OK;
    {
      nb::gil_scoped_release unlocked;
      std::lock_guard<std::mutex> guard(mutex_);
      const Signals::Watch watch(signals_);
      code = rp_get_jacobian(contact_.get(), &found, &message);
    }
    raise(code, message);
    return jacobian_dict(found);
  }

  void solve(const rp_input &input, rp_result &result) override {
    rp_message message = {};
    std::lock_guard<std::mutex> guard(mutex_);
    check(rp_step(contact_.get(), &input, &result, &message), &message);
  }

  void differentiate_all(rp_jacobian &found) override {
    rp_message message = {};
    std::lock_guard<std::mutex> guard(mutex_);
    check(rp_get_jacobian(contact_.get(), &found, &message), &message);
  }

  rp_status differentiate_column(size_t column, double found[2][6]) override {
    rp_input d;
    rp_default_direction(&d);
    double *const numbers[] = {&d.x,     &d.y,  &d.z,  &d.roll,      &d.yaw,      &d.pitch,
                               &d.speed, &d.vy, &d.vz, &d.roll_rate, &d.yaw_rate, &d.pitch_rate};
    *numbers[column] = 1.0;
    rp_result change;
    rp_derivative_kind kind = RP_DERIVATIVE_EXACT;
    rp_message message = {};
    std::lock_guard<std::mutex> guard(mutex_);
    check(rp_differentiate(contact_.get(), &d, &change, &kind, &message), &message);
    for (size_t side = 0; side < 2; ++side) {
      std::copy_n(change.side[side].force, 3, found[side]);
      std::copy_n(change.side[side].moment, 3, found[side] + 3);
    }
    return change.status;
  }

  size_t read_field(int side, int patch, rp_field field, std::vector<double> &to) override {
    std::lock_guard<std::mutex> guard(mutex_);
    double none = 0.0;
    size_t count = 0;
    if (rp_get_field(contact_.get(), side, patch, field, &none, &count) != RP_ERROR_SIZE) return 0;
    to.resize(std::max(to.size(), count));
    return rp_get_field(contact_.get(), side, patch, field, to.data(), &count) == RP_OK ? count : 0;
  }

  // Records of rp_input to as many of what `slices` take of an rp_result: (from, bytes, to), in
  // bytes of both records. Raises StateError with the place of a wrong input.
  static void step_many(const nb::list &all, const Records &inputs, size_t length,
                        const Records &outputs, const nb::list &slices, size_t width) {
    const std::vector<Contact *> contacts = contacts_of(all);
    const size_t count = inputs.shape(0) / sizeof(rp_input);
    if (contacts.empty() || length == 0 || count % length != 0 ||
        inputs.shape(0) != count * sizeof(rp_input) || outputs.shape(0) != count * width)
      throw nb::value_error("step_many: records of another size");
    const std::vector<Slice> parts = slices_of(slices, width);
    const auto *from = reinterpret_cast<const rp_input *>(inputs.data());
    // few at once stay where the processor has them at hand; threads want more to begin with
    const size_t few = contacts.size() > 1 ? 512 * contacts.size() : 64;
    const size_t at_once = std::max<size_t>(1, few / length) * length;
    std::vector<rp_result> results(std::min(at_once, count));
    rp_message message = {};
    rp_error code = RP_OK;
    size_t wrong = count;
    {
      nb::gil_scoped_release unlocked;
      std::vector<std::unique_lock<std::mutex>> guards;
      std::vector<rp_contact *> handles;
      for (Contact *one : contacts) {
        guards.emplace_back(one->mutex_);
        handles.push_back(one->contact_.get());
      }
      // the caller's thread asks for all
      const Signals::Watch watch(contacts[0]->signals_);
      for (size_t first = 0; first < count && code == RP_OK; first += at_once) {
        const size_t here = std::min(at_once, count - first);
        size_t place = here;
        code = rp_step_many(handles.data(), static_cast<int32_t>(handles.size()), from + first,
                            here / length, length, results.data(), &place, &message);
        if (place < here) wrong = first + place;
        if (code != RP_OK) break;
        uint8_t *to = outputs.data() + first * width;
        for (size_t k = 0; k < here; ++k, to += width)
          for (const Slice &part : parts)
            std::memcpy(to + part.to, reinterpret_cast<const uint8_t *>(&results[k]) + part.from,
                        part.bytes);
      }
    }
    if (wrong < count) {
      nb::object type = nb::module_::import_("railpatch.errors").attr("StateError");
      PyErr_SetObject(type.ptr(), nb::make_tuple(wrong, nb::str(message.text)).ptr());
      throw nb::python_error();
    }
    raise(code, message);
  }

  // One of each, as step(): its fields can be asked for.
  void step_record(const Records &input, const Records &result) {
    if (input.shape(0) != sizeof(rp_input) || result.shape(0) != sizeof(rp_result))
      throw nb::value_error("step_record: a record of another size");
    step_once(*reinterpret_cast<const rp_input *>(input.data()),
              *reinterpret_cast<rp_result *>(result.data()));
  }

  nb::tuple time_steps(const nb::list &inputs, const nb::list &reset, int repeat,
                       bool processor_time) {
    timed_steps steps(inputs, reset, repeat, processor_time);
    {
      nb::gil_scoped_release unlocked;
      std::lock_guard<std::mutex> guard(mutex_);
      rp_message message = {};
      check(steps.run(contact_.get(), message), &message);
    }
    return steps.outcome();
  }

  std::optional<FieldArray> field(int side, int patch, const char *name) {
    const rp_field wanted = field_of(name);
    const Turn turn(mutex_);
    double none = 0.0;
    size_t count = 0;
    const rp_error code = rp_get_field(contact_.get(), side, patch, wanted, &none, &count);
    if (code == RP_ERROR_NO_FIELD) return std::nullopt;
    if (code != RP_ERROR_SIZE) check(code);
    std::unique_ptr<double[]> values(new double[count > 0 ? count : 1]);
    check(rp_get_field(contact_.get(), side, patch, wanted, values.get(), &count));
    double *data = values.get();
    nb::capsule owner(values.release(),
                      [](void *p) noexcept { delete[] static_cast<double *>(p); });
    return FieldArray(data, {count}, owner);
  }

  std::unique_ptr<Below> below(std::vector<double> depths, bool displacements, double dang_van) {
    const Turn turn(mutex_);
    return std::make_unique<Below>(contact_.get(), mutex_, std::move(depths), displacements,
                                   dang_van);
  }

  nb::bytes save() {
    const Turn turn(mutex_);
    std::string buffer(rp_state_size(contact_.get()), '\0');
    check(rp_save_state(contact_.get(), buffer.data(), buffer.size()));
    return nb::bytes(buffer.data(), buffer.size());
  }

  void restore(const nb::bytes &state) {
    const Turn turn(mutex_);
    check(rp_restore_state(contact_.get(), state.c_str(), state.size()));
  }

  void reset() {
    const Turn turn(mutex_);
    rp_reset(contact_.get());
  }

  nb::list describe() {
    const Turn turn(mutex_);
    rp_stage_info info[RP_STAGE_COUNT] = {};
    check(rp_describe(contact_.get(), info));
    return stage_list(info, clock_.seconds());
  }

 private:
  struct Destroy {
    void operator()(rp_contact *contact) const { rp_destroy(contact); }
  };

  struct Slice {
    size_t from, bytes, to;
  };

  static std::vector<Contact *> contacts_of(const nb::list &all) {
    std::vector<Contact *> contacts;
    for (const nb::handle one : all) contacts.push_back(nb::cast<Contact *>(one));
    return contacts;
  }

  static std::vector<Slice> slices_of(const nb::list &all, size_t width) {
    std::vector<Slice> slices;
    for (const nb::handle one : all) {
      const auto part = nb::cast<nb::tuple>(one);
      const Slice slice{nb::cast<size_t>(part[0]), nb::cast<size_t>(part[1]),
                        nb::cast<size_t>(part[2])};
      if (slice.from + slice.bytes > sizeof(rp_result) || slice.to + slice.bytes > width)
        throw nb::value_error("step_many: a slice outside the records");
      slices.push_back(slice);
    }
    return slices;
  }

  void step_once(const rp_input &input, rp_result &result) {
    rp_message message = {};
    rp_error code = RP_OK;
    {
      nb::gil_scoped_release unlocked;
      std::lock_guard<std::mutex> guard(mutex_);
      const Signals::Watch watch(signals_);
      code = rp_step(contact_.get(), &input, &result, &message);
    }
    raise(code, message);
  }

  // what a signal's handler raised, or what was wrong
  static void raise(rp_error code, const rp_message &message) {
    if (code == RP_ERROR_INTERRUPTED && PyErr_Occurred()) throw nb::python_error();
    check(code, &message);
  }

  Signals signals_;
  Moves moves_;
  SlipField slip_;
  Bytes table_;  // the contact uses it in place
  std::unique_ptr<rp_contact, Destroy> contact_;
  StageClock clock_;
  std::mutex mutex_;
};

// a wrong value is the caller's error, anything else is ours
void translate(const std::exception_ptr &pointer, void *) {
  try {
    std::rethrow_exception(pointer);
  } catch (const CallError &error) {
    switch (error.code) {
      case RP_ERROR_VALUE:
      case RP_ERROR_PROFILE:
      case RP_ERROR_STATE: {
        nb::object type = nb::module_::import_("railpatch.errors").attr("CaseError");
        PyErr_SetString(type.ptr(), error.text.c_str());
        break;
      }
      case RP_ERROR_MEMORY:
        PyErr_SetString(PyExc_MemoryError, error.text.c_str());
        break;
      default:
        PyErr_SetString(PyExc_RuntimeError, error.text.c_str());
    }
  }
}

// The core's table of fast theories, by name, and the theories that read each option.
void set_theories(nb::module_ &m) {
  nb::dict theories, readers;
  for (const fast_theory &theory : fast_theories()) {
    nb::dict row;
    row["tractions"] = theory.tractions;
    row["contact_blending"] = (theory.reads & reads_contact_blending) != 0;
    row["slip_law"] = (theory.reads & reads_slip_law) != 0;
    theories[theory.name] = row;
  }
  for (const option_key &option : option_keys()) {
    nb::list names;
    for (const fast_theory &theory : fast_theories())
      if (theory.reads & option.option) names.append(theory.name);
    readers[option.key] = nb::tuple(names);
  }
  m.attr("THEORIES") = theories;
  m.attr("THEORY_READERS") = readers;
}

}  // namespace

NB_MODULE(_core, m) {
  m.doc() = "The contact library of railpatch.h. Use railpatch.solve and railpatch.Contact.";
  nb::register_exception_translator(translate);

  m.def("version", &rp_version, "Version of the library.");
  m.def("fft_backend", &rp_fft_backend, "Name of the FFT library in use.");
  m.def("time_fft", &time_fft, nb::arg("size"), nb::arg("repeat"),
        "Seconds of each of `repeat` real transforms of size x size numbers: a measure of the "
        "machine, to carry run times over to another one.");

  m.def(
      "config_numbers",
      [](const nb::dict &config) {
        Config c;
        fill_config(config, c);
        return config_dict(c.values);
      },
      nb::arg("config"), "The plain fields of rp_config as lists of numbers, defaults filled in.");

  m.def(
      "reason_text",
      [](int reason, double value) { return reason_text(static_cast<rp_reason>(reason), value); },
      nb::arg("reason"), nb::arg("value"), "The text of an rp_reason with its number.");
  m.def("warning_texts", &warnings_of, nb::arg("bits"), "The texts of a mask of warnings.");
  m.def(
      "input_record",
      [](const nb::dict &values) {
        rp_input input;
        rp_default_input(&input);
        fill_input(values, input);
        return nb::bytes(reinterpret_cast<const char *>(&input), sizeof input);
      },
      nb::arg("input"), "The bytes of an rp_input, defaults where fields are left out.");

#define RAILPATCH_ENTRY(name, value, text) texts[nb::int_(value)] = text;
  nb::dict texts;
  RP_STATUSES(RAILPATCH_ENTRY)
  m.attr("STATUSES") = texts;
  texts = nb::dict();
  RP_ERRORS(RAILPATCH_ENTRY)
  m.attr("ERRORS") = texts;
#undef RAILPATCH_ENTRY
  set_theories(m);
  m.attr("CHOICES") = listed_choices();
  m.attr("QUANTITIES") = listed_quantities();
  m.attr("CONFIG_FIELDS") = listed_config();
  m.attr("INPUT_FIELDS") = listed_input();
  m.attr("PLAUSIBLE") = listed_ranges();
  m.attr("LAYOUTS") = layouts();

  bind_outcome(m);
  bind_below(m);
  nb::class_<Steppable>(m, "Steppable", "A contact that a force element may step.");
  nb::class_<Contact, Steppable>(m, "Contact", "A handle of the library with its state and memory.")
      .def(nb::init<const nb::dict &, bool>(), nb::arg("config"), nb::arg("timing") = false,
           "config: fields of rp_config, enumerations as texts; timing: measure each stage.")
      .def("step", &Contact::step, nb::arg("input"),
           "Solves for the fields of rp_input, defaults where left out, and returns rp_result. "
           "The interpreter's lock is released.")
      .def("step_from", &Contact::step_from, nb::arg("input"),
           "step(), to be read on demand; step_moved() goes on from its input.")
      .def("allow", &Contact::allow, nb::arg("moves"),
           "What step_moved() takes: name -> (offset in bytes in rp_input, numbers, bounds, low, "
           "high), as in LAYOUTS and INPUT_FIELDS.")
      .def("step_moved", &Contact::step_moved, nb::arg("changes"),
           "A step with some numbers of the last input changed; None, and nothing is done, where a "
           "change is not allowed, not finite or out of its bounds. The interpreter's lock is "
           "released.")
      .def("moved", &Contact::moved, nb::arg("name"), "A number, or numbers, of the last input.")
      .def("differentiate", &Contact::differentiate, nb::arg("rates"),
           "The rates of the last step's rp_result for rates of the fields of rp_input, zero where "
           "left out, and whether they are exact. The interpreter's lock is released.")
      .def("jacobian", &Contact::jacobian,
           "rp_jacobian of the last step, rows after each other. The interpreter's lock is "
           "released.")
      .def_static("step_many", &Contact::step_many, nb::arg("contacts"), nb::arg("inputs"),
                  nb::arg("length"), nb::arg("outputs"), nb::arg("slices"), nb::arg("width"),
                  "rp_step_many: bytes of rp_input to records of `width` bytes, which hold what "
                  "`slices`, a list of (from, bytes, to), take of an rp_result; on as many threads "
                  "as contacts. Raises StateError for a wrong input. The interpreter's lock is "
                  "released.")
      .def("step_record", &Contact::step_record, nb::arg("input"), nb::arg("result"),
           "Bytes of one rp_input to those of one rp_result. The interpreter's lock is released.")
      .def("time_steps", &Contact::time_steps, nb::arg("inputs"), nb::arg("reset"),
           nb::arg("repeat") = 1, nb::arg("processor_time") = false,
           "Steps through a list of inputs `repeat` times, each time forgetting the last solution "
           "before the inputs whose `reset` is true. Returns the seconds of each step [repeat, n], "
           "without Python's own, and the results of the last pass; processor_time: those of the "
           "processor where the system counts them, else by the wall's clock.")
      .def("field", &Contact::field, nb::arg("side"), nb::arg("patch"), nb::arg("name"),
           "A field of the last step as a flat array, x fastest; None where it does not exist.")
      .def("below", &Contact::below, nb::keep_alive<0, 1>(), nb::arg("depths"),
           nb::arg("displacements"), nb::arg("dang_van"),
           "Stresses below the surface at depths (m); displacements: these too.")
      .def("save", &Contact::save, "The state that later steps depend on, as bytes.")
      .def("restore", &Contact::restore, nb::arg("state"), "Brings back a saved state.")
      .def("reset", &Contact::reset, "Forgets the warm start.")
      .def("describe", &Contact::describe, "Stages with reason, bytes and measured seconds.");

  bind_elementary(m);
  bind_force_element(m);
  bind_suspension(m);
  bind_course(m);
  bind_means(m);
  bind_support(m);
  bind_drives(m);
  bind_wet_rails(m);
  bind_steps(m);
}

}  // namespace railpatch::python
