/* Which solver, ordering, factor and preconditioner: by name, or by what they would cost. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/memory_limit.h"
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

/* From so many operations an entry on, dense blocks pay on one core (with more of them, sooner). */
static const double dense = 80;

/* As many steps go by between two factorisations, and so many solutions does a step take. */
static const double steps = 20, solutions = 1.1;

/* Iterations of incomplete Cholesky: in a step that resolves the slow motion, to a residual of
   1e-10, as many as there are nodes along an edge, times `per_edge`; in statics, to the 1e-5 that
   Newton's iteration asks for, `per_length` times those along the body to the power `growth`. Of
   algebraic multigrid, which is for statics, as the mass may leave so few iterations that nothing
   is gained; and for unknowns enough for a second level (corot-bench solvers). */
static const double per_edge = 9, per_length = 7.3, growth = 1.24, of_amg = 20;
enum { AMG_LEAST = 1500 };

/* Bytes for an entry of the factor: cholmod in dense blocks, with its work space (11 measured, with
   blocks that are filled up), and by columns; klu, which has two factors with their indices. */
static const double in_blocks = 11, by_columns = 16, of_klu = 30;

/* Bytes for an entry of the matrix's triangle of what there is beside a factor: mesh, model, state,
   K and D, the matrix, the integrator's vectors and a frame of the fields; and for what conjugate
   gradients need (corot-bench phases). */
static const double beside = 100, of_iteration = 20;

/* Factors that need more of the machine than this part are not chosen: others are at work on it. */
static const double most_of_machine = 1.0 / 3;

static double factor_ns(const corot_linear_costs *of, const graph_fill *f) {
  return of->operation * f->flops + of->made * f->nnz;
}

static bool pays_in_blocks(const graph_fill *f) { return f->flops > dense * f->nnz; }

/* Of a whole run by the direct solver that is asked for or would be chosen. */
static double bytes_of(const corot_linear_def *d, const corot_csc *csc, const graph_fill *f) {
  const char *solver = d->solver ? d->solver : corot_linsol_direct;
  bool blocks = d->factor ? strcmp(d->factor, "supernodal") == 0 : pays_in_blocks(f);
  double entry = strcmp(solver, "klu") == 0 ? of_klu : blocks ? in_blocks : by_columns;
  return beside * csc->nnz + entry * f->nnz;
}

/* A direct solver that does not fit: its memory, and the sentence. */
static corot_status check_room(const corot_linear_def *d, const corot_csc *csc, const graph_fill *f,
                               const corot_memory_limit *memory) {
  double bytes = bytes_of(d, csc, f);
  if (bytes <= memory->process) return COROT_OK;
  return corot_fail(
      COROT_ENOMEM,
      "linear solver %s: a factor of %.3g entries for %d unknowns needs %.3g GB of memory in all, "
      "and %s has %.3g; pcg, which makes none, needs %.3g",
      d->solver, f->nnz, csc->n, bytes / 1e9, memory->what, memory->process / 1e9,
      (beside + of_iteration) * csc->nnz / 1e9);
}

/* Whether a factor would leave too little of the memory for others. */
static bool is_too_large(const corot_linear_def *d, const corot_csc *csc, const graph_fill *f,
                         const corot_memory_limit *memory) {
  return bytes_of(d, csc, f) > fmin(memory->process, most_of_machine * memory->machine);
}

/* Factors that metis orders have had half the entries of amd's or more (boxes of 3000 to 1.4
   million tets): where this part of them is too much, metis, which takes ten times as long, is not
   asked. */
static const double least_share = 0.4;

static bool is_hopeless(const corot_linear_def *d, const corot_csc *csc, const graph_fill *f,
                        const corot_memory_limit *memory) {
  const graph_fill least = {.nnz = least_share * f->nnz, .flops = least_share * f->flops};
  return !d->solver && is_too_large(d, csc, &least, memory);
}

/* The given ordering, or the one of fewest operations. */
static corot_status order_nodes(const corot_csc *csc, node_graph *g,
                                const corot_memory_limit *memory, corot_linear_def *d, int *order,
                                graph_fill *fill) {
  int *trial = malloc(g->n * sizeof *trial);
  if (!trial) return corot_fail(COROT_ENOMEM, "no memory to order %d nodes", g->n);
  corot_status status = COROT_OK;
  const char *given = d->ordering;
  for (int k = 0; k < (given ? 1 : NORDERING) && !status; k++) {
    const char *ordering = given ? given : orderings.name[k];
    status = corot_graph_order(g, ordering, trial);
    if (status) break;
    graph_fill f = corot_graph_fill(g, trial);
    if (k > 0 && f.flops >= fill->flops) continue;
    memcpy(order, trial, g->n * sizeof *order);
    d->ordering = ordering, *fill = f;
    if (is_hopeless(d, csc, fill, memory)) break;
  }
  free(trial);
  return status;
}

/* Set-up and iterations of one solution in statics. */
static double iterated_static_ns(const corot_linear_costs *of, const char *preconditioner,
                                 const corot_csc *csc, node_graph *g) {
  if (strcmp(preconditioner, corot_amg.name) == 0)
    return (of->aggregated + of_amg * of->cycled) * csc->nnz;
  double iterations = per_length * pow(corot_graph_length(g) + 1, growth);
  return (of->incomplete + iterations * of->iterated) * csc->nnz;
}

