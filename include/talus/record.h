/* Recordings: a world's state, the hulls it needs, and the commands that were done to it, with a hash after every step
 * of what is awake, by columns, and every 64 steps of the whole state. Replaying one on any machine gives the same
 * bits, or says where they part.
 *
 * A recording is a run of bytes, little-endian, of chunks with checksums. The library does no I/O: the recorder hands
 * out the bytes to append to a file, the replay reads the bytes of one. */
#ifndef TALUS_RECORD_H
#define TALUS_RECORD_H

#include "talus/command.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- the columns of the state --- */

#define TALUS_MAX_COLUMNS 64u

/* What the rows of a column are of. */
typedef enum talus_row_kind {
    TALUS_ROW_OF_WORLD, /* a single row */
    TALUS_ROW_OF_BODY,
    TALUS_ROW_OF_SHAPE,

    TALUS_ROW_OF_CONTACT,
    TALUS_ROW_OF_JOINT
} talus_row_kind;

typedef struct talus_column {
    const char *name;
    talus_stage stage; /* the one that writes it in a step */
    talus_row_kind rows;
    uint32_t row_bytes, word_bytes; /* of a row, and of each of its members: 4 or 8 */
} talus_column;

uint32_t talus_column_count(void);
/* TALUS_BAD_ARGUMENT past the last one. */
talus_status talus_column_get(uint32_t column, talus_column *out);
/* How many rows are in use now. */
uint32_t talus_column_rows(const talus_world *world, uint32_t column);

/* The column of a set, a bit each, that a step writes first, or talus_column_count() for an empty set. Those that
 * commands write stand first if `commands` is not zero and last if it is, for then a later stage changed them too. */
uint32_t talus_column_first(uint64_t columns, int commands);

/* The first place in which two worlds of the same capacities part, in the order of talus_column_first. Returns 1 if
 * they do, 0 if they are the same, -1 if they cannot be compared. */
typedef struct talus_parting {
    talus_column column;
    uint32_t row, word;                /* which member of the row */
    uint64_t value[2];                 /* its bits in either world */
    uint32_t rows[2];                  /* in use, where that is what differs; else 0 0 */
    talus_body body_a, body_b;         /* whose row it is; none where it is nobody's */
    uint64_t user_data_a, user_data_b; /* of these bodies */
    uint32_t columns;                  /* how many differ in all */
} talus_parting;
int talus_world_part(const talus_world *a, const talus_world *b, int commands, talus_parting *out);

/* --- recording --- */

/* What a recorder knows; it must stay where it is while it records. */
typedef struct talus_recorder {
    talus_log log;
    unsigned char *memory;
    size_t capacity;
    size_t geometry_bytes;  /* of the region, recorded so far */
    uint64_t work;          /* bodies awake, summed over the steps since the last keyframe */
    uint64_t keyframe_work; /* a keyframe is due after so much of it; may be set after talus_recorder_begin */
    uint32_t steps, keyframes;
    uint32_t gaps; /* steps recorded by their outcome, for their commands were lost */
    uint32_t hash[TALUS_MAX_COLUMNS];
} talus_recorder;

/* About as many body steps as a core does in a quarter of a second: that is how long seeking takes. */
#define TALUS_KEYFRAME_WORK 262144u

/* Bytes of memory that a recorder of this world needs, with room for `commands` bytes of commands a step. 0 for an
 * unsound world. */
size_t talus_recorder_size(const talus_world *world, size_t commands);

/* Begins: *bytes and *size receive what the recording begins with, and from now on world->log takes the commands. Each
 * of these three gives out bytes in the recorder's memory, which hold until the next call that changes the world.
 * TALUS_SMALL_BLOCK; TALUS_BAD_ARGUMENT. */
talus_status talus_recorder_begin(talus_recorder *recorder, talus_world *world, void *memory, size_t capacity,
                                  const void **bytes, size_t *size);
/* To be called after every step. One pass over what is awake, and over the whole state every 64 steps. If commands did
 * not fit the memory or the world was restored, the step is recorded by its outcome. TALUS_SMALL_BLOCK if hulls were
 * added that do not fit the room for commands; nothing is lost then. */
