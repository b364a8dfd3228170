#include <algorithm>
#include <cmath>
#include <numbers>

#include "calls.hpp"

using namespace contact_addon;

namespace {

struct profile_request {
  profile_options options;
  std::string refused;
};

std::string ending(const std::string &name) {
  const size_t dot = name.rfind('.');
  std::string out = dot == std::string::npos ? "" : name.substr(dot + 1);
  for (char &c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

// Of the lists of integers and reals; name: of the file, or empty.
profile_request request_of(const units &u, const std::string &name, int nints, const int *ints,
                           int nreals, const double *reals) {
  const auto whole = [&](int i, int start) { return i < nints ? ints[i] : start; };
  const auto real = [&](int i, double start) { return i < nreals ? reals[i] : start; };
  profile_request out;
  int type = whole(0, -1);
  const std::string end = ending(name);
  if (type < 0 && name.empty()) type = 1;
  if (type < 0)
    type = end == "prr" || end == "ban" || end == "slcs"   ? 0
           : end == "prw" || end == "whl" || end == "slcw" ? 1
                                                           : -1;
  if (type < 0) out.refused = "the type is not said, and no extension tells: 0 rail, 1 wheel";
  out.options.role = type == 0 ? profile_role::rail : profile_role::wheel;
  out.options.mirror_y = whole(2, 0) == 1;
  out.options.mirror_z = whole(3, 0);
  out.options.scale = real(0, 1.0);
  if (!(out.options.scale > 0)) out.options.scale = 1e3 * u.length;
  out.options.smoothing = 1e-3 * real(1, 0.0);
  const int method = whole(5, 0);
  if (out.options.smoothing > 0 && method == 0)
    out.refused =
        "smoothing 0 (weighted spline by lambda) has no counterpart: 1 or 2, with a length";
  const double start[5] = {0.5, 5 * std::numbers::pi / 6, std::numbers::pi / 6,
                           std::numbers::pi / 30, 2};
  for (int i = 2; i < std::min(nreals, 7); ++i)
    if (std::fabs(reals[i] - start[i - 2]) > 1e-6)
      say("cntc_setprofileinputfname",
          "real " + std::to_string(i + 1) + " (omitted points, kinks) has no effect here");
  return out;
}

// Slices of both bodies: features of one, or more than one slice, make a rule for both.
void match(wheel_data &w) {
  const bool by_knot = w.wheel_slices.featured() || w.rail_slices.featured();
  const bool cubic = w.wheel_slices.place.size() > 1 || w.rail_slices.place.size() > 1;
  const auto matched = [&](const profile_slices &slices, profile_role role) {
    if (slices.empty()) return std::shared_ptr<matched_slices>();
    return std::make_shared<matched_slices>(match_slices(slices, role, by_knot, cubic));
  };
  w.wheel_matched = matched(w.wheel_slices, profile_role::wheel);
  w.rail_matched = matched(w.rail_slices, profile_role::rail);
}

int take(problem &p, const profile_request &request, profile_curve curve, profile_points points,
         profile_slices slices) {
  const bool wheel = request.options.role == profile_role::wheel;
  (wheel ? p.wheel.wheel_profile : p.wheel.rail_profile) = std::move(curve);
  (wheel ? p.wheel.wheel_points : p.wheel.rail_points) = std::move(points);
  (wheel ? p.wheel.wheel_slices : p.wheel.rail_slices) = std::move(slices);
  match(p.wheel);
  ++p.wheel.profile_changes;
  p.changed = true;
  p.refuse(wheel ? "wheel" : "rail", "");
  return 0;
}

int take(problem &p, const std::string &name, const profile_request &request,
         profile_points points) {
  orient(name, request.options, points);
  profile_curve curve = fit(name, points, request.options.smoothing);
  return take(p, request, std::move(curve), std::move(points), {});
}

int take_file(problem &p, const std::string &path, const profile_request &request) {
  if (!names_slices(path)) return take(p, path, request, read_points(path, request.options));
  profile_slices slices = read_slices(path, request.options);
  profile_curve first = slices.curve.front();
  return take(p, request, std::move(first), slices.first, std::move(slices));
}

// What goes wrong is told by cntc_calculate, as error -32.
template <class Task>
int tried(problem &p, const char *call, const profile_request &request, Task task) {
  std::string why = request.refused;
  if (why.empty()) {
    try {
      return task();
    } catch (const profile_error &error) {
      why = error.what();
    }
  }
  const bool wheel = request.options.role == profile_role::wheel;
  (wheel ? p.wheel.wheel_profile : p.wheel.rail_profile) = {};
  (wheel ? p.wheel.wheel_slices : p.wheel.rail_slices) = {};
  (wheel ? p.wheel.wheel_matched : p.wheel.rail_matched).reset();
  p.refuse(wheel ? "wheel" : "rail", "profile: " + why);
  say(call, why);
  p.changed = true;
  return 0;
}

}  // namespace

std::string contact_addon::below_folder(const std::string &folder, const std::string &path) {
  const bool absolute = !path.empty() && (path[0] == '/' || path[0] == '\\' || path.find(':') == 1);
  return absolute || folder.empty() ? path : folder + "/" + path;
}

int contact_addon::set_profile(const char *call, problem &p, const std::string &path, int nints,
                               const int *ints, int nreals, const double *reals) {
  const profile_request request = request_of(p.unit(), path, nints, ints, nreals, reals);
  return tried(p, call, request, [&] { return take_file(p, path, request); });
}

void cntc_setprofileinputfname(int *ire, const char *name, int *len_name, int *nints, int *ints,
                               int *nreals, double *reals) {
  const char *call = "cntc_setprofileinputfname";
  CONTACT_ADDON_NEEDS(call, ire, name, len_name, nints, nreals)
  with_problem(call, *ire, -1, modules::wheels, patches::element, true, [&](problem &p) {
    std::string path = text_of(name, len_name);
    path = below_folder(work_folder(), path);
    return set_profile(call, p, path, ints ? *nints : 0, ints, reals ? *nreals : 0, reals);
  });
}

void cntc_setprofileinputvalues(int *ire, int *npoint, double *values, int *nints, int *ints,
                                int *nreals, double *reals) {
  const char *call = "cntc_setprofileinputvalues";
  CONTACT_ADDON_NEEDS(call, ire, npoint, values, nints, nreals)
  with_problem(call, *ire, -1, modules::wheels, patches::element, true, [&](problem &p) {
    const profile_request request =
        request_of(p.unit(), "", ints ? *nints : 0, ints, reals ? *nreals : 0, reals);
    return tried(p, call, request, [&] {
      profile_points points;
      const double unit = 1e-3 * request.options.scale;
      for (int i = 0; i < std::min(*npoint, 1000000); ++i) {
        points.y.push_back(values[2 * i] * unit);
        points.z.push_back(values[2 * i + 1] * unit);
        points.weight.push_back(1.0);
      }
      return take(p, "profile", request, std::move(points));
    });
  });
}
