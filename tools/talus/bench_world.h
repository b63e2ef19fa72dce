/* What `talus bench queries` asks a whole world: a pile of boxes that has come to rest. */
#ifndef TALUS_TOOL_BENCH_WORLD_H
#define TALUS_TOOL_BENCH_WORLD_H

#include "gltf/text.h"

#include <stdint.h>

#define BENCH_WORLD_ROWS 10

typedef struct bench_world_row {
    const char *name, *label;
    double least, median, spread; /* ns a query: of the runs; the spread is that between quartiles */
    double found;                 /* shapes a query */
    double wrong;                 /* share of the answers with other shapes than asking each shape alone has */
    double most_error;            /* m: of where, against the same */
} bench_world_row;

typedef struct bench_world_table {
    bench_world_row rows[BENCH_WORLD_ROWS];
    uint32_t count, boxes, runs;
} bench_world_table;

/* 0, or -1 where the world could not be made or a query fails. */
int bench_world_take(bench_world_table *table, int quick);
void bench_world_print(const bench_world_table *table, gltf_text *out);
void bench_world_json(const bench_world_table *table, gltf_text *out); /* `"world":{...}` */

#endif
