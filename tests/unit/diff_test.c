/* The tool's record, replay and diff: what is planted is found and told in every form, what is broken is named. */
#include "record_kit.h"

#include <getopt.h>
#include <stdio.h>

#include "host/file.h"
#include "talus/tool.h"
#include "world/command.h"
#include "world/record.h"

#define A "diff_test_a.tmp"
#define B "diff_test_b.tmp"
#define SUMMARY "diff_test_summary.tmp"
#define JUNIT "diff_test_junit.tmp"

static char message[4096]; /* the last one */

/* In place of the tool's own. */
int tool_fail(int status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return status;
}

/* Runs a subcommand with the words of a line. */
static int run(int (*tool)(int count, char **arguments), const char *line) {
    char words[512], *arguments[24];
    int count = 0;
    snprintf(words, sizeof words, "%s", line);
    for (char *word = strtok(words, " "); word != NULL; word = strtok(NULL, " ")) {
        arguments[count++] = word;
    }
    arguments[count] = NULL;
    optind = 0; /* getopt begins anew */
    message[0] = 0;
    return tool(count, arguments);
}

static char *text_of(const char *path) {
    unsigned char *bytes = NULL;
    size_t size = 0;
    assert_int_equal(host_file_read(path, 1u << 24, &bytes, &size), HOST_FILE_OK);
    return (char *)bytes;
}

static void has(const char *path, const char *what) {
    char *text = text_of(path);
    if (strstr(text, what) == NULL) {
        fail_msg("%s has no \"%s\":\n%s", path, what, text);
    }
    free(text);
}

static uint32_t seed = 31337u;
static uint32_t draw(uint32_t below) {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) % below;
}

/* Random flips, some of things that sleep: diff names step, column, row and word of each that the state bears. */
static void finds_what_is_planted(void **state) {
    (void)state;
    uint32_t found = 0;
    print_message("seed %u\n", seed);
    assert_int_equal(run(tool_record, "record @stack -o " A " --steps 150 --quiet"), 0);
    while (found < 24) {
        char line[256], want[128];
        talus_column column;
        uint32_t step = 1u + draw(150), k = draw(talus_column_count()), row = draw(24);
        talus_column_get(k, &column);
        uint32_t bit = draw(8 * column.row_bytes);
        snprintf(line, sizeof line, "record @stack -o " B " --steps 150 --quiet --flip %u:%s:%u:%u", step, column.name,
                 row, bit);
        int status = run(tool_record, line);
        if (status == TOOL_USAGE) { /* no such row then, or no sound state with it */
            continue;
        }
        assert_int_equal(status, 0);
        remove(SUMMARY);
        assert_int_equal(run(tool_diff, "diff " A " " B " --quiet --summary " SUMMARY " --junit " JUNIT),
                         TOOL_DIVERGED);
        snprintf(want, sizeof want, "| first step that parts | %u |", step);
        has(SUMMARY, want);
        snprintf(want, sizeof want, "| column | %s", column.name);
        has(SUMMARY, want);
        snprintf(want, sizeof want, ", word %u |", bit / (8 * column.word_bytes));
        has(SUMMARY, want);
        has(JUNIT, "failures=\"1\" errors=\"0\"");
        found++;
    }
}

static void same_runs_are_the_same(void **state) {
    (void)state;
    assert_int_equal(run(tool_record, "record @chain -o " A " --steps 80 --quiet"), 0);
    assert_int_equal(run(tool_record, "record @chain -o " B " --steps 80 --isa scalar --quiet"), 0);
    assert_int_equal(run(tool_diff, "diff " A " " B " --quiet --junit " JUNIT), 0);
    has(JUNIT, "failures=\"0\" errors=\"0\"");
    assert_int_equal(run(tool_replay, "replay " A " --quiet --isa scalar --junit " JUNIT), 0);
    assert_int_equal(run(tool_replay, "replay " A " --quiet --sync-test --to 40"), 0);
    assert_int_equal(run(tool_record, "record @chain -o " B " --steps 70 --quiet"), 0);
    assert_int_equal(run(tool_diff, "diff " A " " B " --quiet"), TOOL_SHORTER);
}

static void write_bytes(const char *path, const char *bytes, size_t size) {
    assert_int_equal(host_file_write(path, bytes, size), HOST_FILE_OK);
}

