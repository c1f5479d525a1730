/* Held and extrapolated frames: their update, and how far they have drifted since. */
#include "state.h"

corot_status corot_frames_drift(const corot_model *m, corot_state *s, double t, const double *u,
                                corot_frames_change *drift) {
  const instant now = corot_state_at(s, t);
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  return corot_system_drift(system_of(m, s), &s->system, age_of(s, t), all_u, drift);
}

corot_status corot_frames_update(const corot_model *m, corot_state *s, double t, const double *u,
                                 corot_frames_change *change) {
  COROT_TRY(corot_state_check(m, s, "corot_frames_update"));
  const instant now = corot_state_at(s, t);
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  COROT_TRY(corot_system_update_frames(system_of(m, s), &s->system, age_of(s, t), all_u, change));
  s->t_update = t;
  s->changes++;
  return COROT_OK;
}

corot_status corot_frames_spin(const corot_model *m, corot_state *s, double t, const double *u,
                               const double *v, double *spin_max) {
  double largest;
  const instant now = corot_state_at(s, t);
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  nodal_field all_v = corot_state_move(m, s, &now, v);
  COROT_TRY(corot_system_spin(system_of(m, s), &s->system, age_of(s, t), all_u, all_v, &largest));
  if (spin_max) *spin_max = largest;
  return COROT_OK;
}
