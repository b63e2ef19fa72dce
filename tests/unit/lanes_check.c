#include "lanes_check.h"

#include <stdio.h>

static int run(const char *name, int (*check)(uint32_t, uint64_t *), uint32_t seed) {
    uint64_t digest = 0;
    int failures = check(seed, &digest);
    printf("lanes %-6s seed %lu digest %08lx%08lx failures %d\n", name, (unsigned long)seed,
           (unsigned long)(digest >> 32), (unsigned long)(digest & 0xffffffffu), failures);
    return failures;
}

int lanes_check(uint32_t seed) {
    int failures = run("scalar", lanes_check_scalar, seed);
#if defined(__x86_64__) || defined(_M_X64)
    failures += run("sse2", lanes_check_sse2, seed);
#if defined(__GNUC__)
    if (__builtin_cpu_supports("avx2")) {
        failures += run("avx2", lanes_check_avx2, seed);
    } else {
        printf("lanes avx2   not on this processor\n");
    }
#endif
#elif defined(__aarch64__) || defined(_M_ARM64)
    failures += run("neon", lanes_check_neon, seed);
#elif defined(__wasm_simd128__)
    failures += run("wasm", lanes_check_wasm, seed);
#endif
    return failures;
}