/* A recording that is cut off, damaged, of other columns, none at all. */
static void trouble_is_named(void **state) {
    (void)state;
    assert_int_equal(run(tool_record, "record @stack -o " A " --steps 80 --quiet"), 0);
    unsigned char *bytes;
    size_t size;
    assert_int_equal(host_file_read(A, 1u << 24, &bytes, &size), HOST_FILE_OK);
    char *whole = (char *)bytes;
    write_bytes(B, whole, size - 100);
    assert_int_equal(run(tool_replay, "replay " B " --quiet"), TOOL_SHORTER);
    assert_int_equal(run(tool_diff, "diff " A " " B " --quiet"), TOOL_SHORTER);
    write_bytes(B, whole, 60);
    assert_int_equal(run(tool_replay, "replay " B " --quiet"), GLTF_BROKEN);
    assert_non_null(strstr(message, "offset 60: it is cut off before"));
    whole[size - 200] ^= 4;
    write_bytes(B, whole, size);
    assert_int_equal(run(tool_replay, "replay " B " --quiet --junit " JUNIT), GLTF_BROKEN);
    assert_non_null(strstr(message, ": it is damaged"));
    has(JUNIT, "errors=\"1\"");
    whole[12] ^= 1;
    write_bytes(B, whole, size);
    assert_int_equal(run(tool_diff, "diff " A " " B " --quiet"), GLTF_UNSUPPORTED);
    write_bytes(B, "no recording", 12);
    assert_int_equal(run(tool_diff, "diff " B " " A " --quiet"), GLTF_BROKEN);
    assert_int_equal(run(tool_replay, "replay no/such/file"), GLTF_FAILED);
    assert_int_equal(run(tool_record, "record @stack -o no/such/file"), GLTF_FAILED);
    assert_int_equal(run(tool_record, "record @stack"), TOOL_USAGE);
    assert_int_equal(run(tool_record, "record @stack -o " B " --flip 1:2"), TOOL_USAGE);
    assert_int_equal(run(tool_record, "record @stack -o " B " --flip 1:no_column:0:0"), TOOL_USAGE);
    assert_int_equal(run(tool_record, "record @stack -o " B " --steps 5 --flip 6:body_pose:0:0"), TOOL_USAGE);
    assert_int_equal(run(tool_record, "record @stack -o " B " --steps 5 --flip 3:body_pose:99:0"), TOOL_USAGE);
    assert_int_equal(run(tool_replay, "replay"), TOOL_USAGE);
    assert_int_equal(run(tool_diff, "diff " A), TOOL_USAGE);
    free(bytes);
}

/* Records 40 steps of a box and a ball on a floor; a push at a step if that is not 0. */
static void record_pushed(tape *t, uint32_t pushed) {
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    kit_floor(&world);
    kit_box(&world, kit_vec(0.0f, 0.5f, 0.0f), 0.5f);
    talus_body ball = kit_ball(&world, kit_vec(3.0f, 2.0f, 0.0f), 0.4f);
    tape_begin(t, &world, 4096);
    for (uint32_t step = 1; step <= 40; step++) {
        if (step == pushed) {
            OK(talus_body_apply_impulse(&world, ball, kit_vec(1.0f, 0.0f, 0.0f), kit_vec(3.0f, 2.0f, 0.0f)));
        }
        tape_step(t, &world);
    }
    tape_end(t, &world);
    kit_end(&world);
}

static void other_commands_are_named(void **state) {
    (void)state;
    tape a, b;
    record_pushed(&a, 0);
    record_pushed(&b, 17);
    write_bytes(A, (const char *)a.bytes, a.size);
    write_bytes(B, (const char *)b.bytes, b.size);
    remove(SUMMARY);
    assert_int_equal(run(tool_diff, "diff " A " " B " --quiet --summary " SUMMARY), TOOL_DIVERGED);
    has(SUMMARY, "| first step that parts | 17 |");
    has(SUMMARY, "its commands differ: world_step and body_apply_impulse");
    has(SUMMARY, "of body 2");
    tape_free(&a);
    tape_free(&b);
}

/* A recording of a machine that errs: one hash of step 23 is another, all checksums are right. */
static void machines_that_err_are_named(void **state) {
    (void)state;
    tape a;
    record_pushed(&a, 0);
    write_bytes(A, (const char *)a.bytes, a.size);
    for (size_t at = TL_RECORD_HEAD; at < a.size;) {
        unsigned char *chunk = a.bytes + at, *payload = chunk + TL_CHUNK_HEAD;
        uint32_t bytes = tl_get_word(chunk + 4);
        if (tl_get_word(chunk) == TL_CHUNK_STEP && tl_get_word(chunk + 8) == 23u) {
            unsigned char *mask = payload + 12u + tl_get_word(payload);
            assert_true(tl_get_word(mask) & 8u); /* body_velocity, after counts and body_pose */
            mask[8u + 4u * 2u] ^= 1u;
            tl_put_word(chunk + 12, tl_record_checksum(payload, bytes));
            tl_put_word(chunk + 16, tl_record_checksum(chunk, 16));
        }
        at += TL_CHUNK_HEAD + bytes;
    }
    write_bytes(B, (const char *)a.bytes, a.size);
    remove(SUMMARY);
    assert_int_equal(run(tool_replay, "replay " B " --quiet --summary " SUMMARY), TOOL_DIVERGED);
    has(SUMMARY, "| first step that parts | 23 |");
    has(SUMMARY, "| stage | commit |");
    has(SUMMARY, "| column | body_velocity |");
    remove(SUMMARY);
    assert_int_equal(run(tool_diff, "diff " A " " B " --quiet --summary " SUMMARY), TOOL_DIVERGED);
    has(SUMMARY, "| first step that parts | 23 |");
    has(SUMMARY, "| column | body_velocity |");
    has(SUMMARY, "here " B " replays otherwise than recorded from step 23 on, body_velocity");
    tape_free(&a);
}

static int clean_up(void **state) {
    (void)state;
    remove(A);
    remove(B);
    remove(SUMMARY);
    remove(JUNIT);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_what_is_planted),
        cmocka_unit_test(same_runs_are_the_same),
        cmocka_unit_test(trouble_is_named),
        cmocka_unit_test(other_commands_are_named),
        cmocka_unit_test(machines_that_err_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, clean_up);
}
