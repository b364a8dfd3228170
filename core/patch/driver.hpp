// What makes the steps of a handle: a patch given directly (patch/single_patch.hpp) or wheels
// (wheel/wheels.hpp). Which one is asked once, when the handle is made.
#pragma once

#include <vector>

#include "patch/patch_contact.hpp"
#include "railpatch.h"

namespace railpatch {

struct grid_size {
  int nx = 0, ny = 0;
};

class driver {
 public:
  // largest: of a patch's grid; patches: at most
  driver(const patch_scene &scene, const fft_plans &plans, grid_size largest, stage_marks marks,
         int patches)
      : solver_(scene, plans, largest.nx, largest.ny, marks) {
    memory_.reserve(static_cast<size_t>(patches));
    for (int i = 0; i < patches; ++i)
      memory_.emplace_back(largest.nx * largest.ny, largest.ny, scene);
  }
  driver(const driver &) = delete;
  driver &operator=(const driver &) = delete;
  virtual ~driver() = default;

  // Fills a result that knows nothing yet.
  virtual void step(const rp_input &input, rp_result &result) = 0;
  virtual void reset() {}

  patch_contact &solver() { return solver_; }
  const patch_contact &solver() const { return solver_; }
  std::vector<patch_memory> &memories() { return memory_; }
  const std::vector<patch_memory> &memories() const { return memory_; }
  // Of one patch, null where there is no such.
  virtual const patch_memory *find(int side, int patch) const = 0;
  // -, of the friction law in the last step.
  virtual double friction_scale(int) const { return solver_.scene().friction_scale; }
  // Whether a side is solved as its mirror image.
  virtual bool mirrors(int) const { return false; }

  // What later steps depend on beside the patches; nothing: null.
  struct kept_numbers {
    double *depth = nullptr;  // m
    void *more = nullptr;     // plain bytes
    size_t bytes = 0;
    void *heat = nullptr;  // the same of bodies that store it
    size_t heat_bytes = 0;
    bool begins_only = false;  // `more` says where a search begins, and changes no more than that
    size_t all_bytes() const { return bytes + heat_bytes; }
    bool matter() const { return heat_bytes > 0 || (bytes > 0 && !begins_only); }
  };
  virtual kept_numbers kept() { return {}; }

  // Rates of the last step (input, result) into a change of nothing, in scenes with exact ones.
  virtual void differentiate(const rp_input &direction, const rp_input &input,
                             const rp_result &result, rp_result &change) = 0;
  // By pose and velocity, of wheels, whose height may be found by their load.
  virtual bool has_jacobian() const { return false; }
  virtual bool finds_height() const { return false; }
  // Whether nothing changes along the track or round a wheel: steps do not depend on places there.
  virtual bool uniform_along() const { return false; }
  virtual void jacobian(const rp_input &, const rp_result &, rp_jacobian &) {}

  virtual const char *geometry_reason() const = 0;
  virtual size_t geometry_bytes() const = 0;
  virtual size_t support_bytes() const { return 0; }
  virtual size_t derivative_bytes() const { return solver_.derivative_bytes(); }

 protected:
  patch_contact solver_;
  std::vector<patch_memory> memory_;
};

}  // namespace railpatch
