// The host may round differently, flush small numbers to zero or trap exceptions. A solve runs in
// the default environment, and the host finds its own again.
#pragma once

#include <cfenv>

namespace railpatch::fmu {

class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint() {
    std::fegetenv(&host_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatingPoint() { std::fesetenv(&host_); }
  DefaultFloatingPoint(const DefaultFloatingPoint &) = delete;
  DefaultFloatingPoint &operator=(const DefaultFloatingPoint &) = delete;

 private:
  std::fenv_t host_;
};

}  // namespace railpatch::fmu
