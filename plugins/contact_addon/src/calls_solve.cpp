#include <algorithm>
#include <cmath>

#include "angles.hpp"
#include "calls.hpp"
#include "solve.hpp"

using namespace contact_addon;

void cntc_calculate(int *ire, int *icp, int *ierror) {
  const char *call = "cntc_calculate";
  CONTACT_ADDON_NEEDS(call, ire, icp, ierror)
  *ierror = with_problem(call, *ire, *icp, modules::both, patches::settings, true,
                         [&](problem &p) { return solve(p, call); });
}

void cntc_calculate1(int *ire, int *ierror) {
  const char *call = "cntc_calculate1";
  CONTACT_ADDON_NEEDS(call, ire, ierror)
  *ierror = with_problem(call, *ire, -1, modules::wheels, patches::settings, true,
                         [&](problem &p) { return solve(p, call); });
}

void cntc_calculate3(int *ire, int *icp, int *ierror) {
  const char *call = "cntc_calculate3";
  CONTACT_ADDON_NEEDS(call, ire, icp, ierror)
  *ierror = with_problem(call, *ire, *icp, modules::basic, patches::settings, true,
                         [&](problem &p) { return solve(p, call); });
}

void subs_addblock(int *ire, int *icp, int *iblk, int *isubs, int *nx, int *ny, int *nz, double *x,
                   double *y, double *z) {
  const char *call = "subs_addblock";
  CONTACT_ADDON_NEEDS(call, ire, icp, iblk, isubs, nx, ny, nz)
  with_problem(call, *ire, *icp, modules::both, patches::either, true, [&](problem &p) {
    const int at = *iblk, kind = *isubs;
    if (at == 0) {
      for (block &b : p.blocks) b = {};
      return 0;
    }
    const bool known = (kind >= 1 && kind <= 3) || (kind >= 5 && kind <= 7) || kind == 9;
    if (at < 1 || at > 10 || !known) {
      say(call, "block " + std::to_string(at) + " of kind " + std::to_string(kind) +
                    ": allowed blocks 1 ... 10 of kinds 1-3, 5-7, 9; nothing is changed");
      return 0;
    }
    const double L = p.unit().length;
    const bool whole = kind == 1 || kind == 5, stepped = kind == 2 || kind == 6;
    const auto list = [&](const double *from, int count, double unit) {
      std::vector<double> out;
      for (int i = 0; from && i < count; ++i) out.push_back(from[i] * unit);
      return out;
    };
    // a block takes the place of its own and all behind it
    for (size_t i = static_cast<size_t>(at); i < p.blocks.size(); ++i) p.blocks[i] = {};
    block &b = p.blocks[static_cast<size_t>(at)];
    b.kind = kind;
    b.count[0] = *nx, b.count[1] = *ny, b.count[2] = *nz;
    const double unit = kind == 9 ? L : 1.0;
    if (!whole) {
      b.x = list(x, stepped ? 3 : *nx, unit);
      b.y = list(y, stepped ? 3 : *ny, unit);
    }
    b.z = list(z, kind <= 3 ? 2 : *nz, L);
    return 0;
  });
}

void subs_calculate(int *ire, int *icp, int *ierror) {
  const char *call = "subs_calculate";
  CONTACT_ADDON_NEEDS(call, ire, icp, ierror)
  *ierror = with_problem(call, *ire, *icp, modules::both, patches::either, false, [&](problem &p) {
    const bool all = p.wheel_rail() && *icp <= 0;
    const int first = all ? 1 : *icp, last = all ? p.patches() : *icp;
    if (!p.solved) {
      say(call, "no case was solved");
      return static_cast<int>(error_not_initialised);
    }
    p.block_results.assign(static_cast<size_t>(most_patches + 1), {});
    for (int patch = first; patch <= last; ++patch) {
      auto &results = p.block_results[static_cast<size_t>(patch)];
      results = p.blocks;
      for (block &b : results) {
        if (b.kind == 0) continue;
        std::string why;
        if (const int code = solve_block(p, patch, b, why); code != 0) {
          say(call, why);
          return code;
        }
      }
    }
    return 0;
  });
}

