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

using std::sqrt;
using std::numbers::pi;
using shapes_header = shape_table_header;

constexpr char shape_magic[8] = {'R', 'P', 'S', 'H', 'A', 'P', 'E', '3'};
constexpr size_t shapes_checked_from = offsetof(shapes_header, node_count);
constexpr double shape_stiffness[3] = {4.2, 3.7, 2.3};
constexpr int shape_functions = shapes_header::functions;
constexpr int cell_numbers = 3 * shape_functions;
constexpr int shape_cells = shapes_header::spins * shape_table::directions * shape_table::radii;
constexpr int most_nodes = 20000;
constexpr double poisson_within = 0.005;

struct shape_layout {
  size_t weight, function, recipe, ellipses;  // bytes from the start
};

size_t whole_words(size_t bytes) { return (bytes + 7) / 8 * 8; }

size_t blocks_of(const shapes_header &h) {
  return (static_cast<size_t>(h.node_count) + shape_table::lanes - 1) / shape_table::lanes;
}

shape_layout shape_layout_of(const shapes_header &h) {
  shape_layout at{};
  at.weight =
      sizeof h + blocks_of(h) * shape_table::lanes * shapes_header::features * sizeof(float);
  at.function = at.weight + blocks_of(h) * shape_table::lanes * shape_functions * sizeof(double);
  at.recipe = at.function + size_t{shape_cells} * cell_numbers * sizeof(int16_t);
  at.ellipses = at.recipe + whole_words(static_cast<size_t>(h.recipe_bytes));
  return at;
}

bool positive_number(double value) { return value > 0 && std::isfinite(value); }

// Distances from one shape to the nodes of a block, each by itself, so that no sum depends on the
// width of the vectors; and Wendland's function of them.
RAILPATCH_DISPATCH void find_near(const float *block, const double *of, double *distance,
                                  double *near) {
  constexpr int lanes = shape_table::lanes;
  double square[lanes] = {};
  for (int k = 0; k < shapes_header::features; ++k)
    for (int lane = 0; lane < lanes; ++lane) {
      const double d = static_cast<double>(block[k * lanes + lane]) - of[k];
      square[lane] += d * d;
    }
  for (int lane = 0; lane < lanes; ++lane) distance[lane] = std::sqrt(square[lane]);
  for (int lane = 0; lane < lanes; ++lane) {
    const double d = distance[lane] < 1.0 ? distance[lane] : 1.0, u = (1.0 - d) * (1.0 - d);
    near[lane] = u * u * (4.0 * d + 1.0);
  }
}

// Adds what the nodes of a block have of each function, each by itself.
RAILPATCH_DISPATCH void add_nodes(const double *weight, const double *near, double *amount) {
  constexpr int lanes = shape_table::lanes;
#if defined(__GNUC__)
  typedef double doubles __attribute__((vector_size(32)));
  constexpr int wide = 4, vectors = shape_functions / wide;
  static_assert(vectors * wide == shape_functions);
  doubles sum[vectors];
  std::memcpy(sum, amount, sizeof sum);
  for (int lane = 0; lane < lanes; ++lane)
    for (int k = 0; k < vectors; ++k) {
      doubles part;
      std::memcpy(&part, weight + lane * shape_functions + k * wide, sizeof part);
      sum[k] += near[lane] * part;
    }
  std::memcpy(amount, sum, sizeof sum);
#else
  for (int lane = 0; lane < lanes; ++lane)
    for (int k = 0; k < shape_functions; ++k)
      amount[k] += near[lane] * weight[lane * shape_functions + k];
#endif
}

// Sums weight[k] times the numbers at offset[k], each by itself.
RAILPATCH_DISPATCH void add_cells(const int16_t *of, const int *offset, const double *weight,
                                  int count, float *sum) {
  std::fill_n(sum, cell_numbers, 0.0f);
  for (int k = 0; k < count; ++k) {
    const auto w = static_cast<float>(weight[k]);
    const int16_t *cell = of + offset[k];
    for (int i = 0; i < cell_numbers; ++i) sum[i] += w * static_cast<float>(cell[i]);
  }
}

