/* Residuals over the mass, their derivative, and differences of outputs. */
#include "slopes.h"

#include <corot/inputs.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"

corot_status slopes_create(const body *b, corot_state *state, corot_inputs *inputs, slopes *s) {
  size_t n = (size_t)corot_model_ndof(b->model) + 1;
  *s = (slopes){.body = b, .state = state, .inputs = inputs};
  s->u = calloc(n, sizeof *s->u);
  s->v = calloc(n, sizeof *s->v);
  s->value = calloc((size_t)probes_ncolumn(b->probes) + 1, sizeof *s->value);
  corot_status status = s->u && s->v && s->value ? COROT_OK : no_memory();
  if (!status) status = corot_mass_solver_create(b->model, &s->mass);
  if (status) slopes_clear(s);
  return status;
}

void slopes_clear(slopes *s) {
  corot_mass_solver_destroy(s->mass);
  free(s->u);
  free(s->v);
  free(s->value);
  *s = (slopes){0};
}

corot_status slopes_find(slopes *s, const moment *now, double *a) {
  COROT_TRY(corot_residual(s->body->model, s->state, now->t, now->u, now->v, a));
  return corot_mass_solve(s->mass, a, a);
}

/* --- In a direction --- */

static double largest(const double *x, int n) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most;
}

/* Factors of loads moved by `part` of the direction; 0: back. */
static corot_status move_loads(const slopes *s, const direction *d, double part) {
  const scenario *of = &s->body->used;
  for (int i = 0; i < of->ninput; i++)
    if (of->input[i].of == INPUT_LOAD)
      COROT_TRY(corot_inputs_set_load(s->inputs, of->input[i].index,
                                      s->body->value[i] + part * d->load[i]));
  return COROT_OK;
}

/* r += what the loads change of it, by a step that is as large as one of the factors. */
static corot_status add_loads(slopes *s, const moment *now, const direction *d, double *r) {
  int n = corot_model_ndof(s->body->model);
  double most = largest(d->load, s->body->used.ninput);
  if (most == 0) return COROT_OK;
  COROT_TRY(corot_residual(s->body->model, s->state, now->t, now->u, now->v, s->u));
  COROT_TRY(move_loads(s, d, 1 / most));
  corot_status status = corot_residual(s->body->model, s->state, now->t, now->u, now->v, s->v);
  corot_status back = move_loads(s, d, 0);
  if (status) return status;
  for (int i = 0; i < n; i++) r[i] += most * (s->v[i] - s->u[i]);
  return back;
}

corot_status slopes_change(slopes *s, const moment *now, const direction *d, double *da) {
  COROT_TRY(corot_jvp(s->body->model, s->state, now->t, now->u, now->v, COROT_TANGENT_EXACT, d->u,
                      d->v, da));
  COROT_TRY(add_loads(s, now, d, da));
  return corot_mass_solve(s->mass, da, da);
}

/* --- Outputs --- */

/* What is a small part of the direction: rounding, over 1e-6, is about as large as the square of
   that, which the central difference leaves. */
static double part_of(const slopes *s, const direction *d) {
  const corot_model *m = s->body->model;
  int n = corot_model_ndof(m);
  double length = corot_model_length(m), speed = length * corot_model_frequency(m);
  double most = fmax(largest(d->u, n) / length, largest(d->v, n) / speed);
  most = fmax(most, largest(d->load, s->body->used.ninput));
  return most > 0 ? 1e-6 / most : 0;
}

static corot_status look_at(slopes *s, sight *outputs, const moment *now, const direction *d,
                            double part) {
  int n = corot_model_ndof(s->body->model);
  for (int i = 0; i < n; i++) s->u[i] = now->u[i] + part * d->u[i];
  for (int i = 0; i < n; i++) s->v[i] = now->v[i] + part * d->v[i];
  moment there = *now;
  there.u = s->u, there.v = s->v;
  if (s->inputs) COROT_TRY(move_loads(s, d, part));
  corot_status status = sight_look(outputs, s->state, &there);
  corot_status back = s->inputs ? move_loads(s, d, 0) : COROT_OK;
  return status ? status : back;
}

corot_status slopes_of_outputs(slopes *s, sight *outputs, const moment *now, const direction *d,
                               double *change) {
  int n = probes_ncolumn(s->body->probes);
  double part = part_of(s, d);
  memset(change, 0, (size_t)n * sizeof *change);
  if (part == 0) return COROT_OK;
  COROT_TRY(look_at(s, outputs, now, d, -part));
  memcpy(s->value, outputs->value, (size_t)n * sizeof *s->value);
  COROT_TRY(look_at(s, outputs, now, d, part));
  for (int c = 0; c < n; c++) change[c] = (outputs->value[c] - s->value[c]) / (2 * part);
  return COROT_OK;
}
