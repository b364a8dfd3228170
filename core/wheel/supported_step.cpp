#include "numeric/nan.hpp"
#include "wheel/wheels.hpp"

// A step of wheels on rails that deflect.

namespace railpatch {

namespace {

// Moves the wheels' rails and solves their contacts for rail_support.
template <class Evaluate>
class wheels_of_step final : public supported_wheels {
 public:
  wheels_of_step(std::vector<wheel_contact> &wheels, const patch_contact &solver,
                 const rp_input &input, Evaluate &evaluate)
      : wheels_(wheels), solver_(solver), input_(input), evaluate_(evaluate) {}

  void move_rails(const lateral_vertical *deflection, const lateral_vertical *rate) override {
    rp_input moved = input_;
    for (size_t w = 0; w < wheels_.size(); ++w)
      for (size_t k = 0; k < 2; ++k) {
        const int side = wheels_[w].side();
        moved.rail_offset[side][k + 1] += deflection[w][k];
        moved.rail_velocity[side][k + 1] += rate[w][k];
      }
    const stage_mark mark = solver_.marks().enter(RP_STAGE_GEOMETRY);
    for (auto &wheel : wheels_) wheel.place(moved);
  }
  bool first_touch(int wheel, double &z) override {
    return wheels_[static_cast<size_t>(wheel)].first_touch(z);
  }
  bool evaluate(double z, wheel_on_rail *out) override { return evaluate_(z, out); }

 private:
  std::vector<wheel_contact> &wheels_;
  const patch_contact &solver_;
  const rp_input &input_;
  Evaluate &evaluate_;
};

}  // namespace

void wheels::solve_supported(const rp_input &in, rp_result &out) {
  const auto evaluate = [&](double z, supported_wheels::wheel_on_rail *found) {
    this->evaluate(z, out);
    bool known = true;
    for (size_t w = 0; w < wheels_.size(); ++w) {
      const rp_side_result &side = out.side[wheels_[w].side()];
      found[w] = {{-side.force[1], -side.force[2]}, 0};
      if (side.patch_count > 0) found[w].rolling_speed = side.patch[0].rolling_speed;
      found[w].known = !wheels_[w].beyond();
      known = known && found[w].known;
    }
    return known;
  };
  wheels_of_step moved(wheels_, solver_, in, evaluate);
  const support_load load{force_given_, in.vertical_force, in.z, in.time_step};
  const support_result found = support_->solve(moved, load);
  out.z = found.z;
  if (found.beyond) {
    if (load.prescribed) out.z = nan;
    report_search({RP_OUT_OF_RANGE, RP_REASON_RAIL_BEYOND, found.residual}, found.residual, out);
    return;
  }
  verdict ended;
  if (!found.converged) ended = {RP_NOT_CONVERGED, RP_REASON_RAIL_SEARCH, found.residual};
  report_search(ended, found.residual, out);
  for (size_t w = 0; w < wheels_.size(); ++w)
    for (size_t k = 0; k < 2; ++k) {
      rp_side_result &side = out.side[wheels_[w].side()];
      side.rail_deflection[k] = support_->deflection(static_cast<int>(w))[k];
      side.rail_deflection_rate[k] = support_->rate(static_cast<int>(w))[k];
    }
}

}  // namespace railpatch
