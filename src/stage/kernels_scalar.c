#define TL_LANES_SCALAR
#define TL_KERNELS tl_kernels_scalar
#include "stage/kernels.inl"