talus_status talus_recorder_step(talus_recorder *recorder, talus_world *world, const void **bytes, size_t *size);
/* Ends, with the commands since the last step, and takes the log off. */
talus_status talus_recorder_end(talus_recorder *recorder, talus_world *world, const void **bytes, size_t *size);

/* --- replaying --- */

typedef enum talus_fault {
    TALUS_FAULT_NONE,
    TALUS_FAULT_NO_RECORDING,  /* it does not begin as one */
    TALUS_FAULT_OTHER_VERSION, /* of the format */
    TALUS_FAULT_OTHER_LAYOUT,  /* recorded by a library with other columns */
    TALUS_FAULT_DAMAGED,
    TALUS_FAULT_TOO_SHORT, /* cut off before the first state was whole */
    TALUS_FAULT_COUNT
} talus_fault;

/* A short English text for a fault; never null. */
const char *talus_fault_text(talus_fault fault);

typedef struct talus_replay {
    const unsigned char *bytes;
    size_t size;
    /* what talus_replay_open found */
    talus_fault fault;
    size_t offset;         /* of the fault; without one, where the last whole chunk ends */
    talus_world_def def;   /* the capacities that the world needs */
    size_t geometry_bytes; /* of the region that the hulls need */
    uint32_t steps, keyframes;
    int cut; /* the end is missing, from `offset` on */
    /* where the replay stands */
    size_t at;
    uint32_t step;                     /* steps done */
    uint32_t hash[TALUS_MAX_COLUMNS];  /* as recorded: of what is awake, in the columns that stages write */
    uint32_t whole[TALUS_MAX_COLUMNS]; /* of all rows of every column, if `has_whole` */
    int has_whole;
    const unsigned char *commands; /* of the last step */
    size_t command_bytes;
    uint32_t lost;        /* commands of the last step that were not recorded */
    size_t done;          /* bytes of the last step's commands that were carried out */
    talus_status refused; /* what the next one was answered with, if it was not TALUS_OK */
    /* for the caller to set after opening */
    const talus_clock *clock; /* handed to every step; null: none */
} talus_replay;

/* Looks through a whole recording, which must stay where it is. TALUS_BAD_BLOB with `fault` and
 * `offset` if it is none, damaged, or of another version; one whose end is missing is in order up to there. */
talus_status talus_replay_open(talus_replay *replay, const void *bytes, size_t size);

/* Makes the recording's world in `block` (talus_world_size(&replay->def) bytes) with its hulls in `geometry`
 * (TALUS_BLOB_ALIGNMENT aligned, replay->geometry_bytes), in the state before the first step. Those of
 * talus_world_init; TALUS_BAD_BLOB. */
talus_status talus_replay_begin(talus_replay *replay, talus_world *world, void *block, size_t block_bytes,
                                void *geometry, size_t geometry_bytes);

typedef enum talus_replayed {
    TALUS_REPLAYED,        /* the commands of a step were done */
    TALUS_REPLAYED_GAP,    /* those of a step were lost in recording: the recorded state was taken */
    TALUS_REPLAYED_END,    /* there is no further step: nothing was done */
    TALUS_REPLAYED_REFUSED /* the world took a command of the step not as it did when recorded: its state is another */
} talus_replayed;

/* Does the next step's commands to the world. */
talus_replayed talus_replay_step(talus_replay *replay, talus_world *world);
/* The columns whose hash is not the recorded one, a bit each: 0 if the replay is true. One pass over what is awake, and
 * over the whole state where the recording has hashes of it. */
uint64_t talus_replay_compare(const talus_replay *replay, const talus_world *world);
/* Takes the last keyframe at or before a step; from there it is reached by steps. TALUS_BAD_BLOB; if it is the state
 * that is not sound, no call takes the world any more. */
talus_status talus_replay_seek(talus_replay *replay, talus_world *world, uint32_t step);
/* Goes to the next step without doing it, for what is recorded of it; 0 if there is none. */
int talus_replay_next(talus_replay *replay);
/* The columns whose recorded hashes differ where two replays stand, a bit each. */
uint64_t talus_replay_differ(const talus_replay *a, const talus_replay *b);

#ifdef __cplusplus
}
#endif

#endif
