# The FFT library behind core/fft.*: defines the target railpatch_fft. FFTW is GPL-2.0-or-later.

set(fft_choices fftw)
if(NOT RAILPATCH_FFT IN_LIST fft_choices)
  message(FATAL_ERROR
    "RAILPATCH_FFT is \"${RAILPATCH_FFT}\"; this version of Railpatch knows: ${fft_choices}")
endif()

add_library(railpatch_fft INTERFACE)
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
