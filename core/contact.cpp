#include "contact.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "force_search.hpp"

namespace railpatch {

namespace {

constexpr int max_searches = 60;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct capacity {
  int nx, ny;
};

// Elements of one patch's grid, with a border of one element that stays free of contact.
capacity grid_capacity(const rp_config &c) {
  capacity size{c.max_elements[0], c.max_elements[1]};
  const bool sized = c.element_size[0] > 0;
  if (c.kind == RP_PATCH && c.geometry == RP_UNDEFORMED_DISTANCE)
    return {c.distance_shape[0], c.distance_shape[1]};
  for (int k = 0; k < 2; ++k) {
    int &n = k == 0 ? size.nx : size.ny;
    const bool line = k == 1 && c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT;
    if (line)
      n = 1;
    else if (!sized)
      n = c.elements[k] + 2;
    else if (c.kind == RP_PATCH && c.geometry == RP_SEMI_AXES)
      n = static_cast<int>(std::min(2000.0, std::ceil(2.0 * c.semi_axes[k] / c.element_size[k]))) +
          3;
    else if (n == 0)
      // wheel on rail: overlaps up to 60 mm long and 50 mm wide; else a square of 128
      n = c.kind == RP_PATCH
              ? 130
              : static_cast<int>(std::clamp(std::ceil((k == 0 ? 0.060 : 0.050) / c.element_size[k]),
                                            16.0, 400.0));
  }
  return size;
}

// Transform sizes up to a capacity, each about a fifth larger than the one before.
std::vector<int> ladder(int smallest, int largest) {
  std::vector<int> sizes{smooth_size(smallest)};
  while (sizes.back() < largest)
    sizes.push_back(
        std::min(smooth_size(sizes.back() + sizes.back() / 5 + 1), smooth_size(largest)));
  return sizes;
}

fft_plans make_plans(const rp_config &c) {
  const capacity size = grid_capacity(c);
  const int nx = 2 * size.nx + 1, ny = size.ny > 1 ? 2 * size.ny - 1 : 1;
  const bool fixed = c.kind == RP_PATCH && !(c.geometry == RP_CURVATURES && c.element_size[0] > 0);
  const auto top = [](int n) { return n > 1 ? smooth_size(n) : 1; };
  if (fixed) return fft_plans({top(nx)}, {top(ny)});
  return fft_plans(ladder(std::min(nx, 16), nx), ladder(std::min(ny, 16), ny));
}

patch_scene make_scene(const rp_config &c) {
  patch_scene scene;
  scene.elastic = combine(c.shear_modulus, c.poisson_ratio);
  scene.friction_coefficient = c.friction_coefficient;
  if (c.layer_thickness > 0) scene.layer_flexibility = c.layer_thickness / c.layer_shear_modulus;
  if (c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT) scene.line_width = c.width;
  scene.normal = c.normal;
  scene.tangential = c.regime == RP_REGIME_NONE ? RP_TANGENTIAL_NONE : c.tangential;
  scene.tolerance = scene.normal_tolerance = c.tolerance;
  // the search for z sees the force change only where each force is known better than it asks for
  if (c.kind != RP_PATCH && c.load == RP_FORCE)
    scene.normal_tolerance = std::max(0.1 * c.tolerance, 1e-12);
  scene.max_iterations = c.max_iterations;
  scene.spin_offset = c.spin_offset == RP_SPIN_OFFSET_SIXTH;
  return scene;
}

hertz_contact hertz_of(const rp_config &c, const patch_scene &scene, const rp_input &in) {
  const double modulus = scene.modulus();
  const bool force = c.load == RP_FORCE;
  switch (c.geometry) {
    case RP_SEMI_AXES:
      return force ? hertz_from_ellipse(c.semi_axes, modulus, in.normal_force)
                   : hertz_ellipse_from_approach(c.semi_axes, modulus, in.approach);
    case RP_CURVATURES:
      return force ? hertz_from_force(c.curvatures, modulus, in.normal_force)
                   : hertz_from_approach(c.curvatures, modulus, in.approach);
    case RP_LINE_CONTACT:
      return hertz_line(c.line_contact_radius, c.width, modulus, in.normal_force);
    case RP_UNDEFORMED_DISTANCE:
      break;
  }
  return {};
}

// Grid over the ellipse's bounding box, centred, with one free element around it.
grid hertz_grid(const rp_config &c, const hertz_contact &hertz) {
  grid g;
  const bool line = c.geometry == RP_LINE_CONTACT;
  const auto cells = [&](int k, double &size) {
    const double length = 2.0 * hertz.semi_axes[k];
    if (c.element_size[0] > 0) {
      size = c.element_size[k];
      return static_cast<int>(std::min(1e6, std::ceil(length / size - 1e-9))) + 2;
    }
    size = length / c.elements[k];
    return c.elements[k] + 2;
  };
  g.nx = cells(0, g.dx);
  g.ny = line ? 1 : cells(1, g.dy);
  if (line) g.dy = c.width;
  g.x0 = -0.5 * (g.nx - 1) * g.dx;
  g.y0 = -0.5 * (g.ny - 1) * g.dy;
  return g;
}

}  // namespace

contact::contact(const rp_config &config)
    : config_(config),
      plans_(make_plans(config)),
      solver_(make_scene(config), plans_, grid_capacity(config).nx, grid_capacity(config).ny,
              config.observer, config.observer_user) {
  const capacity size = grid_capacity(config);
  const bool tangential = solver_.scene().tangential != RP_TANGENTIAL_NONE;
  if (config.kind == RP_PATCH) {
    memory_.emplace_back(size.nx * size.ny, tangential);
    if (config.geometry == RP_UNDEFORMED_DISTANCE) {
      shape_ = aligned_buffer<double>(static_cast<size_t>(size.nx * size.ny));
      std::copy_n(config.undeformed_distance, shape_.size(), shape_.data());
    }
  } else {
    for (int side = 0; side < 2; ++side) {
      if (!has_side(side)) continue;
      wheels_.emplace_back(config, side);
      for (int i = 0; i < config.max_patches; ++i)
        memory_.emplace_back(size.nx * size.ny, tangential);
    }
  }
  // nothing of the caller's memory is kept
  config_.undeformed_distance = nullptr;
  for (auto *p : {&config_.wheel[0], &config_.wheel[1], &config_.rail[0], &config_.rail[1]})
    *p = rp_profile{};
}

bool contact::has_side(int side) const {
  if (config_.kind == RP_PATCH) return side == RP_RIGHT;
  return config_.kind == RP_WHEELSET || side == config_.side;
}

// Memory of a patch; the sides in use follow each other.
patch_memory &contact::memory(int side, int patch) {
  const int before = side == RP_RIGHT && config_.kind == RP_WHEELSET ? config_.max_patches : 0;
  return memory_[static_cast<size_t>(before + patch)];
}
const patch_memory &contact::memory(int side, int patch) const {
  return const_cast<contact *>(this)->memory(side, patch);
}

void contact::step(const rp_input &input, rp_result &result) {
  rp_result out{};
  out.z = nan;
  for (auto &side : out.side) {
    side.status = RP_NO_CONTACT;
    side.rolling_radius = nan;
    for (auto &patch : side.patch) patch = empty_patch_result();
  }
  for (auto &m : memory_) m.solved = false;
  config_.kind == RP_PATCH ? step_patch(input, out) : step_wheels(input, out);
  result = out;
}

void contact::step_patch(const rp_input &in, rp_result &out) {
  rp_side_result &side = out.side[RP_RIGHT];
  rp_patch_result &result = side.patch[0];
  side.patch_count = 1;
  for (double *v : {&out.force[0], &out.force[1], &out.force[2], &out.moment[0], &out.moment[1],
                    &out.moment[2]})
    *v = nan;
  const auto finish = [&](rp_status status) { out.status = side.status = result.status = status; };
  result.rolling_speed = in.rolling_speed;
  if (config_.load == RP_POSITION && config_.geometry != RP_UNDEFORMED_DISTANCE &&
      in.approach <= 0) {
    result.approach = in.approach;
    result.normal_force = result.max_pressure = result.contact_area = 0;
    return finish(RP_NO_CONTACT);
  }
  patch_problem problem;
  problem.hertz = hertz_of(config_, solver_.scene(), in);
  if (config_.geometry == RP_UNDEFORMED_DISTANCE) {
    grid &g = problem.g;
    g = {config_.distance_shape[0],
         config_.distance_shape[1],
         config_.element_size[0],
         config_.element_size[1],
         0,
         0};
    g.x0 = -0.5 * (g.nx - 1) * g.dx;
    g.y0 = -0.5 * (g.ny - 1) * g.dy;
  } else {
    problem.g = hertz_grid(config_, problem.hertz);
  }
  if (!solver_.fits(problem.g)) return finish(RP_OUT_OF_RANGE);
  problem.force_given = config_.load == RP_FORCE;
  problem.force = in.normal_force;
  problem.approach = in.approach;
  const bool rolling = solver_.scene().tangential != RP_TANGENTIAL_NONE;
  if (rolling) {
    problem.rolling_speed = in.rolling_speed;
    problem.rolling = {{in.creepage[0], in.creepage[1]}, in.spin_creepage, in.direction, 0.0};
    result.creepage[0] = in.creepage[0];
    result.creepage[1] = in.creepage[1];
    result.spin_creepage = in.spin_creepage;
    result.direction = in.rolling_speed > 0 ? in.direction : 0;
  }
  patch_memory &m = memory(RP_RIGHT, 0);
  solver_.start_from(m, problem.g);
  const grid &g = problem.g;
  const hertz_contact &hertz = problem.hertz;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>(j * g.nx + i);
      const double x = g.x(i), y = g.y(j);
      m.undeformed_distance[at] =
          shape_.size() ? shape_[at] : hertz.curvatures[0] * x * x + hertz.curvatures[1] * y * y;
    }
  patch_wrench wrench;
  solver_.solve(problem, m, result, wrench);
  finish(result.status);
}

