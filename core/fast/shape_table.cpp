#include "fast/shape_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/fade.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;
using shapes_header = shape_table_header;

constexpr char shape_magic[8] = {'R', 'P', 'S', 'H', 'A', 'P', 'E', '2'};
constexpr size_t shapes_checked_from = offsetof(shapes_header, node_count);
constexpr double shape_stiffness[3] = {4.2, 3.7, 2.3};
constexpr int shape_cells = shapes_header::spins * shape_table::directions * shape_table::radii;
constexpr int most_nodes = 20000;
// -, of the distances between shapes: below this they count alike, as a grid's elements let them
// differ by as much
constexpr double alike = 0.05;
// Sizes of the weights of a plane whose sum is 1, added up: above the first they are mixed with
// those of the distances, more so up to the second.
constexpr double magnified = 2.0, beyond = 4.0;
constexpr double poisson_within = 0.005;

struct shape_layout {
  size_t remainder, recipe, ellipses;  // bytes from the start
};

size_t whole_words(size_t bytes) { return (bytes + 7) / 8 * 8; }

size_t blocks_of(const shapes_header &h) {
  return (static_cast<size_t>(h.node_count) + shape_table::lanes - 1) / shape_table::lanes;
}

shape_layout shape_layout_of(const shapes_header &h) {
  const auto nodes = static_cast<size_t>(h.node_count);
  shape_layout at{};
  at.remainder =
      sizeof h + blocks_of(h) * shape_table::lanes * shapes_header::features * sizeof(float);
  at.recipe = at.remainder + nodes * shape_cells * 4 * sizeof(int16_t);
  at.ellipses = at.recipe + whole_words(static_cast<size_t>(h.recipe_bytes));
  return at;
}

bool positive_number(double value) { return value > 0 && std::isfinite(value); }

// Squares of the distances from one shape to blocks of nodes, each by itself, so that no sum
// depends on the width of the vectors.
RAILPATCH_DISPATCH void add_distances(const float *blocks, int count, const float *of, float *out) {
  constexpr int lanes = shape_table::lanes;
  for (int b = 0; b < count; ++b)
    for (int lane = 0; lane < lanes; ++lane) {
      float sum = 0;
      for (int k = 0; k < shapes_header::features; ++k) {
        const float d = blocks[(b * shapes_header::features + k) * lanes + lane] - of[k];
        sum += d * d;
      }
      out[b * lanes + lane] = sum;
    }
}

// Sums weight[k] times the four numbers at offset[k], each component by itself, so that no sum
// depends on the width of the vectors (as add_weighted of creep_table.cpp).
RAILPATCH_DISPATCH void add_cells(const int16_t *of, const int *offset, const double *weight,
                                  int count, double *sum) {
#if defined(__GNUC__)
  typedef int16_t shorts __attribute__((vector_size(8)));
  typedef int32_t integers __attribute__((vector_size(16)));
  typedef double doubles __attribute__((vector_size(32)));
  doubles total = {};
  for (int k = 0; k < count; ++k) {
    shorts part;
    std::memcpy(&part, of + offset[k], sizeof part);
    const integers wide = __builtin_convertvector(part, integers);
    total += weight[k] * __builtin_convertvector(wide, doubles);
  }
  std::memcpy(sum, &total, sizeof total);
#else
  std::fill_n(sum, 4, 0.0);
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < 4; ++i) sum[i] += weight[k] * of[offset[k] + i];
#endif
}

// Of values at four rising places x for one between the middle ones: the cubic through these with
// the slopes of parabolas through three neighbours; at the end of an axis, where the last is none,
// with the chord's slope there.
std::array<double, 4> cubic_weights(const double x[4], double at, bool ends) {
  const double h = x[2] - x[1], u = (at - x[1]) / h, before = x[1] - x[0];
  const double slope[2] = {u * (1 - u) * (1 - u) * h, -u * u * (1 - u) * h};
  std::array<double, 4> w = {0, (1 + 2 * u) * (1 - u) * (1 - u), u * u * (3 - 2 * u), 0};
  w[0] -= slope[0] * h / (before * (before + h));
  w[1] += slope[0] * (h - before) / (before * h);
  w[2] += slope[0] * before / (h * (before + h));
  if (ends) {
    w[1] -= slope[1] / h;
    w[2] += slope[1] / h;
    return w;
  }
  const double after = x[3] - x[2];
  w[1] -= slope[1] * after / (h * (h + after));
  w[2] += slope[1] * (after - h) / (h * after);
  w[3] += slope[1] * h / (after * (h + after));
  return w;
}

}  // namespace

