/* The balance of forces at all nodes, those that supports hold as well. */
#include <string.h>

#include "state.h"

/* s->du = minus the elastic force and, unless v is NULL, the viscous one. */
static corot_status find_internal(const corot_model *m, corot_state *s, double t, nodal_field u,
                                  nodal_field v) {
  memset(s->du, 0, s->nnode * sizeof *s->du);
  return corot_system_force(system_of(m, s), &s->system, age_of(s, t), u, v, NULL, s->du[0]);
}

/* f [nnode] += factor * s->du, unless it is NULL. */
static void add_scratch(const corot_state *s, double factor, double (*f)[3]) {
  for (int n = 0; f && n < s->nnode; n++)
    for (int c = 0; c < 3; c++) f[n][c] += factor * s->du[n][c];
}

static void clear(const corot_model *m, double (*f)[3]) {
  if (f) memset(f, 0, m->mesh->nnode * sizeof *f);
}

/* Nodes that only follow level 0 take no part. */
static void clear_followers(const corot_model *m, double (*f)[3]) {
  int n = m->body_nnode;
  if (f && n < m->mesh->nnode) memset(f[n], 0, (m->mesh->nnode - n) * sizeof *f);
}

/* Elastic and viscous forces, together where they are not asked for one by one. */
static corot_status add_stresses(const corot_model *m, corot_state *s, double t, nodal_field u,
                                 nodal_field v, const corot_nodal_forces *f) {
  bool viscous = v && body_of(m, s)->damped, apart = viscous && f->viscous;
  if (f->internal || apart) {
    COROT_TRY(find_internal(m, s, t, u, viscous && !apart ? v : NULL));
    add_scratch(s, -1, f->internal);
  }
  if (!apart) return COROT_OK;
  add_scratch(s, 1, f->viscous); /* the difference of both and the elastic one */
  COROT_TRY(find_internal(m, s, t, u, v));
  add_scratch(s, -1, f->viscous);
  return COROT_OK;
}

corot_status corot_forces(const corot_model *m, corot_state *s, double t, const double *u,
                          const double *v, const double *a, const corot_nodal_forces *f) {
  COROT_TRY(corot_state_check(m, s, "corot_forces"));
  COROT_TRY(COROT_GIVEN(u));
  COROT_TRY(COROT_GIVEN(f));
  const instant now = corot_state_at(s, t);
  double(*const part[])[3] = {f->internal, f->viscous, f->inertial, f->load};
  for (int k = 0; k < 4; k++) clear(m, part[k]);
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  nodal_field all_v = now.moving && v ? corot_state_move(m, s, &now, v) : NULL;
  COROT_TRY(add_stresses(m, s, t, all_u, all_v, f));

  /* what belongs to the mass */
  double(*damped)[3] = f->viscous ? f->viscous : f->internal;
  if (all_v && damped) corot_mass_nodal(m, true, all_v, damped);
  if (f->inertial && now.moving && a) {
    corot_model_acceleration(m, &now, a, s->du[0], 4);
    corot_mass_nodal(m, false, (nodal_field)s->du, f->inertial);
  }

  if (f->load) corot_loads_nodal(m, &now, all_u, f->load);
  if (f->load && inputs_feed_back(&now)) {
    COROT_TRY(corot_feedback_evaluate(&now, all_u, all_v));
    corot_feedback_add_nodal(&now, f->load);
  }
  for (int k = 0; k < 4; k++) clear_followers(m, part[k]);
  return COROT_OK;
}

void corot_nodal_motion(const corot_model *m, const corot_state *s, double t, const double *v,
                        const double *a, double (*velocity)[3], double (*acceleration)[3]) {
  const instant now = corot_state_at(s, t);
  if (!now.moving) {
    clear(m, velocity);
    clear(m, acceleration);
    return;
  }
  if (velocity) corot_model_velocity(m, &now, v, velocity[0], 3);
  if (acceleration) corot_model_acceleration(m, &now, a, acceleration[0], 3);
}
