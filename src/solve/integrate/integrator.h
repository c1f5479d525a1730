/* Inside of an integrator: what all methods share, and the functions each of them provides. */
#ifndef COROT_SOLVE_INTEGRATE_INTEGRATOR_H
#define COROT_SOLVE_INTEGRATE_INTEGRATOR_H

#include <corot/integrate.h>

#include "core/base/pack.h"
#include "core/ode/stamp.h"
#include "solve/host/host.h"
#include "solve/pencil/pencil.h"

typedef struct integrator_ops {
  corot_method_kind kind;
  void (*choose)(corot_integrator *self); /* what the definition leaves open */
  corot_status (*create)(corot_integrator *self, const double *u, const double *v);
  void (*destroy)(void *method);
  corot_status (*step)(corot_integrator *self, double t_stop, corot_step *step);
  corot_status (*at)(corot_integrator *self, double t, double *u, double *v);
  corot_status (*work)(corot_integrator *self, double t, double *dissipated, double *external);
  corot_status (*changed)(corot_integrator *self, corot_history history);
  /* Nothing has changed but forces that depend on u and t alone. NULL: as changed. */
  corot_status (*loaded)(corot_integrator *self, corot_history history);
  void (*statistics)(const corot_integrator *self, corot_statistics *statistics);
  /* Before a state is taken away: what waits for the next step is decided now. NULL: nothing does.
   */
  corot_status (*settle)(corot_integrator *self);
  /* Writes what the method knows beside u, v and its counts; reads it into one that was just
   * created. */
  void (*exchange)(corot_integrator *self, pack *p);
} integrator_ops;

extern const integrator_ops corot_integrator_cvode;
extern const integrator_ops corot_integrator_ida;
extern const integrator_ops corot_integrator_arkode; /* diagonally implicit */
extern const integrator_ops corot_integrator_erk;
extern const integrator_ops corot_integrators_fixed[]; /* one without a name ends it */

struct corot_integrator {
  const integrator_ops *ops;
  const corot_model *model;
  corot_state *state;
  corot_pencil *pencil; /* NULL: of explicit steps */
  corot_mass_solver *mass;
  corot_integrator_def def;   /* choices made; its strings are not kept */
  double t;                   /* reached */
  double before;              /* where the last step began; t: there is no interpolant */
  double hlast;               /* length of the last step, 0: there was none */
  int qlast;                  /* its order */
  long nst;                   /* steps taken */
  double force_s, work_s;     /* wall time in the right-hand side and the work integrands [s] */
  double step_s;              /* wall time of all steps [s] */
  void *method;               /* the method's own part */
  const char *table;          /* the Butcher table in use; NULL: none */
  corot_energies energies;    /* where the work integrands were last evaluated */
  double t_energies;          /* when that was; NaN: nowhere yet */
  double given, given_before; /* external work by changes of materials, and before the latest [J] */
  double t_given;             /* when that was; -infinity: there was none */
  state_stamp seen;           /* of the state, as the integrator knows it */
  corot_statistics carried; /* the method's counts before its latest beginning from a saved state */
  corot_frame_clock *clock; /* made last for this integrator; NULL: none, or it is gone */
  uint64_t asked;           /* checksum of the definition as it was given */
  uint64_t identity;        /* of the model; 0: not asked for yet */
};

/* corot_sight of the next step. */
double corot_integrator_sight(const corot_integrator *self, double h, double t_stop);

/* Checksum of a definition: what tells two of them apart. */
uint64_t corot_integrator_sum_of(const corot_integrator_def *def);

/* The clock's integrator is no more. */
void corot_frame_clock_orphan(corot_frame_clock *clock);

/* Writes or reads when the clock's next updates are due. */
void corot_frame_clock_exchange(pack *p, corot_frame_clock *clock);

/* Takes the advice for a method where the definition leaves something open. */
void corot_integrator_take_advice(corot_integrator *self, corot_sun_method method);

#endif
