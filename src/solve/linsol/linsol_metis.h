/* METIS, in a process that has a use of its own for signals. */
#ifndef COROT_SOLVE_LINSOL_LINSOL_METIS_H
#define COROT_SOLVE_LINSOL_LINSOL_METIS_H

#include "linsol_graph.h"

/* order [n]: nested dissection. While it works, a SIGABRT of the calling thread stands for METIS
   without memory; those of other threads go where they went before. COROT_ENOMEM */
corot_status corot_graph_order_metis(const node_graph *g, int *order);

#endif
