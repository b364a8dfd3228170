#include "log.hpp"

#include <cstdio>
#include <mutex>

namespace contact_addon {

namespace {

struct log_state {
  std::mutex mutex;
  std::string path;
  bool also_screen = false;
  std::FILE *file = nullptr;
};

log_state &state() {
  static log_state it;
  return it;
}

}  // namespace

void open_log(const std::string &path, bool also_screen) {
  log_state &log = state();
  const std::lock_guard lock(log.mutex);
  if (log.file) std::fclose(log.file);
  log.file = nullptr;
  log.path = path;
  log.also_screen = also_screen || path.empty();
}

void close_log() { open_log({}, true); }

void say(const std::string &where, const std::string &text) {
  log_state &log = state();
  const std::lock_guard lock(log.mutex);
  const std::string line = where.empty() ? text + "\n" : where + ": " + text + "\n";
  if (!log.path.empty() && !log.file) {
    log.file = std::fopen(log.path.c_str(), "w");
    if (!log.file) {
      std::fprintf(stderr, "contact_addon: cannot write %s\n", log.path.c_str());
      log.path.clear();
      log.also_screen = true;
    }
  }
  if (log.file) {
    std::fputs(line.c_str(), log.file);
    std::fflush(log.file);
  }
  if (log.also_screen || log.path.empty()) std::fputs(("contact_addon: " + line).c_str(), stderr);
}

}  // namespace contact_addon