bool shape_table::is_one(const void *data, size_t size) {
  return data && size >= sizeof shape_magic &&
         std::memcmp(data, shape_magic, sizeof shape_magic) == 0;
}

const char *shape_table::defect(const void *data, size_t size) {
  const auto *bytes = static_cast<const unsigned char *>(data);
  if (reinterpret_cast<uintptr_t>(bytes) % 8 != 0) return "must be aligned to 8 bytes";
  shapes_header h;
  if (size < sizeof h) return "is too short for its header";
  std::memcpy(&h, bytes, sizeof h);
  if (h.bytes != size || size % 8 != 0) return "has not the length that its header says";
  if (h.node_count < neighbours + 1 || h.node_count > most_nodes)
    return "has fewer than 15 or more than 20000 shapes";
  if (h.recipe_bytes < 0 || shape_layout_of(h).ellipses > size)
    return "has not the length that its shapes ask for";
  if (table_checksum(bytes + shapes_checked_from, size - shapes_checked_from) != h.checksum)
    return "has a wrong checksum: it was altered";
  bool good = h.poisson_ratio > -1 && h.poisson_ratio <= 0.5 && positive_number(h.reach) &&
              positive_number(h.radius) && h.spin[0] == 0;
  for (int k = 0; k + 1 < shapes_header::spins; ++k) good = good && h.spin[k] < h.spin[k + 1];
  good = good && std::isfinite(h.spin[shapes_header::spins - 1]);
  for (double s : h.scale) good = good && s >= 0 && std::isfinite(s);
  for (double u : h.unit) good = good && positive_number(u);
  for (double e : h.error) good = good && e >= 0 && std::isfinite(e);
  if (!good) return "has an axis or a scale out of range";
  const auto *feature = reinterpret_cast<const float *>(bytes + sizeof h);
  if (!std::all_of(feature, feature + blocks_of(h) * shape_table::lanes * shapes_header::features,
                   [](float f) { return std::isfinite(f); }))
    return "holds values that are no numbers";
  return nullptr;
}

std::pair<const void *, size_t> shape_table::ellipses(const void *data) {
  shapes_header h;
  std::memcpy(&h, data, sizeof h);
  const size_t at = shape_layout_of(h).ellipses;
  return {static_cast<const unsigned char *>(data) + at, h.bytes - at};
}

const char *creep_table_defect(const void *data, size_t size) {
  if (!shape_table::is_one(data, size)) return creep_table::defect(data, size);
  if (const char *found = shape_table::defect(data, size)) return found;
  const auto [inner, length] = shape_table::ellipses(data);
  return creep_table::defect(inner, length);
}

shape_table::shape_table(const void *data, double poisson_ratio)
    : header_(static_cast<const shapes_header *>(data)) {
  const auto *bytes = static_cast<const unsigned char *>(data);
  feature_ = reinterpret_cast<const float *>(bytes + sizeof *header_);
  remainder_ = reinterpret_cast<const int16_t *>(bytes + shape_layout_of(*header_).remainder);
  poisson_in_range_ = std::fabs(poisson_ratio - header_->poisson_ratio) <= poisson_within;
}

shape_of_pressure shape_table::describe(const grid &g, const double *pressure) {
  shape_of_pressure out{};
  double sum = 0, x0 = 0, y0 = 0;
  for (int j = 0; j < g.ny; ++j) {
    double row = 0;
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i];
      row += p;
      x0 += p * g.x(i);
    }
    sum += row;
    y0 += row * g.y(j);
  }
  out.centre[0] = x0 /= sum;
  out.centre[1] = y0 /= sum;
  double xx = 0, yy = 0, xy = 0, x4 = 0, y3 = 0, y4 = 0, xxy = 0, xxyy = 0;
  for (int j = 0; j < g.ny; ++j) {
    row_sums r{0, 0, 0, 0};
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i], x = g.x(i) - x0, px = p * x, pxx = px * x;
      r.zero += p;
      r.one += px;
      r.two += pxx;
      r.four += pxx * x * x;
    }
    const double y = g.y(j) - y0, y2 = y * y;
    xx += r.two;
    x4 += r.four;
    xy += r.one * y;
    yy += r.zero * y2;
    y3 += r.zero * y2 * y;
    y4 += r.zero * y2 * y2;
    xxy += r.two * y;
    xxyy += r.two * y2;
  }
  // elements have a second moment of their own; of Hertz's pressure it is a fifth of the axis
  // squared
  const double a = std::sqrt(5.0 * (xx / sum + g.dx * g.dx / 12.0));
  const double b = std::sqrt(5.0 * (yy / sum + g.dy * g.dy / 12.0));
  out.axes[0] = a;
  out.axes[1] = b;
  const double bb = b * b, aa = a * a;
  out.feature = {
      log(a / b),           y3 / (sum * bb * b),    y4 / (sum * bb * bb), xy / (sum * a * b),
      xxy / (sum * aa * b), xxyy / (sum * aa * bb), x4 / (sum * aa * aa), 0.0};
  return out;
}

