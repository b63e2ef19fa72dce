/* The block: a header, then the columns. */
#ifndef TL_STORE_H
#define TL_STORE_H

#include "base/vec.h"
#include "stage/store/columns.h"
#include "talus/world.h"

#define TL_BLOCK_MAGIC 0x53554c54u /* "TLUS" */
#define TL_BLOCK_VERSION 3u
#define TL_UNIT 64u /* bytes: columns start at multiples of it, offsets are counted in it */

typedef enum tl_column_id {
#define X(name, type, count, stage, life, word) TL_COLUMN_##name,
    TL_COLUMNS(X)
#undef X
        TL_COLUMN_COUNT
} tl_column_id;

/* Room for pairs that are apart, a contact. */
#define TL_APART_PER_CONTACT 3u

/* Blocks of linkages beside the diagonals and values of their factors, a joint. */
#define TL_LINK_BLOCKS 4u
#define TL_LINK_VALUES 256u

/* The same of presses, a contact in them. */
#define TL_PRESS_BLOCKS 4u
#define TL_PRESS_VALUES 256u

/* Words of packed definitions, a body and a shape: more than bodies that differ in mass and shapes in size take. */
#define TL_DEFINITION_WORDS 24u

/* The capacities that the table's `count` names. */
typedef enum tl_count {
    TL_COUNT_BODY,
    TL_COUNT_SHAPE,
    TL_COUNT_NODE,
    TL_COUNT_PAIR,
    TL_COUNT_SLOT,
    TL_COUNT_CONTACT,
    TL_COUNT_CONTACTBIT,
    TL_COUNT_JOINT,
    TL_COUNT_JOINTBIT,
    TL_COUNT_ROW,
    TL_COUNT_GROUP,
    TL_COUNT_JOINTGROUP,
    TL_COUNT_JOINTROW,
    TL_COUNT_LINKNODE,
    TL_COUNT_LINKBLOCK,
    TL_COUNT_LINKVALUE,
    TL_COUNT_LINKSCRATCH,
    TL_COUNT_PRESSED,
    TL_COUNT_PRESSBLOCK,
    TL_COUNT_PRESSVALUE,
    TL_COUNT_DEFINITION,
    TL_COUNT_EVENT,
    TL_COUNT_OF_STATE, /* worlds that agree in those above have one layout of the state */
    TL_COUNT_TALLY = TL_COUNT_OF_STATE,
    TL_COUNT_FRAME,
    TL_COUNT_COUNT
} tl_count;

/* The settings of talus_world_def in members of four bytes. */
typedef struct tl_settings {
    talus_vec3 gravity;
    uint32_t substeps, iterations, most_substeps;
    float error_budget;
    float contact_hertz, contact_damping_ratio, push_speed;
    float speculative_margin, recycle_slack, restitution_speed, hit_speed, sleep_speed, sleep_time;
    uint32_t enable_sleep;
    float substep; /* s, of the last step, of islands without more: scales the impulses that the next one starts from */
} tl_settings;

/* A pool: slots in use are below `high`; freed ones form a list. */
typedef struct tl_pool {
    uint32_t high, free, used, peak;
} tl_pool;

typedef struct tl_event_counts {
    uint32_t begin, end, hit, sensor_begin, sensor_end, broken, dropped;
} tl_event_counts;

/* Counted in members of four bytes, as the records are. From `magic` up to `state` is set at init and not hashed. */
typedef struct tl_header {
    uint32_t magic, version;
    uint32_t units; /* of TL_UNIT bytes in the whole block */
    uint32_t isa;
    uint32_t capacity[TL_COUNT_COUNT];
    uint32_t offset[TL_COLUMN_COUNT]; /* in TL_UNIT bytes */
    uint32_t state;                   /* marks where the state begins */
    tl_settings settings;
    tl_pool bodies, shapes, contacts, joints;
    uint32_t steps_low, steps_high;
    uint32_t event_shapes, breaking_joints; /* in use: without any there is nothing to look for */
    uint32_t end;                           /* marks where the state ends */
    tl_pool nodes, pairs;
    uint32_t root[2]; /* of the trees: moving, still */
    uint32_t moved_shapes, awake_bodies, awake_pairs, awake_contacts, awake_joints;
    uint32_t
        defined; /* bytes in `definitions`: what snapshots have of the columns that only commands write; 0: unknown */
    uint32_t doubted; /* not 0: some awake body has TL_WAY_DOUBTED */
    talus_counters counters;
    tl_event_counts events;
    uint32_t groups, joint_groups, joint_rows, linkages, pressed, presses; /* of the last step */
    uint32_t frames, next_frame;           /* of the ring: in use, the place that the next step fills */
    uint32_t ties, tallied;                /* changes of what is tied and awake; as of the last tally */
    uint32_t tallied_points, tallied_ties; /* contact points; contacts and joints */
} tl_header;

