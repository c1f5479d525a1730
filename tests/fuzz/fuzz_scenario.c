/* Any bytes as a scenario: a scenario or a message, never a crash. The first byte chooses YAML or
   JSON; what follows a byte 0xFF is an override. What is accepted resolves to itself. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/json_text.h"
#include "app/scenario.h"

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

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

static void check_resolved(const scenario *s) {
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

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size) {
  if (size == 0) return 0;
  const char *path = data[0] & 1 ? "f.json" : "f.yaml";
  const unsigned char *end = memchr(data, 0xFF, size);
  size_t length = end ? (size_t)(end - data) : size;
  char *override = NULL;
  if (end) {
    override = calloc(size - length + 1, 1);
    if (!override) abort();
    memcpy(override, end + 1, size - length - 1);
  }
  scenario *s = NULL;
  size_t first = length > 0;
  if (!scenario_read_text(path, (const char *)data + first, length - first, override != NULL,
                          &override, &s))
    check_resolved(s);
  scenario_destroy(s);
  free(override);
  return 0;
}
