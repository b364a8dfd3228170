// Dispatch of hot loops to AVX2 at load time. Only element-wise loops are marked, so the order of
// every sum, and with it every bit, is the same on all machines (no FMA: -ffp-contract=off).
#pragma once

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__)
#define RAILPATCH_DISPATCH __attribute__((target_clones("avx2", "default")))
#else
#define RAILPATCH_DISPATCH
#endif

// Before a loop whose steps touch no number that another step writes.
#if defined(__clang__)
#define RAILPATCH_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define RAILPATCH_INDEPENDENT _Pragma("GCC ivdep")
#else
#define RAILPATCH_INDEPENDENT
#endif

// Bodies of dispatched functions must be part of them.
#if defined(__GNUC__)
#define RAILPATCH_INLINE __attribute__((always_inline)) inline
#else
#define RAILPATCH_INLINE inline
#endif

// Before a short loop of a known length: it becomes instructions for several steps at once, where
// writing its steps out first would leave one instruction for each.
#if defined(__GNUC__) && !defined(__clang__)
#define RAILPATCH_ROLLED _Pragma("GCC unroll 1")
#else
#define RAILPATCH_ROLLED
#endif