/* One accessor a column: tl_body_pose(h) and so on. */
#define X(name, type, count, stage, life, word)                                                                        \
    static inline type *tl_##name(const tl_header *h) {                                                                \
        return (type *)(void *)((unsigned char *)(uintptr_t)h + (size_t)h->offset[TL_COLUMN_##name] * TL_UNIT);        \
    }
TL_COLUMNS(X)
#undef X

static inline tl_header *tl_header_of(const talus_world *world) { return (tl_header *)world->block; }

/* Whether a world's pointer and block look like one that was initialised. */
int tl_world_is_sound(const talus_world *world);

/* Works out capacities, offsets and the size of a block (in TL_UNIT); 0 if it would pass what 32 bits count. */
uint32_t tl_store_layout(const talus_world_def *def, uint32_t capacity[TL_COUNT_COUNT],
                         uint32_t offset[TL_COLUMN_COUNT]);

/* A slot of a pool, or TL_NONE if `capacity` are used. `next` is the free list's link of a slot. */
uint32_t tl_pool_top(const tl_pool *pool, uint32_t capacity);

/* Takes the slot that tl_pool_top gave, `next` being its link in the free list. */
static inline void tl_pool_take(tl_pool *pool, uint32_t i, uint32_t next) {
    if (i == pool->free) {
        pool->free = next;
    } else {
        pool->high++;
    }
    pool->used++;
    pool->peak = pool->used > pool->peak ? pool->used : pool->peak;
}

/* How many rows of a column are live. */
uint32_t tl_store_live(const tl_header *h, tl_column_id column);

/* The live rows of a state column; 0 if the column is not part of the state. */
typedef struct tl_live {
    unsigned char *data;
    uint32_t rows, row_bytes, word;
} tl_live;
int tl_store_state(const tl_header *h, tl_column_id column, tl_live *out);

/* What wakes, sleeps, begins or ceases to be tied by a contact or a joint says so, for the profiler's islands. */
static inline void tl_ties_changed(tl_header *h) {
#ifndef TALUS_NO_PROFILE
    h->ties++;
#else
    (void)h;
#endif
}

static inline talus_vec3 tl_row_xyz(const tl_row8 *r) { return tl_v(r->f[0], r->f[1], r->f[2]); }
static inline talus_vec3 tl_row_345(const tl_row8 *r) { return tl_v(r->f[3], r->f[4], r->f[5]); }
static inline talus_quat tl_row_quat(const tl_row8 *r) {
    talus_quat q = {r->f[3], r->f[4], r->f[5], r->f[6]};
    return q;
}
static inline talus_pose tl_row_pose_of(const tl_row8 *r) {
    talus_pose p = {tl_row_xyz(r), tl_row_quat(r)};
    return p;
}
static inline void tl_row_set_pose(tl_row8 *r, const talus_pose *p) {
    r->f[0] = p->position.x, r->f[1] = p->position.y, r->f[2] = p->position.z;
    r->f[3] = p->rotation.x, r->f[4] = p->rotation.y, r->f[5] = p->rotation.z, r->f[6] = p->rotation.w;
}
static inline void tl_row_set6(tl_row8 *r, talus_vec3 a, talus_vec3 b) {
    r->f[0] = a.x, r->f[1] = a.y, r->f[2] = a.z, r->f[3] = b.x, r->f[4] = b.y, r->f[5] = b.z;
}
static inline uint32_t tl_body_type(const tl_body_meta *m) { return m->flags & TL_BODY_TYPE; }

#endif
