// Fields of the last step's patches, as rp_get_field gives them.
#include <algorithm>
#include <cmath>

#include "handle/contact.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

rp_error error_features_of(const patch_memory &m, double *values, size_t *count) {
  if (!m.solved || !m.estimated) return RP_ERROR_NO_FIELD;
  const size_t capacity = *count;
  *count = m.error_features.size();
  if (capacity < m.error_features.size() || !values) return RP_ERROR_SIZE;
  std::copy(m.error_features.begin(), m.error_features.end(), values);
  return RP_OK;
}

// What the yield stress depends on, element by element.
struct plastic_path {
  const patch_history &history;
  double operator[](size_t at) const {
    const double *u = history.after[at].v + 1;
    return hypot(u[0], u[1]);
  }
};

// The coefficient of a law of temperature with the factor of each row.
struct friction_of_heat {
  const patch_memory &m;
  double scale;
  double operator[](size_t i) const {
    const double mu = scale * m.heat->friction[i];
    return m.row_friction.size() > 0 ? mu * m.row_friction[i / static_cast<size_t>(m.g.nx)] : mu;
  }
};

// Of each element in contact, else 0.
struct share_of_asperities {
  const patch_memory &m;
  double operator[](size_t i) const {
    return m.pressure[i] > 0 ? 1.0 - m.fluid_pressure[i] / m.pressure[i] : 0.0;
  }
};
struct film_between {
  const patch_memory &m;
  const patch_scene &scene;
  double operator[](size_t i) const {
    if (scene.has_ehl()) return m.fluid_film[i];
    if (!(m.pressure[i] > 0)) return 0.0;
    const strip_liquid liquid{0, 0, scene.fluid->roughness, scene.fluid->hardness};
    return liquid.film(m.pressure[i] - m.fluid_pressure[i]);
  }
};

// Whether a field belongs to laws beyond Coulomb's, and this patch has none such.
bool lacks_law(const patch_memory &m, rp_field name) {
  if (name == RP_FIELD_FRICTION)
    return m.history.friction.size() == 0 && !(m.heat && m.heat->friction.size() > 0);
  const bool plastic = name == RP_FIELD_PLASTIC_DISPLACEMENT || name == RP_FIELD_PLASTIC_PATH ||
                       name == RP_FIELD_YIELD_STRESS;
  return plastic && m.history.yield_stress.size() == 0;
}

// Whether the solution that a patch remembers has the field.
bool has_field(const patch_memory &m, rp_field name) {
  if (!m.solved || m.columns() * m.rows() == 0 || lacks_law(m, name)) return false;
  switch (name) {
    case RP_FIELD_TRACTION:
    case RP_FIELD_MICRO_SLIP:
    case RP_FIELD_ELEMENT_DIVISION:
      return m.px.size() > 0;
    case RP_FIELD_PRESSURE:
      return m.pressure.size() + m.node_pressure.size() > 0;
    case RP_FIELD_TEMPERATURE:
      return static_cast<bool>(m.heat);
    case RP_FIELD_FLUID_PRESSURE:
    case RP_FIELD_FILM_THICKNESS:
    case RP_FIELD_ASPERITY_SHARE:
      return m.fluid_pressure.size() > 0 && !m.fitted();
    case RP_FIELD_ROW_POSITION:
    case RP_FIELD_ROW_ANGLE:
      return static_cast<bool>(m.curved);
    case RP_FIELD_UNDEFORMED_DISTANCE:
      return !m.fitted();
    default:
      return true;
  }
}

size_t field_size(const patch_memory &m, rp_field name) {
  const auto nx = static_cast<size_t>(m.columns()), ny = static_cast<size_t>(m.rows());
  switch (name) {
    case RP_FIELD_X:
      return m.fitted() ? nx * ny : nx;
    case RP_FIELD_Y:
    case RP_FIELD_ROW_ANGLE:
      return ny;
    case RP_FIELD_ROW_POSITION:
      return 2 * ny;
    case RP_FIELD_TRACTION:
    case RP_FIELD_MICRO_SLIP:
    case RP_FIELD_PLASTIC_DISPLACEMENT:
    case RP_FIELD_TEMPERATURE:
      return 2 * nx * ny;
    default:
      return nx * ny;
  }
}

