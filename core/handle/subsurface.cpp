#include "handle/subsurface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "handle/abi.hpp"
#include "handle/check.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

constexpr int most_depths = 1000;

grid_size greatest(const contact &of, const rp_subsurface_config &config) {
  const rp_config &c = of.config();
  // of fitted rows twice the nodes, as spread lays them out
  grid_size n = c.fitted[0] > 0 ? grid_size{2 * c.fitted[0], 2 * c.fitted[1]} : of.largest_grid();
  if (config.max_elements[0] > 0) n.nx = std::min(n.nx, static_cast<int>(config.max_elements[0]));
  if (config.max_elements[1] > 0) n.ny = std::min(n.ny, static_cast<int>(config.max_elements[1]));
  // theories without elements have none
  return {std::max(n.nx, 2), std::max(n.ny, 1)};
}

bool is_plane_strain(const rp_config &c) {
  return c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT;
}

std::vector<int> sizes(int n) {
  if (n == 1) return {1};
  std::vector<int> found{smooth_size(std::min(2 * n, 16))};
  while (found.back() < 2 * n)
    found.push_back(std::min(smooth_size(found.back() + found.back() / 5 + 1), smooth_size(2 * n)));
  return found;
}

body_constants constants(const contact &of, int body) {
  return {of.config().shear_modulus[body], of.config().poisson_ratio[body]};
}

// Into the body, and along it: what acts on the rail is opposite to what acts on the wheel.
double traction_sign(int body) { return body == RP_BODY_WHEEL ? 1.0 : -1.0; }

// Components along x, s, n of the contact frame, where n leads into the rail: the wheel's depth
// has the other sense. A left wheel is solved as its mirror image.
void component_signs(int body, bool mirrored, double *sign) {
  using b = below;
  std::fill_n(sign, static_cast<int>(b::components), 1.0);
  if (body == RP_BODY_WHEEL) sign[b::yz] = sign[b::zx] = sign[b::uz] = -1.0;
  if (mirrored)
    for (const int c : {b::xy, b::yz, b::uy}) sign[c] = -sign[c];
}

}  // namespace

// The loaded rectangles of a patch.
struct subsurface::patch_view {
  const patch_memory &m;

  bool has_elements() const {
    return m.columns() * m.rows() > 0 &&
           (m.fitted() ? m.node_height.size() : m.pressure.size()) > 0;
  }
  // f(x, y, size along x and y, pressure, px, py), in m and Pa
  template <class F>
  void for_each(F &&f) const {
    if (m.fitted())
      of_rows(f);
    else
      of_grid(f);
  }

 private:
  template <class F>
  void of_grid(F &&f) const {
    const bool rubs = m.px.size() > 0;
    for (int j = 0; j < m.g.ny; ++j)
      for (int i = 0; i < m.g.nx; ++i) {
        const auto at = static_cast<size_t>(j * m.g.nx + i);
        if (m.pressure[at] == 0) continue;
        f(m.g.x(i), m.g.y(j), m.g.dx, m.g.dy, m.pressure[at], rubs ? m.px[at] : 0.0,
          rubs ? m.py[at] : 0.0);
      }
  }
  // A node stands for the area that its weight gives it, between the points half-way in angle.
  template <class F>
  void of_rows(F &&f) const {
    const int n = m.columns();
    const double step = std::numbers::pi / (n + 1);
    for (int j = 0; j < m.rows(); ++j) {
      const auto row = static_cast<size_t>(j);
      const double height = m.node_height[row];
      if (height == 0) continue;
      const double *x = m.node_x.data() + j * n;
      // the chord by its outermost nodes
      const double middle = 0.5 * (x[0] + x[n - 1]);
      const double half = n > 1 ? 0.5 * (x[n - 1] - x[0]) / cos(step) : 0.0;
      for (int k = 0; k < n; ++k) {
        const auto at = static_cast<size_t>(j * n + k);
        const double low = middle - half * cos((k + 0.5) * step);
        const double high = middle - half * cos((k + 1.5) * step);
        const double part = half * step * sin((k + 1) * step) / (high - low);
        f(0.5 * (low + high), m.node_y[row], high - low, height, part * m.node_pressure[at],
          part * m.px[at], part * m.py[at]);
      }
    }
  }
};

