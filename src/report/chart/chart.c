/* Lays out axes, series and legend, and writes them as SVG. */
#include "chart.h"

#include <math.h>
#include <string.h>

#include "report/page/markup.h"
#include "ticks.h"

/* All lengths are in the units of the picture, 640 of them wide. */
enum {
  WIDTH = 640,
  LEFT = 78,
  RIGHT = 16,
  PLOT_HEIGHT = 340,
  FONT = 13,
  LEGEND_ROW = 20,
  LEGEND_KEY = 42,
  LEGEND_NAME = 44, /* characters */
  TITLE = 70,
  NCOLOUR = 8,
  NMARKER = 8,
};

static const char style[] =
    "<style>\n"
    "text{font:13px system-ui,'Helvetica Neue',Arial,'DejaVu Sans',sans-serif;fill:#1b1f24}\n"
    ".title{font-size:16px;font-weight:600}.note,.tick{fill:#4a5159}.tick{font-size:12px}\n"
    ".paper{fill:#fff}.grid{stroke:#e4e7eb}.minor{stroke:#f1f3f5}.frame{fill:none;stroke:#6a737d}\n"
    ".floor{fill:#d7dbe0;fill-opacity:.6}.edge{stroke:#6a737d;stroke-dasharray:6 4}\n"
    ".line{fill:none;stroke-width:1.6;stroke-linejoin:round}.bar{stroke-width:1}\n"
    ".mark{stroke-width:1.5}.hollow .mark{fill:#fff}\n"
    ".c0{stroke:#0065a8;fill:#0065a8}.c1{stroke:#c94f00;fill:#c94f00}\n"
    ".c2{stroke:#00805c;fill:#00805c}.c3{stroke:#a8327e;fill:#a8327e}\n"
    ".c4{stroke:#7a5c00;fill:#7a5c00}.c5{stroke:#5b4bc4;fill:#5b4bc4}\n"
    ".c6{stroke:#b3261e;fill:#b3261e}.c7{stroke:#3d6b78;fill:#3d6b78}\n"
    "@media(prefers-color-scheme:dark){text{fill:#e6e9ec}.note,.tick{fill:#aeb6bf}\n"
    ".paper,.hollow .mark{fill:#14181d}.grid{stroke:#2a3038}.minor{stroke:#1f242b}\n"
    ".frame,.edge{stroke:#8b949e}.floor{fill:#3a424c}\n"
    ".c0{stroke:#5db3f0;fill:#5db3f0}.c1{stroke:#ff9248;fill:#ff9248}\n"
    ".c2{stroke:#3fcf9f;fill:#3fcf9f}.c3{stroke:#f28bc7;fill:#f28bc7}\n"
    ".c4{stroke:#e0b83d;fill:#e0b83d}.c5{stroke:#a79bff;fill:#a79bff}\n"
    ".c6{stroke:#ff7d73;fill:#ff7d73}.c7{stroke:#8fc3d1;fill:#8fc3d1}}\n"
    "</style>\n";

/* Paths about the origin, each some 9 across. */
static const char *const marker[NMARKER] = {
    "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z",
    "M-3.6-3.6h7.2v7.2h-7.2z",
    "M0-4.8l4.4 7.8h-8.8z",
    "M0-5l5 5l-5 5l-5-5z",
    "M0 4.8l4.4-7.8h-8.8z",
    "M-4.2-1.5h2.7v-2.7h3v2.7h2.7v3h-2.7v2.7h-3v-2.7h-2.7z",
    "M0-5l1.4 3.2h3.4l-2.7 2.3l1 3.7l-3.1-2l-3.1 2l1-3.7l-2.7-2.3h3.4z",
    "M-4.6-2.6h9.2v5.2h-9.2z",
};

static const char no_points[] = " (no points)";

/* The chart and where its parts are. */
typedef struct layout {
  const chart *chart;
  axis_range x, y;
  double top, bottom, height; /* of the plot, and of the picture */
  int columns, column_width;  /* of the legend */
} layout;

static bool drawn(const chart *c, const chart_series *s, int i) {
  return axis_takes(c->x.log, s->x[i]) && axis_takes(c->y.log, s->y[i]);
}

static bool any_drawn(const chart *c, int k) {
  for (int i = 0; i < c->series[k].npoint; i++)
    if (drawn(c, &c->series[k], i)) return true;
  return false;
}

int chart_skipped(const chart *c) {
  int n = 0;
  for (int s = 0; s < c->nseries; s++)
    for (int i = 0; i < c->series[s].npoint; i++) n += !drawn(c, &c->series[s], i);
  return n;
}

static void reach(axis_range *r, double x) {
  if (!axis_takes(r->log, x)) return;
  r->low = fmin(r->low, x);
  r->high = fmax(r->high, x);
}

