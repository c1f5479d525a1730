/* KLU: sparse LU. The symbolic analysis is done once and the pivots are kept from one factorisation
   to the next while the smallest and the largest of them are no further apart than eps^(2/3). (An
   estimate of the condition number would not do: a good matrix factored with bad pivots has a good
   one.) A factor with pivots chosen anew is refused where the smallest is mere rounding beside the
   largest: KLU by itself objects only to a zero. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <suitesparse/klu.h>

#include "linsol.h"

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
    return corot_linsol_singular(k->pattern, "klu", (int)k->common.singular_col, 0);
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

static corot_status klu_solver_create(const corot_csc *pattern, const linsol_plan *plan,
                                      void **solver) {
  klu *k = calloc(1, sizeof *k);
  if (!k) return corot_fail(COROT_ENOMEM, "no memory for klu");
  k->pattern = pattern;
  klu_defaults(&k->common);
  k->common.btf = 0; /* the matrix of a connected mesh is irreducible */
  k->symbolic = klu_analyze_given(pattern->n, pattern->colptr, pattern->row, plan->order,
                                  plan->order, &k->common);
  if (!k->symbolic) {
    corot_status status = failure(k, "analysis");
    klu_solver_destroy(k);
    return status;
  }
  *solver = k;
  return COROT_OK;
}

/* Refuses a factor without a usable pivot, or with a NaN in it. */
static corot_status check_pivots(klu *k) {
  if (!klu_rcond(k->symbolic, k->numeric, &k->common)) return failure(k, "condition");
  if (k->common.rcond >= k->pattern->n * DBL_EPSILON) return COROT_OK;
  const double *pivot = k->numeric->Udiag;
  int smallest = 0;
  for (int j = 1; j < k->pattern->n; j++)
    if (!(fabs(pivot[j]) >= fabs(pivot[smallest]))) smallest = j;
  corot_status status =
      corot_linsol_singular(k->pattern, "klu", k->symbolic->Q[smallest], k->common.rcond);
  klu_free_numeric(&k->numeric, &k->common);
  return status;
}

/* Factors with the old pivots, if there are any and they will do. */
static bool refactor(klu *k, double *value) {
  const corot_csc *A = k->pattern;
  return k->numeric &&
         klu_refactor(A->colptr, A->row, value, k->symbolic, k->numeric, &k->common) &&
         klu_rcond(k->symbolic, k->numeric, &k->common) &&
         k->common.rcond >= pow(DBL_EPSILON, 2.0 / 3.0);
}

static corot_status klu_solver_factor(void *solver, const double *value, bool *fresh) {
  klu *k = solver;
  const corot_csc *A = k->pattern;
  double *x = (double *)value; /* klu does not write to it */
  *fresh = !refactor(k, x);
  if (!*fresh) return COROT_OK;
  klu_free_numeric(&k->numeric, &k->common);
  k->numeric = klu_factor(A->colptr, A->row, x, k->symbolic, &k->common);
  return k->numeric ? check_pivots(k) : failure(k, "factorisation");
}

static corot_status klu_solver_solve(void *solver, double *x) {
  klu *k = solver;
  if (!k->numeric) return corot_fail(COROT_EINVAL, "klu: solve: there is no factor");
  if (klu_solve(k->symbolic, k->numeric, k->pattern->n, 1, x, &k->common)) return COROT_OK;
  return failure(k, "solve");
}

/* With the factor go its pivots. */
static void klu_solver_forget(void *solver) {
  klu *k = solver;
  klu_free_numeric(&k->numeric, &k->common);
}

static const linsol_variant variants[] = {
    {.name = "klu, amd", .ordering = "amd"},
    {.name = "klu, metis", .ordering = "metis"},
    {.name = NULL},
};

const linsol_ops corot_linsol_klu = {
    .name = "klu",
    .variants = variants,
    .triangle = COROT_FULL,
    .create = klu_solver_create,
    .factor = klu_solver_factor,
    .solve = klu_solver_solve,
    .destroy = klu_solver_destroy,
    .forget = klu_solver_forget,
    .count_negative = corot_inertia,
};
