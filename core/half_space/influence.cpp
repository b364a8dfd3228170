#include "half_space/influence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;

// y ln(x + r) with the part that cancels in differences along x taken out: ln(x+r) - ln|y|.
double y_log(double x, double y) { return y * asinh(x / std::abs(y)); }

// primitive of ln(width/|x|)
double line_primitive(double x, double width) { return x * (1.0 + log(width / std::abs(x))); }

}  // namespace

elastic_constants combine(const double shear_modulus[2], const double poisson_ratio[2]) {
  const double gw = shear_modulus[0], gr = shear_modulus[1];
  const double nw = poisson_ratio[0], nr = poisson_ratio[1];
  const double g = 2.0 / (1.0 / gw + 1.0 / gr);
  return {g, 0.5 * g * (nw / gw + nr / gr),
          0.25 * g * ((1.0 - 2.0 * nw) / gw - (1.0 - 2.0 * nr) / gr)};
}

influence::influence(const medium &of, const fft_plans &plans)
    : medium_(of),
      plans_(plans),
      full_(plans.max_nx(), plans.max_ny(), of.tangential),
      single_(plans.max_nx(), plans.max_ny(), of.tangential),
      transform_(plans.max_nx(), plans.max_ny()) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  const size_t table = (nx / 2 + 1) * (ny / 2 + 1), half = (nx / 2 + 1) * ny;
  stride_ = static_cast<int>(nx / 2 + 1);
  for (int k = 0; k < (of.tangential ? 4 : 1); ++k) table_[k] = aligned_buffer<double>(table);
  if (has_physics && of.own) {
    own_ = aligned_buffer<double>(static_cast<size_t>(of.own_columns) *
                                  static_cast<size_t>(of.own_rows) * (of.tangential ? 4 : 1));
    std::copy_n(of.own, own_.size(), own_.data());
    medium_.own = nullptr;
  }
  for (auto &corner : corner_) corner = aligned_buffer<double>((nx / 2 + 2) * (ny / 2 + 2));
  spectrum_ = aligned_buffer<double>(half);
  if (of.curved)
    curved_ = std::make_unique<conformal_influence>(plans, of.tangential, of.layer_flexibility);
  if (!of.follows || of.curved || of.line_width > 0 || of.by_length) return;
  if (!kernel_book::serves(table)) return;
  const int kept = of.tangential ? 3 : 1;
  book_ = std::make_unique<kernel_book>(2 * kept, table);
  mixed_ = aligned_buffer<double>(static_cast<size_t>(kept) * table);
}

bool influence::close(const grid &a, const grid &b) {
  return std::fabs(log(a.dy * b.dx / (b.dy * a.dx))) < kernel_book::step;
}

bool influence::set_grid(const grid &g, int followed) {
  // one element more along x: the product is also seen from one element upstream
  const int plan = plans_.find(2 * g.nx + 1, g.ny > 1 ? 2 * g.ny - 1 : 1);
  if (plan < 0) return false;
  const bool read = book_ && followed >= kernel_book::lead;
  const bool same_elements = g.dx == grid_.dx && g.dy == grid_.dy && read == read_;
  const int half_x = plans_.nx(plan) / 2, half_y = plans_.ny(plan) / 2;
  grid_ = g;
  full_.set_size(g.nx, g.ny, plans_.nx(plan), plans_.ny(plan));
  single_.set_size(g.nx, g.ny, plans_.nx(plan), plans_.ny(plan));
  if (is_curved()) curved_->set_size(g.nx, g.ny, plans_.nx(plan), plans_.ny(plan));
  if (same_elements && plan == plan_) return true;
  plan_ = plan;
  read_ = read;
  transform_.set_size(plans_.nx(plan), plans_.ny(plan));
  if (read) {
    half_x_ = half_x;
    half_y_ = half_y;
    read_book();
    make_spectra();
    return true;
  }
  const bool prepares = book_ && followed > 0;
  const bool made = same_elements && half_x <= half_x_ && half_y <= half_y_ && !prepares;
  if (prepares) {
    half_x_ = half_x;
    half_y_ = half_y;
    prepare_book();
  }
  if (!made) make_kernels(half_x, half_y);
  make_spectra();
  return true;
}

void influence::prepare_book() {
  book_->set_size(plans_.nx(plan_), plans_.ny(plan_));
  book_->prepare(grid_.dy / grid_.dx,
                 [&](double ratio, double *const *arrays) { write_page(ratio, arrays); });
}

