/* Snapshots: the state and nothing else. A head of words, the settings and counts, the columns packed by what differs
 * from row to row, and the contacts one after the other with the points that they have. What follows from the rest
 * (colours, mixed materials, and all of the index) is worked out anew. */
#include "talus/snapshot.h"

#include <string.h>

#include "base/bits.h"
#include "talus/command.h"
#include "world/pack.h"
#include "world/reindex.h"
#include "world/world_internal.h"

#define SNAPSHOT_MAGIC 0x50534c54u /* "TLSP" */
#define SNAPSHOT_VERSION 2u

/* Words of the head: magic, version, bytes, checksum (low, high), then the capacities. */
enum { HEAD_MAGIC, HEAD_VERSION, HEAD_BYTES, HEAD_SUM, HEAD_SUM_HIGH, HEAD_CAPACITY, HEAD_WORDS = HEAD_CAPACITY + 5 };
#define HEAD_CHECKED (4u * HEAD_CAPACITY) /* bytes from here on are under the checksum */

static const tl_count CAPACITIES[5] = {TL_COUNT_BODY, TL_COUNT_SHAPE, TL_COUNT_CONTACT, TL_COUNT_JOINT, TL_COUNT_EVENT};

static unsigned char *state_of(const tl_header *h) { return (unsigned char *)(uintptr_t)&h->settings; }
static size_t state_words(void) { return (offsetof(tl_header, end) - offsetof(tl_header, settings)) / 4u; }

/* Columns that are written row by row; those of contacts are written contact by contact. */
static int is_packed(tl_column_id column) {
    switch (column) {
    case TL_COLUMN_heads:
    case TL_COLUMN_points:
    case TL_COLUMN_contacts:
    case TL_COLUMN_contact_caches:
        return 0;
    default:
        return 1;
    }
}

/* Columns of indices, which mostly go up by one from row to row. */
static int counts(tl_column_id column) { return column == TL_COLUMN_bodies || column == TL_COLUMN_shapes; }

/* --- contacts --------------------------------------------------------------------------------- */

/* A contact begins with a word: count (3 bits), colour (7), flags (8), whether friction is at work (1), whether the
 * ids need more than 16 bits (1), which points press (4) and which words the cache holds (4). */
#define MOST_CONTACT_BYTES (4u + 8u + 4u + 12u + 16u + 16u + TL_MANIFOLD_POINTS * 32u)

static uint32_t word_of(float x) {
    uint32_t w;
    memcpy(&w, &x, 4);
    return w;
}

static uint32_t contact_code(const tl_header *h, uint32_t c) {
    const tl_contact_meta *m = &tl_contacts(h)[c];
    const tl_contact_head *head = &tl_heads(h)[c];
    const tl_contact_points *points = &tl_points(h)[c];
    const tl_pair_cache *cache = &tl_contact_caches(h)[c];
    uint32_t friction =
        word_of(head->friction[0]) | word_of(head->friction[1]) | word_of(head->friction[2]) | word_of(head->twist);
    uint32_t code = m->count | m->color << 3 | m->flags << 10 | (uint32_t)(friction != 0) << 18;
    uint32_t ids = 0;
    for (uint32_t i = 0; i < m->count; i++) {
        ids |= points->p[i].id;
        code |= (uint32_t)(word_of(points->p[i].impulse) != 0) << (20u + i);
    }
    for (uint32_t i = 0; i < 4u; i++) {
        code |= (uint32_t)(cache->word[i] != 0) << (24u + i);
    }
    return code | (uint32_t)(ids > 0xffffu) << 19;
}

static unsigned char *put_contact(unsigned char *p, const tl_header *h, uint32_t c) {
    const tl_contact_meta *m = &tl_contacts(h)[c];
    const tl_contact_head *head = &tl_heads(h)[c];
    const tl_contact_points *points = &tl_points(h)[c];
    const tl_pair_cache *cache = &tl_contact_caches(h)[c];
    uint32_t code = contact_code(h, c);
    p = tl_put_word(p, code);
    if (h->shapes.high <= 0x10000u) {
        p = tl_put_word(p, m->shape_a | m->shape_b << 16);
    } else {
        p = tl_put_word(tl_put_word(p, m->shape_a), m->shape_b);
    }
    p = tl_put_word(p, m->motion);
    p = tl_put_words(p, head->normal, 3);
    if (code >> 18 & 1u) {
        p = tl_put_words(p, head->friction, 4); /* and the twist */
    }
    for (uint32_t i = 0; i < 4u; i++) {
        if (code >> (24u + i) & 1u) {
            p = tl_put_word(p, cache->word[i]);
        }
    }
    for (uint32_t i = 0; i < m->count; i++) {
        const tl_contact_point_record *r = &points->p[i];
        p = tl_put_words(p, r->a, 7); /* and b and the impulse */
        p -= code >> (20u + i) & 1u ? 0 : 4;
        if (code >> 19 & 1u) {
            p = tl_put_word(p, r->id);
        } else {
            p[0] = (unsigned char)r->id, p[1] = (unsigned char)(r->id >> 8);
            p += 2;
        }
    }
    return p;
}

