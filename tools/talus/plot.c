#include "plot.h"

#include <math.h>
#include <stdio.h>

#define NAME 50.0 /* of room that a name takes */

void plot_begin(int width, int height, gltf_text *out) {
    gltf_text_add(out,
                  "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\">\n"
                  "<style>svg{--b:#fff;--f:#222;--g:#ddd;--c0:#0072b2;--c1:#d55e00;--c2:#009e73;--c3:#b5367a;"
                  "--c4:#8a6d00;--c5:#666}\n"
                  "@media(prefers-color-scheme:dark){svg{--b:#16181c;--f:#ddd;--g:#363a42;--c0:#56b4e9;--c1:#ff8a3d;"
                  "--c2:#2fd0a0;--c3:#f07fb8;--c4:#e6c640;--c5:#aaa}}\n"
                  "text{font:12px sans-serif;fill:var(--f)}.t{font-weight:bold}.g{stroke:var(--g);fill:none}"
                  ".l{fill:none;stroke-width:1.5}</style>\n"
                  "<rect width=\"100%%\" height=\"100%%\" fill=\"var(--b)\"/>\n",
                  width, height, width, height);
}

void plot_end(gltf_text *out) { gltf_text_add(out, "</svg>\n"); }

double plot_across(const plot_panel *p, double value) {
    return p->x + (log10(value) - p->low_x) / (p->high_x - p->low_x) * p->width;
}

double plot_down(const plot_panel *p, double value) {
    return p->y + p->height - (log10(value) - p->low_y) / (p->high_y - p->low_y) * p->height;
}

void plot_number(int power, char *out, size_t size) {
    snprintf(out, size, power < 0 ? "1e%d" : "10<tspan dy=\"-5\" font-size=\"9\">%d</tspan>", power);
}

/* 1, 10 and 100 of one unit, then of the next. */
static void name(int power, const char *const *units, int count, char *out, size_t size) {
    static const char *const counts[] = {"1", "10", "100"};
    if (power >= 0 && power < 3 * count) {
        snprintf(out, size, "%s %s", counts[power % 3], units[power / 3]);
    } else {
        out[0] = 0;
    }
}

void plot_nanoseconds(int power, char *out, size_t size) {
    static const char *const units[] = {"ns", "µs", "ms", "s"};
    name(power, units, 4, out, size);
}

void plot_metres(int power, char *out, size_t size) {
    static const char *const units[] = {"nm", "µm", "mm", "m"};
    name(power + 9, units, 4, out, size);
}

void plot_axes(const plot_panel *p, const char *title, const char *x_name, plot_namer *names_x, plot_namer *names_y,
               gltf_text *out) {
    char label[64];
    if (title != NULL) {
        gltf_text_add(out, "<text class=\"t\" x=\"%.1f\" y=\"%.1f\">%s</text>\n", p->x, p->y - 12.0, title);
    }
    for (double power = ceil(p->low_x); power <= p->high_x;
         power += (p->high_x - p->low_x) * NAME > p->width ? 2.0 : 1.0) {
        double x = plot_across(p, pow(10.0, power));
        names_x((int)power, label, sizeof label);
        gltf_text_add(out, "<path class=\"g\" d=\"M%.1f %.1fv%.1f\"/>", x, p->y, p->height);
        gltf_text_add(out, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", x, p->y + p->height + 16.0,
                      label);
    }
    for (double power = ceil(p->low_y); power <= p->high_y; power += 1.0) {
        double y = plot_down(p, pow(10.0, power));
        names_y((int)power, label, sizeof label);
        gltf_text_add(out, "<path class=\"g\" d=\"M%.1f %.1fh%.1f\"/>", p->x, y, p->width);
        gltf_text_add(out, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", p->x - 6.0, y + 4.0, label);
    }
    if (x_name != NULL) {
        gltf_text_add(out, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", p->x + 0.5 * p->width,
                      p->y + p->height + 34.0, x_name);
    }
}
