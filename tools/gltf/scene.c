#include "gltf/scene.h"

#include "gltf/loader.h"
#include "host/file.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NOTE_SIZE 200
#define MAX_NOTES 20u

int gltf_grow(gltf_error *error, void *array, uint32_t *room, uint32_t count, size_t size) {
    if (count < *room) {
        return 1;
    }
    void *old;
    memcpy(&old, array, sizeof old); /* any type of pointer */
    uint32_t larger = *room < 16 ? 16 : *room * 2;
    void *more = larger > *room && larger <= SIZE_MAX / size ? realloc(old, larger * size) : NULL;
    if (more == NULL) {
        gltf_error_set(error, GLTF_FAILED, "$: there is no memory for %lu elements", (unsigned long)larger);
        return 0;
    }
    memcpy(array, &more, sizeof more);
    *room = larger;
    return 1;
}

void gltf_scene_add_note(gltf_scene *scene, const char *format, ...) {
    char text[NOTE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    for (uint32_t i = 0; i < scene->note_count; i++) {
        if (strcmp(scene->notes[i], text) == 0) {
            return;
        }
    }
    gltf_error ignored;
    memset(&ignored, 0, sizeof ignored);
    char *copy = scene->note_count < MAX_NOTES ? malloc(strlen(text) + 1) : NULL;
    if (copy == NULL ||
        !gltf_grow(&ignored, &scene->notes, &scene->note_room, scene->note_count, sizeof *scene->notes)) {
        free(copy);
        return;
    }
    strcpy(copy, text);
    scene->notes[scene->note_count++] = copy;
}

static char *copy_text(const char *text) {
    char *copy = text != NULL ? malloc(strlen(text) + 1) : NULL;
    return copy != NULL ? strcpy(copy, text) : NULL;
}

static void read_extras(gltf_loader *loader) {
    gltf_scene *scene = loader->scene;
    gltf_list scenes = gltf_list_open(&loader->document.root, "scenes");
    if (scenes.count > loader->scene_index) {
        gltf_at info = gltf_list_item(&scenes, loader->scene_index), extras = gltf_member(&info, "extras");
        if (extras.json != NULL && !cJSON_IsObject(extras.json)) {
            extras.json = NULL; /* somebody else's */
        }
        double g[3] = {0, -9.81, 0};
        gltf_numbers(&extras, "gravity", g, 3, 1e6);
        scene->gravity = gltf_vec3(gltf_d3(g[0], g[1], g[2]));
        scene->dt = (float)gltf_number(&extras, "dt", 1.0 / 60, 1e-6, 1);
        scene->steps = (uint32_t)gltf_whole(&extras, "steps", 600, GLTF_MAX_STEPS);
        scene->name = copy_text(gltf_string(&info, "name"));
        scene->note = copy_text(gltf_string(&extras, "note"));
    }
    gltf_list_close(&scenes);
}

gltf_status gltf_scene_load(gltf_scene *scene, const void *bytes, size_t size, const char *folder, gltf_error *error) {
    memset(scene, 0, sizeof *scene);
    memset(error, 0, sizeof *error);
    gltf_loader *loader = calloc(1, sizeof *loader);
    if (loader == NULL) {
        gltf_error_set(error, GLTF_FAILED, "$: there is no memory");
        return error->status;
    }
    loader->scene = scene;
    loader->error = error;
    if (gltf_document_open(&loader->document, bytes, size, folder, error) && gltf_load_tree(loader) &&
        gltf_load_bodies(loader) && gltf_load_colliders(loader) && gltf_load_joints(loader)) {
        read_extras(loader);
    }
    gltf_document_close(&loader->document);
    gltf_table_free(&loader->shape_table);
    gltf_table_free(&loader->hull_table);
    gltf_table_free(&loader->geometry_table);
    free(loader->parent);
    free(loader->local);
    free(loader->place);
    free(loader->body);
    free(loader->body_node);
    free(loader->collider);
    free(loader->order);
    free(loader);
    if (error->status != GLTF_OK) {
        gltf_scene_free(scene);
    }
    return error->status;
}

gltf_status gltf_scene_load_file(gltf_scene *scene, const char *path, gltf_error *error) {
    memset(scene, 0, sizeof *scene);
    memset(error, 0, sizeof *error);
    unsigned char *bytes;
    size_t size;
    host_file_status status = host_file_read(path, GLTF_FILE_LIMIT, &bytes, &size);
    if (status == HOST_FILE_TOO_LARGE) {
        gltf_error_set(error, GLTF_UNSUPPORTED, "has more than %lu bytes", (unsigned long)GLTF_FILE_LIMIT);
        return error->status;
    }
    if (status != HOST_FILE_OK) {
        gltf_error_set(error, GLTF_FAILED, "%s",
                       status == HOST_FILE_NO_MEMORY ? "there is no memory" : strerror(errno));
        return error->status;
    }
    char *folder = copy_text(path);
    char *slash = folder != NULL ? strrchr(folder, '/') : NULL;
    if (slash != NULL) {
        slash[slash == folder] = 0; /* "/a.gltf" lies in "/" */
    } else if (folder != NULL) {
        strcpy(folder, "");
    }
    gltf_scene_load(scene, bytes, size, folder, error);
    free(folder);
    free(bytes);
    return error->status;
}

void gltf_scene_free(gltf_scene *scene) {
    for (uint32_t i = 0; i < scene->hull_count; i++) {
        free(scene->hulls[i].points);
    }
    for (uint32_t i = 0; i < scene->body_count; i++) {
        free(scene->bodies[i].name);
    }
    for (uint32_t i = 0; i < scene->collider_count; i++) {
        free(scene->colliders[i].name);
    }
    for (uint32_t i = 0; i < scene->note_count; i++) {
        free(scene->notes[i]);
    }
    free(scene->hulls);
    free(scene->geometries);
    free(scene->bodies);
    free(scene->colliders);
    free(scene->joints);
    free(scene->notes);
    free(scene->name);
    free(scene->note);
    memset(scene, 0, sizeof *scene);
}
