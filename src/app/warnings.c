#include "warnings.h"

#include "escape.h"
#include "json_text.h"

/* Linear tets lock where lambda is many mu. Beyond ten, a nu of 0.4545, the bar of models/bar bends
   a third less than with averaged dilatations, and at 0.495 two thirds less. */
#define MOST_LAMBDA 10.0

static json_t *locking(const corot_material *m) {
  double ratio = m->lambda / m->mu;
  char text[256];
  snprintf(
      text, sizeof text,
      "material%s%.64s: nu = %.4g: tets with a dilatation of their own are too stiff, the more "
      "so the nearer nu is to 0.5; dilatation: nodal is the remedy",
      m->group ? " of " : "", m->group ? m->group : "", 0.5 * ratio / (ratio + 1));
  return json_text_string(text);
}

json_t *warnings_list(const scenario *s) {
  json_t *list = json_array();
  if (s->dilatation == COROT_DILATATION_NODAL) return list;
  for (int i = 0; list && i < s->nmaterial; i++) {
    const corot_material *m = &s->material[i];
    if (!(m->lambda > MOST_LAMBDA * m->mu) || json_array_append_new(list, locking(m)) == 0)
      continue;
    json_decref(list);
    list = NULL;
  }
  return list;
}

void warnings_print(const scenario *s, const char *head, FILE *out) {
  json_t *list = warnings_list(s), *text;
  size_t i;
  json_array_foreach(list, i, text) {
    fputs(head, out);
    escape_line(json_string_value(text), out);
    fputc('\n', out);
  }
  json_decref(list);
}
