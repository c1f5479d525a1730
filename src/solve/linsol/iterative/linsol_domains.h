/* The nodes of a matrix in domains that do not touch one another, and those between them: threads
   then sweep through the domains at the same time. How many domains there are depends on the size
   of the matrix alone, so that results do not depend on the number of threads. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_DOMAINS_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_DOMAINS_H

#include "solve/linsol/linsol_graph.h"

enum { MOST_DOMAINS = 16 };

typedef struct domains {
  int n;
  int first[MOST_DOMAINS + 1]; /* where in the order each begins; first[n]: those between them */
} domains;

/* order [g->n]: the nodes, domain by domain, each in its old order, then those between. Bisected
   again and again by a search in breadth from one end of a part to its other. COROT_ENOMEM */
corot_status corot_domains_find(node_graph *g, int *order, domains *d);

#endif
