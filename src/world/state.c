/* The state as columns: hashing, writing, reading, comparing. */
#include "world/state.h"

#include <string.h>

#include "base/bits.h"
#include "world/command.h"
#include "world/world_internal.h"

typedef char columns_fit_a_mask[TL_STATE_COUNT <= TALUS_MAX_COLUMNS ? 1 : -1];

typedef struct column_info {
    const char *name;
    uint32_t column; /* tl_column_id */
    uint32_t count;  /* tl_count */
    uint32_t row_bytes, word;
    talus_stage stage;
} column_info;

#define NO_COLUMN TL_COLUMN_COUNT
#define SETTINGS_BYTES (uint32_t)sizeof(tl_settings)
#define COUNTS_BYTES (uint32_t)(offsetof(tl_header, end) - offsetof(tl_header, bodies))

static const column_info COLUMNS[TL_STATE_COUNT] = {
    {"settings", NO_COLUMN, TL_COUNT_COUNT, SETTINGS_BYTES, 4, TALUS_STAGE_COMMANDS},
    {"counts", NO_COLUMN, TL_COUNT_COUNT, COUNTS_BYTES, 4, TALUS_STAGE_COMMANDS},
#define X(name, type, count, stage, life, word)                                                                        \
    TL_STATE_ONLY_##life({#name, TL_COLUMN_##name, TL_COUNT_##count, sizeof(type), word, TALUS_STAGE_##stage}, )
    TL_COLUMNS(X)
#undef X
};

tl_live tl_state_rows(const tl_header *h, uint32_t column) {
    const column_info *c = &COLUMNS[column];
    tl_live live;
    if (c->column != NO_COLUMN) {
        tl_store_state(h, (tl_column_id)c->column, &live);
        return live;
    }
    const void *data = column == TL_STATE_settings ? (const void *)&h->settings : (const void *)&h->bodies;
    live.data = (unsigned char *)(uintptr_t)data;
    live.rows = 1;
    live.row_bytes = c->row_bytes;
    live.word = c->word;
    return live;
}

static talus_row_kind rows_of(const column_info *c) {
    switch (c->count) {
    case TL_COUNT_BODY:
        return TALUS_ROW_OF_BODY;
    case TL_COUNT_SHAPE:
        return TALUS_ROW_OF_SHAPE;
    case TL_COUNT_CONTACT:
        return TALUS_ROW_OF_CONTACT;
    case TL_COUNT_JOINT:
        return TALUS_ROW_OF_JOINT;
    default:
        return TALUS_ROW_OF_WORLD;
    }
}

/* --- hashes ----------------------------------------------------------------------------------- */

/* Sixteen streams of 32 bits, each taking every sixteenth word as h <- 9 rotl(h xor w, 7): four simple operations that
 * compilers run lanes wide. Every step is one to one in h and in w, so that a single word that changes always changes
 * its stream. Not for use against an adversary. */
#define STREAMS 16u

typedef struct streams {
    uint32_t h[STREAMS];
} streams;

static streams begin_streams(void) {
    streams s;
    for (uint32_t k = 0; k < STREAMS; k++) {
        s.h[k] = (k + 1u) * 0x9e3779b1u;
    }
    return s;
}

static void add_block(uint32_t h[STREAMS], const uint32_t w[STREAMS]) {
    for (unsigned k = 0; k < STREAMS; k++) {
        uint32_t x = h[k] ^ w[k];
        x = x << 7 | x >> 25;
        h[k] = x + (x << 3);
    }
}

/* The blocks that are full and of words of four bytes: the loop that must be fast. */
static size_t add_full_blocks(streams *s, const unsigned char *p, size_t words) {
    uint32_t h[STREAMS], w[STREAMS];
    size_t i = 0;
    memcpy(h, s->h, sizeof h);
    for (; i + STREAMS <= words; i += STREAMS) {
        memcpy(w, p + 4u * i, sizeof w);
        add_block(h, w);
    }
    memcpy(s->h, h, sizeof h);
    return i;
}

