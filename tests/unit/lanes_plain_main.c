/* The lane checks as a program that needs nothing but the C library: lanes_plain [seed] */
#include "lanes_check.h"

#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv) {
    uint32_t seed = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 0) : 1u;
    int failures = lanes_check(seed);
    printf("%d failures\n", failures);
    return failures != 0;
}
