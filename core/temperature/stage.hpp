// Temperature as a stage of a patch: which of the parts below a scene has, their memory, and the
// order of their steps within the patch's.
#pragma once

#include <optional>

#include "temperature/columns.hpp"
#include "temperature/loop.hpp"

namespace railpatch {

struct heat_scene {
  thermal_pair bodies;
  bool exchanges = false;       // bulk temperatures may be unequal
  bool by_temperature = false;  // friction follows the law
  temperature_law law;
  double depth = 0;             // m, of the temperatures given
  double plastic_fraction = 0;  // of the plastic work, that heats the surfaces
  bool transient = false;
};

// What one patch remembers; [ny][nx] of its grid but for the columns.
struct heat_memory {
  heat_memory() = default;
  heat_memory(int max_nx, int max_ny, const heat_scene &scene);
  aligned_buffer<double> temperature[2];  // degrees C, wheel and rail
  aligned_buffer<double> friction;        // -, of a law of temperature
  aligned_buffer<double> columns;         // transient: the state of heat_columns
  double conductance = 0;                 // W/K, between the bodies at the last step
  void clear();
  void forget_friction();  // it starts at the law of what is there without friction's heat
  size_t bytes() const { return 2 * temperature[0].bytes() + friction.bytes() + columns.bytes(); }
};

class temperature_stage {
 public:
  temperature_stage(const heat_scene &scene, int max_nx, int max_ny);

  void set_bulk(int body, double temperature) { scene_.bodies.body[body].bulk = temperature; }
  bool feeds_back() const { return scene_.by_temperature; }
  // Before the tangential problem: what the surfaces have without this step's heat. distance (m)
  // counts in transient rolling only. The memory's friction is the start.
  void begin(const heat_rows &rows, double distance, const double *pressure, heat_memory &memory);
  // Heat of a tangential solution: W/m^2, [ny][nx], from friction's work (N/m^2 over the way
  // rolled) and plastic work (W/m^2, or null).
  void heat(const double *friction, const double *plastic, double *q) const;
  // Finds the memory's friction; see temperature_loop.
  template <class Tangential>
  temperature_loop_result solve(const double *pressure, const temperature_loop_options &options,
                                heat_memory &memory, Tangential &&tangential) {
    return loop_->solve(
        {scene_.law, rows_, &kernel(), scene_.bodies.effusivity(), background_.data(), pressure},
        options, memory.friction.data(), flux_.data(), tangential);
  }
  // After it: fields of temperature, and in transient rolling the step is taken over. Gives the
  // greatest surface temperature in contact (degrees C); without contact, of both bodies.
  double finish(const double *pressure, heat_memory &memory);
  double *flux() { return flux_.data(); }  // of the step, for finish
  // W, after finish: a body's share of the flux and what it gets from the other one, with rows dy
  // (m) apart. NaN where columns of a transient contact exchange heat.
  double heat_into(int body, double dy) const;
  // W/K, of that exchange: heat from the warmer body over the difference of bulk temperatures.
  // Steady rolling; 0 in scenes whose bodies are equally warm.
  double exchange_conductance(double dy) const;
  size_t bytes() const;

 private:
  const heat_kernel &kernel() const { return columns_ ? columns_->kernel() : steady_->kernel(); }
  const double *exchanged() const;
  int count() const { return rows_.nx * rows_.ny; }

  heat_scene scene_;
  heat_rows rows_;
  std::optional<steady_temperature> steady_;
  std::optional<heat_columns> columns_;
  std::optional<temperature_loop> loop_;
  aligned_buffer<double> flux_, rise_, background_, exchanged_;
};

}  // namespace railpatch
