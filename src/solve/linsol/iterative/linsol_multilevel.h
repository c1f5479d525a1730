/* Preconditioners of conjugate gradients by levels: those of a refined mesh, or aggregates. All
   take the matrices of the coarser levels from that of the finest, and factor the coarsest. They
   are positive definite, if the matrix is. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_MULTILEVEL_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_MULTILEVEL_H

#include "linsol_nodes.h"
#include "solve/linsol/linsol.h"

typedef struct multilevel_ops {
  const char *name;
  bool refined; /* it is for a refined mesh, linsol_galerkin.h being how its levels are related */
  bool scaled;  /* it works on A as corot_nodes_jacobi scales it, else unscaled */
  bool by_domains; /* it takes the nodes in any order, so in that by domains */

  /* `csc` and A, on the finest level, and plan->x are borrowed; no more of the plan is needed
     afterwards. */
  corot_status (*create)(const corot_csc *csc, const node_matrix *A, const linsol_plan *plan,
                         void **self);
  /* Of the values that A has now. COROT_RETRY: not positive definite; COROT_ESINGULAR. */
  corot_status (*factor)(void *self);
  /* z = M^-1 r [3 nodes]; z may be r. */
  corot_status (*apply)(void *self, const double *r, double *z);
  void (*destroy)(void *self); /* takes NULL */
} multilevel_ops;

/* The hierarchical basis u = T y (Yserentant, Numer. Math. 49, 1986; corot/hierarchy.h): M^-1 =
   T D^-1 T', where D is what the matrix in that basis, T' A T, has on level 0, and of each later
   node its own 3x3 block. */
extern const multilevel_ops corot_hierarchical_basis; /* "hierarchical" */

/* One V-cycle: on each level a forward sweep of block Gauss-Seidel, the correction of the next
   coarser level, and a backward sweep. */
extern const multilevel_ops corot_multigrid; /* "multigrid" */

/* One V-cycle through aggregates of nodes, of aggregates, and so on (linsol_prolong.h), with
   polynomials in the matrix before and after the correction. */
extern const multilevel_ops corot_amg; /* "amg" */

/* NULL: none has this name. */
const multilevel_ops *corot_multilevel_find(const char *name);

#endif