// Of values at four rising places x for one between the middle ones: the cubic through these with
// the slopes of parabolas through three neighbours; at the end of an axis, where the last is none,
// with the chord's slope there.
template <class T>
std::array<T, 4> cubic_weights(const double x[4], const T &at, bool ends) {
  const double h = x[2] - x[1], before = x[1] - x[0];
  const T u = (at - x[1]) / h;
  const T slope[2] = {u * (1 - u) * (1 - u) * h, -u * u * (1 - u) * h};
  std::array<T, 4> w = {0, (1 + 2 * u) * (1 - u) * (1 - u), u * u * (3 - 2 * u), 0};
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

// A place in the plane of (v1, v2): its size, and its direction in turns.
struct polar {
  double size, turn;
};
polar polar_of(double x, double y) { return {hypot(x, y), atan2(y, x) / (2.0 * pi)}; }
// At 0 it moves off in the direction of its rate.
struct directed_polar {
  directed size, turn;
};
directed_polar polar_of(const directed &x, const directed &y) {
  if (x.value != 0 || y.value != 0) return {hypot(x, y), atan2(y, x) / (2.0 * pi)};
  const double dx = x.rate[0], dy = y.rate[0];
  return {directed_of(0.0, hypot(dx, dy)), directed(atan2(dy, dx) / (2.0 * pi))};
}

bool counts(double weight) { return weight != 0; }
bool counts(const directed &weight) { return weight.value != 0 || weight.rate[0] != 0; }

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
  if (h.node_count < 1 || h.node_count > most_nodes)
    return "has less than one or more than 20000 shapes";
  if (h.recipe_bytes < 0 || shape_layout_of(h).ellipses > size)
    return "has not the length that its shapes ask for";
  if (table_checksum(bytes + shapes_checked_from, size - shapes_checked_from) != h.checksum)
    return "has a wrong checksum: it was altered";
  bool good = h.poisson_ratio > -1 && h.poisson_ratio <= 0.5 && positive_number(h.reach) &&
              positive_number(h.radius) && h.spin[0] == 0;
  for (int k = 0; k + 1 < shapes_header::spins; ++k) good = good && h.spin[k] < h.spin[k + 1];
  good = good && std::isfinite(h.spin[shapes_header::spins - 1]);
  for (double s : h.scale) good = good && s >= 0 && std::isfinite(s);
  good = good && positive_number(h.unit);
  for (double e : h.error) good = good && e >= 0 && std::isfinite(e);
  if (!good) return "has an axis or a scale out of range";
  const shape_layout at = shape_layout_of(h);
  const auto *feature = reinterpret_cast<const float *>(bytes + sizeof h);
  const auto *weight = reinterpret_cast<const double *>(bytes + at.weight);
  const auto finite = [](double f) { return std::isfinite(f); };
  if (!std::all_of(feature, feature + (at.weight - sizeof h) / sizeof(float), finite) ||
      !std::all_of(weight, weight + (at.function - at.weight) / sizeof(double), finite))
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
  const shape_layout at = shape_layout_of(*header_);
  feature_ = reinterpret_cast<const float *>(bytes + sizeof *header_);
  weight_ = reinterpret_cast<const double *>(bytes + at.weight);
  function_ = reinterpret_cast<const int16_t *>(bytes + at.function);
  poisson_in_range_ = std::fabs(poisson_ratio - header_->poisson_ratio) <= poisson_within;
}

