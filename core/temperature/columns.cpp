#include "temperature/columns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

using std::numbers::inv_sqrtpi;
using std::numbers::pi;

namespace {

// step in u, and ages between which the sum of exponentials holds, in passages of one element;
// `longest` counts rows
constexpr double step = 0.25, shortest = 1.0 / 256.0, longest = 256.0;
// change of speed that the modes take without being moved
constexpr double speed_window = 8.0;
// places closer than this to a whole number of elements are on it
constexpr double snap = 1e-9;
// head of the state
enum { at_nx, at_ny, at_offset, at_unit, head_size = 8 };

RAILPATCH_DISPATCH void accumulate(int n, double w, const double *y, double *sum) {
  RAILPATCH_INDEPENDENT
  for (int i = 0; i < n; ++i) sum[i] += w * y[i];
}

RAILPATCH_DISPATCH void decay_and_add(int n, double decay, double gain, const double *q,
                                      double *y) {
  RAILPATCH_INDEPENDENT
  for (int i = 0; i < n; ++i) y[i] = decay * y[i] + gain * q[i];
}

RAILPATCH_DISPATCH void scale(int n, double decay, double *y) {
  RAILPATCH_INDEPENDENT
  for (int i = 0; i < n; ++i) y[i] *= decay;
}

// Each element takes the value of the one behind it.
void shift_row(int nx, int direction, double *row) {
  if (direction > 0) {
    std::copy_backward(row, row + nx - 1, row + nx);
    row[0] = 0;
  } else {
    std::copy(row + 1, row + nx, row);
    row[nx - 1] = 0;
  }
}

// f(k, share): the value at `at` of a function even in k, by Lagrange's polynomial on 6 points.
template <class F>
void for_each_point(double at, F &&f) {
  const int begin = static_cast<int>(std::floor(at)) - 2;
  for (int i = 0; i < 6; ++i) {
    double share = 1;
    for (int k = 0; k < 6; ++k)
      if (k != i) share *= (at - begin - k) / (i - k);
    f(std::abs(begin + i), share);
  }
}

double least_node(int max_nx) { return std::sqrt(8.0 / (longest * max_nx)); }

int mode_count(int max_nx) {
  const double top = std::sqrt(20.0 / shortest) / least_node(max_nx);
  return 1 + static_cast<int>(std::ceil(asinh(top) / step));
}

}  // namespace

double dawson(double x) {
  constexpr double h = 0.2;
  // the sum's terms beyond 36 are below rounding; n0 even
  const double n0 = 2.0 * std::round(0.5 * x / h);
  const double xp = x - n0 * h;
  double e1 = exp(2.0 * xp * h), d1 = n0 + 1, d2 = n0 - 1, sum = 0;
  const double e2 = e1 * e1;
  for (int i = 0; i < 18; ++i) {
    const double odd = (2 * i + 1) * h;
    sum += exp(-odd * odd) * (e1 / d1 + 1.0 / (d2 * e1));
    d1 += 2;
    d2 -= 2;
    e1 *= e2;
  }
  return inv_sqrtpi * exp(-xp * xp) * sum;
}

// What one column has exchanged: closed form of its last contact, modes of those before.
struct heat_columns::exchange_column {
  double jump = 0, touched = 0, since = 0;  // -, s, s; touched = since: in contact
  bool again = false;                       // modes are not all zero
  bool touches() const { return touched > 0 && touched == since; }
};

heat_columns::heat_columns(int max_nx, int max_ny, bool exchanges)
    : max_nx_(max_nx),
      capacity_(static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny)),
      exchanges_(exchanges),
      kernel_(max_nx) {
  const double x0 = least_node(max_nx);
  modes_ = mode_count(max_nx);
  const auto m = static_cast<size_t>(modes_);
  for (auto *b : {&node_, &node_weight_, &rate_, &weight_, &decay_, &gain_, &column_, &scratch_})
    *b = aligned_buffer<double>(m);
  for (size_t k = 0; k < m; ++k) {
    const double u = step * static_cast<double>(k);
    node_[k] = x0 * sinh(u);
    node_weight_[k] = (k == 0 ? 1.0 : 2.0) * x0 * step * cosh(u) / pi;
  }
  for (auto *b : {&sum_, &memory_}) *b = aligned_buffer<double>(capacity_);
  if (exchanges) exchanged_ = aligned_buffer<double>(capacity_);
}

