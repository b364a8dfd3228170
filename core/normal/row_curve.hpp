// The curve through one number of each row, such as its lowest distance.
#pragma once

#include "half_space/influence.hpp"
#include "normal/strip.hpp"

namespace railpatch {

// The parabola through three rows as a function of y - y(j).
quadratic through(const double *rows, const grid &g, int j);
// Between two rows the parabolas of both, each with its share: with a continuous slope.
double value_at(const double *rows, const grid &g, double y);
// That curve from row j to j + 1, of which the part from `from` to `to` counts: where it is lowest,
// in rows from j; value: there.
double lowest_between(const double *rows, const grid &g, int j, double from, double to,
                      double &value);
// Half the second derivative, as seen over a distance to both sides.
double mean_curvature(const double *rows, const grid &g, int j, double reach);

}  // namespace railpatch
