/* The environment decides (https://no-color.org). */
#include "colour.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool is_wanted(FILE *out) {
  const char *none = getenv("NO_COLOR"), *term = getenv("TERM");
  if ((none && *none) || !term || !*term || strcmp(term, "dumb") == 0) return false;
  int fd = fileno(out);
  return fd >= 0 && isatty(fd);
}

const char *colour_of(colour what, FILE *out) {
  static const char *const sequence[] = {
      [COLOUR_ERROR] = "\033[1;31m",
      [COLOUR_WARNING] = "\033[1;33m",
      [COLOUR_PLACE] = "\033[1;32m",
      [COLOUR_END] = "\033[0m",
  };
  return is_wanted(out) ? sequence[what] : "";
}