size_t heat_columns::bytes() const {
  return kernel_.bytes() + 8 * node_.bytes() + sum_.bytes() + memory_.bytes() + exchanged_.bytes();
}

size_t heat_columns::flux_at() const { return head_size + static_cast<size_t>(modes_) * capacity_; }

size_t heat_columns::exchange_at() const { return flux_at() + capacity_; }

size_t heat_columns::state_size() const {
  const size_t exchange = (4 + static_cast<size_t>(modes_)) * capacity_;
  return modes_ == 0 ? 0 : exchange_at() + (exchanges_ ? exchange : 0);
}

size_t heat_columns::state_size(int max_nx, int max_ny, bool exchanges) {
  const auto n = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  const auto modes = static_cast<size_t>(mode_count(max_nx));
  return head_size + (modes + 1 + (exchanges ? 4 + modes : 0)) * n;
}

void heat_columns::reset(double *state) const { std::fill_n(state, state_size(), 0.0); }

double heat_columns::offset(const double *state) { return state[at_offset]; }

double heat_columns::stored(int i, int j, const double *state) const {
  // the mode of rate 0
  return state[head_size + static_cast<size_t>(j * static_cast<int>(state[at_nx]) + i)];
}

void heat_columns::set_rates(double unit) {
  unit_ = unit;
  duration_ = -1;
  for (size_t k = 0; k < node_.size(); ++k) {
    rate_[k] = node_[k] * node_[k] / unit;
    weight_[k] = node_weight_[k] / std::sqrt(unit);
  }
}

void heat_columns::set_factors(double duration) {
  if (duration == duration_) return;
  duration_ = duration;
  for (size_t k = 0; k < node_.size(); ++k) {
    const double fall = expm1(-rate_[k] * duration);
    decay_[k] = 1.0 + fall;
    gain_[k] = rate_[k] > 0 ? -fall / rate_[k] : duration;
  }
}

// Flux 1 for the time `unit` until `age` ago, minus what the modes make of it: the part of the last
// flux that they do not see while it is young.
double heat_columns::local_part(double age) const {
  double sum = constant_flux(age + unit_, 0.0) - constant_flux(age, 0.0);
  for (size_t k = 0; k < node_.size(); ++k) {
    const double mode = rate_[k] > 0 ? -expm1(-rate_[k] * unit_) / rate_[k] : unit_;
    sum -= weight_[k] * exp(-rate_[k] * age) * mode;
  }
  return sum;
}

heat_columns::movement heat_columns::move(double offset) const {
  const double dx = rows_.dx;
  movement m;
  // material moves against the rolling
  const double place = offset - rows_.direction * distance_;
  const double whole = std::round(place / dx);
  m.shift = static_cast<int>(std::clamp(whole, -1.0 * rows_.nx, 1.0 * rows_.nx));
  m.offset = place - whole * dx;
  if (std::fabs(m.offset) < snap * dx) m.offset = 0;
  m.travelled = std::clamp(0.5 * dx - rows_.direction * m.offset, 0.0, dx);
  m.heated = m.travelled + rows_.upstream * dx;
  m.ahead = m.heated > (1.0 + snap) * dx ? -1 : 0;
  m.heated = std::min(m.heated + m.ahead * dx, dx);
  return m;
}

template <class F>
void heat_columns::for_each_interval(double travelled, F &&f) const {
  const double dx = rows_.dx, own = std::min(travelled, distance_);
  const double before = (distance_ - own) / dx;
  // what lies further ahead than the grid is no contact
  const int whole = static_cast<int>(std::min(std::floor(before + snap), 1.0 * rows_.nx));
  const double first = before - whole;
  if (whole < rows_.nx && first > snap) f(first * dx / rows_.speed, whole + 1);
  for (int m = whole; m > 0; --m) f(dx / rows_.speed, m);
  if (own > snap * dx) f(own / rows_.speed, 0);
}

void heat_columns::begin(const heat_rows &rows, double distance, const double *pressure,
                         double *state) {
  if (state[at_nx] != rows.nx || state[at_ny] != rows.ny) {
    reset(state);
    state[at_nx] = rows.nx;
    state[at_ny] = rows.ny;
  }
  // no time passes where nothing rolls
  rows_ = rows;
  distance_ = rows.speed > 0 ? distance : 0.0;
  kernel_.set(rows, distance_);
  if (rows.speed > 0) {
    const double unit = rows.dx / rows.speed, ratio = state[at_unit] / unit;
    if (state[at_unit] == 0)
      state[at_unit] = unit;
    else if (!(ratio > 1.0 / speed_window && ratio < speed_window))
      set_unit(unit, state);
  }
  if (state[at_unit] > 0 && state[at_unit] != unit_) set_rates(state[at_unit]);
  movement_ = move(state[at_offset]);
  remember(state[at_offset], state);
  if (exchanges_) exchange(pressure, state);
}