// The nearest nodes and the one after them, in order; returns how many.
int shape_table::nearest(const shape_features &feature,
                         std::array<near, neighbours + 1> &found) const {
  constexpr int blocks = 32, most = blocks * lanes;
  float squares[most];
  int count = 0;
  for (int first = 0; first < header_->node_count; first += most) {
    const int number = std::min(most, header_->node_count - first);
    add_distances(feature_ + shapes_header::features * first, (number + lanes - 1) / lanes,
                  feature.data(), squares);
    for (int n = 0; n < number; ++n) {
      const double square = static_cast<double>(squares[n]);
      if (count == neighbours + 1 && square >= found[neighbours].distance) continue;
      // of equal ones the first
      int at = count < neighbours + 1 ? count++ : neighbours;
      for (; at > 0 && found[static_cast<size_t>(at - 1)].distance > square; --at)
        found[static_cast<size_t>(at)] = found[static_cast<size_t>(at - 1)];
      found[static_cast<size_t>(at)] = {first + n, square};
    }
  }
  for (int k = 0; k < count; ++k) {
    double &d = found[static_cast<size_t>(k)].distance;
    d = std::sqrt(d);
  }
  return count;
}

// Of the nearest nodes, adding up to 1: value at the shape of the plane through what they have,
//   sum w (y - y0 - s.(f_node - f))^2 + alike^2 |s|^2 least,
// whose normal equations a Cholesky factorisation solves.
shape_table::node_weights shape_table::weigh(const shape_features &feature,
                                             const std::array<near, neighbours + 1> &found) const {
  constexpr int n = shapes_header::features;  // the plane's value and seven slopes
  node_weights weight;
  const double end = found[neighbours].distance;
  double all = 0;
  for (size_t k = 0; k < neighbours; ++k) {
    const double d = found[k].distance, w = end > 0 ? (1.0 - d / end) / (d + alike) : 0.0;
    all += weight[k] = w * w;
  }
  // all as far away as the one that does not count
  if (!(all > 0)) {
    weight.fill(1.0 / neighbours);
    return weight;
  }
  double row[neighbours][n], matrix[n][n] = {};
  for (size_t k = 0; k < neighbours; ++k) {
    weight[k] /= all;
    const int node = found[k].node;
    const float *of = feature_ + node / lanes * (n * lanes) + node % lanes;
    row[k][0] = 1.0;
    for (int i = 1; i < n; ++i)
      row[k][i] = static_cast<double>(of[(i - 1) * lanes]) -
                  static_cast<double>(feature[static_cast<size_t>(i - 1)]);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) matrix[i][j] += weight[k] * row[k][i] * row[k][j];
  }
  for (int i = 1; i < n; ++i) matrix[i][i] += alike * alike;
  // of L L^T = matrix only the first row of the inverse is asked for
  double first[n] = {1.0};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = matrix[i][j];
      for (int k = 0; k < j; ++k) sum -= matrix[i][k] * matrix[j][k];
      matrix[i][j] = i == j ? std::sqrt(sum) : sum / matrix[j][j];
    }
    for (int k = 0; k < i; ++k) first[i] -= matrix[i][k] * first[k];
    first[i] /= matrix[i][i];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) first[i] -= matrix[k][i] * first[k];
    first[i] /= matrix[i][i];
  }
  node_weights plane;
  double size = 0;
  for (size_t k = 0; k < neighbours; ++k) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += first[i] * row[k][i];
    plane[k] = weight[k] * sum;
    size += std::fabs(plane[k]);
  }
  const double kept = fade((size - magnified) / (beyond - magnified));
  for (size_t k = 0; k < neighbours; ++k) weight[k] += kept * (plane[k] - weight[k]);
  return weight;
}

// Where creepages lie between a node's remainders: four along each axis.
struct shape_table::place_between {
  std::array<int, 64> offset;  // of a node's numbers
  std::array<double, 64> weight;
  int count = 0;
};

