/* Shared by the targets that read scenarios. */
#include "resolved.h"

#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"

/* libfyaml 0.7.12 loses its buffer of a very long token that ends in an error. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) { return "leak:libfyaml\n"; }

static char *to_text(const json_t *value) {
  char *text = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&text, &size);
  if (!stream) abort();
  json_text_write(value, stream);
  fclose(stream);
  return text;
}

void check_resolved(const scenario *s) {
  char *text = to_text(s->resolved);
  scenario *again = NULL;
  if (scenario_read_text("resolved.yaml", text, strlen(text), 0, NULL, &again)) {
    fprintf(stderr, "%s\n%s", corot_error(), text);
    abort();
  }
  if (!json_equal(s->resolved, again->resolved)) abort();
  scenario_destroy(again);
  free(text);
}
