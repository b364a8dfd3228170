// Dispatch of hot loops to AVX2 at load time. Only element-wise loops are marked, so the order of
// every sum, and with it every bit, is the same on all machines (no FMA: -ffp-contract=off).
#pragma once

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__)
#define RAILPATCH_DISPATCH __attribute__((target_clones("avx2", "default")))
#else
#define RAILPATCH_DISPATCH
#endif
