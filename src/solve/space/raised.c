/* The same body on ten-node tets: mesh, model, and the fields of a moment, of which the nodes on
   the edges have the mean of the ends. */
#include "raised.h"

#include <math.h>
#include <stdlib.h>

#include <corot/hierarchy.h>

#include "core/ode/state.h"

/* --- Model --- */

static corot_status raise_mesh(const corot_mesh *mesh, raised *r) {
  corot_mesh *same = NULL;
  COROT_TRY(corot_mesh_change_order(mesh, 2, &r->mesh));
  COROT_TRY(corot_mesh_refine(mesh, 0, COROT_DIAGONAL_CONSISTENT, &same, &r->refinement));
  corot_mesh_destroy(same);
  return corot_refinement_raise(r->refinement, r->mesh);
}

corot_status corot_raised_create(const corot_model_def *def, const corot_model *model, raised *r) {
  corot_model_def of = *def;
  *r = (raised){0};
  COROT_TRY(raise_mesh(corot_model_mesh(model), r));
  of.mesh = r->mesh;
  COROT_TRY(corot_model_create(&of, &r->model));
  r->n = corot_model_ndof(r->model);
  return corot_state_create(r->model, &r->state);
}

void corot_raised_clear(raised *r) {
  corot_state_destroy(r->state);
  corot_model_destroy(r->model);
  corot_refinement_destroy(r->refinement);
  corot_mesh_destroy(r->mesh);
  *r = (raised){0};
}

/* --- Fields --- */

void corot_space_enter(const corot_space_moment *at, corot_state *state) {
  if (at->still)
    corot_state_stand_still(state, at->load_t, at->factor);
  else
    corot_state_enter(state, at->t > 0 ? nextafter(at->t, 0) : at->t);
}

/* M^-1 r(t, u, v) of the given model, whose state this is. */
static corot_status accelerate(const corot_model *model, corot_state *state,
                               const corot_space_moment *at, double *a) {
  corot_mass_solver *mass = NULL;
  COROT_TRY(corot_mass_solver_create(model, &mass));
  corot_status status = corot_residual(model, state, at->t, at->u, at->v, a);
  if (!status) status = corot_mass_solve(mass, a, a);
  corot_mass_solver_destroy(mass);
  return status;
}

/* x [nnode], of which the nodes of the given model are set, on all nodes; values [n] of these. */
static void spread(const raised *r, double (*x)[3], double *values) {
  const int(*dof)[3] = corot_model_dof(r->model);
  int first = r->refinement->nnode[0];
  for (int i = first; i < r->mesh->nnode; i++)
    for (int c = 0; c < 3; c++) x[i][c] = 0;
  corot_hierarchy_apply(r->refinement, x);
  for (int i = 0; i < r->mesh->nnode; i++)
    for (int c = 0; c < 3; c++)
      if (dof[i][c] >= 0) values[dof[i][c]] = x[i][c];
}

/* Acceleration and velocity; `a` and the state are the given model's. */
static void spread_motion(const corot_model *model, const corot_state *state, const double *a,
                          const corot_space_moment *at, const raised *r, raised_fields *f) {
  instant now = corot_state_at(state, at->t);
  corot_model_acceleration(model, &now, a, f->x[0], 3);
  spread(r, f->x, f->a);
  corot_model_velocity(model, &now, at->v, f->x[0], 3);
  spread(r, f->x, f->v);
}

/* Displacement, and where it takes the nodes. */
static void spread_displacement(const corot_model *model, const corot_state *state,
                                const corot_space_moment *at, const raised *r, raised_fields *f) {
  instant now = corot_state_at(state, at->t);
  corot_model_displacement(model, &now, at->u, f->x[0], 3);
  spread(r, f->x, f->u);
  now = corot_state_at(r->state, at->t);
  corot_model_displacement(r->model, &now, f->u, f->x[0], 3);
  for (int i = 0; i < r->mesh->nnode; i++)
    for (int c = 0; c < 3; c++) f->x[i][c] += r->mesh->x[i][c];
}

corot_status corot_raised_take(const corot_model *model, const corot_space_moment *at,
                               const raised *r, raised_fields *fields) {
  corot_state *state = NULL;
  size_t n = (size_t)corot_model_ndof(model);
  double *a = calloc(n, sizeof *a);
  corot_status status = a ? corot_state_create(model, &state)
                          : corot_fail(COROT_ENOMEM, "no memory for %zu unknowns", n);
  if (!status) {
    corot_space_enter(at, state);
    if (!at->still) status = accelerate(model, state, at, a);
  }
  if (!status && !at->still) spread_motion(model, state, a, at, r, fields);
  if (!status) spread_displacement(model, state, at, r, fields);
  corot_state_destroy(state);
  free(a);
  return status;
}
