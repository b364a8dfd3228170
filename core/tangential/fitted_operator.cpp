#include "tangential/fitted_operator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;

// Fine nodes whose kernels are made in one go.
constexpr int batch = 64;
// A squared slip below this is zero: its inverse must be a number.
constexpr double least_square = 1e-290;

// Strip edges at y = upper, lower from observers a distance x ahead: the kernels times pi G. Of a
// row on itself: by symmetry x and y do not act on each other.
RAILPATCH_DISPATCH
void strip_kernels(int count, const double *distance, double upper, double lower, double nu,
                   double *xx, double *yy) {
  const double upper2 = upper * upper, lower2 = lower * lower;
  for (int i = 0; i < count; ++i) {
    const double x = distance[i];
    const double iu = 1.0 / std::sqrt(x * x + upper2), il = 1.0 / std::sqrt(x * x + lower2);
    const double cu = upper * iu, cl = lower * il;  // Y/r
    const double shear = nu * x * (cu * iu * iu - cl * il * il), direct = (cu - cl) / x;
    xx[i] = shear + (1.0 - nu) * direct;
    yy[i] = direct - shear;
  }
}

// The same beside a strip, where observers may stand abreast of a node: there (cu - cl)/x is
//   x (upper^2 - lower^2) iu^2 il^2/(cu + cl),
// without the division by x and without the difference of two numbers near one.
RAILPATCH_DISPATCH
void strip_kernels_beside(int count, const double *distance, double upper, double lower, double nu,
                          double *xx, double *yy, double *xy) {
  const double upper2 = upper * upper, lower2 = lower * lower;
  const double difference = (upper - lower) * (upper + lower);
  for (int i = 0; i < count; ++i) {
    const double x = distance[i];
    const double iu = 1.0 / std::sqrt(x * x + upper2), il = 1.0 / std::sqrt(x * x + lower2);
    const double cu = upper * iu, cl = lower * il, iul = iu * il;
    const double shear = nu * x * (cu * iu * iu - cl * il * il);
    const double direct = x * difference * iul * iul / (cu + cl);
    xx[i] = shear + (1.0 - nu) * direct;
    yy[i] = direct - shear;
    xy[i] = nu * (cu * cu * iu - cl * cl * il);
  }
}

RAILPATCH_DISPATCH
void add_scaled(int count, double factor, const double *from, double *to) {
  for (int i = 0; i < count; ++i) to[i] += factor * from[i];
}

// t += columns times v, four columns at a time; the order of the sums is that of the columns.
RAILPATCH_DISPATCH
void add_columns(int stride, int columns, const double *matrix, const double *v, double *t) {
  int c = 0;
  for (; c + 4 <= columns; c += 4) {
    const double *m = matrix + static_cast<size_t>(c) * static_cast<size_t>(stride);
    const double v0 = v[c], v1 = v[c + 1], v2 = v[c + 2], v3 = v[c + 3];
    for (int i = 0; i < stride; ++i)
      t[i] += v0 * m[i] + v1 * m[stride + i] + (v2 * m[2 * stride + i] + v3 * m[3 * stride + i]);
  }
  for (; c < columns; ++c) {
    const double *m = matrix + static_cast<size_t>(c) * static_cast<size_t>(stride);
    for (int i = 0; i < stride; ++i) t[i] += v[c] * m[i];
  }
}

}  // namespace

fitted_operator::fitted_operator(const elastic_constants &elastic, double layer_flexibility,
                                 bool line, const contact_rows &rows)
    : elastic_(elastic),
      flexibility_(layer_flexibility),
      line_(line),
      nodes_(rows.nodes()),
      points_(rows.nodes() + 1),
      stride_((2 * points_ + 3) / 4 * 4) {
  const auto n = static_cast<size_t>(nodes_), strips = static_cast<size_t>(rows.strips());
  const auto stride = static_cast<size_t>(stride_);
  rows_ = aligned_buffer<contact_row>(strips);
  point_cosine_ = aligned_buffer<double>(n + 1);
  tau_ = aligned_buffer<double>(n);
  for (int i = 0; i < points_; ++i)
    point_cosine_[static_cast<size_t>(i)] = cos((2 * i + 1) * pi / (2.0 * points_));
  for (int k = 0; k < nodes_; ++k) {
    const double *c = point_cosine_.data() + k;
    tau_[static_cast<size_t>(k)] = (c[0] - rows.cosine(k)) / (c[0] - c[1]);
  }
  for (int f = 0; f < factors; ++f) make_refinement(fine_[f], (2 << f) - 1);
  matrix_ = aligned_buffer<double>(strips * stride * strips * 2 * n);
  rigid_ = aligned_buffer<double>(strips * stride);
  slip_ = aligned_buffer<double>(strips * stride);
  change_ = aligned_buffer<double>(stride);
  for (auto &k : kernel_) k = aligned_buffer<double>(static_cast<size_t>(batch * points_));
  blends_ = aligned_buffer<slip_blend>(strips * n);
}

