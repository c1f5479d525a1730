/* KLU: sparse LU. The symbolic analysis is done once and the pivots are kept from one factorisation
   to the next while the reciprocal condition number stays above eps^(2/3), the bound of SUNDIALS'
   own KLU interface. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <suitesparse/klu.h>

#include "solve/linsol.h"

typedef struct klu {
  const corot_csc *pattern;
  klu_common common;
  klu_symbolic *symbolic;
  klu_numeric *numeric;
} klu;

static const char *reason(int status) {
  switch (status) {
    case KLU_OUT_OF_MEMORY:
      return "out of memory";
    case KLU_INVALID:
      return "invalid matrix";
    case KLU_TOO_LARGE:
      return "the factor exceeds 32-bit counts; try cholmod";
    case KLU_SINGULAR:
      return "singular";
    default:
      return "unknown failure";
  }
}

static corot_status failure(const klu *k, const char *phase) {
  int status = k->common.status;
  if (status == KLU_SINGULAR)
    return corot_fail(COROT_ESINGULAR, "klu: the matrix is singular at degree of freedom %d",
                      (int)k->common.singular_col);
  return corot_fail(status == KLU_OUT_OF_MEMORY ? COROT_ENOMEM : COROT_EINVAL, "klu: %s: %s", phase,
                    reason(status));
}

static void klu_solver_destroy(void *solver) {
  klu *k = solver;
  if (!k) return;
  klu_free_symbolic(&k->symbolic, &k->common);
  klu_free_numeric(&k->numeric, &k->common);
  free(k);
}

static corot_status klu_solver_create(const corot_csc *pattern, void **solver) {
  klu *k = calloc(1, sizeof *k);
  if (!k) return corot_fail(COROT_ENOMEM, "no memory for klu");
  k->pattern = pattern;
  klu_defaults(&k->common);
  k->common.btf = 0; /* the matrix of a connected mesh is irreducible */
  k->symbolic = klu_analyze(pattern->n, pattern->colptr, pattern->row, &k->common);
  if (!k->symbolic) {
    corot_status status = failure(k, "analysis");
    klu_solver_destroy(k);
    return status;
  }
  *solver = k;
  return COROT_OK;
}

/* Whether a factor with old pivots can be trusted. */
static bool well_conditioned(klu *k, double *value) {
  const double bound = pow(DBL_EPSILON, 2.0 / 3.0);
  if (!klu_rcond(k->symbolic, k->numeric, &k->common)) return false;
  if (k->common.rcond >= bound) return true;
  if (!klu_condest(k->pattern->colptr, value, k->symbolic, k->numeric, &k->common)) return false;
  return k->common.condest <= 1 / bound;
}

static corot_status klu_solver_factor(void *solver, const double *value, bool *fresh) {
  klu *k = solver;
  const corot_csc *A = k->pattern;
  double *x = (double *)value; /* klu does not write to it */
  *fresh = false;
  if (k->numeric && klu_refactor(A->colptr, A->row, x, k->symbolic, k->numeric, &k->common) &&
      well_conditioned(k, x))
    return COROT_OK;

  *fresh = true;
  klu_free_numeric(&k->numeric, &k->common);
  k->numeric = klu_factor(A->colptr, A->row, x, k->symbolic, &k->common);
  return k->numeric ? COROT_OK : failure(k, "factorisation");
}

static corot_status klu_solver_solve(void *solver, double *x) {
  klu *k = solver;
  if (klu_solve(k->symbolic, k->numeric, k->pattern->n, 1, x, &k->common)) return COROT_OK;
  return failure(k, "solve");
}

const linsol_ops linsol_klu = {
    "klu", COROT_FULL, klu_solver_create, klu_solver_factor, klu_solver_solve, klu_solver_destroy};