void contact::step_wheels(const rp_input &in, rp_result &out) {
  const auto evaluate = [&](double z) {
    double vertical = 0;
    rp_status status = RP_NO_CONTACT;
    for (auto &wheel : wheels_) {
      rp_side_result &side = out.side[wheel.side()];
      wheel.move_to(z);
      wheel.evaluate(solver_, &memory(wheel.side(), 0), side);
      vertical -= side.force[2];
      status = combine_status(status, side.status);
    }
    ++out.evaluations;
    out.status = status;
    return vertical;
  };
  solver_.observe(RP_STAGE_GEOMETRY, true);
  for (auto &wheel : wheels_) wheel.place(in);
  solver_.observe(RP_STAGE_GEOMETRY, false);
  if (config_.load == RP_POSITION) {
    out.z = in.z;
    evaluate(in.z);
  } else {
    find_z(in.vertical_force, evaluate, out);
  }
  for (auto &wheel : wheels_)
    for (int k = 0; k < 3; ++k) {
      out.force[k] += out.side[wheel.side()].force[k];
      out.moment[k] += out.side[wheel.side()].moment[k];
    }
}

// Finds z for a prescribed vertical force; `evaluate(z)` solves all wheels and returns their force.
template <class Evaluate>
void contact::find_z(double target, Evaluate &&evaluate, rp_result &out) {
  double touch = HUGE_VAL;
  for (const auto &wheel : wheels_) {
    double z = 0;
    if (wheel.first_touch(z)) touch = std::min(touch, z);
  }
  if (touch == HUGE_VAL) {
    evaluate(0.0);
    out.z = nan;
    out.status = RP_OUT_OF_RANGE;
    return;
  }
  double depth = depth_;
  if (!(depth > 0)) {
    // a ball on a plane with the load of one wheel and a typical combined radius
    const double load = target / static_cast<double>(wheels_.size());
    const double modulus = solver_.scene().modulus(), radius = 0.5 * config_.nominal_radius;
    depth = std::cbrt(9.0 * load * load / (16.0 * modulus * modulus * radius));
  }
  force_search search(target, depth, config_.tolerance);
  for (int i = 0; i < max_searches; ++i) {
    depth = search.depth();
    const double force = evaluate(touch + depth);
    search.report(force, out.status == RP_OUT_OF_RANGE);
    if (search.converged() || search.exhausted()) break;
  }
  out.z = touch + depth;
  for (auto &side : out.side)
    for (int i = 0; i < side.patch_count; ++i)
      side.patch[i].residual = std::max(side.patch[i].residual, search.residual());
  if (search.too_deep())
    out.status = RP_OUT_OF_RANGE;
  else if (!search.converged() && out.status != RP_OUT_OF_RANGE)
    out.status = RP_NOT_CONVERGED;
  depth_ = search.converged() ? depth : 0.0;
}

