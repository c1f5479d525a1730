/* Streams into memory. */
#define _GNU_SOURCE
#include "text_stream.h"

#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#ifdef __GLIBC__

typedef struct growing {
  char **text;
  size_t *size, room;
} growing;

/* Writes all or nothing; 0 is a failure. */
static ssize_t append(void *cookie, const char *data, size_t n) {
  growing *g = cookie;
  if (g->room - *g->size <= n) {
    size_t room = 2 * (*g->size + n + 1);
    char *larger = realloc(*g->text, room);
    if (!larger) return 0;
    *g->text = larger;
    g->room = room;
  }
  memcpy(*g->text + *g->size, data, n);
  *g->size += n;
  (*g->text)[*g->size] = '\0';
  return (ssize_t)n;
}

static int forget(void *cookie) {
  free(cookie);
  return 0;
}

FILE *text_open(char **text, size_t *size) {
  enum { ROOM = 256 };
  growing *g = malloc(sizeof *g);
  *size = 0;
  *text = malloc(ROOM);
  FILE *out = NULL;
  if (g && *text) {
    **text = '\0';
    *g = (growing){.text = text, .size = size, .room = ROOM};
    out = fopencookie(g, "w", (cookie_io_functions_t){.write = append, .close = forget});
  }
  if (out) return out;
  free(g);
  free(*text);
  *text = NULL;
  return NULL;
}

#else

FILE *text_open(char **text, size_t *size) {
  *text = NULL;
  return open_memstream(text, size);
}

#endif

int text_close(FILE *out) {
  if (!out) return EOF;
  int failed = fflush(out) != 0 || ferror(out);
  return fclose(out) != 0 || failed ? EOF : 0;
}
