#include "fast/creep_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

namespace {

using std::sqrt;
using std::numbers::pi;

constexpr char magic[8] = {'R', 'P', 'C', 'R', 'E', 'E', 'P', '1'};
constexpr size_t checked_from = offsetof(creep_table_header, ratio_count);
constexpr int linear_stride = 8;
constexpr int most_cells = 192;  // of a sum: of Poisson's ratio three nodes, four along three axes
// Of the bound: above this part the force bends away from it, so that it stays below for sure.
constexpr double bend = 1e-3;
// Creepages beyond are all sliding, and shrunk to this size.
constexpr double greatest = 1e150;

struct layout {
  size_t linear, remainder, recipe, end;  // bytes from the start
};

size_t padded(size_t bytes) { return (bytes + 7) / 8 * 8; }

layout layout_of(const creep_table_header &h) {
  const auto ratios = static_cast<size_t>(h.ratio_count), ts = static_cast<size_t>(h.t_count);
  const size_t directions = static_cast<size_t>(h.psi_count) * static_cast<size_t>(h.theta_count);
  layout at{};
  at.linear = sizeof h + 3 * ratios * 3 * sizeof(double);
  at.remainder = at.linear + 3 * ratios * ts * linear_stride * sizeof(float);
  at.recipe = at.remainder + padded(3 * ratios * directions * ts * 3 * sizeof(int16_t));
  at.end = at.recipe + padded(static_cast<size_t>(h.recipe_bytes));
  return at;
}

bool increasing(const double *values, int count) {
  for (int i = 0; i + 1 < count; ++i)
    if (!(values[i] < values[i + 1])) return false;
  return true;
}

bool is_positive(double value) { return value > 0 && std::isfinite(value); }

template <class T>
bool all_finite(const unsigned char *data, size_t count) {
  const T *values = reinterpret_cast<const T *>(data);
  return std::all_of(values, values + count, [](T v) { return std::isfinite(v); });
}

// Sums weight[k] times the 12 numbers at data[k], each component by itself, so that the order of
// the sums does not depend on the width of the vectors. Compilers convert numbers of 16 bits one by
// one, so vectors are spelled out where they can be.
RAILPATCH_DISPATCH void add_weighted(const int16_t *const *data, const double *weight, int count,
                                     double *sum) {
#if defined(__GNUC__)
  typedef int16_t shorts __attribute__((vector_size(8)));
  typedef int32_t integers __attribute__((vector_size(16)));
  typedef double doubles __attribute__((vector_size(32)));
  doubles total[3] = {};
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < 3; ++i) {
      shorts part;
      std::memcpy(&part, data[k] + 4 * i, sizeof part);
      // in two steps, each of which is one instruction
      const integers wide = __builtin_convertvector(part, integers);
      total[i] += weight[k] * __builtin_convertvector(wide, doubles);
    }
  std::memcpy(sum, total, sizeof total);
#else
  std::fill_n(sum, 12, 0.0);
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < 12; ++i) sum[i] += weight[k] * data[k][i];
#endif
}

// The same with the weights' rates, which the sum is linear in.
void add_weighted(const int16_t *const *data, const directed *weight, int count, directed *sum) {
  double part[most_cells], found[12];
  for (int k = 0; k < count; ++k) part[k] = weight[k].value;
  add_weighted(data, part, count, found);
  for (int i = 0; i < 12; ++i) sum[i] = found[i];
  for (int k = 0; k < count; ++k) part[k] = weight[k].rate[0];
  add_weighted(data, part, count, found);
  for (int i = 0; i < 12; ++i) sum[i].rate[0] = found[i];
}

// 1 for s up to 1 - bend, then s times it bends towards 1 with continuous slope: s/|s| limited.
template <class T>
T limit(const T &s) {
  if (s <= 1.0 - bend) return 1.0;
  const T u = (s - 1.0) / bend + 1.0;
  return (1.0 - bend + bend * u / sqrt(1.0 + u * u)) / s;
}

// a times sign for a 0, whose size would not have its rate; else the size.
double size_of(double a, double) { return std::abs(a); }
directed size_of(const directed &a, double sign) { return a.value == 0 ? sign * a : fabs(a); }

