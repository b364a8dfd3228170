// Mixed lubrication of a whole contact: film, share of the load that asperities carry, friction.
//
// Share f of the asperities, h the central film (fluid/film.hpp), sigma the combined roughness:
//   film_ratio    f = exp(-1.8 (h/sigma)^1.2), Aihara 1987, eq. 13, there fitted below 0.4 GPa
//   load_sharing  h = film of what the liquid carries, f = p_a/p_mean, with h/sigma and p_a by
//                 fluid/asperities.hpp: one root in d
// Friction mu = mu_a f + mu_f (1 - f). mu_a is that of boundary lubrication; where the supply is
// given, of surfaces that liquid reaches: mu_a = mu_dry + (mu_b - mu_dry) (1 - exp(-h_in/sigma))
// (assumed), so that friction goes over to dry as the supply goes to 0. mu_f of oil is Eyring's:
// tau_E asinh(eta gamma/tau_E)/p, eta = eta_0 exp(alpha p), gamma slip speed over h, p the mean
// pressure, not above a limit (0.05 to 0.1; not verified).
//
// Inlet: heated by shear the film is thinner by 1/(1 + 0.1 L_t^0.64), L_t = eta beta u_m^2/k (not
// verified); starved by a factor; and with a layer h_in on the surfaces, given, or a rate of water
// spread over the width of the contact, by r/(1 + r^2)^(1/2), r = h_in/h (form after Chevalier,
// Lubrecht, Cann, Colin and Dalmaz 1998, not verified; exponent assumed).
//
// A paste that dries (assumed): of its water the part w is left, so that solids c of its volume are
// c/(c + (1 - c) w) and the viscosity rises as exp(k of them), until they are packed, c_p; from
// there on the paste is as thick as that and covers the part w/w_p of the surfaces, w_p what is
// left of the water then: mu = w/w_p mu of that paste + (1 - w/w_p) mu_dry, so that friction goes
// over to dry as w goes to 0.
#pragma once

#include "fluid/film.hpp"
#include "fluid/regimes.hpp"
#include "fluid/viscosity.hpp"
#include "numeric/nan.hpp"
#include "railpatch.h"

namespace railpatch {

// The paste of oxide; by time and work its water falls to 1/e.
struct drying_paste {
  double content = 0, exponent = 0;  // -
  double per_second = 0;             // 1/s
  double per_work = 0;               // m/J
  bool dries() const { return per_second > 0 || per_work > 0; }
  static constexpr double packed = 0.64;  // -, content: random close packing of spheres (assumed)
  // -, of the viscosity, over that of the paste as it was given. water: the part that is left
  double thicker(double water) const;
  double covers(double water) const;  // -, of the surfaces
};

struct fluid_scene {
  rp_fluid_model model = RP_FLUID_FILM;
  rp_fluid_share share = RP_SHARE_FILM_RATIO;
  double roughness = 1e-6;          // m
  double boundary_friction = 0.15;  // -
  bool own_boundary = true;         // false: the friction coefficient is that
  double hardness = 2.8e9;          // Pa
  double mean_pressure = 6e8;       // Pa, of load_sharing; 0: of the contact
  viscosity_law liquid;
  double pressure_coefficient = 5e-10;  // 1/Pa
  double inlet_conductivity = 0;        // W/(m K), > 0: heated inlet
  double starvation = 1;                // -
  double eyring_stress = 0;             // Pa, 0: the liquid has no friction
  double limiting_friction = 0.07;      // -
  water_regimes regimes;
  drying_paste paste;
};

// Of a step; NaN: not given.
struct fluid_supply {
  double water_rate = nan;   // m^3/s; not given: flooded
  double temperature = nan;  // degrees C
  double layer = nan;        // m, on the surfaces before the contact; not given: flooded
  double work = 0;           // J/m, of friction, that has cleaned wheel and rail
  double oxide_water = 1;    // -, part of the paste's water that is left
};

struct wet_contact {
  film_contact film;
  double half_width;     // m, across rolling
  double mean_pressure;  // Pa
  double slip_speed;     // m/s
  double dry_friction;   // -
};

struct film_outcome {
  double film_thickness = 0;  // m
  double share = 1;           // of asperities
  double temperature = 0;     // degrees C, of the liquid
  double friction = 0;        // -
  double shear = 0;           // -, the part of it that the liquid's own shear has
};

// -, of asperities: where a layer (m) is all that arrives, dry where no liquid reaches them.
double asperity_friction(double boundary, double dry, double layer, double roughness);

film_outcome solve_film(const fluid_scene &scene, const fluid_supply &supply, wet_contact contact);

// Rates of what is found, by those of the contact, but for the liquid's own, and of the supply: the
// sharing of the load as an implicit function. Where a limit or a supply counts it stays the one
// that does; of what is not given the rate is not read.
film_outcome film_rates(const fluid_scene &scene, const fluid_supply &supply,
                        const wet_contact &contact, const wet_contact &rate,
                        const fluid_supply &supply_rate);

}  // namespace railpatch
