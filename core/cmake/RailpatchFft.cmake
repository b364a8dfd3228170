# The FFT libraries behind core/numeric/fft.hpp. For each backend at hand: an object library
# railpatch_fft_<name> of core/numeric/fft_<name>.cpp and an interface library <name>_library to link
# with it.
# RAILPATCH_FFT chooses the one of the main library: fft_objects, fft_library; RAILPATCH_FFT_USED is
# its name. FFTW is GPL-2.0-or-later, Eigen's own FFT (MPL-2.0) is the permissive choice.

set(fft_choices fftw eigen)
if(RAILPATCH_FFT AND NOT RAILPATCH_FFT IN_LIST fft_choices)
  message(FATAL_ERROR
    "RAILPATCH_FFT is \"${RAILPATCH_FFT}\"; this version of Railpatch knows: ${fft_choices}")
endif()

# what every object of the core is compiled with
function(railpatch_object_options target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(NOT RAILPATCH_MUTANTS)  # whose tests look into a shared library
    set_target_properties(${target} PROPERTIES
      CXX_VISIBILITY_PRESET hidden
      VISIBILITY_INLINES_HIDDEN ON
    )
  endif()
  if(NOT RAILPATCH_ZIG)  # a library of the FMU for Windows shows nothing but FMI's functions
    target_compile_definitions(${target} PRIVATE RP_BUILD)
  endif()
  target_include_directories(${target} PUBLIC
    "${PROJECT_SOURCE_DIR}/core"
    "${PROJECT_SOURCE_DIR}/core/include"
  )
  target_link_libraries(${target} PRIVATE railpatch_options)
endfunction()

function(railpatch_fft_backend name library)
  add_library(${name}_library INTERFACE)
  target_link_libraries(${name}_library INTERFACE ${library})
  add_library(railpatch_fft_${name} OBJECT EXCLUDE_FROM_ALL numeric/fft_${name}.cpp)
  railpatch_object_options(railpatch_fft_${name})
  target_link_libraries(railpatch_fft_${name} PRIVATE ${name}_library)
endfunction()

find_package(Eigen3 3.4 QUIET NO_MODULE)
if(TARGET Eigen3::Eigen)
  railpatch_fft_backend(eigen Eigen3::Eigen)
  set_source_files_properties(numeric/fft_eigen.cpp PROPERTIES COMPILE_OPTIONS -fcx-limited-range)
endif()

find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(FFTW3 QUIET IMPORTED_TARGET fftw3>=3.3)
endif()
if(FFTW3_FOUND)
  railpatch_fft_backend(fftw PkgConfig::FFTW3)
else()
  find_path(FFTW3_INCLUDE_DIR fftw3.h)
  find_library(FFTW3_LIBRARY NAMES fftw3 fftw3-3)
  if(FFTW3_INCLUDE_DIR AND FFTW3_LIBRARY)
    railpatch_fft_backend(fftw "${FFTW3_LIBRARY}")
    target_include_directories(fftw_library SYSTEM INTERFACE "${FFTW3_INCLUDE_DIR}")
  endif()
endif()

set(fft_used "${RAILPATCH_FFT}")
if(NOT fft_used AND TARGET railpatch_fft_fftw)
  set(fft_used fftw)
elseif(NOT fft_used)
  set(fft_used eigen)
endif()
set(fft_objects railpatch_fft_${fft_used})
set(fft_library ${fft_used}_library)
if(NOT TARGET ${fft_objects})
  message(FATAL_ERROR "RAILPATCH_FFT is ${fft_used}, which was not found (FFTW 3 in double "
    "precision, or Eigen 3.4); on Debian and Ubuntu: apt install libfftw3-dev libeigen3-dev")
endif()
set(RAILPATCH_FFT_USED ${fft_used} CACHE INTERNAL "The FFT library of this build")
message(STATUS "FFT library: ${fft_used}")
