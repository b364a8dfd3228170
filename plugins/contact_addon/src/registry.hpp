// All result elements, and the frame of every call: who is meant, what may go wrong.
#pragma once

#include <functional>
#include <string>

#include "problem.hpp"

namespace contact_addon {

constexpr int version = 2520;
constexpr int most_elements = 999, most_patches = 9;

enum error_code {
  error_none = 0,
  error_search = -25,
  error_total_force = -26,
  error_normal = -27,
  error_tangential = -28,
  error_not_initialised = -31,
  error_profile = -32,
  error_friction = -33,
  error_grid_changed = -34,
  error_input_file = -39,
  error_other = -99,
  error_element = -101,
  error_not_in_1 = -102,
  error_not_in_3 = -103,
  error_patch_range = -104,
  error_needs_patch = -105,
  error_takes_no_patch = -106,
  locked = 305
};

// which module a call is for, and which patches it takes
enum class modules { both, wheels, basic };
enum class patches { element, settings, either, patch };  // e, w, b, c of the interface

void start(int output, const std::string &folder, const std::string &out_folder,
           const std::string &name);
void stop();
// The folder that relative names begin at; empty: the current one.
std::string work_folder();
// Makes a result element ready; 0, or an error.
int make_element(int ire, int module);
void drop_element(int ire);
int alive_elements();
// 0 where it was never made.
int module_of(int ire);
void set_threads(int count);
int threads();

// Runs `task` with the problem that is meant, locked; what goes wrong is said and given back, as
// is what `task` returns. Of a wheel-rail element every patch is in the one problem. create: makes
// the problem where there is none, else error_not_initialised.
int with_problem(const char *call, int ire, int icp, modules module, patches which, bool create,
                 const std::function<int(problem &)> &task);

// A call's body, out of which nothing is thrown.
int guarded(const char *call, const std::function<int()> &body);

}  // namespace contact_addon
