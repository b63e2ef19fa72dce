#include "gltf/json.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void append(char *text, size_t size, const char *more) {
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s", more);
}

/* Control bytes would reach the terminal of whoever reads the message. */
static void make_printable(char *text) {
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        if (c < 32 || c == 127) {
            *text = '?';
        }
    }
}

void gltf_error_set(gltf_error *error, gltf_status status, const char *format, ...) {
    if (error->status != GLTF_OK) {
        return;
    }
    error->status = status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    make_printable(error->text);
}

static void write_path(const gltf_at *at, char *text, size_t size) {
    const gltf_at *places[24]; /* deeper than any place that is read */
    int depth = 0;
    for (; at->up != NULL && depth < 24; at = at->up) {
        places[depth++] = at;
    }
    append(text, size, "$");
    while (depth-- > 0) {
        char step[96];
        if (places[depth]->key != NULL) {
            snprintf(step, sizeof step, ".%s", places[depth]->key);
        } else {
            snprintf(step, sizeof step, "[%d]", places[depth]->index);
        }
        append(text, size, step);
    }
}

void gltf_fail(const gltf_at *at, gltf_status status, const char *format, ...) {
    if (at->error->status != GLTF_OK) {
        return;
    }
    at->error->status = status;
    char *text = at->error->text;
    size_t size = sizeof at->error->text;
    text[0] = 0;
    write_path(at, text, size);
    append(text, size, ": ");
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
    make_printable(text);
}

int gltf_failed(const gltf_at *at) { return at->error->status != GLTF_OK; }

/* What stands at a place, for a message. */
static const char *describe(const cJSON *json, char *text, size_t size) {
    if (json == NULL) {
        snprintf(text, size, "is missing");
    } else if (cJSON_IsNumber(json)) {
        snprintf(text, size, "is %.9g", json->valuedouble);
    } else if (cJSON_IsString(json)) {
        snprintf(text, size, "is \"%.40s%s\"", json->valuestring, strlen(json->valuestring) > 40 ? "..." : "");
    } else if (cJSON_IsBool(json)) {
        snprintf(text, size, "is %s", cJSON_IsTrue(json) ? "true" : "false");
    } else {
        snprintf(text, size, "is %s", cJSON_IsObject(json) ? "an object" : cJSON_IsArray(json) ? "an array" : "null");
    }
    return text;
}

gltf_at gltf_member(const gltf_at *object, const char *key) {
    gltf_at at = {object, key, 0, NULL, object->error};
    if (object->json == NULL || gltf_failed(object)) {
        return at;
    }
    if (!cJSON_IsObject(object->json)) {
        char found[64];
        gltf_fail(object, GLTF_BROKEN, "%s, must be an object", describe(object->json, found, sizeof found));
        return at;
    }
    at.json = cJSON_GetObjectItemCaseSensitive(object->json, key);
    return at;
}

gltf_at gltf_element(const gltf_at *array, int index, const cJSON *item) {
    gltf_at at = {array, NULL, index, item, array->error};
    return at;
}

int gltf_has(const gltf_at *object, const char *key) { return gltf_member(object, key).json != NULL; }

/* The number of elements; -1 and an error if it is no array. */
static int count_elements(const gltf_at *at) {
    if (!cJSON_IsArray(at->json)) {
        char found[64];
        gltf_fail(at, GLTF_BROKEN, "%s, must be an array", describe(at->json, found, sizeof found));
        return -1;
    }
    return cJSON_GetArraySize(at->json);
}

gltf_list gltf_list_open(const gltf_at *object, const char *key) {
    gltf_list list = {gltf_member(object, key), NULL, 0};
    if (list.at.json == NULL || gltf_failed(object)) {
        return list;
    }
    int count = count_elements(&list.at);
    if (count <= 0) {
        return list;
    }
    list.items = malloc((size_t)count * sizeof *list.items);
    if (list.items == NULL) {
        gltf_fail(&list.at, GLTF_FAILED, "there is no memory for its %d elements", count);
        return list;
    }
    list.count = count;
    int i = 0;
    for (const cJSON *item = list.at.json->child; item != NULL && i < count; item = item->next) {
        list.items[i++] = item;
    }
    return list;
}

gltf_at gltf_list_item(const gltf_list *list, int index) { return gltf_element(&list->at, index, list->items[index]); }

void gltf_list_close(gltf_list *list) {
    free(list->items);
    list->items = NULL;
    list->count = 0;
}