/* Bytes of a contact with this code. */
static size_t contact_bytes(const tl_header *h, uint32_t code) {
    uint32_t count = code & 7u, bits = tl_bit_count(code >> 20 & 0xffu);
    return 8u + (h->shapes.high <= 0x10000u ? 4u : 8u) + 12u + (code >> 18 & 1u ? 16u : 0u) + 4u * bits +
           count * (24u + (code >> 19 & 1u ? 4u : 2u));
}

/* What was in a contact's slot goes: its pair is left without one. */
static void part_contact(tl_header *h, uint32_t c) {
    if (tl_contacts(h)[c].flags & TL_CONTACT_ALIVE) {
        tl_pairs(h)[tl_contact_pair(h)[c]].contact = TL_NONE;
    }
    tl_contacts(h)[c].body_a = TL_NONE; /* says so until the contacts are tied to their pairs */
}

/* Null if it is cut off or is none. *others counts those that are not what stood in their slots. */
static const unsigned char *get_contact(const unsigned char *p, const unsigned char *end, tl_header *h, uint32_t c,
                                        uint32_t *others) {
    tl_contact_meta *m = &tl_contacts(h)[c];
    tl_contact_head *head = &tl_heads(h)[c];
    tl_contact_points *points = &tl_points(h)[c];
    tl_pair_cache *cache = &tl_contact_caches(h)[c];
    uint32_t code = end - p >= 4 ? tl_get_word(p) : 7u, count = code & 7u;
    if (count > TL_MANIFOLD_POINTS || (code >> 20 & 15u) >> count || (size_t)(end - p) < contact_bytes(h, code)) {
        return NULL;
    }
    uint32_t shape_a = tl_get_word(p + 4), shape_b = shape_a >> 16;
    if (h->shapes.high <= 0x10000u) {
        shape_a &= 0xffffu;
        p += 8;
    } else {
        shape_b = tl_get_word(p + 8);
        p += 12;
    }
    for (uint32_t i = count; i < m->count && i < TL_MANIFOLD_POINTS; i++) {
        memset(&points->p[i], 0, sizeof points->p[i]);
    }
    if (m->shape_a != shape_a || m->shape_b != shape_b) {
        part_contact(h, c);
    }
    *others += m->body_a == TL_NONE || m->color != (code >> 3 & 127u);
    memset(head, 0, sizeof *head);
    memset(cache, 0, sizeof *cache);
    m->count = count, m->color = code >> 3 & 127u, m->flags = code >> 10 & 255u;
    m->shape_a = shape_a, m->shape_b = shape_b;
    m->motion = tl_get_word(p);
    tl_get_words(p + 4, head->normal, 3);
    p += 16;
    if (code >> 18 & 1u) {
        tl_get_words(p, head->friction, 4);
        p += 16;
    }
    for (uint32_t i = 0; i < 4u; i++) {
        if (code >> (24u + i) & 1u) {
            cache->word[i] = tl_get_word(p);
            p += 4;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        tl_contact_point_record *r = &points->p[i];
        tl_get_words(p, r->a, 6);
        p += 24;
        r->impulse = 0.0f;
        if (code >> (20u + i) & 1u) {
            tl_get_words(p, &r->impulse, 1);
            p += 4;
        }
        r->id = code >> 19 & 1u ? tl_get_word(p) : (uint32_t)p[0] | (uint32_t)p[1] << 8;
        p += code >> 19 & 1u ? 4 : 2;
    }
    return p;
}

/* --- saving ----------------------------------------------------------------------------------- */

static size_t most_bytes(const tl_header *h) {
    size_t size = 4u * (HEAD_WORDS + state_words()) + 8u * (size_t)tl_bit_words(h->contacts.high) +
                  (size_t)h->contacts.used * MOST_CONTACT_BYTES;
    for (uint32_t i = 0; i < TL_COLUMN_COUNT; i++) {
        tl_live live;
        if (is_packed((tl_column_id)i) && tl_store_state(h, (tl_column_id)i, &live)) {
            size += tl_pack_bound(live.rows, live.row_bytes);
        }
    }
    return size;
}

size_t tl_snapshot_most(const tl_header *h) {
    tl_header full = *h;
    full.bodies.high = h->capacity[TL_COUNT_BODY], full.shapes.high = h->capacity[TL_COUNT_SHAPE];
    full.joints.high = h->capacity[TL_COUNT_JOINT];
    full.contacts.high = full.contacts.used = h->capacity[TL_COUNT_CONTACT];
    return most_bytes(&full);
}

size_t talus_world_save_size(const talus_world *world) {
    return tl_world_is_sound(world) ? most_bytes(tl_header_of(world)) : 0;
}

talus_status talus_world_save(const talus_world *world, void *out, size_t bytes, size_t *written) {
    if (!tl_world_is_sound(world) || !out || !written) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    if (bytes < talus_world_save_size(world)) {
        return TALUS_SMALL_BLOCK;
    }
    unsigned char *first = out, *p = first + 4u * HEAD_WORDS;
    tl_put_word(first + 4u * HEAD_MAGIC, SNAPSHOT_MAGIC);
    tl_put_word(first + 4u * HEAD_VERSION, SNAPSHOT_VERSION);
    for (unsigned i = 0; i < 5u; i++) {
        tl_put_word(first + 4u * (HEAD_CAPACITY + i), h->capacity[CAPACITIES[i]]);
    }
    p = tl_put_words(p, state_of(h), state_words());
    for (uint32_t i = 0; i < TL_COLUMN_COUNT; i++) {
        tl_live live;
        if (is_packed((tl_column_id)i) && tl_store_state(h, (tl_column_id)i, &live)) {
            p = tl_pack_rows(p, live.data, live.rows, live.row_bytes, live.word, counts((tl_column_id)i));
        }
    }
    const uint64_t *alive = tl_contact_alive(h);
    for (uint32_t w = 0; w < tl_bit_words(h->contacts.high); w++) {
        p = tl_put_word(tl_put_word(p, (uint32_t)alive[w]), (uint32_t)(alive[w] >> 32));
        for (uint64_t word = alive[w]; word; word &= word - 1u) {
            p = put_contact(p, h, w * 64u + tl_bit_lowest(word));
        }
    }
    size_t size = (size_t)(p - first);
    tl_put_word(first + 4u * HEAD_BYTES, (uint32_t)size);
    uint64_t sum = tl_pack_checksum(first + HEAD_CHECKED, size - HEAD_CHECKED);
    tl_put_word(first + 4u * HEAD_SUM, (uint32_t)sum);
    tl_put_word(first + 4u * HEAD_SUM_HIGH, (uint32_t)(sum >> 32));
    *written = size;
    return TALUS_OK;
}

/* --- restoring -------------------------------------------------------------------------------- */

static int counts_fit(const tl_header *h) {
    const uint32_t *c = h->capacity;
    return h->bodies.high >= 1u && h->bodies.high <= c[TL_COUNT_BODY] && h->shapes.high <= c[TL_COUNT_SHAPE] &&
           h->contacts.high <= c[TL_COUNT_CONTACT] && h->joints.high <= c[TL_COUNT_JOINT];
}

/* Whether the bytes are a whole snapshot of a world like h; `next` becomes h with the snapshot's counts. */
static int is_snapshot(const tl_header *h, const unsigned char *p, size_t bytes, tl_header *next) {
    if (bytes < 4u * (HEAD_WORDS + state_words()) || tl_get_word(p + 4u * HEAD_MAGIC) != SNAPSHOT_MAGIC ||
        tl_get_word(p + 4u * HEAD_VERSION) != SNAPSHOT_VERSION) {
        return 0;
    }
    size_t size = tl_get_word(p + 4u * HEAD_BYTES);
    if (size > bytes || size < 4u * (HEAD_WORDS + state_words())) {
        return 0;
    }
    for (unsigned i = 0; i < 5u; i++) {
        if (tl_get_word(p + 4u * (HEAD_CAPACITY + i)) != h->capacity[CAPACITIES[i]]) {
            return 0;
        }
    }
    uint64_t sum = tl_get_long_word(p + 4u * HEAD_SUM);
    if (tl_pack_checksum(p + HEAD_CHECKED, size - HEAD_CHECKED) != sum) {
        return 0;
    }
    *next = *h;
    tl_get_words(p + 4u * HEAD_WORDS, state_of(next), state_words());
    return counts_fit(next);
}

/* What to note of the rows of a column that become others. */
static tl_marks marks_of(const tl_header *h, tl_column_id column, tl_changes *changes) {
    tl_marks none = {NULL, 0, 0}, meta = {&changes->metas, 0, 1}, body = {tl_island_parent(h), 1, TL_BODY_OTHER};
    tl_marks shape = {&tl_shape_tracks(h)->stale, sizeof(tl_shape_track) / 4u, TL_SHAPE_OTHER};
    switch (column) {
    case TL_COLUMN_bodies:
    case TL_COLUMN_joints:
        return meta;
    case TL_COLUMN_body_pose:
    case TL_COLUMN_body_motion:
    case TL_COLUMN_body_frame:
        return body;
    case TL_COLUMN_shapes:
    case TL_COLUMN_shape_place:
    case TL_COLUMN_shape_geometry:
    case TL_COLUMN_shape_material:
    case TL_COLUMN_shape_category:
    case TL_COLUMN_shape_mask:
        return shape;
    default:
        return none;
    }
}

/* Rows of a column that were in use and are not any more are as new. */
static void clear_rows(const tl_live *live, uint32_t was, const tl_marks *marks) {
    if (was > live->rows) {
        memset(live->data + (size_t)live->rows * live->row_bytes, 0, (size_t)(was - live->rows) * live->row_bytes);
        for (uint32_t row = live->rows; marks && row < was; row++) {
            marks->first[row * marks->stride] = marks->value;
        }
    }
}

static const unsigned char *get_columns(const unsigned char *p, const unsigned char *end, tl_header *h,
                                        const tl_header *before, tl_changes *changes) {
    for (uint32_t i = 0; i < TL_COLUMN_COUNT && p; i++) {
        tl_live live;
        if (!tl_store_state(h, (tl_column_id)i, &live)) {
            continue;
        }
        tl_marks marks = marks_of(h, (tl_column_id)i, changes), *mark = marks.first ? &marks : NULL;
        clear_rows(&live, tl_store_live(before, (tl_column_id)i), mark);
        if (is_packed((tl_column_id)i)) {
            p = tl_unpack_rows(p, end, live.data, live.rows, live.row_bytes, live.word, counts((tl_column_id)i), mark);
        }
    }
    return p;
}

static const unsigned char *get_contacts(const unsigned char *p, const unsigned char *end, tl_header *h,
                                         uint32_t *others) {
    uint64_t *alive = tl_contact_alive(h);
    uint32_t used = 0;
    memset(alive, 0, (size_t)h->capacity[TL_COUNT_CONTACTBIT] * 8u);
    for (uint32_t w = 0; w < tl_bit_words(h->contacts.high); w++) {
        if (end - p < 8) {
            return NULL;
        }
        alive[w] = tl_get_long_word(p);
        p += 8;
        for (uint32_t c = w * 64u; c < h->contacts.high && c < w * 64u + 64u; c++) {
            if (!tl_bit_has(alive, c)) {
                if (tl_contacts(h)[c].flags) {
                    part_contact(h, c);
                    tl_contact_clear(h, c);
                    ++*others;
                }
                continue;
            }
            p = get_contact(p, end, h, c, others);
            used++;
            if (!p) {
                return NULL;
            }
        }
    }
    return used == h->contacts.used && tl_bit_end(alive, h->capacity[TL_COUNT_CONTACTBIT] * 64u) == h->contacts.high
               ? p
               : NULL;
}

talus_status talus_world_restore(talus_world *world, const void *snapshot, size_t bytes) {
    if (!tl_world_is_sound(world) || !snapshot) {
        return TALUS_BAD_ARGUMENT;
    }
    const unsigned char *p = snapshot;
    tl_header *h = tl_header_of(world), before = *h, next;
    if (!is_snapshot(h, p, bytes, &next)) {
        return TALUS_BAD_BLOB;
    }
    const unsigned char *end = p + tl_get_word(p + 4u * HEAD_BYTES);
    tl_changes changes = {0, 0};
    tl_reindex_begin(h, next.bodies.high);
    for (uint32_t c = next.contacts.high; c < h->contacts.high; c++) {
        part_contact(h, c);
        changes.contacts++;
    }
    memcpy(state_of(h), state_of(&next), 4u * state_words());
    p = get_columns(p + 4u * (HEAD_WORDS + state_words()), end, h, &before, &changes);
    if (p) {
        p = get_contacts(p, end, h, &changes.contacts);
    }
    if (p != end || tl_reindex_end(h, &before, &changes) != TALUS_OK) {
        /* Made to deceive: the checksum holds and the contents do not. Nothing of it is kept. */
        talus_world_def def;
        talus_world fresh;
        *h = before;
        if (talus_world_get_def(world, &def) == TALUS_OK) {
            talus_world_init(&fresh, &def, h, (size_t)h->units * TL_UNIT);
        }
        return TALUS_BAD_BLOB;
    }
    if (world->log) {
        world->log->lost++; /* no command says what this did */
    }
    return TALUS_OK;
}
