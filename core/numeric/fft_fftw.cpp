#include <fftw3.h>

#include <mutex>
#include <utility>

#include "numeric/fft.hpp"

namespace railpatch {

namespace {

// FFTW's planner works on process-wide tables; execution is free of them. This lock is the one
// exception to "no globals", forced by the library.
std::mutex &planner_lock() {
  static std::mutex lock;
  return lock;
}

fftw_complex *as_fftw(std::complex<double> *z) { return reinterpret_cast<fftw_complex *>(z); }

}  // namespace

struct fft_plans::library {
  ~library() {
    const std::lock_guard<std::mutex> guard(planner_lock());
    for (fftw_plan plan : plans) fftw_destroy_plan(plan);
  }
  std::vector<fftw_plan> plans;
};

fft_plans::fft_plans(std::vector<int> sizes_x, std::vector<int> sizes_y)
    : sizes_x_(std::move(sizes_x)),
      sizes_y_(std::move(sizes_y)),
      library_(std::make_unique<library>()) {
  const auto count = static_cast<size_t>(max_nx()) * static_cast<size_t>(max_ny());
  aligned_buffer<double> values(count);
  aligned_buffer<std::complex<double>> spectrum(static_cast<size_t>(max_nx() / 2 + 1) *
                                                static_cast<size_t>(max_ny()));
  auto &plans = library_->plans;
  plans.resize(sizes_x_.size() * sizes_y_.size());
  // FFTW's buffered plans take memory from the heap in every execution
  constexpr unsigned flags = FFTW_ESTIMATE | FFTW_NO_BUFFERING;
  const std::lock_guard<std::mutex> guard(planner_lock());
  for (size_t i = 0; i < plans.size(); ++i) {
    // estimated plans depend on nothing but the size, so results are the same in every run
    const int plan = static_cast<int>(i);
    plans[i] =
        fftw_plan_dft_r2c_2d(ny(plan), nx(plan), values.data(), as_fftw(spectrum.data()), flags);
    if (!plans[i]) throw std::bad_alloc();
  }
}

fft_plans::~fft_plans() = default;

size_t fft_plans::bytes() const { return library_->plans.size() * sizeof(fftw_plan); }

void fft_plans::forward(int plan, const double *values, std::complex<double> *spectrum) const {
  fftw_execute_dft_r2c(library_->plans[static_cast<size_t>(plan)], const_cast<double *>(values),
                       as_fftw(spectrum));
}

const char *fft_plans::backend() { return "fftw"; }

}  // namespace railpatch