template <class T>
basic_shape<T> shape_table::describe(const pressure_view<T> &g) {
  basic_shape<T> out{};
  T sum = 0, x0 = 0, y0 = 0;
  for (int j = 0; j < g.ny; ++j) {
    T row = 0;
    for (int i = 0; i < g.nx; ++i) {
      const T p = g.at(j * g.nx + i);
      row += p;
      x0 += p * g.x(i);
    }
    sum += row;
    y0 += row * g.y(j);
  }
  out.centre[0] = x0 /= sum;
  out.centre[1] = y0 /= sum;
  T xx = 0, yy = 0, xy = 0, x4 = 0, y3 = 0, y4 = 0, xxy = 0, xxyy = 0, gathered = 0;
  for (int j = 0; j < g.ny; ++j) {
    row_sums<T> r{0, 0, 0, 0};
    for (int i = 0; i < g.nx; ++i) {
      const T p = g.at(j * g.nx + i), x = g.x(i) - x0, px = p * x, pxx = px * x;
      r.zero += p;
      r.one += px;
      r.two += pxx;
      r.four += pxx * x * x;
    }
    const T y = g.y(j) - y0, y2 = y * y;
    gathered += r.zero * r.zero;
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
  const T a = sqrt(5.0 * (xx / sum + g.dx * g.dx / 12.0));
  const T b = sqrt(5.0 * (yy / sum + g.dy * g.dy / 12.0));
  out.axes[0] = a;
  out.axes[1] = b;
  const T bb = b * b, aa = a * a;
  out.feature = {log(a / b),           y3 / (sum * bb * b),
                 y4 / (sum * bb * bb), xy / (sum * a * b),
                 xxy / (sum * aa * b), xxyy / (sum * aa * bb),
                 x4 / (sum * aa * aa), log(gathered * b / (sum * sum * g.dy))};
  return out;
}

// How much of each function a shape has; returns the distance of the nearest node.
double shape_table::weigh(const shape_features<double> &feature, amounts<double> &amount) const {
  amount.fill(0.0);
  double nearest = 1e9, distance[lanes], near[lanes];
  for (int first = 0; first < header_->node_count; first += lanes) {
    find_near(feature_ + shapes_header::features * first, feature.data(), distance, near);
    for (double d : distance) nearest = std::min(nearest, d);
    // of what fills up the last block nothing is near
    add_nodes(weight_ + shape_functions * first, near, amount.data());
  }
  amount[0] = 1.0;
  return nearest;
}

// The same with rates: of d^2 = sum (f - f_n)^2, d near/dd = -20 d (1 - d)^3.
double shape_table::weigh(const shape_features<directed> &feature,
                          amounts<directed> &amount) const {
  constexpr int features = shapes_header::features;
  shape_features<double> place;
  for (size_t k = 0; k < place.size(); ++k) place[k] = feature[k].value;
  amounts<double> value{}, rate{};
  double nearest = 1e9, distance[lanes], near[lanes], change[lanes];
  for (int first = 0; first < header_->node_count; first += lanes) {
    const float *block = feature_ + features * first;
    find_near(block, place.data(), distance, near);
    for (int lane = 0; lane < lanes; ++lane) {
      nearest = std::min(nearest, distance[lane]);
      change[lane] = 0;
      if (!(distance[lane] < 1)) continue;
      double along = 0;
      for (int k = 0; k < features; ++k) {
        const auto at = static_cast<size_t>(k);
        along += (place[at] - static_cast<double>(block[k * lanes + lane])) * feature[at].rate[0];
      }
      const double u = 1.0 - distance[lane];
      change[lane] = -20.0 * u * u * u * along;
    }
    add_nodes(weight_ + shape_functions * first, near, value.data());
    add_nodes(weight_ + shape_functions * first, change, rate.data());
  }
  for (size_t k = 0; k < amount.size(); ++k) amount[k] = directed_of(value[k], rate[k]);
  amount[0] = 1.0;
  return nearest;
}

// Where creepages lie between the functions' numbers: four along each axis.
template <class T>
struct shape_table::place_between {
  std::array<int, 64> offset;  // of a cell's numbers
  std::array<T, 64> weight;
  int count = 0;
};

// Spin, direction and t between the cells. Where an axis ends at 0 it goes on with the
// opposite direction: -v has the same forces with the other sign. At t = 1 all slides, and nothing
// remains.
template <class T>
shape_table::place_between<T> shape_table::between(const T v[3]) const {
  const shapes_header &h = *header_;
  const auto at = polar_of(v[0], v[1]);
  const T &size = at.size;
  T turn = at.turn * directions;
  if (turn < 0.0) turn += directions;
  const T t = size / (h.radius + size) * radii;
  const int first[2] = {std::min(static_cast<int>(value_of(turn)), directions - 1),
                        std::min(static_cast<int>(value_of(t)), radii - 1)};
  int spin = 0;
  while (spin + 2 < shapes_header::spins && h.spin[spin + 1] < value_of(v[2])) ++spin;
  double spins[4];
  for (int k = 0; k < 4; ++k) {
    const int n = spin - 1 + k;
    spins[k] = n < 0 ? -h.spin[1] : h.spin[std::min(n, shapes_header::spins - 1)];
  }
  const bool last_spin = spin + 2 == shapes_header::spins;
  const std::array<T, 4> of_spin =
      cubic_weights<T>(spins, std::min(v[2], T(h.spin[shapes_header::spins - 1])), last_spin);
  const double even[4] = {-1, 0, 1, 2};
  const std::array<T, 4> of_turn = cubic_weights<T>(even, turn - first[0], false);
  const std::array<T, 4> of_t = cubic_weights<T>(even, t - first[1], first[1] == radii - 1);

  place_between<T> out;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        int s = spin - 1 + k, d = first[0] - 1 + j, r = first[1] - 1 + i;
        T weight = of_spin[static_cast<size_t>(k)] * of_turn[static_cast<size_t>(j)] *
                   of_t[static_cast<size_t>(i)];
        if (r >= radii || !counts(weight)) continue;
        if (s < 0) s = -s, d += directions / 2, weight = -weight;
        if (r < 0) r = -r, d += directions / 2;
        const int cell = (s * directions + (d + directions) % directions) * radii + r;
        out.offset[static_cast<size_t>(out.count)] = cell_numbers * cell;
        out.weight[static_cast<size_t>(out.count++)] = weight;
      }
  return out;
}

