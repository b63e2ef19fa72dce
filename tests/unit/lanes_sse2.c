/* The lane checks over simd/sse2.h; empty where the compiler does not have it. */
#include "lanes_check.h"

#if defined(__SSE2__) || defined(_M_X64)
#define TL_LANES_SSE2
#define LANES_CHECK lanes_check_sse2
#include "lanes_check.inl"
#endif
