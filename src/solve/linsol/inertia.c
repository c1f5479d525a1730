/* Sylvester's law of inertia by KLU: with every pivot on the diagonal, A = L D L', and positive row
   scales leave the signs of D alone. */
#include <stdlib.h>
#include <suitesparse/klu.h>

#include "linsol.h"

static corot_status failure(const klu_common *common, const char *phase) {
  if (common->status == KLU_OUT_OF_MEMORY)
    return corot_fail(COROT_ENOMEM, "klu: %s: out of memory", phase);
  return corot_fail(COROT_EINVAL, "klu: %s: failed (status %d)", phase, common->status);
}

corot_status corot_inertia(const corot_csc *A, const double *value, int *negative) {
  klu_common common;
  klu_defaults(&common);
  common.btf = 0;
  common.tol = 0; /* the diagonal, unless it is zero */
  common.halt_if_singular = 0;
  klu_symbolic *symbolic = klu_analyze(A->n, A->colptr, A->row, &common);
  if (!symbolic) return failure(&common, "analysis");
  klu_numeric *numeric =
      klu_factor(A->colptr, A->row, (double *)value, symbolic, &common); /* does not write */
  corot_status status = numeric ? COROT_OK : failure(&common, "factorisation");
  if (numeric) {
    const double *pivot = numeric->Udiag;
    *negative = 0;
    for (int k = 0; k < A->n; k++) *negative += !(pivot[k] > 0);
  }
  klu_free_numeric(&numeric, &common);
  klu_free_symbolic(&symbolic, &common);
  return status;
}
