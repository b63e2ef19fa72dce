#if defined(__aarch64__)
#define TL_LANES_NEON
#define TL_KERNELS tl_kernels_neon
#include "stage/kernels.inl"
#else
typedef int tl_no_neon; /* C wants a declaration */
#endif
