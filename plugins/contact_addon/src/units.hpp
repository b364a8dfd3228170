// Units and signs of the interface, by its flag 1933. Everything is kept in SI inside.
#pragma once

namespace contact_addon {

enum unit_code { unit_mm = 1934, unit_metre_wheel = 1935, unit_metre_rail = 1936 };

struct units {
  double length = 1e-3;  // m in the unit of length; force N, time s, angle rad, temperature C
  // of tractions, tangential forces, creepages and slip that are handed out, over those on the
  // wheel and of wheel minus rail
  double sign = -1.0;

  double area() const { return length * length; }
  double pressure() const { return 1.0 / (length * length); }  // Pa
  double per_length() const { return 1.0 / length; }
  double volume() const { return length * length * length; }
};

inline units units_of(int code) {
  if (code == unit_metre_wheel) return {1.0, 1.0};
  if (code == unit_metre_rail) return {1.0, -1.0};
  return {};
}

}  // namespace contact_addon
