/* A file of its own: tests put one in its place that keeps the message. */
#include "tool.h"

#include <stdarg.h>
#include <stdio.h>

int tool_fail(int status, const char *format, ...) {
    va_list arguments;
    fputs("talus: ", stderr);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    return status;
}
