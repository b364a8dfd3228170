#include "timing.hpp"

#include <chrono>
#include <complex>
#include <ctime>

#include "convert.hpp"
// a run time means little without the machine's, so this one file looks behind railpatch.h
#include "numeric/fft.hpp"
#include "numeric/memory.hpp"

namespace railpatch::python {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// s, by the wall's clock, or of the processor in this thread where the system counts that.
double now(bool processor_time) {
#ifdef CLOCK_THREAD_CPUTIME_ID
  timespec spent{};
  if (processor_time && clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent) == 0)
    return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
#endif
  static_cast<void>(processor_time);
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

// the array takes the numbers over
template <class Array>
Array array_of(std::unique_ptr<double[]> values, std::initializer_list<size_t> shape) {
  double *data = values.get();
  nb::capsule owner(values.release(), [](void *p) noexcept { delete[] static_cast<double *>(p); });
  return Array(data, shape, owner);
}

}  // namespace

timed_steps::timed_steps(const nb::list &inputs, const nb::list &reset, int repeat,
                         bool processor_time)
    : repeat_(repeat > 0 ? static_cast<size_t>(repeat) : 0), processor_time_(processor_time) {
  if (repeat < 1) throw nb::value_error("repeat: allowed 1 and more");
  if (nb::len(inputs) != nb::len(reset)) throw nb::value_error("reset: allowed one per input");
  for (const nb::handle given : inputs) {
    rp_default_input(&inputs_.emplace_back());
    fill_input(nb::cast<nb::dict>(given), inputs_.back());
  }
  for (const nb::handle given : reset) reset_.push_back(nb::cast<bool>(given));
  results_.resize(inputs_.size());
  seconds_.reset(new double[repeat_ * inputs_.size() + 1]);
}

rp_error timed_steps::run(rp_contact *contact, rp_message &message) {
  double *next = seconds_.get();
  for (size_t pass = 0; pass < repeat_; ++pass)
    for (size_t i = 0; i < inputs_.size(); ++i) {
      if (reset_[i]) rp_reset(contact);
      const double begin = now(processor_time_);
      const rp_error code = rp_step(contact, &inputs_[i], &results_[i], &message);
      *next++ = now(processor_time_) - begin;
      if (code != RP_OK) return code;
    }
  return RP_OK;
}

nb::tuple timed_steps::outcome() {
  using Array = nb::ndarray<nb::numpy, double, nb::ndim<2>>;
  nb::list results;
  for (const rp_result &result : results_) results.append(result_dict(result));
  return nb::make_tuple(array_of<Array>(std::move(seconds_), {repeat_, inputs_.size()}), results);
}

nb::ndarray<nb::numpy, double, nb::ndim<1>> time_fft(int size, int repeat) {
  if (size < 2 || size > 4096) throw nb::value_error("size: allowed 2 to 4096");
  if (repeat < 1) throw nb::value_error("repeat: allowed 1 and more");
  const auto n = static_cast<size_t>(size), count = static_cast<size_t>(repeat);
  const fft_plans plans({size}, {size});
  aligned_buffer<double> values(n * n);
  aligned_buffer<std::complex<double>> spectrum(n * (n / 2 + 1));
  for (size_t i = 0; i < n * n; ++i) values[i] = static_cast<double>(i % 7);
  std::unique_ptr<double[]> seconds(new double[count]);
  for (size_t i = 0; i < count; ++i) {
    const auto begin = Clock::now();
    plans.forward(0, values.data(), spectrum.data());
    seconds[i] = since(begin);
  }
  return array_of<nb::ndarray<nb::numpy, double, nb::ndim<1>>>(std::move(seconds), {count});
}

}  // namespace railpatch::python
