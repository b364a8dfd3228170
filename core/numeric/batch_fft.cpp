#include "numeric/batch_fft.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>

#include "numeric/elementary.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

namespace {

// One pass splits each of `stride` transforms of length factor * m; `run` numbers lie side by side.
template <class T>
struct pass {
  int factor, m, stride;
  size_t run;
  const T *cosine, *sine;
  const T *xr, *xi;
  T *yr, *yi;
  enum { whole, first, last } part;  // first: second half zero; last: second half not asked for
};

// Where one butterfly reads and writes: x step apart, y run apart, y turned by w where asked for.
template <class T>
struct place {
  size_t run, step;
  const T *xr, *xi;
  T *yr, *yi;
  T c[5], s[5];
};

template <bool turned, class T>
RAILPATCH_INLINE void put(const place<T> &f, int k, size_t i, T re, T im) {
  const size_t at = static_cast<size_t>(k) * f.run + i;
  f.yr[at] = turned ? f.c[k] * re - f.s[k] * im : re;
  f.yi[at] = turned ? f.c[k] * im + f.s[k] * re : im;
}

template <bool turned, class T>
RAILPATCH_INLINE void butterfly_2(const place<T> &f) {
  const size_t n = f.run, h = f.step;
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < n; ++i) {
    put<false>(f, 0, i, f.xr[i] + f.xr[h + i], f.xi[i] + f.xi[h + i]);
    put<turned>(f, 1, i, f.xr[i] - f.xr[h + i], f.xi[i] - f.xi[h + i]);
  }
}

template <bool turned, class T>
RAILPATCH_INLINE void butterfly_3(const place<T> &f) {
  const size_t n = f.run, h = f.step;
  const T half_root = static_cast<T>(0.866025403784438646763723);
  const T half = static_cast<T>(0.5);
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < n; ++i) {
    const T ar = f.xr[h + i] + f.xr[2 * h + i], ai = f.xi[h + i] + f.xi[2 * h + i];
    const T br = half_root * (f.xr[h + i] - f.xr[2 * h + i]);
    const T bi = half_root * (f.xi[h + i] - f.xi[2 * h + i]);
    const T cr = f.xr[i] - half * ar, ci = f.xi[i] - half * ai;
    put<false>(f, 0, i, f.xr[i] + ar, f.xi[i] + ai);
    put<turned>(f, 1, i, cr + bi, ci - br);
    put<turned>(f, 2, i, cr - bi, ci + br);
  }
}

template <bool turned, class T>
RAILPATCH_INLINE void butterfly_4(const place<T> &f) {
  const size_t n = f.run, h = f.step;
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < n; ++i) {
    const T ar = f.xr[i] + f.xr[2 * h + i], ai = f.xi[i] + f.xi[2 * h + i];
    const T br = f.xr[i] - f.xr[2 * h + i], bi = f.xi[i] - f.xi[2 * h + i];
    const T cr = f.xr[h + i] + f.xr[3 * h + i], ci = f.xi[h + i] + f.xi[3 * h + i];
    const T dr = f.xr[h + i] - f.xr[3 * h + i], di = f.xi[h + i] - f.xi[3 * h + i];
    put<false>(f, 0, i, ar + cr, ai + ci);
    put<turned>(f, 1, i, br + di, bi - dr);
    put<turned>(f, 2, i, ar - cr, ai - ci);
    put<turned>(f, 3, i, br - di, bi + dr);
  }
}

template <bool turned, class T>
RAILPATCH_INLINE void butterfly_5(const place<T> &f) {
  const size_t n = f.run, h = f.step;
  // cosines and sines of 72 and 144 degrees
  const T c1 = static_cast<T>(0.309016994374947424102293);
  const T c2 = static_cast<T>(-0.809016994374947424102293);
  const T s1 = static_cast<T>(0.951056516295153572116439);
  const T s2 = static_cast<T>(0.587785252292473129168706);
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < n; ++i) {
    const T x0 = f.xr[i], y0 = f.xi[i];
    const T ar = f.xr[h + i] + f.xr[4 * h + i], ai = f.xi[h + i] + f.xi[4 * h + i];
    const T br = f.xr[2 * h + i] + f.xr[3 * h + i], bi = f.xi[2 * h + i] + f.xi[3 * h + i];
    const T cr = f.xr[h + i] - f.xr[4 * h + i], ci = f.xi[h + i] - f.xi[4 * h + i];
    const T dr = f.xr[2 * h + i] - f.xr[3 * h + i], di = f.xi[2 * h + i] - f.xi[3 * h + i];
    const T er = x0 + (c1 * ar + c2 * br), ei = y0 + (c1 * ai + c2 * bi);
    const T gr = x0 + (c2 * ar + c1 * br), gi = y0 + (c2 * ai + c1 * bi);
    const T pr = s1 * cr + s2 * dr, pi = s1 * ci + s2 * di;
    const T qr = s2 * cr - s1 * dr, qi = s2 * ci - s1 * di;
    put<false>(f, 0, i, x0 + (ar + br), y0 + (ai + bi));
    put<turned>(f, 1, i, er + pi, ei - pr);
    put<turned>(f, 2, i, gr + qi, gi - qr);
    put<turned>(f, 3, i, gr - qi, gi + qr);
    put<turned>(f, 4, i, er - pi, ei + pr);
  }
}

// The second half of the line is zero.
template <class T>
RAILPATCH_INLINE void first_2(const place<T> &f) {
  const size_t n = f.run;
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < n; ++i) {
    put<false>(f, 0, i, f.xr[i], f.xi[i]);
    put<true>(f, 1, i, f.xr[i], f.xi[i]);
  }
}

