// Transforms of many lines at once, and of the FFT library, against the sum that defines them in
// greater precision, for all sizes that plans can have; what fft.hpp says about sizes.
#include "numeric/batch_fft.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "numeric/fft.hpp"

namespace {

using namespace railpatch;

bool is_smooth(int n) {
  for (int p : {2, 3, 5})
    while (n % p == 0) n /= p;
  return n == 1;
}

// exp(i 2 pi k/n)
std::vector<std::complex<long double>> roots(int n) {
  std::vector<std::complex<long double>> all;
  for (int k = 0; k < n; ++k) {
    const long double angle = 2 * std::numbers::pi_v<long double> * k / n;
    all.emplace_back(std::cos(angle), std::sin(angle));
  }
  return all;
}

// sum over j of x_j exp(-+ 2 pi i j k/n)
std::complex<double> defined(const std::vector<std::complex<double>> &x,
                             const std::vector<std::complex<long double>> &root, int k,
                             bool forward) {
  long double re = 0, im = 0;
  for (size_t j = 0; j < x.size(); ++j) {
    const auto r = root[j * static_cast<size_t>(k) % x.size()];
    const long double c = r.real(), s = forward ? -r.imag() : r.imag();
    re += c * x[j].real() - s * x[j].imag();
    im += c * x[j].imag() + s * x[j].real();
  }
  return {static_cast<double>(re), static_cast<double>(im)};
}

template <class T>
void expect_transform(batch_fft<T> &fft, int length, int count, int used, bool forward,
                      std::mt19937_64 &random) {
  SCOPED_TRACE(testing::Message() << length << " of " << count << " lines, used " << used
                                  << (forward ? " forward" : " backward"));
  const auto n = static_cast<size_t>(length * count);
  std::uniform_real_distribution<T> value(-1, 1);
  // what is not given is no number
  const T nan = std::numeric_limits<T>::quiet_NaN();
  std::vector<T> re(n, nan), im(n, nan), work_re(n, nan), work_im(n, nan);
  const auto given = static_cast<size_t>((forward ? used : length) * count);
  for (size_t i = 0; i < given; ++i) {
    re[i] = value(random);
    im[i] = value(random);
  }
  const std::vector<T> x_re = re, x_im = im;
  fft.set_length(length);
  const typename batch_fft<T>::lines data{re.data(), im.data()},
      work{work_re.data(), work_im.data()};
  const auto z =
      forward ? fft.forward(count, used, data, work) : fft.backward(count, used, data, work);
  ASSERT_TRUE((z.re == data.re && z.im == data.im) || (z.re == work.re && z.im == work.im));
  // a rounding or two in each of the passes, of sums of the size of the root of the length
  const double bound = 4 * static_cast<double>(std::numeric_limits<T>::epsilon()) *
                       std::sqrt(length) * (1 + std::log2(length));
  const auto root = roots(length);
  for (int line : {0, count / 2 + 1, count - 1}) {
    std::vector<std::complex<double>> x(static_cast<size_t>(length));
    for (int j = 0; j < length; ++j) {
      const auto at = static_cast<size_t>(j * count + line);
      if (!forward || j < used) x[static_cast<size_t>(j)] = {x_re[at], x_im[at]};
    }
    for (int k = 0; k < (forward ? length : used); ++k) {
      const auto should = defined(x, root, k, forward);
      const int at = k * count + line;
      ASSERT_NEAR(z.re[at], should.real(), bound) << line << " " << k;
      ASSERT_NEAR(z.im[at], should.imag(), bound) << line << " " << k;
    }
  }
}

template <class T>
class BatchFft : public testing::Test {};
using precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(BatchFft, precisions);

TYPED_TEST(BatchFft, EqualsTheSumThatDefinesIt) {
  constexpr int most = 150;
  batch_fft<TypeParam> fft(most);
  std::mt19937_64 random(9);
  for (int length = 1; length <= most; ++length) {
    if (!is_smooth(length) || (length > 1 && length % 2)) continue;
    const int half = length > 1 ? length / 2 : 1, count = length % 3 ? 8 : 24;
    for (int used : {1, (half + 1) / 2, half})
      for (bool forward : {true, false})
        expect_transform(fft, length, count, used, forward, random);
    // all of the result
    if (length <= 60) expect_transform(fft, length, count, length, false, random);
  }
}

TYPED_TEST(BatchFft, PacksAreWhole) {
  using fft = batch_fft<TypeParam>;
  for (int n = 0; n <= 40; ++n) {
    EXPECT_GE(fft::whole_packs(n), n);
    EXPECT_LT(fft::whole_packs(n), n + fft::pack);
    EXPECT_EQ(fft::whole_packs(n) % fft::pack, 0);
  }
  EXPECT_EQ(fft(90).bytes(), 2 * 90 * sizeof(TypeParam));
}

TEST(Sizes, AreTheSmallestSmoothEvenOnes) {
  for (int n = 1; n <= 700; ++n) {
    int least = n + n % 2;
    while (!is_smooth(least) || least == 576 || least == 640) least += 2;
    EXPECT_EQ(smooth_size(n), least) << n;
  }
}

TEST(Plans, AreFoundByTheLeastThatHolds) {
  const std::vector<int> along{8, 20, 36}, across{1, 10, 24};
  const fft_plans plans(along, across);
  EXPECT_EQ(plans.max_nx(), 36);
  EXPECT_EQ(plans.max_ny(), 24);
  for (int x = 1; x <= 38; ++x)
    for (int y = 1; y <= 26; ++y) {
      const int plan = plans.find(x, y);
      if (x > 36 || y > 24) {
        EXPECT_EQ(plan, -1) << x << " " << y;
        continue;
      }
      ASSERT_GE(plan, 0) << x << " " << y;
      EXPECT_EQ(plans.nx(plan), x <= 8 ? 8 : x <= 20 ? 20 : 36);
      EXPECT_EQ(plans.ny(plan), y <= 1 ? 1 : y <= 10 ? 10 : 24);
    }
  // half the elements, rounded up, one more along x for the view from upstream: each grid that a
  // plan holds finds its half
  const fft_plans halved = plans.halved();
  for (int nx = 1; 2 * nx + 1 <= 36; ++nx)
    for (int ny = 1; 2 * ny - 1 <= 24; ++ny) {
      const int half_x = (nx + 1) / 2, half_y = (ny + 1) / 2;
      EXPECT_GE(halved.find(2 * half_x + 1, half_y > 1 ? 2 * half_y - 1 : 1), 0) << nx << " " << ny;
    }
  EXPECT_EQ(halved.max_nx(), smooth_size(36 / 2 + 1));
  EXPECT_EQ(halved.max_ny(), smooth_size(24 / 2 + 1));
  EXPECT_EQ(halved.ny(halved.find(1, 1)), 1);
}

TEST(Plans, TransformRealFieldsInTwoDimensions) {
  const fft_plans plans({4, 6, 20}, {1, 2, 18});
  std::mt19937_64 random(10);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int plan = 0; plan < 9; ++plan) {
    const int nx = plans.nx(plan), ny = plans.ny(plan), width = nx / 2 + 1;
    aligned_buffer<double> field(static_cast<size_t>(nx * ny));
    for (double &v : field) v = value(random);
    // a row that is zero, as padded ones are, and one that begins so
    for (int i = 0; i < nx && ny > 2; ++i) field[static_cast<size_t>(nx + i)] = 0;
    field[0] = 0;
    aligned_buffer<std::complex<double>> spectrum(static_cast<size_t>(width * ny));
    plans.forward(plan, field.data(), spectrum.data());
    for (int l = 0; l < ny; ++l)
      for (int k = 0; k < width; ++k) {
        std::complex<long double> sum = 0;
        for (int j = 0; j < ny; ++j)
          for (int i = 0; i < nx; ++i) {
            const long double turns = static_cast<long double>(i * k % nx) / nx +
                                      static_cast<long double>(j * l % ny) / ny;
            const long double angle = -2 * std::numbers::pi_v<long double> * turns;
            sum += static_cast<long double>(field[static_cast<size_t>(j * nx + i)]) *
                   std::complex<long double>(std::cos(angle), std::sin(angle));
          }
        const auto found = spectrum[static_cast<size_t>(l * width + k)];
        EXPECT_NEAR(found.real(), static_cast<double>(sum.real()), 1e-13) << nx << " " << ny;
        EXPECT_NEAR(found.imag(), static_cast<double>(sum.imag()), 1e-13) << nx << " " << ny;
      }
  }
}

}  // namespace