// Kept are tables and spectra of xx, yy and xy, without the layer: zz is (1 - nu)/(2 - nu) of xx
// and yy together. Without tractions those of zz.
void influence::read_book() {
  book_->set_size(plans_.nx(plan_), plans_.ny(plan_));
  double *tractions[] = {table_[1].data(), table_[2].data(), table_[3].data(),
                         mixed(0),         mixed(1),         mixed(2)};
  double *pressure[] = {table_[0].data(), mixed(0)};
  book_->read(grid_.dy / grid_.dx, grid_.dx, table_[0].size(),
              medium_.tangential ? tractions : pressure,
              [&](double ratio, double *const *arrays) { write_page(ratio, arrays); });
  if (!medium_.tangential) return;
  for (size_t i = 0; i < table_[0].size(); ++i)
    table_[0][i] = share_of_pressure() * (table_[1][i] + table_[2][i]);
  table_[1][0] += medium_.layer_flexibility;
  table_[2][0] += medium_.layer_flexibility;
}

double influence::share_of_pressure() const {
  const double nu = medium_.elastic.poisson_ratio;
  return (1.0 - nu) / (2.0 - nu);
}

// Of dx = 1 m.
void influence::write_page(double ratio, double *const *arrays) {
  const grid now = grid_;
  grid_.dx = 1;
  grid_.dy = ratio;
  make_half_space_kernels();
  grid_ = now;
  const int kept = medium_.tangential ? 3 : 1, first = medium_.tangential ? 1 : 0;
  const size_t count = table_[0].size();
  for (int k = 0; k < kept; ++k) {
    const bool odd = static_cast<kernel>(first + k) == kernel::xy;
    std::copy_n(table_[first + k].data(), count, arrays[k]);
    transform_.make(odd, table_[first + k].data(), stride_, spectrum_.data());
    std::copy_n(spectrum_.data(), count, arrays[kept + k]);
  }
}

void influence::make_kernels(int half_x, int half_y) {
  half_x_ = half_x;
  half_y_ = half_y;
  if (has_physics && own_.size() > 0) return take_own_kernels();
  if (medium_.line_width > 0)
    make_line_kernels();
  else
    make_half_space_kernels();
  if (!medium_.tangential) return;
  table_[1][0] += medium_.layer_flexibility;
  table_[2][0] += medium_.layer_flexibility;
}

void influence::make_half_space_kernels() {
  const int nx = half_x_ + 2, ny = half_y_ + 2;
  // primitives at the element corners, from half an element before the origin on
  const auto each = [&](auto &&take) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        take((i - 0.5) * grid_.dx, (j - 0.5) * grid_.dy, i, static_cast<size_t>(j * nx + i));
  };
  each([&](double x, double y, int, size_t at) {
    corner_[0][at] = x / std::abs(y);
    corner_[1][at] = y / std::abs(x);
  });
  // y_log of all
  for (int k = 0; k < 2; ++k) asinh_of(corner_[k].data(), nx * ny);
  each([&](double x, double y, int i, size_t at) {
    if (medium_.by_length) return make_rates(x, y, i - 0.5, at);
    corner_[0][at] *= y;
    corner_[1][at] *= x;
    corner_[2][at] = -hypot(x, y);
  });
  const double nu = medium_.elastic.poisson_ratio;
  const double c = 1.0 / (pi * medium_.elastic.shear_modulus);
  for (int j = 0; j <= half_y_; ++j)
    for (int i = 0; i <= half_x_; ++i) {
      double sum[3];
      for (int k = 0; k < 3; ++k) {
        const double *f = corner_[k].data() + j * nx + i;
        sum[k] = (f[nx + 1] - f[nx]) - (f[1] - f[0]);
      }
      const auto at = static_cast<size_t>(j * stride_ + i);
      table_[0][at] = c * (1.0 - nu) * (sum[0] + sum[1]);
      if (!medium_.tangential) continue;
      table_[1][at] = c * (sum[0] + (1.0 - nu) * sum[1]);
      table_[2][at] = c * (sum[1] + (1.0 - nu) * sum[0]);
      table_[3][at] = c * nu * sum[2];
    }
}

// A corner at (i - 1/2) dx moves by i - 1/2 with dx; its asinh(y/|x|) is there.
void influence::make_rates(double x, double y, double moves, size_t at) {
  const double r = hypot(x, y);
  corner_[0][at] = moves * y / r;
  corner_[1][at] = moves * (corner_[1][at] - y / r);
  corner_[2][at] = -moves * x / r;
}

