/* Which solver, ordering, factor and preconditioner: by name, or by what they would cost. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "linsol.h"
#include "linsol_graph.h"
#include "solve/linsol/iterative/linsol_multilevel.h"

#ifdef COROT_HAVE_CHOLMOD
enum { HAVE_CHOLMOD = 1 };
#else
enum { HAVE_CHOLMOD = 0 };
static const linsol_ops corot_linsol_cholmod = {.name = "cholmod"}; /* not in this build */
#endif
#ifdef COROT_HAVE_METIS
enum { NORDERING = 2 }; /* of the names below */
#else
enum { NORDERING = 1 };
#endif

/* The solvers, each with its row in a file of its own. */
static const linsol_ops *const solvers[] = {&corot_linsol_klu, &corot_linsol_cholmod,
                                            &corot_linsol_pcg};
enum { NSOLVER = sizeof solvers / sizeof *solvers, MOST_NAMES = 5 };
_Static_assert((int)NSOLVER <= MOST_NAMES, "a choice has no room for the names of all solvers");

/* What else there is to choose: how it is called, and the names that it has beside auto. */
typedef struct choice {
  const char *what, *name[MOST_NAMES + 1]; /* up to a NULL */
} choice;

static const choice orderings = {.what = "ordering", .name = {"amd", "metis"}};
static const choice factors = {.what = "factor", .name = {"simplicial", "supernodal"}};
static const choice preconditioners = {
    .what = "preconditioner",
    .name = {"block-jacobi", "incomplete-cholesky", "amg", "hierarchical", "multigrid"}};

const char *const corot_linsol_direct = HAVE_CHOLMOD ? "cholmod" : "klu";

/* *name becomes our own copy of it, or NULL for "auto". */
static corot_status look_up(const choice *c, const char **name) {
  const char *given = *name ? *name : "";
  char list[80] = "auto";
  *name = NULL;
  if (strcmp(given, "auto") == 0) return COROT_OK;
  for (int k = 0; c->name[k]; k++) {
    if (strcmp(given, c->name[k]) == 0) {
      *name = c->name[k];
      return COROT_OK;
    }
    size_t end = strlen(list);
    snprintf(list + end, sizeof list - end, "%s%s", c->name[k + 1] ? ", " : " or ", c->name[k]);
  }
  return corot_fail(COROT_EINVAL, "no %s '%s': %s", c->what, given, list);
}

static corot_status look_up_all(corot_linear_def *d) {
  choice names = {.what = "linear solver"};
  for (int k = 0; k < NSOLVER; k++) names.name[k] = solvers[k]->name;
  COROT_TRY(look_up(&names, &d->solver));
  COROT_TRY(look_up(&orderings, &d->ordering));
  COROT_TRY(look_up(&factors, &d->factor));
  COROT_TRY(look_up(&preconditioners, &d->preconditioner));
  if (!(d->tolerance > 0))
    return corot_fail(COROT_EINVAL, "linear solver: tolerance = %g is not positive", d->tolerance);
  return COROT_OK;
}

/* The row of a name that has been looked up; NULL: of none, "auto". */
static const linsol_ops *row_of(const char *name) {
  for (int k = 0; name && k < NSOLVER; k++)
    if (strcmp(name, solvers[k]->name) == 0) return solvers[k];
  return NULL;
}

static bool fits(const char *wanted, const char *chosen) {
  return !wanted || (chosen && strcmp(wanted, chosen) == 0);
}

static const char *full_name(const linsol_ops *ops, const corot_linear_def *d) {
  const linsol_variant *v = ops->variants;
  while (!(fits(v->factor, d->factor) && fits(v->preconditioner, d->preconditioner) &&
           fits(v->ordering, d->ordering)))
    v++;
  return v->name;
}

static corot_status find(linsol_plan *plan) {
  plan->ops = row_of(plan->def.solver);
  if (!plan->ops->create)
    return corot_fail(COROT_EINVAL,
                      "linear solver %s is not in this build (configure with COROT_CHOLMOD=ON)",
                      plan->def.solver);
  plan->name = full_name(plan->ops, &plan->def);
  plan->by_place = plan->ops->iterative && corot_multilevel_find(plan->def.preconditioner);
  return COROT_OK;
}

static corot_status check_refinement(const corot_linear_def *d) {
  const multilevel_ops *levels =
      row_of(d->solver)->iterative ? corot_multilevel_find(d->preconditioner) : NULL;
  if (!levels || !levels->refined || d->refinement) return COROT_OK;
  return corot_fail(COROT_EINVAL, "preconditioner %s: the mesh has no refinement",
                    d->preconditioner);
}

/* The given ordering, or the one of fewest operations. */
static corot_status order_nodes(node_graph *g, const char **name, int *order, graph_fill *fill) {
  int *trial = malloc(g->n * sizeof *trial);
  if (!trial) return corot_fail(COROT_ENOMEM, "no memory to order %d nodes", g->n);
  corot_status status = COROT_OK;
  const char *given = *name;
  for (int k = 0; k < (given ? 1 : NORDERING) && !status; k++) {
    const char *ordering = given ? given : orderings.name[k];
    status = corot_graph_order(g, ordering, trial);
    if (status) break;
    graph_fill f = corot_graph_fill(g, trial);
    if (k > 0 && f.flops >= fill->flops) continue;
    memcpy(order, trial, g->n * sizeof *order);
    *name = ordering, *fill = f;
  }
  free(trial);
  return status;
}

/* Nanoseconds of one core (AVX-512, 2 MB of cache; corot-bench solvers), of which only the ratios
   matter: for an operation of a factorisation and for an entry of the factor that it makes, for an
   entry in a solution, and for an entry of the matrix in an iteration. */