// Where a force vanishes with xi, it still has a rate.
double sign_of(double xi) { return xi > 0 ? 1.0 : (xi < 0 ? -1.0 : 0.0); }
double sign_of(const directed &xi) { return xi.value < 0 ? -1.0 : 1.0; }

// rad; of two zeros, where nothing depends on it, without a rate.
double angle_of(double y, double x) { return atan2(y, x); }
directed angle_of(const directed &y, const directed &x) {
  return x.value == 0 && y.value == 0 ? directed(0.0) : atan2(y, x);
}

}  // namespace

uint64_t table_checksum(const unsigned char *data, size_t size) {
  uint64_t hash = 14695981039346656037ull;
  for (size_t i = 0; i + 8 <= size; i += 8) {
    uint64_t word;
    std::memcpy(&word, data + i, 8);
    hash = (hash ^ word) * 1099511628211ull;
  }
  return hash;
}

const char *creep_table::defect(const void *data, size_t size) {
  if (!data) return "is null: tangential = table needs one";
  const auto *bytes = static_cast<const unsigned char *>(data);
  if (reinterpret_cast<uintptr_t>(bytes) % 8 != 0) return "must be aligned to 8 bytes";
  creep_table_header h;
  if (size < sizeof h) return "is too short for its header";
  std::memcpy(&h, bytes, sizeof h);
  if (std::memcmp(h.magic, magic, sizeof magic) != 0) return "is no creep table of this version";
  if (h.bytes != size || size % 8 != 0) return "has not the length that its header says";
  for (int count : {h.ratio_count, h.psi_count, h.theta_count, h.t_count})
    if (count < 4 || count > 256)
      return "has an axis of fewer than 4 or more than 256 coefficients";
  if (h.recipe_bytes < 0 || layout_of(h).end != size)
    return "has not the length that its axes ask for";
  if (table_checksum(bytes + checked_from, size - checked_from) != h.checksum)
    return "has a wrong checksum: it was altered";
  const bool axes = increasing(h.poisson_ratio, 3) && increasing(h.log_ratio, 2) &&
                    std::abs(h.log_ratio[0]) < 20 && std::abs(h.log_ratio[1]) < 20 &&
                    std::abs(h.poisson_ratio[0]) < 1 && std::abs(h.poisson_ratio[2]) < 1;
  bool scales = is_positive(h.radius);
  for (double s : h.remainder_scale) scales = scales && is_positive(s);
  for (double e : h.error) scales = scales && e >= 0 && std::isfinite(e);
  if (!axes || !scales) return "has an axis or a scale out of range";
  const layout at = layout_of(h);
  if (!all_finite<double>(bytes + sizeof h, (at.linear - sizeof h) / sizeof(double)) ||
      !all_finite<float>(bytes + at.linear, (at.remainder - at.linear) / sizeof(float)))
    return "holds values that are no numbers";
  return nullptr;
}

creep_table::creep_table(const void *data, double poisson_ratio)
    : header_(static_cast<const creep_table_header *>(data)) {
  const auto *bytes = static_cast<const unsigned char *>(data);
  const layout at = layout_of(*header_);
  scale_ = reinterpret_cast<const double *>(bytes + sizeof *header_);
  linear_ = reinterpret_cast<const float *>(bytes + at.linear);
  remainder_ = reinterpret_cast<const int16_t *>(bytes + at.remainder);
  const double *node = header_->poisson_ratio;
  poisson_in_range_ = poisson_ratio >= node[0] && poisson_ratio <= node[2];
  for (int i = 0; i < 3; ++i) {
    const double a = node[(i + 1) % 3], b = node[(i + 2) % 3];
    poisson_weight_[i] =
        (poisson_ratio - a) * (poisson_ratio - b) / ((node[i] - a) * (node[i] - b));
  }
}

