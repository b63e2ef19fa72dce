/* The lane checks over simd/neon.h; empty where the compiler does not have it. */
#include "lanes_check.h"

#if defined(__aarch64__) || defined(_M_ARM64)
#define TL_LANES_NEON
#define LANES_CHECK lanes_check_neon
#include "lanes_check.inl"
#endif
