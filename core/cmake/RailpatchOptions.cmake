# Compile options of our own targets: link PRIVATE to railpatch_options.

add_library(railpatch_options INTERFACE)
target_compile_features(railpatch_options INTERFACE c_std_11 cxx_std_20)

if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  # no fused multiply-add behind our back: the same inputs give the same bits
  target_compile_options(railpatch_options INTERFACE -Wall -Wextra -Wpedantic -ffp-contract=off)
  if(RAILPATCH_WERROR)
    target_compile_options(railpatch_options INTERFACE -Werror)
  endif()
  # the baseline of a distributed binary: every x86-64 processor since about 2009
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    if(RAILPATCH_ZIG)  # its name for the same
      target_compile_options(railpatch_options INTERFACE -mcpu=x86_64_v2)
    else()
      target_compile_options(railpatch_options INTERFACE -march=x86-64-v2)
    endif()
  endif()
  if(RAILPATCH_SANITIZE)
    target_compile_options(railpatch_options INTERFACE
      -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(railpatch_options INTERFACE -fsanitize=address,undefined)
  endif()
elseif(RAILPATCH_SANITIZE)
  message(FATAL_ERROR "RAILPATCH_SANITIZE needs GCC or Clang")
endif()
