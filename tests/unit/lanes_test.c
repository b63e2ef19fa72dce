/* Every lane function on every instruction set at hand against plain C, bit for bit. */
#include "lanes_check.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void agree_with_plain_c(void **state) {
    (void)state;
    for (uint32_t seed = 1; seed <= 4; seed++) {
        assert_int_equal(lanes_check(seed), 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(agree_with_plain_c)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
