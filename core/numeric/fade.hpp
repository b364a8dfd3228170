// A smooth step down.
#pragma once

namespace railpatch {

// From 1 at t <= 0 to 0 at t >= 1, with two continuous derivatives.
template <class T>
T fade(const T &t) {
  if (!(t > 0)) return T(1);
  if (!(t < 1)) return T(0);
  return 1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t));
}

}  // namespace railpatch
