// Hot loops over arrays compiled twice: for processors with AVX2, and for all. Both give the same bits: no fused
// multiply-add, no sums reordered.
#pragma once

#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define STAIRWRIGHT_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define STAIRWRIGHT_VECTOR_CLONES
#endif

#if defined(__GNUC__)
#define STAIRWRIGHT_INLINE inline __attribute__((always_inline))
#else
#define STAIRWRIGHT_INLINE inline
#endif
