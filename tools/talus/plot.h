/* Charts of two logarithmic axes as SVG, in light or dark as the reader's screen has it. */
#ifndef TALUS_TOOL_PLOT_H
#define TALUS_TOOL_PLOT_H

#include "gltf/text.h"

#define PLOT_COLORS 6 /* --c0 to --c5, to be told apart by eyes that see few colours */

typedef struct plot_panel {
    double x, y; /* of the left upper corner */
    double width, height;
    double low_x, high_x; /* powers of ten */
    double low_y, high_y;
} plot_panel;

/* What a power of ten is called: a plain number; of nanoseconds; of metres. "" for none. */
typedef void plot_namer(int power, char *out, size_t size);
plot_namer plot_number, plot_nanoseconds, plot_metres;

void plot_begin(int width, int height, gltf_text *out);
void plot_end(gltf_text *out);
/* Where a value stands. */
double plot_across(const plot_panel *p, double value);
double plot_down(const plot_panel *p, double value);
/* Grid, names of the powers, title above, the x axis' name below (null: neither). */
void plot_axes(const plot_panel *p, const char *title, const char *x_name, plot_namer *names_x, plot_namer *names_y,
               gltf_text *out);

#endif
