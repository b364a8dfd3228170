#include "patch/patch_memory.hpp"

#include <algorithm>

namespace railpatch {

patch_memory::patch_memory(int max_count, int max_rows, const patch_scene &scene) {
  const auto n = static_cast<size_t>(max_count);
  undeformed_distance = aligned_buffer<double>(n);
  if (!scene.closed_form()) pressure = aligned_buffer<double>(n);
  if (scene.has_strips() || scene.has_ehl()) fluid_pressure = aligned_buffer<double>(n);
  if (scene.has_ehl()) {
    fluid_film = aligned_buffer<double>(n);
    if (scene.fluid->eyring_stress > 0) fluid_shear = aligned_buffer<double>(n);
  }
  if (scene.curved) curved.emplace(max_rows);
  if (scene.local_normals) {
    const int each = scene.slopes_along_rows && !scene.closed_form() ? max_count : max_rows;
    slope_fields = aligned_buffer<double>(3 * static_cast<size_t>(each));
    double *at = slope_fields.data();
    slopes = {at, at + each, at + 2 * each};
  }
  if (!has_tractions(scene.tangential)) return;
  if (scene.friction_variation.varies())
    row_friction = aligned_buffer<double>(static_cast<size_t>(max_rows));
  const size_t count =
      scene.is_fitted() ? static_cast<size_t>(scene.fitted[0] * scene.fitted[1]) : n;
  for (auto *b : {&px, &py, &sx, &sy}) *b = aligned_buffer<double>(count);
  division = aligned_buffer<unsigned char>(count);
  if (scene.is_forced()) creepage = aligned_buffer<double>(2);
  history = patch_history(max_count, scene.keeps_steps(), scene.moves,
                          scene.law ? &*scene.law : nullptr, scene.curved ? max_rows : 0);
  if (scene.heat) heat.emplace(max_count / std::max(max_rows, 1), max_rows, *scene.heat);
  if (!scene.is_fitted()) return;
  node_x = aligned_buffer<double>(count);
  node_y = aligned_buffer<double>(static_cast<size_t>(scene.fitted[1]));
  node_height = aligned_buffer<double>(node_y.size());
  node_pressure = aligned_buffer<double>(count);
}

size_t patch_memory::bytes() const {
  return undeformed_distance.bytes() + pressure.bytes() + 4 * px.bytes() + division.bytes() +
         2 * node_x.bytes() + 2 * node_y.bytes() + row_friction.bytes() + creepage.bytes() +
         fluid_pressure.bytes() + fluid_film.bytes() + fluid_shear.bytes() + slope_fields.bytes() +
         history.bytes() + (curved ? curved->bytes() : 0);
}

void patch_memory::unload(const grid &on, const bound_law *law) {
  for (auto *field : {&pressure, &fluid_pressure, &fluid_film, &fluid_shear})
    if (field->size()) std::fill_n(field->data(), on.count(), 0.0);
  const int n = columns() * rows();
  for (auto *field : {&px, &py, &sx, &sy, &node_pressure})
    if (field->size()) std::fill_n(field->data(), n, 0.0);
  if (division.size()) std::fill_n(division.data(), n, static_cast<unsigned char>(RP_EXTERIOR));
  if (history.energy.size()) std::fill_n(history.energy.data(), on.count(), 0.0);
  if (history.has_law()) history.start_from_before(on, *law, history.keeps_steps());
}

}  // namespace railpatch