// Spin, direction and t between the remainders. Where an axis ends at 0 it goes on with the
// opposite direction: -v has the same forces with the other sign. At t = 1 all slides, and nothing
// remains.
shape_table::place_between shape_table::between(const double v[3]) const {
  const shapes_header &h = *header_;
  const double size = hypot(v[0], v[1]);
  double turn = atan2(v[1], v[0]) / (2.0 * pi) * directions;
  if (turn < 0) turn += directions;
  const double t = size / (h.radius + size) * radii;
  const int first[2] = {std::min(static_cast<int>(turn), directions - 1),
                        std::min(static_cast<int>(t), radii - 1)};
  int spin = 0;
  while (spin + 2 < shapes_header::spins && h.spin[spin + 1] < v[2]) ++spin;
  double spins[4];
  for (int k = 0; k < 4; ++k) {
    const int n = spin - 1 + k;
    spins[k] = n < 0 ? -h.spin[1] : h.spin[std::min(n, shapes_header::spins - 1)];
  }
  const bool last_spin = spin + 2 == shapes_header::spins;
  const std::array<double, 4> of_spin =
      cubic_weights(spins, std::min(v[2], h.spin[shapes_header::spins - 1]), last_spin);
  const double even[4] = {-1, 0, 1, 2};
  const std::array<double, 4> of_turn = cubic_weights(even, turn - first[0], false);
  const std::array<double, 4> of_t = cubic_weights(even, t - first[1], first[1] == radii - 1);

  place_between out;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        int s = spin - 1 + k, d = first[0] - 1 + j, r = first[1] - 1 + i;
        double weight = of_spin[static_cast<size_t>(k)] * of_turn[static_cast<size_t>(j)] *
                        of_t[static_cast<size_t>(i)];
        if (r >= radii || weight == 0) continue;
        if (s < 0) s = -s, d += directions / 2, weight = -weight;
        if (r < 0) r = -r, d += directions / 2;
        const int cell = (s * directions + (d + directions) % directions) * radii + r;
        out.offset[static_cast<size_t>(out.count)] = 4 * cell;
        out.weight[static_cast<size_t>(out.count++)] = weight;
      }
  return out;
}

// Adds a node's remainders, in their units.
void shape_table::interpolate(int node, const place_between &place, double weight,
                              double sum[3]) const {
  const int16_t *of = remainder_ + 4 * static_cast<size_t>(node) * shape_cells;
  double found[4];
  add_cells(of, place.offset.data(), place.weight.data(), place.count, found);
  for (int d = 0; d < 3; ++d) sum[d] += weight * found[d];
}

shape_table::correction shape_table::evaluate(const grid &g, const double *pressure,
                                              double shear_modulus, double bound,
                                              const double creepage[2], double spin_creepage,
                                              int direction) {
  correction out{{0, 0}, 0, poisson_in_range_};
  if (!(bound > 0)) return out;
  const shapes_header &h = *header_;
  shape_of_pressure shape = describe(g, pressure);
  // of the powers of x only x y turns its sign in the mirror image
  shape.feature[3] *= direction;
  shape_features feature;
  for (size_t k = 0; k < feature.size(); ++k)
    feature[k] = static_cast<float>(h.scale[k] * shape.feature[k]);
  std::array<near, neighbours + 1> found;
  nearest(feature, found);
  if (!(found[0].distance <= h.reach)) out.in_range = false;

  const double square = shape.axes[0] * shape.axes[1], c = std::sqrt(square);
  // spin moves the ends of a long contact by as much as its length tells
  const double reach =
      std::sqrt(0.5 * (shape.axes[0] * shape.axes[0] + shape.axes[1] * shape.axes[1]));
  const double scale = shear_modulus * square / bound;
  double v[3] = {
      scale * shape_stiffness[0] * direction * (creepage[0] - spin_creepage * shape.centre[1]),
      scale * shape_stiffness[1] * (creepage[1] + spin_creepage * shape.centre[0]),
      scale * shape_stiffness[2] * direction * reach * spin_creepage};
  const double mirror = v[2] < 0 ? -1.0 : 1.0;
  for (double &part : v) part *= mirror;
  double sum[3] = {0, 0, 0};
  const place_between place = between(v);
  const node_weights weight = weigh(feature, found);
  for (size_t k = 0; k < neighbours; ++k)
    if (weight[k] != 0) interpolate(found[k].node, place, weight[k], sum);
  out.force[0] = mirror * direction * bound * h.unit[0] * sum[0];
  out.force[1] = mirror * bound * h.unit[1] * sum[1];
  out.moment = mirror * direction * bound * c * h.unit[2] * sum[2] +
               shape.centre[0] * out.force[1] - shape.centre[1] * out.force[0];
  return out;
}

}  // namespace railpatch
