/* A matrix with its unknowns in the order of the levels of a refinement, where the mesh numbers its
   nodes otherwise: preconditioners by levels take it that a level's nodes come first. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_BY_LEVELS_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_BY_LEVELS_H

#include <corot/ode.h>

typedef struct ordered_csc {
  corot_csc *csc; /* `node` is no longer ascending; NULL: the caller's will do */
  int *unknown;   /* [n] of the caller's, for each of these */
  int *entry;     /* [nnz] the same */
  double *value;  /* [nnz] room for values */
} ordered_csc;

/* Of a lower triangle. Does nothing where the refinement has no order of its own. What is half made
   is released by clear. */
corot_status corot_order_create(const corot_csc *csc, const corot_refinement *r, ordered_csc *o);
void corot_order_clear(ordered_csc *o);

/* The caller's values in the new order: o->value, or what was given if there is none. */
const double *corot_order_values(const ordered_csc *o, const double *value);

#endif