subsurface::subsurface(const rp_subsurface_config &config, const contact &of)
    : depths_(config.depth, config.depth + config.depth_count),
      dang_van_(config.dang_van),
      plans_(sizes(greatest(of, config).nx), sizes(greatest(of, config).ny)),
      below_{{constants(of, RP_BODY_WHEEL), depths_, plans_, config.displacements != 0,
              is_plane_strain(of.config())},
             {constants(of, RP_BODY_RAIL), depths_, plans_, config.displacements != 0,
              is_plane_strain(of.config())}},
      cycle_(greatest(of, config).nx + 1),
      components_(below_[0].components()) {
  const grid_size n = greatest(of, config);
  const auto count = static_cast<size_t>(n.nx) * static_cast<size_t>(n.ny);
  for (auto &b : load_) b = aligned_buffer<double>(count);
  found_ = aligned_buffer<double>(count * depths_.size() * static_cast<size_t>(components_));
}

size_t subsurface::bytes() const {
  return below_[0].bytes() + below_[1].bytes() + cycle_.bytes() + 3 * load_[0].bytes() +
         found_.bytes() + plans_.bytes();
}

// The loads on a uniform grid: an element's own, or, of fitted rows, of elements half their size,
// what of each rectangle lies in them.
void subsurface::spread(const patch_view &view) {
  const patch_memory &m = view.m;
  if (!m.fitted()) {
    grid_ = m.g;
  } else {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    view.for_each([&](double x, double y, double sx, double sy, double, double, double) {
      low[0] = std::min(low[0], x - 0.5 * sx);
      high[0] = std::max(high[0], x + 0.5 * sx);
      low[1] = std::min(low[1], y - 0.5 * sy);
      high[1] = std::max(high[1], y + 0.5 * sy);
    });
    grid_.nx = 2 * m.columns();
    grid_.ny = 2 * m.rows();
    grid_.dx = (high[0] - low[0]) / grid_.nx;
    grid_.dy = (high[1] - low[1]) / grid_.ny;
    grid_.x0 = low[0] + 0.5 * grid_.dx;
    grid_.y0 = low[1] + 0.5 * grid_.dy;
  }
  for (auto &b : load_) std::fill_n(b.data(), grid_.count(), 0.0);
  const bool fits = !m.fitted();
  view.for_each([&](double x, double y, double sx, double sy, double p, double px, double py) {
    const double value[3] = {p, px, py};
    const double u = (x - grid_.x0) / grid_.dx, v = (y - grid_.y0) / grid_.dy;
    const double du = 0.5 * sx / grid_.dx, dv = 0.5 * sy / grid_.dy;
    const auto index = [](double t) { return static_cast<int>(std::floor(t + 0.5)); };
    const int i0 = std::max(fits ? index(u) : index(u - du), 0);
    const int i1 = std::min(fits ? i0 : index(u + du), grid_.nx - 1);
    const int j0 = std::max(fits ? index(v) : index(v - dv), 0);
    const int j1 = std::min(fits ? j0 : index(v + dv), grid_.ny - 1);
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i) {
        const double a = std::min(u + du, i + 0.5) - std::max(u - du, i - 0.5);
        const double b = std::min(v + dv, j + 0.5) - std::max(v - dv, j - 0.5);
        const double part = fits ? 1.0 : std::max(a, 0.0) * std::max(b, 0.0);
        for (int k = 0; k < 3; ++k)
          load_[k][static_cast<size_t>(j * grid_.nx + i)] += part * value[k];
      }
  });
}

rp_error subsurface::solve(const contact &of, int side, int patch, int body) {
  solved_ = false;
  const patch_memory *m = of.solution(side, patch);
  if (!m) return RP_ERROR_NO_FIELD;
  const patch_view view{*m};
  if (!view.has_elements()) return RP_ERROR_NO_FIELD;
  bool loaded = false;
  view.for_each([&](double, double, double, double, double, double, double) { loaded = true; });
  if (!loaded) return RP_ERROR_NO_FIELD;
  spread(view);
  if (static_cast<size_t>(grid_.count()) > load_[0].size() || !below_[body].set_grid(grid_))
    return RP_ERROR_SIZE;
  const double sign = traction_sign(body);
  for (int k = 1; k < 3; ++k)
    for (int i = 0; i < grid_.count(); ++i) load_[k][static_cast<size_t>(i)] *= sign;
  below_[body].product(load_[0].data(), load_[1].data(), load_[2].data(), found_.data());
  mirrored_ = of.mirrors(side);
  component_signs(body, mirrored_, sign_);
  solved_ = true;
  return RP_OK;
}

