#include "stage/kernels.h"

static const char *const NAMES[TALUS_ISA_COUNT] = {"best", "scalar", "sse2", "avx2", "neon", "wasm"};

const char *talus_isa_name(talus_isa isa) { return (unsigned)isa < TALUS_ISA_COUNT ? NAMES[isa] : "unknown"; }

const tl_kernels *tl_kernels_of(talus_isa isa) {
    switch (isa) {
#if defined(__SSE2__)
    case TALUS_ISA_SSE2:
        return &tl_kernels_sse2;
#endif
#if defined(__x86_64__)
    case TALUS_ISA_AVX2:
        return &tl_kernels_avx2;
#endif
#if defined(__aarch64__)
    case TALUS_ISA_NEON:
        return &tl_kernels_neon;
#endif
#if defined(__wasm_simd128__)
    case TALUS_ISA_WASM:
        return &tl_kernels_wasm;
#endif
    default:
        return &tl_kernels_scalar;
    }
}

#if defined(__x86_64__)
/* CPUID leaf 7 for AVX2; leaf 1 and XGETBV for whether the system saves the wide registers (Intel SDM vol. 1, 14.3). */
static void cpuid(uint32_t leaf, uint32_t r[4]) {
    __asm__ __volatile__("cpuid" : "=a"(r[0]), "=b"(r[1]), "=c"(r[2]), "=d"(r[3]) : "a"(leaf), "c"(0));
}

static int has_avx2(void) {
    uint32_t r[4];
    cpuid(0, r);
    if (r[0] < 7u) {
        return 0;
    }
    cpuid(1, r);
    const uint32_t osxsave_and_avx = 1u << 27 | 1u << 28;
    if ((r[2] & osxsave_and_avx) != osxsave_and_avx) {
        return 0;
    }
    uint32_t low, high;
    __asm__ __volatile__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    if ((low & 6u) != 6u) {
        return 0;
    }
    cpuid(7, r);
    return (int)(r[1] >> 5 & 1u);
}
#endif

int talus_isa_available(talus_isa isa) {
    switch (isa) {
    case TALUS_ISA_BEST:
    case TALUS_ISA_SCALAR:
        return 1;
#if defined(__SSE2__)
    case TALUS_ISA_SSE2:
        return 1;
#endif
#if defined(__x86_64__)
    case TALUS_ISA_AVX2:
        return has_avx2();
#endif
#if defined(__aarch64__)
    case TALUS_ISA_NEON:
        return 1;
#endif
#if defined(__wasm_simd128__)
    case TALUS_ISA_WASM:
        return 1;
#endif
    default:
        return 0;
    }
}

talus_isa tl_best_isa(void) {
    const talus_isa order[] = {TALUS_ISA_AVX2, TALUS_ISA_SSE2, TALUS_ISA_NEON, TALUS_ISA_WASM};
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        if (talus_isa_available(order[i])) {
            return order[i];
        }
    }
    return TALUS_ISA_SCALAR;
}
