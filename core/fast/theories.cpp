#include "fast/theories.hpp"

#include "fast/creep_table.hpp"
#include "fast/fastrip.hpp"
#include "fast/fastsim.hpp"
#include "fast/linear.hpp"
#include "fast/polach.hpp"

namespace railpatch {

namespace {

constexpr bool tractions = true, resultants = false;

constexpr fast_theory theories[] = {
    {RP_TANGENTIAL_LINEAR, "linear", resultants, solve_linear,
     "tangential = linear: creepage coefficients, no traction field", reads_percent},
    {RP_TANGENTIAL_POLACH, "polach", resultants, solve_polach,
     "tangential = polach: closed form, no traction field",
     reads_percent | reads_polach | reads_slip_law},
    {RP_TANGENTIAL_FASTSIM, "fastsim", tractions, solve_fastsim,
     "tangential = fastsim: simplified theory",
     reads_percent | reads_bound | reads_blending | reads_contact_blending | reads_reduction |
         reads_slip_law},
    {RP_TANGENTIAL_FASTRIP, "fastrip", tractions, solve_fastrip,
     "tangential = fastrip: strip theory", reads_percent | reads_blending | reads_slip_law},
    {RP_TANGENTIAL_TABLE, "table", resultants, solve_table,
     "tangential = table: full theory, interpolated; the table is the caller's", 0},
};

constexpr option_key keys[] = {
    {reads_percent, "percent_kalker"},
    {reads_bound, "traction_bound"},
    {reads_blending, "flexibility_blending"},
    {reads_polach, "polach_k_a"},
    {reads_polach, "polach_k_s"},
    {reads_reduction, "fastsim_k0"},
    {reads_reduction, "fastsim_alpha"},
    {reads_reduction, "fastsim_beta"},
};

}  // namespace

std::span<const fast_theory> fast_theories() { return theories; }

std::span<const option_key> option_keys() { return keys; }

const fast_theory *theory_of(rp_tangential_method method) {
  for (const fast_theory &theory : theories)
    if (theory.method == method) return &theory;
  return nullptr;
}

}  // namespace railpatch
