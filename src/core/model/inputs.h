/* Inside of the inputs of corot/inputs.h, and what the functions of a model make of them. An
   instant without inputs costs a test. */
#ifndef COROT_CORE_MODEL_INPUTS_H
#define COROT_CORE_MODEL_INPUTS_H

#include <corot/inputs.h>

#include "core/base/pack.h"
#include "core/base/sized.h"
#include "model.h"

/* A straight line in time. */
typedef struct ramp {
  double t, value, slope;
} ramp;

/* The way of a node of which the model holds something: sum c_k (t' - t)^k. */
typedef struct node_path {
  int node;
  bool on;        /* else the model's own */
  double t;       /* [s] */
  double c[6][3]; /* displacement, velocity, and so on [m/s^k] */
} node_path;

/* The model's system with other materials: of all else it holds no more than the model's pointers.
 */
typedef struct other_system {
  solid_system system;
  material *material;      /* [nmaterial] */
  double *averaged[TERMS]; /* [dilatation.npool] of each term, in the place of its `lambda` */
} other_system;

struct corot_inputs {
  const corot_model *model;
  size_t bytes; /* with all they hold */

  bool forced;                     /* there is a force: */
  double t_force;                  /* at this time [s] */
  double (*force)[3], (*slope)[3]; /* [nnode] that, and its change [N], [N/s] */
  ramp *load;                      /* [nload] factors */

  int nheld, npath;    /* nodes of which something is held, and how many of them are on a path */
  node_path *path;     /* [nheld] by node; NULL until there was one */
  double (*law[3])[3]; /* [nnode] displacement, velocity, acceleration of supports: scratch */

  /* What deforms in the model's place, and what did before the materials changed, if somebody has
     yet to take notice. NULL: the model's own. */
  other_system *other, *before;
  bool pending;

  corot_feedback feedback; /* its name is that below; without a force there is none */
  char name[48];
  double (*u)[3], (*v)[3], (*du)[3], (*dv)[3]; /* [nnode] what it sees; NULL until there is one */
  double (*f)[3];                              /* [nnode] what it answers */

  /* How often they have changed: */
  long loads;    /* forces and factors of loads */
  long matrices; /* what K and D depend on */
  long paths;
};

static inline bool inputs_move(const instant *now) { return now->inputs && now->inputs->npath > 0; }

static inline bool inputs_feed_back(const instant *now) {
  return now->inputs && now->inputs->feedback.force;
}

/* What deforms. */
static inline const solid_system *inputs_system(const corot_model *m, const corot_inputs *in) {
  return in && in->other ? &in->other->system : &m->system;
}

static inline double ramp_at(ramp r, double t) { return r.value + (t - r.t) * r.slope; }

/* The factor of load k at an instant. */
double corot_inputs_load(const instant *now, int k);

/* f [ndof], or f [nnode] on all components, += the force. */
void corot_inputs_add_force(const corot_model *m, const instant *now, double *f);
void corot_inputs_add_nodal_force(const corot_model *m, const instant *now, double (*f)[3]);

/* nodal [nnode], `stride` doubles each, becomes the k-th derivative of the displacement where a
   component is on a path, 0 <= k <= 2. */
void corot_paths_place(const instant *now, int k, double *nodal, int stride);

/* f [ndof] -= what a consistent mass and its damping take from free nodes for the velocities and
   accelerations of paths, less what drags the model's own motions in their places. */
void corot_paths_drag(const instant *now, double *f);

/* Room for paths and for other materials, which are the model's own until they are set. */
corot_status corot_paths_reserve(corot_inputs *in);
corot_status corot_factors_reserve(corot_inputs *in);

/* Call this once in->other->material has changed. */
void corot_factors_settle(corot_inputs *in);

/* Writes or reads all that the inputs say, but for a feedback, which is the host's code: of that
   no more than whether there is one. A reader fails where it finds another; it may then have
   changed some of the inputs. */
void corot_inputs_exchange(pack *p, corot_inputs *in);

/* Takes NULL. */
void corot_other_system_destroy(other_system *other);

/* inputs->f [nnode] = the force of the feedback for nodal u and v; v NULL: nothing has a velocity.
   A status of its own, or COROT_RETRY: it is not finite. */
corot_status corot_feedback_evaluate(const instant *now, nodal_field u, nodal_field v);

/* The same of its change for du and dv. */
corot_status corot_feedback_differentiate(const instant *now, nodal_field u, nodal_field v,
                                          nodal_field du, nodal_field dv);

/* K and D [pattern.nblock], either of which may be NULL, += its blocks. */
corot_status corot_feedback_matrices(const instant *now, nodal_field u, nodal_field v,
                                     double (*K)[9], double (*D)[9]);

/* f [ndof], or f [nnode] on all components, += inputs->f. */
void corot_feedback_add(const instant *now, double *f);
void corot_feedback_add_nodal(const instant *now, double (*f)[3]);

/* COROT_EINVAL: an entry of x [n][3], the `what` of a `row`, is not finite. */
corot_status corot_inputs_check(const char *what, const char *row, int n, const double (*x)[3]);

#endif
