/* Memory of a state, and what enters it: frames, instants, displacement, velocity. */
#include "state.h"

#include <stdlib.h>

#include "core/base/sized.h"

static corot_status allocate(const corot_model *m, corot_state *s) {
  int nnode = m->mesh->nnode;
  s->u = corot_vector_calloc(nnode, sizeof *s->u);
  s->v = corot_vector_calloc(nnode, sizeof *s->v);
  s->du = corot_vector_calloc(nnode, sizeof *s->du);
  s->dv = corot_vector_calloc(nnode, sizeof *s->dv);
  s->r = calloc(m->ndof, sizeof *s->r);
  if (!s->u || !s->v || !s->du || !s->dv || !s->r)
    return corot_fail(COROT_ENOMEM, "no memory for a state of %d nodes", nnode);
  return corot_system_state_create(&m->system, &s->system);
}

corot_status corot_state_create(const corot_model *model, corot_state **state) {
  COROT_TRY(COROT_GIVEN(model));
  COROT_TRY(COROT_GIVEN(state));
  const corot_model *m = model;
  corot_state *s = calloc(1, sizeof *s);
  if (!s) return corot_fail(COROT_ENOMEM, "no memory for a state");
  s->model = m;
  s->nnode = m->mesh->nnode;
  s->side = NAN;
  corot_status status = allocate(m, s);
  if (status) {
    corot_state_destroy(s);
    return status;
  }
  s->bytes = sizeof *s + 4 * s->nnode * sizeof *s->u + m->ndof * sizeof *s->r +
             corot_system_state_bytes(&m->system, &s->system);
  *state = s;
  return COROT_OK;
}

void corot_state_destroy(corot_state *s) {
  if (!s) return;
  corot_team_destroy(s->system.team);
  corot_system_state_clear(&s->system);
  free(s->u);
  free(s->v);
  free(s->du);
  free(s->dv);
  free(s->r);
  free(s);
}

corot_status corot_state_check(const corot_model *m, const corot_state *s, const char *who) {
  if (!m || !s) return corot_fail(COROT_EINVAL, "%s: '%s' is NULL", who, m ? "state" : "model");
  if (s->model != m) return corot_fail(COROT_EINVAL, "%s: the state is another model's", who);
  return COROT_OK;
}

size_t corot_state_bytes(const corot_state *s) { return s->bytes; }

void corot_state_use(corot_state *s, corot_frames frames) {
  s->system.frames = frames;
  s->changes++;
}

corot_status corot_state_use_inputs(corot_state *s, corot_inputs *inputs) {
  COROT_TRY(COROT_GIVEN_AS(s, "state"));
  if (inputs && inputs->model != s->model)
    return corot_fail(COROT_EINVAL, "the inputs are of another model than the state");
  bool factors = (s->inputs && s->inputs->other) || (inputs && inputs->other);
  if (s->in_use && inputs != s->inputs && factors)
    return corot_fail(COROT_EINVAL,
                      "inputs: an integrator of this state counts the energy that changes of "
                      "materials put in, and would miss those: set factors in the inputs that are "
                      "there");
  s->inputs = inputs;
  s->changes++;
  return COROT_OK;
}

corot_frames corot_state_frames(const corot_state *s) { return s->system.frames; }
int corot_state_inverted(const corot_state *s) { return s->system.inverted; }
void corot_state_enter(corot_state *s, double t) {
  s->side = t;
  s->still = false;
}

void corot_state_stand_still(corot_state *s, double t, double factor) {
  s->still = true;
  s->load_time = t;
  s->load_factor = factor;
}

instant corot_state_at(const corot_state *s, double t) {
  if (s->still) return (instant){t, s->load_time, s->load_factor, NAN, false, s->inputs};
  return (instant){t, t, 1, s->side, true, s->inputs};
}

void corot_state_nodal(const corot_model *m, const corot_state *s, double t, const double *u,
                       const double *v, double (*displacement)[3], double (*velocity)[3]) {
  const instant now = corot_state_at(s, t);
  if (displacement) corot_model_displacement(m, &now, u, displacement[0], 3);
  if (velocity) corot_model_velocity(m, &now, v, velocity[0], 3);
}

/* Values that are spread over the nodes by parts. */
typedef struct spreading {
  const corot_model *model;
  const double *values;
  double (*nodal)[4];
} spreading;

static void spread_part(void *work, int from, int end) {
  const spreading *p = work;
  corot_model_spread_part(p->model, p->values, from, end, p->nodal[0], 4);
}

nodal_field corot_state_spread(const corot_state *s, const double *values, double (*nodal)[4]) {
  spreading p = {s->model, values, nodal};
  corot_team_loop(s->system.team, s->nnode, spread_part, &p);
  return (nodal_field)nodal;
}

nodal_field corot_state_displace(const corot_model *m, corot_state *s, const instant *now,
                                 const double *u) {
  corot_state_spread(s, u, s->u);
  corot_supports_place(m, now, 0, s->u[0], 4);
  return (nodal_field)s->u;
}

nodal_field corot_state_move(const corot_model *m, corot_state *s, const instant *now,
                             const double *v) {
  corot_state_spread(s, v, s->v);
  corot_supports_place(m, now, 1, s->v[0], 4);
  return (nodal_field)s->v;
}
