#include "numeric/kernel_transform.hpp"

#include <algorithm>
#include <utility>

namespace railpatch {

kernel_transform::kernel_transform(int max_nx, int max_ny) : along_x_(max_nx), along_y_(max_ny) {
  const auto size = [](int length, int others) {
    return static_cast<size_t>(length) * static_cast<size_t>(fft::whole_packs(others / 2 + 1));
  };
  const size_t count = std::max(size(max_nx, max_ny), size(max_ny, max_nx));
  for (auto &buffer : buffer_) buffer = aligned_buffer<double>(count);
}

void kernel_transform::set_size(int nx, int ny) {
  if (nx == nx_ && ny == ny_) return;
  nx_ = nx;
  ny_ = ny;
  along_x_.set_length(nx);
  along_y_.set_length(ny);
}

// Half the lines that go along x, a column for each lateral wave; the other pair of buffers is
// free.
kernel_transform::lines kernel_transform::laterally(bool odd, const double *values, int stride) {
  const int half_x = nx_ / 2, half_y = ny_ / 2;
  const int columns = fft::whole_packs(half_x + 1), waves = fft::whole_packs(half_y + 1);
  lines here{buffer_[0].data(), buffer_[1].data()}, there{buffer_[2].data(), buffer_[3].data()};
  for (int j = 0; j < half_y; ++j) {
    const double share = j > 0 ? 1.0 : odd ? 0.0 : 0.5;
    double *to = here.re + j * columns;
    for (int i = 0; i <= half_x; ++i) to[i] = share * values[j * stride + i];
    std::fill(to + half_x + 1, to + columns, 0.0);
    std::fill_n(here.im + j * columns, columns, 0.0);
  }
  lines waved = here;
  if (ny_ > 1) waved = along_y_.forward(columns, half_y, here, there);
  if (waved.re == there.re) std::swap(here, there);
  // from waved, which is here, to there; the middle value adds to even ones
  const double *middle = values + half_y * stride;
  for (int i = 0; i <= half_x; ++i) {
    double *to = there.re + i * waves;
    for (int l = 0; l <= half_y; ++l) {
      const double sign = l % 2 == 0 ? 1.0 : -1.0;
      if (ny_ == 1)
        to[l] = odd ? 0.0 : middle[i];
      else if (odd)
        to[l] = 2.0 * here.im[l * columns + i];
      else
        to[l] = 2.0 * here.re[l * columns + i] + sign * middle[i];
    }
    std::fill(to + half_y + 1, to + waves, 0.0);
    std::fill_n(there.im + i * waves, waves, 0.0);
  }
  return there;
}

void kernel_transform::make(bool odd, const double *values, int stride, double *spectrum) {
  const int half_x = nx_ / 2, half_y = ny_ / 2, width = half_x + 1;
  const int waves = fft::whole_packs(half_y + 1);
  lines data = laterally(odd, values, stride);
  const bool second = data.re == buffer_[2].data();
  const lines work{buffer_[second ? 0 : 2].data(), buffer_[second ? 1 : 3].data()};
  // what lies in the middle is kept where the spectrum will be
  if (!odd)
    for (int l = 0; l <= half_y; ++l) spectrum[l * width] = data.re[half_x * waves + l];
  for (int l = 0; l < waves; ++l) data.re[l] *= odd ? 0.0 : 0.5;
  const lines z = along_x_.forward(waves, half_x, data, work);
  for (int l = 0; l <= half_y; ++l) {
    double *row = spectrum + l * width;
    const double end = odd ? 0.0 : row[0];
    for (int k = 0; k <= half_x; ++k) {
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      row[k] = odd ? -2.0 * z.im[k * waves + l] : 2.0 * z.re[k * waves + l] + sign * end;
    }
  }
  for (int l = half_y + 1; l < ny_; ++l) {
    const double *from = spectrum + (ny_ - l) * width;
    double *row = spectrum + l * width;
    for (int k = 0; k <= half_x; ++k) row[k] = odd ? -from[k] : from[k];
  }
}

}  // namespace railpatch
