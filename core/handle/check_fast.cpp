// Checks of what only some theories of the tangential problem read.
#include "fast/theories.hpp"
#include "handle/checker.hpp"

namespace railpatch {

namespace {

// A message that names fast theories by what they read.
struct rule_text {
  char text[RP_MESSAGE_SIZE] = {};

  void add(const char *part) {
    const size_t length = std::strlen(text);
    std::snprintf(text + length, sizeof text - length, "%s", part);
  }
  // "<before>a or b"
  void add_readers(const char *before, unsigned read, unsigned unread = 0) {
    for (const fast_theory &theory : fast_theories()) {
      if (!(theory.reads & read) || theory.reads & unread) continue;
      add(before);
      add(theory.name);
      before = " or ";
    }
  }
};

}  // namespace

void check_fast(const rp_config &c, checker &check) {
  if (!has_tangential(c)) return;
  const fast_theory *theory = theory_of(c.tangential);
  check.require(theory || c.percent_kalker == 100.0,
                "percent_kalker must be 100 with tangential = full: it has no coefficients");
  const auto require = [&](bool unset, unsigned needed, unsigned option, const char *rule) {
    if (unset || (theory && theory->reads & needed)) return;
    rule_text message;
    message.add(rule);
    message.add_readers(" where tangential is not ", option);
    if (option == reads_blending)
      message.add_readers(", and not contact with ", option, reads_contact_blending);
    check.require(false, message.text);
  };
  require(c.percent_kalker == 100.0, reads_percent, reads_percent, "percent_kalker must be 100");
  require(c.polach_k_a == 1.0 && c.polach_k_s == 1.0, reads_polach, reads_polach,
          "polach_k_a and polach_k_s must be 1");
  require(c.fastsim_k0 == 1.0 && c.fastsim_alpha == 1.0 && c.fastsim_beta == 0.0, reads_reduction,
          reads_reduction, "fastsim_k0 and fastsim_alpha must be 1, fastsim_beta 0");
  require(c.traction_bound == RP_BOUND_AUTOMATIC, reads_bound, reads_bound,
          "traction_bound must be automatic");
  const bool contact = c.flexibility_blending == RP_BLENDING_CONTACT;
  require(c.flexibility_blending == RP_BLENDING_SLIDING,
          contact ? reads_contact_blending : reads_blending, reads_blending,
          "flexibility_blending must be sliding");
}

void check_law_of_theory(const rp_config &c, bool grid, checker &check) {
  if (c.friction_law == RP_COULOMB || grid) return;
  const fast_theory *theory = theory_of(c.tangential);
  const bool follows = theory && theory->reads & reads_slip_law;
  rule_text rule;
  rule.add("friction_law must be coulomb but with tangential = full and no fitted rows");
  rule.add_readers(", or slip_velocity with tangential = ", reads_slip_law);
  check.require(follows && c.friction_law == RP_SLIP_VELOCITY, rule.text);
  check.require(!follows || c.friction_memory_distance == 0,
                "friction_memory_distance must be 0 with a fast theory: its friction follows the "
                "rigid slip, which has no beginning");
}

}  // namespace railpatch
