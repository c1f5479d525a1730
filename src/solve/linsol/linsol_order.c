/* Orders of little fill, by other people's libraries. */
#include <string.h>
#include <suitesparse/amd.h>

#include "linsol_graph.h"
#ifdef COROT_HAVE_METIS
#include "linsol_metis.h"
#endif

static corot_status order_amd(const node_graph *g, int *order) {
  int status = amd_order(g->n, g->colptr, g->row, order, NULL, NULL);
  if (status == AMD_OK) return COROT_OK;
  if (status == AMD_OUT_OF_MEMORY)
    return corot_fail(COROT_ENOMEM, "amd: no memory to order %d nodes", g->n);
  return corot_fail(COROT_EINVAL, "amd: cannot order %d nodes", g->n);
}

static const struct {
  const char *name;
  corot_status (*order)(const node_graph *g, int *order);
} orderings[] = {
    {"amd", order_amd},
#ifdef COROT_HAVE_METIS
    {"metis", corot_graph_order_metis},
#endif
};

corot_status corot_graph_order(const node_graph *g, const char *ordering, int *order) {
  for (size_t k = 0; k < sizeof orderings / sizeof *orderings; k++)
    if (strcmp(orderings[k].name, ordering) == 0) return orderings[k].order(g, order);
  return corot_fail(
      COROT_EINVAL,
      "ordering %s is not in this build (it wants METIS, with its header, and CHOLMOD: "
      "configure with COROT_CHOLMOD=ON)",
      ordering);
}
