/* What the drivers of SUNDIALS' Runge-Kutta methods share, ARKStep's and ERKStep's: everything but
   their tables and set-up. The functions of the two differ in their names only; a table holds
   them. */
#ifndef COROT_SOLVE_RUNGE_KUTTA_H
#define COROT_SOLVE_RUNGE_KUTTA_H

#include "solve/driver.h"
#include "solve/explicit_limit.h"

/* A Butcher table by SUNDIALS' name. */
typedef struct rk_table {
  const char *name;
  int order;
} rk_table;

typedef int rk_count(void *memory, long *count);

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
  rk_count *nfe, *netf;
  rk_count *nsetups, *nni, *ncfn; /* NULL: explicit */
} rk_api;

enum { RK_MOST_POINTS = 4 };

/* One end of a step. */
typedef struct rk_end {
  double t;
  N_Vector y, rate; /* [2n] (u, v) and (v, M^-1 r) */
  bool rate_known;
} rk_end;

typedef struct runge_kutta {
  driver driver; /* first: the callbacks' data */
  const rk_api *api;
  void *memory;
  int order;
  rk_end start, end;      /* of the last step */
  N_Vector error, weight; /* [2n] */
  N_Vector power;         /* [2] dissipated, external */
  int npoint;             /* of Gauss' rule in each step */
  double powers[RK_MOST_POINTS][2];
  double work_start[2], work_end[2]; /* dissipated, external [J] */
  double t_stop;                     /* armed; NaN: none */
  bool stale;                        /* r has jumped since the last step */
  double first_step;                 /* after the next reset; 0: as error control had it */
  explicit_limit *limit;             /* NULL: implicit */
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
void corot_rk_statistics(const corot_integrator *self, corot_statistics *statistics);

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
