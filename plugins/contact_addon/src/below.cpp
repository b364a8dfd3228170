// Stresses and displacements below the surface, by the core's rp_stress_at.
#include <algorithm>
#include <cmath>

#include "registry.hpp"
#include "solve.hpp"

namespace contact_addon {

namespace {

// A number of an element, 0 where it is none.
int element_of(double value) {
  return value >= 1 && value <= 1e6 ? static_cast<int>(std::lround(value)) : 0;
}

// Places along one axis of the grid: all, first step last, or a list, counted from 1.
std::vector<double> along(int kind, const std::vector<double> &v, int count, double first,
                          double size) {
  std::vector<double> out;
  const auto place = [&](int element) {
    if (element >= 1 && element <= count) out.push_back(first + (element - 1) * size);
  };
  if (kind == 1 || kind == 5) {
    for (int i = 1; i <= count; ++i) place(i);
  } else if ((kind == 2 || kind == 6) && v.size() >= 3) {
    const int step = std::max(element_of(v[1]), 1);
    for (int i = std::max(element_of(v[0]), 1); i <= std::min(element_of(v[2]), count); i += step)
      place(i);
  } else if (kind == 3 || kind == 7) {
    for (const double element : v) place(element_of(element));
  } else {
    out = v;
  }
  return out;
}

int at_points(const problem &p, int icp, int body, const std::vector<double> &points,
              std::vector<double> &values, std::string &why) {
  rp_message message{};
  values.resize(points.size() * 3);
  const rp_error error = rp_stress_at(p.contact.get(), p.side(), index_of(p, icp), body,
                                      points.data(), points.size() / 3, values.data(), &message);
  why = message.text;
  return error == RP_OK ? error_none : error_other;
}

}  // namespace

int solve_block(problem &p, int icp, block &b, std::string &why) {
  const rp_patch_result *r = patch_of(p, icp);
  b.points.clear();
  b.results.clear();
  for (int &n : b.shape) n = -1;
  if (r == nullptr) {
    why = "there is no solved contact";
    return error_not_initialised;
  }
  const grid_data g = grid_of(p, *r);
  const std::vector<double> x = along(b.kind, b.x, g.mx, g.x0, g.dx);
  const std::vector<double> y = along(b.kind, b.y, g.my, g.y0, g.dy);
  std::vector<double> z = b.z;
  if (b.kind <= 3 && b.z.size() >= 2) {
    z.clear();
    for (int k = 0; k < std::min(b.count[2], 100000); ++k) z.push_back(b.z[0] + k * b.z[1]);
  }
  constexpr double most = 1e7;
  if (static_cast<double>(x.size()) * static_cast<double>(y.size()) *
          static_cast<double>(z.size()) >
      most) {
    why = "a block of more than 10 million points";
    return error_other;
  }
  // the rail is below z = 0, the wheel above
  std::vector<double> inside[2];
  for (const double depth : z)
    for (const double at_y : y)
      for (const double at_x : x) {
        b.points.insert(b.points.end(), {at_x, at_y, depth});
        std::vector<double> &body = inside[depth >= 0 ? RP_BODY_RAIL : RP_BODY_WHEEL];
        body.insert(body.end(),
                    {at_x - p.mapped.offset[0], at_y - p.mapped.offset[1], std::fabs(depth)});
      }
  std::vector<double> found[2];
  for (int body = 0; body < 2; ++body)
    if (!inside[body].empty())
      if (const int code = at_points(p, icp, body, inside[body], found[body], why); code != 0) {
        b.points.clear();
        return code;
      }
  size_t next[2] = {0, 0};
  for (size_t k = 2; k < b.points.size(); k += 3) {
    const int body = b.points[k] >= 0 ? RP_BODY_RAIL : RP_BODY_WHEEL;
    const double *from = found[body].data() + 9 * next[body]++;
    b.results.insert(b.results.end(), from, from + 9);
  }
  b.shape[0] = static_cast<int>(x.size());
  b.shape[1] = static_cast<int>(y.size());
  b.shape[2] = static_cast<int>(z.size());
  return error_none;
}

std::vector<double> displacements_of(const problem &p, int icp) {
  const rp_patch_result *r = patch_of(p, icp);
  if (r == nullptr) return {};
  const grid_data g = grid_of(p, *r);
  const auto count = static_cast<size_t>(g.mx) * static_cast<size_t>(g.my);
  std::vector<double> points, values[2], out(3 * count);
  for (int j = 0; j < g.my; ++j)
    for (int i = 0; i < g.mx; ++i)
      points.insert(points.end(), {g.x0 + i * g.dx - p.mapped.offset[0],
                                   g.y0 + j * g.dy - p.mapped.offset[1], 0.0});
  std::string why;
  for (int body = 0; body < 2; ++body)
    if (at_points(p, icp, body, points, values[body], why) != 0) return {};
  for (size_t k = 0; k < count; ++k)
    for (size_t part = 0; part < 3; ++part)
      out[part * count + k] =
          values[RP_BODY_RAIL][9 * k + 6 + part] - values[RP_BODY_WHEEL][9 * k + 6 + part];
  return out;
}

}  // namespace contact_addon