stress_tensor subsurface::stress(size_t at, size_t points) const {
  stress_tensor s;
  for (size_t c = 0; c < s.size(); ++c) s[c] = sign_[c] * found_[c * points + at];
  return s;
}

rp_error subsurface::field(rp_subsurface_field name, double *values, size_t *count) {
  if (!solved_) return RP_ERROR_NO_FIELD;
  const size_t nx = static_cast<size_t>(grid_.nx), ny = static_cast<size_t>(grid_.ny);
  const size_t deep = depths_.size(), points = deep * ny * nx;
  size_t needed = points;
  switch (name) {
    case RP_SUBSURFACE_X:
      needed = nx;
      break;
    case RP_SUBSURFACE_Y:
      needed = ny;
      break;
    case RP_SUBSURFACE_STRESS:
      needed = 6 * points;
      break;
    case RP_SUBSURFACE_DISPLACEMENT:
      if (components_ == below::stresses) return RP_ERROR_NO_FIELD;
      needed = 3 * points;
      break;
    case RP_SUBSURFACE_PRINCIPAL_STRESS:
      needed = 3 * points;
      break;
    case RP_SUBSURFACE_VON_MISES:
    case RP_SUBSURFACE_GREATEST_SHEAR:
      break;
    case RP_SUBSURFACE_DANG_VAN:
      needed = deep * ny;
      break;
    default:
      return RP_ERROR_NO_FIELD;
  }
  const size_t capacity = *count;
  *count = needed;
  if (capacity < needed || !values) return RP_ERROR_SIZE;
  give(name, values);
  return RP_OK;
}

void subsurface::give(rp_subsurface_field name, double *values) {
  const size_t nx = static_cast<size_t>(grid_.nx), ny = static_cast<size_t>(grid_.ny);
  const size_t deep = depths_.size(), points = deep * ny * nx;
  const auto source_row = [&](size_t j) { return mirrored_ ? ny - 1 - j : j; };
  // f(place in the result, place in what was found)
  const auto for_each_point = [&](auto &&f) {
    for (size_t k = 0; k < deep; ++k)
      for (size_t j = 0; j < ny; ++j)
        for (size_t i = 0; i < nx; ++i) f((k * ny + j) * nx + i, (k * ny + source_row(j)) * nx + i);
  };
  const auto copy = [&](int first, int number) {
    for (int c = 0; c < number; ++c)
      for_each_point([&](size_t to, size_t from) {
        values[static_cast<size_t>(c) * points + to] =
            sign_[first + c] * found_[static_cast<size_t>(first + c) * points + from];
      });
  };
  switch (name) {
    case RP_SUBSURFACE_X:
      for (size_t i = 0; i < nx; ++i) values[i] = grid_.x(static_cast<int>(i));
      break;
    case RP_SUBSURFACE_Y:
      for (size_t j = 0; j < ny; ++j)
        values[j] = (mirrored_ ? -1.0 : 1.0) * grid_.y(static_cast<int>(source_row(j)));
      break;
    case RP_SUBSURFACE_STRESS:
      copy(0, below::stresses);
      break;
    case RP_SUBSURFACE_DISPLACEMENT:
      copy(below::ux, 3);
      break;
    case RP_SUBSURFACE_PRINCIPAL_STRESS:
      for_each_point([&](size_t to, size_t from) {
        const auto p = principal_stresses(stress(from, points));
        for (size_t c = 0; c < 3; ++c) values[c * points + to] = p[c];
      });
      break;
    case RP_SUBSURFACE_VON_MISES:
      for_each_point(
          [&](size_t to, size_t from) { values[to] = von_mises_stress(stress(from, points)); });
      break;
    case RP_SUBSURFACE_GREATEST_SHEAR:
      for_each_point(
          [&](size_t to, size_t from) { values[to] = greatest_shear(stress(from, points)); });
      break;
    case RP_SUBSURFACE_DANG_VAN:
      for (size_t k = 0; k < deep; ++k)
        for (size_t j = 0; j < ny; ++j) {
          cycle_.clear();
          cycle_.add({});  // far from the contact
          for (size_t i = 0; i < nx; ++i)
            cycle_.add(stress((k * ny + source_row(j)) * nx + i, points));
          values[k * ny + j] = cycle_.equivalent(dang_van_);
        }
      break;
  }
}

