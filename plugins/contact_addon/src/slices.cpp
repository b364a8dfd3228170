#include "slices.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/profile_sections.hpp"
#include "words.hpp"

namespace contact_addon {

namespace {

using values = std::vector<double>;

constexpr int most_slices = 10'000, most_features = 100;
constexpr double pi = std::numbers::pi;
// as in railpatch/profiles/sections.py, where the reasons stand
constexpr double spacing = 1e-4, missing = 1e-6, steepest = 0.1, ripple = 2e-4, slack = 1e-4;
constexpr int most_knots = 3000, fewest = 4;

std::string ending(const std::string &path) {
  std::string end = path.size() < 5 ? "" : path.substr(path.size() - 5);
  for (char &c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return end;
}

struct slice_row {
  double u, place;
  std::string file;
  values features;
};

// Places along the profiles, of each slice by its u.
void read_features(words &file, int count, bool angle, std::vector<slice_row> &rows) {
  std::vector<bool> met(rows.size());
  for (size_t k = 0; k < rows.size(); ++k) {
    const double u = file.real("u of features", angle);
    values own;
    for (int i = 0; i < count; ++i) {
      own.push_back(1e-3 * file.real("S_F"));
      if (own.back() < 0)
        file.fail("S_F is below 0, allowed arc lengths from the profile's first point");
    }
    file.end_line();
    const auto of =
        std::find_if(rows.begin(), rows.end(), [&](const slice_row &r) { return r.u == u; });
    if (of == rows.end()) file.fail("features are those of other slices than the profiles");
    met[static_cast<size_t>(of - rows.begin())] = true;
    of->features = own;
  }
  if (std::find(met.begin(), met.end(), false) != met.end())
    file.fail("features are those of other slices than the profiles");
}

std::vector<slice_row> read_rows(words &file, bool angle) {
  const double offset = file.real("U_OFFSET", angle), scale = file.real("U_SCALE");
  if (scale == 0) file.fail("U_SCALE is 0: all slices lie at one place");
  file.end_line();
  const int count = file.whole("NSLC");
  if (count < 1 || count > most_slices)
    file.fail("NSLC is " + std::to_string(count) + ", allowed 1 ... 10000");
  file.end_line();
  const int features = file.whole("NFEAT");
  if (features < 0 || features > most_features)
    file.fail("NFEAT is " + std::to_string(features) + ", allowed 0 ... 100");
  for (const char *name : {"NKINK", "NACCEL"})
    if (file.optional().value_or(0.0) != 0) file.fail(std::string(name) + " has no counterpart");
  file.end_line();
  const int blend = file.whole("U_INTPOL");
  if (blend != 1)
    file.fail("U_INTPOL = " + std::to_string(blend) +
              " has no counterpart: slices are interpolated, 1");
  file.end_line();
  std::vector<slice_row> rows;
  for (int k = 0; k < count; ++k) {
    slice_row row;
    row.u = file.real("u", angle);
    row.file = file.string("the name of a slice's profile");
    row.place = offset + scale * row.u;
    rows.push_back(row);
    file.end_line();
  }
  if (features > 1) read_features(file, features, angle, rows);
  return rows;
}

// y, z at an arc length from the first knot on.
void point_at(const profile_curve &p, double s, double &y, double &z) {
  double slope;
  p.at(s, y, z, slope);
}

profile_curve with_knots(const profile_curve &p, const values &at) {
  profile_curve out;
  for (const double s : at) {
    double y, z;
    point_at(p, s, y, z);
    out.arc_length.push_back(s - p.arc_length.front());
    out.y.push_back(y);
    out.z.push_back(z);
  }
  out.dy = slopes(out.arc_length, out.y, p.dy.front(), p.dy.back());
  out.dz = slopes(out.arc_length, out.z, p.dz.front(), p.dz.back());
  return out;
}

double length_of(const profile_curve &p) { return p.arc_length.back() - p.arc_length.front(); }

std::vector<profile_curve> at_equal_shares(const std::vector<profile_curve> &profiles) {
  double longest = 0;
  size_t most = 0;
  for (const profile_curve &p : profiles) {
    longest = std::max(longest, length_of(p));
    most = std::max(most, p.y.size());
  }
  const auto count = std::min<size_t>(
      std::max(static_cast<size_t>(std::ceil(longest / spacing)) + 1, most), most_knots);
  std::vector<profile_curve> out;
  for (const profile_curve &p : profiles) {
    const double begin = p.arc_length.front(), end = p.arc_length.back();
    values at(count);
    const double step = 1.0 / static_cast<double>(count - 1);
    for (size_t i = 0; i < count; ++i)
      at[i] = begin + (i + 1 < count ? static_cast<double>(i) * step : 1.0) * (end - begin);
    at.back() = end;
    out.push_back(with_knots(p, at));
  }
  return out;
}

// Begin, features and end, each beyond the one before.
values edges_of(const std::string &name, const profile_curve &p, const values &features) {
  const double length = length_of(p);
  double before = 0;
  for (const double feature : features) {
    if (!(before <= feature && feature <= length + slack))
      throw profile_error(name + ": has a feature at " + std::to_string(1e3 * feature) +
                          " mm, allowed " + std::to_string(1e3 * before) + " ... " +
                          std::to_string(1e3 * length) +
                          ": arc lengths along the profile that do not fall");
    before = feature;
  }
  values edges{0.0};
  edges.insert(edges.end(), features.begin(), features.end());
  edges.push_back(length);
  const size_t n = edges.size();
  values least(n);
  for (size_t i = 0; i < n; ++i) least[i] = missing * static_cast<double>(i);
  for (size_t i = 0; i < n; ++i) edges[i] -= least[i];
  for (size_t i = 1; i < n; ++i) edges[i] = std::max(edges[i], edges[i - 1]);
  for (size_t i = 0; i < n; ++i) edges[i] += least[i];
  // not beyond the end either
  for (size_t i = 0; i < n; ++i) edges[i] = std::min(edges[i], length) + least[n - 1 - i];
  for (size_t i = n - 1; i-- > 0;) edges[i] = std::min(edges[i], edges[i + 1]);
  for (size_t i = 0; i < n; ++i) edges[i] -= least[n - 1 - i];
  return edges;
}

// Of each step from knot to knot whether it is on the way down into a gap, or over an edge.
std::vector<bool> falling(const values &z) {
  std::vector<bool> falls(z.size() - 1, true);
  bool down = true;
  size_t last = 0;
  for (size_t i = 1; i < z.size(); ++i) {
    if ((z[i] >= z[last]) == down) {
      last = i;
    } else if (std::fabs(z[i] - z[last]) > ripple) {
      down = !down;
      std::fill(falls.begin() + static_cast<std::ptrdiff_t>(last), falls.end(), down);
      last = i;
    }
  }
  return falls;
}

profile_curve seen_from_above(const std::string &name, profile_curve p) {
  const size_t pieces = p.y.size() - 1;
  values least(pieces), &y = p.y;
  size_t first = pieces, last = 0;
  for (size_t i = 0; i < pieces; ++i) {
    least[i] = steepest * (p.arc_length[i + 1] - p.arc_length[i]);
    if (y[i + 1] - y[i] > least[i]) first = std::min(first, i), last = i;
  }
  if (first == pieces) throw profile_error(name + ": has no surface that can be seen from above");
  bool seen = true;
  for (size_t i = first; i <= last; ++i) seen &= y[i + 1] - y[i] >= least[i];
  if (seen) return p;
  const values given = y;
  const std::vector<bool> falls = falling(p.z);
  for (size_t i = first; i <= last; ++i)
    if (falls[i]) y[i + 1] = std::max(y[i + 1], y[i] + least[i]);
  // on the way up from the other side, and what of the gap's bottom that pushes along
  std::vector<bool> level(pieces);
  for (size_t i = 0; i < pieces; ++i) level[i] = y[i + 1] - y[i] >= least[i];
  for (size_t i = last + 1; i-- > first;)
    if (!falls[i] || level[i]) y[i] = std::min(y[i], y[i + 1] - least[i]);
  for (size_t i = first; i <= last; ++i)
    if (y[i + 1] - y[i] < 0.5 * least[i])
      throw profile_error(name + ": turns back at y = " + std::to_string(1e3 * given[i]) +
                          " mm: a gap that narrows downwards must be cut off above");
  values way{0.0};
  for (size_t i = 0; i < pieces; ++i) {
    const double a = y[i + 1] - y[i], b = p.z[i + 1] - p.z[i];
    way.push_back(way.back() + std::sqrt(a * a + b * b));
  }
  p.dy = slopes(way, y, p.dy.front(), p.dy.back());
  p.dz = slopes(way, p.z, p.dz.front(), p.dz.back());
  p.arc_length = way;
  return p;
}

std::string shown_place(const profile_slices &slices, profile_role role, size_t k) {
  return role == profile_role::rail ? "slice at " + std::to_string(1e3 * slices.place[k]) + " mm"
                                    : "slice at " + std::to_string(slices.place[k]) + " rad";
}

std::vector<profile_curve> at_features(const profile_slices &slices, profile_role role) {
  std::vector<values> edges;
  for (size_t k = 0; k < slices.curve.size(); ++k)
    edges.push_back(edges_of(shown_place(slices, role, k), slices.curve[k], slices.features[k]));
  values lengths(edges.front().size() - 1);
  double whole = 0;
  for (size_t i = 0; i < lengths.size(); ++i) {
    for (const values &own : edges) lengths[i] = std::max(lengths[i], own[i + 1] - own[i]);
    whole += lengths[i];
  }
  const double apart = std::max(spacing, whole / most_knots);
  std::vector<profile_curve> out;
  for (size_t k = 0; k < edges.size(); ++k) {
    const profile_curve &p = slices.curve[k];
    const double begin = p.arc_length.front();
    values at;
    for (size_t i = 0; i < lengths.size(); ++i) {
      const int count = std::max(fewest, static_cast<int>(std::ceil(lengths[i] / apart)));
      const double a = edges[k][i], b = edges[k][i + 1];
      for (int j = 0; j < count; ++j) at.push_back(begin + (a + (b - a) * j / count));
    }
    at.push_back(begin + edges[k].back());
    out.push_back(seen_from_above(shown_place(slices, role, k), with_knots(p, at)));
  }
  return out;
}

// Which parts of a profile, up to its last feature, are missing.
std::vector<bool> parts_missing(const values &features) {
  std::vector<bool> out;
  double before = 0;
  for (const double feature : features) {
    out.push_back(feature == before);
    before = feature;
  }
  return out;
}

}  // namespace

bool names_slices(const std::string &path) {
  const std::string end = ending(path);
  return end == ".slcs" || end == ".slcw";
}

profile_slices read_slices(const std::string &path, const profile_options &options) {
  const bool wheel = options.role == profile_role::wheel;
  if ((ending(path) == ".slcw") != wheel)
    throw profile_error(path + ": is read as a " + (wheel ? "wheel" : "rail") +
                        ", slices along the track are .slcs, round the wheel .slcw");
  std::vector<slice_row> rows;
  try {
    words file = words::of_file(path);
    rows = read_rows(file, wheel);
  } catch (const input_error &error) {
    throw profile_error(error.what());
  }
  if (wheel)
    for (slice_row &row : rows)
      row.place = std::fmod(std::fmod(row.place, 2 * pi) + 2 * pi, 2 * pi);
  else
    for (slice_row &row : rows) row.place *= 1e-3;
  std::stable_sort(rows.begin(), rows.end(),
                   [](const slice_row &a, const slice_row &b) { return a.place < b.place; });
  const std::string folder = path.substr(0, path.find_last_of("/\\") + 1);
  profile_slices out;
  for (const slice_row &row : rows) {
    if (!out.empty() && !(row.place > out.place.back()))
      throw profile_error(path + ": two slices lie at one place");
    const std::string own = folder + row.file;
    profile_points points = read_points(own, options);
    orient(own, options, points);
    out.place.push_back(row.place);
    out.curve.push_back(fit(own, points, options.smoothing));
    out.features.push_back(row.features);
    if (out.place.size() == 1) out.first = std::move(points);
  }
  return out;
}

matched_slices match_slices(const profile_slices &slices, profile_role role, bool by_knot,
                            bool cubic) {
  matched_slices out;
  if (slices.empty()) return out;
  out.place = slices.place;
  out.curve = by_knot ? at_features(slices, role) : at_equal_shares(slices.curve);
  const size_t n = out.place.size();
  out.kink.assign(n, 0);
  std::vector<std::vector<bool>> gone;
  for (const values &features : slices.features) gone.push_back(parts_missing(features));
  for (size_t k = role == profile_role::wheel ? 0 : 1; k < n; ++k) {
    const size_t before = k > 0 ? k - 1 : n - 1;
    if (gone[k] != gone[before]) out.kink[k] = out.kink[before] = 1;
  }
  std::vector<railpatch::profile_view> views;
  for (const profile_curve &c : out.curve) {
    views.push_back({c.arc_length.data(), c.y.data(), c.z.data(), c.dy.data(), c.dz.data(),
                     static_cast<int>(c.y.size())});
  }
  railpatch::section_rules rules;
  rules.by_knot = by_knot;
  rules.cubic = cubic;
  rules.period = role == profile_role::wheel ? 2 * pi : 0;
  rules.kink = out.kink.data();
  out.blend = std::make_shared<railpatch::profile_sections>(views.data(), out.place.data(),
                                                            static_cast<int>(n), rules);
  out.now = out.curve.front();
  out.now_at = out.place.front();
  return out;
}

std::vector<rp_profile> matched_slices::views() const {
  std::vector<rp_profile> out;
  for (const profile_curve &c : curve) out.push_back(c.view());
  return out;
}

const profile_curve &slice_at(matched_slices &slices, double place) {
  if (place == slices.now_at) return slices.now;
  bool changed;
  const railpatch::profile_view v = slices.blend->at(place, changed);
  const auto copy = [&](const double *from) { return values(from, from + v.n); };
  slices.now = {copy(v.s), copy(v.y), copy(v.z), copy(v.dy), copy(v.dz)};
  slices.now_at = place;
  return slices.now;
}

}  // namespace contact_addon
