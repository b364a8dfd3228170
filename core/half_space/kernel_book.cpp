#include "half_space/kernel_book.hpp"

#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

namespace {

struct mixture {
  const double *from[kernel_book::points];
  double weight[kernel_book::points];
};

RAILPATCH_DISPATCH
void add_up(const mixture &m, std::size_t count, double *out) {
  double w[kernel_book::points];
  const double *f[kernel_book::points];
  for (int k = 0; k < kernel_book::points; ++k) w[k] = m.weight[k], f[k] = m.from[k];
  double *__restrict to = out;
  RAILPATCH_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i)
    to[i] = ((w[0] * f[0][i] + w[1] * f[1][i]) + (w[2] * f[2][i] + w[3] * f[3][i])) +
            ((w[4] * f[4][i] + w[5] * f[5][i]) + (w[6] * f[6][i] + w[7] * f[7][i]));
}

}  // namespace

kernel_book::kernel_book(int arrays, std::size_t size) : arrays_(arrays), stride_(size) {
  // those never written take no memory
  pages_ = aligned_buffer<double>(static_cast<std::size_t>(capacity * arrays) * size);
  entries_ = aligned_buffer<entry>(capacity);
}

double kernel_book::ratio_of(int place) { return exp(place * step); }

// Which pages, and Lagrange's weights of them.
void kernel_book::look_up(double ratio, double scale) {
  const double at = log(ratio) / step;
  const double below = std::floor(at);
  first_ = static_cast<int>(below) - (points / 2 - 1);
  const double x = at - below + (points / 2 - 1);
  for (int k = 0; k < points; ++k) {
    double w = scale;
    for (int j = 0; j < points; ++j)
      if (j != k) w *= (x - j) / (k - j);
    weight_[k] = w;
  }
  ++now_;
}

int kernel_book::find(int place) {
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    if (entries_[k].place != place || entries_[k].nx != nx_ || entries_[k].ny != ny_) continue;
    entries_[k].used = now_;
    return static_cast<int>(k);
  }
  return -1;
}

// One that was never written, or else has not been read for longest.
int kernel_book::free_page(int place) {
  std::size_t oldest = 0;
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    if (entries_[k].nx == 0) {
      oldest = k;
      break;
    }
    if (entries_[k].used < entries_[oldest].used) oldest = k;
  }
  entries_[oldest] = {place, nx_, ny_, now_};
  return static_cast<int>(oldest);
}

void kernel_book::mix(std::size_t count, double *const *out) const {
  mixture m;
  for (int k = 0; k < points; ++k) m.weight[k] = weight_[k];
  for (int a = 0; a < arrays_; ++a) {
    for (int k = 0; k < points; ++k)
      m.from[k] = pages_.data() + (static_cast<std::size_t>(chosen_[k] * arrays_ + a)) * stride_;
    add_up(m, count, out[a]);
  }
}

}  // namespace railpatch
