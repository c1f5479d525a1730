/* corot-bench hierarchy: what the levels of a refined mesh are good for. */
#include <corot/hierarchy.h>
#include <stdlib.h>

#include "bench.h"
#include "machine.h"
#include "report.h"
#include "solvers.h"

static const char help[] =
    "usage: corot-bench hierarchy [--json] [--levels N]\n"
    "\n"
    "Conjugate gradients on refined bodies, by every preconditioner, and sparse Cholesky beside\n"
    "them: a bar of 2 x 2 x 6 cells six times as long as wide, and a cube of 2 x 2 x 2 cells of\n"
    "the same volume, each refined up to N times. Set-up and solution to a relative residual of\n"
    "1e-10, the least of a few, in CPU time; OPENBLAS_NUM_THREADS=1 keeps all of it on one core.\n"
    "  dynamic  the matrix of an implicit step with g = 10 ms\n"
    "  static   the stiffness\n"
    "\n"
    "Then the transformations of the hierarchical basis, by what they move at least, each array\n"
    "once, beside a triad on as much data.\n"
    "\n"
    "      --levels N  1 to 6 [3]; with 5 it takes minutes\n"
    "      --json      one JSON object a line\n"
    "\n"
    "example: OPENBLAS_NUM_THREADS=1 corot-bench hierarchy --levels 2\n";

static const struct shape {
  const char *name;
  corot_box box;
} shapes[] = {
    {"bar", {.size = {0.1, 0.1, 0.6}, .cells = {2, 2, 6}}},
    {"cube", {.size = {0.1817, 0.1817, 0.1817}, .cells = {2, 2, 2}}},
};
enum { NSHAPE = 2 };

static const struct candidate {
  const char *solver, *preconditioner;
} candidates[] = {
    {"pcg", "block-jacobi"}, {"pcg", "incomplete-cholesky"},
    {"pcg", "hierarchical"}, {"pcg", "multigrid"},
    {"cholmod", "auto"},
};
enum { NCANDIDATE = sizeof candidates / sizeof *candidates };

/* A refined body with its matrices. */
typedef struct refined {
  const char *name;
  corot_refinement *levels;
  specimen s;
} refined;

static void refined_clear(refined *r) {
  corot_refinement_destroy(r->levels);
  solid_clear(&r->s);
}

static corot_status refine(const struct shape *shape, int nlevel, corot_mesh **mesh,
                           corot_refinement **levels) {
  corot_mesh *coarse;
  COROT_TRY(corot_mesh_box(&shape->box, &coarse));
  corot_status status = corot_mesh_refine(coarse, nlevel, COROT_DIAGONAL_CONSISTENT, mesh, levels);
  corot_mesh_destroy(coarse);
  return status;
}

static corot_status refined_create(const struct shape *shape, int nlevel, refined *r) {
  corot_mesh *mesh;
  *r = (refined){.name = shape->name};
  COROT_TRY(refine(shape, nlevel, &mesh, &r->levels));
  specimen *s = &r->s;
  corot_status status = solid_create(mesh, "polar", true, s);
  corot_mesh_destroy(mesh);
  if (!status)
    status = corot_jacobian(s->model, s->state, 0, s->u, s->v, COROT_TANGENT_HELD, s->K, s->D);
  if (status) refined_clear(r);
  return status;
}

/* --- Solvers --- */

static const char *const role_names[] = {"dynamic", "static"};

static void print(bool json, const refined *r, corot_role role, const problem *p, double factor,
                  double solve, long iterations) {
  if (json) {
    report_object(json_pack("{s:s, s:s, s:i, s:i, s:s, s:s, s:f, s:f, s:i}", "bench", "hierarchy",
                            "shape", r->name, "levels", r->levels->nlevel, "unknowns", r->s.n,
                            "role", role_names[role], "solver", p->s.name, "factor_s", factor,
                            "solve_s", solve, "iterations", (int)iterations));
    return;
  }
  printf("%-26s %7ld %10.3f %10.3f\n", p->s.name, iterations, 1e3 * factor, 1e3 * solve);
  fflush(stdout);
}

static corot_status measure(bool json, const refined *r, corot_role role, const struct candidate *c,
                            problem *p) {
  const double g = 0.01;
  bool dynamic = role == COROT_ROLE_DYNAMIC;
  corot_linear_def def = corot_linear_defaults();
  def.solver = c->solver, def.preconditioner = c->preconditioner;
  def.role = role, def.refinement = r->levels;
  COROT_TRY(dynamic ? problem_create(&r->s, &def, 1, g, g * g, p)
                    : problem_create(&r->s, &def, 0, 0, 1, p));
  const linsol *s = &p->s;
  timing factor, solve;
  COROT_TRY(timing_of(problem_factor, p, &factor));
  COROT_TRY(timing_of(problem_solve, p, &solve));
  long before = s->ops->iterations ? s->ops->iterations(s->solver) : 0;
  COROT_TRY(problem_solve(p));
  long after = s->ops->iterations ? s->ops->iterations(s->solver) : 0;
  print(json, r, role, p, factor.min, solve.min, after - before);
  return COROT_OK;
}

