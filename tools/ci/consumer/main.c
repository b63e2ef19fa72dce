/* A program of somebody else's: a ball falls for a second. */
#include <stdio.h>
#include <stdlib.h>

#include <talus/talus.h>

int main(void) {
    talus_world_def def = talus_world_def_default();
    size_t size = talus_world_size(&def);
    char *memory = malloc(size + TALUS_BLOCK_ALIGNMENT);
    char *block = memory + (TALUS_BLOCK_ALIGNMENT - (uintptr_t)memory % TALUS_BLOCK_ALIGNMENT);
    talus_world world;
    talus_body_def ball = talus_body_def_default();
    talus_body body;
    talus_pose pose;
    ball.type = TALUS_DYNAMIC;
    if (!memory || talus_world_init(&world, &def, block, size) != TALUS_OK ||
        talus_body_create(&world, &ball, &body) != TALUS_OK) {
        return 1;
    }
    for (int i = 0; i < 60; i++) {
        talus_world_step(&world, 1.0f / 60.0f, NULL, NULL);
    }
    talus_body_get_pose(&world, body, &pose);
    printf("%.3f\n", (double)pose.position.y);
    free(memory);
    return pose.position.y > -4.9f || pose.position.y < -4.91f;
}