double gltf_number_here(const gltf_at *at, double low, double high) {
    if (gltf_failed(at)) {
        return low;
    }
    char found[64];
    if (!cJSON_IsNumber(at->json)) {
        gltf_fail(at, GLTF_BROKEN, "%s, must be a number", describe(at->json, found, sizeof found));
        return low;
    }
    double value = at->json->valuedouble;
    if (!(value >= low && value <= high)) { /* a NaN as well */
        gltf_fail(at, GLTF_BROKEN, "%s, must be from %.9g to %.9g", describe(at->json, found, sizeof found), low, high);
        return low;
    }
    return value;
}

double gltf_number(const gltf_at *object, const char *key, double fallback, double low, double high) {
    gltf_at at = gltf_member(object, key);
    return at.json == NULL ? fallback : gltf_number_here(&at, low, high);
}

int gltf_flag(const gltf_at *object, const char *key, int fallback) {
    gltf_at at = gltf_member(object, key);
    if (at.json == NULL || gltf_failed(object)) {
        return fallback;
    }
    if (!cJSON_IsBool(at.json)) {
        char found[64];
        gltf_fail(&at, GLTF_BROKEN, "%s, must be true or false", describe(at.json, found, sizeof found));
        return fallback;
    }
    return cJSON_IsTrue(at.json);
}

static double whole_here(const gltf_at *at, double highest) {
    double value = gltf_number_here(at, 0, highest);
    if (!gltf_failed(at) && value != floor(value)) {
        gltf_fail(at, GLTF_BROKEN, "is %.9g, must be a whole number", value);
        return 0;
    }
    return value;
}

double gltf_whole(const gltf_at *object, const char *key, double fallback, double highest) {
    gltf_at at = gltf_member(object, key);
    return at.json == NULL ? fallback : whole_here(&at, highest);
}

int gltf_index_here(const gltf_at *at, int count, const char *things) {
    if (gltf_failed(at)) {
        return -1;
    }
    double value = whole_here(at, INT_MAX);
    if (gltf_failed(at)) {
        return -1;
    }
    if (value >= count) {
        gltf_fail(at, GLTF_BROKEN, "is %.9g, but the file has %d %s", value, count, things);
        return -1;
    }
    return (int)value;
}

int gltf_index(const gltf_at *object, const char *key, int count, const char *things) {
    gltf_at at = gltf_member(object, key);
    return at.json == NULL ? -1 : gltf_index_here(&at, count, things);
}

const char *gltf_string(const gltf_at *object, const char *key) {
    gltf_at at = gltf_member(object, key);
    if (at.json == NULL || gltf_failed(object)) {
        return NULL;
    }
    if (!cJSON_IsString(at.json)) {
        char found[64];
        gltf_fail(&at, GLTF_BROKEN, "%s, must be a text", describe(at.json, found, sizeof found));
        return NULL;
    }
    return at.json->valuestring;
}

int gltf_choice(const gltf_at *object, const char *key, const char *const *words, int count, int fallback) {
    const char *text = gltf_string(object, key);
    if (text == NULL) {
        return fallback;
    }
    char allowed[160] = "";
    for (int i = 0; i < count; i++) {
        if (strcmp(text, words[i]) == 0) {
            return i;
        }
        append(allowed, sizeof allowed, i == 0 ? "\"" : i + 1 < count ? "\", \"" : "\" or \"");
        append(allowed, sizeof allowed, words[i]);
    }
    gltf_at at = gltf_member(object, key);
    char found[64];
    gltf_fail(&at, GLTF_BROKEN, "%s, must be %s\"", describe(at.json, found, sizeof found), allowed);
    return fallback;
}

int gltf_numbers(const gltf_at *object, const char *key, double *out, int count, double bound) {
    gltf_at at = gltf_member(object, key);
    if (at.json == NULL || gltf_failed(object)) {
        return 0;
    }
    int found = count_elements(&at);
    if (found < 0) {
        return 0;
    }
    if (found != count) {
        gltf_fail(&at, GLTF_BROKEN, "has %d elements, must have %d", found, count);
        return 0;
    }
    int i = 0;
    for (const cJSON *item = at.json->child; item != NULL && i < count; item = item->next, i++) {
        gltf_at element = gltf_element(&at, i, item);
        double value = gltf_number_here(&element, -bound, bound);
        if (gltf_failed(&at)) {
            return 0;
        }
        out[i] = value;
    }
    return 1;
}