size_t fitted_operator::bytes() const {
  size_t sum = rows_.bytes() + matrix_.bytes() + 2 * rigid_.bytes() + change_.bytes() +
               blends_.bytes() + point_cosine_.bytes() + tau_.bytes() + 4 * kernel_[0].bytes();
  for (const refinement &r : fine_)
    sum += r.column.bytes() + r.weight.bytes() + r.cosine.bytes() + r.sine.bytes();
  return sum;
}

// Nodes `factor` times as close in the angle, and the cubics that carry a traction over to them.
// Beyond an edge the traction continues as an odd function of the angle.
void fitted_operator::make_refinement(refinement &r, int factor) {
  const int fine = factor * (nodes_ + 1) - 1;
  r.factor = factor;
  r.column = aligned_buffer<int>(4 * static_cast<size_t>(fine));
  r.weight = aligned_buffer<double>(4 * static_cast<size_t>(fine));
  r.cosine = aligned_buffer<double>(static_cast<size_t>(fine));
  r.sine = aligned_buffer<double>(static_cast<size_t>(fine));
  for (int l = 0; l < fine; ++l) {
    const double angle = (l + 1) * pi / (fine + 1);
    r.cosine[static_cast<size_t>(l)] = cos(angle);
    r.sine[static_cast<size_t>(l)] = sin(angle);
    const int base = (l + 1) / factor;
    const double u = static_cast<double>(l + 1 - base * factor) / factor;
    const double weights[4] = {-u * (u - 1) * (u - 2) / 6, (u + 1) * (u - 1) * (u - 2) / 2,
                               -(u + 1) * u * (u - 2) / 2, (u + 1) * u * (u - 1) / 6};
    for (int m = 0; m < 4; ++m) {
      int k = base - 1 + m;
      double sign = 1.0;
      if (k < 0) k = -k, sign = -1.0;
      if (k > nodes_ + 1) k = 2 * (nodes_ + 1) - k, sign = -1.0;
      const auto at = static_cast<size_t>(4 * l + m);
      r.column[at] = k == 0 || k == nodes_ + 1 ? -1 : k - 1;
      r.weight[at] = sign * weights[m];
    }
  }
}

void fitted_operator::set(const contact_rows &rows, const rolling_input &input) {
  const auto same = [](const contact_row &a, const contact_row &b) {
    return a.y == b.y && a.height == b.height && a.x == b.x && a.half_length == b.half_length;
  };
  bool unchanged = count_ == rows.count() && direction_ == input.direction;
  for (int j = 0; unchanged && j < count_; ++j)
    unchanged = same(rows_[static_cast<size_t>(j)], rows[j]);
  count_ = rows.count();
  direction_ = input.direction;
  for (int j = 0; j < count_; ++j) rows_[static_cast<size_t>(j)] = rows[j];
  if (!unchanged) make_blocks();
  for (int j = 0; j < count_; ++j) {
    const contact_row &row = rows_[static_cast<size_t>(j)];
    double *w = rigid_.data() + j * stride_;
    for (int i = 0; i < points_; ++i) {
      const double x = row.x + direction_ * row.half_length * point_cosine_[static_cast<size_t>(i)];
      w[i] = input.slip(0, x, row.y);
      w[points_ + i] = input.slip(1, x, row.y);
    }
  }
  // until the first linearisation: the slip at the collocation point ahead of each node
  std::fill_n(blends_.data(), count_ * nodes_, slip_blend{{1, 0, 0, 1}, {0, 0, 0, 0}});
}

void fitted_operator::make_blocks() {
  bool symmetric = true;
  for (int j = 0; j < count_; ++j) {
    const contact_row &a = rows_[static_cast<size_t>(j)];
    const contact_row &b = rows_[static_cast<size_t>(count_ - 1 - j)];
    symmetric = symmetric && a.half_length == b.half_length && a.x == b.x && a.y == -b.y &&
                a.height == b.height;
  }
  for (int j = 0; j < (symmetric ? (count_ + 1) / 2 : count_); ++j)
    for (int k = 0; k < count_; ++k) {
      assemble(j, k);
      if (symmetric && 2 * j + 1 != count_) mirror(j, k);
    }
  if (flexibility_ > 0)
    for (int j = 0; j < count_; ++j) add_layer(j);
}

