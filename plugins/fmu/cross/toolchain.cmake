# The FMU's libraries for other systems than this one, by the Clang of the Python package ziglang,
# which brings headers and link libraries of them all.
#   RAILPATCH_ZIG     its program
#   RAILPATCH_TARGET  processor, system and C library, as in x86_64-linux-gnu.2.17
#   CMAKE_SYSTEM_NAME, CMAKE_SYSTEM_PROCESSOR  the same in CMake's words

list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES RAILPATCH_ZIG RAILPATCH_TARGET)
set(CMAKE_C_COMPILER "${RAILPATCH_ZIG}" cc -target "${RAILPATCH_TARGET}")
set(CMAKE_CXX_COMPILER "${RAILPATCH_ZIG}" c++ -target "${RAILPATCH_TARGET}")
# CMake asks for it where Windows is meant; there is nothing to compile with it
set(CMAKE_RC_COMPILER "${RAILPATCH_ZIG}")
# Eigen has headers only, and those of this machine do
set(CMAKE_PREFIX_PATH /usr)
