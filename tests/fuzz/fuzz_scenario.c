/* Any bytes as a scenario: a scenario or a message, never a crash. The first byte chooses YAML or
   JSON; what follows a byte 0xFF is an override. What is accepted resolves to itself. */
#include <stdlib.h>
#include <string.h>

#include "app/scenario/scenario.h"
#include "resolved.h"

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

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
