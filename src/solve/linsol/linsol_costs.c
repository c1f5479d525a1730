/* What solutions cost on a machine: the numbers that "auto" chooses by, and how they are found. */
#include <corot/mesh.h>
#include <corot/model.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/base/sized.h"
#include "linsol.h"

/* By corot_linear_costs_measure, see corot/solve.h. */
corot_linear_costs corot_linear_costs_usual(void) {
  return (corot_linear_costs){
#ifdef COROT_HAVE_CHOLMOD
      .operation = 0.07,
      .made = 20,
#else
      .operation = 0.65,
      .made = 0,
#endif
      .solved = 1.6,
      .incomplete = 6,
      .iterated = 1.05,
      .aggregated = 95,
      .cycled = 6.5,
  };
}

/* --- Measuring ------------------------------------------------------------------------------- */

/* A cube held at its base, at rest, with room for its stiffness and a solution. */
typedef struct subject {
  corot_model *model;
  corot_state *state;
  corot_csc *csc;
  double (*K)[9];
  double *u, *value, *x; /* [n], [nnz], [n] */
} subject;

static corot_status make_model(int cells, corot_model **model) {
  corot_box box = {.size = {1, 1, 1}, .cells = {cells, cells, cells}};
  corot_material material = {.lambda = 1.5, .mu = 1, .density = 1}; /* nu = 0.3 */
  corot_fix base = {"zmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  corot_mesh *mesh;
  COROT_TRY(corot_mesh_box(&box, &mesh));
  def.mesh = mesh;
  def.nmaterial = 1, def.material = &material;
  def.nfix = 1, def.fix = &base;
  corot_status status = corot_model_create(&def, model);
  corot_mesh_destroy(mesh);
  return status;
}

static void clear(subject *s) {
  corot_csc_destroy(s->csc);
  corot_state_destroy(s->state);
  corot_model_destroy(s->model);
  free(s->K);
  free(s->u);
  free(s->value);
}

static corot_status make(int cells, subject *s) {
  COROT_TRY(make_model(cells, &s->model));
  COROT_TRY(corot_state_create(s->model, &s->state));
  size_t n = (size_t)corot_model_ndof(s->model), nblock = (size_t)corot_model_nblock(s->model);
  s->K = malloc(nblock * sizeof *s->K);
  s->u = calloc(2 * n, sizeof *s->u);
  if (!s->K || !s->u) return corot_fail(COROT_ENOMEM, "no memory for a stiffness to measure");
  s->x = s->u + n;
  return corot_jacobian(s->model, s->state, 0, s->u, NULL, COROT_TANGENT_EXACT, s->K, NULL);
}

/* The stiffness as this solver reads it. */
static corot_status fill_in(subject *s, corot_triangle triangle) {
  corot_csc_destroy(s->csc);
  free(s->value);
  s->csc = NULL, s->value = NULL;
  COROT_TRY(corot_csc_create(s->model, triangle, &s->csc));
  s->value = malloc((size_t)s->csc->nnz * sizeof *s->value);
  if (!s->value) return corot_fail(COROT_ENOMEM, "no memory for a matrix to measure");
  corot_csc_combine(s->model, s->csc, 0, 0, (const double(*)[9])s->K, 1, (const double(*)[9])s->K,
                    s->value);
  return COROT_OK;
}

/* Nanoseconds of the processor: not those that it spends on others. */
static double cpu_ns(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

/* The least of several factorisations, and of as many solutions [ns]. */
typedef struct cost {
  double factor, solution;
  double entries, operations, triangle; /* of the factor, in it, of the matrix */
  double iterations;                    /* of a solution */
} cost;

static corot_status run(subject *s, const linsol_ops *ops, void *solver, cost *c) {
  enum { LEAST = 3, MOST = 20 };
  const double enough = 3e8;
  int n = corot_model_ndof(s->model);
  bool fresh;
  COROT_TRY(ops->factor(solver, s->value, &fresh)); /* the first one allocates */
  c->factor = c->solution = INFINITY;
  double begin = cpu_ns();
  for (int k = 0; k < LEAST || (k < MOST && cpu_ns() - begin < enough); k++) {
    double start = cpu_ns();
    COROT_TRY(ops->factor(solver, s->value, &fresh));
    c->factor = fmin(c->factor, cpu_ns() - start);
    for (int i = 0; i < n; i++) s->x[i] = 1 + i % 3;
    long before = ops->iterations ? ops->iterations(solver) : 0;
    start = cpu_ns();
    COROT_TRY(ops->solve(solver, s->x));
    c->solution = fmin(c->solution, cpu_ns() - start);
    if (ops->iterations) c->iterations = (double)(ops->iterations(solver) - before);
  }
  return COROT_OK;
}

static corot_status measure(subject *s, const char *name, const char *preconditioner, cost *c) {
  corot_linear_def def = corot_linear_defaults();
  linsol_plan plan = {0};
  void *solver = NULL;
  def.solver = name, def.preconditioner = preconditioner, def.role = COROT_ROLE_STATIC;
  COROT_TRY(fill_in(s, COROT_LOWER));
  c->triangle = s->csc->nnz;
  COROT_TRY(corot_linsol_choose(&def, s->csc, &plan));
  c->entries = plan.entries, c->operations = plan.operations;
  corot_status status = plan.ops->triangle == COROT_FULL ? fill_in(s, COROT_FULL) : COROT_OK;
  if (!status) status = plan.ops->create(s->csc, &plan, &solver);
  if (!status) status = run(s, plan.ops, solver, c);
  if (solver) plan.ops->destroy(solver);
  corot_linsol_plan_clear(&plan);
  return status;
}

/* From two factors of different size; a machine so much out of the ordinary that one of the parts
   comes out negative has the other only. */
static void part(const cost c[2], corot_linear_costs *costs) {
  double ratio[2];
  for (int k = 0; k < 2; k++) ratio[k] = c[k].operations / c[k].entries;
  double per[2] = {c[0].factor / c[0].entries, c[1].factor / c[1].entries};
  costs->operation = fmax(0, (per[1] - per[0]) / (ratio[1] - ratio[0]));
  costs->made = per[0] - costs->operation * ratio[0];
  if (costs->made >= 0) return;
  costs->made = 0;
  costs->operation = per[1] / ratio[1];
}

static corot_status measure_direct(subject s[2], corot_linear_costs *costs) {
  cost c[2] = {0};
  for (int k = 0; k < 2; k++) COROT_TRY(measure(&s[k], corot_linsol_direct, "auto", &c[k]));
  part(c, costs);
  costs->solved = c[1].solution / c[1].entries;
  return COROT_OK;
}

static corot_status measure_all(subject s[2], const int cells[2], corot_linear_costs *costs) {
  cost c = {0};
  for (int k = 0; k < 2; k++) COROT_TRY(make(cells[k], &s[k]));
  COROT_TRY(measure_direct(s, costs));
  COROT_TRY(measure(&s[1], "pcg", "incomplete-cholesky", &c));
  costs->incomplete = c.factor / c.triangle;
  costs->iterated = c.solution / c.iterations / c.triangle;
  COROT_TRY(measure(&s[1], "pcg", "amg", &c));
  costs->aggregated = c.factor / c.triangle;
  costs->cycled = c.solution / c.iterations / c.triangle;
  return COROT_OK;
}

corot_status corot_linear_costs_measure_on(const int cells[2], corot_linear_costs *costs) {
  subject s[2] = {0};
  corot_linear_costs found;
  corot_status status = measure_all(s, cells, &found);
  for (int k = 0; k < 2; k++) clear(&s[k]);
  if (!status) *costs = found;
  return status;
}

corot_status corot_linear_costs_measure(corot_linear_costs *costs) {
  static const int cells[] = {12, 20};
  COROT_TRY(COROT_GIVEN(costs));
  return corot_linear_costs_measure_on(cells, costs);
}
