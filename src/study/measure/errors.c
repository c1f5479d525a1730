/* Norms of differences, sample by sample. */
#include "errors.h"

#include <corot/ode.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/probe_location.h"
#include "states_sum.h"

const char *const error_words[ERROR_PROBES] = {"displacement", "velocity", "energy", "mixed"};

int error_named(const char *name) {
  for (int i = 0; i < ERROR_PROBES; i++)
    if (strcmp(error_words[i], name) == 0) return i;
  return -1;
}

bool is_rated(const error_pair *error, const error_pair *known, bool end) {
  return end ? error->end >= ERROR_FLOOR * known->end : error->max >= ERROR_FLOOR * known->max;
}

/* --- The yardstick --- */

static corot_status find_probes(yardstick *y, const scenario *s) {
  y->probe_def = calloc((size_t)s->nprobe + 1, sizeof *y->probe_def);
  y->probe = calloc((size_t)s->nprobe + 1, sizeof *y->probe);
  if (!y->probe_def || !y->probe) return corot_fail(COROT_ENOMEM, "out of memory");
  for (int i = 0; i < s->nprobe; i++) {
    if (!probe_is_plain(&s->probe[i])) continue;
    y->probe_def[y->nprobe] = &s->probe[i];
    COROT_TRY(probe_locate(&s->probe[i], y->mesh, &y->probe[y->nprobe++]));
  }
  return COROT_OK;
}

static corot_status build(yardstick *y, const scenario *s) {
  COROT_TRY(scenario_build(s, &y->mesh, NULL, &y->model));
  COROT_TRY(corot_state_create(y->model, &y->state));
  COROT_TRY(find_probes(y, s));
  size_t n = (size_t)corot_model_ndof(y->model), nblock = (size_t)corot_model_nblock(y->model);
  y->work = calloc(3 * n + 1, sizeof *y->work);
  y->stiffness = calloc(nblock + 1, sizeof *y->stiffness);
  if (!y->work || !y->stiffness) return corot_fail(COROT_ENOMEM, "out of memory");
  return corot_jacobian(y->model, y->state, 0, y->work, y->work + n, COROT_TANGENT_HELD,
                        y->stiffness, NULL);
}

corot_status yardstick_create(const scenario *s, yardstick **out) {
  yardstick *y = calloc(1, sizeof *y);
  if (!y) return corot_fail(COROT_ENOMEM, "out of memory");
  corot_status status = build(y, s);
  if (status == COROT_OK)
    *out = y;
  else
    yardstick_destroy(y);
  return status;
}

void yardstick_destroy(yardstick *y) {
  if (!y) return;
  corot_state_destroy(y->state);
  corot_model_destroy(y->model);
  corot_mesh_destroy(y->mesh);
  free(y->stiffness);
  free(y->probe_def);
  free(y->probe);
  free(y->work);
  free(y);
}

/* --- Norms --- */

static double dot(int n, const double *x, const double *y) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

double yardstick_product(yardstick *y, const double *x, const double *z) {
  int n = corot_model_ndof(y->model);
  double *Mx = y->work + 2 * n;
  corot_mass_multiply(y->model, x, Mx);
  return dot(n, z, Mx);
}

static double mass_norm(yardstick *y, const double *x) { return sqrt(yardstick_product(y, x, x)); }

static double energy_norm(yardstick *y, const double *x) {
  int n = corot_model_ndof(y->model);
  double *Kx = y->work + 2 * n;
  corot_block_multiply(y->model, (const double(*)[9])y->stiffness, x, Kx);
  return sqrt(fmax(0, dot(n, x, Kx) / 2));
}

/* --- Two solutions side by side --- */

typedef struct pairing {
  yardstick *y;
  const trajectory *run, *reference;
  int *at;         /* [n] where each degree of freedom stands in the reference */
  double scale[3]; /* of displacement, velocity, energy: the reference's largest */
  errors *e;
} pairing;

static corot_status match_places(pairing *p) {
  int n = corot_model_ndof(p->y->model);
  if (p->run->n != n)
    return corot_fail(COROT_EINVAL, "states of %d degrees of freedom, of a model of %d", p->run->n,
                      n);
  return states_places(p->run, p->reference, &p->at);
}

static corot_status check_ends(const pairing *p) {
  if (p->run->count == 0 || p->reference->count == 0)
    return corot_fail(COROT_EINVAL, "no states were written");
  double end = states_t(p->run, p->run->count - 1);
  double other = states_t(p->reference, p->reference->count - 1);
  if (states_same_time(end, other, fmax(end, other))) return COROT_OK;
  return corot_fail(COROT_EINVAL, "ends at t = %g s, its reference at %g s", end, other);
}

/* The reference's x (of all its degrees of freedom) at those of the model, less y if that is given:
   to out [n]. */