namespace {

const block *block_of(const problem &p, int icp, int iblk) {
  const auto patch = static_cast<size_t>(std::max(icp, 1)),
             at = static_cast<size_t>(std::max(iblk, 0));
  if (patch >= p.block_results.size() || at < 1 || at >= p.block_results[patch].size())
    return nullptr;
  const block &b = p.block_results[patch][at];
  return b.shape[0] < 0 ? nullptr : &b;
}

// Roots of the characteristic polynomial of a symmetric tensor, from the greatest.
void principal(const double *s, double out[3]) {
  const double mean = (s[0] + s[1] + s[2]) / 3;
  const double a = s[0] - mean, b = s[1] - mean, c = s[2] - mean;
  const double j2 = 0.5 * (a * a + b * b + c * c) + s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  const double j3 =
      a * (b * c - s[4] * s[4]) - s[3] * (s[3] * c - s[4] * s[5]) + s[5] * (s[3] * s[4] - b * s[5]);
  const double radius = std::sqrt(j2 / 3);
  const double cosine =
      radius > 0 ? std::clamp(0.5 * j3 / (radius * radius * radius), -1.0, 1.0) : 1.0;
  const double angle = contact_addon::acos(cosine) / 3;
  constexpr double third = 2.0943951023931953;
  for (int k = 0; k < 3; ++k) out[k] = mean + 2 * radius * contact_addon::cos(angle - k * third);
  std::sort(out, out + 3, [](double p, double q) { return p > q; });
}

// Columns 1 ... 21 of one point, in the caller's units. v: xx ss nn xs sn nx, displacements.
void columns_of(const double *point, const double *v, const units &u, double out[22]) {
  double s[6], top[3];
  for (int k = 0; k < 6; ++k) s[k] = v[k] / u.pressure();
  principal(s, top);
  for (int k = 0; k < 3; ++k) {
    out[1 + k] = point[k] / u.length;
    out[4 + k] = v[6 + k] / u.length;
    out[10 + k] = top[k];
  }
  out[7] = (s[0] + s[1] + s[2]) / 3;
  out[8] = std::sqrt(0.5 * ((top[0] - top[1]) * (top[0] - top[1]) +
                            (top[1] - top[2]) * (top[1] - top[2]) +
                            (top[2] - top[0]) * (top[2] - top[0])));
  out[9] = top[0] - top[2];
  const double tensor[9] = {s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]};
  std::copy_n(tensor, 9, out + 13);
}

}  // namespace

void subs_getblocksize(int *ire, int *icp, int *iblk, int *nx, int *ny, int *nz) {
  const char *call = "subs_getblocksize";
  CONTACT_ADDON_NEEDS(call, ire, icp, iblk, nx, ny, nz)
  with_problem(call, *ire, *icp, modules::both, patches::patch, false, [&](problem &p) {
    const block *b = block_of(p, *icp, *iblk);
    *nx = b ? b->shape[0] : -1;
    *ny = b ? b->shape[1] : -1;
    *nz = b ? b->shape[2] : -1;
    return 0;
  });
}

void subs_getresults(int *ire, int *icp, int *iblk, int *count, int *ncolumn, int *columns,
                     double *values) {
  const char *call = "subs_getresults";
  CONTACT_ADDON_NEEDS(call, ire, icp, iblk, count, ncolumn, columns, values)
  with_problem(call, *ire, *icp, modules::both, patches::patch, false, [&](problem &p) {
    const block *b = block_of(p, *icp, *iblk);
    if (b == nullptr) {
      say(call, "block " + std::to_string(*iblk) + " has no results");
      return 0;
    }
    const auto rows = static_cast<size_t>(std::max(*count, 0));
    for (size_t i = 0; i < rows; ++i) {
      double all[22];
      std::fill_n(all, 22, -999.0);
      if (3 * i + 2 < b->points.size())
        columns_of(b->points.data() + 3 * i, b->results.data() + 9 * i, p.unit(), all);
      for (int c = 0; c < *ncolumn; ++c) {
        const int wanted = columns[c];
        values[static_cast<size_t>(c) * rows + i] =
            wanted >= 1 && wanted <= 21 ? all[wanted] : -999.0;
      }
    }
    return 0;
  });
}
