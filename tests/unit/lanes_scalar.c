/* The lane checks over simd/scalar.h. */
#include "lanes_check.h"

#define TL_LANES_SCALAR
#define LANES_CHECK lanes_check_scalar
#include "lanes_check.inl"
