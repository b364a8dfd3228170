// What a step through the FMU's functions costs beyond that of the core: all inputs set, one step,
// all outputs read, beside rp_step with the same inputs. Prints medians in microseconds, or with a
// scene's name and a number of steps just makes these, to be counted by valgrind (overhead.py).
#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "made_fmu.hpp"

namespace {

using clock_type = std::chrono::steady_clock;

double microseconds(clock_type::time_point begin) {
  return std::chrono::duration<double, std::micro>(clock_type::now() - begin).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class Run {
 public:
  explicit Run(const made::scene &s, bool apart)
      : slave_(made::write(s)), contact_(s.config), wheels_(s.config.kind != RP_PATCH) {
    for (const made::variable &v : s.variables) {
      if (v.reference == made::direction || v.reference == made::substeps) continue;
      if (v.reference > 40) {
        outputs_.push_back(v.reference);
        continue;
      }
      inputs_.push_back(v.reference);
      values_.push_back(apart && v.reference == made::height ? -1e-3 : v.start);
    }
    results_.resize(outputs_.size());
    in_ = wheels_ ? scenes::running(RP_RAIL) : scenes::patch_input(1e5, 1e-3, 0, 0.1);
    in_.z = apart ? -1e-3 : 2e-4;
    in_.rolling_speed = 20;
    slave_.initialize();
  }

  size_t inputs() const { return inputs_.size(); }
  size_t outputs() const { return outputs_.size(); }

  void by_fmu(int k) {
    values_[wheels_ ? 0 : 1] = moved(k);
    bool good = fmi2SetReal(slave_.get(), inputs_.data(), inputs_.size(), values_.data()) == fmi2OK;
    good = good && slave_.step(1e-3) == fmi2OK;
    good = good &&
           fmi2GetReal(slave_.get(), outputs_.data(), outputs_.size(), results_.data()) == fmi2OK;
    if (!good) std::abort();
  }
  void by_core(int k) {
    (wheels_ ? in_.y : in_.creepage[0]) = moved(k);
    rp_result result;
    if (rp_step(contact_.get(), &in_, &result, nullptr) != RP_OK) std::abort();
  }

 private:
  double moved(int k) const { return (wheels_ ? 1e-3 : 2e-3) * std::sin(0.05 * k); }

  made::slave slave_;
  scenes::handle contact_;
  bool wheels_;
  std::vector<fmi2ValueReference> inputs_, outputs_;
  std::vector<double> values_, results_;
  rp_input in_;
};

void print(const made::scene &s, bool apart, int steps) {
  Run run(s, apart);
  std::vector<double> fmu, core;
  for (int k = 0; k < steps; ++k) {
    auto begin = clock_type::now();
    run.by_fmu(k);
    fmu.push_back(microseconds(begin));
    begin = clock_type::now();
    run.by_core(k);
    core.push_back(microseconds(begin));
  }
  std::printf("%-8s %-8s %3zu inputs %3zu outputs: %8.2f us, core %8.2f us, beyond %6.2f us\n",
              s.name.c_str(), apart ? "apart" : "contact", run.inputs(), run.outputs(), median(fmu),
              median(core), median(fmu) - median(core));
}

}  // namespace

int main(int count, char **arguments) {
  const scenes::profile_pair pair;
  for (made::scene &s : made::scenes_of(pair)) {
    if (s.name != "patch" && s.name != "rail") continue;
    if (s.name == "rail") s.config.element_size[0] = s.config.element_size[1] = 1e-3;
    if (count > 2) {
      if (s.name != arguments[1]) continue;
      Run run(s, false);
      for (int k = 0; k < std::atoi(arguments[2]); ++k) run.by_fmu(k);
      return 0;
    }
    print(s, false, 1000);
    if (s.name == "rail") print(s, true, 20000);
  }
  return 0;
}
