#if defined(__SSE2__)
#define TL_LANES_SSE2
#define TL_KERNELS tl_kernels_sse2
#include "stage/kernels.inl"
#else
typedef int tl_no_sse2; /* C wants a declaration */
#endif
