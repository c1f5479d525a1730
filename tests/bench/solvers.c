/* corot-bench solvers: the linear solvers at a few sizes. */
#include "solvers.h"

#include <stdlib.h>
#include <string.h>

#include "app/clock.h"
#include "bench.h"
#include "report.h"
#include "solve/linsol.h"

enum { KLU_MOST = 12000 };

static const char help[] =
    "usage: corot-bench solvers [--json]\n"
    "\n"
    "Factorisation and solution of the matrix of an implicit step by each linear solver, in boxes\n"
    "of several sizes. KLU is left out beyond 12000 unknowns; pcg solves to a relative residual\n"
    "of 1e-10. CHOLMOD may use threads of its BLAS, whose time then adds up; with\n"
    "OPENBLAS_NUM_THREADS=1 in the environment all is done on one core.\n"
    "\n"
    "      --json     one JSON object a line\n"
    "\n"
    "example: corot-bench solvers\n";

typedef struct problem {
  const linsol_ops *ops;
  corot_csc *csc;
  double *S, *x, *b; /* [nnz], [n], [n] */
  void *solver;
} problem;

static corot_status refactor(void *data) {
  problem *p = data;
  bool fresh;
  return p->ops->factor(p->solver, p->S, &fresh);
}

/* The right-hand side is new each time, as solutions of solutions would fade away. */
static corot_status solve(void *data) {
  problem *p = data;
  memcpy(p->x, p->b, p->csc->n * sizeof *p->x);
  return p->ops->solve(p->solver, p->x);
}

/* First factorisations, each with a solver made for it. */
static corot_status first_factors(problem *p, timing *time) {
  enum { FEWEST = 3, MOST = 15 };
  double sample[MOST], spent = 0;
  int n = 0;
  for (; (n < FEWEST && spent < 2) || (n < MOST && spent < 0.5); n++) {
    if (p->solver) p->ops->destroy(p->solver);
    p->solver = NULL;
    COROT_TRY(p->ops->create(p->csc, &p->solver));
    double start = cpu_clock();
    COROT_TRY(refactor(p));
    sample[n] = cpu_clock() - start;
    spent += sample[n];
  }
  *time = timing_summary(n, sample);
  return COROT_OK;
}

/* S with g = 10 ms, a step that resolves the slow motion. */
static corot_status prepare(const solid *s, problem *p) {
  const double g = 0.01;
  COROT_TRY(corot_csc_create(s->model, p->ops->triangle, &p->csc));
  p->S = malloc(p->csc->nnz * sizeof *p->S);
  p->x = malloc(2 * (size_t)s->n * sizeof *p->x);
  if (!p->S || !p->x) return corot_fail(COROT_ENOMEM, "no memory for a matrix");
  p->b = p->x + s->n;
  for (int i = 0; i < s->n; i++) p->b[i] = 1 + i % 3;
  corot_csc_combine(s->model, p->csc, 1, g, (const double(*)[9])s->D, g * g,
                    (const double(*)[9])s->K, p->S);
  return COROT_OK;
}

/* Once there is a factor. */
static corot_status least_cost(const corot_csc *full, problem *p, solver_cost *out) {
  if (!p->ops->iterations) return cost_direct(full, p->ops->triangle == COROT_LOWER, out);
  long before = p->ops->iterations(p->solver);
  COROT_TRY(solve(p));
  *out = cost_pcg(full, (double)(p->ops->iterations(p->solver) - before));
  return COROT_OK;
}

static corot_status measure(bool json, const solid *s, const corot_csc *full, problem *p) {
  row r = {.bench = "factor", .solver = p->ops->name, .ntet = s->ntet, .n = s->n};
  solver_cost least;
  COROT_TRY(first_factors(p, &r.time));
  COROT_TRY(least_cost(full, p, &least));
  r.least = least.factor;
  report_row(json, &r);
  r.bench = "refactor";
  COROT_TRY(timing_of(refactor, p, &r.time));
  report_row(json, &r);
  r.bench = "solve", r.least = least.solve;
  COROT_TRY(timing_of(solve, p, &r.time));
  report_row(json, &r);
  return COROT_OK;
}

static corot_status one_solver(bool json, const solid *s, const corot_csc *full,
                               const linsol_ops *ops) {
  problem p = {.ops = ops};
  corot_status status = prepare(s, &p);
  if (!status) status = measure(json, s, full, &p);
  if (p.solver) ops->destroy(p.solver);
  corot_csc_destroy(p.csc);
  free(p.S), free(p.x);
  return status;
}

corot_status solvers_measure(bool json, const solid *s) {
  static const char *const names[] = {"klu", "cholmod", "pcg"};
  corot_csc *full;
  COROT_TRY(corot_csc_create(s->model, COROT_FULL, &full));
  corot_status status = COROT_OK;
  for (int k = 0; k < 3 && !status; k++) {
    const linsol_ops *ops;
    if (corot_linsol_find(names[k], s->n, &ops) != COROT_OK) continue; /* not in this build */
    if (k == 0 && s->n > KLU_MOST) continue;
    status = one_solver(json, s, full, ops);
  }
  corot_csc_destroy(full);
  return status;
}

static corot_status of_size(bool json, int ntet) {
  corot_mesh *mesh;
  solid s = {0};
  COROT_TRY(solid_mesh(ntet, &mesh));
  corot_status status = solid_create(mesh, "polar", true, &s);
  corot_mesh_destroy(mesh);
  if (status) return status;
  report_heading(json, s.ntet, s.n);
  status = corot_jacobian(s.model, s.state, 0, s.u, s.v, COROT_TANGENT_HELD, s.K, s.D);
  if (!status) status = solvers_measure(json, &s);
  solid_clear(&s);
  return status;
}

int command_solvers(int argc, char **argv) {
  static const int ntet[] = {288, 2304, 7776, 18432, 36000};
  bool json;
  int code = only_json("corot-bench solvers", help, argc, argv, &json);
  if (code >= 0) return code;
  report_machine(json);
  for (size_t k = 0; k < sizeof ntet / sizeof *ntet; k++) {
    corot_status status = of_size(json, ntet[k]);
    if (status) return failure(status);
  }
  return EXIT_OK;
}
