/* The state of a world as a list of columns: two that stand for the header, then those that columns.h calls STATE. What
 * recordings hash, write and compare. */
#ifndef TL_STATE_H
#define TL_STATE_H

#include "stage/store/store.h"
#include "talus/record.h"

/* Only the columns of the state make an entry. */
#define TL_STATE_ONLY_STATE(...) __VA_ARGS__
#define TL_STATE_ONLY_INDEX(...)
#define TL_STATE_ONLY_STEP(...)

typedef enum tl_state_id {
    TL_STATE_settings, /* of the definition, and the last step's length */
    TL_STATE_counts,   /* of rows in use, list heads, steps */
#define X(name, type, count, stage, life, word) TL_STATE_ONLY_##life(TL_STATE_##name, )
    TL_COLUMNS(X)
#undef X
        TL_STATE_COUNT
} tl_state_id;

/* The rows in use. */
tl_live tl_state_rows(const tl_header *h, uint32_t column);

/* A 32-bit hash of each column, the same in either byte order. One pass over the rows in use. */
void tl_state_hashes(const tl_header *h, uint32_t out[TL_STATE_COUNT]);
/* The same of what a step may have changed: the rows of bodies, contacts and joints that are awake, or all rows where
 * half of them are; 0 for the columns that commands write. */
void tl_state_active_hashes(const tl_header *h, uint32_t out[TL_STATE_COUNT]);

/* A number that changes with the names, the order and the sizes of the columns. */
uint32_t tl_state_layout(void);

#endif
