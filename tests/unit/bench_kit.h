/* What the tests of `talus bench` share: its texts read back. */
#ifndef BENCH_KIT_H
#define BENCH_KIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gltf/text.h"

#include <cjson/cJSON.h>
#include <string.h>

static inline cJSON *bench_parsed(const gltf_text *text) {
    assert_false(text->failed);
    cJSON *root = cJSON_Parse(text->data);
    assert_non_null(root);
    return root;
}

/* The dots of a whole SVG in which no number is none. */
static inline int bench_dots(const gltf_text *text) {
    int dots = 0;
    assert_false(text->failed);
    assert_int_equal(strncmp(text->data, "<svg ", 5), 0);
    assert_string_equal(text->data + text->size - 7, "</svg>\n");
    assert_null(strstr(text->data, "nan"));
    assert_null(strstr(text->data, "inf"));
    for (const char *at = text->data; (at = strstr(at, "<circle")) != NULL; at++) {
        dots++;
    }
    return dots;
}

#endif