void contact::reset() {
  for (auto &m : memory_) m.warm = m.solved = false;
  depth_ = 0;
}

// --- state -------------------------------------------------------------------------------------

namespace {

constexpr uint32_t state_magic = 0x52505331;  // "RPS1"

struct state_header {
  uint32_t magic, kind;
  uint64_t bytes, checksum;
  // the checksum covers all that follows
  uint64_t scene;
  double depth, friction_coefficient;
};
constexpr size_t checked_from = offsetof(state_header, scene);
struct patch_header {
  grid g;
  vec3 reference;
  uint64_t warm;
};

// FNV-1a (Fowler, Noll, Vo 1991)
uint64_t checksum(const unsigned char *data, size_t size) {
  uint64_t hash = 14695981039346656037ull;
  for (size_t i = 0; i < size; ++i) hash = (hash ^ data[i]) * 1099511628211ull;
  return hash;
}

// Tells the states of one config from those of another; shapes and profiles are left out.
uint64_t fingerprint(const rp_config &c) {
  const double values[] = {static_cast<double>(c.geometry),
                           static_cast<double>(c.load),
                           static_cast<double>(c.regime),
                           static_cast<double>(c.normal),
                           static_cast<double>(c.tangential),
                           static_cast<double>(c.spin_offset),
                           static_cast<double>(c.track),
                           static_cast<double>(c.side),
                           static_cast<double>(c.elements[0]),
                           static_cast<double>(c.elements[1]),
                           static_cast<double>(c.max_elements[0]),
                           static_cast<double>(c.max_elements[1]),
                           static_cast<double>(c.max_iterations),
                           static_cast<double>(c.max_patches),
                           c.element_size[0],
                           c.element_size[1],
                           c.shear_modulus[0],
                           c.shear_modulus[1],
                           c.poisson_ratio[0],
                           c.poisson_ratio[1],
                           c.semi_axes[0],
                           c.semi_axes[1],
                           c.curvatures[0],
                           c.curvatures[1],
                           c.line_contact_radius,
                           c.width,
                           c.friction_coefficient,
                           c.layer_shear_modulus,
                           c.layer_thickness,
                           c.tolerance,
                           c.nominal_radius,
                           c.flange_back_distance,
                           c.flange_back_position,
                           c.gauge,
                           c.gauge_height,
                           c.cant,
                           c.curvature,
                           c.roller_radius};
  unsigned char bytes[sizeof values];
  std::memcpy(bytes, values, sizeof values);
  return checksum(bytes, sizeof bytes);
}

// the fields that a later step starts from
template <class Memory, class F>
void for_each_start_field(Memory &m, F &&f) {
  const auto bytes = static_cast<size_t>(m.g.count()) * sizeof(double);
  if (!m.warm) return;
  f(m.pressure.data(), bytes);
  if (m.px.size() == 0) return;
  f(m.px.data(), bytes);
  f(m.py.data(), bytes);
}

}  // namespace

