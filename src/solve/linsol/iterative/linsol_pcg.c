/* Preconditioned conjugate gradients, by way of SUNDIALS' own. The work of an iteration grows with
   the number of unknowns only, and the mass keeps their number low at small steps.

   The preconditioner C C' or C (I + L)(I + L') C' is applied to the system from both sides, so
   that what SUNDIALS sees has none: with incomplete Cholesky an iteration then costs one product.
   Those by levels SUNDIALS applies; C is I, or that of block Jacobi. */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_pcg.h>

#include "linsol_by_levels.h"
#include "linsol_multilevel.h"
#include "solve/linsol/linsol.h"
#include "solve/sundials/sun_status.h"
#include "solve/sundials/vector.h"

/* The end of a message where conjugate gradients do not find the solution that there may be. */
#ifdef COROT_HAVE_CHOLMOD
#define WHAT_SOLVES "; use a direct linear_solver: cholmod or klu"
#else
#define WHAT_SOLVES "; use a direct linear_solver: klu"
#endif

typedef struct pcg {
  const corot_csc *csc; /* the caller's, or that of `ordered` */
  ordered_csc ordered;
  node_matrix A;
  bool cholesky;             /* or else Jacobi, if `ops` is NULL */
  const multilevel_ops *ops; /* of what works by levels */
  void *levels;
  corot_status status; /* of its last product */
  int most;            /* iterations of a system */
  corot_role role; /* in a time step direct solvers have a remedy against an indefinite matrix */
  bool factored;
  double tolerance; /* of the residual, relative to the right-hand side: of the plan, */
  double aim;       /* and of the next solution */
  long iterations;
  double curvature;      /* p' A p of the last direction */
  bool indefinite;       /* the last solution failed as this was not positive */
  double *b, *r, *x, *z; /* [3 nodes] right-hand side, residual, solution, its change; scaled */
  SUNContext ctx;
  N_Vector from, to;
  SUNLinearSolver cg;
} pcg;

/* y = A x, and whether x is a direction in which A is positive. */
static int multiply(void *data, N_Vector x, N_Vector y) {
  pcg *p = data;
  const double *in = N_VGetArrayPointer(x);
  double *out = N_VGetArrayPointer(y);
  (p->cholesky ? corot_nodes_sandwich : corot_nodes_multiply)(&p->A, in, out);
  p->curvature = N_VDotProd(x, y);
  return p->curvature > 0 ? 0 : 1;
}

/* z = M^-1 r */
static int apply(void *data, N_Vector r, N_Vector z, sunrealtype tolerance, int side) {
  pcg *p = data;
  (void)tolerance, (void)side;
  p->status = p->ops->apply(p->levels, N_VGetArrayPointer(r), N_VGetArrayPointer(z));
  return sun_callback_code(p->status);
}

static void pcg_destroy(void *solver) {
  pcg *p = solver;
  if (!p) return;
  if (p->cg) SUNLinSolFree(p->cg);
  if (p->from) N_VDestroy(p->from);
  if (p->to) N_VDestroy(p->to);
  if (p->ctx) SUNContext_Free(&p->ctx);
  if (p->ops) p->ops->destroy(p->levels);
  corot_nodes_clear(&p->A);
  corot_order_clear(&p->ordered);
  free(p->b);
  free(p);
}

static bool make_cg(pcg *p) {
  p->cg = SUNLinSol_PCG(p->to, p->ops ? SUN_PREC_LEFT : SUN_PREC_NONE, p->most, p->ctx);
  return p->cg && !SUNLinSolSetATimes(p->cg, p, multiply) &&
         (!p->ops || !SUNLinSolSetPreconditioner(p->cg, p, NULL, apply)) &&
         !SUNLinSolInitialize(p->cg);
}

static corot_status prepare(pcg *p, const linsol_plan *plan) {
  if (p->ops && p->ops->refined)
    COROT_TRY(corot_order_create(p->csc, plan->def.refinement, &p->ordered));
  if (p->ordered.csc) p->csc = p->ordered.csc;
  COROT_TRY(corot_nodes_create(p->csc, !p->ops || p->ops->by_domains, &p->A));
  p->A.unknown = p->ordered.unknown;
  corot_nodes_keep(&p->A);
  if (p->ops) COROT_TRY(p->ops->create(p->csc, &p->A, plan, &p->levels));
  int n = 3 * p->A.n;
  /* in exact arithmetic as many iterations as unknowns suffice; rounding may ask for some more */
  p->most = 10 * n + 100;
  if (plan->most_iterations > 0 && plan->most_iterations < p->most)
    p->most = (int)plan->most_iterations;
  p->b = malloc(4 * (size_t)n * sizeof *p->b);
  p->r = p->b + n, p->x = p->r + n, p->z = p->x + n;
  if (sun_context_create(&p->ctx) == 0) {
    p->to = N_VNewEmpty_Serial(n, p->ctx);
    p->from = N_VNewEmpty_Serial(n, p->ctx);
  }
  if (p->to) corot_vector_quicken(p->to);
  if (!p->b || !p->from || !p->to || !make_cg(p))
    return corot_fail(COROT_ENOMEM, "no memory for pcg on %d unknowns", p->csc->n);
  return COROT_OK;
}