// Offsets beyond the grid are those of the transform's padding: as far as the last ones are.
void influence::take_own_kernels() {
  const int columns = medium_.own_columns, rows = medium_.own_rows;
  for (int k = 0; k < (medium_.tangential ? 4 : 1); ++k)
    for (int j = 0; j <= half_y_; ++j)
      for (int i = 0; i <= half_x_; ++i) {
        const int at = (k * rows + std::min(j, rows - 1)) * columns + std::min(i, columns - 1);
        table_[k][static_cast<size_t>(j * stride_ + i)] = own_[static_cast<size_t>(at)];
      }
}

void influence::make_line_kernels() {
  const double nu = medium_.elastic.poisson_ratio;
  const double c = 2.0 / (pi * medium_.elastic.shear_modulus);
  for (int i = 0; i <= half_x_; ++i) {
    const double lower = (i - 0.5) * grid_.dx, upper = (i + 0.5) * grid_.dx;
    const double value =
        line_primitive(upper, medium_.line_width) - line_primitive(lower, medium_.line_width);
    const auto at = static_cast<size_t>(i);
    table_[0][at] = c * (1.0 - nu) * value;
    if (!medium_.tangential) continue;
    table_[1][at] = c * (1.0 - nu) * value;
    table_[2][at] = c * value;
    table_[3][at] = 0.0;
  }
}

void influence::bodies_at(double x, double y, double values[3]) const {
  const double nu = medium_.elastic.poisson_ratio;
  const double c = 1.0 / (pi * medium_.elastic.shear_modulus);
  if (medium_.line_width > 0) {
    const double ends[2] = {x + 0.5 * grid_.dx, x - 0.5 * grid_.dx};
    double sum = 0;
    for (int k = 0; k < 2; ++k)
      if (ends[k] != 0) sum += (k == 0 ? 1 : -1) * line_primitive(ends[k], medium_.line_width);
    values[0] = 2.0 * c * (1.0 - nu) * sum;
    values[1] = 2.0 * c * sum;
    values[2] = 0;
    return;
  }
  double sum[3] = {0, 0, 0};
  for (int k = 0; k < 4; ++k) {
    const double sign = (k == 0 || k == 3) ? 1.0 : -1.0;
    const double u = x + (k & 1 ? -0.5 : 0.5) * grid_.dx, v = y + (k & 2 ? -0.5 : 0.5) * grid_.dy;
    sum[0] += sign * (v != 0 ? y_log(u, v) : 0.0);
    sum[1] += sign * (u != 0 ? y_log(v, u) : 0.0);
    sum[2] -= sign * hypot(u, v);
  }
  values[0] = c * (sum[0] + (1.0 - nu) * sum[1]);
  values[1] = c * (sum[1] + (1.0 - nu) * sum[0]);
  values[2] = c * nu * sum[2];
}

void influence::corner_at(double x, double y, double values[3]) {
  values[0] = y != 0 ? y_log(x, y) : 0.0;
  values[1] = x != 0 ? y_log(y, x) : 0.0;
  values[2] = -hypot(x, y);
}

void influence::from_corners(const double sum[3], double values[3]) const {
  const double nu = medium_.elastic.poisson_ratio;
  const double c = 1.0 / (pi * medium_.elastic.shear_modulus);
  values[0] = c * (sum[0] + (1.0 - nu) * sum[1]);
  values[1] = c * (sum[1] + (1.0 - nu) * sum[0]);
  values[2] = c * nu * sum[2];
}

double influence::coefficient(kernel k, int i, int j) const {
  const auto at = static_cast<size_t>(std::abs(j) * stride_ + std::abs(i));
  const double value = table_[static_cast<int>(k)][at];
  if (k != kernel::xy) return value;
  return i == 0 || j == 0 ? 0.0 : ((i < 0) == (j < 0) ? value : -value);
}

// All that a curved surface needs; else each when it is asked for.
void influence::make_spectra() {
  pressed_ = rubbed_ = false;
  if (!is_curved()) return;
  need_tractions();
  need_pressure();
}

void influence::need_pressure() {
  if (pressed_) return;
  pressed_ = true;
  if (!read_)
    transform_.make(false, table_[0].data(), stride_, spectrum_.data());
  else if (medium_.tangential)
    for (size_t i = 0; i < table_[0].size(); ++i)
      spectrum_[i] = share_of_pressure() * (mixed(0)[i] + mixed(1)[i]);
  else
    std::copy_n(mixed(0), table_[0].size(), spectrum_.data());
  take_spectrum(kernel::zz);
  take_inverse();
}