size_t contact::state_size() const {
  size_t size = sizeof(state_header) + memory_.size() * sizeof(patch_header);
  for (const auto &m : memory_)
    for_each_start_field(m, [&](const double *, size_t bytes) { size += bytes; });
  return size;
}

void contact::save_state(unsigned char *buffer) const {
  unsigned char *at = buffer + sizeof(state_header);
  const auto put = [&](const void *data, size_t size) {
    std::memcpy(at, data, size);
    at += size;
  };
  for (const auto &m : memory_) {
    const patch_header header{m.g, m.reference, m.warm ? 1u : 0u};
    put(&header, sizeof header);
    for_each_start_field(m, put);
  }
  const auto bytes = static_cast<size_t>(at - buffer);
  state_header header{
      state_magic, static_cast<uint32_t>(config_.kind), bytes, 0, fingerprint(config_),
      depth_,      solver_.scene().friction_coefficient};
  std::memcpy(buffer, &header, sizeof header);
  header.checksum = checksum(buffer + checked_from, bytes - checked_from);
  std::memcpy(buffer, &header, sizeof header);
}

bool contact::restore_state(const unsigned char *buffer, size_t size) {
  state_header header;
  if (size < sizeof header) return false;
  std::memcpy(&header, buffer, sizeof header);
  const bool ours = header.magic == state_magic &&
                    header.kind == static_cast<uint32_t>(config_.kind) && header.bytes == size &&
                    header.scene == fingerprint(config_) &&
                    header.checksum == checksum(buffer + checked_from, size - checked_from);
  if (!ours || !state_fits(buffer + sizeof header, size - sizeof header)) return false;
  const unsigned char *at = buffer + sizeof header;
  for (auto &m : memory_) {
    patch_header patch;
    std::memcpy(&patch, at, sizeof patch);
    at += sizeof patch;
    m.g = patch.g;
    m.reference = patch.reference;
    m.warm = patch.warm != 0;
    m.solved = false;
    for_each_start_field(m, [&](double *data, size_t bytes) {
      std::memcpy(data, at, bytes);
      at += bytes;
    });
  }
  depth_ = header.depth;
  solver_.set_friction_coefficient(header.friction_coefficient);
  return true;
}

