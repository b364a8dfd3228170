// One instance of the FMU: its mode, time, values of all variables, and the contact behind them.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "calls.hpp"
#include "log.hpp"
#include "outputs.hpp"
#include "profile_file.hpp"
#include "railpatch.h"
#include "scene.hpp"
#include "snapshot.hpp"
#include "types.hpp"

namespace railpatch::fmu {

class Instance {
 public:
  // Null where it cannot be made; the log then says why.
  static std::unique_ptr<Instance> create(const Making &making, Interface interface,
                                          const char *token, const char *location, Log log);

  Log &log() { return log_; }
  // False, with a message, where the state does not allow the call.
  bool allows(const Call &call);
  Status refuse(const Call &call, const std::string &why);

  Status setup(const Call &call, bool tolerance_defined, double tolerance, double start,
               bool stop_defined, double stop);
  Status enter_initialization();
  Status exit_initialization(const Call &call);
  Status terminate(const Call &call);
  Status reset();
  Status step(const Call &call, double time, double step);
  Status go_to(Mode mode);  // event and continuous-time mode
  Status set_time(const Call &call, double time);

  template <class T>
  Status get(const Call &call, Type type, const Reference *references, size_t count, T *values);
  template <class T>
  Status set(const Call &call, Type type, const Reference *references, size_t count,
             const T *values);

  // texts that stay as long as the instance
  Status get_text(const Call &call, const Reference *references, size_t count, const char **values);
  Status set_text(const Call &call, const Reference *references, size_t count,
                  const char *const *values);

  // FMI 3.0: the components of arrays, into flat()
  Status flatten(const Call &call, Type type, const Reference *references, size_t count,
                 size_t value_count);
  // of unknowns and knowns
  Status flatten_both(const Call &call, const Reference *const (&lists)[2],
                      const size_t (&counts)[2], const size_t (&values)[2],
                      std::vector<Reference> (&flat)[2]);
  const std::vector<Reference> &flat() const { return flat_; }

  Status directional_derivative(const Call &call, const Reference *unknown, size_t unknown_count,
                                const Reference *known, size_t known_count, const double *seed,
                                double *change);
  // seed: of the unknowns; sensitivity: of the knowns, one solve for each of these
  Status adjoint_derivative(const Call &call, const std::vector<Reference> &unknown,
                            const std::vector<Reference> &known, const double *seed,
                            double *sensitivity);
  Status set_input_derivatives(const Call &call, const Reference *references, size_t count,
                               const int32_t *orders, const double *values);
  Status output_derivatives(const Call &call, const Reference *references, size_t count,
                            const int32_t *orders, double *values);

  Status get_state(const Call &call, StateHandle *state);
  Status set_state(const Call &call, StateHandle state);
  Status free_state(const Call &call, StateHandle *state);
  Status state_size(const Call &call, StateHandle state, size_t *size);
  Status serialize(const Call &call, StateHandle state, unsigned char *bytes, size_t size);
  Status deserialize(const Call &call, const unsigned char *bytes, size_t size, StateHandle *state);

  double time() const { return time_; }
  Status last_step() const { return mode_ == Mode::step_failed ? Status::discard : Status::ok; }

 private:
  struct Destroy {
    void operator()(rp_contact *contact) const { rp_destroy(contact); }
  };
  using Contact = std::unique_ptr<rp_contact, Destroy>;
  // numbers of the wheel's and the rail's, from 1, and those of the files by ProfileFiles, 0: none
  using Profiles = std::array<double, 6>;
  explicit Instance(Log log) : log_(std::move(log)) {}

  // The contact's last solution: none that belongs to the outputs, one that a restored state was
  // made of but does not hold, or the one that the contact holds.
  enum class Solution : uint32_t { none, lost, held };
  static constexpr size_t orders = 3;  // of input derivatives