static void find_ranges(layout *l) {
  const chart *c = l->chart;
  axis_range x = {INFINITY, -INFINITY, c->x.log}, y = {INFINITY, -INFINITY, c->y.log};
  for (int k = 0; k < c->nseries; k++) {
    const chart_series *s = &c->series[k];
    for (int i = 0; i < s->npoint; i++) {
      if (!drawn(c, s, i)) continue;
      reach(&x, s->x[i]);
      reach(&y, s->y[i]);
      if (s->x_low) reach(&x, s->x_low[i]);
      if (s->x_high) reach(&x, s->x_high[i]);
    }
  }
  reach(&y, c->floor);
  l->x = axis_range_of(2, (double[]){x.low, x.high}, c->x.log);
  l->y = axis_range_of(2, (double[]){y.low, y.high}, c->y.log);
}

static void lay_out(layout *l) {
  const chart *c = l->chart;
  find_ranges(l);
  int longest = 0;
  for (int k = 0; k < c->nseries; k++) {
    int length = markup_length(c->series[k].name);
    if (length > LEGEND_NAME) length = LEGEND_NAME;
    if (!any_drawn(c, k)) length += (int)strlen(no_points);
    if (length > longest) longest = length;
  }
  l->column_width = LEGEND_KEY + longest * FONT * 6 / 10 + 12;
  l->columns = (WIDTH - 2 * RIGHT) / l->column_width;
  if (l->columns < 1) l->columns = 1;
  int rows = (c->nseries + l->columns - 1) / l->columns;
  l->top = 16 + (c->title ? 24 : 0) + (c->note ? 20 : 0);
  l->bottom = l->top + PLOT_HEIGHT;
  l->height = l->bottom + 52 + rows * LEGEND_ROW + (chart_skipped(c) ? 20 : 0);
}

static double across(const layout *l, double x) {
  return LEFT + axis_place(&l->x, x) * (WIDTH - LEFT - RIGHT);
}

static double down(const layout *l, double y) {
  return l->bottom - axis_place(&l->y, y) * PLOT_HEIGHT;
}

static void open_text(FILE *out, const char *class, const char *anchor, double x, double y) {
  fprintf(out, "<text class=\"%s\" text-anchor=\"%s\" x=\"%.1f\" y=\"%.1f\">", class, anchor, x, y);
}

static void text_at(FILE *out, const char *class, const char *anchor, double x, double y,
                    const char *text) {
  open_text(out, class, anchor, x, y);
  markup_text(out, text);
  fputs("</text>\n", out);
}

static void tick_label(FILE *out, const char *anchor, double x, double y, const tick *t) {
  int base = (int)strcspn(t->label, "^");
  open_text(out, "tick", anchor, x, y);
  fprintf(out, "%.*s", base, t->label);
  if (t->label[base])
    fprintf(out, "<tspan dy=\"-5\" font-size=\"10\">%s</tspan>", t->label + base + 1);
  fputs("</text>\n", out);
}

static void write_ticks(const layout *l, FILE *out) {
  tick ticks[TICKS_MAX];
  int n = axis_ticks(&l->x, 7, ticks);
  for (int i = 0; i < n; i++) {
    double x = across(l, ticks[i].at);
    bool minor = !ticks[i].label[0];
    fprintf(out, "<path class=\"%s\" d=\"M%.2f %.2fV%.2f\"/>\n", minor ? "minor" : "grid", x,
            l->top, l->bottom);
    if (!minor) tick_label(out, "middle", x, l->bottom + 18, &ticks[i]);
  }
  n = axis_ticks(&l->y, 8, ticks);
  for (int i = 0; i < n; i++) {
    double y = down(l, ticks[i].at);
    bool minor = !ticks[i].label[0];
    fprintf(out, "<path class=\"%s\" d=\"M%d %.2fH%d\"/>\n", minor ? "minor" : "grid", LEFT, y,
            WIDTH - RIGHT);
    if (!minor) tick_label(out, "end", LEFT - 8, y + 4, &ticks[i]);
  }
}

static void write_axes(const layout *l, FILE *out) {
  const chart *c = l->chart;
  write_ticks(l, out);
  fprintf(out, "<rect class=\"frame\" x=\"%d\" y=\"%.0f\" width=\"%d\" height=\"%d\"/>\n", LEFT,
          l->top, WIDTH - LEFT - RIGHT, PLOT_HEIGHT);
  text_at(out, "label", "middle", (LEFT + WIDTH - RIGHT) / 2.0, l->bottom + 40, c->x.label);
  double middle = (l->top + l->bottom) / 2;
  fprintf(out,
          "<text class=\"label\" text-anchor=\"middle\" transform=\"translate(18 %.0f)"
          "rotate(-90)\">",
          middle);
  markup_text(out, c->y.label);
  fputs("</text>\n", out);
}

