#include "below.hpp"

#include <nanobind/stl/string.h>

#include <cstring>

#include "convert.hpp"
#include "watching.hpp"

namespace railpatch::python {

namespace {

#define RAILPATCH_WORD(name, value, word) word,
constexpr const char *fields[] = {RP_SUBSURFACE_FIELDS(RAILPATCH_WORD)};
#undef RAILPATCH_WORD

nb::ndarray<nb::numpy, double> owned(std::unique_ptr<double[]> values, size_t count) {
  double *data = values.get();
  nb::capsule owner(values.release(), [](void *p) noexcept { delete[] static_cast<double *>(p); });
  return nb::ndarray<nb::numpy, double>(data, {count}, owner);
}

void found(rp_error code, const rp_message &message) {
  if (code == RP_ERROR_NO_FIELD) {
    PyErr_SetString(PyExc_LookupError, message.text);
    throw nb::python_error();
  }
  check(code, &message);
}

}  // namespace

Below::Below(const rp_contact *contact, std::mutex &mutex, std::vector<double> depths,
             bool displacements, double dang_van)
    : contact_(contact), mutex_(mutex), depths_(std::move(depths)) {
  rp_subsurface_config config;
  rp_default_subsurface(&config);
  config.depth = depths_.data();
  config.depth_count = static_cast<int32_t>(depths_.size());
  config.displacements = displacements;
  config.dang_van = dang_van;
  rp_message message = {};
  rp_subsurface *made = nullptr;
  check(rp_create_subsurface(contact_, &config, &made, &message), &message);
  below_.reset(made);
}

void Below::solve(int side, int patch, int body) {
  rp_message message = {};
  rp_error code = RP_OK;
  {
    nb::gil_scoped_release unlocked;
    std::lock_guard<std::mutex> guard(mutex_);
    code = rp_solve_subsurface(below_.get(), contact_, side, patch, body, &message);
  }
  found(code, message);
}

nb::ndarray<nb::numpy, double> Below::field(const char *name) {
  int wanted = -1, number = 0;
  for (const char *word : fields) {
    if (std::strcmp(word, name) == 0) wanted = number;
    ++number;
  }
  if (wanted < 0) throw nb::key_error(name);
  const auto which = static_cast<rp_subsurface_field>(wanted);
  size_t count = 0;
  const rp_error code = rp_get_subsurface_field(below_.get(), which, nullptr, &count);
  found(code == RP_ERROR_SIZE ? RP_OK : code, {"no such field: solve() first"});
  std::unique_ptr<double[]> values(new double[count]);
  check(rp_get_subsurface_field(below_.get(), which, values.get(), &count));
  return owned(std::move(values), count);
}

nb::ndarray<nb::numpy, double> Below::at(
    int side, int patch, int body,
    const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu> &points) {
  if (points.shape(1) != 3) throw nb::value_error("points: three numbers each");
  const size_t count = points.shape(0);
  std::unique_ptr<double[]> values(new double[9 * count + 1]);
  rp_message message = {};
  rp_error code = RP_OK;
  {
    nb::gil_scoped_release unlocked;
    std::lock_guard<std::mutex> guard(mutex_);
    code = rp_stress_at(contact_, side, patch, body, points.data(), count, values.get(), &message);
  }
  found(code, message);
  return owned(std::move(values), 9 * count);
}

void bind_below(nb::module_ &m) {
  nb::list field_words;
  for (const char *word : fields) field_words.append(word);
  m.attr("SUBSURFACE_FIELDS") = nb::tuple(field_words);
  nb::class_<Below>(m, "Below", "rp_subsurface of a contact.")
      .def(
          "solve", &Below::solve, nb::arg("side"), nb::arg("patch"), nb::arg("body"),
          "Of the last step. Raises LookupError where it has no such patch. The interpreter's lock "
          "is released.")
      .def("field", &Below::field, nb::arg("name"), "A field of the last solve(), flat, x fastest.")
      .def("at", &Below::at, nb::arg("side"), nb::arg("patch"), nb::arg("body"), nb::arg("points"),
           "Stresses and displacements, flat, nine a point, of points [n, 3].");
}

}  // namespace railpatch::python