static corot_status pcg_create(const corot_csc *pattern, const linsol_plan *plan, void **solver) {
  pcg *p = calloc(1, sizeof *p);
  if (!p) return corot_fail(COROT_ENOMEM, "no memory for pcg");
  p->csc = pattern;
  p->tolerance = p->aim = plan->def.tolerance;
  p->role = plan->def.role;
  p->cholesky = strcmp(plan->def.preconditioner, "incomplete-cholesky") == 0;
  p->ops = corot_multilevel_find(plan->def.preconditioner);
  corot_status status = prepare(p, plan);
  if (status) {
    pcg_destroy(p);
    return status;
  }
  *solver = p;
  return COROT_OK;
}

/* What is positive definite may have an incomplete factor that is not: then the diagonal is raised
   until it is (Manteuffel 1980). */
static bool incomplete_cholesky(pcg *p, const double *value, int *at) {
  for (double shift = 0; !corot_nodes_cholesky(&p->A, shift, at);) {
    if (shift > 100) return false;
    shift = fmax(0.01, 2 * shift);
    corot_nodes_load(&p->A, p->csc, value);
  }
  return true;
}

static corot_status pcg_factor(void *solver, const double *value, bool *fresh) {
  pcg *p = solver;
  int at = 0;
  *fresh = true;
  p->factored = false;
  corot_nodes_load(&p->A, p->csc, corot_order_values(&p->ordered, value));
  if (!(p->cholesky                 ? incomplete_cholesky(p, value, &at)
        : !p->ops || p->ops->scaled ? corot_nodes_jacobi(&p->A, &at)
                                    : true))
    return corot_nodes_indefinite(&p->A, p->csc, at);
  if (p->ops) COROT_TRY(p->ops->factor(p->levels));
  p->factored = true;
  return COROT_OK;
}

/* x += the solution for the residual, as closely as brings |r| from `norm` to half the tolerance,
   `whole` being |b|. */
static corot_status improve(pcg *p, double norm, double whole) {
  int n = 3 * p->A.n;
  double square = 0, target = 0.5 * p->aim * whole;
  if (p->cholesky) corot_nodes_forward(&p->A, p->r);
  for (int i = 0; i < n; i++) square += p->r[i] * p->r[i];
  /* iterate on the residual, from zero */
  memset(p->z, 0, n * sizeof *p->z);
  N_VSetArrayPointer(p->z, p->to);
  N_VSetArrayPointer(p->r, p->from);
  p->status = COROT_OK;
  int status = SUNLinSolSetZeroGuess(p->cg, 1);
  team *before = corot_vector_share(p->A.team);
  if (!status) status = SUNLinSolSolve(p->cg, NULL, p->to, p->from, target / norm * sqrt(square));
  corot_vector_share(before);
  int iterations = SUNLinSolNumIters(p->cg);
  p->iterations += iterations;
  /* why it ended */
  if (p->status) return p->status;
  p->indefinite = status && !(p->curvature > 0);
  if (p->indefinite)
    return corot_fail(COROT_RETRY, "pcg: the matrix is not positive definite (p'Sp = %.3g)%s",
                      p->curvature, p->role == COROT_ROLE_STATIC ? "" : WHAT_SOLVES);
  if (status && status != SUNLS_RES_REDUCED && status != SUNLS_CONV_FAIL)
    return corot_fail(COROT_EINVAL, "pcg: SUNDIALS refuses to iterate (status %d)", status);
  if (status)
    return corot_fail(COROT_RETRY,
                      "pcg: did not converge in %d iterations: residual %.1e of the right-hand "
                      "side, tolerance %.1e" WHAT_SOLVES,
                      iterations, SUNLinSolResNorm(p->cg) / sqrt(square) * norm / whole, p->aim);
  /* back to the unknowns of the matrix */
  if (p->cholesky) corot_nodes_backward(&p->A, p->z);
  for (int i = 0; i < n; i++) p->x[i] += p->z[i];
  return COROT_OK;
}

/* r = b - A x, |r| in the caller's units */
static double residual(pcg *p) {
  corot_nodes_multiply(&p->A, p->x, p->r);
  for (int i = 0; i < 3 * p->A.n; i++) p->r[i] = p->b[i] - p->r[i];
  return corot_nodes_unscaled_norm(&p->A, p->r);
}

/* Conjugate gradients stop by the residual they see; how large it really is shows afterwards. One
   that no longer falls is good enough if it is as small as the rounding of its own terms, so that
   no solver would do better. */