static void take(const pairing *p, const double *x, const double *y, double *out) {
  for (int i = 0; i < p->run->n; i++) out[i] = x[p->at[i]] - (y ? y[i] : 0);
}

static void find_scales(pairing *p) {
  double *x = p->y->work;
  for (int k = 0; k < p->reference->count; k++) {
    take(p, states_u(p->reference, k), NULL, x);
    p->scale[0] = fmax(p->scale[0], mass_norm(p->y, x));
    p->scale[2] = fmax(p->scale[2], energy_norm(p->y, x));
    take(p, states_v(p->reference, k), NULL, x);
    p->scale[1] = fmax(p->scale[1], mass_norm(p->y, x));
  }
}

double error_relative(double error, double scale) {
  return scale > 0 ? error / scale : error > 0 ? INFINITY : 0;
}

static void enter(pairing *p, int measure, double value) {
  error_pair *pair = &p->e->of[measure];
  pair->max = fmax(pair->max, value);
  pair->end = value; /* of the last time entered */
}

/* difference [n] of reference - run, of size `scale` each component at least */
static double mixed_error(const pairing *p, const double *difference, const double *reference,
                          double scale) {
  double worst = 0;
  for (int i = 0; i < p->run->n; i++)
    worst = fmax(worst, fabs(difference[i]) / (scale + fabs(reference[p->at[i]])));
  return worst;
}

double yardstick_probe(const yardstick *y, int k, int c, const double *x) {
  const corot_location *at = &y->probe[k];
  double sum = 0;
  for (int a = 0; a < at->nnode; a++) {
    int i = corot_model_dof(y->model)[at->node[a]][c];
    if (i >= 0) sum += at->weight[a] * x[i];
  }
  return sum;
}

static void enter_probes(pairing *p, const double *du) {
  for (int k = 0; k < p->y->nprobe; k++) {
    double square = 0;
    for (int c = 0; c < 3; c++) {
      double d = yardstick_probe(p->y, k, c, du);
      square += d * d;
    }
    enter(p, ERROR_PROBES + k, sqrt(square));
  }
}

static void compare(pairing *p, int at, int at_reference) {
  int n = p->run->n;
  double *du = p->y->work, *dv = du + n;
  const double *u = states_u(p->reference, at_reference), *v = states_v(p->reference, at_reference);
  double length = 0.01 * corot_model_length(p->y->model);
  double speed = length * corot_model_frequency(p->y->model);

  take(p, u, states_u(p->run, at), du);
  take(p, v, states_v(p->run, at), dv);
  enter(p, ERROR_DISPLACEMENT, error_relative(mass_norm(p->y, du), p->scale[0]));
  enter(p, ERROR_VELOCITY, error_relative(mass_norm(p->y, dv), p->scale[1]));
  enter(p, ERROR_ENERGY, error_relative(energy_norm(p->y, du), p->scale[2]));
  enter(p, ERROR_MIXED, fmax(mixed_error(p, du, u, length), mixed_error(p, dv, v, speed)));
  enter_probes(p, du);
  if (p->e->of[ERROR_DISPLACEMENT].max > 1e-3 && isnan(p->e->parting))
    p->e->parting = states_t(p->run, at);
}

static corot_status measure(pairing *p) {
  COROT_TRY(check_ends(p));
  COROT_TRY(match_places(p));
  find_scales(p);
  double end = states_t(p->run, p->run->count - 1);
  for (int i = 0, k = 0; i < p->run->count && k < p->reference->count;) {
    double s = states_t(p->run, i), t = states_t(p->reference, k);
    if (states_same_time(s, t, end))
      compare(p, i++, k++);
    else if (s < t)
      i++;
    else
      k++;
  }
  return COROT_OK;
}

corot_status errors_measure(yardstick *y, const trajectory *run, const trajectory *reference,
                            errors *out) {
  errors e = {.n = ERROR_PROBES + y->nprobe, .parting = NAN};
  e.of = calloc((size_t)e.n, sizeof *e.of);
  if (!e.of) return corot_fail(COROT_ENOMEM, "out of memory");
  pairing p = {.y = y, .run = run, .reference = reference, .e = &e};
  corot_status status = measure(&p);
  free(p.at);
  if (status == COROT_OK)
    *out = e;
  else
    errors_free(&e);
  return status;
}

corot_status errors_copy(const errors *e, errors *out) {
  errors copy = *e;
  copy.of = malloc(((size_t)e->n + 1) * sizeof *copy.of);
  if (!copy.of) return corot_fail(COROT_ENOMEM, "out of memory");
  if (e->n > 0) memcpy(copy.of, e->of, (size_t)e->n * sizeof *copy.of);
  *out = copy;
  return COROT_OK;
}

void errors_free(errors *e) {
  free(e->of);
  *e = (errors){0};
}
