/* Trajectories: the bytes of the file, and the hash of its last frame. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "host/file.h"
#include "talus/trajectory.h"

#define PATH "trajectory_test.tmp"

static uint32_t word(const unsigned char *p) {
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static float number(const unsigned char *p) {
    uint32_t bits = word(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static trajectory_state state_of(float first) {
    trajectory_state s = {{{first, first + 1, first + 2}, {first + 3, first + 4, first + 5, first + 6}},
                          {first + 7, first + 8, first + 9},
                          {first + 10, first + 11, first + 12}};
    return s;
}

static void writes_frames(void **state) {
    (void)state;
    trajectory t;
    assert_true(trajectory_open(&t, PATH, 2, 3, 0.25f));
    for (int frame = 0; frame < 3; frame++) {
        const trajectory_state states[2] = {state_of((float)(100 * frame)), state_of((float)(100 * frame + 50))};
        trajectory_frame(&t, (float)frame * 0.5f, states);
    }
    uint64_t hash = trajectory_hash(&t);
    assert_true(trajectory_close(&t));
    unsigned char *bytes;
    size_t size;
    assert_int_equal(host_file_read(PATH, 1 << 20, &bytes, &size), HOST_FILE_OK);
    remove(PATH);
    assert_int_equal(size, 24 + 3 * (4 + 2 * 52));
    assert_memory_equal(bytes, "PTRJ", 4);
    assert_int_equal(word(bytes + 4), 1);
    assert_int_equal(word(bytes + 8), 2);
    assert_int_equal(word(bytes + 12), 3);
    assert_true(number(bytes + 16) == 0.25f);
    assert_int_equal(word(bytes + 20), 0);
    for (int frame = 0; frame < 3; frame++) {
        const unsigned char *at = bytes + 24 + frame * 108;
        assert_true(number(at) == (float)frame * 0.5f);
        for (int i = 0; i < 26; i++) {
            assert_true(number(at + 4 + 4 * i) == (float)(100 * frame + (i < 13 ? i : 50 + i - 13)));
        }
    }
    uint64_t expected = 0xcbf29ce484222325u; /* FNV-1a */
    for (size_t i = size - 104; i < size; i++) {
        expected = (expected ^ bytes[i]) * 0x100000001b3u;
    }
    assert_true(hash == expected);
    free(bytes);
}

static void hashes_without_a_file(void **state) {
    (void)state;
    trajectory t;
    assert_true(trajectory_open(&t, NULL, 0, 1, 0.25f));
    trajectory_frame(&t, 0, NULL);
    assert_true(trajectory_hash(&t) == 0xcbf29ce484222325u);
    assert_true(trajectory_close(&t));
}

static void tells_of_what_cannot_be_written(void **state) {
    (void)state;
    trajectory t;
    assert_false(trajectory_open(&t, "no such folder/t.ptrj", 1, 1, 0.25f));
    FILE *full = fopen("/dev/full", "wb"); /* where there is such a device */
    if (full != NULL) {
        fclose(full);
        const trajectory_state one = state_of(1);
        assert_true(trajectory_open(&t, "/dev/full", 1, 1, 0.25f));
        trajectory_frame(&t, 0, &one);
        assert_false(trajectory_close(&t));
    }
}

static void reads_files(void **state) {
    (void)state;
    unsigned char *bytes;
    size_t size;
    assert_int_equal(host_file_write(PATH, "12345", 5), HOST_FILE_OK);
    assert_int_equal(host_file_read(PATH, 5, &bytes, &size), HOST_FILE_OK);
    assert_int_equal(size, 5);
    assert_string_equal((char *)bytes, "12345");
    free(bytes);
    assert_int_equal(host_file_read(PATH, 4, &bytes, &size), HOST_FILE_TOO_LARGE);
    assert_null(bytes);
    remove(PATH);
    assert_int_equal(host_file_read(PATH, 4, &bytes, &size), HOST_FILE_CANNOT_OPEN);
    assert_int_equal(host_file_read(".", 4, &bytes, &size), HOST_FILE_CANNOT_READ);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(writes_frames),
        cmocka_unit_test(hashes_without_a_file),
        cmocka_unit_test(tells_of_what_cannot_be_written),
        cmocka_unit_test(reads_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
