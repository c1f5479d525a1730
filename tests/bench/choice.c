/* corot-bench solvers: every linear solver with every choice it has, and what auto makes of it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/run/run_clock.h"
#include "bench.h"
#include "report.h"
#include "solvers.h"

static const char help[] =
    "usage: corot-bench solvers [--json] [--most N] [--role ROLE]\n"
    "\n"
    "Analysis, factorisation and solution by every linear solver with every choice it has, in\n"
    "cubes and in bars six times as long as wide, of the same volume and of 300 to 100 000 "
    "degrees\n"
    "of freedom; the cost as it is modelled; and how far the choice of 'auto' is from the best.\n"
    "  dynamic  the matrix of an implicit step with g = 10 ms; cost of a step: a twentieth of a\n"
    "           factorisation and 1.1 solutions\n"
    "  static   the stiffness; cost: a factorisation and a solution. pcg solves to a residual of\n"
    "           1e-5, as Newton's iteration asks it to on average\n"
    "Else pcg solves to a relative residual of 1e-10. Times are the least of a few, of process CPU "
    "time;\n"
    "with OPENBLAS_NUM_THREADS=1 in the environment all is done on one core. What has no chance "
    "is\n"
    "left out, unless auto takes it: klu beyond 8000 unknowns, cholmod simplicial beyond 15000.\n"
    "\n"
    "      --json       one JSON object a line\n"
    "      --most N     only solids of up to N degrees of freedom [100000]; all takes some "
    "minutes\n"
    "      --role ROLE  dynamic or static [both]\n"
    "\n"
    "example: OPENBLAS_NUM_THREADS=1 corot-bench solvers --most 10000\n";

static const struct shape {
  const char *name;
  double size[3];  /* [m] */
  int cells[3];    /* times the fineness: */
  int fineness[8]; /* up to a zero */
} shapes[] = {
    {"cube", {0.1817, 0.1817, 0.1817}, {1, 1, 1}, {4, 6, 8, 12, 16, 20, 26, 31}},
    {"bar", {0.1, 0.1, 0.6}, {1, 1, 6}, {2, 3, 4, 6, 8, 12, 17, 0}},
};
enum { NSHAPE = 2, NSIZE = 8 };

static const char *const role_names[] = {"dynamic", "static"};

static const struct candidate {
  const char *solver, *ordering, *factor, *preconditioner;
  int most; /* unknowns */
} candidates[] = {
    {"klu", "amd", "auto", "auto", 8000},
    {"klu", "metis", "auto", "auto", 8000},
    {"cholmod", "amd", "simplicial", "auto", 15000},
    {"cholmod", "metis", "simplicial", "auto", 15000},
    {"cholmod", "amd", "supernodal", "auto", 1000000},
    {"cholmod", "metis", "supernodal", "auto", 1000000},
    {"pcg", "auto", "auto", "block-jacobi", 1000000},
    {"pcg", "auto", "auto", "incomplete-cholesky", 1000000},
    {"pcg", "auto", "auto", "amg", 1000000},
};
enum { NCANDIDATE = sizeof candidates / sizeof *candidates };

typedef struct options {
  bool json;
  int most;
  bool role[2];
} options;

typedef struct result {
  const char *name;                     /* NULL: not measured */
  double analysis, factor, solve, cost; /* [s] */
  double iterations;                    /* of a solution */
} result;

/* The largest ratio of the choice of auto to the best, so far. */
typedef struct worst {
  double ratio;
  const char *shape, *role;
  int n;
} worst;

/* The least of a few calls; their number. */
static corot_status least(piece_of_work *work, problem *p, double *seconds, int *ncall) {
  double spent = 0;
  *seconds = INFINITY;
  for (*ncall = 0; *ncall < 2 || (spent < 0.2 && *ncall < 50); ++*ncall) {
    if (*ncall > 0 && spent > 3) break;
    double start = cpu_clock();
    COROT_TRY(work(p));
    double time = cpu_clock() - start;
    *seconds = fmin(*seconds, time);
    spent += time;
  }
  return COROT_OK;
}

static corot_status measure(const specimen *s, const corot_linear_def *def, problem *p, result *r) {
  const double g = 0.01;
  bool dynamic = def->role == COROT_ROLE_DYNAMIC;
  double start = cpu_clock();
  COROT_TRY(dynamic ? problem_create(s, def, 1, g, g * g, p) : problem_create(s, def, 0, 0, 1, p));
  r->analysis = cpu_clock() - start;
  int ncall;
  COROT_TRY(problem_factor(p)); /* the first one allocates */
  COROT_TRY(least(problem_factor, p, &r->factor, &ncall));
  COROT_TRY(least(problem_solve, p, &r->solve, &ncall));
  if (p->s.ops->iterations) r->iterations = (double)p->s.ops->iterations(p->s.solver) / ncall;
  r->cost = dynamic ? r->factor / 20 + 1.1 * r->solve : r->factor + r->solve;
  r->name = p->s.name;
  return COROT_OK;
}

/* What auto takes: the name is the solver's own. */
static corot_status ask_auto(const specimen *s, corot_role role, const char **name) {
  corot_linear_def def = corot_linear_defaults();
  linsol made;
  def.role = role;
  corot_status status = corot_linsol_create(s->model, &def, &made);
  *name = made.name;
  corot_linsol_clear(&made);
  return status;
}

/* Whether a name in full has what the candidate asks for. */
static bool is(const char *name, const struct candidate *c) {
  const char *part[] = {c->solver, c->ordering, c->factor, c->preconditioner};
  for (int k = 0; k < 4; k++)
    if (strcmp(part[k], "auto") != 0 && !strstr(name, part[k])) return false;
  return true;
}

