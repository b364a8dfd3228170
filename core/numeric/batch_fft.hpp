// Complex transforms of many lines at once: the lines lie side by side, so every step works on
// whole SIMD registers. At the sizes of contact grids this takes a third of the time that FFT
// libraries take, line after line, and gives the same bits with any of them.
//
// Stockham's self-sorting method (Van Loan 1992, section 1.7) with factors 2, 3, 4 and 5. What is
// known to be zero at the start or not asked for at the end of a padded line is left out.
// Layout: [length][lines], real and imaginary parts apart; lines in whole packs. Sign: forward uses
// exp(-i k x), backward exp(i k x); neither carries a factor.
#pragma once

#include "numeric/memory.hpp"

namespace railpatch {

template <class T>
class batch_fft {
 public:
  static constexpr int pack = 8;  // lines come in multiples of it
  static constexpr int whole_packs(int lines) { return (lines + pack - 1) / pack * pack; }

  explicit batch_fft(int max_length);
  // Prepares a length: 1, or even without prime factors above 5.
  void set_length(int length);

  struct lines {
    T *re, *im;
  };
  // Transform `data` with `work` of the same size; the result is in the one that is returned.
  // forward: of the data only the first `used` rows hold numbers, the others count as zero;
  // backward: of the result only the first `used` rows are made. At most half the length, where
  // that is not 1.
  lines forward(int count, int used, lines data, lines work) const;
  lines backward(int count, int used, lines data, lines work) const;
  size_t bytes() const { return 2 * cosine_.bytes(); }

 private:
  static constexpr int max_factors = 32;
  int length_ = 1;
  int factors_ = 0;
  int factor_[max_factors] = {};     // 4 and 2 first
  aligned_buffer<T> cosine_, sine_;  // exp(-2 pi i k/length)
};

extern template class batch_fft<float>;
extern template class batch_fft<double>;

}  // namespace railpatch
