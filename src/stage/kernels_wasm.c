#if defined(__wasm_simd128__)
#define TL_LANES_WASM
#define TL_KERNELS tl_kernels_wasm
#include "stage/kernels.inl"
#else
typedef int tl_no_wasm; /* C wants a declaration */
#endif
