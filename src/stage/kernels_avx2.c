#if defined(__AVX2__)
#define TL_LANES_AVX2
#define TL_KERNELS tl_kernels_avx2
#include "stage/kernels.inl"
#else
typedef int tl_no_avx2; /* C wants a declaration */
#endif
