/* The layout of the block, and what is said of whole blocks: hash, first difference. */
#include "stage/store/store.h"

#include <string.h>

#include "base/bits.h"
#include "stage/store/hash.h"

typedef enum life { LIFE_STATE, LIFE_INDEX, LIFE_STEP } life;

typedef struct column_info {
    const char *name;
    uint32_t row_bytes, word, count, life;
} column_info;

static const column_info COLUMNS[TL_COLUMN_COUNT] = {
#define X(name, type, count, stage, life, word) {#name, sizeof(type), word, TL_COUNT_##count, LIFE_##life},
    TL_COLUMNS(X)
#undef X
};

static uint32_t power_of_two_from(uint32_t n) {
    uint32_t p = 8u;
    while (p < n) {
        p *= 2u;
    }
    return p;
}

/* Groups of eight: full ones, one that is not full for each colour, and room for contacts beyond the last colour, which
 * may have to stand alone. */
static uint32_t group_capacity(uint32_t contacts) { return contacts / TL_LANES + TL_COLORS + contacts / 16u; }

uint32_t tl_store_layout(const talus_world_def *def, uint32_t capacity[TL_COUNT_COUNT],
                         uint32_t offset[TL_COLUMN_COUNT]) {
    capacity[TL_COUNT_BODY] = def->body_capacity + 1u; /* the ground is body 0 */
    capacity[TL_COUNT_SHAPE] = def->shape_capacity;
    capacity[TL_COUNT_NODE] = 2u * def->shape_capacity;
    capacity[TL_COUNT_PAIR] = (1u + TL_APART_PER_CONTACT) * def->contact_capacity;
    capacity[TL_COUNT_SLOT] = power_of_two_from(2u * capacity[TL_COUNT_PAIR]);
    capacity[TL_COUNT_CONTACT] = def->contact_capacity;
    capacity[TL_COUNT_CONTACTBIT] = tl_bit_words(def->contact_capacity);
    capacity[TL_COUNT_JOINTBIT] = tl_bit_words(def->joint_capacity);
    capacity[TL_COUNT_JOINT] = def->joint_capacity;
    capacity[TL_COUNT_ROW] = (def->body_capacity + 1u + TL_LANES) / TL_LANES * TL_LANES + TL_LANES;
    capacity[TL_COUNT_GROUP] = group_capacity(def->contact_capacity);
    capacity[TL_COUNT_JOINTGROUP] = def->joint_capacity;
    capacity[TL_COUNT_JOINTROW] = def->joint_capacity * 6u + TL_JOINT_ROWS;
    capacity[TL_COUNT_LINKNODE] = 2u * def->joint_capacity;
    capacity[TL_COUNT_LINKBLOCK] = def->joint_capacity * TL_LINK_BLOCKS;
    capacity[TL_COUNT_LINKVALUE] = def->joint_capacity * TL_LINK_VALUES;
    capacity[TL_COUNT_LINKSCRATCH] = TL_BLOCK_SCRATCH(def->joint_capacity, def->joint_capacity + 1u);
    capacity[TL_COUNT_PRESSED] = def->contact_capacity < TL_MOST_PRESSED ? def->contact_capacity : TL_MOST_PRESSED;
    capacity[TL_COUNT_PRESSBLOCK] = capacity[TL_COUNT_PRESSED] * TL_PRESS_BLOCKS;
    capacity[TL_COUNT_PRESSVALUE] = capacity[TL_COUNT_PRESSED] * TL_PRESS_VALUES;
    capacity[TL_COUNT_DEFINITION] = (def->body_capacity + 1u + def->shape_capacity) * TL_DEFINITION_WORDS;
    capacity[TL_COUNT_EVENT] = def->event_capacity;
#ifdef TALUS_NO_PROFILE
    capacity[TL_COUNT_FRAME] = 0;
#else
    capacity[TL_COUNT_FRAME] = def->profile_capacity;
#endif
    capacity[TL_COUNT_TALLY] = capacity[TL_COUNT_FRAME] ? capacity[TL_COUNT_ROW] : 0u;
    uint64_t unit = (sizeof(tl_header) + TL_UNIT - 1u) / TL_UNIT;
    for (uint32_t i = 0; i < TL_COLUMN_COUNT; i++) {
        offset[i] = (uint32_t)unit;
        unit += ((uint64_t)COLUMNS[i].row_bytes * capacity[COLUMNS[i].count] + TL_UNIT - 1u) / TL_UNIT;
        if (unit > 0xfffffff0u) {
            return 0;
        }
    }
    return (uint32_t)unit;
}

uint32_t tl_pool_top(const tl_pool *pool, uint32_t capacity) {
    if (pool->free != TL_NONE) {
        return pool->free;
    }
    return pool->high < capacity ? pool->high : TL_NONE;
}

int tl_world_is_sound(const talus_world *world) {
    if (!world || !world->block || (uintptr_t)world->block % TALUS_BLOCK_ALIGNMENT) {
        return 0;
    }
    const tl_header *h = tl_header_of(world);
    return h->magic == TL_BLOCK_MAGIC && h->version == TL_BLOCK_VERSION;
}

uint32_t tl_store_live(const tl_header *h, tl_column_id column) {
    switch (COLUMNS[column].count) {
    case TL_COUNT_BODY:
        return h->bodies.high;
    case TL_COUNT_SHAPE:
        return h->shapes.high;
    case TL_COUNT_CONTACT:
        return h->contacts.high;
    case TL_COUNT_JOINT:
        return h->joints.high;
    default:
        return 0;
    }
}

static const unsigned char *column_bytes(const tl_header *h, uint32_t column) {
    return (const unsigned char *)h + (size_t)h->offset[column] * TL_UNIT;
}

int tl_store_state(const tl_header *h, tl_column_id column, tl_live *out) {
    if (COLUMNS[column].life != LIFE_STATE) {
        return 0;
    }
    out->rows = tl_store_live(h, column);
    out->row_bytes = COLUMNS[column].row_bytes;
    out->word = COLUMNS[column].word;
    out->data = (unsigned char *)(uintptr_t)column_bytes(h, column);
    return 1;
}

uint64_t talus_world_hash(const talus_world *world) {
    if (!tl_world_is_sound(world)) {
        return 0;
    }
    const tl_header *h = tl_header_of(world);
    tl_hash hash = tl_hash_begin();
    tl_hash_words(&hash, &h->settings,
                  (size_t)((const unsigned char *)&h->end - (const unsigned char *)&h->settings) / 4u);
    for (uint32_t i = 0; i < TL_COLUMN_COUNT; i++) {
        if (COLUMNS[i].life != LIFE_STATE) {
            continue;
        }
        size_t words = (size_t)tl_store_live(h, (tl_column_id)i) * COLUMNS[i].row_bytes / COLUMNS[i].word;
        if (COLUMNS[i].word == 8u) {
            tl_hash_long_words(&hash, column_bytes(h, i), words);
        } else {
            tl_hash_words(&hash, column_bytes(h, i), words);
        }
    }
    return tl_hash_end(&hash);
}
