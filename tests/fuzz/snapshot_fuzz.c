/* libFuzzer: a sound snapshot with bytes changed. Restoring answers; what the validator takes can be stepped, asked and
 * looked through again. Changed bytes may be numbers so large, though finite, that a step passes what floats hold: that
 * the state after it is finite is not asked here but of worlds made by calls (world_fuzz). */
#include "busy_world.h"
#include "world/pack.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define STATES 4u
static const uint32_t STEPS[STATES] = {0, 20, 60, 200};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static talus_world world;
    static unsigned char *snapshot[STATES], *broken;
    static size_t bytes[STATES];
    if (!broken) {
        size_t most = 0;
        for (uint32_t i = 0; i < STATES; i++) {
            busy_world(&world, STEPS[i]);
            bytes[i] = talus_world_save_size(&world);
            most = bytes[i] > most ? bytes[i] : most;
            snapshot[i] = aligned(bytes[i]);
            MUST(talus_world_save(&world, snapshot[i], bytes[i], &bytes[i]));
        }
        broken = aligned(most);
    }
    if (size < 1u) {
        return 0;
    }
    uint32_t k = data[0] % STATES;
    memcpy(broken, snapshot[k], bytes[k]);
    for (size_t i = 1; i + 4u <= size; i += 4u) { /* where: 24 bits; what: 8 */
        size_t at = ((size_t)data[i] | (size_t)data[i + 1u] << 8 | (size_t)data[i + 2u] << 16) % bytes[k];
        broken[at] = data[i + 3u];
    }
    uint64_t sum = tl_pack_checksum(broken + 20, bytes[k] - 20u); /* as one who forges it would */
    tl_put_word(broken + 12, (uint32_t)sum);
    tl_put_word(broken + 16, (uint32_t)(sum >> 32));
    if (talus_world_restore(&world, broken, bytes[k]) == TALUS_OK && talus_world_validate(&world) == TALUS_OK) {
        for (int i = 0; i < 3; i++) {
            talus_world_step(&world, 1.0f / 60.0f, NULL, NULL);
        }
        talus_errors errors;
        talus_world_measure(&world, &errors);
        (void)talus_world_validate(&world);
        (void)talus_world_hash(&world);
    }
    MUST(talus_world_restore(&world, snapshot[k], bytes[k])); /* so that the next input finds a sound world */
    return 0;
}
