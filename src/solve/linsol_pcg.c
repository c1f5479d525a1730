/* Conjugate gradients with a block-diagonal preconditioner, one block a node: the paper's iterative
   solver, by way of SUNDIALS' own. Its work grows with the number of unknowns only, and the mass
   keeps the number of iterations low at small steps. */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_pcg.h>

#include "solve/linsol.h"
#include "solve/sun_compat.h"

typedef struct node_block {
  int n, dof[3];
  double inverse[9]; /* of the block, n x n in the upper left */
} node_block;

typedef struct pcg {
  const corot_csc *A;
  const double *value; /* NULL: none was accepted */
  double tolerance;    /* of the residual, relative to the right-hand side */
  long iterations;
  double curvature; /* p' A p of the last direction */
  double *rhs;      /* [n] */
  int nblock;
  node_block *block;
  SUNContext ctx;
  N_Vector x, b;
  SUNLinearSolver cg;
} pcg;

/* y = A x, and whether x is a direction in which A is positive. */
static int multiply(void *data, N_Vector x, N_Vector y) {
  pcg *p = data;
  const corot_csc *A = p->A;
  const double *in = N_VGetArrayPointer(x);
  double *out = N_VGetArrayPointer(y), curvature = 0;
  for (int j = 0; j < A->n; j++) { /* symmetric: columns are rows */
    double sum = 0;
    for (int k = A->colptr[j]; k < A->colptr[j + 1]; k++) sum += p->value[k] * in[A->row[k]];
    out[j] = sum;
    curvature += in[j] * sum;
  }
  p->curvature = curvature;
  return curvature > 0 ? 0 : 1;
}

static int precondition(void *data, N_Vector r, N_Vector z, sunrealtype tol, int side) {
  (void)tol, (void)side;
  const pcg *p = data;
  const double *in = N_VGetArrayPointer(r);
  double *out = N_VGetArrayPointer(z);
  for (int k = 0; k < p->nblock; k++) {
    const node_block *b = &p->block[k];
    for (int i = 0; i < b->n; i++) {
      double sum = 0;
      for (int j = 0; j < b->n; j++) sum += b->inverse[3 * i + j] * in[b->dof[j]];
      out[b->dof[i]] = sum;
    }
  }
  return 0;
}

static void pcg_destroy(void *solver) {
  pcg *p = solver;
  if (!p) return;
  if (p->cg) SUNLinSolFree(p->cg);
  if (p->x) N_VDestroy(p->x);
  if (p->b) N_VDestroy(p->b);
  if (p->ctx) SUNContext_Free(&p->ctx);
  free(p->block);
  free(p->rhs);
  free(p);
}

static void list_nodes(const corot_csc *A, pcg *p) {
  for (int i = 0; i < A->n; i++) {
    if (i == 0 || A->node[i] != A->node[i - 1]) p->block[p->nblock++].n = 0;
    node_block *b = &p->block[p->nblock - 1];
    b->dof[b->n++] = i;
  }
}

static corot_status pcg_create(const corot_csc *pattern, void **solver) {
  pcg *p = calloc(1, sizeof *p);
  if (!p) return corot_fail(COROT_ENOMEM, "no memory for pcg");
  p->A = pattern;
  p->tolerance = 1e-10;
  p->block = malloc(pattern->n * sizeof *p->block);
  p->rhs = malloc(pattern->n * sizeof *p->rhs);
  if (p->block) list_nodes(pattern, p);
  if (sun_context_create(&p->ctx) == 0) {
    p->x = N_VNewEmpty_Serial(pattern->n, p->ctx);
    p->b = N_VNewEmpty_Serial(pattern->n, p->ctx);
    /* in exact arithmetic n iterations suffice; rounding may ask for some more */
    if (p->x) p->cg = SUNLinSol_PCG(p->x, SUN_PREC_LEFT, 10 * pattern->n + 100, p->ctx);
  }
  if (!p->block || !p->rhs || !p->b || !p->cg || SUNLinSolSetATimes(p->cg, p, multiply) ||
      SUNLinSolSetPreconditioner(p->cg, p, NULL, precondition) || SUNLinSolInitialize(p->cg)) {
    pcg_destroy(p);
    return corot_fail(COROT_ENOMEM, "no memory for pcg on %d unknowns", pattern->n);
  }
  *solver = p;
  return COROT_OK;
}

