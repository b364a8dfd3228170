// The GNU C++ runtime that is linked in keeps a pool for exceptions that nobody frees when the
// library is unloaded: 70 kB each time an importer loads and unloads it.
#include <version>

#if defined(__GLIBCXX__)

namespace __gnu_cxx {
void __freeres();
}

namespace {

[[gnu::destructor]] void free_pool() { __gnu_cxx::__freeres(); }

}  // namespace

#endif