rp_error subsurface::at(const contact &of, int side, int patch, int body, const double *points,
                        size_t count, double *values) {
  const patch_memory *m = of.solution(side, patch);
  if (!m) return RP_ERROR_NO_FIELD;
  const patch_view view{*m};
  if (!view.has_elements() || is_plane_strain(of.config())) return RP_ERROR_NO_FIELD;
  const bool mirrored = of.mirrors(side);
  double signs[below::components];
  component_signs(body, mirrored, signs);
  const body_constants material = constants(of, body);
  for (size_t k = 0; k < count; ++k) {
    const double *point = points + 3 * k;
    double *sum = values + 9 * k;
    std::fill_n(sum, 9, 0.0);
    const double across = mirrored ? -point[1] : point[1];
    view.for_each([&](double x, double y, double sx, double sy, double p, double px, double py) {
      const double size[2] = {sx, sy}, t = traction_sign(body), load[3] = {p, t * px, t * py};
      const below_coefficients c =
          below_rectangle(material, size, point[0] - x, across - y, point[2]);
      for (int l = 0; l < below::loads; ++l)
        for (int n = 0; n < below::components; ++n)
          sum[n] += load[l] * c[static_cast<size_t>(below::at(l, n))];
    });
    for (int n = 0; n < below::components; ++n) sum[n] *= signs[n];
  }
  return RP_OK;
}

}  // namespace railpatch

using namespace railpatch;

struct rp_subsurface {
  rp_subsurface(const rp_subsurface_config &config, const contact &of)
      : below(config, of), made_for(of.config()) {}
  subsurface below;
  rp_config made_for;
};

static rp_error check_subsurface(const rp_subsurface_config &c, rp_message *message) {
  if (c.cookie != subsurface_cookie) {
    set_message(message, "the config was never filled by rp_default_subsurface");
    return RP_ERROR_NOT_DEFAULTED;
  }
  if (c.depth_count < 1 || c.depth_count > most_depths) {
    set_message(message, "depth_count is %d, outside 1 to %d", c.depth_count, most_depths);
    return RP_ERROR_VALUE;
  }
  if (!c.depth) {
    set_message(message, "depth is null");
    return RP_ERROR_NULL;
  }
  for (int k = 0; k < c.depth_count; ++k)
    if (!(c.depth[k] >= 0 && c.depth[k] <= 1)) {
      set_message(message, "depth[%d] is %g, outside 0 to 1 m", k, c.depth[k]);
      return RP_ERROR_VALUE;
    }
  if (!(c.dang_van >= 0 && c.dang_van <= 3)) {
    set_message(message, "dang_van is %g, outside 0 to 3", c.dang_van);
    return RP_ERROR_VALUE;
  }
  for (int k = 0; k < 2; ++k)
    if (c.max_elements[k] < 0) {
      set_message(message, "max_elements[%d] is %d, must be 0 or more", k, c.max_elements[k]);
      return RP_ERROR_VALUE;
    }
  return RP_OK;
}

// Side, patch and body of a call.
static rp_error check_place(int side, int patch, int body, rp_message *message) {
  const int value[3] = {side, patch, body}, most[3] = {1, RP_MAX_PATCHES - 1, 1};
  const char *const name[3] = {"side", "patch", "body"};
  for (int k = 0; k < 3; ++k)
    if (value[k] < 0 || value[k] > most[k]) {
      set_message(message, "%s is %d, outside 0 to %d", name[k], value[k], most[k]);
      return RP_ERROR_VALUE;
    }
  return RP_OK;
}

