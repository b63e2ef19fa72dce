/* The lane checks over simd/wasm.h; empty where the compiler does not have it. */
#include "lanes_check.h"

#if defined(__wasm_simd128__)
#define TL_LANES_WASM
#define LANES_CHECK lanes_check_wasm
#include "lanes_check.inl"
#endif
