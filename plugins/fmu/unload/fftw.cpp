// The planner of the FFTW inside this library keeps tables; the library's end is theirs, too.
#include <fftw3.h>

namespace {

[[gnu::destructor]] void free_plans() { fftw_cleanup(); }

}  // namespace