// Y that earlier steps leave at the end of this one, at element centres: each centre's material
// stood between two columns at the step's begin.
void heat_columns::remember(double offset, const double *state) {
  const int n = rows_.nx * rows_.ny;
  std::fill_n(sum_.data(), n, 0.0);
  std::fill_n(memory_.data(), n, 0.0);
  const double from = (rows_.direction * distance_ - offset) / rows_.dx;
  if (!(state[at_unit] > 0) || !(std::fabs(from) < rows_.nx)) return;
  const double duration = rows_.speed > 0 ? distance_ / rows_.speed : 0.0;
  set_factors(duration);
  for (int k = 0; k < modes_; ++k) {
    const auto mode = static_cast<size_t>(k);
    // a sum of terms that have died out is not worth its time
    if (decay_[mode] < 1e-18) break;
    accumulate(n, weight_[mode] * decay_[mode], state + head_size + mode * capacity_, sum_.data());
  }
  accumulate(n, local_part(duration), state + flux_at(), sum_.data());
  double base = std::floor(from), w = from - base;
  if (w < snap) w = 0;
  if (w > 1.0 - snap) {
    w = 0;
    base += 1;
  }
  const int nx = rows_.nx, shift = static_cast<int>(base);
  for (int j = 0; j < rows_.ny; ++j) {
    const double *row = sum_.data() + static_cast<ptrdiff_t>(j) * nx;
    double *out = memory_.data() + static_cast<ptrdiff_t>(j) * nx;
    // ahead of the grid all is fresh; behind it the last column is the nearest known
    const auto sample = [&](int k) {
      const bool ahead = rows_.direction > 0 ? k >= nx : k < 0;
      return ahead ? 0.0 : row[std::clamp(k, 0, nx - 1)];
    };
    for (int i = 0; i < nx; ++i)
      out[i] =
          w == 0 ? sample(i + shift) : (1.0 - w) * sample(i + shift) + w * sample(i + shift + 1);
  }
}

void heat_columns::shift_columns(double *field) const {
  const int nx = rows_.nx, shift = movement_.shift;
  if (shift == 0) return;
  for (int j = 0; j < rows_.ny; ++j) {
    double *row = field + static_cast<ptrdiff_t>(j) * nx;
    const int kept = nx - std::abs(shift);
    if (shift < 0)
      std::copy(row - shift, row + nx, row);
    else
      std::copy_backward(row, row + kept, row + nx);
    std::fill_n(shift < 0 ? row + kept : row, nx - kept, 0.0);
  }
}

// The step's flux of the elements so many ahead of the columns, over a part of the step.
void heat_columns::heat_rows_of(const double *q, double duration, int ahead, double *state) {
  const int nx = rows_.nx, n = nx * rows_.ny;
  set_factors(duration);
  // the columns whose element then was outside the grid, and the others; towards +x
  const int outside = std::min(std::abs(ahead), nx), inside = nx - outside;
  const int towards = rows_.direction * ahead;
  const int still = towards > 0 ? inside : 0, heated = towards < 0 ? outside : 0;
  const int from = towards > 0 ? outside : 0;
  for (int k = 0; k < modes_; ++k) {
    const auto mode = static_cast<size_t>(k);
    double *y = state + head_size + mode * capacity_;
    for (int at = 0; at < n; at += nx) {
      scale(outside, decay_[mode], y + at + still);
      decay_and_add(inside, decay_[mode], gain_[mode], q + at + from, y + at + heated);
    }
  }
}