// Fx, Fy and Mz, in the functions' unit.
template <>
void shape_table::interpolate(const place_between<double> &place, const amounts<double> &amount,
                              double sum[3]) const {
  float found[cell_numbers];
  add_cells(function_, place.offset.data(), place.weight.data(), place.count, found);
  for (int d = 0; d < 3; ++d) {
    sum[d] = 0;
    for (int k = 0; k < shape_functions; ++k)
      sum[d] +=
          amount[static_cast<size_t>(k)] * static_cast<double>(found[shape_functions * d + k]);
  }
}

// It is linear in the place's weights and in the amounts.
template <>
void shape_table::interpolate(const place_between<directed> &place, const amounts<directed> &amount,
                              directed sum[3]) const {
  std::array<double, 64> weight, rate;
  for (size_t k = 0; k < static_cast<size_t>(place.count); ++k) {
    weight[k] = place.weight[k].value;
    rate[k] = place.weight[k].rate[0];
  }
  float found[cell_numbers], change[cell_numbers];
  add_cells(function_, place.offset.data(), weight.data(), place.count, found);
  add_cells(function_, place.offset.data(), rate.data(), place.count, change);
  for (int d = 0; d < 3; ++d) {
    sum[d] = 0;
    for (int k = 0; k < shape_functions; ++k) {
      const auto at = static_cast<size_t>(shape_functions * d + k);
      sum[d] += amount[static_cast<size_t>(k)] *
                directed_of(static_cast<double>(found[at]), static_cast<double>(change[at]));
    }
  }
}

template <class T>
shape_table::correction<T> shape_table::evaluate(const pressure_view<T> &pressure,
                                                 double shear_modulus, const T &bound,
                                                 const T creepage[2], const T &spin_creepage,
                                                 int direction) const {
  correction<T> out{{0, 0}, 0, poisson_in_range_};
  if (!(bound > 0.0)) return out;
  const shapes_header &h = *header_;
  basic_shape<T> shape = describe(pressure);
  // of the powers of x only x y turns its sign in the mirror image
  shape.feature[3] *= direction;
  shape_features<T> feature;
  for (size_t k = 0; k < feature.size(); ++k) feature[k] = h.scale[k] * shape.feature[k];
  amounts<T> amount;
  if (!(weigh(feature, amount) <= h.reach)) out.in_range = false;

  const T square = shape.axes[0] * shape.axes[1], c = sqrt(square);
  // spin moves the ends of a long contact by as much as its length tells
  const T reach = sqrt(0.5 * (shape.axes[0] * shape.axes[0] + shape.axes[1] * shape.axes[1]));
  const T scale = shear_modulus * square / bound;
  T v[3] = {
      scale * shape_stiffness[0] * direction * (creepage[0] - spin_creepage * shape.centre[1]),
      scale * shape_stiffness[1] * (creepage[1] + spin_creepage * shape.centre[0]),
      scale * shape_stiffness[2] * direction * reach * spin_creepage};
  const double mirror = v[2] < 0.0 ? -1.0 : 1.0;
  for (T &part : v) part *= mirror;
  T sum[3];
  interpolate(between<T>(v), amount, sum);
  const T unit = mirror * bound * h.unit;
  out.force[0] = direction * unit * sum[0];
  out.force[1] = unit * sum[1];
  out.moment = direction * unit * c * sum[2] + shape.centre[0] * out.force[1] -
               shape.centre[1] * out.force[0];
  return out;
}

template shape_table::correction<double> shape_table::evaluate(const pressure_view<double> &,
                                                               double, const double &,
                                                               const double[2], const double &,
                                                               int) const;
template shape_table::correction<directed> shape_table::evaluate(const pressure_view<directed> &,
                                                                 double, const directed &,
                                                                 const directed[2],
                                                                 const directed &, int) const;

}  // namespace railpatch
