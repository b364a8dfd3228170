// How numbers of the contact search change as a wheel is displaced and turned while its rail or
// roller stays: what a force and moment of the wheel are to follow from, as those of an energy that
// depends on them.
//
// At a lateral position the depth of the overlap grows by c . (t + turn x r) with the displacement
// t, the rotation about the track's origin, the point r of the locus and c = N/N_z, N the normal of
// the wheel's surface: along x the locus has the least gap, so what it moves on changes nothing.
#pragma once

#include "geometry/placement.hpp"

namespace railpatch {

// By displacement (1/m) and by rotation about the track's origin (1/rad), times the number's unit.
template <class T>
struct basic_place_slope {
  vec<T> by_offset{}, by_turn{};

  void add(const T &factor, const basic_place_slope &b) {
    by_offset = by_offset + factor * b.by_offset;
    by_turn = by_turn + factor * b.by_turn;
  }
};
using place_slope = basic_place_slope<double>;

template <class T>
basic_place_slope<T> scaled(const T &factor, const basic_place_slope<T> &b) {
  return {factor * b.by_offset, factor * b.by_turn};
}

// Adds to a wheel's force and moment about a point what an energy that grows so takes.
template <class T>
void add_yielding(const basic_place_slope<T> &energy, const vec<T> &centre, T force[3],
                  T moment[3]) {
  const vec<T> turning = energy.by_turn - cross(centre, energy.by_offset);
  for (size_t k = 0; k < 3; ++k) {
    force[k] -= energy.by_offset[k];
    moment[k] -= turning[k];
  }
}

// Of the depth at a point of the locus; normal: of the wheel's surface, over its part along z.
template <class T>
basic_place_slope<T> depth_slope(const vec<T> &at, const vec<T> &normal) {
  return {normal, cross(at, normal)};
}

}  // namespace railpatch
