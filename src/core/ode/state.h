/* Inside of a state: what evaluations write to, and the instant they are for. */
#ifndef COROT_CORE_ODE_STATE_H
#define COROT_CORE_ODE_STATE_H

#include "core/base/sized.h"
#include "core/model/inputs.h"

struct corot_state {
  const corot_model *model;
  corot_inputs *inputs; /* NULL: none */
  long changes;         /* of frames, or of inputs for others */
  bool in_use;          /* an integrator has been made of it, which counts the work */
  int nnode;            /* of the model */
  double side;          /* of kinks: see instant.h */
  bool still;           /* nothing has a velocity, and the loads are those */
  double load_time;     /* of this time, not of the evaluation's */
  double load_factor;   /* times this */
  double t_update;      /* when the held frames were found */
  system_state system;
  double (*u)[4];            /* [nnode] scratch: displacement of all nodes, */
  double (*v)[4];            /* velocity, */
  double (*du)[4], (*dv)[4]; /* and directions of a derivative */
  double *r;                 /* [ndof] scratch */
  size_t bytes;              /* with all it holds */
};

/* COROT_EINVAL: there is no model or no state, or the state is another model's. `who` is the
   function that a host called. */
COROT_SISTERS corot_status corot_state_check(const corot_model *model, const corot_state *state,
                                             const char *who);

/* What deforms: the model's system, or with the factors of inputs; and the solid on the mesh. */
static inline const solid_system *system_of(const corot_model *m, const corot_state *s) {
  return inputs_system(m, s->inputs);
}

static inline const solid *body_of(const corot_model *m, const corot_state *s) {
  return &system_of(m, s)->term[0].body;
}

/* The instant of an evaluation at t. */
COROT_SISTERS instant corot_state_at(const corot_state *s, double t);

/* How long ago the held frames were found. */
static inline double age_of(const corot_state *s, double t) { return t - s->t_update; }

/* nodal [nnode] = values on the free components, and zero on those that are held. */
nodal_field corot_state_spread(const corot_state *s, const double *values, double (*nodal)[4]);

/* s->u and s->v = displacement and velocity of all nodes. */
nodal_field corot_state_displace(const corot_model *m, corot_state *s, const instant *now,
                                 const double *u);
nodal_field corot_state_move(const corot_model *m, corot_state *s, const instant *now,
                             const double *v);

#endif