/* Nothing where it is not worth measuring, or not in this build. */
static corot_status try_candidate(const specimen *s, corot_role role, const struct candidate *c,
                                  const char *taken, result *r) {
  corot_linear_def def = {c->solver,
                          c->ordering,
                          c->factor,
                          c->preconditioner,
                          role == COROT_ROLE_STATIC ? 1e-5 : 1e-10,
                          role,
                          NULL,
                          NULL};
  problem p = {0};
  if (s->n > c->most && !is(taken, c)) return COROT_OK;
  corot_status status = measure(s, &def, &p, r);
  if (status == COROT_EINVAL && !p.s.ops) status = COROT_OK;
  problem_clear(&p);
  return status;
}

static void report(const options *o, const struct shape *shape, const specimen *s, corot_role role,
                   const result *r, const result *best, const char *taken) {
  bool chosen = strcmp(r->name, taken) == 0;
  double ratio = r->cost / best->cost;
  if (o->json) {
    report_object(json_pack("{s:s, s:s, s:s, s:i, s:s, s:f, s:f, s:f, s:f, s:f, s:f, s:b}", "bench",
                            "solver", "shape", shape->name, "role", role_names[role], "unknowns",
                            s->n, "solver", r->name, "analysis_s", r->analysis, "factor_s",
                            r->factor, "solve_s", r->solve, "iterations", r->iterations, "cost_s",
                            r->cost, "ratio", ratio, "auto", chosen));
    return;
  }
  char iterations[24] = "";
  if (r->iterations > 0) snprintf(iterations, sizeof iterations, "%.0f", r->iterations);
  printf("%-26s %10.3f %10.3f %10.3f %7s %10.3f %7.2f%s\n", r->name, 1e3 * r->analysis,
         1e3 * r->factor, 1e3 * r->solve, iterations, 1e3 * r->cost, ratio, chosen ? "  auto" : "");
  fflush(stdout);
}

static corot_status compare(const options *o, const struct shape *shape, const specimen *s,
                            corot_role role, worst *w) {
  result r[NCANDIDATE] = {0}, *best = NULL;
  const char *taken;
  COROT_TRY(ask_auto(s, role, &taken));
  for (int k = 0; k < NCANDIDATE; k++) {
    COROT_TRY(try_candidate(s, role, &candidates[k], taken, &r[k]));
    if (r[k].name && (!best || r[k].cost < best->cost)) best = &r[k];
  }
  if (!o->json) {
    printf("\n%s, %d degrees of freedom, %s; ms\n", shape->name, s->n, role_names[role]);
    printf("%-26s %10s %10s %10s %7s %10s %7s\n", "solver", "analysis", "factor", "solve", "its",
           "cost", "ratio");
  }
  for (int k = 0; k < NCANDIDATE; k++) {
    if (!r[k].name) continue;
    report(o, shape, s, role, &r[k], best, taken);
    double ratio = r[k].cost / best->cost;
    if (strcmp(r[k].name, taken) == 0 && ratio > w->ratio)
      *w = (worst){ratio, shape->name, role_names[role], s->n};
  }
  return COROT_OK;
}

static corot_status of_size(const options *o, const struct shape *shape, int fineness, worst *w) {
  corot_box box = {0};
  for (int c = 0; c < 3; c++) {
    box.size[c] = shape->size[c];
    box.cells[c] = fineness * shape->cells[c];
  }
  long n = 3L * (box.cells[0] + 1) * (box.cells[1] + 1) * box.cells[2];
  if (n > o->most) return COROT_OK;
  corot_mesh *mesh;
  specimen s = {0};
  COROT_TRY(corot_mesh_box(&box, &mesh));
  corot_status status = solid_create(mesh, "polar", true, &s);
  corot_mesh_destroy(mesh);
  if (status) return status;
  status = corot_jacobian(s.model, s.state, 0, s.u, s.v, COROT_TANGENT_HELD, s.K, s.D);
  for (int role = 0; role < 2 && !status; role++)
    if (o->role[role]) status = compare(o, shape, &s, role, w);
  solid_clear(&s);
  return status;
}

static int read_options(int argc, char **argv, options *o) {
  static const struct option known[] = {{"json", no_argument, NULL, 'j'},
                                        {"most", required_argument, NULL, 'm'},
                                        {"role", required_argument, NULL, 'r'},
                                        {"help", no_argument, NULL, 'h'},
                                        {0}};
  static const char program[] = "corot-bench solvers";
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", known, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    if (answer == 'j') {
      o->json = true;
    } else if (answer == 'm') {
      if (!parse_count(optarg, 10000000, &o->most))
        return usage_error(program, "--most: not a count: %s", optarg);
    } else if (answer == 'r') {
      for (int k = 0; k < 2; k++) o->role[k] = strcmp(optarg, role_names[k]) == 0;
      if (!o->role[0] && !o->role[1])
        return usage_error(program, "--role: neither dynamic nor static: %s", optarg);
    } else {
      return option_error(program, answer, argv, known);
    }
  }
  return optind < argc ? usage_error(program, "unexpected: %s", argv[optind]) : -1;
}

int command_solvers(int argc, char **argv) {
  options o = {.most = 100000, .role = {true, true}};
  worst w = {0};
  int code = read_options(argc, argv, &o);
  if (code >= 0) return code;
  report_machine(o.json);
  for (int k = 0; k < NSHAPE; k++)
    for (int i = 0; i < NSIZE && shapes[k].fineness[i]; i++) {
      corot_status status = of_size(&o, &shapes[k], shapes[k].fineness[i], &w);
      if (status) return failure(status);
    }
  if (!o.json && w.ratio > 0)
    printf("\nauto: at most %.2f times the best (%s, %d degrees of freedom, %s)\n", w.ratio,
           w.shape, w.n, w.role);
  return EXIT_OK;
}
