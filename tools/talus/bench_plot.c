/* The table of `talus bench queries` as SVG: time against vertices at one degree a step, and time against error at a
 * hundred vertices, of distances and of depths. Both axes are logarithmic. */
#include "bench_queries.h"
#include "plot.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#define WIDTH 1110
#define HEIGHT 730
#define PANEL_WIDTH 380.0
#define PANEL_HEIGHT 270.0
#define LEAST_ERROR 1e-16 /* what is right to the last bit is drawn here */

static double error_of(const bench_row *r) { return fmax(r->mean_error, LEAST_ERROR); }

/* The range of a panel's rows, in whole powers of ten. */
static void fit_range(const bench_table *t, int overlapping, int by_error, double degrees, uint32_t vertices,
                      plot_panel *p) {
    p->low_x = p->low_y = HUGE_VAL, p->high_x = p->high_y = -HUGE_VAL;
    for (uint32_t i = 0; i < t->count; i++) {
        const bench_row *r = &t->rows[i];
        if (r->method->overlapping != overlapping || (by_error && r->method->yes_or_no) ||
            (by_error ? r->vertices != vertices : r->degrees != degrees)) {
            continue;
        }
        double x = log10(by_error ? error_of(r) : (double)r->vertices), y = log10(r->least);
        p->low_x = fmin(p->low_x, x), p->high_x = fmax(p->high_x, x);
        p->low_y = fmin(p->low_y, y), p->high_y = fmax(p->high_y, y);
    }
    p->low_y = floor(p->low_y), p->high_y = ceil(p->high_y);
    p->low_x = by_error ? floor(p->low_x) : p->low_x - 0.05;
    p->high_x = by_error ? ceil(p->high_x) : p->high_x + 0.05;
}

static int is_drawn(const bench_row *r, const bench_method *m, int by_error, double degrees, uint32_t vertices) {
    return r->method == m && (by_error ? r->vertices == vertices && !m->yes_or_no : r->degrees == degrees);
}

static void draw_method(const bench_table *t, const bench_method *m, const plot_panel *p, int by_error, double degrees,
                        uint32_t vertices, int color, gltf_text *out) {
    int points = 0;
    for (uint32_t i = 0; i < t->count && !by_error; i++) {
        const bench_row *r = &t->rows[i];
        if (is_drawn(r, m, by_error, degrees, vertices)) {
            gltf_text_add(out, points++ ? " " : "<polyline class=\"l\" stroke=\"var(--c%d)\" points=\"", color);
            gltf_text_add(out, "%.1f,%.1f", plot_across(p, (double)r->vertices), plot_down(p, r->least));
        }
    }
    if (points > 0) {
        gltf_text_add(out, "\"/>\n");
    }
    for (uint32_t i = 0; i < t->count; i++) {
        const bench_row *r = &t->rows[i];
        if (is_drawn(r, m, by_error, degrees, vertices)) {
            gltf_text_add(
                out, "<circle fill=\"var(--c%d)\" cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\"><title>%s, %" PRIu32 " vertices, ",
                color, plot_across(p, by_error ? error_of(r) : (double)r->vertices), plot_down(p, r->least), m->label,
                r->vertices);
            gltf_text_add(out, r->degrees == BENCH_RANDOM ? "random" : "%g degrees a step", r->degrees);
            gltf_text_add(out, ": %.0f ns, error %.1e</title></circle>\n", r->least, r->mean_error);
        }
    }
}

static void draw_row(const bench_table *t, int overlapping, double y, uint32_t vertices, gltf_text *out) {
    const char *what = overlapping ? "Depth" : "Distance";
    for (int by_error = 0; by_error < 2; by_error++) {
        char title[96];
        plot_panel p = {70.0 + 470.0 * by_error, y, PANEL_WIDTH, PANEL_HEIGHT, 0.0, 0.0, 0.0, 0.0};
        fit_range(t, overlapping, by_error, 1.0, vertices, &p);
        if (by_error) {
            snprintf(title, sizeof title, "%s: time and error at %" PRIu32 " vertices, every motion", what, vertices);
        } else {
            snprintf(title, sizeof title, "%s: time at 1 degree a step", what);
        }
        plot_axes(&p, title, by_error ? "mean relative error" : "vertices of each hull", plot_number, plot_nanoseconds,
                  out);
        int color = 0;
        for (int i = 0; i < bench_own_count + bench_ccd_count; i++) {
            const bench_method *m =
                i < bench_own_count ? &bench_own_methods[i] : &bench_ccd_methods[i - bench_own_count];
            if (m->overlapping != overlapping) {
                continue;
            }
            draw_method(t, m, &p, by_error, 1.0, vertices, color, out);
            if (by_error) {
                double at = y + 12.0 + 22.0 * color;
                gltf_text_add(out, "<circle fill=\"var(--c%d)\" cx=\"945\" cy=\"%.1f\" r=\"5\"/>", color, at);
                gltf_text_add(out, "<text x=\"958\" y=\"%.1f\">%s</text>\n", at + 4.0, m->label);
            }
            color++;
        }
    }
}

void bench_plot(const bench_table *t, gltf_text *out) {
    uint32_t vertices = t->rows[0].vertices; /* the most that is no more than a hundred */
    for (uint32_t i = 0; i < t->count; i++) {
        vertices = t->rows[i].vertices <= 100u ? t->rows[i].vertices : vertices;
    }
    plot_begin(WIDTH, HEIGHT, out);
    draw_row(t, 0, 40.0, vertices, out);
    draw_row(t, 1, 410.0, vertices, out);
    plot_end(out);
}
