/* What is wrong with a scene, and how that is told: "$.nodes[3].rotation: what, and what is allowed". */
#ifndef TALUS_GLTF_ERROR_H
#define TALUS_GLTF_ERROR_H

/* The exit statuses of the tool as well. */
typedef enum gltf_status {
    GLTF_OK = 0,
    GLTF_FAILED = 1,      /* the machine could not: no memory, no such file */
    GLTF_UNSUPPORTED = 3, /* a sound scene that asks for what is not there */
    GLTF_BROKEN = 4       /* the file does not hold what it should */
} gltf_status;

/* Only the first error is kept. */
typedef struct gltf_error {
    gltf_status status;
    char text[640];
} gltf_error;

#if defined(__GNUC__)
#define GLTF_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define GLTF_PRINTF(text, first)
#endif

void gltf_error_set(gltf_error *error, gltf_status status, const char *format, ...) GLTF_PRINTF(3, 4);

#endif