template <class T>
RAILPATCH_INLINE void first_4(const place<T> &f) {
  const size_t n = f.run, h = f.step;
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < n; ++i) {
    const T ar = f.xr[i], ai = f.xi[i], br = f.xr[h + i], bi = f.xi[h + i];
    put<false>(f, 0, i, ar + br, ai + bi);
    put<true>(f, 1, i, ar + bi, ai - br);
    put<true>(f, 2, i, ar - br, ai - bi);
    put<true>(f, 3, i, ar - bi, ai + br);
  }
}

// The second half of the line is not asked for.
template <class T>
RAILPATCH_INLINE void last_2(const place<T> &f) {
  const size_t n = f.run, h = f.step;
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < n; ++i) put<false>(f, 0, i, f.xr[i] + f.xr[h + i], f.xi[i] + f.xi[h + i]);
}

template <class T>
RAILPATCH_INLINE void last_4(const place<T> &f) {
  const size_t n = f.run, h = f.step;
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < n; ++i) {
    put<false>(f, 0, i, (f.xr[i] + f.xr[2 * h + i]) + (f.xr[h + i] + f.xr[3 * h + i]),
               (f.xi[i] + f.xi[2 * h + i]) + (f.xi[h + i] + f.xi[3 * h + i]));
    put<false>(f, 1, i, (f.xr[i] - f.xr[2 * h + i]) + (f.xi[h + i] - f.xi[3 * h + i]),
               (f.xi[i] - f.xi[2 * h + i]) - (f.xr[h + i] - f.xr[3 * h + i]));
  }
}

template <bool turned, class T>
RAILPATCH_INLINE void butterfly(int factor, const place<T> &f) {
  if (factor == 2) butterfly_2<turned>(f);
  if (factor == 3) butterfly_3<turned>(f);
  if (factor == 4) butterfly_4<turned>(f);
  if (factor == 5) butterfly_5<turned>(f);
}

template <class T>
RAILPATCH_INLINE void run(const pass<T> &f) {
  // the compiler sees that no pack is left over
  const size_t width = f.run / batch_fft<T>::pack * batch_fft<T>::pack;
  for (int p = 0; p < f.m; ++p) {
    const size_t x = static_cast<size_t>(p) * width, y = static_cast<size_t>(f.factor) * x;
    place<T> at{width, static_cast<size_t>(f.m) * width, f.xr + x, f.xi + x, f.yr + y, f.yi + y, {},
                {}};
    for (int k = 1; k < f.factor; ++k) {
      at.c[k] = f.cosine[k * p * f.stride];
      at.s[k] = f.sine[k * p * f.stride];
    }
    if (f.part == pass<T>::first)
      f.factor == 2 ? first_2(at) : first_4(at);
    else if (f.part == pass<T>::last)
      f.factor == 2 ? last_2(at) : last_4(at);
    else if (p == 0)
      butterfly<false>(f.factor, at);
    else
      butterfly<true>(f.factor, at);
  }
}

// dispatch does not go with templates
RAILPATCH_DISPATCH
void run_pass(const pass<float> &f) { run(f); }
RAILPATCH_DISPATCH
void run_pass(const pass<double> &f) { run(f); }

}  // namespace

template <class T>
batch_fft<T>::batch_fft(int max_length)
    : cosine_(static_cast<size_t>(max_length)), sine_(static_cast<size_t>(max_length)) {}

template <class T>
void batch_fft<T>::set_length(int length) {
  length_ = length;
  factors_ = 0;
  int rest = length;
  for (int f : {4, 2, 3, 5})
    for (; rest % f == 0; rest /= f) factor_[factors_++] = f;
  for (int k = 0; k < length; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / length;
    cosine_[static_cast<size_t>(k)] = static_cast<T>(cos(angle));
    sine_[static_cast<size_t>(k)] = static_cast<T>(-sin(angle));
  }
}

template <class T>
typename batch_fft<T>::lines batch_fft<T>::forward(int count, int used, lines data,
                                                   lines work) const {
  const int filled = factors_ > 1 ? length_ / 2 : length_;
  std::fill(data.re + used * count, data.re + filled * count, T(0));
  std::fill(data.im + used * count, data.im + filled * count, T(0));
  for (int k = 0, stride = 1; k < factors_; ++k) {
    const int f = factor_[k];
    run_pass({f, length_ / (stride * f), stride, static_cast<size_t>(stride * count),
              cosine_.data(), sine_.data(), data.re, data.im, work.re, work.im,
              k == 0 && factors_ > 1 ? pass<T>::first : pass<T>::whole});
    stride *= f;
    std::swap(data, work);
  }
  return data;
}

// Real and imaginary parts change places; factors in reverse, so that a 4 or 2 comes last.
template <class T>
typename batch_fft<T>::lines batch_fft<T>::backward(int count, int used, lines data,
                                                    lines work) const {
  const bool half = factors_ > 1 && 2 * used <= length_;
  for (int k = factors_ - 1, stride = 1; k >= 0; --k) {
    const int f = factor_[k];
    run_pass({f, length_ / (stride * f), stride, static_cast<size_t>(stride * count),
              cosine_.data(), sine_.data(), data.im, data.re, work.im, work.re,
              k == 0 && half ? pass<T>::last : pass<T>::whole});
    stride *= f;
    std::swap(data, work);
  }
  return data;
}

template class batch_fft<float>;
template class batch_fft<double>;

}  // namespace railpatch
