// One instance of the FMU: its mode, time, values of all variables, and the contact behind them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calls.hpp"
#include "fmi2FunctionTypes.h"
#include "log.hpp"
#include "railpatch.h"
#include "scene.hpp"
#include "snapshot.hpp"

namespace railpatch::fmu {

class Instance {
 public:
  // Null where it cannot be made; the log then says why.
  static std::unique_ptr<Instance> create(const char *guid, const char *location, Log log);

  Log &log() { return log_; }
  // False, with a message, where the state does not allow the call.
  bool allows(const Call &call);
  fmi2Status refuse(const Call &call, const std::string &why);

  fmi2Status setup(bool tolerance_defined, double tolerance, double start, bool stop_defined,
                   double stop);
  fmi2Status enter_initialization();
  fmi2Status exit_initialization();
  fmi2Status terminate();
  fmi2Status reset();
  fmi2Status step(double time, double step);

  template <class T>
  fmi2Status get(const Call &call, Type type, const fmi2ValueReference *references, size_t count,
                 T *values);
  template <class T>
  fmi2Status set(const Call &call, Type type, const fmi2ValueReference *references, size_t count,
                 const T *values);

  fmi2Status get_state(fmi2FMUstate *state);
  fmi2Status set_state(fmi2FMUstate state);
  fmi2Status free_state(fmi2FMUstate *state);
  fmi2Status state_size(fmi2FMUstate state, size_t *size);
  fmi2Status serialize(fmi2FMUstate state, fmi2Byte *bytes, size_t size);
  fmi2Status deserialize(const fmi2Byte *bytes, size_t size, fmi2FMUstate *state);

  double time() const { return time_; }
  fmi2Status last_step() const { return mode_ == Mode::step_failed ? fmi2Discard : fmi2OK; }

 private:
  struct Destroy {
    void operator()(rp_contact *contact) const { rp_destroy(contact); }
  };
  explicit Instance(Log log) : log_(std::move(log)) {}

  // index in values_, or -1
  int index_of(fmi2ValueReference reference) const;
  int find(const Call &call, Type type, fmi2ValueReference reference);
  bool settable(const Call &call, int index, double value);
  void start_values();
  fmi2Status solve(const Call &call, double time);
  std::string failure(double time, const rp_result &result) const;
  void take(rp_result &result);
  fmi2Status give_handle(const Call &call, std::unique_ptr<Snapshot> snapshot, fmi2FMUstate *state);
  Snapshot *known(fmi2FMUstate state) const;

  Log log_;
  std::vector<SceneVariable> variables_;
  std::vector<int16_t> index_;  // by value reference, -1: not in this scene
  uint64_t content_ = 0;        // tells this FMU's states from those of another
  bool wheels_ = false;
  std::string table_;  // of creep forces, which the contact uses in place
  std::unique_ptr<rp_contact, Destroy> contact_;
  rp_input input_ = {};
  std::vector<std::unique_ptr<Snapshot>> snapshots_;

  // what a snapshot carries, besides the contact's own state
  Mode mode_ = Mode::instantiated;
  double time_ = 0, start_ = 0, stop_ = 0;
  bool stop_defined_ = false;
  bool changed_ = true;  // an input or parameter was set after the last solve
  std::vector<double> values_;
};

}  // namespace railpatch::fmu
