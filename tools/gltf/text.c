#include "gltf/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *reserve(gltf_text *text, size_t more) {
    if (text->failed || more > (size_t)-1 / 4 - text->size) {
        text->failed = 1;
        return NULL;
    }
    if (text->size + more + 1 > text->room) {
        size_t room = (text->size + more + 1) * 2;
        char *data = realloc(text->data, room);
        if (data == NULL) {
            text->failed = 1;
            return NULL;
        }
        text->data = data;
        text->room = room;
    }
    return text->data + text->size;
}

void gltf_text_add(gltf_text *text, const char *format, ...) {
    char small[256];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(small, sizeof small, format, arguments);
    va_end(arguments);
    if (length < 0) {
        text->failed = 1;
    } else if ((size_t)length < sizeof small) {
        gltf_text_bytes(text, small, (size_t)length);
    } else if (reserve(text, (size_t)length) != NULL) {
        va_start(arguments, format);
        vsnprintf(text->data + text->size, (size_t)length + 1, format, arguments);
        va_end(arguments);
        text->size += (size_t)length;
    }
}

void gltf_text_bytes(gltf_text *text, const void *bytes, size_t size) {
    char *end = reserve(text, size);
    if (end != NULL) {
        memcpy(end, bytes, size);
        end[size] = 0;
        text->size += size;
    }
}

void gltf_text_quoted(gltf_text *text, const char *string) {
    gltf_text_bytes(text, "\"", 1);
    for (; *string; string++) {
        unsigned char c = (unsigned char)*string;
        if (c == '"' || c == '\\') {
            gltf_text_add(text, "\\%c", c);
        } else if (c < 32) {
            gltf_text_add(text, "\\u%04x", c);
        } else {
            gltf_text_bytes(text, string, 1);
        }
    }
    gltf_text_bytes(text, "\"", 1);
}

void gltf_text_base64(gltf_text *text, const void *bytes, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *p = bytes;
    for (size_t i = 0; i < size; i += 3) {
        unsigned a = p[i], b = i + 1 < size ? p[i + 1] : 0, c = i + 2 < size ? p[i + 2] : 0;
        char four[4] = {digits[a >> 2], digits[(a & 3) << 4 | b >> 4],
                        i + 1 < size ? digits[(b & 15) << 2 | c >> 6] : '=', i + 2 < size ? digits[c & 63] : '='};
        gltf_text_bytes(text, four, 4);
    }
}

void gltf_text_free(gltf_text *text) {
    free(text->data);
    memset(text, 0, sizeof *text);
}