/* Adds words, the last sixteen of them filled up with zeros; those of eight bytes lowest half first. */
static void add_words(streams *s, const unsigned char *p, size_t words, uint32_t word) {
    int swap = word == 8u && tl_high_byte_first();
    for (size_t i = swap ? 0 : add_full_blocks(s, p, words); i < words; i += STREAMS) {
        uint32_t w[STREAMS] = {0};
        memcpy(w, p + 4u * i, 4u * (words - i < STREAMS ? words - i : STREAMS));
        for (unsigned k = 0; swap && k < STREAMS; k += 2u) {
            uint32_t high = w[k];
            w[k] = w[k + 1u], w[k + 1u] = high;
        }
        add_block(s->h, w);
    }
}

static uint32_t end_streams(const streams *s, size_t words) {
    uint64_t h = words;
    for (unsigned k = 0; k < STREAMS; k++) {
        h = (h ^ s->h[k]) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
    }
    return (uint32_t)h;
}

static uint32_t hash_column(const tl_header *h, uint32_t column) {
    tl_live live = tl_state_rows(h, column);
    streams s = begin_streams();
    size_t words = (size_t)live.rows * live.row_bytes / 4u;
    add_words(&s, live.data, words, COLUMNS[column].word);
    return end_streams(&s, words);
}

void tl_state_hashes(const tl_header *h, uint32_t out[TL_STATE_COUNT]) {
    for (uint32_t i = 0; i < TL_STATE_COUNT; i++) {
        out[i] = hash_column(h, i);
    }
}

#define BATCH_BYTES 4096u

/* Puts the rows that a list names one after another. */
static void gather(unsigned char *to, const tl_live *from, const uint32_t *list, uint32_t count) {
#define GATHER(bytes)                                                                                                  \
    case bytes:                                                                                                        \
        for (uint32_t k = 0; k < count; k++) {                                                                         \
            memcpy(to + (size_t)k * (bytes), from->data + (size_t)list[k] * (bytes), bytes);                           \
        }                                                                                                              \
        break;
    switch (from->row_bytes) { /* copies of a length that the compiler knows */
        GATHER(4)
        GATHER(8)
        GATHER(16)
        GATHER(32)
        GATHER(128)
    default:
        for (uint32_t k = 0; k < count; k++) {
            memcpy(to + (size_t)k * from->row_bytes, from->data + (size_t)list[k] * from->row_bytes, from->row_bytes);
        }
        break;
    }
#undef GATHER
}

static uint32_t hash_listed_rows(const tl_header *h, uint32_t column, const uint32_t *list, uint32_t count) {
    unsigned char batch[BATCH_BYTES];
    tl_live live = tl_state_rows(h, column);
    if (count >= live.rows / 2u) { /* to run through all of them is faster */
        return hash_column(h, column);
    }
    streams s = begin_streams();
    uint32_t most = BATCH_BYTES / live.row_bytes;
    for (uint32_t k = 0; k < count; k += most) {
        uint32_t n = count - k < most ? count - k : most;
        gather(batch, &live, list + k, n);
        add_words(&s, batch, (size_t)n * live.row_bytes / 4u, COLUMNS[column].word);
    }
    return end_streams(&s, count);
}

/* The bodies that are awake, ascending, into island_parent; awake_body has them in an order that is no part of the
 * state. */
static uint32_t list_awake(const tl_header *h) {
    uint32_t *out = tl_island_parent(h), count = 0;
    for (uint32_t i = 0; h->awake_bodies && i < h->bodies.high; i++) {
        out[count] = i;
        count += tl_body_row(h)[i] != 0;
    }
    return count;
}

