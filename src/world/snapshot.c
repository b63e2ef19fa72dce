/* Snapshots: the state and nothing else. A head of words, the settings and counts, the columns packed by what differs
 * from row to row, and the contacts one after the other with the points that they have. What follows from the rest
 * (colours, mixed materials, and all of the index) is worked out anew. */
#include "talus/snapshot.h"

#include <string.h>

#include "talus/command.h"
#include "world/pack.h"
#include "world/pack_contact.h"
#include "world/world_internal.h"

#define SNAPSHOT_MAGIC 0x50534c54u /* "TLSP" */
#define SNAPSHOT_VERSION 4u

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

/* Columns that only commands write, and none of those that act every frame (command.h). They come first, and what they
 * were packed to is kept in the block: as long as that stands, nothing of them is read to save, and a snapshot that
 * begins with the same bytes says the same of them. */
static int is_definition(tl_column_id column) {
    switch (column) {
    case TL_COLUMN_body_inertias:
    case TL_COLUMN_body_frame:
    case TL_COLUMN_body_mass:
    case TL_COLUMN_body_user:
    case TL_COLUMN_shape_place:
    case TL_COLUMN_shape_geometry:
    case TL_COLUMN_shapes:
    case TL_COLUMN_shape_material:
    case TL_COLUMN_shape_category:
    case TL_COLUMN_shape_mask:
    case TL_COLUMN_shape_pose:
    case TL_COLUMN_shape_user:
        return 1;
    default:
        return 0;
    }
}

/* Columns of indices, which mostly go up by one from row to row. */
static int counts(tl_column_id column) { return column == TL_COLUMN_bodies || column == TL_COLUMN_shapes; }

/* --- saving ----------------------------------------------------------------------------------- */

static size_t most_bytes(const tl_header *h) {
    size_t size = 4u * (HEAD_WORDS + state_words()) + tl_pack_contacts_bound(h);
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

static unsigned char *put_columns(unsigned char *p, const tl_header *h, int definitions) {
    for (uint32_t i = 0; i < TL_COLUMN_COUNT; i++) {
        tl_column_id column = (tl_column_id)i;
        tl_live live;
        if (is_packed(column) && is_definition(column) == definitions && tl_store_state(h, column, &live)) {
            p = tl_pack_rows(p, live.data, live.rows, live.row_bytes, live.word, counts(column));
        }
    }
    return p;
}

static unsigned char *put_definitions(unsigned char *p, tl_header *h) {
    if (h->defined) {
        memcpy(p, tl_definitions(h), h->defined);
        return p + h->defined;
    }
    unsigned char *end = put_columns(p, h, 1);
    size_t bytes = (size_t)(end - p);
    if (bytes <= h->capacity[TL_COUNT_DEFINITION] * sizeof(uint32_t)) {
        memcpy(tl_definitions(h), p, bytes);
        h->defined = (uint32_t)bytes;
    }
    return end;
}

talus_status talus_world_save(const talus_world *world, void *out, size_t bytes, size_t *written) {
    if (!tl_world_is_sound(world) || !out || !written) {
        return TALUS_BAD_ARGUMENT;
    }
    tl_header *h = tl_header_of(world);
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
    p = put_columns(put_definitions(p, h), h, 0);
    size_t size = (size_t)(tl_pack_contacts(p, h) - first);
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

/* What to note of the rows of a column that become others, and where they are counted. */
static tl_marks marks_of(const tl_header *h, tl_column_id column, tl_changes *changes, uint32_t **counter) {
    tl_marks none = {NULL, 0, 0, 0}, body = {tl_island_parent(h), 1, TL_BODY_OTHER, 0};
    tl_marks shape = {&tl_shape_tracks(h)->stale, sizeof(tl_shape_track) / 4u, TL_SHAPE_OTHER, 0};
    switch (column) {
    case TL_COLUMN_bodies:
    case TL_COLUMN_joints:
        *counter = &changes->metas;
        return none;
    case TL_COLUMN_body_pose:
    case TL_COLUMN_body_motion:
    case TL_COLUMN_body_frame:
        *counter = &changes->bodies;
        return body;
    case TL_COLUMN_shapes:
    case TL_COLUMN_shape_place:
    case TL_COLUMN_shape_geometry:
    case TL_COLUMN_shape_material:
    case TL_COLUMN_shape_category:
    case TL_COLUMN_shape_mask:
        *counter = &changes->shapes;
        return shape;
    default:
        *counter = NULL;
        return none;
    }
}

/* Rows of a column that were in use and are not any more are as new. */
static void clear_rows(const tl_live *live, uint32_t was, tl_marks *marks) {
    if (was > live->rows) {
        memset(live->data + (size_t)live->rows * live->row_bytes, 0, (size_t)(was - live->rows) * live->row_bytes);
        marks->count += was - live->rows;
        for (uint32_t row = live->rows; marks->first && row < was; row++) {
            marks->first[row * marks->stride] = marks->value;
        }
    }
}

static const unsigned char *get_columns(const unsigned char *p, const unsigned char *end, tl_header *h,
                                        const tl_header *before, int definitions, tl_changes *changes) {
    for (uint32_t i = 0; i < TL_COLUMN_COUNT && p; i++) {
        tl_column_id column = (tl_column_id)i;
        tl_live live;
        if (is_definition(column) != definitions || !tl_store_state(h, column, &live)) {
            continue;
        }
        uint32_t *counter;
        tl_marks marks = marks_of(h, column, changes, &counter);
        clear_rows(&live, tl_store_live(before, column), &marks);
        if (is_packed(column)) {
            p = tl_unpack_rows(p, end, live.data, live.rows, live.row_bytes, live.word, counts(column), &marks);
        }
        if (counter) {
            *counter += marks.count;
        }
    }
    return p;
}

static const unsigned char *get_definitions(const unsigned char *p, const unsigned char *end, tl_header *h,
                                            const tl_header *before, tl_changes *changes) {
    if (h->defined && h->bodies.high == before->bodies.high && h->shapes.high == before->shapes.high &&
        (size_t)(end - p) >= h->defined && memcmp(p, tl_definitions(h), h->defined) == 0) {
        return p + h->defined;
    }
    h->defined = 0;
    return get_columns(p, end, h, before, 1, changes);
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
    tl_changes changes = {0, 0, 0, 0};
    tl_reindex_begin(h, next.bodies.high);
    for (uint32_t c = next.contacts.high; c < h->contacts.high; c++) {
        tl_reindex_part_contact(h, c);
    }
    memcpy(state_of(h), state_of(&next), 4u * state_words());
    p = get_definitions(p + 4u * (HEAD_WORDS + state_words()), end, h, &before, &changes);
    if (p) {
        p = get_columns(p, end, h, &before, 0, &changes);
    }
    if (p) {
        p = tl_unpack_contacts(p, end, h, &changes);
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
