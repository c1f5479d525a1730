/* The table of the multilevel preconditioners. */
#include "linsol_multilevel.h"

#include <string.h>

const multilevel_ops *corot_multilevel_find(const char *name) {
  static const multilevel_ops *const known[] = {&corot_hierarchical_basis, &corot_multigrid,
                                                &corot_amg};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    if (strcmp(known[k]->name, name) == 0) return known[k];
  return NULL;
}