static corot_status iterate(pcg *p) {
  size_t bytes = 3 * (size_t)p->A.n * sizeof *p->b;
  double whole = corot_nodes_unscaled_norm(&p->A, p->b), norm = whole, before;
  memcpy(p->r, p->b, bytes);
  memset(p->x, 0, bytes);
  corot_status status;
  p->indefinite = false;
  do {
    before = norm;
    status = improve(p, norm, whole);
    if (!status) norm = residual(p);
  } while (!status && norm > p->aim * whole && norm < 0.5 * before);
  if (sun_is_fatal(status)) return status;
  if (norm <= p->aim * whole || norm <= 10 * corot_nodes_rounding(&p->A, p->x)) {
    p->indefinite = false;
    return COROT_OK;
  }
  if (status) return status;
  return corot_fail(COROT_RETRY,
                    "pcg: the residual stays at %.1e of the right-hand side, tolerance "
                    "%.1e" WHAT_SOLVES,
                    norm / whole, p->aim);
}

/* The exponent by which x [n] must be scaled so that squares of its entries can be represented. */
static int exponent(int n, const double *x) {
  double most = 0;
  int e = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  if (most < INFINITY) frexp(most, &e);
  return abs(e) < 300 ? 0 : e;
}

static corot_status pcg_solve(void *solver, double *x) {
  pcg *p = solver;
  if (!p->factored) return corot_fail(COROT_EINVAL, "pcg: solve: there is no factor");
  int n = p->csc->n;
  bool zero = true;
  for (int i = 0; i < n && zero; i++) zero = x[i] == 0;
  if (zero) return COROT_OK;
  int e = exponent(n, x);
  const int *unknown = p->ordered.unknown;
  memset(p->b, 0, 3 * p->A.n * sizeof *p->b);
  for (int i = 0; i < n; i++) {
    double value = x[unknown ? unknown[i] : i];
    p->b[p->A.slot[i]] = e ? ldexp(value, -e) : value;
  }
  corot_nodes_scale(&p->A, p->b);
  COROT_TRY(iterate(p));
  corot_nodes_unscale_transposed(&p->A, p->x);
  for (int i = 0; i < n; i++) {
    double value = p->x[p->A.slot[i]];
    x[unknown ? unknown[i] : i] = e ? ldexp(value, e) : value;
  }
  return COROT_OK;
}

static void pcg_aim(void *solver, double tolerance) {
  pcg *p = solver;
  p->aim = tolerance > 0 ? tolerance : p->tolerance;
}

static bool pcg_met_indefinite(const void *solver) { return ((const pcg *)solver)->indefinite; }

/* Uniform in (-1, 1): the high bits of a congruential sequence (Knuth's constants). */
static double draw(uint64_t *seed) {
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(*seed >> 11) * 0x1p-52 - 1;
}

/* Solves for a right-hand side b at random. After k iterations with Ritz values t_i, all positive,
   the residual in an eigenvector w of A is prod (1 - l / t_i) times that of b: where l is negative,
   it has grown. So if |r| falls to a part e of |b| and no direction of negative curvature was met,
   w'b is less than e |b|. As the density of w'b is at most 1 / sqrt(2) (Ball 1986, slices of the
   cube) and |b| about sqrt(n / 3), that has a probability of e sqrt(n) at most, once in 100 000
   matrices of a million unknowns that are not positive definite. */
static corot_status pcg_prove(void *solver, bool *definite) {
  static const double small = 1e-8;
  pcg *p = solver;
  uint64_t seed = 1;
  if (!p->factored) return corot_fail(COROT_EINVAL, "pcg: prove: there is no factor");
  memset(p->b, 0, 3 * (size_t)p->A.n * sizeof *p->b);
  for (int i = 0; i < p->csc->n; i++) p->b[p->A.slot[i]] = draw(&seed);
  p->aim = small;
  corot_status status = iterate(p);
  p->aim = p->tolerance;
  *definite = !p->indefinite;
  return p->indefinite ? COROT_OK : status;
}

static void pcg_share(void *solver, team *by) { ((pcg *)solver)->A.team = by; }

static long pcg_iterations(const void *solver) { return ((const pcg *)solver)->iterations; }

static const linsol_variant variants[] = {
    {.name = "pcg, block-jacobi", .preconditioner = "block-jacobi"},
    {.name = "pcg, incomplete-cholesky", .preconditioner = "incomplete-cholesky"},
    {.name = "pcg, hierarchical", .preconditioner = "hierarchical"},
    {.name = "pcg, multigrid", .preconditioner = "multigrid"},
    {.name = "pcg, amg", .preconditioner = "amg"},
    {.name = NULL},
};

const linsol_ops corot_linsol_pcg = {
    .name = "pcg",
    .variants = variants,
    .iterative = true,
    .triangle = COROT_LOWER,
    .create = pcg_create,
    .factor = pcg_factor,
    .solve = pcg_solve,
    .destroy = pcg_destroy,
    .iterations = pcg_iterations,
    .aim = pcg_aim,
    .met_indefinite = pcg_met_indefinite,
    .prove = pcg_prove,
    .share = pcg_share,
};
