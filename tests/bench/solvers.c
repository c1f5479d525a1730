#include "solvers.h"

#include <stdlib.h>
#include <string.h>

#include "app/run/run_clock.h"
#include "report.h"

enum { KLU_MOST = 12000 };

corot_status problem_create(const specimen *s, const corot_linear_def *def, double a, double b,
                            double c, problem *p) {
  *p = (problem){0};
  COROT_TRY(corot_linsol_create(s->model, def, &p->s));
  p->x = malloc(2 * (size_t)s->n * sizeof *p->x);
  if (!p->x) return corot_fail(COROT_ENOMEM, "no memory for %d unknowns", s->n);
  p->b = p->x + s->n;
  for (int i = 0; i < s->n; i++) p->b[i] = 1 + i % 3;
  corot_linsol_move(&p->s, s->model, 0, s->u);
  corot_csc_combine(s->model, p->s.csc, a, b, (const double(*)[9])s->D, c, (const double(*)[9])s->K,
                    p->s.value);
  return COROT_OK;
}

void problem_clear(problem *p) {
  corot_linsol_clear(&p->s);
  free(p->x);
}

corot_status problem_factor(void *data) {
  problem *p = data;
  bool fresh;
  return p->s.ops->factor(p->s.solver, p->s.value, &fresh);
}

/* The right-hand side is new each time, as solutions of solutions would fade away. */
corot_status problem_solve(void *data) {
  problem *p = data;
  memcpy(p->x, p->b, p->s.csc->n * sizeof *p->x);
  return p->s.ops->solve(p->s.solver, p->x);
}

/* First factorisations, each with a solver made for it. */
static corot_status first_factors(const specimen *s, const corot_linear_def *def, problem *p,
                                  timing *time) {
  enum { FEWEST = 3, MOST = 15 };
  double sample[MOST], spent = 0, g = 0.01;
  int n = 0;
  for (; (n < FEWEST && spent < 2) || (n < MOST && spent < 0.5); n++) {
    problem_clear(p);
    COROT_TRY(problem_create(s, def, 1, g, g * g, p));
    double start = cpu_clock();
    COROT_TRY(problem_factor(p));
    sample[n] = cpu_clock() - start;
    spent += sample[n];
  }
  *time = timing_summary(n, sample);
  return COROT_OK;
}

/* Once there is a factor. */
static corot_status least_cost(const corot_csc *full, problem *p, solver_cost *out) {
  const linsol_ops *ops = p->s.ops;
  if (!ops->iterations) return cost_direct(full, ops->triangle == COROT_LOWER, out);
  long before = ops->iterations(p->s.solver);
  COROT_TRY(problem_solve(p));
  *out = cost_pcg(full, (double)(ops->iterations(p->s.solver) - before));
  return COROT_OK;
}

static corot_status measure(bool json, const specimen *s, const corot_csc *full,
                            const corot_linear_def *def, problem *p) {
  row r = {.bench = "factor", .solver = def->solver, .ntet = s->ntet, .n = s->n};
  solver_cost least;
  COROT_TRY(first_factors(s, def, p, &r.time));
  COROT_TRY(least_cost(full, p, &least));
  r.least = least.factor;
  report_row(json, &r);
  r.bench = "refactor";
  COROT_TRY(timing_of(problem_factor, p, &r.time));
  report_row(json, &r);
  r.bench = "solve", r.least = least.solve;
  COROT_TRY(timing_of(problem_solve, p, &r.time));
  report_row(json, &r);
  return COROT_OK;
}

corot_status solvers_measure(bool json, const specimen *s) {
  static const char *const names[] = {"klu", "cholmod", "pcg"};
  corot_csc *full;
  COROT_TRY(corot_csc_create(s->model, COROT_FULL, &full));
  corot_status status = COROT_OK;
  for (int k = 0; k < 3 && !status; k++) {
    corot_linear_def def = corot_linear_defaults();
    def.solver = names[k];
    if (k == 0 && s->n > KLU_MOST) continue;
    problem p = {0};
    status = measure(json, s, full, &def, &p);
    if (status == COROT_EINVAL && !p.s.ops) status = COROT_OK; /* not in this build */
    problem_clear(&p);
  }
  corot_csc_destroy(full);
  return status;
}