void tl_state_active_hashes(const tl_header *h, uint32_t out[TL_STATE_COUNT]) {
    uint32_t bodies = list_awake(h);
    uint32_t contacts = tl_bit_list(tl_contact_awake(h), h->contacts.high, tl_awake_contact(h));
    uint32_t joints = tl_bit_list(tl_joint_awake(h), h->joints.high, tl_awake_joint(h));
    for (uint32_t i = 0; i < TL_STATE_COUNT; i++) {
        talus_row_kind rows = rows_of(&COLUMNS[i]);
        if (rows == TALUS_ROW_OF_WORLD) {
            out[i] = hash_column(h, i);
        } else if (COLUMNS[i].stage == TALUS_STAGE_COMMANDS) {
            out[i] = 0;
        } else if (rows == TALUS_ROW_OF_BODY) {
            out[i] = hash_listed_rows(h, i, tl_island_parent(h), bodies);
        } else if (rows == TALUS_ROW_OF_CONTACT) {
            out[i] = hash_listed_rows(h, i, tl_awake_contact(h), contacts);
        } else {
            out[i] = hash_listed_rows(h, i, tl_awake_joint(h), joints);
        }
    }
}

uint32_t tl_state_layout(void) {
    uint32_t hash = 2166136261u; /* FNV-1a */
    for (uint32_t i = 0; i < TL_STATE_COUNT; i++) {
        for (const char *p = COLUMNS[i].name; *p; p++) {
            hash = (hash ^ (unsigned char)*p) * 16777619u;
        }
        hash = (hash ^ COLUMNS[i].row_bytes) * 16777619u;
        hash = (hash ^ COLUMNS[i].word) * 16777619u;
    }
    return hash;
}

/* --- columns ---------------------------------------------------------------------------------- */

uint32_t talus_column_count(void) { return TL_STATE_COUNT; }