static const double operation_ns = HAVE_CHOLMOD ? 0.018 : 0.65, made_ns = HAVE_CHOLMOD ? 20 : 0,
                    solved_ns = 1.5, iterated_ns = 1.2;

/* From so many operations an entry on, dense blocks pay on one core (with more of them, sooner). */
static const double dense = 80;

/* As many steps go by between two factorisations, and so many solutions does a step take. */
static const double steps = 20, solutions = 1.1;

/* Iterations to a residual of 1e-10: with the mass, of a step that resolves the slow motion, as
   many as there are nodes along an edge, times this; without it, as there are along the body. */
static const double per_edge = 9, per_length = 20;

/* In statics algebraic multigrid takes the place of incomplete Cholesky from so many unknowns on:
   for a cube of 1944 it takes 6 ms instead of 10, of 26 460 159 instead of 417; for a bar of 1800 6
   instead of 14, of 36 504 303 instead of 1330 (corot-bench solvers --role static). A factor and a
   solution cost as much as `amg_whole` iterations with incomplete Cholesky, an iteration as much as
   `amg_iteration` of them. In a step the mass may leave so few iterations that nothing is gained.
 */
enum { AMG_LEAST = 1500 };
static const double amg_whole = 400, amg_iteration = 8;

/* Larger factors (8 GB) do not fit many a memory. */
static const double most_entries = 1e9;

static double factor_ns(const graph_fill *f) { return operation_ns * f->flops + made_ns * f->nnz; }

static bool takes_amg(const corot_csc *csc, corot_role role) {
  return role == COROT_ROLE_STATIC && csc->n >= AMG_LEAST;
}

/* Whether conjugate gradients are the faster, by a margin: a factor does not depend on how well
   conditioned a matrix is, nor on the guesses above. */
static bool iteration_pays(const corot_csc *csc, node_graph *g, const graph_fill *f,
                           corot_role role) {
  const double margin = 1.15;
  if (f->nnz > most_entries) return true;
  if (role == COROT_ROLE_STATIC && HAVE_CHOLMOD)
    return false; /* pcg cannot tell a stable equilibrium */
  double factor = factor_ns(f), solution = solved_ns * f->nnz;
  if (role == COROT_ROLE_STATIC) {
    double iterations = takes_amg(csc, role) ? amg_whole : per_length * (corot_graph_length(g) + 1);
    return margin * iterations * iterated_ns * csc->nnz < factor + solution;
  }
  double iteration = per_edge * cbrt(g->n) * iterated_ns * csc->nnz;
  return margin * solutions * iteration < factor / steps + solutions * solution;
}

/* How well conditioned a matrix is shows only in the iterations: flat tets, stiff inclusions and
   incompressible materials take many times those above, or go on without end. So the costs of the
   direct solver that was not chosen are kept, and one system may cost three factors and solutions
   (see corot_pencil_solve). */
static void limit_iterations(const corot_csc *csc, const graph_fill *f, linsol_plan *plan) {
  if (f->nnz > most_entries) return; /* there is no other */
  const char *preconditioner = plan->def.preconditioner;
  bool amg = preconditioner && strcmp(preconditioner, corot_amg.name) == 0;
  double iteration = (amg ? amg_iteration : 1) * iterated_ns * csc->nnz;
  plan->rival.factor = factor_ns(f) / iteration;
  plan->rival.solution = solved_ns * f->nnz / iteration;
  plan->most_iterations = 100 + lround(fmin(1e9, 3 * (plan->rival.factor + plan->rival.solution)));
}

static corot_status analyze(const corot_csc *csc, node_graph *g, linsol_plan *plan) {
  corot_linear_def *d = &plan->def;
  graph_fill fill = {0};
  int *nodes = malloc(csc->n * sizeof *nodes);
  plan->order = malloc(csc->n * sizeof *plan->order);
  corot_status status = COROT_OK;
  if (!nodes || !plan->order)
    status = corot_fail(COROT_ENOMEM, "no memory to order %d unknowns", csc->n);
  if (!status) status = order_nodes(g, &d->ordering, nodes, &fill);
  for (int k = 0, i = 0; k < g->n && !status; k++)
    for (int j = g->first[nodes[k]]; j < g->first[nodes[k] + 1]; j++) plan->order[i++] = j;
  free(nodes);
  if (status) return status;
  if (!d->solver && iteration_pays(csc, g, &fill, d->role)) {
    d->solver = corot_linsol_pcg.name;
    limit_iterations(csc, &fill, plan);
  }
  if (!d->solver) d->solver = corot_linsol_direct;
  if (!d->factor) d->factor = fill.flops > dense * fill.nnz ? "supernodal" : "simplicial";
  return COROT_OK;
}

corot_status corot_linsol_choose(const corot_linear_def *def, const corot_csc *lower,
                                 linsol_plan *plan) {
  linsol_plan p = {.def = *def};
  node_graph g = {0};
  COROT_TRY(look_up_all(&p.def));
  corot_status status = COROT_OK;
  const linsol_ops *asked = row_of(p.def.solver);
  p.by_cost = !asked;
  if (!p.def.preconditioner)
    p.def.preconditioner = takes_amg(lower, def->role) ? corot_amg.name : "incomplete-cholesky";
  if (!asked || !asked->iterative) {
    status = corot_graph_create(lower, &g);
    if (!status) status = analyze(lower, &g, &p);
  }
  corot_graph_clear(&g);
  if (!status) status = check_refinement(&p.def);
  if (!status) status = find(&p);
  if (status) {
    corot_linsol_plan_clear(&p);
    return status;
  }
  *plan = p;
  return COROT_OK;
}

void corot_linsol_plan_clear(linsol_plan *plan) {
  free(plan->order);
  plan->order = NULL;
}
