/* The names of a table's rows, for a message. */
#ifndef COROT_CORE_BASE_NAMES_H
#define COROT_CORE_BASE_NAMES_H

#include <stdio.h>

enum { NAMES_SIZE = 256 };

/* text = "a, b or c"; name(i) is NULL beyond the last. */
static inline const char *names_list(const char *(*name)(int i), char text[NAMES_SIZE]) {
  size_t at = 0;
  for (int i = 0; name(i) && at < NAMES_SIZE; i++) {
    const char *between = i == 0 ? "" : name(i + 1) ? ", " : " or ";
    at += (size_t)snprintf(text + at, NAMES_SIZE - at, "%s%s", between, name(i));
  }
  return text;
}

#endif
