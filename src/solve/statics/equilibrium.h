/* One equilibrium: KINSOL at one load factor. */
#ifndef COROT_SOLVE_STATICS_EQUILIBRIUM_H
#define COROT_SOLVE_STATICS_EQUILIBRIUM_H

#include <corot/statics.h>

#include "solve/integrate/driver.h"

typedef struct equilibrium {
  const corot_model *model;
  corot_state *state;
  corot_pencil *pencil;
  const corot_statics_def *def;
  int n;
  double t;        /* of the full loads */
  double factor;   /* sought */
  double rounding; /* of r, over the size of u and an edge [N/m] */
  double edge;     /* longest [m] */

  SUNContext ctx;
  void *memory; /* KINSOL's */
  SUNMatrix A;
  SUNLinearSolver LS;
  N_Vector u;                /* [n] where it starts, and what it finds */
  N_Vector u_scale, f_scale; /* [n] KINSOL's units, the same for all components */
  double *zero;              /* [n] the velocity */
  double *r;                 /* [n] */
  double (*f)[3];            /* [nnode] internal forces */

  double force;     /* largest on a node [N] */
  double floor;     /* rounding of r [N] */
  double tolerance; /* of r's largest component [N] */
  double unit;      /* KINSOL's, of forces [N] */
  double before; /* largest component of r where the last iteration of this run began [N]; 0: it is
                    the first */
  double aim;    /* of an iterative linear solver: what it has to leave of r */
  double *history; /* [nhistory] largest component of r [N] */
  int nhistory, capacity;
  bool recording; /* the residual of each Newton iteration goes to the history */
  int iterations;
  corot_status fatal;       /* of a callback; COROT_OK: none */
  char reason[SUN_MESSAGE]; /* why none was found */
  char refusal[256]; /* why the last evaluation, factor or solution was refused; "": it was not */
  corot_statics_counts counts;
  double force_s;
} equilibrium;

/* Into zeroed memory; what is half made is released by close. `def` must outlive it.
   COROT_ESINGULAR: K at rest has no factor. */
corot_status corot_equilibrium_open(equilibrium *e, const corot_statics_def *def,
                                    const corot_model *model, double t);
void corot_equilibrium_close(equilibrium *e);

/* From e->u to the equilibrium at `factor`. COROT_RETRY: there is none near, see e->reason. */
corot_status corot_equilibrium_find(equilibrium *e, double factor);

/* The same with a line search in each iteration: slow, but it always comes nearer. */
corot_status corot_equilibrium_search(equilibrium *e, double factor);

/* Whether K is positive definite at e->u, an equilibrium that was just found. */
corot_status corot_equilibrium_judge(equilibrium *e, corot_stability *stability);

#endif