void heat_columns::commit(const double *q, const double *pressure, double *state) {
  if (!(rows_.speed > 0) || distance_ == 0) return;
  const int nx = rows_.nx, n = nx * rows_.ny;
  for (int k = 0; k < modes_; ++k)
    shift_columns(state + head_size + static_cast<size_t>(k) * capacity_);
  for_each_interval(movement_.heated, [&](double duration, int ahead) {
    heat_rows_of(q, duration, ahead + movement_.ahead, state);
  });
  double *last = state + flux_at();
  std::copy_n(q, n, last);
  // the column's last element is the one behind its own
  if (movement_.ahead < 0)
    for (int at = 0; at < n; at += nx) shift_row(nx, rows_.direction, last + at);
  state[at_offset] = movement_.offset;
  if (!exchanges_) return;
  double *e = state + exchange_at();
  for (int k = 0; k < modes_ + 4; ++k) shift_columns(e + static_cast<size_t>(k) * capacity_);
  for (int c = 0; c < n; ++c) {
    exchange_column column = load(state, c);
    for_each_interval(movement_.travelled, [&](double duration, int ahead) {
      pass(column, duration, touched_by(pressure, c / nx, c % nx + rows_.direction * ahead));
    });
    store(column, state, c);
  }
}

bool heat_columns::touched_by(const double *pressure, int row, int i) const {
  return i >= 0 && i < rows_.nx && pressure[row * rows_.nx + i] > 0;
}

heat_columns::exchange_column heat_columns::load(const double *state, int column) {
  const double *e = state + exchange_at() + column;
  exchange_column c{e[0], e[capacity_], e[2 * capacity_], e[3 * capacity_] != 0};
  if (c.again)
    for (size_t k = 0; k < node_.size(); ++k) column_[k] = e[(4 + k) * capacity_];
  else
    std::fill_n(column_.data(), modes_, 0.0);
  return c;
}

void heat_columns::store(const exchange_column &c, double *state, int column) const {
  double *e = state + exchange_at() + column;
  e[0] = c.jump;
  e[capacity_] = c.touched;
  e[2 * capacity_] = c.since;
  e[3 * capacity_] = c.again;
  if (c.again)
    for (size_t k = 0; k < node_.size(); ++k) e[(4 + k) * capacity_] = column_[k];
}

// E at the surface of the column whose modes are in column_.
double heat_columns::value(const exchange_column &c) const {
  double sum = c.touched > 0 ? c.jump * levelled(c.touched, c.since, 0.0) : 0.0;
  for (size_t k = 0; c.again && k < node_.size(); ++k) sum += weight_[k] * column_[k];
  return sum;
}

void heat_columns::pass(exchange_column &c, double duration, bool touches) {
  if (touches && !c.touches()) {
    const double jump = 1.0 - value(c);
    // the modes take the last contact over
    for (size_t k = 0; c.touched > 0 && k < node_.size(); ++k) {
      const double x = std::sqrt(rate_[k]), root = std::sqrt(c.touched);
      const double met = x > 0 ? dawson(x * root) / x : root;
      column_[k] += c.jump * 2.0 * inv_sqrtpi * met * exp(-rate_[k] * (c.since - c.touched));
      c.again = true;
    }
    c.jump = jump;
    c.touched = c.since = 0;
  }
  if (touches) c.touched += duration;
  if (c.touched > 0) c.since += duration;
  if (!c.again) return;
  set_factors(duration);
  double left = 0, flux = 0;
  for (size_t k = 0; k < node_.size(); ++k) {
    column_[k] *= decay_[k];
    left += weight_[k] * column_[k];
  }
  // what earlier contacts have levelled out fades: flux keeps the surfaces equal
  if (touches) flux = (1.0 - c.jump - left) / constant_flux(duration, 0.0);
  for (size_t k = 0; flux != 0 && k < node_.size(); ++k) column_[k] += flux * gain_[k];
}

void heat_columns::exchange(const double *pressure, const double *state) {
  const int nx = rows_.nx, n = nx * rows_.ny;
  for (int c = 0; c < n; ++c) {
    const int i = c % nx, old = i - movement_.shift;
    exchange_column column;
    if (old >= 0 && old < nx)
      column = load(state, c - movement_.shift);
    else
      std::fill_n(column_.data(), modes_, 0.0);
    for_each_interval(movement_.travelled, [&](double duration, int ahead) {
      pass(column, duration, touched_by(pressure, c / nx, i + rows_.direction * ahead));
    });
    sum_[static_cast<size_t>(c)] = column.touches() ? 1.0 : value(column);
  }
  to_centres(sum_.data(), 0.0, exchanged_.data());
  for (int c = 0; c < n; ++c)
    if (pressure[c] > 0) exchanged_[static_cast<size_t>(c)] = 1.0;
}

