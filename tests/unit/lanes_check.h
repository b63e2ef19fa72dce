/* The checks of simd/lanes.h and base/trig_lanes.h, without a test library, so that they run wherever a C compiler
 * reaches: under an emulator or in a WebAssembly runtime too. */
#ifndef TL_TEST_LANES_CHECK_H
#define TL_TEST_LANES_CHECK_H

#include <stdint.h>

/* Checks every instruction set that this build has and this processor runs. Prints what failed; answers how much. */
int lanes_check(uint32_t seed);

/* One instruction set each. The digest is of all results (a NaN counts as one value): the same everywhere. */
int lanes_check_scalar(uint32_t seed, uint64_t *digest);
int lanes_check_sse2(uint32_t seed, uint64_t *digest);
int lanes_check_avx2(uint32_t seed, uint64_t *digest);
int lanes_check_neon(uint32_t seed, uint64_t *digest);
int lanes_check_wasm(uint32_t seed, uint64_t *digest);

#endif