void influence::need_tractions() {
  if (rubbed_ || !medium_.tangential) return;
  rubbed_ = true;
  for (const kernel k : {kernel::xy, kernel::yy, kernel::xx}) {
    const int at = static_cast<int>(k);
    const double layer = k == kernel::xy ? 0.0 : medium_.layer_flexibility;
    if (!read_)
      transform_.make(k == kernel::xy, table_[at].data(), stride_, spectrum_.data());
    else
      for (size_t i = 0; i < table_[0].size(); ++i) spectrum_[i] = mixed(at - 1)[i] + layer;
    take_spectrum(k);
  }
}

void influence::take_spectrum(kernel k) {
  using name = convolution<double>::kernel_name;
  constexpr name names[] = {name::zz, name::xx, name::yy, name::xy};
  const name of = names[static_cast<int>(k)];
  full_.set_spectrum(of, spectrum_.data());
  single_.set_spectrum(static_cast<convolution<float>::kernel_name>(of), spectrum_.data());
  if (is_curved()) give_spectrum(k);
}

// Of zz: truncation can make small entries negative, and a floor keeps the preconditioner positive.
// What is taken of a spectrum are its lateral waves up to the middle; the others mirror them.
void influence::take_inverse() {
  const int half = (plans_.nx(plan_) / 2 + 1) * (plans_.ny(plan_) / 2 + 1);
  const double top = *std::max_element(spectrum_.data(), spectrum_.data() + half);
  for (int i = 0; i < half; ++i) {
    double &value = spectrum_[static_cast<size_t>(i)];
    value = 1.0 / std::max(value, 1e-6 * top);
  }
  single_.set_spectrum(convolution<float>::zz_inverse, spectrum_.data());
}

void influence::give_spectrum(kernel k) {
  const auto count = static_cast<size_t>((plans_.nx(plan_) / 2 + 1) * plans_.ny(plan_));
  const double *s = spectrum_.data();
  switch (k) {
    case kernel::xx:
      return curved_->take_xx(s, count);
    case kernel::yy:
      return curved_->take_yy(s, count);
    case kernel::xy:
      return curved_->take_xy(s, count);
    case kernel::zz:
      return curved_->take_zz(s, count);
  }
}

void influence::normal_product(const double *pressure, double *displacement) {
  need_pressure();
  const auto flat = [&](const double *p, double *u) {
    full_.product(convolution<double>::zz, p, u);
  };
  if (is_curved()) return curved_->normal(pressure, displacement, flat);
  flat(pressure, displacement);
}

void influence::normal_product_single(const double *pressure, double *displacement) {
  need_pressure();
  const auto flat = [&](const double *p, double *u) {
    single_.product(convolution<float>::zz, p, u);
  };
  if (is_curved()) return curved_->normal(pressure, displacement, flat);
  flat(pressure, displacement);
}

void influence::normal_inverse(const double *displacement, double *pressure) {
  need_pressure();
  single_.product(convolution<float>::zz_inverse, displacement, pressure);
}

void influence::tangential_product(const double *px, const double *py, double *ux, double *uy) {
  if (is_curved()) return curved_->tangential(px, py, ux, uy);
  need_tractions();
  full_.tangential_product(px, py, ux, uy);
}

void influence::tangential_product_single(const double *px, const double *py, double *ux,
                                          double *uy) {
  if (is_curved()) return curved_->tangential_single(px, py, ux, uy);
  need_tractions();
  single_.tangential_product(px, py, ux, uy);
}

double influence::rolling_product(const double *px, const double *py, int direction, double *sx,
                                  double *sy) {
  need_tractions();
  if (!is_curved()) return full_.rolling_product(px, py, direction, grid_.dx, sx, sy);
  curved_->rolling(px, py, direction, grid_.dx, sx, sy);
  return nan;
}

void influence::rolling_product_single(const double *px, const double *py, int direction,
                                       double *sx, double *sy) {
  if (is_curved()) return curved_->rolling_single(px, py, direction, grid_.dx, sx, sy);
  need_tractions();
  single_.rolling_product(px, py, direction, grid_.dx, sx, sy);
}

size_t influence::bytes() const {
  size_t sum = plans_.bytes() + own_.bytes() + spectrum_.bytes() + transform_.bytes() +
               full_.bytes() + single_.bytes() + (is_curved() ? curved_->bytes() : 0);
  for (const auto &b : table_) sum += b.bytes();
  for (const auto &b : corner_) sum += b.bytes();
  if (book_) sum += sizeof(kernel_book) + book_->bytes() + mixed_.bytes();
  return sum;
}

}  // namespace railpatch
