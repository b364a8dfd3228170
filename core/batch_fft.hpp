// Single-precision complex transforms of many lines at once, for products that only steer an
// iteration: the lines lie side by side, so every step works on whole SIMD registers. At the sizes
// of contact grids this takes a third of the time that FFT libraries take, line after line. What a
// result is measured by stays with the library's transforms (fft.hpp).
//
// Stockham's self-sorting method (Van Loan 1992, section 1.7) with factors 2, 3, 4 and 5.
// Layout: [length][lines], real and imaginary parts apart; lines in whole packs. Sign: forward uses
// exp(-i k x); exchanging the real and imaginary arrays gives the backward transform. No factor.
#pragma once

#include "memory.hpp"

namespace railpatch {

class batch_fft {
 public:
  static constexpr int pack = 8;  // lines come in multiples of it
  static constexpr int whole_packs(int lines) { return (lines + pack - 1) / pack * pack; }

  explicit batch_fft(int max_length);
  // Prepares a length without prime factors above 5.
  void set_length(int length);

  struct lines {
    float *re, *im;
  };
  // Transforms `data`, with `work` of the same size; the result is in the one that is returned.
  lines transform(int count, lines data, lines work) const;
  size_t bytes() const { return 2 * cosine_.bytes(); }

 private:
  static constexpr int max_factors = 32;
  int length_ = 1;
  int factors_ = 0;
  int factor_[max_factors] = {};
  aligned_buffer<float> cosine_, sine_;  // exp(-2 pi i k/length)
};

}  // namespace railpatch