// Walks the patches without changing anything: every grid must fit this handle's memory.
bool contact::state_fits(const unsigned char *at, size_t size) const {
  for (const auto &m : memory_) {
    patch_header patch;
    if (size < sizeof patch) return false;
    std::memcpy(&patch, at, sizeof patch);
    const bool fits = patch.g.nx >= 0 && patch.g.ny >= 0 && solver_.fits(patch.g);
    if (!fits) return false;
    const size_t fields = patch.warm ? (m.px.size() ? 3 : 1) : 0;
    const size_t bytes =
        sizeof patch + fields * static_cast<size_t>(patch.g.count()) * sizeof(double);
    if (size < bytes) return false;
    at += bytes;
    size -= bytes;
  }
  return size == 0;
}

// --- fields and stages -------------------------------------------------------------------------

rp_error contact::field(int side, int patch, rp_field name, double *values, size_t *count) const {
  const int patches = config_.kind == RP_PATCH ? 1 : config_.max_patches;
  if ((side != RP_LEFT && side != RP_RIGHT) || !has_side(side) || patch < 0 || patch >= patches)
    return RP_ERROR_NO_FIELD;
  const patch_memory &m = memory(side, patch);
  const bool of_tangential =
      name == RP_FIELD_TRACTION || name == RP_FIELD_MICRO_SLIP || name == RP_FIELD_ELEMENT_DIVISION;
  if (!m.solved || (of_tangential && m.px.size() == 0)) return RP_ERROR_NO_FIELD;
  const bool of_axis = name == RP_FIELD_X || name == RP_FIELD_Y;
  const bool of_vectors = name == RP_FIELD_TRACTION || name == RP_FIELD_MICRO_SLIP;
  const auto plane = static_cast<size_t>(m.g.count());
  const size_t needed = of_axis ? static_cast<size_t>(name == RP_FIELD_X ? m.g.nx : m.g.ny)
                                : (of_vectors ? 2 * plane : plane);
  const size_t capacity = *count;
  *count = needed;
  if (capacity < needed || !values) return RP_ERROR_SIZE;
  // a left wheel is solved as its mirror image: rows in reverse, lateral components negative
  const bool left = config_.kind != RP_PATCH && side == RP_LEFT;
  const auto copy = [&](auto &&source, double *out, double sign) {
    for (int j = 0; j < m.g.ny; ++j)
      for (int i = 0; i < m.g.nx; ++i)
        out[j * m.g.nx + i] =
            sign * source[static_cast<size_t>((left ? m.g.ny - 1 - j : j) * m.g.nx + i)];
  };
  const double lateral = left ? -1.0 : 1.0;
  switch (name) {
    case RP_FIELD_X:
      for (int i = 0; i < m.g.nx; ++i) values[i] = m.g.x(i);
      break;
    case RP_FIELD_Y:
      for (int j = 0; j < m.g.ny; ++j) values[j] = left ? -m.g.y(m.g.ny - 1 - j) : m.g.y(j);
      break;
    case RP_FIELD_UNDEFORMED_DISTANCE:
      copy(m.undeformed_distance, values, 1.0);
      break;
    case RP_FIELD_PRESSURE:
      copy(m.pressure, values, 1.0);
      break;
    case RP_FIELD_TRACTION:
      copy(m.px, values, 1.0);
      copy(m.py, values + plane, lateral);
      break;
    case RP_FIELD_MICRO_SLIP:
      copy(m.sx, values, 1.0);
      copy(m.sy, values + plane, lateral);
      break;
    case RP_FIELD_ELEMENT_DIVISION:
      copy(m.division, values, 1.0);
      break;
    default:
      return RP_ERROR_NO_FIELD;
  }
  return RP_OK;
}