static void write_floor(const layout *l, FILE *out) {
  const chart *c = l->chart;
  if (!axis_takes(c->y.log, c->floor)) return;
  double y = down(l, c->floor);
  fprintf(out, "<rect class=\"floor\" x=\"%d\" y=\"%.2f\" width=\"%d\" height=\"%.2f\"/>\n", LEFT,
          y, WIDTH - LEFT - RIGHT, l->bottom - y);
  fprintf(out, "<path class=\"edge\" d=\"M%d %.2fH%d\"/>\n", LEFT, y, WIDTH - RIGHT);
  text_at(out, "note", "start", LEFT + 8, y - 6, c->floor_label ? c->floor_label : "floor");
}

static void begin_series(int k, FILE *out) {
  static const char *const dashes[] = {"", "7 3", "2 3", "9 3 2 3"};
  const char *dash = dashes[k / NCOLOUR % 4];
  fprintf(out, "<g class=\"series c%d%s\"", k % NCOLOUR, k / NMARKER % 2 ? " hollow" : "");
  if (*dash) fprintf(out, " stroke-dasharray=\"%s\"", dash);
  fputs(">\n", out);
}

static void write_mark(int k, double x, double y, FILE *out) {
  fprintf(out,
          "<path class=\"mark\" stroke-dasharray=\"none\" transform=\"translate(%.2f %.2f)\""
          " d=\"%s\"/>\n",
          x, y, marker[k % NMARKER]);
}

static void write_series(const layout *l, int k, FILE *out) {
  const chart_series *s = &l->chart->series[k];
  begin_series(k, out);
  bool joined = false;
  fputs("<path class=\"line\" d=\"", out);
  for (int i = 0; i < s->npoint; i++) {
    bool on = drawn(l->chart, s, i);
    if (on) fprintf(out, "%c%.2f %.2f", joined ? 'L' : 'M', across(l, s->x[i]), down(l, s->y[i]));
    joined = on;
  }
  fputs("\"/>\n", out);
  for (int i = 0; i < s->npoint; i++) {
    if (!drawn(l->chart, s, i)) continue;
    double y = down(l, s->y[i]);
    if (s->x_low && axis_takes(l->x.log, s->x_low[i]) && axis_takes(l->x.log, s->x_high[i]))
      fprintf(out, "<path class=\"bar\" d=\"M%.2f %.2fH%.2f\"/>\n", across(l, s->x_low[i]), y,
              across(l, s->x_high[i]));
    write_mark(k, across(l, s->x[i]), y, out);
  }
  fputs("</g>\n", out);
}

static void write_legend(const layout *l, FILE *out) {
  for (int k = 0; k < l->chart->nseries; k++) {
    double x = RIGHT + k % l->columns * l->column_width;
    double y = l->bottom + 62 + k / l->columns * LEGEND_ROW;
    begin_series(k, out);
    fprintf(out, "<path class=\"line\" d=\"M%.0f %.0fh32\"/>\n", x, y);
    write_mark(k, x + 16, y, out);
    fprintf(out, "</g>\n<text x=\"%.0f\" y=\"%.1f\"><title>", x + LEGEND_KEY, y + 4.5);
    markup_text(out, l->chart->series[k].name);
    fputs("</title>", out);
    markup_text_cut(out, l->chart->series[k].name, LEGEND_NAME);
    fprintf(out, "%s</text>\n", any_drawn(l->chart, k) ? "" : no_points);
  }
}

static void write_heading(const layout *l, FILE *out) {
  const chart *c = l->chart;
  if (c->title) {
    open_text(out, "title", "start", RIGHT, 24);
    markup_text_cut(out, c->title, TITLE);
    fputs("</text>\n", out);
  }
  if (c->note) text_at(out, "note", "start", RIGHT, c->title ? 46 : 22, c->note);
  int skipped = chart_skipped(c);
  if (!skipped) return;
  char text[96];
  snprintf(text, sizeof text, "%d point%s not drawn: not finite%s", skipped,
           skipped == 1 ? "" : "s", c->x.log || c->y.log ? ", or not above zero" : "");
  text_at(out, "note", "start", RIGHT, l->height - 8, text);
}

void chart_write(const chart *c, FILE *out) {
  layout l = {.chart = c};
  lay_out(&l);
  fprintf(out,
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %.0f\" width=\"%d\""
          " height=\"%.0f\" role=\"img\">\n" CHART_MARK "\n<title>",
          WIDTH, l.height, WIDTH, l.height);
  markup_text(out, c->title ? c->title : c->y.label);
  fprintf(out, "</title>\n%s<rect class=\"paper\" width=\"100%%\" height=\"100%%\"/>\n", style);
  write_heading(&l, out);
  write_axes(&l, out);
  write_floor(&l, out);
  for (int k = 0; k < c->nseries; k++) write_series(&l, k, out);
  if (chart_skipped(c) == 0 && c->nseries == 0)
    text_at(out, "note", "middle", (LEFT + WIDTH - RIGHT) / 2.0, (l.top + l.bottom) / 2,
            "no points");
  write_legend(&l, out);
  fputs("</svg>\n", out);
}
