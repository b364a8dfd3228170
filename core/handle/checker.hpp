// Ranges of numbers, and what remembers the first field that is out of its own: for check.cpp,
// check_fast.cpp and check_wheels.cpp.
#pragma once

#include <cstdio>
#include <cstring>
#include <limits>
#include <type_traits>

#include "handle/case_fields.hpp"
#include "handle/check.hpp"

namespace railpatch {

inline constexpr double inf = std::numeric_limits<double>::infinity();

// of what is no member by itself, or has another range where a condition holds
inline constexpr range positive{0, inf, true, true};
inline constexpr range finite{-inf, inf, true, true};
inline constexpr range only_one{1, 1, false, false};  // of a line contact
inline constexpr range friction = config_range::friction_coefficient;

// Remembers the first field that is out of range.
class checker {
 public:
  explicit checker(rp_message *message) : message_(message) {}

  void number(const char *name, double value, const range &r) {
    if (failed_ || inside(value, r)) return;
    failed_ = true;
    set_message(message_, "%s is %g, allowed is %c%g, %g%c", name, value, r.open_low ? '(' : '[',
                r.low, r.high, r.open_high ? ')' : ']');
  }
  void numbers(const char *name, const double *values, int count, const range &r) {
    for (int i = 0; i < count && !failed_; ++i) {
      // a step has no time to spell names of what is in range
      if (!inside(values[i], r)) element(name, i, values[i], r);
    }
  }
  void integer(const char *name, int value, int low, int high) {
    if ((value >= low && value <= high) || failed_) return;
    failed_ = true;
    set_message(message_, "%s is %d, allowed is %d ... %d", name, value, low, high);
  }
  // a member with its listed range, by what it is; rows of arrays by their last index
  template <class T>
  void field(const char *name, const T &value, const range &r) {
    if constexpr (std::is_enum_v<T>) {
      choice(name, value, choice_count<T>);
    } else if constexpr (std::is_same_v<T, double>) {
      number(name, value, r);
    } else if constexpr (std::is_same_v<T, int32_t>) {
      integer(name, value, static_cast<int>(r.low), static_cast<int>(r.high));
    } else if constexpr (std::rank_v<T> > 1) {
      for (const auto &row : value) field(name, row, r);
    } else if constexpr (std::is_same_v<T, double[std::extent_v<T>]>) {
      numbers(name, value, static_cast<int>(std::extent_v<T>), r);
    } else if constexpr (std::is_array_v<T>) {
      for (size_t i = 0; i < std::extent_v<T> && !failed_; ++i)
        element(name, static_cast<int>(i), value[i], r);
    }
  }
  // an enumeration: looked at as a number, since a value outside it must not be read as one
  template <class E>
  void choice(const char *name, const E &value, int count) {
    static_assert(sizeof(E) == sizeof(int));
    int number;
    std::memcpy(&number, &value, sizeof number);
    integer(name, number, 0, count - 1);
  }
  void require(bool condition, const char *text) {
    if (condition || failed_) return;
    failed_ = true;
    set_message(message_, "%s", text);
  }
  rp_error error() const { return failed_ ? RP_ERROR_VALUE : RP_OK; }

 private:
  template <class T>
  void element(const char *name, int index, const T &value, const range &r) {
    char label[64];
    std::snprintf(label, sizeof label, "%s[%d]", name, index);
    field(label, value, r);
  }
  static bool inside(double value, const range &r) {
    return (r.open_low ? value > r.low : value >= r.low) &&
           (r.open_high ? value < r.high : value <= r.high);
  }

  rp_message *message_;
  bool failed_ = false;
};

inline bool has_tangential(const rp_config &c) {
  return c.regime != RP_REGIME_NONE && c.tangential != RP_TANGENTIAL_NONE;
}

// The grid given has only one or two elements either way.
inline bool has_strips(const rp_config &c) {
  return c.kind == RP_PATCH && c.geometry == RP_UNDEFORMED_DISTANCE &&
         (c.distance_shape[0] < 3 || c.distance_shape[1] < 3);
}

// Viscoelastic bodies.
void check_viscous(const rp_config &c, checker &check);
// Influence coefficients that are given, and how many there are.
void check_own_influence(const rp_config &c, checker &check);
size_t count_of_own_influence(const rp_config &c);
// Shift and transient rolling, and regimes that change.
void check_regime(const rp_config &c, checker &check);
// The regime of a step, an rp_regime, and what it may be.
int regime_of(const rp_config &c, const rp_input &in);
void check_step_regime(const rp_config &c, const rp_input &in, checker &check);
// A rigid slip of each element of a step.
void check_slip_field(const rp_config &c, const rp_input &in, checker &check);
// What only some of the fast theories read must not be set for others.
void check_fast(const rp_config &c, checker &check);
// Which theories follow a law beside Coulomb's; grid: the full theory on the uniform grid.
void check_law_of_theory(const rp_config &c, bool grid, checker &check);
// What wheels, rails and rollers have beside the rest.
void check_wheels(const rp_config &c, checker &check);
// What goes with a curved reference surface.
void check_reference(const rp_config &c, checker &check);
// Of bodies that the contacts' heat warms.
void check_stored_heat(const rp_config &c, checker &check);
// Of a liquid between wheel and rail.
void check_fluid(const rp_config &c, checker &check);
void check_fluid(const rp_config &c, const rp_input &in, checker &check);
void check_balance(const rp_config &c, checker &check);
void check_max_work(const rp_config &c, checker &check);

}  // namespace railpatch
