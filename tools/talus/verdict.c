#define _POSIX_C_SOURCE 200809L
#include "verdict.h"

#include "gltf/text.h"
#include "host/file.h"
#include "tool.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

void verdict_take_option(int option, const char *text, verdict_options *out) {
    switch (option) {
    case VERDICT_JSON:
        out->json = 1;
        break;
    case VERDICT_SUMMARY:
        out->summary = text;
        break;
    case VERDICT_JUNIT:
        out->junit = text;
        break;
    default:
        out->quiet = 1;
        break;
    }
}

void verdict_take_columns(verdict *v, uint64_t columns, int commands) {
    talus_column_get(talus_column_first(columns, commands), &v->column);
    v->columns = 0;
    for (; columns != 0; columns &= columns - 1) {
        v->columns++;
    }
}

static const char *const row_names[] = {"world", "body", "shape", "node", "contact", "joint", "entry"};

/* A word as its bits and, where it has four bytes, as the float they may be. */
static void describe_value(const verdict *v, int side, char *out, size_t room) {
    uint64_t bits = v->parting.value[side];
    if (v->parting.column.word_bytes == 8) {
        snprintf(out, room, "0x%016" PRIx64, bits);
        return;
    }
    uint32_t word = (uint32_t)bits;
    float number;
    memcpy(&number, &word, sizeof number);
    snprintf(out, room, "0x%08" PRIx32 " (%.9g)", word, (double)number);
}

static void describe_place(const verdict *v, char *out, size_t room) {
    const talus_parting *p = &v->parting;
    int used = snprintf(out, room, "%s", v->column.name);
    if (!v->has_values) {
        return;
    }
    if (p->column.rows != TALUS_ROW_OF_WORLD) {
        used += snprintf(out + used, room - (size_t)used, " of %s %" PRIu32, row_names[p->column.rows], p->row);
    }
    if (p->column.rows != TALUS_ROW_OF_BODY && p->body_a.generation != 0) {
        used += snprintf(out + used, room - (size_t)used, " (body %" PRIu32, p->body_a.index);
        if (p->body_b.generation != 0) {
            used += snprintf(out + used, room - (size_t)used, " and body %" PRIu32, p->body_b.index);
        }
        used += snprintf(out + used, room - (size_t)used, ")");
    }
    snprintf(out + used, room - (size_t)used, ", word %" PRIu32, p->word);
}

void verdict_describe(const verdict *v, char *out, size_t room) {
    char place[256], a[64], b[64];
    describe_place(v, place, sizeof place);
    int used = snprintf(out, room, "step %" PRIu32 ": stage %s, %s", v->step, talus_stage_name(v->column.stage), place);
    if (v->has_values && v->parting.rows[0] != v->parting.rows[1]) {
        used += snprintf(out + used, room - (size_t)used, ": %" PRIu32 " and %" PRIu32 " rows in use",
                         v->parting.rows[0], v->parting.rows[1]);
    } else if (v->has_values) {
        describe_value(v, 0, a, sizeof a);
        describe_value(v, 1, b, sizeof b);
        used += snprintf(out + used, room - (size_t)used, ": %s and %s", a, b);
    }
    snprintf(out + used, room - (size_t)used, "; %" PRIu32 " column%s part%s", v->columns, v->columns == 1 ? "" : "s",
             v->columns == 1 ? "s" : "");
}

static const char *word_of(const verdict *v) {
    return v->status == 0               ? "same"
           : v->status == TOOL_DIVERGED ? "diverged"
           : v->status == TOOL_SHORTER  ? "same, but shorter"
                                        : "failed";
}

/* --- for programs --- */

static void add_json(gltf_text *out, const verdict *v) {
    const talus_parting *p = &v->parting;
    gltf_text_add(out, "{\"subcommand\":\"%s\",\"a\":", v->subcommand);
    gltf_text_quoted(out, v->a);
    if (v->b != NULL) {
        gltf_text_add(out, ",\"b\":");
        gltf_text_quoted(out, v->b);
    }
    gltf_text_add(out, ",\"verdict\":\"%s\",\"status\":%d,\"steps_same\":%" PRIu32 ",\"seconds\":%.6g", word_of(v),
                  v->status, v->steps, v->seconds);
    if (v->status == TOOL_DIVERGED) {
        gltf_text_add(out, ",\"step\":%" PRIu32 ",\"stage\":\"%s\",\"column\":\"%s\",\"columns\":%" PRIu32, v->step,
                      talus_stage_name(v->column.stage), v->column.name, v->columns);
    }
    if (v->has_values) {
        char a[64], b[64];
        describe_value(v, 0, a, sizeof a);
        describe_value(v, 1, b, sizeof b);
        gltf_text_add(out, ",\"rows_of\":\"%s\",\"row\":%" PRIu32 ",\"word\":%" PRIu32, row_names[p->column.rows],
                      p->row, p->word);
        gltf_text_add(out, ",\"bodies\":[");
        if (p->body_a.generation != 0) {
            gltf_text_add(out, "{\"body\":%" PRIu32 ",\"user_data\":%" PRIu64 "}", p->body_a.index, p->user_data_a);
        }
        if (p->body_b.generation != 0) {
            gltf_text_add(out, ",{\"body\":%" PRIu32 ",\"user_data\":%" PRIu64 "}", p->body_b.index, p->user_data_b);
        }
        gltf_text_add(out, "],\"value_a\":\"%s\",\"value_b\":\"%s\"", a, b);
        gltf_text_add(out, ",\"rows_a\":%" PRIu32 ",\"rows_b\":%" PRIu32, p->rows[0], p->rows[1]);
    }
    gltf_text_add(out, ",\"text\":");
    gltf_text_quoted(out, v->text);
    gltf_text_add(out, "}");
}