void heat_columns::set_unit(double unit, double *state) {
  const double factor = std::sqrt(state[at_unit] / unit);
  set_rates(state[at_unit]);
  const int n = rows_.nx * rows_.ny;
  for (int c = 0; c < n; ++c) {
    convert_modes(factor, state + head_size, state + flux_at(), c);
    if (exchanges_ && state[exchange_at() + 3 * capacity_ + static_cast<size_t>(c)] != 0)
      convert_modes(factor, state + exchange_at() + 4 * capacity_, nullptr, c);
  }
  state[at_unit] = unit;
}

// From nodes x to nodes factor x; beyond the last node a mode follows its flux.
void heat_columns::convert_modes(double factor, double *modes, const double *flux, int column) {
  double *y = modes + column;
  const double x0 = node_[1] / sinh(step);
  for (size_t k = 0; k < node_.size(); ++k) scratch_[k] = y[k * capacity_];
  for (size_t k = 0; k < node_.size(); ++k) {
    const double at = asinh(factor * node_[k] / x0) / step;
    double moved = 0;
    for_each_point(std::min(at, modes_ - 4.0),
                   [&](int i, double share) { moved += share * scratch_[static_cast<size_t>(i)]; });
    if (at <= modes_ - 4.0)
      y[k * capacity_] = moved;
    else
      y[k * capacity_] = flux ? flux[column] / (factor * factor * rate_[k]) : 0.0;
  }
}

// Weights of the modes in scratch_ for 2/pi int y(x) cos(x depth) dx. The modes are smooth in u but
// the cosine is not: sixteen points a mode, each from six modes.
void heat_columns::weigh(double depth) {
  constexpr int finer = 16;
  const double x0 = node_[1] / sinh(step), root_unit = std::sqrt(unit_);
  std::fill(scratch_.begin(), scratch_.end(), 0.0);
  for (int m = 0; m <= finer * (modes_ - 4); ++m) {
    const double u = step * m / finer;
    const double w = (m == 0 ? 1.0 : 2.0) * x0 * cosh(u) * step / (finer * pi * root_unit) *
                     cos(x0 * sinh(u) * depth / root_unit);
    for_each_point(1.0 * m / finer,
                   [&](int k, double share) { scratch_[static_cast<size_t>(k)] += w * share; });
  }
}

void heat_columns::at_depth(const thermal_pair &pair, int body, double z, const double *state,
                            double *temperature) {
  const int nx = static_cast<int>(state[at_nx]), n = nx * static_cast<int>(state[at_ny]);
  const double depth = z / std::sqrt(pair.body[body].diffusivity());
  std::fill_n(temperature, n, 0.0);
  if (state[at_unit] > 0) {
    if (state[at_unit] != unit_) set_rates(state[at_unit]);
    weigh(depth);
    // the present flux over one unit of time makes the kink at the surface, which no mode has
    double kink = constant_flux(unit_, depth);
    set_factors(unit_);
    for (size_t m = 0; m < node_.size(); ++m) {
      kink -= scratch_[m] * gain_[m];
      accumulate(n, scratch_[m], state + head_size + m * capacity_, temperature);
    }
    accumulate(n, kink, state + flux_at(), temperature);
  }
  for (int i = 0; i < n; ++i) {
    double e = 0;
    if (exchanges_) {
      const exchange_column c = load(state, i);
      e = c.touched > 0 ? c.jump * levelled(c.touched, c.since, depth) : 0.0;
      for (size_t m = 0; c.again && m < node_.size(); ++m) e += scratch_[m] * column_[m];
    }
    temperature[i] = pair.surface(body, e, temperature[i] / pair.effusivity());
  }
}

// From the columns to the element centres, between which they stand.
void heat_columns::to_centres(const double *columns, double fresh, double *centres) const {
  const int nx = rows_.nx, n = nx * rows_.ny;
  const double w = std::fabs(movement_.offset) / rows_.dx;
  const int other = movement_.offset > 0 ? -1 : 1;
  for (int c = 0; c < n; ++c) {
    const int k = c % nx + other;
    const bool ahead = rows_.direction > 0 ? k >= nx : k < 0;
    const double there = ahead ? fresh : (k >= 0 && k < nx ? columns[c + other] : columns[c]);
    centres[c] = w == 0 ? columns[c] : (1.0 - w) * columns[c] + w * there;
  }
}

}  // namespace railpatch
