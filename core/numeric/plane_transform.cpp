#include "numeric/plane_transform.hpp"

namespace railpatch {

plane_transform::plane_transform(const fft_plans &plans)
    : plans_(plans), along_x_(plans.max_nx()), along_y_(plans.max_ny()) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  padded_ = aligned_buffer<double>(nx * ny);
  transform_ = aligned_buffer<std::complex<double>>((nx / 2 + 1) * ny);
  const auto columns = static_cast<size_t>(fft::whole_packs(plans.max_nx() / 2 + 1));
  const auto waves = static_cast<size_t>(fft::whole_packs(plans.max_ny()));
  for (auto &b : lateral_) b = aligned_buffer<double>(columns * ny);
  for (auto &b : along_) b = aligned_buffer<double>(waves * nx);
}

size_t plane_transform::bytes() const {
  return along_x_.bytes() + along_y_.bytes() + padded_.bytes() + transform_.bytes() +
         4 * (lateral_[0].bytes() + along_[0].bytes());
}

void plane_transform::set_plan(int plan) {
  if (plan == plan_) return;
  plan_ = plan;
  along_x_.set_length(nx());
  along_y_.set_length(ny());
}

plane_transform::lines plane_transform::forward(const int from[2], const double *re,
                                                const double *im) {
  const int waves = fft::whole_packs(ny()), columns = fft::whole_packs(from[0]);
  for (int j = 0; j < from[1]; ++j) {
    double *row[2] = {lateral_[0].data() + j * columns, lateral_[1].data() + j * columns};
    std::copy_n(re + j * from[0], from[0], row[0]);
    if (im)
      std::copy_n(im + j * from[0], from[0], row[1]);
    else
      std::fill_n(row[1], from[0], 0.0);
    for (double *r : row) std::fill(r + from[0], r + columns, 0.0);
  }
  const lines z = along_y_.forward(columns, from[1], {lateral_[0].data(), lateral_[1].data()},
                                   {lateral_[2].data(), lateral_[3].data()});
  for (int i = 0; i < from[0]; ++i)
    for (int j = 0; j < waves; ++j) {
      const auto at = static_cast<size_t>(i * waves + j);
      along_[0][at] = j < ny() ? z.re[j * columns + i] : 0.0;
      along_[1][at] = j < ny() ? z.im[j * columns + i] : 0.0;
    }
  return along_x_.forward(waves, from[0], {along_[0].data(), along_[1].data()},
                          {along_[2].data(), along_[3].data()});
}

plane_transform::lines plane_transform::back(const int to[2], lines product, lines work) {
  const int waves = fft::whole_packs(ny()), columns = fft::whole_packs(to[0]);
  const lines x = along_x_.backward(waves, to[0], product, work);
  for (int j = 0; j < ny(); ++j)
    for (int i = 0; i < columns; ++i) {
      const auto at = static_cast<size_t>(j * columns + i);
      lateral_[0][at] = i < to[0] ? x.re[i * waves + j] : 0.0;
      lateral_[1][at] = i < to[0] ? x.im[i * waves + j] : 0.0;
    }
  return along_y_.backward(columns, to[1], {lateral_[0].data(), lateral_[1].data()},
                           {lateral_[2].data(), lateral_[3].data()});
}

}  // namespace railpatch