static rp_error said(rp_error error, int side, int patch, rp_message *message) {
  if (error == RP_ERROR_NO_FIELD)
    set_message(message,
                "side %d, patch %d: no such patch in the last step, or its theories give no "
                "pressure element by element",
                side, patch);
  if (error == RP_ERROR_SIZE)
    set_message(message, "side %d, patch %d: its grid has more elements than max_elements", side,
                patch);
  return error;
}

static rp_error check_bodies(const rp_contact &of, rp_message *message) {
  const rp_config &c = of.handle.config();
  const bool viscous = c.viscoelastic_ratio[0] > 0 || c.viscoelastic_ratio[1] > 0;
  if (!viscous && c.own_influence == 0) return RP_OK;
  set_message(message, viscous ? "viscoelastic_ratio must be 0: viscoelastic bodies are not solved "
                                 "below their surface"
                               : "own_influence must be 0: what is given is of the surface alone");
  return RP_ERROR_VALUE;
}

void rp_default_subsurface(rp_subsurface_config *to) {
  if (!to) return;
  *to = {};
  to->cookie = subsurface_cookie;
  to->dang_van = 1.0 / 3.0;
}

rp_error rp_create_subsurface(const rp_contact *contact, const rp_subsurface_config *config,
                              rp_subsurface **out, rp_message *message) {
  if (!contact || !config || !out) {
    set_message(message, "%s is null", !contact ? "contact" : (!config ? "config" : "out"));
    return RP_ERROR_NULL;
  }
  if (const rp_error error = check_subsurface(*config, message); error != RP_OK) return error;
  if (const rp_error error = check_bodies(*contact, message); error != RP_OK) return error;
  try {
    *out = new rp_subsurface(*config, contact->handle);
    return RP_OK;
  } catch (const std::bad_alloc &) {
    set_message(message, "out of memory: fewer depths, or smaller max_elements");
    return RP_ERROR_MEMORY;
  } catch (...) {
    set_message(message, "internal error in rp_create_subsurface");
    return RP_ERROR_INTERNAL;
  }
}

void rp_destroy_subsurface(rp_subsurface *subsurface) { delete subsurface; }

rp_error rp_solve_subsurface(rp_subsurface *subsurface, const rp_contact *contact, int side,
                             int patch, int body, rp_message *message) {
  if (!subsurface || !contact) {
    set_message(message, "%s is null", subsurface ? "contact" : "subsurface");
    return RP_ERROR_NULL;
  }
  if (const rp_error error = check_place(side, patch, body, message); error != RP_OK) return error;
  const rp_config &now = contact->handle.config(), &then = subsurface->made_for;
  for (int k = 0; k < 2; ++k)
    if (now.shear_modulus[k] != then.shear_modulus[k] ||
        now.poisson_ratio[k] != then.poisson_ratio[k]) {
      set_message(message, "contact has other materials than the one this was made for");
      return RP_ERROR_VALUE;
    }
  return said(subsurface->below.solve(contact->handle, side, patch, body), side, patch, message);
}

rp_error rp_get_subsurface_field(rp_subsurface *subsurface, rp_subsurface_field field,
                                 double *values, size_t *count) {
  if (!subsurface || !count) return RP_ERROR_NULL;
  return subsurface->below.field(field, values, count);
}

rp_error rp_stress_at(const rp_contact *contact, int side, int patch, int body,
                      const double *points, size_t count, double *values, rp_message *message) {
  if (!contact || ((!points || !values) && count > 0)) {
    set_message(message, "%s is null", !contact ? "contact" : (!points ? "points" : "values"));
    return RP_ERROR_NULL;
  }
  if (const rp_error error = check_place(side, patch, body, message); error != RP_OK) return error;
  if (const rp_error error = check_bodies(*contact, message); error != RP_OK) return error;
  for (size_t k = 0; k < count; ++k) {
    const double *p = points + 3 * k;
    if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && p[2] >= 0 && p[2] <= 1)) {
      set_message(message, "points[%zu] is (%g, %g, %g), outside finite x and y, depth 0 to 1 m", k,
                  p[0], p[1], p[2]);
      return RP_ERROR_VALUE;
    }
  }
  return said(subsurface::at(contact->handle, side, patch, body, points, count, values), side,
              patch, message);
}