// The four B-splines at a position from 0 to count - 3 intervals.
template <class T>
creep_table::axis<T> creep_table::locate(const T &position, int count) {
  axis<T> at;
  at.first = std::clamp(static_cast<int>(value_of(position)), 0, count - 4);
  const T u = position - at.first, v = 1.0 - u;
  at.weight[0] = v * v * v / 6.0;
  at.weight[1] = (4.0 - 6.0 * u * u + 3.0 * u * u * u) / 6.0;
  at.weight[2] = (4.0 - 6.0 * v * v + 3.0 * v * v * v) / 6.0;
  at.weight[3] = u * u * u / 6.0;
  return at;
}

template <class T>
void creep_table::interpolate_scale(const axis<T> &ratio, T s[3]) const {
  std::fill_n(s, 3, T(0.0));
  for (int n = 0; n < 3; ++n)
    for (int i = 0; i < 4; ++i) {
      const T w = poisson_weight_[n] * ratio.weight[i];
      const double *at = scale_ + 3 * (n * header().ratio_count + ratio.first + i);
      for (int k = 0; k < 3; ++k) s[k] += w * at[k];
    }
}

template <class T>
void creep_table::interpolate_linear(const axis<T> &ratio, const axis<T> &t, T m[5]) const {
  std::fill_n(m, 5, T(0.0));
  for (int n = 0; n < 3; ++n) {
    if (poisson_weight_[n] == 0) continue;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const T w = poisson_weight_[n] * ratio.weight[i] * t.weight[j];
        const int row = (n * header().ratio_count + ratio.first + i) * header().t_count;
        const float *at = linear_ + linear_stride * (row + t.first + j);
        for (int k = 0; k < 5; ++k) m[k] += w * static_cast<double>(at[k]);
      }
  }
}

template <class T>
void creep_table::interpolate_remainder(const axis<T> &ratio, const axis<T> &psi,
                                        const axis<T> &theta, const axis<T> &t, T h[3]) const {
  const creep_table_header &d = header();
  const int16_t *data[most_cells];
  T weight[most_cells], sum[12];
  int count = 0;
  for (int n = 0; n < 3; ++n) {
    // at a node of Poisson's ratio the others count nothing
    if (poisson_weight_[n] == 0) continue;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const T w = poisson_weight_[n] * ratio.weight[i] * psi.weight[j];
        const int row = (n * d.ratio_count + ratio.first + i) * d.psi_count + psi.first + j;
        for (int k = 0; k < 4; ++k) {
          const auto line = static_cast<size_t>(row * d.theta_count + theta.first + k);
          data[count] = remainder_ +
                        3 * (line * static_cast<size_t>(d.t_count) + static_cast<size_t>(t.first));
          weight[count++] = w * theta.weight[k];
        }
      }
  }
  add_weighted(data, weight, count, sum);
  for (int k = 0; k < 3; ++k) {
    h[k] = 0;
    for (int j = 0; j < 4; ++j) h[k] += t.weight[j] * sum[3 * j + k];
    h[k] *= d.remainder_scale[k];
  }
}

double creep_table::nearest_ratio(double ratio) const {
  const double t = log(ratio), *range = header().log_ratio;
  if (t >= range[0] && t <= range[1]) return ratio;
  return exp(std::clamp(t, range[0], range[1]));
}

// Without creepage there is no force; its rates are those of the linear theory, t n A(0) with
// t n = G c^2/(R B) of n before it is divided by its size.
template <class T>
basic_creep_forces<T> creep_table::from_rest(const basic_creep_problem<T> &p, const axis<T> &ratio,
                                             const T n[3], double along, double mirror,
                                             const T &c) const {
  basic_creep_forces<T> out{};
  out.in_range = in_range(log(p.semi_axes[0] / p.semi_axes[1]));
  T m[5];
  interpolate_linear(ratio, locate(T(0.0), header().t_count), m);
  const T scale = p.shear_modulus * c * c / header().radius;
  out.force[0] = p.direction * along * scale * (m[0] * n[0]);
  out.force[1] = mirror * scale * (m[1] * n[1] + m[2] * n[2]);
  out.moment = p.direction * mirror * c * scale * (m[3] * n[1] + m[4] * n[2]);
  return out;
}

