// The flags of cntc_setflags: code, allowed values, value by default.
#pragma once

#include <array>
#include <string>

namespace contact_addon {

enum flag_code {
  flag_units = 1933,
  flag_config = 1967,
  flag_sequence = 1970,    // P
  flag_bound = 1971,       // B
  flag_tangential = 1972,  // T
  flag_normal = 1973,      // N
  flag_force = 1974,       // F
  flag_friction = 1976,    // L, read only
  flag_patches = 1977,     // D
  flag_influence = 1978,   // C3
  flag_material = 1979,    // M, read only
  flag_extra_slip = 1980,  // E
  flag_xflow = 1981,
  flag_heat = 1982,   // H, read only
  flag_start = 1983,  // I
  flag_output = 1984,
  flag_flow = 1985,
  flag_return = 1986,
  flag_matfile = 1987,
  flag_sensitivity = 1988,
  flag_angle_method = 1989,
  flag_angle_variant = 1990,
  flag_block_output = 1991,
  flag_block_file = 1992,
  flag_most_elements = 1993,
  flag_debug = 2000,
  flag_licence = 2001,
  flag_write_input = 2002,
  flag_threads = 2003,
  flag_timers = 2004,
  flag_case = 2005
};

struct flag_rule {
  int code, least, most, start;
  bool ignored;      // values outside are left out, else the nearest is taken
  bool kept_by_low;  // 0 and 1: the value stays
  const char *name;
};

inline constexpr std::array<flag_rule, 26> flag_rules{{
    {flag_units, 1934, 1937, 1934, false, false, "units"},
    {flag_config, 0, 5, 1, false, false, "C1"},
    {flag_sequence, 0, 3, 2, false, false, "P"},
    {flag_bound, 0, 6, 0, false, false, "B"},
    {flag_tangential, 0, 3, 3, false, false, "T"},
    {flag_normal, 0, 1, 0, false, false, "N"},
    {flag_force, 0, 3, 0, false, false, "F"},
    {flag_patches, 0, 9, 2, true, true, "D"},
    {flag_influence, 0, 4, 2, true, true, "C3"},
    {flag_extra_slip, 0, 9, 0, false, false, "E"},
    {flag_xflow, 0, 999999999, 0, false, false, "X"},
    {flag_start, 0, 3, 0, false, false, "I"},
    {flag_output, 0, 9, 0, false, false, "O"},
    {flag_flow, 0, 9, 1, false, false, "W"},
    {flag_return, 0, 3, 1, false, false, "R"},
    {flag_matfile, 0, 2, 0, false, false, "A"},
    {flag_sensitivity, 0, 3, 1, false, false, "S2"},
    {flag_angle_method, 0, 1, 0, false, false, "IF_METH"},
    {flag_angle_variant, 1, 4, 4, false, false, "VARIANT"},
    {flag_block_output, 0, 4, 0, false, false, "O_s"},
    {flag_block_file, 0, 2, 0, false, false, "A_s"},
    {flag_most_elements, 100, 1000000, 20000, false, false, "NPOMAX"},
    {flag_write_input, 0, 2, 0, false, false, "wrtinp"},
    {flag_timers, 0, 2, 0, false, false, "timers"},
    {flag_debug, -1, 3, 0, false, false, "idebug"},
    {flag_licence, 0, 9, 0, false, false, "licdbg"},
}};

class flag_values {
 public:
  flag_values() {
    for (size_t i = 0; i < flag_rules.size(); ++i) values_[i] = flag_rules[i].start;
  }
  static int place_of(int code) {
    for (size_t i = 0; i < flag_rules.size(); ++i)
      if (flag_rules[i].code == code) return static_cast<int>(i);
    return -1;
  }
  // of a code of the table
  int get(int code) const { return values_[static_cast<size_t>(place_of(code))]; }
  // Whether it is another value now; false also where the code is none of the table.
  bool set(int code, int value, std::string &said) {
    const int at = place_of(code);
    if (at < 0) {
      said = "flag " + std::to_string(code) + " is unknown and ignored";
      return false;
    }
    const flag_rule &rule = flag_rules[static_cast<size_t>(at)];
    int &kept = values_[static_cast<size_t>(at)];
    int wanted = value;
    if (value < rule.least || value > rule.most) {
      wanted = rule.ignored ? kept : value < rule.least ? rule.least : rule.most;
      said = std::string("flag ") + std::to_string(code) + " (" + rule.name + ") is " +
             std::to_string(value) + ", allowed " + std::to_string(rule.least) + " ... " +
             std::to_string(rule.most) + ": " + std::to_string(wanted) + " is used";
    }
    if (rule.kept_by_low && wanted <= 1) wanted = kept;
    const bool other = kept != wanted;
    kept = wanted;
    return other;
  }

 private:
  std::array<int, flag_rules.size()> values_{};
};

}  // namespace contact_addon
