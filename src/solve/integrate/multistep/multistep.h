/* What the drivers of SUNDIALS' multistep integrators share, CVODE's and IDA's: everything but
   their set-up. The functions the two libraries offer differ in their names only; a table holds
   them. */
#ifndef COROT_SOLVE_INTEGRATE_MULTISTEP_MULTISTEP_H
#define COROT_SOLVE_INTEGRATE_MULTISTEP_MULTISTEP_H

#include "lobatto.h"
#include "solve/integrate/driver.h"

typedef struct multistep multistep;

typedef int multistep_count(void *memory, long *count);

typedef struct multistep_api {
  int stopped; /* what `advance` returns where it has reached the stop time */
  int (*advance)(multistep *m, double beyond, double *t); /* by one internal step */
  int (*restart)(multistep *m);                           /* from (self->t, y) */
  int (*set_stop_time)(void *memory, sunrealtype t);
  int (*set_first_step)(void *memory, sunrealtype h);
  int (*interpolate)(void *memory, sunrealtype t, int derivative, N_Vector y);
  int (*restart_work)(void *memory, N_Vector work);
  int (*last_order)(void *memory, int *order);
  int (*last_step)(void *memory, sunrealtype *h);
  int (*next_step)(void *memory, sunrealtype *h);
  int (*local_errors)(void *memory, N_Vector error);
  int (*error_weights)(void *memory, N_Vector weight);
  multistep_count *nfe, *nsetups, *netf, *nni, *ncfn, *nfeQ;
} multistep_api;

/* What dissipates and what the moving supports put in at one time [W]. */
typedef struct multistep_power {
  double t, dissipated, supports;
} multistep_power;

/* Work up to the end of the last step, see multistep_work.c. */
typedef struct multistep_ledger {
  double t_start;                /* of the last step */
  N_Vector start, end;           /* [2n] y at its ends */
  N_Vector room;                 /* [2n] */
  N_Vector loads;                /* [2n] room for both: */
  double *load_start, *load_end; /* [n] the force of the loads there [N] */
  bool broken;                   /* nothing is known of the forces where the next step begins */
  double work_start[2];          /* dissipated and external [J] */
  double work_end[2];
  int npower; /* powers at ends of steps since the last break, the latest first */
  multistep_power power[LOBATTO_MOST];
  int ninside; /* those the polynomial of the last step passes through */
  multistep_power inside[LOBATTO_MOST];
} multistep_ledger;

struct multistep {
  driver driver; /* first: the callbacks' data */
  const multistep_api *api;
  void *memory;
  N_Vector rate;                   /* [2n] y' at self->t, of IDA; NULL: CVODE knows it */
  N_Vector error, weight, scratch; /* [2n] */
  N_Vector work;                   /* [2] SUNDIALS' own integrals, of which nothing is made */
  multistep_ledger ledger;
  double t_last;           /* end of the last step; self->t may be after it by rounding */
  double t_stop;           /* armed; NaN: none */
  corot_statistics before; /* counts of earlier starts */
  long nni;                /* at the end of the last step */
};

/* Driver and vectors of an `m` that is zero and stands in self->method; what is half made is
   released by close. */
corot_status corot_multistep_open(multistep *m, corot_integrator *self, const multistep_api *api,
                                  const double *u, const double *v);

/* All but the integrator's own memory; frees `m`. */
void corot_multistep_close(multistep *m);

/* The ledger of an `m` whose vectors are made; what is half made is released by close. */
corot_status corot_multistep_open_ledger(multistep *m);
void corot_multistep_close_ledger(multistep_ledger *ledger);

/* Call this after each step, from ledger->t_start to m->t_last, of this order. m->error and
   m->scratch lend their room; m->weight is that of the step. */
corot_status corot_multistep_measure_work(multistep *m, int order);

/* The loads have changed at the end of the last step, which the next step starts with: jump [n] is
   by how much [N]. */
corot_status corot_multistep_reload(multistep *m, double *jump);

/* Operations of an integrator. */
corot_status corot_multistep_step(corot_integrator *self, double t_stop, corot_step *step);
corot_status corot_multistep_at(corot_integrator *self, double t, double *u, double *v);
corot_status corot_multistep_work(corot_integrator *self, double t, double *dissipated,
                                  double *external);
corot_status corot_multistep_changed(corot_integrator *self, corot_history history);
corot_status corot_multistep_loaded(corot_integrator *self, corot_history history);
void corot_multistep_exchange(corot_integrator *self, pack *p);
void corot_multistep_statistics(const corot_integrator *self, corot_statistics *statistics);

#endif
