/* What the drivers of SUNDIALS' Runge-Kutta methods share, ARKStep's and ERKStep's: everything but
   their tables and set-up. The functions of the two differ in their names only; a table holds
   them. */
#ifndef COROT_SOLVE_INTEGRATE_RUNGE_KUTTA_RUNGE_KUTTA_H
#define COROT_SOLVE_INTEGRATE_RUNGE_KUTTA_RUNGE_KUTTA_H

#include <stdio.h> /* which the next one needs */

#include <arkode/arkode_butcher.h>

#include "explicit_limit.h"
#include "solve/integrate/driver.h"
#include "solve/integrate/multistep/lobatto.h"

/* A Butcher table by SUNDIALS' name. */
typedef struct rk_table {
  const char *name;
  int order;
} rk_table;

typedef int rk_count(void *memory, long *count);

/* Called with each stage that has been solved, z at t. */
typedef int rk_observer(sunrealtype t, N_Vector z, void *user_data);

typedef struct rk_api {
  int (*advance)(void *memory, sunrealtype tout, N_Vector y, sunrealtype *t, int task);
  int (*reset)(void *memory, sunrealtype t, N_Vector y);
  void (*release)(void **memory);
  int (*set_stop_time)(void *memory, sunrealtype t);
  int (*set_first_step)(void *memory, sunrealtype h);
  int (*interpolate)(void *memory, sunrealtype t, int derivative, N_Vector y);
  int (*next_step)(void *memory, sunrealtype *h);
  int (*local_errors)(void *memory, N_Vector error);
  int (*error_weights)(void *memory, N_Vector weight);
  int (*observe_stages)(void *memory, rk_observer *observer); /* NULL: explicit, as what follows */
  rk_count *nfe, *netf;
  rk_count *nsetups, *nni, *ncfn;
} rk_api;

enum { RK_MOST_STAGES = 8, RK_MOST_NODES = 4 };

/* One end of a step. */
typedef struct rk_end {
  double t;
  N_Vector y, rate; /* [2n] (u, v) and (v, M^-1 r) */
  double power[2];  /* dissipated, external [W] */
  bool rate_known, power_known;
} rk_end;

/* Where two polynomials of a step are compared; no zero of their difference is expected there. */
#define RK_SAMPLE 0.37

/* The implicit stages of a step, and the polynomial through displacements among them: see
   rk_stages.c. */
typedef struct rk_stages {
  int n;                      /* implicit stages; 0: of an explicit method */
  N_Vector z[RK_MOST_STAGES]; /* [2n] the latest n of them, in turn */
  N_Vector start;             /* [2n] u and u' of a first stage that is the start; between
                                                  steps, of the last stage */
  long count;                 /* stages kept so far: the next goes to count % n */
  /* Coefficients, weights and times; of a first stage that is the start, a_start and b_start. */
  double a[RK_MOST_STAGES][RK_MOST_STAGES], b[RK_MOST_STAGES], c[RK_MOST_STAGES];
  double a_start[RK_MOST_STAGES], b_start;
  bool closing;                   /* the last stage is the end of the step */
  int nnode, node[RK_MOST_NODES]; /* stages the polynomial passes through */
  /* Weights of the displacements at the start, at the end and at the nodes, in its h u' and h^2 u''
     at the start, the same at the end, and in its value and h u' at RK_SAMPLE. */
  double weight[6][RK_MOST_NODES + 2];
} rk_stages;

typedef struct runge_kutta {
  driver driver; /* first: the callbacks' data */
  const rk_api *api;
  void *memory;
  void *controller; /* of the steps, see sun_ark.h; NULL: ARKODE's own */
  int order;
  rk_end start, end;                 /* of the last step */
  rk_stages stages;                  /* of the last step */
  N_Vector slope[2];                 /* [2n] u' and u'' of the interpolant at its start and end */
  bool resolved;                     /* the last step resolves all that its slopes show */
  bool inside_known;                 /* slope and powers are those of the last step */
  N_Vector error, weight;            /* [2n] */
  N_Vector load;                     /* [2n] force of the loads at the end of the last step, where
                                        there are inputs, and room for another */
  N_Vector power;                    /* [2] dissipated, external */
  int npoint;                        /* of Lobatto's rule in each step */
  double powers[LOBATTO_MOST][2];    /* at its points in the last step */
  double work_start[2], work_end[2]; /* dissipated, external [J] */
  double t_stop;                     /* armed; NaN: none */
  bool stale;                        /* r has jumped since the last step */
  bool fresh;                        /* ARKODE begins at the start of the last step */
  double first_step;                 /* after the next reset; 0: as error control had it */
  double begin;          /* step of a method that begins from a saved state; 0: of others */
  explicit_limit *limit; /* NULL: implicit */
  long nni, nfe, nfeQ, nrestart;
} runge_kutta;

/* What follows serves as operations of an integrator, but for open and close.

   open: of an `m` that is zero and stands in self->method; what is half made is released by
   close, which also frees `m`. */
corot_status corot_rk_open(runge_kutta *m, corot_integrator *self, const rk_api *api, int order,
                           const double *u, const double *v);
void corot_rk_close(void *method);
corot_status corot_rk_step(corot_integrator *self, double t_stop, corot_step *step);
corot_status corot_rk_at(corot_integrator *self, double t, double *u, double *v);
corot_status corot_rk_work(corot_integrator *self, double t, double *dissipated, double *external);
corot_status corot_rk_changed(corot_integrator *self, corot_history history);
corot_status corot_rk_loaded(corot_integrator *self, corot_history history);
corot_status corot_rk_settle(corot_integrator *self);
void corot_rk_exchange(corot_integrator *self, pack *p);
void corot_rk_statistics(const corot_integrator *self, corot_statistics *statistics);

/* Keeps the stages of an implicit method of this table, and finds the polynomial through them. */
corot_status corot_rk_keep_stages(runge_kutta *m, ARKodeButcherTable table);
void corot_rk_release_stages(rk_stages *s);

/* The k-th implicit stage of the last step. */
N_Vector corot_rk_stage(const rk_stages *s, int k);

/* Puts the rates u' of the stages in the place of their velocities. */
void corot_rk_find_rates(runge_kutta *m);

/* u and v at the fraction s of the last step, by the polynomial through the slopes; NULL skips one.
 */
void corot_rk_interpolate(const runge_kutta *m, double s, double *u, double *v);

/* Whether what this polynomial has in modes too fast for the step is below the tolerance, see
   rk_stages.c. */
corot_status corot_rk_resolves(runge_kutta *m, bool *resolved);

/* In those modes the slopes give way to the slopes of the polynomial through the stages. */
corot_status corot_rk_clear_slopes(runge_kutta *m);

/* Shortens h, the step to be taken after a change of r, to what a transient it brings asks for: see
   rk_start.c. m->start.rate is that of the new r. */
corot_status corot_rk_first_step(runge_kutta *m, double *h);

/* The table the definition asks for, by name or order; `mine` and `others` end with a NULL name,
   and the first of an order is the one it stands for. NULL: there is none, see corot_rk_refuse. */
const rk_table *corot_rk_find(const corot_integrator_def *def, const rk_table *mine);

/* 0: no table of that name. */
int corot_rk_order(const char *name, const rk_table *tables);

/* COROT_EINVAL: says why find found nothing, and what there is. */
corot_status corot_rk_refuse(const corot_integrator *self, const rk_table *mine,
                             const rk_table *others, const char *others_are);

extern const rk_table corot_rk_implicit[], corot_rk_explicit[];

#endif
