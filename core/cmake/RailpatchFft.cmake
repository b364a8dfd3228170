# The FFT library behind core/fft.hpp: defines the target railpatch_fft and the source that uses it.
# FFTW is GPL-2.0-or-later and fast, Eigen's own FFT (MPL-2.0) is the permissive choice.

set(fft_choices fftw eigen)
if(NOT RAILPATCH_FFT IN_LIST fft_choices)
  message(FATAL_ERROR
    "RAILPATCH_FFT is \"${RAILPATCH_FFT}\"; this version of Railpatch knows: ${fft_choices}")
endif()
set(fft_source "fft_${RAILPATCH_FFT}.cpp")

add_library(railpatch_fft INTERFACE)
if(RAILPATCH_FFT STREQUAL "eigen")
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)
  target_link_libraries(railpatch_fft INTERFACE Eigen3::Eigen)
  return()
endif()

find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(FFTW3 QUIET IMPORTED_TARGET fftw3>=3.3)
endif()
if(FFTW3_FOUND)
  target_link_libraries(railpatch_fft INTERFACE PkgConfig::FFTW3)
else()
  find_path(FFTW3_INCLUDE_DIR fftw3.h)
  find_library(FFTW3_LIBRARY NAMES fftw3 fftw3-3)
  if(NOT FFTW3_INCLUDE_DIR OR NOT FFTW3_LIBRARY)
    message(FATAL_ERROR
      "FFTW 3 (double precision) was not found; on Debian and Ubuntu: apt install libfftw3-dev")
  endif()
  target_include_directories(railpatch_fft SYSTEM INTERFACE "${FFTW3_INCLUDE_DIR}")
  target_link_libraries(railpatch_fft INTERFACE "${FFTW3_LIBRARY}")
endif()
