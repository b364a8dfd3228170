// The pressure on a grid, its elements and their places as numbers of type T: as they are, or with
// their rates along one direction.
#pragma once

#include "half_space/influence.hpp"
#include "numeric/dual.hpp"

namespace railpatch {

template <class T>
class pressure_view;

template <>
class pressure_view<double> {
 public:
  pressure_view(const grid &g, const double *pressure)
      : nx(g.nx), ny(g.ny), dx(g.dx), dy(g.dy), g_(g), pressure_(pressure) {}
  double x(int i) const { return g_.x(i); }
  double y(int j) const { return g_.y(j); }
  double at(int k) const { return pressure_[k]; }

  const int nx, ny;
  const double dx, dy;

 private:
  const grid &g_;
  const double *pressure_;
};

// The centre of element i moves by origin + i size (m); rate: of the pressure, null: zero.
template <>
class pressure_view<directed> {
 public:
  pressure_view(const grid &g, const double *pressure, const double *rate, const double origin[2],
                const double size[2])
      : nx(g.nx),
        ny(g.ny),
        dx(directed_of(g.dx, size[0])),
        dy(directed_of(g.dy, size[1])),
        g_(g),
        pressure_(pressure),
        rate_(rate),
        origin_{origin[0], origin[1]} {}
  directed x(int i) const { return directed_of(g_.x(i), origin_[0] + i * dx.rate[0]); }
  directed y(int j) const { return directed_of(g_.y(j), origin_[1] + j * dy.rate[0]); }
  directed at(int k) const { return directed_of(pressure_[k], rate_ ? rate_[k] : 0.0); }

  const int nx, ny;
  const directed dx, dy;

 private:
  const grid &g_;
  const double *pressure_, *rate_;
  double origin_[2];
};

}  // namespace railpatch
