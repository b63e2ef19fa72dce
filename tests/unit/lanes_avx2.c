/* The lane checks over simd/avx2.h; empty where the compiler does not have it. */
#include "lanes_check.h"

#if defined(__AVX2__)
#define TL_LANES_AVX2
#define LANES_CHECK lanes_check_avx2
#include "lanes_check.inl"
#endif
