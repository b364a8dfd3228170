#include "patch/conformal_rows.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"

namespace railpatch {

namespace {

constexpr int most_turns = 12;          // of a step's direction
constexpr double steady_angle = 1e-12;  // rad, that ends them
constexpr int arc_steps = 16;           // of an arc length as long as its projection
constexpr int most_arc_steps = 64;

}  // namespace

conformal_rows::conformal_rows(int max_rows) {
  for (auto *b : {&y_, &z_, &angle_, &s_, &n_, &cos_, &sin_, &xi_, &eta_, &phi_, &valid_, &below_})
    *b = aligned_buffer<double>(static_cast<size_t>(max_rows));
}

bool conformal_rows::begin(const side_geometry &side, patch_region &region) {
  reference_ = region.frame;
  first_ = {};
  first_.start[0] = first_.start[1] = nan;
  const section_point p = side.section(reference_, first_.start);
  if (!p.valid) return false;
  height_ = 0.5 * (p.wheel + p.rail);
  lift_ = side.one_point() ? height_ : 0.0;
  first_.y = reference_.origin[1] - height_ * sin(reference_.contact_angle);
  first_.z = reference_.origin[2] + height_ * cos(reference_.contact_angle);
  first_.angle = reference_.contact_angle + 0.5 * (p.wheel_angle + p.rail_angle);
  first_.valid = true;
  bool reached = arc_length(side, region.s_min) && arc_length(side, region.s_max);
  for (int k = 0; k + 1 < region.parts; ++k) reached = reached && arc_length(side, region.cut[k]);
  return reached;
}

// One step along the curve: its chord has the mean angle of its ends. bend: what the angle changes
// by, as a start. Where a profile has ended the curve goes on straight.
conformal_rows::point conformal_rows::step(const side_geometry &side, const point &from,
                                           double length, double bend) const {
  point to = from;
  to.angle = from.angle + bend;
  for (int k = 0; k < most_turns; ++k) {
    const double middle = 0.5 * (from.angle + to.angle);
    const contact_frame f{
        {reference_.origin[0], from.y + length * cos(middle), from.z + length * sin(middle)},
        to.angle};
    const section_point p = side.section(f, to.start);
    if (!p.valid) {
      to = from;
      to.valid = false;
      to.y += length * cos(from.angle);
      to.z += length * sin(from.angle);
      to.start[0] = to.start[1] = nan;
      return to;
    }
    const double height = 0.5 * (p.wheel + p.rail), turn = 0.5 * (p.wheel_angle + p.rail_angle);
    to.y = f.origin[1] - height * sin(to.angle);
    to.z = f.origin[2] + height * cos(to.angle);
    to.angle += turn;
    to.valid = true;
    if (std::fabs(turn) < steady_angle) break;
  }
  return to;
}

// From a distance along the reference's s to the arc length of the curve's point there.
bool conformal_rows::arc_length(const side_geometry &side, double &s) const {
  const double c = cos(reference_.contact_angle), t = sin(reference_.contact_angle);
  const double length = s / arc_steps;
  if (length == 0) return true;
  point at = first_;
  double before = 0, bend = 0;
  for (int k = 1; k <= most_arc_steps; ++k) {
    const point next = step(side, at, length, bend);
    const double projection = c * (next.y - first_.y) + t * (next.z - first_.z);
    const double advance = (projection - before) / length;
    if (!(advance > 0.05)) return false;
    if (std::fabs(projection) >= std::fabs(s) * (1 - 1e-14)) {
      s = (k - 1) * length + (s - before) / advance;
      return true;
    }
    bend = next.angle - at.angle;
    before = projection;
    at = next;
  }
  return false;
}

double conformal_rows::arc_of(const side_geometry &side, double s) const {
  double arc = s;
  return arc_length(side, arc) ? arc : s;
}

void conformal_rows::take_mean(const grid &g, const double now[4], const double mean[4]) {
  if (!(mean[3] > 0)) return;
  double more[3];
  for (int k = 0; k < 3; ++k) more[k] = mean[k] * mean[3] - now[k] * now[3];
  for (int row = 0; row < rows_; ++row) {
    const auto j = static_cast<size_t>(row);
    xi_[j] = (xi_[j] * now[3] + more[0] - more[2] * g.y(row)) / mean[3];
    eta_[j] = (eta_[j] * now[3] + more[1]) / mean[3];
    phi_[j] = (phi_[j] * now[3] + more[2]) / mean[3];
  }
}

double conformal_rows::slip(int component, double row, double x) const {
  if (rows_ < 2) return slip(component, 0, x);
  const int first = static_cast<int>(std::clamp(std::floor(row), 0.0, rows_ - 2.0));
  const double share = row - first;
  // a whole row is that row
  return (1.0 - share) * slip(component, first, x) + share * slip(component, first + 1, x);
}

void conformal_rows::keep(int row, const point &p) {
  const auto j = static_cast<size_t>(row);
  const double c = cos(reference_.contact_angle), t = sin(reference_.contact_angle);
  const double dy = p.y - first_.y, dz = p.z - first_.z;
  y_[j] = p.y;
  z_[j] = p.z;
  angle_[j] = p.angle;
  valid_[j] = p.valid ? 1.0 : 0.0;
  s_[j] = c * dy + t * dz;
  n_[j] = c * dz - t * dy;
  cos_[j] = cos(p.angle - reference_.contact_angle);
  sin_[j] = sin(p.angle - reference_.contact_angle);
}

contact_frame conformal_rows::frame(int row) const {
  const auto j = static_cast<size_t>(row);
  return {{reference_.origin[0], y_[j], z_[j]}, angle_[j]};
}

void conformal_rows::place(const side_geometry &side, const grid &g, double *distance,
                           const surface_slopes &slopes) {
  rows_ = g.ny;
  slopes_ = slopes;
  slopes_.columns = side.level() ? 1 : g.nx;
  const int start =
      static_cast<int>(std::clamp(std::round(-g.y0 / g.dy), 0.0, static_cast<double>(g.ny - 1)));
  const point middle = step(side, first_, g.y(start), 0.0);
  keep(start, middle);
  for (int direction : {1, -1}) {
    point at = middle;
    double bend = 0;
    for (int row = start + direction; row >= 0 && row < g.ny; row += direction) {
      const point next = step(side, at, direction * g.dy, bend);
      bend = next.angle - at.angle;
      at = next;
      keep(row, at);
    }
  }
  for (int row = 0; row < g.ny; ++row) {
    double *h = distance + static_cast<std::ptrdiff_t>(row) * g.nx;
    if (valid_[static_cast<size_t>(row)] > 0)
      side.undeformed_distance(frame(row), {g.nx, 1, g.x0, 0.0, g.dx, g.dy}, h);
    else
      std::fill_n(h, g.nx, side_geometry::no_surface);
    if (!slopes_.height) continue;
    const auto first = slopes_.place(row);
    surface_slopes of_row{slopes.height + first, slopes.across + first, slopes.along + first};
    side.rail_slopes(frame(row), {g.nx, 1, g.x0, 0.0, g.dx, g.dy}, true, of_row);
  }
}

void conformal_rows::set_slip(const side_geometry &side, double depth, double rolling_speed) {
  for (int row = 0; row < rows_; ++row) {
    const auto j = static_cast<size_t>(row);
    // as deep below the curve as the reference is
    contact_frame f = frame(row);
    f.origin[1] += height_ * sin(f.contact_angle);
    f.origin[2] -= height_ * cos(f.contact_angle);
    const creepage_state c = side.creepages(f, depth);
    const double scale = rolling_speed > 0 ? c.rolling_speed / rolling_speed : 0.0;
    xi_[j] = scale * c.xi;
    eta_[j] = scale * c.eta;
    phi_[j] = scale * c.phi;
    // of the tractions below the curve
    below_[j] = side.one_point() ? side.contact_depth(f, depth) - height_ : 0.0;
  }
}

patch_wrench conformal_rows::sum_tractions(const grid &g, const double *pressure, const double *px,
                                           const double *py) const {
  patch_wrench w{};
  for (int j = 0; j < g.ny; ++j) {
    const auto row = static_cast<size_t>(j);
    const double c = cos_[row], t = sin_[row], s = s_[row], n = n_[row] + lift_;
    // moments of what acts below the curve
    double deep_x = 0, deep_s = 0;
    for (int i = 0; i < g.nx; ++i) {
      const int at = j * g.nx + i;
      const double x = g.x(i), p = pressure[at];
      double along = px ? px[at] : 0.0;
      double across = px ? py[at] : 0.0;
      deep_x += below_[row] * along;
      deep_s += below_[row] * across;
      if (slopes_.height) {
        const auto to = slopes_.place(j) + (slopes_.columns > 1 ? i : 0);
        along += slopes_.along[to] * p;
        across += slopes_.across[to] * p;
        deep_x += slopes_.height[to] * slopes_.along[to] * p;
        deep_s += slopes_.height[to] * slopes_.across[to] * p;
      }
      const double f[3] = {along, c * across + t * p, t * across - c * p};
      const double m[3] = {s * f[2] - n * f[1], n * f[0] - x * f[2], x * f[1] - s * f[0]};
      for (int k = 0; k < 3; ++k) {
        w.force[k] += f[k];
        w.moment[k] += m[k];
      }
    }
    w.moment[0] -= deep_s;
    w.moment[1] += c * deep_x;
    w.moment[2] += t * deep_x;
  }
  const double area = g.dx * g.dy;
  for (int k = 0; k < 3; ++k) {
    w.force[k] *= area;
    w.moment[k] *= area;
  }
  return w;
}

}  // namespace railpatch
