// Spectra of kernels against the sums that define them.
#include "numeric/kernel_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace {

using namespace railpatch;

// A kernel by its quarter: even, or odd with nothing where both signs meet.
struct quarter {
  int nx, ny;
  bool odd;
  std::vector<double> values;

  int width() const { return nx / 2 + 1; }
  double at(int i, int j) const {
    const int oi = 2 * i <= nx ? i : nx - i, oj = 2 * j <= ny ? j : ny - j;
    const double value = values[static_cast<size_t>(oj * width() + oi)];
    if (!odd) return value;
    if (oi == 0 || oj == 0 || 2 * oi == nx || 2 * oj == ny) return 0.0;
    return (2 * i > nx) == (2 * j > ny) ? value : -value;
  }
  // of wave k, l; the sum's imaginary part is nothing
  double spectrum(int k, int l) const {
    double sum = 0;
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const double turns =
            static_cast<double>(k * i % nx) / nx + static_cast<double>(l * j % ny) / ny;
        sum += at(i, j) * std::cos(2 * std::numbers::pi * turns);
      }
    return sum;
  }
};

TEST(KernelTransform, GivesTheSums) {
  const int sizes[][2] = {{2, 1}, {20, 1}, {2, 2}, {6, 4}, {4, 10}, {12, 10}, {36, 30}, {10, 40}};
  kernel_transform transform(36, 40);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-1, 1);
  for (const auto &[nx, ny] : sizes)
    for (const bool odd : {false, true}) {
      quarter kernel{nx, ny, odd, {}};
      for (int i = 0; i < kernel.width() * (ny / 2 + 1); ++i)
        kernel.values.push_back(value(random));
      transform.set_size(nx, ny);
      std::vector<double> spectrum(static_cast<size_t>(kernel.width() * ny), NAN);
      transform.make(odd, kernel.values.data(), kernel.width(), spectrum.data());
      for (int l = 0; l < ny; ++l)
        for (int k = 0; k < kernel.width(); ++k)
          EXPECT_NEAR(spectrum[static_cast<size_t>(l * kernel.width() + k)], kernel.spectrum(k, l),
                      1e-15 * nx * ny)
              << nx << " x " << ny << (odd ? ", odd: " : ": ") << k << ", " << l;
    }
}

}  // namespace
