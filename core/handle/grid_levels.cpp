#include "handle/grid_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "handle/case_fields.hpp"
#include "handle/check.hpp"
#include "numeric/elementary.hpp"
#include "patch/status.hpp"

namespace railpatch {

namespace {

// of the elements across, from level to level: errors fall to some 0.55
constexpr double growth = 1.4;

int grown(int count, double factor, int most) {
  return std::min(static_cast<int>(std::lround(count * factor)), most);
}

// Nodes and rows, as far as there is room for them.
void grow_rows(const rp_config &first, double factor, rp_config &c) {
  const int most = static_cast<int>(config_range::fitted.high);
  for (;; factor *= 0.98) {
    for (int k = 0; k < 2; ++k) c.fitted[k] = grown(first.fitted[k], factor, most);
    if (c.fitted[0] * c.fitted[1] <= max_fitted_nodes) return;
  }
}

bool same_grid(const rp_config &a, const rp_config &b) {
  if (a.tangential != b.tangential) return false;
  if (a.fitted[0] > 0) return a.fitted[0] == b.fitted[0] && a.fitted[1] == b.fitted[1];
  return a.elements[0] == b.elements[0] && a.elements[1] == b.elements[1];
}

// of one solution, over what is allowed
double excess_of(const rp_patch_result &patch, double friction, double accuracy) {
  if (patch.status != RP_CONVERGED || std::isnan(patch.creep_force[0])) return 0;
  const double estimate = patch.error_estimate[0];
  if (std::isnan(estimate)) return HUGE_VAL;
  const double allowed = accuracy * friction * patch.normal_force;
  return estimate > 0 ? estimate / allowed : 0;
}

template <class Result, class F>
void for_each_solution(Result &result, F &&f) {
  for (auto &side : result.side)
    for (int i = 0; i < side.patch_count + side.alternative_count; ++i) f(side, side.patch[i]);
}

// Tractions of fitted rows on others, linear between the places of nodes in their row and of rows
// in the contact.
void resample(const patch_memory &from, const aligned_buffer<double> &a, patch_memory &to,
              aligned_buffer<double> &b) {
  const int n[2] = {from.columns(), from.rows()}, m[2] = {to.columns(), to.rows()};
  const auto place = [&](int k, int i, int &low) {
    const double at = std::clamp((i + 0.5) * n[k] / m[k] - 0.5, 0.0, n[k] - 1.0);
    low = std::min(static_cast<int>(at), std::max(n[k] - 2, 0));
    return at - low;
  };
  const auto value = [&](int i, int j) {
    return a[static_cast<size_t>(std::min(j, n[1] - 1) * n[0] + std::min(i, n[0] - 1))];
  };
  for (int j = 0; j < m[1]; ++j)
    for (int i = 0; i < m[0]; ++i) {
      int column = 0, row = 0;
      const double u = place(0, i, column), v = place(1, j, row);
      b[static_cast<size_t>(j * m[0] + i)] =
          (1 - v) * ((1 - u) * value(column, row) + u * value(column + 1, row)) +
          v * ((1 - u) * value(column, row + 1) + u * value(column + 1, row + 1));
    }
}

void carry_over(const patch_memory &from, patch_memory &to) {
  to.g = from.g;
  to.reference = from.reference;
  to.rolling = from.rolling;
  to.share = from.share;
  std::copy_n(from.rail, 2, to.rail);
  to.approach = from.approach;
  to.followed = from.followed;
  to.solved = false;
  const auto count = static_cast<size_t>(from.g.count());
  const bool holds = to.pressure.size() == 0 || count <= to.pressure.size();
  // a closed form leaves nothing to start from
  to.warm = from.warm && holds && from.fitted() == to.fitted() && from.px.size() > 0 &&
            (from.pressure.size() > 0) == (to.pressure.size() > 0);
  if (!to.warm) {
    to.g = grid{};
    return;
  }
  if (from.pressure.size()) std::copy_n(from.pressure.data(), count, to.pressure.data());
  if (from.creepage.size()) std::copy_n(from.creepage.data(), 2, to.creepage.data());
  if (from.fitted()) {
    resample(from, from.px, to, to.px);
    resample(from, from.py, to, to.py);
    resample(from, from.node_pressure, to, to.node_pressure);
    return;
  }
  std::copy_n(from.px.data(), count, to.px.data());
  std::copy_n(from.py.data(), count, to.py.data());
}

}  // namespace

std::vector<rp_config> configs_of_levels(const rp_config &first) {
  std::vector<rp_config> levels{first};
  if (!(first.accuracy > 0) || first.regime == RP_REGIME_NONE ||
      first.tangential == RP_TANGENTIAL_NONE)
    return levels;
  const bool table = uses_table(first);
  for (int k = 1; k <= first.finer_grids; ++k) {
    rp_config c = first;
    // the table has no grid: the first of the full theory is the one given
    const double factor = pow(growth, table ? k - 1 : k);
    c.tangential = table ? RP_TANGENTIAL_FULL : first.tangential;
    for (int &elements : c.elements)
      if (elements > 1)
        elements = grown(elements, factor, static_cast<int>(config_range::elements.high));
    if (c.fitted[0] > 0) grow_rows(first, factor, c);
    if (same_grid(levels.back(), c)) break;
    levels.push_back(c);
  }
  return levels;
}

double excess_of(const rp_result &result, const std::array<double, 2> &friction, double accuracy) {
  double greatest = 0;
  bool solved = true;
  for_each_solution(result, [&](const rp_side_result &side, const rp_patch_result &patch) {
    solved = solved && (patch.status == RP_CONVERGED || patch.status == RP_NO_CONTACT);
    const double own = friction[static_cast<size_t>(&side - result.side)];
    greatest = std::max(greatest, excess_of(patch, own, accuracy));
  });
  return solved && combine_status(result.status, RP_NO_CONTACT) == RP_CONVERGED ? greatest : 0;
}

void report_inaccurate(const std::array<double, 2> &friction, double accuracy, rp_result &out) {
  for_each_solution(out, [&](rp_side_result &side, rp_patch_result &patch) {
    const double own = friction[static_cast<size_t>(&side - out.side)];
    const double excess = excess_of(patch, own, accuracy);
    if (!(excess > 1)) return;
    const verdict found = std::isinf(excess)
                              ? verdict{RP_ACCURACY_NOT_MET, RP_REASON_NO_ESTIMATE}
                              : verdict{RP_ACCURACY_NOT_MET, RP_REASON_ACCURACY, excess * accuracy};
    degrade(patch, found);
    degrade(side, found);
    degrade(out, found);
  });
}

void carry_kept(driver &from, driver &to) {
  const driver::kept_numbers source = from.kept(), kept = to.kept();
  if (kept.bytes) std::memcpy(kept.more, source.more, kept.bytes);
  if (kept.heat_bytes) std::memcpy(kept.heat, source.heat, kept.heat_bytes);
  if (kept.depth) *kept.depth = *source.depth;
}

void carry_over(driver &from, driver &to) {
  carry_kept(from, to);
  for (size_t k = 0; k < to.memories().size(); ++k)
    carry_over(from.memories()[k], to.memories()[k]);
}

}  // namespace railpatch