static const char *choose_preconditioner(const corot_linear_costs *of, const corot_csc *csc,
                                         node_graph *g, corot_role role) {
  static const char usual[] = "incomplete-cholesky";
  if (role != COROT_ROLE_STATIC || csc->n < AMG_LEAST) return usual;
  return iterated_static_ns(of, corot_amg.name, csc, g) < iterated_static_ns(of, usual, csc, g)
             ? corot_amg.name
             : usual;
}

/* Whether conjugate gradients are the faster, by a margin: a factor does not depend on how well
   conditioned a matrix is, nor on the guesses above. */
static bool iteration_pays(const corot_linear_def *d, const corot_csc *csc, node_graph *g,
                           const graph_fill *f) {
  const double margin = 1.15;
  double factor = factor_ns(d->costs, f), solution = d->costs->solved * f->nnz;
  if (d->role == COROT_ROLE_STATIC)
    return margin * iterated_static_ns(d->costs, d->preconditioner, csc, g) < factor + solution;
  double iteration = per_edge * cbrt(g->n) * d->costs->iterated * csc->nnz;
  return margin * solutions * iteration < factor / steps + solutions * solution;
}

/* How well conditioned a matrix is shows only in the iterations: flat tets, stiff inclusions and
   incompressible materials take many times those above, or go on without end. So the costs of the
   direct solver that was not chosen are kept, and one system may cost three factors and solutions
   (see corot_pencil_solve). */
static void limit_iterations(const corot_csc *csc, const graph_fill *f, linsol_plan *plan) {
  const corot_linear_costs *of = plan->def.costs;
  const char *preconditioner = plan->def.preconditioner;
  bool amg = preconditioner && strcmp(preconditioner, corot_amg.name) == 0;
  double iteration = (amg ? of->cycled : of->iterated) * csc->nnz;
  plan->rival.factor = factor_ns(of, f) / iteration;
  plan->rival.solution = of->solved * f->nnz / iteration;
  plan->most_iterations = 100 + lround(fmin(1e9, 3 * (plan->rival.factor + plan->rival.solution)));
}

static corot_status decide(const corot_csc *csc, node_graph *g, const graph_fill *f,
                           const corot_memory_limit *memory, linsol_plan *plan) {
  corot_linear_def *d = &plan->def;
  bool too_large = is_too_large(d, csc, f, memory), fits = bytes_of(d, csc, f) <= memory->process;
  if (!d->solver && (too_large || iteration_pays(d, csc, g, f))) {
    d->solver = corot_linsol_pcg.name;
    /* a large factor is made where iterations fail, not where they are slow; one that does not fit
       is never made */
    plan->by_cost = fits;
    if (!too_large) limit_iterations(csc, f, plan);
  } else {
    if (!d->solver) d->solver = corot_linsol_direct;
    COROT_TRY(check_room(d, csc, f, memory));
  }
  if (!d->factor) d->factor = pays_in_blocks(f) ? "supernodal" : "simplicial";
  return COROT_OK;
}

static corot_status analyze(const corot_csc *csc, node_graph *g, const corot_memory_limit *memory,
                            linsol_plan *plan) {
  corot_linear_def *d = &plan->def;
  graph_fill fill = {0};
  int *nodes = malloc(csc->n * sizeof *nodes);
  plan->order = malloc(csc->n * sizeof *plan->order);
  corot_status status = COROT_OK;
  if (!nodes || !plan->order)
    status = corot_fail(COROT_ENOMEM, "no memory to order %d unknowns", csc->n);
  if (!status) status = order_nodes(csc, g, memory, d, nodes, &fill);
  for (int k = 0, i = 0; k < g->n && !status; k++)
    for (int j = g->first[nodes[k]]; j < g->first[nodes[k] + 1]; j++) plan->order[i++] = j;
  free(nodes);
  plan->entries = fill.nnz, plan->operations = fill.flops;
  return status ? status : decide(csc, g, &fill, memory, plan);
}

/* A direct solver needs the order of its unknowns, and a choice the lengths of the graph. */
static corot_status look_at_graph(const corot_csc *lower, const corot_memory_limit *memory,
                                  linsol_plan *p) {
  corot_linear_def *d = &p->def;
  bool iterative = d->solver && row_of(d->solver)->iterative;
  if (iterative && d->preconditioner) return COROT_OK;
  node_graph g = {0};
  corot_status status = corot_graph_create(lower, &g);
  if (!status && !d->preconditioner)
    d->preconditioner = choose_preconditioner(d->costs, lower, &g, d->role);
  if (!status && !iterative) status = analyze(lower, &g, memory, p);
  corot_graph_clear(&g);
  return status;
}

corot_status corot_linsol_choose_within(const corot_memory_limit *memory,
                                        const corot_linear_def *def, const corot_csc *lower,
                                        linsol_plan *plan) {
  const corot_linear_costs usual = corot_linear_costs_usual();
  linsol_plan p = {.def = *def};
  COROT_TRY(look_up_all(&p.def));
  p.by_cost = !p.def.solver;
  if (!p.def.costs) p.def.costs = &usual;
  corot_status status = look_at_graph(lower, memory, &p);
  p.def.costs = NULL;
  if (!status) status = check_refinement(&p.def);
  if (!status) status = find(&p);
  if (status) {
    corot_linsol_plan_clear(&p);
    return status;
  }
  *plan = p;
  return COROT_OK;
}

corot_status corot_linsol_choose(const corot_linear_def *def, const corot_csc *lower,
                                 linsol_plan *plan) {
  const corot_memory_limit memory = corot_memory_limits();
  return corot_linsol_choose_within(&memory, def, lower, plan);
}

void corot_linsol_plan_clear(linsol_plan *plan) {
  free(plan->order);
  plan->order = NULL;
}
