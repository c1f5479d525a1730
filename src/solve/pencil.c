#include "solve/pencil.h"

#include <stdlib.h>
#include <string.h>

#include "solve/clock.h"

static corot_status allocate(const corot_linear_def *linear, corot_pencil *p) {
  if (!(linear->tolerance > 0))
    return corot_fail(COROT_EINVAL, "linear solver: tolerance = %g is not positive",
                      linear->tolerance);
  COROT_TRY(corot_linsol_find(linear->solver, p->n, &p->ops));
  COROT_TRY(corot_csc_create(p->model, p->ops->triangle, &p->csc));
  size_t nblock = corot_model_nblock(p->model);
  p->K = malloc(nblock * sizeof *p->K);
  p->D = malloc(nblock * sizeof *p->D);
  p->S = malloc(p->csc->nnz * sizeof *p->S);
  p->work = malloc(2 * p->n * sizeof *p->work);
  if (!p->K || !p->D || !p->S || !p->work)
    return corot_fail(COROT_ENOMEM, "no memory for matrices of %d unknowns", p->n);
  COROT_TRY(p->ops->create(p->csc, &p->solver));
  if (p->ops->set_tolerance) p->ops->set_tolerance(p->solver, linear->tolerance);
  return COROT_OK;
}

corot_status corot_pencil_create(const corot_model *model, corot_state *state,
                                 const corot_linear_def *linear, corot_pencil **pencil) {
  corot_linear_def chosen = linear ? *linear : corot_linear_defaults();
  corot_pencil *p = calloc(1, sizeof *p);
  if (!p) return corot_fail(COROT_ENOMEM, "no memory for a pencil");
  p->model = model;
  p->state = state;
  p->n = corot_model_ndof(model);
  p->dirty = true;
  corot_status status = allocate(&chosen, p);
  if (status) {
    corot_pencil_destroy(p);
    return status;
  }
  *pencil = p;
  return COROT_OK;
}

void corot_pencil_destroy(corot_pencil *p) {
  if (!p) return;
  if (p->solver) p->ops->destroy(p->solver);
  corot_csc_destroy(p->csc);
  free(p->K);
  free(p->D);
  free(p->S);
  free(p->work);
  free(p);
}

const char *corot_pencil_solver(const corot_pencil *p) { return p->ops->name; }
void corot_pencil_use(corot_pencil *p, corot_tangent tangent) { p->tangent = tangent; }
void corot_pencil_invalidate(corot_pencil *p) { p->dirty = true; }
corot_pencil_counts corot_pencil_statistics(const corot_pencil *p) {
  corot_pencil_counts counts = p->counts;
  if (p->ops->iterations) counts.niteration = p->ops->iterations(p->solver);
  return counts;
}

corot_status corot_pencil_assemble(corot_pencil *p, double t, const double *u, const double *v) {
  double start = clock_wall();
  corot_status status = corot_jacobian(p->model, p->state, t, u, v, p->tangent, p->K, p->D);
  p->dirty = status != COROT_OK;
  p->counts.nassembly++;
  p->counts.assembly_s += clock_wall() - start;
  return status;
}

void corot_pencil_combine(corot_pencil *p, double a, double b, double c) {
  double start = clock_wall();
  corot_csc_combine(p->model, p->csc, a, b, (const double(*)[9])p->D, c, (const double(*)[9])p->K,
                    p->S);
  p->counts.ncombine++;
  p->counts.combine_s += clock_wall() - start;
}

corot_status corot_pencil_factor(corot_pencil *p) {
  double start = clock_wall();
  bool fresh = false;
  corot_status status = p->ops->factor(p->solver, p->S, &fresh);
  p->counts.nfactor++;
  p->counts.nfresh += fresh;
  p->counts.nindefinite += status == COROT_RETRY;
  p->counts.factor_s += clock_wall() - start;
  return status;
}

corot_status corot_pencil_solve(corot_pencil *p, const double *b, double *x) {
  double start = clock_wall();
  if (x != b) memcpy(x, b, p->n * sizeof *x);
  corot_status status = p->ops->solve(p->solver, x);
  p->counts.nsolve++;
  p->counts.solve_s += clock_wall() - start;
  return status;
}