void contact::describe(rp_stage_info *info) const {
  const patch_scene &scene = solver_.scene();
  const bool tangential = scene.tangential != RP_TANGENTIAL_NONE;
  const bool wheels = config_.kind != RP_PATCH;
  size_t distance = 0, normal = 0, traction = 0;
  for (const auto &m : memory_) {
    distance += m.undeformed_distance.bytes();
    normal += m.pressure.bytes();
    traction += 4 * m.px.bytes() + m.division.bytes();
  }
  for (const auto &wheel : wheels_) distance += wheel.bytes();
  info[RP_STAGE_GEOMETRY] = {"geometry", 1,
                             wheels ? "kind is wheel_rail or wheelset: placement and contact search"
                                    : "undeformed distance of the given shape",
                             distance};
  const size_t influence = solver_.influence_bytes();
  info[RP_STAGE_INFLUENCE] = {"influence", influence > 0,
                              influence > 0 ? "a method on the half-space is asked for"
                                            : "neither normal nor tangential method needs it",
                              influence};
  info[RP_STAGE_NORMAL] = {"normal", 1,
                           scene.normal == RP_NORMAL_HERTZ
                               ? "normal = hertz: closed form"
                               : "normal = half_space: conjugate gradients",
                           normal + solver_.normal_bytes()};
  const char *why = "tangential = full: semi-smooth Newton";
  if (config_.regime == RP_REGIME_NONE)
    why = "regime = none";
  else if (!tangential)
    why = "tangential = none";
  else if (scene.tangential == RP_TANGENTIAL_FASTSIM)
    why = "tangential = fastsim: simplified theory";
  info[RP_STAGE_TANGENTIAL] = {"tangential", tangential, why,
                               tangential ? traction + solver_.tangential_bytes() : 0};
  info[RP_STAGE_FORCES] = {"forces", 1, "resultants of pressure and traction", 0};
}

}  // namespace railpatch