/* Text inside of XML, or of a Markdown table where `table` is not zero. */
static void add_escaped(gltf_text *out, const char *text, int table) {
    for (; *text != 0; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '&' || c == '<' || c == '>' || c == '"' || (table && (c == '|' || c == '`'))) {
            gltf_text_add(out, "&#%u;", c);
        } else if (c < 32) {
            gltf_text_add(out, " ");
        } else {
            gltf_text_bytes(out, text, 1);
        }
    }
}

static void add_row(gltf_text *out, const char *name, const char *text) {
    gltf_text_add(out, "| %s | ", name);
    add_escaped(out, text, 1);
    gltf_text_add(out, " |\n");
}

static void add_markdown(gltf_text *out, const verdict *v) {
    char text[256];
    gltf_text_add(out, "### talus %s: %s\n\n| | |\n| --- | --- |\n", v->subcommand, word_of(v));
    add_row(out, v->b != NULL ? "A" : "recording", v->a);
    if (v->b != NULL) {
        add_row(out, "B", v->b);
    }
    snprintf(text, sizeof text, "%" PRIu32, v->steps);
    add_row(out, "steps that are the same", text);
    if (v->status == TOOL_DIVERGED) {
        snprintf(text, sizeof text, "%" PRIu32, v->step);
        add_row(out, "first step that parts", text);
        add_row(out, "stage", talus_stage_name(v->column.stage));
        describe_place(v, text, sizeof text);
        add_row(out, "column", text);
    }
    if (v->has_values && v->parting.rows[0] == v->parting.rows[1]) {
        describe_value(v, 0, text, sizeof text);
        add_row(out, "value in A", text);
        describe_value(v, 1, text, sizeof text);
        add_row(out, "value in B", text);
    }
    add_row(out, "in words", v->text);
    gltf_text_add(out, "\n");
}

static void add_junit(gltf_text *out, const verdict *v) {
    int failed = v->status == TOOL_DIVERGED || v->status == TOOL_SHORTER, broken = v->status != 0 && !failed;
    gltf_text_add(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    gltf_text_add(out, "<testsuite name=\"talus\" tests=\"1\" failures=\"%d\" errors=\"%d\" time=\"%.3f\">\n", failed,
                  broken, v->seconds);
    gltf_text_add(out, "  <testcase classname=\"talus.%s\" name=\"", v->subcommand);
    add_escaped(out, v->a, 0);
    if (v->b != NULL) {
        gltf_text_add(out, " ");
        add_escaped(out, v->b, 0);
    }
    gltf_text_add(out, "\" time=\"%.3f\">", v->seconds);
    if (failed || broken) {
        gltf_text_add(out, "\n    <%s message=\"", failed ? "failure" : "error");
        add_escaped(out, v->text, 0);
        gltf_text_add(out, "\"/>\n  ");
    }
    gltf_text_add(out, "</testcase>\n</testsuite>\n");
}

/* --- telling --- */

static int write_text(const char *path, const gltf_text *text, const char *mode) {
    FILE *file = fopen(path, mode);
    int failed = file == NULL || fwrite(text->data, 1, text->size, file) != text->size;
    int reason = errno;
    if (file != NULL && fclose(file) != 0 && !failed) {
        failed = 1;
        reason = errno;
    }
    return failed ? tool_fail(GLTF_FAILED, "%s: %s", path, strerror(reason)) : 0;
}

int verdict_tell(const verdict *v, const verdict_options *options) {
    gltf_text text[3] = {{NULL, 0, 0, 0}, {NULL, 0, 0, 0}, {NULL, 0, 0, 0}};
    int status = v->status, trouble = 0;
    add_json(&text[0], v);
    add_markdown(&text[1], v);
    add_junit(&text[2], v);
    if (text[0].failed || text[1].failed || text[2].failed) {
        trouble = tool_fail(GLTF_FAILED, "there is no memory for the report");
    } else {
        if (options->json) {
            puts(text[0].data);
        } else if (status != 0 && status != TOOL_DIVERGED && status != TOOL_SHORTER) {
            tool_fail(status, "%s", v->text);
        } else if (!options->quiet || status != 0) {
            puts(v->text);
        }
        /* A job's summary grows by what each step of the job adds to it. */
        trouble = options->summary != NULL ? write_text(options->summary, &text[1], "ab") : 0;
        if (options->junit != NULL) {
            int other = write_text(options->junit, &text[2], "wb");
            trouble = trouble != 0 ? trouble : other;
        }
    }
    for (int i = 0; i < 3; i++) {
        gltf_text_free(&text[i]);
    }
    return status != 0 ? status : trouble;
}
