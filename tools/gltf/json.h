/* Checked reading of JSON. Each place knows its path, so that whatever is wrong is told with its place. After the first
 * error every reader returns its fallback: a caller may look once, at the end. */
#ifndef TALUS_GLTF_JSON_H
#define TALUS_GLTF_JSON_H

#include "gltf/error.h"

#include <cjson/cJSON.h>

/* A place in the document. Lives on the reader's stack, and must not outlive the place above it. */
typedef struct gltf_at {
    const struct gltf_at *up; /* null: the document */
    const char *key;          /* null: an element of an array */
    int index;
    const cJSON *json; /* null: nothing is there */
    gltf_error *error;
} gltf_at;

/* An array with its elements at hand: cJSON's own are a linked list. */
typedef struct gltf_list {
    gltf_at at;
    const cJSON **items;
    int count; /* 0 where nothing is there */
} gltf_list;

void gltf_fail(const gltf_at *at, gltf_status status, const char *format, ...) GLTF_PRINTF(3, 4);
int gltf_failed(const gltf_at *at);

gltf_at gltf_member(const gltf_at *object, const char *key);
gltf_at gltf_element(const gltf_at *array, int index, const cJSON *item);
int gltf_has(const gltf_at *object, const char *key);

/* Lists are freed by gltf_list_close, after errors as well. */
gltf_list gltf_list_open(const gltf_at *object, const char *key);
gltf_at gltf_list_item(const gltf_list *list, int index);
void gltf_list_close(gltf_list *list);

/* A number in [low, high]; `fallback` if it is not there. */
double gltf_number(const gltf_at *object, const char *key, double fallback, double low, double high);
/* The value of a place itself. */
double gltf_number_here(const gltf_at *at, double low, double high);
int gltf_flag(const gltf_at *object, const char *key, int fallback);
/* A whole number in [0, highest]; `fallback` if it is not there. */
double gltf_whole(const gltf_at *object, const char *key, double fallback, double highest);
/* An index into a list of `count` things called `things`; -1 if it is not there. */
int gltf_index(const gltf_at *object, const char *key, int count, const char *things);
int gltf_index_here(const gltf_at *at, int count, const char *things);
/* The text, or null if it is not there. */
const char *gltf_string(const gltf_at *object, const char *key);
/* Which of `count` words it is; `fallback` if it is not there. */
int gltf_choice(const gltf_at *object, const char *key, const char *const *words, int count, int fallback);
/* `count` numbers of at most `bound` either way; returns 0 and leaves `out` as it is if they are not there. */
int gltf_numbers(const gltf_at *object, const char *key, double *out, int count, double bound);

#endif
