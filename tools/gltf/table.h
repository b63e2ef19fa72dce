/* A hash table from short keys to numbers, for finding what was seen before. */
#ifndef TALUS_GLTF_TABLE_H
#define TALUS_GLTF_TABLE_H

#include <stddef.h>
#include <stdint.h>

#define GLTF_KEY_WORDS 10

typedef struct gltf_key {
    uint32_t word[GLTF_KEY_WORDS];
} gltf_key;

typedef struct gltf_slot {
    gltf_key key;
    uint32_t value, used;
} gltf_slot;

/* All zero is empty. */
typedef struct gltf_table {
    gltf_slot *slots;
    uint32_t room, count; /* room is a power of two */
} gltf_table;

/* The value's place for a key, added with `fresh` if it is new; null if there is no memory. Holds until the next call.
 */
uint32_t *gltf_table_find(gltf_table *table, const gltf_key *key, uint32_t fresh);
void gltf_table_free(gltf_table *table);
/* FNV-1a, 64 bits. */
uint64_t gltf_hash(const void *bytes, size_t size);

#endif