  // index in values_, or -1
  int index_of(Reference reference) const;
  int find(const Call &call, Type type, Reference reference);
  // finds a Real input, one that derivatives are taken by, or a Real output that has derivatives
  int find_input(const Call &call, Reference reference);
  int find_known(const Call &call, Reference reference);
  int find_output(const Call &call, Reference reference);
  int find_unknown(const Call &call, Reference reference);
  // friction may be one: options_.friction_input
  bool is_input(const Variable &variable) const {
    return variable.role == Role::input ||
           (options_.friction_input != 0 && variable.reference == reference::friction_coefficient);
  }
  bool settable(const Call &call, int index, double value);
  bool in_range(const Call &call, int index, double value);
  bool index_arrays(const std::vector<SceneArray> &arrays);
  Status append(const Call &call, Type type, const Reference *references, size_t count,
                size_t value_count, std::vector<Reference> &flat);
  bool index_variables();  // false: they do not belong together
  void start_values();
  // outputs follow the inputs at once
  bool follows() const {
    return mode_ == Mode::initialization || mode_ == Mode::event || mode_ == Mode::continuous;
  }
  // Solves at the values set and publishes the outputs.
  Status solve(const Call &call);
  // Solves at at_; the outputs stay.
  Status advance(const Call &call, double time, double time_step);
  Status run_contact(const Call &call, double time, double time_step);
  std::string failure(double time, const rp_result &result) const;
  void warn(double time);
  // of a patch that the last solve did not have
  bool absent(const Variable &variable) const;
  void publish();
  Status extrapolate(const Call &call, double time, double past);
  void end_inputs(bool moving, double step);
  int step_count(bool moving) const;
  Status march(const Call &call, double time, double step);
  // Solves what the outputs belong to; the next step starts from the state as it was.
  Status keep_state(const Call &call);
  Status take_back(const Call &call, Solution solution);
  Status solve_again(const Call &call);
  // Sees to it that the contact holds the outputs' solution.
  Status hold_solution(const Call &call);
  Status differentiate(const Call &call, const std::vector<double> &rates);
  double rate_of(Reference reference) const;
  Status find_largest_step(const Call &call);
  double profile_count(const Variable &variable) const;
  // Numbers of the profiles among values of all inputs and parameters.
  Profiles profiles_of(const std::vector<double> &values) const;
  Status make_contact(const Call &call, const Profiles &profiles, const ProfileFiles &files,
                      Contact &made);
  // place in ProfileFiles of a variable that names a file
  static size_t place_of_file(const Variable &variable);
  Status load_profile(const Call &call, const SceneVariable &item, const char *path,
                      ProfileFile &file);
  void take_files(const ProfileFiles &files);
  // Makes the contact anew where other profiles were chosen.
  Status take_profiles(const Call &call);
  std::vector<double> saved_numbers() const;
  size_t number_count() const { return values_.size() + (2 + orders) * known_; }
  Status give_handle(const Call &call, std::unique_ptr<Snapshot> snapshot, StateHandle *state);
  Snapshot *known(StateHandle state) const;

  Log log_;
  std::vector<SceneVariable> variables_;
  std::vector<std::unique_ptr<Variable>> constants_;  // of them, those that no table knows
  std::vector<int16_t> index_;                        // by value reference, -1: not in this scene
  std::vector<uint32_t> extent_;  // of variables: components of an array, 0: in the array before
  std::vector<Reference> flat_;   // components of a call's arrays
  uint64_t content_ = 0;          // tells this FMU's states from those of another
  int version_ = 2;               // of FMI
  Interface interface_ = Interface::co_simulation;
  Options options_;
  bool wheels_ = false, derivatives_ = false, with_z_ = false;
  // degrees C, where they are no inputs; NaN: the scene has none
  double bulk_[2] = {std::numeric_limits<double>::quiet_NaN(),
                     std::numeric_limits<double>::quiet_NaN()};
  size_t known_ = 0;  // number of inputs and parameters, which come first
  std::vector<std::pair<size_t, size_t>> means_;  // mean over a step, and what it is the mean of
  std::string table_;                   // of creep forces, which the contact uses in place
  std::unique_ptr<Scene> scene_;        // kept where profiles can be chosen, else null
  Profiles made_ = {1, 1, 0, 0, 0, 0};  // those of the contact
  ProfileFiles files_;                  // those that were set
  Contact contact_;
  rp_input input_ = {};     // of the last solve
  Outputs outputs_ = {};    // of the last solve
  std::vector<double> at_;  // inputs and parameters of the solve to come
  // the state to come back to, where the contact was brought to another one for derivatives
  std::vector<unsigned char> pending_;
  // of the contact, before the step that is made (FMI 3.0)
  std::vector<unsigned char> before_;
  // the last direction, and what it gave
  std::vector<double> direction_;
  Outputs change_ = {};
  std::vector<std::unique_ptr<Snapshot>> snapshots_;

  // what a snapshot carries, besides the contact's own state
  Mode mode_ = Mode::instantiated;
  double time_ = 0, start_ = 0, stop_ = 0;
  bool stop_defined_ = false;
  bool largest_known_ = false;  // the largest step, which is found where it is read
  uint32_t warned_ = 0;         // warnings that were told
  bool changed_ = true;         // an input or parameter was set after the last solve
  Solution solution_ = Solution::none;
  std::vector<double> values_;
  std::vector<double> solved_;             // inputs and parameters of the outputs
  std::vector<double> rates_;              // of the inputs, at the end of the last step
  std::vector<double> input_derivatives_;  // for the next step, orders of them for each input
};

}  // namespace railpatch::fmu
