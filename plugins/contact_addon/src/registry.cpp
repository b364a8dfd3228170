#include "registry.hpp"

#include <cstring>
#include <exception>
#include <new>

#include "log.hpp"

namespace contact_addon {

namespace {

struct element {
  int module = 0;
  std::array<std::shared_ptr<problem>, most_patches + 1> problems;  // of wheels: the first
};

struct all_elements {
  std::mutex mutex;
  bool named = false;  // by cntc_initializefirst
  std::string folder;
  int threads = 1;
  std::array<std::unique_ptr<element>, most_elements + 1> elements;
};

all_elements &all() {
  static all_elements it;
  return it;
}

std::string joined(const std::string &folder, const std::string &name) {
  if (folder.empty() || (!name.empty() && name[0] == '/')) return name;
  return folder.back() == '/' ? folder + name : folder + "/" + name;
}

// Needs the lock.
void make(all_elements &a, int ire, int module) {
  auto &place = a.elements[static_cast<size_t>(ire)];
  place = std::make_unique<element>();
  place->module = module;
}

std::shared_ptr<problem> made(element &it, int ire, int icp) {
  const size_t at = it.module == 1 ? 0 : static_cast<size_t>(icp);
  auto &place = it.problems[at];
  if (!place) {
    place = std::make_shared<problem>();
    place->module = it.module;
    place->ire = ire;
    place->icp = it.module == 1 ? -1 : icp;
  }
  return place;
}

// Whether a call takes these numbers of an element of a module.
int misfit(int module, int icp, modules wanted, patches which) {
  if (wanted == modules::basic && module == 1) return error_not_in_1;
  if (wanted == modules::wheels && module == 3) return error_not_in_3;
  if (icp > most_patches || (icp < 1 && icp != -1)) return error_patch_range;
  const bool patch_needed = which == patches::patch || module == 3;
  if (patch_needed && icp < 1 && which != patches::element) return error_needs_patch;
  if (module == 1 && which == patches::settings && icp > 0) return error_takes_no_patch;
  return error_none;
}

std::string text_of(int code, int ire, int icp) {
  const std::string where = " (ire " + std::to_string(ire) + ", icp " + std::to_string(icp) + ")";
  switch (code) {
    case error_not_initialised:
      return "the contact patch is not initialised" + where;
    case error_element:
      return "result element " + std::to_string(ire) + " is not in 1 ... 999";
    case error_not_in_1:
      return "is not for wheel-rail problems (module 1)" + where;
    case error_not_in_3:
      return "is not for basic contacts (module 3)" + where;
    case error_patch_range:
      return "contact patch " + std::to_string(icp) + " is not in 1 ... 9, or -1";
    case error_needs_patch:
      return "needs a contact patch, icp > 0" + where;
    case error_takes_no_patch:
      return "takes no contact patch: icp = -1" + where;
    case locked:
      return "the contact is in use on another thread" + where;
    default:
      return "failed" + where;
  }
}

}  // namespace

void problem::refuse(const char *call, const std::string &text) {
  for (auto &[name, why] : refused)
    if (name == nullptr || std::strcmp(name, call) == 0) {
      name = call;
      if (why != text) changed = true;
      why = text;
      return;
    }
}

void start(int output, const std::string &folder, const std::string &out_folder,
           const std::string &name) {
  all_elements &a = all();
  const std::lock_guard lock(a.mutex);
  if (a.named) return;  // the first call's folders hold
  a.named = true;
  a.folder = folder;
  // a file only where the caller names one
  const bool named = !out_folder.empty() || !name.empty();
  const std::string file = (name.empty() ? "contact_addon" : name) + ".out";
  open_log(named ? joined(joined(folder, out_folder), file) : std::string(), output == 1);
}

void stop() {
  all_elements &a = all();
  const std::lock_guard lock(a.mutex);
  for (auto &place : a.elements) place.reset();
  a.named = false;
  a.folder.clear();
  close_log();
}

std::string work_folder() {
  all_elements &a = all();
  const std::lock_guard lock(a.mutex);
  return a.folder;
}

int make_element(int ire, int module) {
  if (ire < 1 || ire > most_elements) return error_element;
  if (module != 1 && module != 3) return error_other;
  all_elements &a = all();
  const std::lock_guard lock(a.mutex);
  if (a.elements[static_cast<size_t>(ire)]) {
    say("cntc_initialize", "result element " + std::to_string(ire) + " is in use already");
    return error_none;
  }
  make(a, ire, module);
  return error_none;
}

void drop_element(int ire) {
  if (ire < 1 || ire > most_elements) {
    say("cntc_finalize", text_of(error_element, ire, -1));
    return;
  }
  {
    all_elements &a = all();
    const std::lock_guard lock(a.mutex);
    a.elements[static_cast<size_t>(ire)].reset();
  }
  if (alive_elements() == 0) stop();
}

int alive_elements() {
  all_elements &a = all();
  const std::lock_guard lock(a.mutex);
  int count = 0;
  for (const auto &place : a.elements) count += place ? 1 : 0;
  return count;
}

int module_of(int ire) {
  if (ire < 1 || ire > most_elements) return 0;
  all_elements &a = all();
  const std::lock_guard lock(a.mutex);
  const auto &place = a.elements[static_cast<size_t>(ire)];
  return place ? place->module : 0;
}

void set_threads(int count) {
  all_elements &a = all();
  const std::lock_guard lock(a.mutex);
  a.threads = count;
}

int threads() {
  all_elements &a = all();
  const std::lock_guard lock(a.mutex);
  return a.threads;
}

int guarded(const char *call, const std::function<int()> &body) {
  try {
    return body();
  } catch (const std::exception &error) {
    say(call, error.what());
  } catch (...) {
    say(call, "unexpected error");
  }
  return error_other;
}

int with_problem(const char *call, int ire, int icp, modules module, patches which, bool create,
                 const std::function<int(problem &)> &task) {
  return guarded(call, [&] {
    const auto failed = [&](int code) {
      say(call, text_of(code, ire, icp));
      return code;
    };
    if (ire < 1 || ire > most_elements) return failed(error_element);
    std::shared_ptr<problem> meant;
    {
      all_elements &a = all();
      const std::lock_guard lock(a.mutex);
      auto &place = a.elements[static_cast<size_t>(ire)];
      if (!place && !create) return failed(error_not_initialised);
      if (!place) make(a, ire, icp <= 0 ? 1 : 3);
      const int code = misfit(place->module, icp, module, which);
      if (code != error_none) return failed(code);
      const size_t at = place->module == 1 ? 0 : static_cast<size_t>(icp);
      if (!place->problems[at] && !create) return failed(error_not_initialised);
      meant = made(*place, ire, icp);
    }
    const std::unique_lock lock(meant->busy, std::try_to_lock);
    if (!lock.owns_lock()) return failed(locked);
    return task(*meant);
  });
}

}  // namespace contact_addon
