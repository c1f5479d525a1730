/* How far a file that grows has come, and going on from there: files of a run beside its
   checkpoint. */
#ifndef COROT_APP_FOLDER_GROWTH_H
#define COROT_APP_FOLDER_GROWTH_H

#include "core/base/pack.h"

typedef struct growth {
  long size;    /* bytes */
  uint64_t sum; /* of these, by growth_add; without it, as it began */
} growth;

static inline growth growth_begin(void) { return (growth){0, COROT_CHECKSUM}; }

/* So many bytes more. */
static inline void growth_add(growth *g, const void *data, size_t size) {
  g->size += (long)size;
  g->sum = corot_checksum(g->sum, data, size);
}

void growth_exchange(pack *p, growth *g);

/* Opens a file that has come that far, or further, to write where its contents of then end, and
   changes nothing. COROT_EFORMAT: it is not there, shorter, or, where the growth has a sum, other
   than it was. COROT_EIO. */
corot_status growth_reopen(const char *path, const growth *g, int *fd);

/* Takes away what has come since. */
corot_status growth_cut(int fd, const char *path, const growth *g);

#endif
