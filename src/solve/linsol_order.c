/* Orders of little fill, by other people's libraries. */
#include <stdbool.h>
#include <string.h>
#include <suitesparse/amd.h>
#ifdef COROT_HAVE_METIS
#include <suitesparse/cholmod.h>
#endif

#include "solve/linsol_graph.h"

static corot_status refuse(const char *library, const node_graph *g, bool no_memory) {
  if (no_memory) return corot_fail(COROT_ENOMEM, "%s: no memory to order %d nodes", library, g->n);
  return corot_fail(COROT_EINVAL, "%s: cannot order %d nodes", library, g->n);
}

static corot_status order_amd(const node_graph *g, int *order) {
  int status = amd_order(g->n, g->colptr, g->row, order, NULL, NULL);
  return status == AMD_OK ? COROT_OK : refuse("amd", g, status == AMD_OUT_OF_MEMORY);
}

#ifdef COROT_HAVE_METIS
static corot_status order_metis(const node_graph *g, int *order) {
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  cholmod_sparse A = {.nrow = g->n,
                      .ncol = g->n,
                      .nzmax = g->colptr[g->n],
                      .p = g->colptr,
                      .i = g->row,
                      .stype = -1, /* of both triangles, look at the lower */
                      .itype = CHOLMOD_INT,
                      .xtype = CHOLMOD_PATTERN,
                      .dtype = CHOLMOD_DOUBLE,
                      .sorted = 1,
                      .packed = 1};
  int done = cholmod_metis(&A, NULL, 0, 0, order, &common), status = common.status;
  cholmod_finish(&common);
  return done ? COROT_OK : refuse("metis", g, status == CHOLMOD_OUT_OF_MEMORY);
}
#endif

static const struct {
  const char *name;
  corot_status (*order)(const node_graph *g, int *order);
} orderings[] = {
    {"amd", order_amd},
#ifdef COROT_HAVE_METIS
    {"metis", order_metis},
#endif
};

corot_status corot_graph_order(const node_graph *g, const char *ordering, int *order) {
  for (size_t k = 0; k < sizeof orderings / sizeof *orderings; k++)
    if (strcmp(orderings[k].name, ordering) == 0) return orderings[k].order(g, order);
  return corot_fail(COROT_EINVAL,
                    "ordering %s is not in this build (it comes with CHOLMOD: configure with "
                    "COROT_CHOLMOD=ON)",
                    ordering);
}
