/* The names of the ways to cut a box into tets. */
#include "box_split.h"

#include <string.h>

static const struct {
  const char *name;
  corot_box_split split;
} splits[] = {{"kuhn", COROT_BOX_KUHN},
              {"alternating", COROT_BOX_ALTERNATING},
              {"symmetric", COROT_BOX_SYMMETRIC}};

bool box_split_find(const char *name, corot_box_split *split) {
  for (size_t k = 0; k < sizeof splits / sizeof *splits; k++)
    if (strcmp(name, splits[k].name) == 0) {
      *split = splits[k].split;
      return true;
    }
  return false;
}