static double entry(const pcg *p, int row, int column) {
  const corot_csc *A = p->A;
  for (int k = A->colptr[column]; k < A->colptr[column + 1]; k++)
    if (A->row[k] == row) return p->value[k];
  return 0;
}

/* Inverts an n x n symmetric block, n <= 3, by Cholesky's elimination on the identity. */
static bool invert(int n, double a[9], double inverse[9]) {
  for (int i = 0; i < 9; i++) inverse[i] = i % 4 == 0;
  for (int k = 0; k < n; k++) {
    if (!(a[4 * k] > 0)) return false;
    double pivot = 1 / a[4 * k];
    for (int j = 0; j < n; j++) a[3 * k + j] *= pivot, inverse[3 * k + j] *= pivot;
    for (int i = 0; i < n; i++) {
      double factor = a[3 * i + k];
      if (i == k) continue;
      for (int j = 0; j < n; j++) {
        a[3 * i + j] -= factor * a[3 * k + j];
        inverse[3 * i + j] -= factor * inverse[3 * k + j];
      }
    }
  }
  return true;
}

static corot_status pcg_factor(void *solver, const double *value, bool *fresh) {
  pcg *p = solver;
  p->value = value; /* for entry() */
  *fresh = true;
  for (int k = 0; k < p->nblock; k++) {
    node_block *b = &p->block[k];
    double a[9] = {0};
    for (int i = 0; i < b->n; i++)
      for (int j = 0; j < b->n; j++) a[3 * i + j] = entry(p, b->dof[i], b->dof[j]);
    if (!invert(b->n, a, b->inverse)) {
      p->value = NULL;
      return corot_fail(COROT_RETRY, "pcg: the matrix is not positive definite (unknown %d)",
                        b->dof[0]);
    }
  }
  return COROT_OK;
}

static corot_status pcg_solve(void *solver, double *x) {
  pcg *p = solver;
  if (!p->value) return corot_fail(COROT_EINVAL, "pcg: solve: there is no factor");
  int n = p->A->n;
  double square = 0;
  for (int i = 0; i < n; i++) square += x[i] * x[i];
  if (square == 0) return COROT_OK;
  memcpy(p->rhs, x, n * sizeof *x);
  memset(x, 0, n * sizeof *x);
  N_VSetArrayPointer(x, p->x);
  N_VSetArrayPointer(p->rhs, p->b);
  SUNLinSolSetZeroGuess(p->cg, 1);
  int status = SUNLinSolSolve(p->cg, NULL, p->x, p->b, p->tolerance * sqrt(square));
  p->iterations += SUNLinSolNumIters(p->cg);
  if (status == 0) return COROT_OK;
  if (!(p->curvature > 0))
    return corot_fail(COROT_RETRY, "pcg: the matrix is not positive definite (p'Sp = %.3g)",
                      p->curvature);
  return corot_fail(COROT_RETRY, "pcg: not converged to %g in %d iterations", p->tolerance,
                    SUNLinSolNumIters(p->cg));
}

static void pcg_set_tolerance(void *solver, double tolerance) {
  ((pcg *)solver)->tolerance = tolerance;
}

static long pcg_iterations(const void *solver) { return ((const pcg *)solver)->iterations; }

const linsol_ops corot_linsol_pcg = {"pcg",     COROT_FULL,  pcg_create,        pcg_factor,
                                     pcg_solve, pcg_destroy, pcg_set_tolerance, pcg_iterations};
