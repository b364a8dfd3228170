// The table of fast theories: one row each. Who asks what a theory needs, reads or is called reads
// it here; so does the Python package. A new theory is a pair of files with its solve function, a
// row in theories.cpp and its word in railpatch.h.
#pragma once

#include <span>

#include "fast/fast_problem.hpp"

namespace railpatch {

// Options that only some theories read, as bits of fast_theory::reads.
enum theory_option : unsigned {
  reads_percent = 1,
  reads_bound = 2,
  reads_blending = 4,          // sliding or none
  reads_contact_blending = 8,  // and as in the program CONTACT
  reads_polach = 16,
  reads_reduction = 32,
  reads_slip_law = 64,  // friction that follows the speed of slip
};

// Fills the fields (theories with tractions) or the resultants about the reference. Not
// converged: outside the theory's range, the result is there all the same.
using fast_solve = tangential_result(const fast_problem &, tangential_fields, creep_resultants &);

struct fast_theory {
  rp_tangential_method method;
  const char *name;  // in cases and messages
  bool tractions;    // not only resultants; only these need a grid and memory
  fast_solve *solve;
  const char *reason;  // of the stage
  unsigned reads;      // options, or-ed
};
std::span<const fast_theory> fast_theories();
// Null for none and for the full theory.
const fast_theory *theory_of(rp_tangential_method method);

// Keys of the options in a config.
struct option_key {
  theory_option option;
  const char *key;
};
std::span<const option_key> option_keys();

inline bool is_fast(rp_tangential_method method) { return theory_of(method) != nullptr; }
// Whether the theory gives tractions, not only their resultants.
inline bool has_tractions(rp_tangential_method method) {
  const fast_theory *theory = theory_of(method);
  return theory ? theory->tractions : method == RP_TANGENTIAL_FULL;
}

}  // namespace railpatch
