#include "fft.hpp"

#include <fftw3.h>

#include <mutex>

namespace railpatch {

struct fft_plans::plan_pair {
  fftw_plan forward = nullptr;
  fftw_plan backward = nullptr;
};

namespace {

// FFTW's planner works on process-wide tables; execution is free of them. This lock is the one
// exception to "no globals", forced by the library.
std::mutex &planner_lock() {
  static std::mutex lock;
  return lock;
}

fftw_complex *as_fftw(std::complex<double> *z) { return reinterpret_cast<fftw_complex *>(z); }

}  // namespace

fft_plans::fft_plans(std::vector<int> sizes_x, std::vector<int> sizes_y)
    : sizes_x_(std::move(sizes_x)), sizes_y_(std::move(sizes_y)) {
  const auto count = static_cast<size_t>(max_nx()) * static_cast<size_t>(max_ny());
  aligned_buffer<double> values(count);
  aligned_buffer<std::complex<double>> spectrum(static_cast<size_t>(max_nx() / 2 + 1) *
                                                static_cast<size_t>(max_ny()));
  plans_.resize(sizes_x_.size() * sizes_y_.size());
  // FFTW's buffered plans take memory from the heap in every execution
  constexpr unsigned flags = FFTW_ESTIMATE | FFTW_NO_BUFFERING;
  const std::lock_guard<std::mutex> guard(planner_lock());
  for (size_t i = 0; i < plans_.size(); ++i) {
    // estimated plans depend on nothing but the size, so results are the same in every run
    const int plan = static_cast<int>(i);
    plans_[i].forward =
        fftw_plan_dft_r2c_2d(ny(plan), nx(plan), values.data(), as_fftw(spectrum.data()), flags);
    plans_[i].backward =
        fftw_plan_dft_c2r_2d(ny(plan), nx(plan), as_fftw(spectrum.data()), values.data(), flags);
    if (!plans_[i].forward || !plans_[i].backward) throw std::bad_alloc();
  }
}

fft_plans::~fft_plans() {
  const std::lock_guard<std::mutex> guard(planner_lock());
  for (auto &pair : plans_) {
    fftw_destroy_plan(pair.forward);
    fftw_destroy_plan(pair.backward);
  }
}

int fft_plans::find(int min_nx, int min_ny) const {
  for (size_t i = 0; i < sizes_x_.size(); ++i) {
    if (sizes_x_[i] < min_nx) continue;
    for (size_t j = 0; j < sizes_y_.size(); ++j)
      if (sizes_y_[j] >= min_ny) return static_cast<int>(i * sizes_y_.size() + j);
  }
  return -1;
}

size_t fft_plans::bytes() const { return plans_.size() * sizeof(plan_pair); }

void fft_plans::forward(int plan, const double *values, std::complex<double> *spectrum) const {
  fftw_execute_dft_r2c(plans_[static_cast<size_t>(plan)].forward, const_cast<double *>(values),
                       as_fftw(spectrum));
}

void fft_plans::backward(int plan, std::complex<double> *spectrum, double *values) const {
  fftw_execute_dft_c2r(plans_[static_cast<size_t>(plan)].backward, as_fftw(spectrum), values);
}

const char *fft_plans::backend() { return "fftw"; }

int smooth_size(int n) {
  for (int m = n + n % 2;; m += 2) {
    // FFTW takes memory from the heap in every execution with these numbers of rows
    if (m == 576 || m == 640) continue;
    int rest = m;
    for (int prime : {2, 3, 5})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return m;
  }
}

}  // namespace railpatch
