#include "gltf/table.h"

#include <stdlib.h>
#include <string.h>

uint64_t gltf_hash(const void *bytes, size_t size) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (const unsigned char *p = bytes; size-- > 0; p++) {
        hash = (hash ^ *p) * 0x100000001b3u;
    }
    return hash;
}

static gltf_slot *find(gltf_slot *slots, uint32_t room, const gltf_key *key) {
    uint64_t hash = gltf_hash(key, sizeof *key);
    uint32_t i = (uint32_t)(hash ^ hash >> 32) & (room - 1);
    while (slots[i].used && memcmp(&slots[i].key, key, sizeof *key) != 0) {
        i = (i + 1) & (room - 1);
    }
    return &slots[i];
}

static int grow(gltf_table *table) {
    uint32_t room = table->room == 0 ? 64 : table->room * 2;
    gltf_slot *slots = calloc(room, sizeof *slots);
    if (slots == NULL) {
        return 0;
    }
    for (uint32_t i = 0; i < table->room; i++) {
        if (table->slots[i].used) {
            *find(slots, room, &table->slots[i].key) = table->slots[i];
        }
    }
    free(table->slots);
    table->slots = slots;
    table->room = room;
    return 1;
}

uint32_t *gltf_table_find(gltf_table *table, const gltf_key *key, uint32_t fresh) {
    if (table->count * 2 >= table->room && !grow(table)) {
        return NULL;
    }
    gltf_slot *slot = find(table->slots, table->room, key);
    if (!slot->used) {
        slot->used = 1;
        slot->key = *key;
        slot->value = fresh;
        table->count++;
    }
    return &slot->value;
}

void gltf_table_free(gltf_table *table) {
    free(table->slots);
    memset(table, 0, sizeof *table);
}