static corot_status compare_solvers(bool json, const refined *r, corot_role role) {
  if (!json)
    printf("\n%s refined %d times, %d degrees of freedom, %s; ms\n%-26s %7s %10s %10s\n", r->name,
           r->levels->nlevel, r->s.n, role_names[role], "solver", "its", "set-up", "solve");
  for (int k = 0; k < NCANDIDATE; k++) {
    problem p = {0};
    corot_status status = measure(json, r, role, &candidates[k], &p);
    if (status == COROT_EINVAL && !p.s.ops) status = COROT_OK; /* not in this build */
    problem_clear(&p);
    COROT_TRY(status);
  }
  return COROT_OK;
}

static corot_status compare_all(bool json, int most) {
  for (int k = 0; k < NSHAPE; k++)
    for (int nlevel = 1; nlevel <= most; nlevel++) {
      refined r;
      COROT_TRY(refined_create(&shapes[k], nlevel, &r));
      corot_status status = compare_solvers(json, &r, COROT_ROLE_DYNAMIC);
      if (!status) status = compare_solvers(json, &r, COROT_ROLE_STATIC);
      refined_clear(&r);
      COROT_TRY(status);
    }
  return COROT_OK;
}

/* --- Transformations --- */

typedef struct transformation {
  const char *name;
  void (*of)(const corot_refinement *levels, double (*v)[3]);
  const corot_refinement *levels;
  double (*v)[3];
} transformation;

static corot_status transform(void *data) {
  transformation *t = data;
  t->of(t->levels, t->v);
  return COROT_OK;
}

/* Values come in and go out, and parents come in. */
static double least_bytes(const corot_refinement *r) {
  double n = r->nnode[r->nlevel];
  return n * 2 * 3 * sizeof(double) + (n - r->nnode[0]) * sizeof *r->parent;
}

static corot_status time_transformations(bool json, const corot_refinement *r, double (*v)[3]) {
  static const transformation all[] = {{.name = "T", .of = corot_hierarchy_apply},
                                       {.name = "T^-1", .of = corot_hierarchy_solve},
                                       {.name = "T'", .of = corot_hierarchy_apply_transposed},
                                       {.name = "T'^-1", .of = corot_hierarchy_solve_transposed}};
  int n = r->nnode[r->nlevel];
  double bytes = least_bytes(r);
  if (!json)
    printf("\n%d nodes, %.1f MB\n%-6s %10s %10s %10s %7s\n", n, 1e-6 * bytes, "", "ms", "GB/s",
           "machine", "ratio");
  for (int k = 0; k < 4; k++) {
    transformation t = all[k];
    t.levels = r, t.v = v;
    timing time;
    COROT_TRY(timing_of(transform, &t, &time)); /* of zeros: nothing grows */
    double rate = bytes / time.min, best = machine_bandwidth((size_t)bytes);
    if (json)
      report_object(json_pack("{s:s, s:s, s:i, s:f, s:f, s:f}", "bench", "transformation", "of",
                              t.name, "nodes", n, "seconds", time.min, "bytes_per_s", rate,
                              "best_bytes_per_s", best));
    else
      printf("%-6s %10.3f %10.2f %10.2f %7.2f\n", t.name, 1e3 * time.min, 1e-9 * rate, 1e-9 * best,
             best / rate);
  }
  return COROT_OK;
}

static corot_status transformations(bool json, int nlevel) {
  corot_mesh *mesh;
  corot_refinement *levels;
  COROT_TRY(refine(&shapes[0], nlevel, &mesh, &levels));
  double(*v)[3] = calloc(mesh->nnode, sizeof *v);
  corot_status status = v ? time_transformations(json, levels, v)
                          : corot_fail(COROT_ENOMEM, "no memory for %d nodes", mesh->nnode);
  free(v);
  corot_refinement_destroy(levels);
  corot_mesh_destroy(mesh);
  return status;
}

static int read_options(int argc, char **argv, bool *json, int *most) {
  static const struct option known[] = {{"json", no_argument, NULL, 'j'},
                                        {"levels", required_argument, NULL, 'l'},
                                        {"help", no_argument, NULL, 'h'},
                                        {0}};
  static const char program[] = "corot-bench hierarchy";
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", known, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    if (answer == 'j') {
      *json = true;
    } else if (answer == 'l') {
      if (!parse_count(optarg, 6, most))
        return usage_error(program, "--levels %s: expected 1 to 6", optarg);
    } else {
      return option_error(program, answer, argv, known);
    }
  }
  return optind < argc ? usage_error(program, "unexpected: %s", argv[optind]) : -1;
}

int command_hierarchy(int argc, char **argv) {
  bool json = false;
  int most = 3, code = read_options(argc, argv, &json, &most);
  if (code >= 0) return code;
  report_machine(json);
  corot_status status = compare_all(json, most);
  for (int nlevel = most; nlevel <= most + 2 && !status; nlevel++)
    status = transformations(json, nlevel);
  return status ? failure(status) : EXIT_OK;
}