// Slip at the collocation points of row `target` from the nodes of row `source`.
void fitted_operator::assemble(int target, int source) {
  const contact_row &t = rows_[static_cast<size_t>(target)];
  const contact_row &s = rows_[static_cast<size_t>(source)];
  const double between = t.y - s.y;
  const double upper = between + 0.5 * s.height, lower = between - 0.5 * s.height;
  // nodes must not be much wider apart than the observers are from the strip's edges
  const double spacing = pi * s.half_length / points_;
  const double distance = std::min(std::abs(upper), std::abs(lower));
  int level = 0;
  while (level + 1 < factors && spacing > fine_[level].factor * distance) ++level;
  const refinement &r = fine_[level];
  const int fine = r.factor * points_ - 1;
  double *to = matrix_.data() + (block(target, source) - matrix_.data());
  std::fill_n(to, 2 * nodes_ * stride_, 0.0);
  const double scale = s.half_length / ((fine + 1) * elastic_.shear_modulus);
  for (int first = 0; first < fine; first += batch) {
    const int count = std::min(batch, fine - first);
    double *x = kernel_[0].data();
    for (int l = 0; l < count; ++l)
      for (int i = 0; i < points_; ++i)
        x[l * points_ + i] = direction_ * (t.x - s.x) +
                             t.half_length * point_cosine_[static_cast<size_t>(i)] -
                             s.half_length * r.cosine[static_cast<size_t>(first + l)];
    make_kernels(count * points_, upper, lower, target == source);
    gather(r, first, count, scale, target != source, to);
  }
}

void fitted_operator::make_kernels(int count, double upper, double lower, bool own) {
  const double *x = kernel_[0].data(), nu = elastic_.poisson_ratio;
  double *xx = kernel_[1].data(), *yy = kernel_[2].data(), *xy = kernel_[3].data();
  if (line_)
    for (int i = 0; i < count; ++i) {
      yy[i] = 2.0 / x[i];
      xx[i] = (1.0 - nu) * yy[i];
    }
  else if (own)
    strip_kernels(count, x, upper, lower, nu, xx, yy);
  else
    strip_kernels_beside(count, x, upper, lower, nu, xx, yy, xy);
}

// Sums the kernels of fine nodes into the columns of a block, weighted by the quadrature.
void fitted_operator::gather(const refinement &r, int first, int count, double scale, bool coupled,
                             double *px) const {
  const int stride = stride_;
  double *py = px + nodes_ * stride;
  const double *xx = kernel_[1].data(), *yy = kernel_[2].data(), *xy = kernel_[3].data();
  for (int l = first; l < first + count; ++l, xx += points_, yy += points_, xy += points_)
    for (int m = 4 * l; m < 4 * l + 4; ++m) {
      const int k = r.column[static_cast<size_t>(m)];
      const double w = scale * r.sine[static_cast<size_t>(l)] * r.weight[static_cast<size_t>(m)];
      if (k < 0 || w == 0) continue;
      add_scaled(points_, w, xx, px + k * stride);
      add_scaled(points_, w, yy, py + k * stride + points_);
      if (!coupled) continue;
      // odd in rolling direction
      add_scaled(points_, direction_ * w, xy, px + k * stride + points_);
      add_scaled(points_, direction_ * w, xy, py + k * stride);
    }
}

// The block of rows that mirror those of another block in y: the coupling of x and y turns round.
void fitted_operator::mirror(int target, int source) {
  const double *from = block(target, source);
  double *to = matrix_.data() + (block(count_ - 1 - target, count_ - 1 - source) - matrix_.data());
  for (int c = 0; c < 2 * nodes_; ++c, from += stride_, to += stride_) {
    const double x = c < nodes_ ? 1.0 : -1.0;
    for (int i = 0; i < points_; ++i) {
      to[i] = x * from[i];
      to[points_ + i] = -x * from[points_ + i];
    }
  }
}

