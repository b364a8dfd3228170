// A profile that varies along the track, of a rail, or round the wheel: profiles at given
// positions, blended in between.
//
// Knot i of one section belongs to knot i of the next. By share both lie at the same share of the
// arc length; by knot anywhere, so that edges, a blade's tip or a crossing's nose go from section
// to section where the knots go. Between two neighbouring sections the knots' arc lengths, y and z
// are linear in the position, or Hermite's cubics with the slopes of parabolas through three
// sections. These are linear in the knots, as a rule of slopes that keeps each knot between its
// values is not: that one bends the profile wherever its neighbours take another case. Slopes are 0
// at the ends. At a kink each side has the slope of a parabola by its own sections alone: where a
// part of the profile begins at once, as a blade's tip. Next to an end that is the chord's, as the
// slope of 0 says nothing of the way inside: so what goes on evenly through a kink has one slope.
// Before the first and beyond the last section the profile is constant; with a period it goes on at
// the first. Each step's rail is prismatic, each step's wheel round, with the profile there.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/profile.hpp"

namespace railpatch {

struct section_rules {
  bool by_knot = false;  // knots belong together wherever they lie; else at equal shares
  bool cubic = false;    // else linear
  double period = 0;     // of the position; 0: none
  const std::int32_t *kink = nullptr;  // of each section, 1: one; null: none
};

// How a point of the blended profile that stays at its share of a piece between two knots moves
// with the position, and how that changes along the arc length.
struct section_rate {
  double y = 0, z = 0;    // m by position
  double dy = 0, dz = 0;  // - by position
};

class profile_sections {
 public:
  // Views that have passed validate() and fault(), copied; positions (m or rad) increase, within
  // a period.
  profile_sections(const profile_view *sections, const double *positions, int count,
                   const section_rules &rules = {});
  // Whether two sections have knots that belong together.
  static bool belong_together(const profile_view &a, const profile_view &b, bool by_knot = false);

  // The profile at x; changed tells whether it is another than the last one, at first the first
  // section, or goes on to another section.
  profile_view at(double x, bool &changed);
  // Of the last profile, at a share of the piece from knot i to the next: from its position on.
  section_rate rate(int i, double share) const;
  std::size_t bytes() const;

 private:
  using values = std::vector<double>;
  struct section {
    double position;
    values s, y, z, dy, dz;
  };
  // Of the knots by position, each over the way to the next section.
  struct slopes {
    values s, y, z;
  };
  struct place {
    std::size_t first = 0, second = 0;
    double share = 0, length = 1;  // of the way from the first to the second, and that way
  };
  // Rates of a knot by position; dy, dz those of the derivatives by arc length.
  struct knot_rate {
    double s, y, z, dy, dz;
  };
  profile_view view() const {
    return {now_.s.data(),  now_.y.data(),  now_.z.data(),
            now_.dy.data(), now_.dz.data(), static_cast<int>(now_.s.size())};
  }
  place place_of(double x) const;
  double way(std::size_t k) const;
  void find_slopes(const std::int32_t *kink);
  template <class F>
  void set_slopes(slopes &to, F slope) const;
  void mix_shares(const section &a, const section &b, double share);
  void mix_knots(const place &at);
  knot_rate rate_of(std::size_t knot) const;

  std::vector<section> sections_;
  std::vector<slopes> slopes_;             // cubic: of the sections, two at a kink
  std::vector<std::size_t> left_, right_;  // which of them each section has on either side
  section now_;
  section_rules rules_;
  place last_;  // of the profile now
};

}  // namespace railpatch
