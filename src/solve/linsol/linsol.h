/* Linear solvers behind one interface, found by name. */
#ifndef COROT_SOLVE_LINSOL_LINSOL_H
#define COROT_SOLVE_LINSOL_LINSOL_H

#include <corot/solve.h>
#include <stdbool.h>

#include "core/base/memory_limit.h"
#include "core/base/sisters.h"
#include "core/base/team.h"

/* What is to be used on one matrix, every "auto" decided. */
typedef struct linsol_plan linsol_plan;

/* One way to set a solver up: its name in full, and the choices that it stands for; NULL: of no
   importance. */
typedef struct linsol_variant {
  const char *name, *ordering, *factor, *preconditioner;
} linsol_variant;

/* A linear solver: what it is called, what it is like, and what it does. */
typedef struct linsol_ops {
  const char *name;
  const linsol_variant *variants; /* up to one without a name */
  bool iterative;                 /* its factor is a preconditioner, its solution is iterated */
  corot_triangle triangle;        /* the part of the matrix it reads */

  /* Symbolic analysis, once; `pattern` is borrowed for the solver's life. */
  corot_status (*create)(const corot_csc *pattern, const linsol_plan *plan, void **solver);
  /* Numeric factorisation of value [nnz]; *fresh: the pivots were chosen anew. COROT_RETRY: not
     positive definite; COROT_ESINGULAR: no pivot. */
  corot_status (*factor)(void *solver, const double *value, bool *fresh);
  /* x [n] becomes A^-1 x. */
  corot_status (*solve)(void *solver, double *x);
  void (*destroy)(void *solver);
  /* Drops the numeric factor, so that the next one does not depend on any before it. NULL: none
     ever does. */
  void (*forget)(void *solver);
  /* From now on a team shares out what it computes, with the same results; NULL: nobody does. NULL
     in the place of this: none ever does. */
  void (*share)(void *solver, team *by);

  /* The following four are NULL where the solver is not iterative.
     Iterations so far. */
  long (*iterations)(const void *solver);
  /* The relative residual of solutions from now on; 0: the plan's. */
  void (*aim)(void *solver, double tolerance);
  /* Whether the last solution failed as A turned out not to be positive definite. */
  bool (*met_indefinite)(const void *solver);
  /* Whether A, of which there is a factor, is positive definite: what a direct solver's factor
     shows. COROT_RETRY: not known, for the iteration does not converge. */
  corot_status (*prove)(void *solver, bool *definite);

  /* How many negative pivots A has, of a direct solver whose factor does not object to an
     indefinite A; else NULL. */
  corot_status (*count_negative)(const corot_csc *pattern, const double *value, int *negative);
} linsol_ops;

extern const linsol_ops corot_linsol_klu;
extern const linsol_ops corot_linsol_pcg;
#ifdef COROT_HAVE_CHOLMOD
extern const linsol_ops corot_linsol_cholmod;
#endif

/* What a factor and a solution of a direct solver would cost, in iterations of the solver chosen in
   its place; 0: there is none that would do. */
typedef struct linsol_rival {
  double factor, solution;
} linsol_rival;

struct linsol_plan {
  corot_linear_def def;
  const linsol_ops *ops;
  const char *name; /* static: "cholmod supernodal, amd", "klu, metis", "pcg, block-jacobi" */
  bool by_cost;     /* the solver was chosen by its cost, not asked for by name, nor because nothing
                       else fits into memory: another may take its place */
  bool by_place;    /* it asks where the nodes are */
  linsol_rival rival;
  long most_iterations; /* of an iterative solver, for one system; 0: its own limit */
  int most_direct;      /* unknowns of a coarsest level that a direct solver is left with; 0: the
                           preconditioner's own limit */
  int *order;           /* [unknowns] of a direct solver: an order of little fill; else NULL */
  double entries, operations; /* of its factor, multiplications to find it */
  const double (*x)[3]; /* [nodes of the mesh] where they are when a matrix is factored, for the
                           solver's life; NULL: not known, or of no importance */
};

/* `lower`: the lower triangle. COROT_EINVAL: a name that does not exist, or is not in this build.
   COROT_ENOMEM: or a factor that does not fit into the memory there is, which is seen from the
   count of its entries, before it is made. Conjugate gradients are chosen in its place. */
corot_status corot_linsol_choose(const corot_linear_def *def, const corot_csc *lower,
                                 linsol_plan *plan);

/* The same with other limits than those of corot_memory_limits. */
corot_status corot_linsol_choose_within(const corot_memory_limit *memory,
                                        const corot_linear_def *def, const corot_csc *lower,
                                        linsol_plan *plan);

/* corot_linear_costs_measure on cubes of other sizes, in cells along an edge. */
corot_status corot_linear_costs_measure_on(const int cells[2], corot_linear_costs *costs);

/* The best direct solver of this build. */
extern COROT_SISTERS const char *const corot_linsol_direct;
void corot_linsol_plan_clear(linsol_plan *plan);

/* A solver with the matrix it is for. */
typedef struct linsol {
  const linsol_ops *ops;
  const char *name; /* as in the plan; static */
  bool by_cost;     /* as in the plan */
  corot_csc *csc;
  double *value; /* [csc->nnz] */
  void *solver;
  linsol_rival rival;
  double (*x)[3]; /* as in the plan */
} linsol;

/* On the model's pattern. What is half made is released by clear. */
/* COROT_EINVAL: the definition was filled for a host with headers of another version. */
corot_status corot_linear_check(const corot_linear_def *def);

COROT_SISTERS corot_status corot_linsol_create(const corot_model *model,
                                               const corot_linear_def *def, linsol *s);
COROT_SISTERS void corot_linsol_clear(linsol *s);

/* Matrices are of the body displaced by u at t from now on, and not at rest. */
void corot_linsol_move(linsol *s, const corot_model *model, double t, const double *u);

/* Negative pivots of the symmetric matrix `value` on `A` (both triangles), none of which is moved
   from the diagonal: as many as it has negative eigenvalues. Zero pivots count, too. */
corot_status corot_inertia(const corot_csc *A, const double *value, int *negative);

/* *negative: the pivots of value [csc->nnz] that are negative, of a solver whose factor does not
   object to them; else 0. */
COROT_SISTERS corot_status corot_linsol_count_negative(const linsol *s, const double *value,
                                                       int *negative);

/* Fails with COROT_ESINGULAR for want of a pivot at a degree of freedom; `ratio`: of the smallest
   pivot to the largest. */
corot_status corot_linsol_singular(const corot_csc *csc, const char *solver, int dof, double ratio);

#endif
