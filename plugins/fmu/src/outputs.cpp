#include "outputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace railpatch::fmu {

namespace {

using Vector = std::array<double, 3>;

// A number and its rate.
struct Dual {
  double value, rate;
};
Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.rate + b.rate}; }
Dual operator*(Dual a, Dual b) { return {a.value * b.value, a.rate * b.value + a.value * b.rate}; }
Dual operator-(Dual a) { return {-a.value, -a.rate}; }
Dual sine(Dual a) { return {std::sin(a.value), std::cos(a.value) * a.rate}; }
Dual cosine(Dual a) { return {std::cos(a.value), -std::sin(a.value) * a.rate}; }

double or_zero(double value) { return std::isfinite(value) ? value : 0.0; }
Dual or_zero(double value, double rate) { return {or_zero(value), or_zero(rate)}; }

// Angular velocity of the wheelset, track axes: roll about x, yaw about the z axis that the roll
// turned, pitch about the axle.
void angular_velocity(const rp_input &input, const rp_input &rate, Dual (&w)[3]) {
  const Dual roll{input.roll, rate.roll}, yaw{input.yaw, rate.yaw};
  const Dual yaw_rate{input.yaw_rate, rate.yaw_rate}, pitch{input.pitch_rate, rate.pitch_rate};
  w[0] = Dual{input.roll_rate, rate.roll_rate} + -(pitch * sine(yaw));
  w[1] = pitch * (cosine(roll) * cosine(yaw)) + -(yaw_rate * sine(roll));
  w[2] = pitch * (sine(roll) * cosine(yaw)) + yaw_rate * cosine(roll);
}

Dual power_of(const double (&force)[3], const double (&moment)[3], const double (&force_rate)[3],
              const double (&moment_rate)[3], const rp_input &input, const rp_input &rate) {
  const Dual velocity[3] = {{input.speed, rate.speed}, {input.vy, rate.vy}, {input.vz, rate.vz}};
  Dual angular[3];
  angular_velocity(input, rate, angular);
  Dual power{0, 0};
  for (size_t k = 0; k < 3; ++k)
    power = power + or_zero(force[k], force_rate[k]) * velocity[k] +
            or_zero(moment[k], moment_rate[k]) * angular[k];
  return power;
}

// Of the warmer body.
double bulk_of(const rp_input &of, const rp_input &input) {
  const double *bulk = input.bulk_temperature;
  return of.bulk_temperature[bulk[1] > bulk[0] ? 1 : 0];
}

// Where there is no contact the core knows no temperature.
void fill_temperatures(rp_result &result, double rest) {
  for (auto &side : result.side)
    for (auto &patch : side.patch)
      if (std::isnan(patch.max_temperature)) patch.max_temperature = rest;
}

// Adds a wheel's patches, and the alternatives that count in its force.
void add_patches(const rp_side_result &side, const rp_side_result &rate, Sums &sums, Sums &rates) {
  for (int i = 0; i < side.patch_count + side.alternative_count; ++i) {
    const rp_patch_result &p = side.patch[i], &d = rate.patch[i];
    const Dual share = or_zero(p.share, d.share);
    const Dual friction = share * or_zero(p.friction_power, d.friction_power);
    const Dual energy = share * or_zero(p.elastic_energy, d.elastic_energy);
    sums.friction_power += friction.value;
    rates.friction_power += friction.rate;
    sums.elastic_energy += energy.value;
    rates.elastic_energy += energy.rate;
    const Dual plastic = share * or_zero(p.plastic_power, d.plastic_power);
    sums.plastic_power += plastic.value;
    rates.plastic_power += plastic.rate;
    sums.residual = std::max(sums.residual, or_zero(p.residual));
    if (p.max_temperature > sums.max_temperature) {
      sums.max_temperature = p.max_temperature;
      rates.max_temperature = or_zero(d.max_temperature);
    }
  }
}

void add_wrench(const double (&force)[3], const double (&moment)[3], const double (&force_rate)[3],
                const double (&moment_rate)[3], const rp_input &input, const rp_input &direction,
                Sums &sums, Sums &rates) {
  const Dual power = power_of(force, moment, force_rate, moment_rate, input, direction);
  sums.power = power.value;
  rates.power = power.rate;
  std::copy(std::begin(force), std::end(force), sums.mean_force);
  std::copy(std::begin(moment), std::end(moment), sums.mean_moment);
  std::copy(std::begin(force_rate), std::end(force_rate), rates.mean_force);
  std::copy(std::begin(moment_rate), std::end(moment_rate), rates.mean_moment);
}

void sums_of(const rp_result &result, const rp_result &rate, const rp_input &input,
             const rp_input &direction, Sums (&sums)[3], Sums (&rates)[3]) {
  for (int k = 0; k < 3; ++k) {
    sums[k] = rates[k] = {};
    sums[k].max_temperature = bulk_of(input, input);
    rates[k].max_temperature = bulk_of(direction, input);
  }
  for (int s = 0; s < 2; ++s) {
    const rp_side_result &side = result.side[s], &change = rate.side[s];
    add_patches(side, change, sums[s], rates[s]);
    add_patches(side, change, sums[2], rates[2]);
    add_wrench(side.force, side.moment, change.force, change.moment, input, direction, sums[s],
               rates[s]);
  }
  add_wrench(result.force, result.moment, rate.force, rate.moment, input, direction, sums[2],
             rates[2]);
}

}  // namespace

void add_sums(Outputs &outputs, const rp_input &input) {
  outputs.rest_temperature = or_zero(bulk_of(input, input));
  fill_temperatures(outputs.result, outputs.rest_temperature);
  const rp_input still = {};
  Sums rates[3];
  // rates of nothing: the result stands in, so that no second one is made
  sums_of(outputs.result, outputs.result, input, still, outputs.sums, rates);
}

void add_sum_rates(const Outputs &outputs, const rp_input &input, const rp_input &direction,
                   Outputs &change) {
  change.rest_temperature = or_zero(bulk_of(direction, input));
  fill_temperatures(change.result, change.rest_temperature);
  Sums sums[3];
  sums_of(outputs.result, change.result, input, direction, sums, change.sums);
}

}  // namespace railpatch::fmu