talus_status talus_column_get(uint32_t column, talus_column *out) {
    if (column >= TL_STATE_COUNT || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    const column_info *c = &COLUMNS[column];
    out->name = c->name;
    out->stage = c->stage;
    out->rows = rows_of(c);
    out->row_bytes = c->row_bytes, out->word_bytes = c->word;
    return TALUS_OK;
}

uint32_t talus_column_rows(const talus_world *world, uint32_t column) {
    return tl_world_is_sound(world) && column < TL_STATE_COUNT ? tl_state_rows(tl_header_of(world), column).rows : 0;
}

/* --- comparing -------------------------------------------------------------------------------- */

/* The place of a column in the order in which a step writes them. */
static uint32_t turn_of(uint32_t column, int commands) {
    if (COLUMNS[column].stage == TALUS_STAGE_COMMANDS) {
        return commands ? 0 : TALUS_STAGE_COUNT;
    }
    return (uint32_t)COLUMNS[column].stage;
}

uint32_t talus_column_first(uint64_t columns, int commands) {
    uint32_t best = TL_STATE_COUNT;
    for (uint32_t i = 0; i < TL_STATE_COUNT; i++) {
        if ((columns >> i & 1u) && (best == TL_STATE_COUNT || turn_of(i, commands) < turn_of(best, commands))) {
            best = i;
        }
    }
    return best;
}

static void find_bodies(const tl_header *h, talus_parting *out) {
    uint32_t row = out->row, a = TL_NONE, b = TL_NONE;
    switch (out->column.rows) {
    case TALUS_ROW_OF_BODY:
        a = row;
        break;
    case TALUS_ROW_OF_SHAPE:
        a = row < h->shapes.high ? tl_shapes(h)[row].body : TL_NONE;
        break;
    case TALUS_ROW_OF_CONTACT:
        if (row < h->contacts.high) {
            a = tl_contacts(h)[row].body_a, b = tl_contacts(h)[row].body_b;
        }
        break;
    case TALUS_ROW_OF_JOINT:
        if (row < h->joints.high) {
            a = tl_joints(h)[row].body_a, b = tl_joints(h)[row].body_b;
        }
        break;
    default:
        break;
    }
    if (a < h->bodies.high) {
        out->body_a.index = a, out->body_a.generation = tl_bodies(h)[a].generation;
        out->user_data_a = tl_body_user(h)[a];
    }
    if (b < h->bodies.high) {
        out->body_b.index = b, out->body_b.generation = tl_bodies(h)[b].generation;
        out->user_data_b = tl_body_user(h)[b];
    }
}

static uint64_t word_at(const unsigned char *p, uint32_t word) {
    uint64_t both;
    uint32_t one;
    if (word == 8u) {
        memcpy(&both, p, 8u);
        return both;
    }
    memcpy(&one, p, 4u);
    return one;
}

/* The first word of a column in which two states differ; 0 if they are the same. */
static int column_parts(const tl_header *a, const tl_header *b, uint32_t column, talus_parting *out) {
    tl_live la = tl_state_rows(a, column), lb = tl_state_rows(b, column);
    uint32_t rows = la.rows < lb.rows ? la.rows : lb.rows, word = COLUMNS[column].word;
    memset(out, 0, sizeof *out);
    talus_column_get(column, &out->column);
    for (uint32_t row = 0; row < rows; row++) {
        const unsigned char *pa = la.data + (size_t)row * la.row_bytes, *pb = lb.data + (size_t)row * la.row_bytes;
        for (uint32_t k = 0; memcmp(pa, pb, la.row_bytes) != 0 && k < la.row_bytes; k += word) {
            if (memcmp(pa + k, pb + k, word) != 0) {
                out->row = row, out->word = k / word;
                out->value[0] = word_at(pa + k, word), out->value[1] = word_at(pb + k, word);
                find_bodies(a, out);
                return 1;
            }
        }
    }
    if (la.rows != lb.rows) {
        out->row = rows;
        out->rows[0] = la.rows, out->rows[1] = lb.rows;
        find_bodies(la.rows > lb.rows ? a : b, out);
        return 1;
    }
    return 0;
}

int talus_world_part(const talus_world *a, const talus_world *b, int commands, talus_parting *out) {
    if (!tl_world_is_sound(a) || !tl_world_is_sound(b) || !out) {
        return -1;
    }
    const tl_header *ha = tl_header_of(a), *hb = tl_header_of(b);
    if (memcmp(ha->capacity, hb->capacity, TL_COUNT_OF_STATE * sizeof *ha->capacity) != 0) {
        return -1;
    }
    uint64_t differ = 0;
    uint32_t columns = 0;
    for (uint32_t i = 0; i < TL_STATE_COUNT; i++) {
        int parts = column_parts(ha, hb, i, out);
        differ |= (uint64_t)parts << i;
        columns += (uint32_t)parts;
    }
    if (columns > 0) {
        column_parts(ha, hb, talus_column_first(differ, commands), out);
    }
    out->columns = columns;
    return columns > 0;
}

talus_status tl_run_world_flip(talus_world *world, uint32_t i, talus_command *c) {
    tl_header *h = tl_header_of(world);
    const talus_command_flip *f = &c->as.flip;
    (void)i;
    if (f->column >= TL_STATE_COUNT) {
        return TALUS_BAD_ARGUMENT;
    }
    tl_live live = tl_state_rows(h, f->column);
    if (f->row >= live.rows || f->bit >= 8u * live.row_bytes) {
        return TALUS_BAD_ARGUMENT;
    }
    uint32_t width = COLUMNS[f->column].word, byte = f->bit % (8u * width) / 8u;
    byte = f->bit / (8u * width) * width + (tl_high_byte_first() ? width - 1u - byte : byte);
    unsigned char *at = live.data + (size_t)f->row * live.row_bytes + byte;
    *at ^= (unsigned char)(1u << f->bit % 8u);
    if (talus_world_validate(world) != TALUS_OK) {
        *at ^= (unsigned char)(1u << f->bit % 8u);
        return TALUS_BAD_ARGUMENT;
    }
    for (uint32_t s = 0; s < h->shapes.high; s++) { /* it may have been where they are */
        if (tl_shapes(h)[s].flags & TL_SHAPE_ALIVE) {
            tl_shape_mark_moved(h, s);
        }
    }
    return TALUS_OK;
}
