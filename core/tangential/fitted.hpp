// Steady rolling contact with Coulomb friction, full theory, on rows fitted to the contact area
// (contact_rows.hpp, fitted_operator.hpp): one per cent of the creep force with ten nodes across,
// where a uniform grid needs forty.
#pragma once

#include "half_space/forces.hpp"
#include "tangential/fitted_operator.hpp"

namespace railpatch {

// Outputs on the nodes, [strip][node], nodes by rising x; strips out of contact are zero.
struct fitted_fields {
  double *x;         // m
  double *y;         // m, [strip]
  double *height;    // m, [strip]
  double *pressure;  // Pa; start in (of the traction's start), solution out
  tangential_fields traction;
};

class fitted_solver {
 public:
  // forced: for inputs with a prescribed force.
  fitted_solver(const elastic_constants &elastic, double layer_flexibility, bool line, bool forced,
                const contact_rows &rows);

  tangential_result solve(const contact_rows &rows, double friction_coefficient,
                          const rolling_input &input, const tangential_options &options,
                          fitted_fields fields);
  // Longitudinal and lateral force and spin moment of the last solution.
  patch_wrench creep_wrench(const contact_rows &rows, const fitted_fields &fields) const;
  // J, of the tractions of the last solution; NaN for a line contact.
  double elastic_energy(const contact_rows &rows) const;
  size_t bytes() const;

 private:
  void collect(const contact_rows &rows, double friction_coefficient, const rolling_input &input,
               const fitted_fields &fields);
  void release(const contact_rows &rows, int direction, fitted_fields fields) const;
  // f(row, node from the leading edge, element, indices of its components in vectors, in fields)
  template <class F>
  void for_each_node(const contact_rows &rows, int direction, F &&f) const;

  fitted_operator operator_;
  aligned_buffer<int> row_start_;
  aligned_buffer<double> bound_, area_, rigid_, p_, s_;
  rolling_newton newton_;
};

}  // namespace railpatch
