/* The table of `talus bench solver` as SVG: a row of panels a scene, of each error that it can have the time of a step
 * against it. What stands on the front is drawn full. */
#include "bench_solver.h"
#include "plot.h"

#include <math.h>
#include <stdio.h>

#define LEFT 60.0
#define TOP 70.0
#define PANEL_WIDTH 180.0
#define PANEL_HEIGHT 130.0
#define COLUMN 250.0 /* from a panel to the next */
#define ROW 205.0

static double error_of(const solver_row *r, int e) { return fmax(r->errors[e], SOLVER_LEAST_ERROR); }

static void fit_range(const solver_case *c, int e, plot_panel *p) {
    p->low_x = p->low_y = HUGE_VAL, p->high_x = p->high_y = -HUGE_VAL;
    for (uint32_t i = 0; i < c->rows; i++) {
        double x = log10(error_of(&c->row[i], e)), y = log10(1e6 * c->row[i].ms);
        p->low_x = fmin(p->low_x, x), p->high_x = fmax(p->high_x, x);
        p->low_y = fmin(p->low_y, y), p->high_y = fmax(p->high_y, y);
    }
    p->low_x = floor(p->low_x), p->low_y = floor(p->low_y);
    p->high_x = fmax(ceil(p->high_x), p->low_x + 1.0), p->high_y = fmax(ceil(p->high_y), p->low_y + 1.0);
}

static void draw_series(const solver_case *c, int e, solver_series series, const plot_panel *p, gltf_text *out) {
    int points = 0;
    for (uint32_t i = 0; i < c->rows && series != SOLVER_OTHERS; i++) {
        if (c->row[i].setting->series == series) {
            gltf_text_add(out, points++ > 0 ? " " : "<polyline class=\"l\" stroke=\"var(--c%d)\" points=\"",
                          (int)series);
            gltf_text_add(out, "%.1f,%.1f", plot_across(p, error_of(&c->row[i], e)), plot_down(p, 1e6 * c->row[i].ms));
        }
    }
    gltf_text_add(out, "%s", points > 0 ? "\"/>\n" : "");
    for (uint32_t i = 0; i < c->rows; i++) {
        const solver_row *r = &c->row[i];
        if (r->setting->series == series) {
            char color[16];
            snprintf(color, sizeof color, "c%d", (int)series);
            gltf_text_add(out, "<circle stroke=\"var(--c%d)\" fill=\"var(--%s)\" cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\">",
                          (int)series, r->front[e] ? color : "b", plot_across(p, error_of(r, e)),
                          plot_down(p, 1e6 * r->ms));
            gltf_text_add(out, "<title>%s: %.4f ms, %.4f mm</title></circle>\n", r->setting->name, r->ms,
                          1e3 * r->errors[e]);
        }
    }
}

static void draw_legend(gltf_text *out) {
    static const char *const names[SOLVER_SERIES_COUNT] = {"sub-steps, 1 iteration", "iterations, 4 sub-steps",
                                                           "iterations, 1 sub-step", "error budgets", "other settings"};
    double x = LEFT;
    for (int s = 0; s < SOLVER_SERIES_COUNT; s++) {
        gltf_text_add(out, "<circle fill=\"var(--c%d)\" cx=\"%.1f\" cy=\"20\" r=\"5\"/>", s, x);
        gltf_text_add(out, "<text x=\"%.1f\" y=\"24\">%s</text>\n", x + 12.0, names[s]);
        x += 170.0;
    }
    gltf_text_add(out, "<text x=\"%.1f\" y=\"24\">full: no other setting is as fast with less error</text>\n", x);
}

void solver_plot(const solver_table *t, gltf_text *out) {
    static const char *const titles[BENCH_ERROR_COUNT] = {"overlap, p99", "overlap, most", "joints apart", "drift",
                                                          "energy gained, as a lift"};
    plot_begin((int)(LEFT + BENCH_ERROR_COUNT * COLUMN), (int)(TOP + t->count * ROW), out);
    draw_legend(out);
    for (uint32_t i = 0; i < t->count; i++) {
        const solver_case *c = &t->cases[i];
        int column = 0;
        for (int e = 0; e < BENCH_ERROR_COUNT; e++) {
            char title[96];
            plot_panel p = {LEFT + COLUMN * column, TOP + ROW * i, PANEL_WIDTH, PANEL_HEIGHT, 0.0, 0.0, 0.0, 0.0};
            if (c->row[0].errors[e] < 0) {
                continue;
            }
            snprintf(title, sizeof title, "%s: %s", c->scene->name, titles[e]);
            fit_range(c, e, &p);
            plot_axes(&p, title, NULL, plot_metres, plot_nanoseconds, out);
            for (int s = 0; s < SOLVER_SERIES_COUNT; s++) {
                draw_series(c, e, (solver_series)s, &p, out);
            }
            column++;
        }
    }
    plot_end(out);
}
