#include "batch_fft.hpp"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>

#include "simd.hpp"

namespace railpatch {

namespace {

// One pass splits each of `stride` transforms of length factor * m; `run` numbers lie side by side.
struct pass {
  int m, stride, run;
  const float *cosine, *sine;
  const float *xr, *xi;
  float *yr, *yi;
};

struct twiddle {
  float c, s;
};
inline twiddle turn(const pass &f, int k, int p) {
  return {f.cosine[k * p * f.stride], f.sine[k * p * f.stride]};
}

RAILPATCH_DISPATCH
void pass_2(const pass &f) {
  const auto run = static_cast<size_t>(f.run / batch_fft::pack) * batch_fft::pack;
  for (int p = 0; p < f.m; ++p) {
    const size_t x0 = static_cast<size_t>(p) * run, x1 = x0 + static_cast<size_t>(f.m) * run;
    const float *__restrict ar = f.xr + x0, *__restrict ai = f.xi + x0;
    const float *__restrict br = f.xr + x1, *__restrict bi = f.xi + x1;
    float *__restrict yr = f.yr + 2 * x0, *__restrict yi = f.yi + 2 * x0;
    const twiddle w = turn(f, 1, p);
    RAILPATCH_INDEPENDENT
    for (size_t i = 0; i < run; ++i) {
      const float dr = ar[i] - br[i], di = ai[i] - bi[i];
      yr[i] = ar[i] + br[i];
      yi[i] = ai[i] + bi[i];
      yr[run + i] = w.c * dr - w.s * di;
      yi[run + i] = w.c * di + w.s * dr;
    }
  }
}

RAILPATCH_DISPATCH
void pass_3(const pass &f) {
  const auto run = static_cast<size_t>(f.run / batch_fft::pack) * batch_fft::pack;
  const float half_root = 0.866025403784438647f;
  for (int p = 0; p < f.m; ++p) {
    const size_t x0 = static_cast<size_t>(p) * run, step = static_cast<size_t>(f.m) * run;
    const float *__restrict xr = f.xr + x0, *__restrict xi = f.xi + x0;
    float *__restrict yr = f.yr + 3 * x0, *__restrict yi = f.yi + 3 * x0;
    const twiddle w1 = turn(f, 1, p), w2 = turn(f, 2, p);
    RAILPATCH_INDEPENDENT
    for (size_t i = 0; i < run; ++i) {
      const float sr = xr[step + i] + xr[2 * step + i], si = xi[step + i] + xi[2 * step + i];
      const float dr = half_root * (xr[step + i] - xr[2 * step + i]);
      const float di = half_root * (xi[step + i] - xi[2 * step + i]);
      const float mr = xr[i] - 0.5f * sr, mi = xi[i] - 0.5f * si;
      const float pr = mr + di, pi = mi - dr, qr = mr - di, qi = mi + dr;
      yr[i] = xr[i] + sr;
      yi[i] = xi[i] + si;
      yr[run + i] = w1.c * pr - w1.s * pi;
      yi[run + i] = w1.c * pi + w1.s * pr;
      yr[2 * run + i] = w2.c * qr - w2.s * qi;
      yi[2 * run + i] = w2.c * qi + w2.s * qr;
    }
  }
}

RAILPATCH_DISPATCH
void pass_4(const pass &f) {
  const auto run = static_cast<size_t>(f.run / batch_fft::pack) * batch_fft::pack;
  for (int p = 0; p < f.m; ++p) {
    const size_t x0 = static_cast<size_t>(p) * run, step = static_cast<size_t>(f.m) * run;
    const float *__restrict xr = f.xr + x0, *__restrict xi = f.xi + x0;
    float *__restrict yr = f.yr + 4 * x0, *__restrict yi = f.yi + 4 * x0;
    const twiddle w1 = turn(f, 1, p), w2 = turn(f, 2, p), w3 = turn(f, 3, p);
    RAILPATCH_INDEPENDENT
    for (size_t i = 0; i < run; ++i) {
      const float ar = xr[i] + xr[2 * step + i], ai = xi[i] + xi[2 * step + i];
      const float br = xr[i] - xr[2 * step + i], bi = xi[i] - xi[2 * step + i];
      const float cr = xr[step + i] + xr[3 * step + i], ci = xi[step + i] + xi[3 * step + i];
      const float dr = xr[step + i] - xr[3 * step + i], di = xi[step + i] - xi[3 * step + i];
      yr[i] = ar + cr;
      yi[i] = ai + ci;
      const float pr = br + di, pi = bi - dr, qr = ar - cr, qi = ai - ci;
      const float sr = br - di, si = bi + dr;
      yr[run + i] = w1.c * pr - w1.s * pi;
      yi[run + i] = w1.c * pi + w1.s * pr;
      yr[2 * run + i] = w2.c * qr - w2.s * qi;
      yi[2 * run + i] = w2.c * qi + w2.s * qr;
      yr[3 * run + i] = w3.c * sr - w3.s * si;
      yi[3 * run + i] = w3.c * si + w3.s * sr;
    }
  }
}

RAILPATCH_DISPATCH
void pass_5(const pass &f) {
  const auto run = static_cast<size_t>(f.run / batch_fft::pack) * batch_fft::pack;
  // cosines and sines of 72 and 144 degrees
  const float c1 = 0.309016994374947424f, c2 = -0.809016994374947424f;
  const float s1 = 0.951056516295153572f, s2 = 0.587785252292473129f;
  for (int p = 0; p < f.m; ++p) {
    const size_t x0 = static_cast<size_t>(p) * run, step = static_cast<size_t>(f.m) * run;
    const float *__restrict xr = f.xr + x0, *__restrict xi = f.xi + x0;
    float *__restrict yr = f.yr + 5 * x0, *__restrict yi = f.yi + 5 * x0;
    const twiddle w[4] = {turn(f, 1, p), turn(f, 2, p), turn(f, 3, p), turn(f, 4, p)};
    RAILPATCH_INDEPENDENT
    for (size_t i = 0; i < run; ++i) {
      const float ar = xr[step + i] + xr[4 * step + i], ai = xi[step + i] + xi[4 * step + i];
      const float br = xr[2 * step + i] + xr[3 * step + i],
                  bi = xi[2 * step + i] + xi[3 * step + i];
      const float cr = xr[step + i] - xr[4 * step + i], ci = xi[step + i] - xi[4 * step + i];
      const float dr = xr[2 * step + i] - xr[3 * step + i],
                  di = xi[2 * step + i] - xi[3 * step + i];
      const float er = xr[i] + (c1 * ar + c2 * br), ei = xi[i] + (c1 * ai + c2 * bi);
      const float fr = xr[i] + (c2 * ar + c1 * br), fi = xi[i] + (c2 * ai + c1 * bi);
      const float gr = s1 * cr + s2 * dr, gi = s1 * ci + s2 * di;
      const float hr = s2 * cr - s1 * dr, hi = s2 * ci - s1 * di;
      yr[i] = xr[i] + (ar + br);
      yi[i] = xi[i] + (ai + bi);
      const float r1 = er + gi, i1 = ei - gr, r2 = fr + hi, i2 = fi - hr;
      const float r3 = fr - hi, i3 = fi + hr, r4 = er - gi, i4 = ei + gr;
      yr[run + i] = w[0].c * r1 - w[0].s * i1;
      yi[run + i] = w[0].c * i1 + w[0].s * r1;
      yr[2 * run + i] = w[1].c * r2 - w[1].s * i2;
      yi[2 * run + i] = w[1].c * i2 + w[1].s * r2;
      yr[3 * run + i] = w[2].c * r3 - w[2].s * i3;
      yi[3 * run + i] = w[2].c * i3 + w[2].s * r3;
      yr[4 * run + i] = w[3].c * r4 - w[3].s * i4;
      yi[4 * run + i] = w[3].c * i4 + w[3].s * r4;
    }
  }
}

}  // namespace

batch_fft::batch_fft(int max_length)
    : cosine_(static_cast<size_t>(max_length)), sine_(static_cast<size_t>(max_length)) {}

void batch_fft::set_length(int length) {
  length_ = length;
  factors_ = 0;
  for (int rest = length; int f : {4, 2, 3, 5})
    for (; rest % f == 0; rest /= f) factor_[factors_++] = f;
  for (int k = 0; k < length; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / length;
    cosine_[static_cast<size_t>(k)] = static_cast<float>(std::cos(angle));
    sine_[static_cast<size_t>(k)] = static_cast<float>(-std::sin(angle));
  }
}

batch_fft::lines batch_fft::transform(int count, lines data, lines work) const {
  for (int k = 0, stride = 1; k < factors_; ++k) {
    const int f = factor_[k];
    const pass step{length_ / (stride * f),
                    stride,
                    stride * count,
                    cosine_.data(),
                    sine_.data(),
                    data.re,
                    data.im,
                    work.re,
                    work.im};
    (f == 2 ? pass_2 : f == 3 ? pass_3 : f == 4 ? pass_4 : pass_5)(step);
    stride *= f;
    std::swap(data, work);
  }
  return data;
}

}  // namespace railpatch
