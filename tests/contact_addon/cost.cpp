// The same steps by the add-on's calls and by railpatch.h, for cost.py: cost addon|core STEPS
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "contact_addon.h"
#include "railpatch.h"

namespace {

constexpr int across = 20;
constexpr double size = 6e-4, low = -6e-3;

double creepage(int step) { return 1e-3 + 1e-6 * step; }

double by_addon(int steps) {
  int ire = 1, icp = 1, m = 0, four = 4, l = 0, two = 2, kind = 1, six = 6, base = 1, code = 1933,
      unit = 1935;
  double steel[] = {.28, .28, 82e9, 82e9}, mu[] = {.3, .3},
         grid[] = {across, across, low, low, size, size};
  double round[] = {1, 0, 1, 0, 0, 0}, force = 40000, speed = 10, sum = 0;
  int one = 1;
  cntc_setflags(&ire, &icp, &one, &code, &unit);
  cntc_setmaterialparameters(&ire, &icp, &m, &four, steel);
  cntc_setfrictionmethod(&ire, &icp, &l, &two, mu);
  cntc_setpotcontact(&ire, &icp, &kind, &six, grid);
  cntc_setundeformeddistc(&ire, &icp, &base, &six, round);
  cntc_setreferencevelocity(&ire, &icp, &speed);
  for (int i = 0; i < steps; ++i) {
    double vx = -creepage(i), vy = 0, phi = 0, fn, tx, ty, mz;
    int error = -1;
    cntc_setnormalforce(&ire, &icp, &force);
    cntc_setcreepages(&ire, &icp, &vx, &vy, &phi);
    cntc_calculate(&ire, &icp, &error);
    cntc_getcontactforces(&ire, &icp, &fn, &tx, &ty, &mz);
    if (error != 0) std::exit(1);
    sum += tx;
  }
  return sum;
}

double by_core(int steps) {
  rp_config config;
  rp_default_config(&config);
  std::vector<double> h;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i) {
      const double x = low + 0.5 * size + i * size, y = low + 0.5 * size + j * size;
      h.push_back(x * x + y * y);
    }
  config.kind = RP_PATCH;
  config.geometry = RP_UNDEFORMED_DISTANCE;
  config.undeformed_distance = h.data();
  config.distance_shape[0] = config.distance_shape[1] = across;
  config.elements[0] = config.elements[1] = 0;
  config.element_size[0] = config.element_size[1] = size;
  config.spin_offset = RP_SPIN_OFFSET_SIXTH;
  config.max_iterations = 999;
  rp_contact *contact = nullptr;
  if (rp_create(&config, &contact, nullptr) != RP_OK) std::exit(1);
  rp_input input;
  rp_default_input(&input);
  input.normal_force = 40000;
  static rp_result result;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    input.creepage[0] = creepage(i);
    rp_reset(contact);
    if (rp_step(contact, &input, &result, nullptr) != RP_OK) std::exit(1);
    sum += result.side[RP_RIGHT].patch[0].creep_force[0];
  }
  rp_destroy(contact);
  return sum;
}

}  // namespace

int main(int count, char **arguments) {
  if (count != 3) return 2;
  const int steps = std::atoi(arguments[2]);
  std::printf("%.17g\n",
              std::strcmp(arguments[1], "addon") == 0 ? by_addon(steps) : by_core(steps));
  return 0;
}
