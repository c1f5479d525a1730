/* The faults of a tree, the first ones by place. */
#include "config.h"

#include <stdio.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "core/base/fault.h"

typedef struct fault {
  const char *message;
  bool placed, in_file;
  size_t at; /* in the file */
} fault;

struct config_faults {
  fault fault[CONFIG_MOST_FAULTS];
  int nfault; /* of these */
  long count; /* in all */
};

/* Where the last failure was, and which it was. Its source may be gone by the time it is kept. */
static _Thread_local struct {
  bool placed, in_file;
  size_t at;
  long number;
} failed;

void config_failed_at(const config_source *source, size_t at) {
  failed.placed = source;
  failed.in_file = source && source->lines;
  failed.at = at;
  failed.number = corot_fail_count();
}

/* Files come before --set, and what has no place comes last. */
static bool is_before(const fault *a, const fault *b) {
  if (a->placed != b->placed) return a->placed;
  if (a->in_file != b->in_file) return a->in_file;
  return a->in_file && a->at < b->at;
}

corot_status config_keep(config *tree, corot_status status) {
  if (status != COROT_EFORMAT && status != COROT_EINVAL) return status;
  bool placed = failed.number == corot_fail_count() && failed.placed;
  bool in_file = placed && failed.in_file;
  fault f = {.placed = placed, .in_file = in_file, .at = in_file ? failed.at : 0};
  if (!tree->faults) tree->faults = config_alloc(tree, 1, sizeof *tree->faults);
  if (!tree->faults) return no_memory();
  struct config_faults *all = tree->faults;

  /* between those before and those behind it, which lose the last one where they are many */
  int i = all->nfault;
  while (i > 0 && is_before(&f, &all->fault[i - 1])) i--;
  all->count++;
  if (i == CONFIG_MOST_FAULTS) return COROT_OK;
  f.message = config_copy(tree, corot_error(), strlen(corot_error()));
  if (!f.message) return no_memory();
  if (all->nfault < CONFIG_MOST_FAULTS) all->nfault++;
  memmove(&all->fault[i + 1], &all->fault[i], (size_t)(all->nfault - 1 - i) * sizeof f);
  all->fault[i] = f;
  return COROT_OK;
}

corot_status config_kept(config *tree) {
  enum { ROOM = 3900 }; /* of corot_error() */
  struct config_faults *all = tree->faults;
  if (!all) return COROT_OK;
  char text[ROOM + 64];
  size_t used = 0;
  long shown = 0;
  tree->faults = NULL;
  for (; shown < all->nfault; shown++) {
    size_t length = strlen(all->fault[shown].message);
    if (shown > 0 && used + 1 + length > ROOM) break;
    used += (size_t)snprintf(text + used, ROOM - used, "%s%s", shown ? "\n" : "",
                             all->fault[shown].message);
    if (used >= ROOM) used = ROOM - 1;
  }
  if (shown < all->count)
    snprintf(text + used, sizeof text - used, "\nand %ld more", all->count - shown);
  return corot_fail(COROT_EFORMAT, "%s", text);
}
