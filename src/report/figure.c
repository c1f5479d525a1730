#include "figure.h"

#include <stddef.h>

#include "encode.h"
#include "markup.h"

static void write_series(const figure_series *s, FILE *out) {
  static const char *const style[] = {"line", "steps", "points", "marked"};
  fputs("{\"name\":", out);
  encode_text(s->name, out);
  fprintf(out, ",\"style\":\"%s\",\"x\":", style[s->style]);
  encode_doubles((size_t)s->n, s->x, out);
  fputs(",\"y\":", out);
  encode_doubles((size_t)s->n, s->y, out);
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
