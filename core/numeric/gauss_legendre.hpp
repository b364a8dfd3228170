// Gauss-Legendre on (-1, 1) with 16 nodes: the positive half (Abramowitz and Stegun 1964,
// table 25.4).
#pragma once

namespace railpatch {

struct gauss_legendre {
  static constexpr int half = 8;
  static constexpr double node[half] = {
      0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863, 0.6178762444026437484,
      0.7554044083550030339, 0.8656312023878317439, 0.9445750230732325761, 0.9894009349916499326};
  static constexpr double weight[half] = {
      0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382, 0.1495959888165767321,
      0.1246289712555338720, 0.0951585116824927848, 0.0622535239386478929, 0.0271524594117540949};

  // f(place, weight) at each node of [begin, end], in a fixed order
  template <class F>
  static void each(double begin, double end, F &&f) {
    const double middle = 0.5 * (begin + end), length = 0.5 * (end - begin);
    for (int k = 0; k < half; ++k) {
      f(middle - length * node[k], length * weight[k]);
      f(middle + length * node[k], length * weight[k]);
    }
  }
};

}  // namespace railpatch