// -direction dp/dx at the collocation points, zero traction at both edges.
void fitted_operator::add_layer(int row) {
  const contact_row &r = rows_[static_cast<size_t>(row)];
  const auto node = [&](int k) { return r.half_length * cos(k * pi / points_); };
  double *px = matrix_.data() + (block(row, row) - matrix_.data());
  double *py = px + nodes_ * stride_;
  for (int i = 0; i < points_; ++i) {
    const double change = flexibility_ / (node(i) - node(i + 1));
    for (int c = 0; c < 2; ++c) {
      double *p = c == 0 ? px + i : py + points_ + i;
      if (i < nodes_) p[i * stride_] += change;
      if (i > 0) p[(i - 1) * stride_] -= change;
    }
  }
}

const double *fitted_operator::block(int target, int source) const {
  return matrix_.data() +
         (static_cast<size_t>(target) * rows_.size() + static_cast<size_t>(source)) * 2 *
             static_cast<size_t>(nodes_ * stride_);
}

// t = slip at the collocation points of a row from the tractions of the rows begin ... end - 1.
void fitted_operator::collocation_slip(int row, const double *v, int begin, int end,
                                       double *t) const {
  const int columns = 2 * nodes_;
  std::fill_n(t, stride_, 0.0);
  add_columns(stride_, columns * (end - begin), block(row, begin), v + begin * columns, t);
}

void fitted_operator::micro_slip(const rolling_problem &problem, const double *p, double *s) {
  for (int c = 0; c < 2; ++c) creepage_[c] = problem.creepage(c);
  for (int j = 0; j < count_; ++j) {
    double *t = slip_.data() + j * stride_;
    collocation_slip(j, p, 0, count_, t);
    const double *w = rigid_.data() + j * stride_;
    for (int i = 0; i < 2 * points_; ++i) t[i] += w[i];
    for (int i = 0; i < points_ && problem.force; ++i) {
      t[i] += problem.creepage(0);
      t[points_ + i] += problem.creepage(1);
    }
    for (int k = 0; k < nodes_; ++k) {
      const double *x = t + k, *y = t + points_ + k, tau = tau_[static_cast<size_t>(k)];
      const double dx = tau * (x[1] - x[0]), dy = tau * (y[1] - y[0]);
      const double size = x[0] * x[0] + y[0] * y[0], change = 4.0 * (dx * dx + dy * dy);
      const double lambda = size > least_square ? size / (size + change) : 0.0;
      s[2 * j * nodes_ + k] = x[0] + lambda * dx;
      s[(2 * j + 1) * nodes_ + k] = y[0] + lambda * dy;
    }
  }
}

// The derivative of the blended slip at the slip of the last call of micro_slip.
void fitted_operator::linearise() {
  for (int j = 0; j < count_; ++j) {
    const double *t = slip_.data() + j * stride_;
    for (int k = 0; k < nodes_; ++k) {
      const double *x = t + k, *y = t + points_ + k, tau = tau_[static_cast<size_t>(k)];
      const double d[2] = {tau * (x[1] - x[0]), tau * (y[1] - y[0])}, s[2] = {x[0], y[0]};
      const double size = s[0] * s[0] + s[1] * s[1], change = 4.0 * (d[0] * d[0] + d[1] * d[1]);
      const double sum = size + change;
      slip_blend &b = blends_[static_cast<size_t>(j * nodes_ + k)];
      const bool slides = size > least_square;
      const double lambda = slides ? size / sum : 0.0;
      const double ahead = slides ? 2.0 * (change / sum) / sum : 0.0;
      const double between = slides ? -8.0 * (size / sum) / sum : 0.0;
      for (int r = 0; r < 2; ++r)
        for (int c = 0; c < 2; ++c) {
          b.ahead[2 * r + c] = (r == c) + d[r] * ahead * s[c];
          b.between[2 * r + c] = tau * ((r == c ? lambda : 0.0) + d[r] * between * d[c]);
        }
    }
  }
}

// ds of a row's nodes from dt at its collocation points.
void fitted_operator::blend_change(int row, const double *t, double *ds) const {
  const slip_blend *blends = blends_.data() + row * nodes_;
  for (int k = 0; k < nodes_; ++k) {
    const double x = t[k], y = t[points_ + k];
    const double dx = t[k + 1] - x, dy = t[points_ + k + 1] - y;
    const slip_blend &b = blends[k];
    ds[k] = b.ahead[0] * x + b.ahead[1] * y + b.between[0] * dx + b.between[1] * dy;
    ds[nodes_ + k] = b.ahead[2] * x + b.ahead[3] * y + b.between[2] * dx + b.between[3] * dy;
  }
}