template <class T>
basic_creep_forces<T> creep_table::evaluate(const basic_creep_problem<T> &p) const {
  const creep_table_header &d = header();
  basic_creep_forces<T> out{};
  const T ratio = log(p.semi_axes[0] / p.semi_axes[1]);
  out.in_range = in_range(ratio);
  if (!(p.bound > 0)) return out;
  T inside = ratio;
  if (inside < d.log_ratio[0]) inside = d.log_ratio[0];
  if (inside > d.log_ratio[1]) inside = d.log_ratio[1];
  const axis<T> at_ratio =
      locate<T>((inside - d.log_ratio[0]) / (d.log_ratio[1] - d.log_ratio[0]) * (d.ratio_count - 3),
                d.ratio_count);
  T scale[3];
  interpolate_scale(at_ratio, scale);
  const T c = sqrt(p.semi_axes[0] * p.semi_axes[1]);

  // rolling along -x is a mirror image; xi and (eta, phi) then are made positive by symmetry
  const T xi = p.direction * p.creepage[0], phi = p.direction * p.spin_creepage;
  const T eta = p.creepage[1];
  const double mirror = phi < 0.0 || (value_of(phi) == 0 && eta < 0.0) ? -1.0 : 1.0;
  const double along = sign_of(xi);
  // all components alike, so that the direction stays
  const double most = std::max(
      {std::abs(value_of(xi)), std::abs(value_of(eta)), value_of(c) * std::abs(value_of(phi))});
  const double shrink = most > greatest ? greatest / most : 1.0;
  T n[3] = {scale[0] * size_of(xi * shrink, along), mirror * scale[1] * (eta * shrink),
            scale[2] * c * size_of(phi * shrink, mirror)};
  const T size = hypot(hypot(n[0], n[1]), n[2]);
  if (value_of(size) == 0) return from_rest(p, at_ratio, n, along, mirror, c);
  for (T &component : n) component /= size;
  const T stiffness = p.shear_modulus * c * c * size;
  const T t = stiffness / (d.radius * p.bound + stiffness);

  const T level = hypot(n[0], n[1]);
  const axis<T> at_t = locate<T>(t * (d.t_count - 3), d.t_count);
  const axis<T> at_psi =
      locate<T>(atan2(n[2], level) * (2.0 / pi) * (d.psi_count - 3), d.psi_count);
  const axis<T> at_theta =
      locate<T>((angle_of(n[1], n[0]) / pi + 0.5) * (d.theta_count - 3), d.theta_count);
  T m[5], h[3];
  interpolate_linear(at_ratio, at_t, m);
  interpolate_remainder(at_ratio, at_psi, at_theta, at_t, h);
  const T share = level * level;
  const T fx = t * (m[0] * n[0] + share * h[0]);
  const T fy = t * (m[1] * n[1] + m[2] * n[2] + share * h[1]);
  const T mz = t * (m[3] * n[1] + m[4] * n[2] + share * h[2]);

  const T cut = limit<T>(hypot(fx, fy));
  // where xi vanishes, so does the force along it
  out.force[0] = p.direction * along * cut * p.bound * fx;
  out.force[1] = mirror * cut * p.bound * fy;
  out.moment = p.direction * mirror * c * p.bound * mz;
  const T power =
      out.force[0] * p.creepage[0] + out.force[1] * p.creepage[1] + out.moment * p.spin_creepage;
  out.friction = std::max(T(0.0), -power);
  return out;
}

template creep_forces creep_table::evaluate(const creep_problem &) const;
template basic_creep_forces<directed> creep_table::evaluate(
    const basic_creep_problem<directed> &) const;

tangential_result solve_table(const fast_problem &p, tangential_fields /*fields*/,
                              creep_resultants &sums) {
  const rolling_input &in = p.at_centre;
  const creep_forces found = p.table->evaluate<double>({{p.axes[0], p.axes[1]},
                                                        p.elastic.shear_modulus,
                                                        p.capacity,
                                                        {in.creepage[0], in.creepage[1]},
                                                        in.spin_creepage,
                                                        in.direction});
  const double x = found.force[0], y = found.force[1];
  sums = {{x, y}, found.moment + p.centre[0] * y - p.centre[1] * x, found.friction};
  tangential_result result;
  result.friction = found.friction;
  result.converged = found.in_range;
  return result;
}

}  // namespace railpatch
