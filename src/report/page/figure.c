/* A figure as JSON, with the points that a screen can show. */
#include "figure.h"

#include <stdlib.h>

#include "encode.h"
#include "markup.h"
#include "thin.h"

static void write_values(const char *name, int n, const double *value, const int *keep,
                         double *kept, FILE *out) {
  for (int i = 0; keep && i < n; i++) kept[i] = value[keep[i]];
  fprintf(out, ",\"%s\":", name);
  encode_doubles((size_t)n, keep ? kept : value, out);
}

/* Marked points are few, and in any order. Where memory is short all points are written. */
static void write_points(const figure_series *s, FILE *out) {
  bool many = s->style != FIGURE_MARKED && !s->note && s->n > THIN_MOST;
  int *keep = many ? malloc(THIN_MOST * sizeof *keep) : NULL;
  double *kept = keep ? malloc(THIN_MOST * sizeof *kept) : NULL;
  int n = kept ? thin(s->n, s->x, s->y, keep) : s->n;
  write_values("x", n, s->x, kept ? keep : NULL, kept, out);
  write_values("y", n, s->y, kept ? keep : NULL, kept, out);
  free(keep);
  free(kept);
}

static void write_series(const figure_series *s, FILE *out) {
  static const char *const style[] = {"line", "steps", "points", "marked"};
  fputs("{\"name\":", out);
  encode_text(s->name, out);
  fprintf(out, ",\"style\":\"%s\"", style[s->style]);
  write_points(s, out);
  if (s->note) {
    fputs(",\"note\":[", out);
    for (int i = 0; i < s->n; i++) {
      if (i) fputc(',', out);
      encode_text(s->note[i], out);
    }
    fputc(']', out);
  }
  fputc('}', out);
}

static void write_interval(const figure *f, FILE *out) {
  fputs(",\"interval\":[", out);
  encode_number(f->interval[0], out);
  fputc(',', out);
  encode_number(f->interval[1], out);
  fputs("],\"intervalLabel\":", out);
  encode_text(f->interval_label, out);
}

void figure_json(const figure *f, FILE *out) {
  fputs("{\"title\":", out);
  encode_text(f->title, out);
  fputs(",\"xLabel\":", out);
  encode_text(f->x_label, out);
  fputs(",\"yLabel\":", out);
  encode_text(f->y_label, out);
  fprintf(out, ",\"xLog\":%s,\"yLog\":%s,\"time\":%s,\"tall\":%s,\"whole\":%s,\"floor\":",
          f->x_log ? "true" : "false", f->y_log ? "true" : "false", f->time ? "true" : "false",
          f->tall ? "true" : "false", f->whole ? "true" : "false");
  encode_number(f->floor, out);
  if (f->interval) write_interval(f, out);
  fputs(",\"series\":[", out);
  for (int k = 0; k < f->nseries; k++) {
    if (k) fputc(',', out);
    write_series(&f->series[k], out);
  }
  fputs("]}", out);
}

void figure_write(const figure *f, FILE *out) {
  fputs("<figure class=\"chart\" id=\"", out);
  markup_text(out, f->id);
  fputs("\"><figcaption><h3>", out);
  markup_text(out, f->title);
  fputs("</h3>", out);
  if (f->caption) {
    fputs("<p>", out);
    markup_text(out, f->caption);
    fputs("</p>", out);
  }
  fputs("</figcaption>\n<script type=\"application/json\">", out);
  figure_json(f, out);
  fputs("</script></figure>\n", out);
}
