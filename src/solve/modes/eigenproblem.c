/* The shift, the factor, and the M-orthonormal basis of what was found. */
#include "eigenproblem.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solve/pencil/wall_clock.h"

corot_status corot_eigen_create(const corot_modes_def *def, const corot_model *model, int capacity,
                                eigen *e) {
  size_t n = (size_t)corot_model_ndof(model), room = (size_t)capacity;
  *e = (eigen){.def = def, .model = model, .n = (int)n, .capacity = capacity};
  e->K = malloc((size_t)corot_model_nblock(model) * sizeof *e->K);
  e->x = malloc(room * n * sizeof *e->x);
  e->Mx = malloc(room * n * sizeof *e->Mx);
  e->eigenvalue = malloc(room * sizeof *e->eigenvalue);
  e->work = malloc(2 * n * sizeof *e->work);
  if (!e->K || !e->x || !e->Mx || !e->eigenvalue || !e->work)
    return corot_fail(COROT_ENOMEM, "no memory for %d modes of %d unknowns", capacity, e->n);
  corot_linear_def linear = def->linear;
  if (strcmp(linear.solver, "auto") == 0) linear.solver = corot_linsol_direct;
  linear.role = COROT_ROLE_STATIC;
  COROT_TRY(corot_linsol_create(model, &linear, &e->solver));
  if (!e->solver.ops->iterative) return COROT_OK;
  return corot_fail(COROT_EINVAL, "modes: the linear solver %s is not a direct one",
                    e->solver.ops->name);
}

void corot_eigen_clear(eigen *e) {
  corot_linsol_clear(&e->solver);
  free(e->K), free(e->x), free(e->Mx), free(e->eigenvalue), free(e->work);
  *e = (eigen){0};
}

/* --- The factor --- */

static void combine(eigen *e, double mass, double stiffness) {
  corot_csc_combine(e->model, e->solver.csc, mass, 0, NULL, stiffness, (const double(*)[9])e->K,
                    e->solver.value);
}

/* No eigenvalue exceeds a few times the largest K_ii / M_ii, and K x is off by rounding of that
   size. */
static void measure(eigen *e) {
  const linsol *s = &e->solver;
  double *mass = e->work, most = 0;
  combine(e, 1, 0);
  for (int i = 0; i < e->n; i++) mass[i] = s->value[s->csc->diagonal[i]];
  combine(e, 0, 1);
  for (int i = 0; i < e->n; i++) {
    double stiffness = fabs(s->value[s->csc->diagonal[i]]);
    e->stiffest = fmax(e->stiffest, stiffness);
    most = fmax(most, stiffness / mass[i]);
  }
  e->zero = 16 * DBL_EPSILON * most;
}

/* COROT_RETRY: K - shift M is not positive definite. */
static corot_status factor_at(eigen *e, double shift) {
  const linsol *s = &e->solver;
  bool fresh;
  int negative = 0;
  combine(e, -shift, 1);
  corot_status status = s->ops->factor(s->solver, s->value, &fresh);
  if (!status) status = corot_linsol_count_negative(s, s->value, &negative);
  e->facts.nfactor++;
  if (!status && negative) status = corot_fail(COROT_RETRY, "modes: %d below the shift", negative);
  return status;
}

/* The first shift is a hundredth of what a compact body's first eigenvalue is like, so that rigid
   motions leave K - s M well conditioned. */
corot_status corot_eigen_factor(eigen *e) {
  double start = clock_wall(), w = corot_model_frequency(e->model), shift = -0.01 * w * w;
  corot_status status = COROT_RETRY;
  measure(e);
  for (int k = 0; k < 12 && (status == COROT_RETRY || status == COROT_ESINGULAR); k++) {
    e->shift = shift;
    status = factor_at(e, shift);
    shift *= 10;
  }
  e->facts.factor_s += clock_wall() - start;
  if (status != COROT_RETRY && status != COROT_ESINGULAR) return status;
  return corot_fail(COROT_ESINGULAR, "modes: w^2 lies below %.3g 1/s^2, or there is no factor: %s",
                    e->shift, corot_error());
}

corot_status corot_eigen_solve(eigen *e, double *x) {
  double start = clock_wall();
  corot_status status = e->solver.ops->solve(e->solver.solver, x);
  e->facts.nsolve++;
  e->facts.solve_s += clock_wall() - start;
  if (!status && e->def->stop && e->def->stop(e->def->stop_data))
    return corot_fail(COROT_EINTEGRATE, "modes: stopped on the way");
  return status;
}

/* --- What was found --- */

void corot_eigen_project(const eigen *e, double *x) {
  for (int k = 0; k < e->nfound; k++) {
    const double *known = e->x + (size_t)k * e->n;
    double along = dot(e->n, e->Mx + (size_t)k * e->n, x);
    for (int i = 0; i < e->n; i++) x[i] -= along * known[i];
  }
}

/* Twice is enough (Kahan and Parlett); what is left then of less than this part is rounding. */
static const double NOTHING = 1e-8;

static bool add(eigen *e, const double *from) {
  double *x = e->x + (size_t)e->nfound * e->n, *Mx = e->Mx + (size_t)e->nfound * e->n;
  memcpy(x, from, (size_t)e->n * sizeof *x);
  for (int pass = 0; pass < 3; pass++) {
    corot_mass_multiply(e->model, x, Mx);
    double before = sqrt(dot(e->n, x, Mx));
    if (!(before > 0)) return false;
    for (int i = 0; i < e->n; i++) x[i] /= before;
    if (pass == 2) break;
    corot_eigen_project(e, x);
    corot_mass_multiply(e->model, x, Mx);
    if (!(sqrt(dot(e->n, x, Mx)) > NOTHING)) return false;
  }
  corot_mass_multiply(e->model, x, Mx);
  return true;
}

bool corot_eigen_add(eigen *e, const double *from) {
  if (!add(e, from)) return false;
  const double *x = e->x + (size_t)e->nfound * e->n;
  corot_block_multiply(e->model, (const double(*)[9])e->K, x, e->work);
  double lambda = dot(e->n, x, e->work);
  e->eigenvalue[e->nfound++] = fabs(lambda) <= e->zero ? 0 : lambda;
  return true;
}

bool corot_eigen_add_rigid(eigen *e, const double *from) {
  if (!add(e, from)) return false;
  e->eigenvalue[e->nfound++] = 0;
  return true;
}

void corot_eigen_swap(eigen *e, int i, int j) {
  double *a = e->x + (size_t)i * e->n, *b = e->x + (size_t)j * e->n;
  double *Ma = e->Mx + (size_t)i * e->n, *Mb = e->Mx + (size_t)j * e->n;
  for (int k = 0; i != j && k < e->n; k++) {
    double x = a[k], Mx = Ma[k];
    a[k] = b[k], Ma[k] = Mb[k];
    b[k] = x, Mb[k] = Mx;
  }
  double lambda = e->eigenvalue[i];
  e->eigenvalue[i] = e->eigenvalue[j];
  e->eigenvalue[j] = lambda;
}
