/* Finds what probes need, in the order in which one follows from the other. */
#include "probe_fields.h"

#include <stdlib.h>

static corot_status no_room(void) { return corot_fail(COROT_ENOMEM, "the probes: out of memory"); }

/* Room for a field of the nodes, if it is needed. */
static bool make_nodal(const probe_fields *f, unsigned need, double (**field)[3]) {
  if (!(f->needs & need)) return true;
  *field = calloc((size_t)corot_model_mesh(f->model)->nnode, sizeof **field);
  return *field != NULL;
}

corot_status probe_fields_create(probe_fields *f) {
  size_t ndof = (size_t)corot_model_ndof(f->model) + 1;
  if (f->needs & NEEDS_INERTIAL) f->needs |= NEEDS_ACCELERATION;
  bool made = make_nodal(f, NEEDS_VELOCITY, &f->velocity) &&
              make_nodal(f, NEEDS_ACCELERATION, &f->acceleration) &&
              make_nodal(f, NEEDS_INTERNAL, &f->forces.internal) &&
              make_nodal(f, NEEDS_VISCOUS, &f->forces.viscous) &&
              make_nodal(f, NEEDS_INERTIAL, &f->forces.inertial) &&
              make_nodal(f, NEEDS_LOAD, &f->forces.load);
  if (f->needs & NEEDS_ACCELERATION) f->a = calloc(ndof, sizeof *f->a);
  if (f->needs & NEEDS_MOMENTUM) f->momentum = calloc(ndof, sizeof *f->momentum);
  if (!made || (f->needs & NEEDS_ACCELERATION && !f->a) ||
      (f->needs & NEEDS_MOMENTUM && !f->momentum))
    return no_room();
  return f->needs & NEEDS_ACCELERATION ? corot_mass_solver_create(f->model, &f->mass) : COROT_OK;
}

void probe_fields_clear(probe_fields *f) {
  corot_element_fields *t = &f->tets;
  void *const all[] = {f->a,
                       f->momentum,
                       f->velocity,
                       f->acceleration,
                       f->forces.internal,
                       f->forces.viscous,
                       f->forces.inertial,
                       f->forces.load,
                       t->frame,
                       t->strain,
                       t->von_mises,
                       t->det,
                       t->frame_at,
                       t->strain_at,
                       t->von_mises_at,
                       t->det_at,
                       t->stress,
                       t->principal,
                       t->stress_at,
                       t->principal_at,
                       t->energy,
                       t->volume};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
  corot_mass_solver_destroy(f->mass);
  *f = (probe_fields){.model = f->model};
}

/* --- Tets --- */

/* Room for rows, where there is none yet. */
#define ROWS_OF(field, n) \
  ((field) || ((field) = calloc((n), sizeof *(field))) ? (const double *)(field) : NULL)

const double *probe_fields_rows(probe_fields *f, probe_of of, bool points, int *stride) {
  size_t n = (size_t)corot_model_mesh(f->model)->ntet;
  corot_element_fields *t = &f->tets;
  f->of_tets = true;
  if (!ROWS_OF(t->volume, n)) return NULL; /* which means are weighted by */
  switch (of) {
    case PROBE_STRESS:
      *stride = 6;
      return points ? ROWS_OF(t->stress_at, n) : ROWS_OF(t->stress, n);
    case PROBE_STRAIN:
      *stride = 6;
      return points ? ROWS_OF(t->strain_at, n) : ROWS_OF(t->strain, n);
    case PROBE_PRINCIPAL:
      *stride = 3;
      return points ? ROWS_OF(t->principal_at, n) : ROWS_OF(t->principal, n);
    case PROBE_FRAME_ANGLE:
      *stride = 9;
      return points ? ROWS_OF(t->frame_at, n) : ROWS_OF(t->frame, n);
    case PROBE_VON_MISES:
      *stride = 1;
      return points ? ROWS_OF(t->von_mises_at, n) : ROWS_OF(t->von_mises, n);
    case PROBE_ELASTIC:
      *stride = 1;
      return ROWS_OF(t->energy, n);
    default:
      *stride = 1;
      return points ? ROWS_OF(t->det_at, n) : ROWS_OF(t->det, n);
  }
}

/* --- A moment --- */

/* M a = r; nothing moves in statics. */
static corot_status find_acceleration(probe_fields *f, const probe_moment *now) {
  if (now->still) return COROT_OK; /* which is zero from the start */
  COROT_TRY(corot_residual(f->model, now->state, now->t, now->u, now->v, f->a));
  return corot_mass_solve(f->mass, f->a, f->a);
}

corot_status probe_fields_find(probe_fields *f, const probe_moment *now) {
  enum { FORCES = NEEDS_INTERNAL | NEEDS_VISCOUS | NEEDS_INERTIAL | NEEDS_LOAD };
  if (f->needs & NEEDS_ACCELERATION) COROT_TRY(find_acceleration(f, now));
  if (f->needs & (NEEDS_VELOCITY | NEEDS_ACCELERATION))
    corot_nodal_motion(f->model, now->state, now->t, now->v, f->a, f->velocity, f->acceleration);
  if (f->needs & FORCES)
    COROT_TRY(corot_forces(f->model, now->state, now->t, now->u, now->v, f->a, &f->forces));
  if (f->needs & NEEDS_MOMENTUM) corot_mass_multiply(f->model, now->v, f->momentum);
  return f->of_tets ? corot_elements(f->model, now->state, now->t, now->u, &f->tets) : COROT_OK;
}