// Copies fields out. A left wheel is solved as its mirror image: its rows stand in reverse, its
// lateral components have the other sign.
struct field_copier {
  const patch_memory &m;
  bool left;
  double *out;

  int row(int j) const { return left ? m.rows() - 1 - j : j; }
  double lateral() const { return left ? -1.0 : 1.0; }
  double *second() const { return out + m.columns() * m.rows(); }
  template <class Source>
  void scalar(Source &&source, double *to, double sign) const {
    const int nx = m.columns(), ny = m.rows();
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        to[j * nx + i] = sign * source[static_cast<size_t>(row(j) * nx + i)];
  }
  template <class Source>
  void scalar(Source &&source) const {
    scalar(source, out, 1.0);
  }
  template <class Source>
  void vector(Source &&x, Source &&y) const {
    scalar(x, out, 1.0);
    scalar(y, second(), lateral());
  }
  template <class F>
  void of_rows(F &&f, double *to, double sign) const {
    for (int j = 0; j < m.rows(); ++j) to[j] = sign * f(row(j));
  }
};

}  // namespace

rp_error contact::field(int side, int patch, rp_field name, double *values, size_t *count) const {
  const patch_memory *found = driver_->find(side, patch);
  if (!found) return RP_ERROR_NO_FIELD;
  const patch_memory &m = *found;
  if (name == RP_FIELD_ERROR_FEATURES) return error_features_of(m, values, count);
  if (!has_field(m, name)) return RP_ERROR_NO_FIELD;
  const size_t needed = field_size(m, name), capacity = *count;
  *count = needed;
  if (capacity < needed || !values) return RP_ERROR_SIZE;
  const field_copier copy{m, driver_->mirrors(side), values};
  switch (name) {
    case RP_FIELD_X:
      if (m.fitted())
        copy.scalar(m.node_x);
      else
        for (int i = 0; i < m.columns(); ++i) values[i] = m.g.x(i);
      break;
    case RP_FIELD_Y:
      copy.of_rows([&](int j) { return m.fitted() ? m.node_y[static_cast<size_t>(j)] : m.g.y(j); },
                   values, copy.lateral());
      break;
    case RP_FIELD_UNDEFORMED_DISTANCE:
      copy.scalar(m.undeformed_distance);
      break;
    case RP_FIELD_PRESSURE:
      copy.scalar(m.fitted() ? m.node_pressure : m.pressure);
      break;
    case RP_FIELD_TRACTION:
      copy.vector(m.px, m.py);
      break;
    case RP_FIELD_MICRO_SLIP:
      copy.vector(m.sx, m.sy);
      break;
    case RP_FIELD_ELEMENT_DIVISION:
      copy.scalar(m.division);
      break;
    case RP_FIELD_TEMPERATURE:
      copy.scalar(m.heat->temperature[0]);
      copy.scalar(m.heat->temperature[1], copy.second(), 1.0);
      break;
    case RP_FIELD_FRICTION:
      if (m.history.friction.size() > 0)
        copy.scalar(m.history.friction);
      else
        copy.scalar(friction_of_heat{m, driver_->friction_scale(side)});
      break;
    case RP_FIELD_PLASTIC_DISPLACEMENT:
      copy.vector(m.history.plastic[0], m.history.plastic[1]);
      break;
    case RP_FIELD_PLASTIC_PATH:
      copy.scalar(plastic_path{m.history});
      break;
    case RP_FIELD_YIELD_STRESS:
      copy.scalar(m.history.yield_stress);
      break;
    case RP_FIELD_FLUID_PRESSURE:
      copy.scalar(m.fluid_pressure);
      break;
    case RP_FIELD_FILM_THICKNESS:
      copy.scalar(film_between{m, this->patch()});
      break;
    case RP_FIELD_ASPERITY_SHARE:
      copy.scalar(share_of_asperities{m});
      break;
    case RP_FIELD_ROW_POSITION:
      copy.of_rows([&](int j) { return m.curved->y(j); }, values, copy.lateral());
      copy.of_rows([&](int j) { return m.curved->z(j); }, values + m.rows(), 1.0);
      break;
    case RP_FIELD_ROW_ANGLE:
      copy.of_rows([&](int j) { return m.curved->angle(j); }, values, copy.lateral());
      break;
    default:
      return RP_ERROR_NO_FIELD;
  }
  return RP_OK;
}

}  // namespace railpatch