// A creepage changes the slip everywhere alike, so nothing between the collocation points.
void fitted_operator::slip_of_creepage(const rolling_problem &, int component, double *s) const {
  for (int j = 0; j < count_; ++j)
    for (int k = 0; k < nodes_; ++k) {
      const slip_blend &b = blends_[static_cast<size_t>(j * nodes_ + k)];
      s[2 * j * nodes_ + k] = b.ahead[component];
      s[(2 * j + 1) * nodes_ + k] = b.ahead[2 + component];
    }
}

void fitted_operator::product(const double *v, double *ds) {
  for (int j = 0; j < count_; ++j) {
    collocation_slip(j, v, 0, count_, change_.data());
    blend_change(j, change_.data(), ds + 2 * j * nodes_);
  }
}

bool fitted_operator::product_of_rows_before(int row, const double *v, double *ds) {
  collocation_slip(row, v, 0, row, change_.data());
  blend_change(row, change_.data(), ds);
  return true;
}

void fitted_operator::row_matrices(int row, double *bxx, double *byy) const {
  const slip_blend *blends = blends_.data() + row * nodes_;
  for (int c = 0; c < 2; ++c) {
    const double *column = block(row, row) + c * (nodes_ * stride_ + points_);
    double *matrix = c == 0 ? bxx : byy;
    for (int source = 0; source < nodes_; ++source, column += stride_)
      for (int k = 0; k < nodes_; ++k)
        *matrix++ = blends[k].ahead[3 * c] * column[k] +
                    blends[k].between[3 * c] * (column[k + 1] - column[k]);
  }
}

// At a row's leading edge, from all tractions.
void fitted_operator::edge_displacement(const contact_rows &rows, int row, const double *p,
                                        double u[2]) const {
  const contact_row &t = rows[row];
  const double nu = elastic_.poisson_ratio;
  u[0] = u[1] = 0;
  for (int source = 0; source < count_; ++source) {
    const contact_row &s = rows[source];
    const double between = t.y - s.y;
    const double upper = between + 0.5 * s.height, lower = between - 0.5 * s.height;
    const double weight = s.half_length / (points_ * elastic_.shear_modulus);
    const double *px = p + 2 * source * nodes_, *py = px + nodes_;
    for (int k = 0; k < nodes_; ++k) {
      const double x = t.x - s.x + direction_ * (t.half_length - s.half_length * rows.cosine(k));
      const double ru = hypot(x, upper), rl = hypot(x, lower);
      const double iu = 1.0 / ru, il = 1.0 / rl, share = upper * iu - lower * il;
      // asinh(upper/|x|) - asinh(lower/|x|), beside a strip also where x = 0
      const double rise = lower > 0   ? log((upper + ru) / (lower + rl))
                          : upper < 0 ? log((rl - lower) / (ru - upper))
                                      : log((upper + ru) * (rl - lower) / (x * x));
      const double w = weight * rows.sine(k);
      const double cross = nu * x * (il - iu);
      u[0] += w * (((1.0 - nu) * rise + nu * share) * px[k] + cross * py[k]);
      u[1] += w * ((rise - nu * share) * py[k] + cross * px[k]);
    }
  }
}

double fitted_operator::elastic_energy(const contact_rows &rows, const double *p) const {
  if (line_) return nan;
  double energy = 0;
  for (int j = 0; j < count_; ++j) {
    double u[2];
    edge_displacement(rows, j, p, u);
    const double *t = slip_.data() + j * stride_, *w = rigid_.data() + j * stride_;
    double before = 1.0;
    for (int k = 0; k < nodes_; ++k) {
      // slip minus rigid slip is the displacement's slope downstream
      const double step = rows[j].half_length * (before - rows.cosine(k));
      before = rows.cosine(k);
      u[0] += step * (t[k] - w[k] - creepage_[0]);
      u[1] += step * (t[points_ + k] - w[points_ + k] - creepage_[1]);
      energy +=
          rows.area(j, k) * (p[2 * j * nodes_ + k] * u[0] + p[(2 * j + 1) * nodes_ + k] * u[1]);
    }
  }
  return 0.5 * energy;
}

double fitted_operator::projection_scale(int row) const {
  const double *px = block(row, row), *py = px + nodes_ * stride_ + points_;
  double sum = 0;
  for (int k = 0; k < nodes_; ++k)
    sum += std::abs(px[k * stride_ + k]) + std::abs(py[k * stride_ + k]);
  return 2.0 * nodes_ / sum;
}

}  // namespace railpatch
