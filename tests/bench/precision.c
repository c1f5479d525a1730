/* corot-bench precision: error against CPU time, for every integrator. */
#include <corot/integrate.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/run/run_clock.h"
#include "bench.h"
#include "motion.h"
#include "report.h"

static const char help[] =
    "usage: corot-bench precision [--json] [--mesh FILE | --cells I,J,K] [--strain NAME]\n"
    "                             [--only METHOD] [--limit S] [--repeat N]\n"
    "\n"
    "40 s of the bar (see corot-bench run --help) by every integrator, at tolerances from 1e-2 on\n"
    "by factors of sqrt(10), and at constant steps h from 40 ms on by factors of 2, with Newton's\n"
    "iteration to 1e-4 h^2 lengths of the bar. The error is the largest deviation of ux in the\n"
    "corner, read every 0.1 s, from a reference: Runge-Kutta of order 8 at a tolerance of 1e-12, "
    "by\n"
    "which cvode is checked at 1e-10. It is that of time alone: the reference moves on the same "
    "mesh,\n"
    "whose four-node tets leave out half of the deflection (see corot-bench total). Creation of "
    "the\n"
    "integrator and reading its interpolant are part of the time, that of mesh and model is not.\n"
    "At the end: the fastest at each accuracy, and how the error of each method follows its\n"
    "tolerance, error = C rtol^p [m], or its step, error = C h^p.\n"
    "\n"
    "      --json          one JSON object a line\n"
    "      --mesh FILE     a mesh in place of the box\n"
    "      --cells I,J,K   cells of the box 0.1 x 0.1 x 0.6 m (default: 2,2,12, 288 tets)\n"
    "      --strain NAME   cauchy, warp, polar, hybrid or green (default: green)\n"
    "      --only METHOD   rows whose name begins so, e.g. 'arkode' or 'cvode 2'\n"
    "      --limit S       no finer once a run takes longer, in s of CPU time (default: 2)\n"
    "      --repeat N      runs, of which the fastest counts (default: 3)\n"
    "\n"
    "example: corot-bench precision --mesh models/bar/bar.msh\n";

static const char program[] = "corot-bench precision";

enum { MOST_ROWS = 1024, MOST_RUNS = 100 };

typedef struct arguments {
  bool json;
  bar_source bar;
  const char *only;
  double limit;
  int nrun;
} arguments;

typedef struct variant {
  const char *name;
  corot_integrator_def def;
  bool newton; /* of constant step, not linear */
} variant;

/* A bar, and how it moves. */
typedef struct job {
  motion bar;
  double reference[NOUTPUT];
} job;

typedef struct result {
  const variant *variant;
  double fineness; /* tolerance, or step [s] */
  double error;    /* [m] */
  double cpu;      /* [s] */
  corot_statistics counts;
} result;

static corot_integrator_def with_order(const char *method, int max_order, int order) {
  corot_integrator_def def = corot_integrator_defaults();
  def.method = method, def.max_order = max_order, def.order = order;
  return def;
}

/* Every integrator; returns how many. */
static int list_variants(variant out[]) {
  static const struct {
    const char *name, *method;
    int max_order, order;
  } controlled[] = {
      {"cvode auto", "cvode", 0, 0}, {"cvode 2", "cvode", 2, 0},   {"cvode 3", "cvode", 3, 0},
      {"cvode 5", "cvode", 5, 0},    {"ida auto", "ida", 0, 0},    {"ida 2", "ida", 2, 0},
      {"ida 5", "ida", 5, 0},        {"arkode 2", "arkode", 0, 2}, {"arkode 3", "arkode", 0, 3},
      {"arkode 4", "arkode", 0, 4},  {"arkode 5", "arkode", 0, 5}, {"erk 2", "erk", 0, 2},
      {"erk 3", "erk", 0, 3},        {"erk 4", "erk", 0, 4},       {"erk 5", "erk", 0, 5},
      {"erk 6", "erk", 0, 6},        {"erk 8", "erk", 0, 8}};
  static const char *const constant[] = {
      "backward-euler", "bdf2", "bdf3", "midpoint", "newmark", "hht", "generalized-alpha"};
  int n = 0;
  for (size_t k = 0; k < sizeof controlled / sizeof *controlled; k++)
    out[n++] = (variant){
        controlled[k].name,
        with_order(controlled[k].method, controlled[k].max_order, controlled[k].order), false};
  for (size_t k = 0; k < sizeof constant / sizeof *constant; k++)
    out[n++] = (variant){constant[k], with_order(constant[k], 0, 0), true};
  return n;
}

static double deviation(const double *a, const double *b) {
  double largest = 0;
  for (int k = 0; k < NOUTPUT; k++) largest = fmax(largest, fabs(a[k] - b[k]));
  return largest;
}

/* The fastest of `nrun` runs; one that fails has an infinite error. */
static corot_status measure(const arguments *a, job *j, result *r) {
  corot_integrator_def def = r->variant->def;
  bool controlled = corot_integrator_controls_error(def.method);
  *(controlled ? &def.rtol : &def.step) = r->fineness;
  if (!controlled) def.newton_tolerance = 1e-4 * r->fineness * r->fineness;
  double ux[NOUTPUT];
  r->cpu = INFINITY;
  for (int k = 0; k < a->nrun && (k == 0 || r->cpu < a->limit); k++) {
    double start = cpu_clock();
    corot_status status = motion_run(&j->bar, &def, ux, &r->counts);
    r->cpu = fmin(r->cpu, cpu_clock() - start);
    if (status == COROT_EINVAL || status == COROT_ENOMEM) return status;
    r->error = status ? INFINITY : deviation(ux, j->reference);
    if (status) break;
  }
  return COROT_OK;
}

/* Least squares of log error over log fineness, where the error is above twice the floor and falls:
   error = C fineness^p. Returns the number of points. */
static int fit(const result *r, int n, double floor, double *C, double *p) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  int m = 0;
  for (int k = 0; k < n; k++) {
    if (!(r[k].error > 2 * floor && r[k].error < 0.02)) continue;
    double x = log(r[k].fineness), y = log(r[k].error);
    sx += x, sy += y, sxx += x * x, sxy += x * y, m++;
  }
  *p = (m * sxy - sx * sy) / (m * sxx - sx * sx);
  *C = exp((sy - *p * sx) / m);
  return m;
}

static void print_result(bool json, const result *r) {
  const corot_statistics *c = &r->counts;
  bool controlled = corot_integrator_controls_error(r->variant->def.method);
  if (json) {
    report_object(json_pack(
        "{s:s, s:s, s:s, s:f, s:f, s:f, s:I, s:I, s:I, s:I, s:I, s:I}", "bench", "precision",
        "method", r->variant->name, "by", controlled ? "rtol" : "step", "value", r->fineness,
        "error_m", isfinite(r->error) ? r->error : -1.0, "cpu_s", r->cpu, "nst", (json_int_t)c->nst,
        "nfe", (json_int_t)c->nfe, "nni", (json_int_t)c->nni, "nfactor", (json_int_t)c->nfactor,
        "netf", (json_int_t)c->netf, "ncfn", (json_int_t)c->ncfn));
    return;
  }
  printf("%-18s %s %7.1e  %8.2e m %8.3f s %8ld %8ld %8ld %6ld %5ld %5ld\n", r->variant->name,
         controlled ? "rtol" : "step", r->fineness, r->error, r->cpu, c->nst, c->nfe, c->nni,
         c->nfactor, c->netf, c->ncfn);
  fflush(stdout);
}

static void print_fit(bool json, const result *r, int n, double floor) {
  double C, p;
  if (fit(r, n, floor, &C, &p) < 3) return;
  const char *by = corot_integrator_controls_error(r->variant->def.method) ? "rtol" : "step";
  if (json)
    report_object(json_pack("{s:s, s:s, s:s, s:f, s:f}", "bench", "precision fit", "method",
                            r->variant->name, "by", by, "C", C, "p", p));
  else
    printf("%-18s error = %.3g %s^%.2f\n", r->variant->name, C, by, p);
}

/* One method, finer and finer. */
static corot_status measure_variant(const arguments *a, job *j, const variant *v, double floor,
                                    result *rows, int *nrow) {
  bool controlled = corot_integrator_controls_error(v->def.method);
  double fineness = controlled ? 1e-2 : 0.04, best = INFINITY;
  int worse = 0; /* rows since the best */
  for (int k = 0; k < 19; k++) {
    result *r = &rows[*nrow];
    *r = (result){.variant = v, .fineness = fineness};
    COROT_TRY(measure(a, j, r));
    print_result(a->json, r);
    ++*nrow;
    if (r->error < 0.7 * best) best = r->error, worse = 0;
    if (r->cpu > a->limit || r->error < floor || ++worse == 4) break;
    fineness /= controlled ? sqrt(10) : 2;
  }
  return COROT_OK;
}

static void print_fastest(bool json, const result *rows, int nrow) {
  static const double wanted[] = {1e-2, 3e-3, 1e-3, 5e-4, 2e-4, 7e-5, 1e-5, 1.3e-6, 1e-7, 1e-8};
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) {
    const result *best = NULL;
    for (int i = 0; i < nrow; i++)
      if (rows[i].error <= wanted[k] && (!best || rows[i].cpu < best->cpu)) best = &rows[i];
    if (!best) continue;
    const char *by = corot_integrator_controls_error(best->variant->def.method) ? "rtol" : "step";
    if (json)
      report_object(json_pack("{s:s, s:f, s:s, s:s, s:f, s:f, s:f}", "bench", "precision fastest",
                              "wanted_m", wanted[k], "method", best->variant->name, "by", by,
                              "value", best->fineness, "error_m", best->error, "cpu_s", best->cpu));
    else
      printf("%7.1e m: %-18s %s %7.1e  %8.2e m %8.3f s\n", wanted[k], best->variant->name, by,
             best->fineness, best->error, best->cpu);
  }
}

/* The reference, and how far another method stays from it. */
static corot_status make_reference(job *j, double *floor) {
  corot_integrator_def erk = with_order("erk", 0, 8), bdf = with_order("cvode", 5, 0);
  corot_statistics counts;
  double other[NOUTPUT];
  erk.rtol = 1e-12, bdf.rtol = 1e-10;
  COROT_TRY(motion_run(&j->bar, &erk, j->reference, &counts));
  COROT_TRY(motion_run(&j->bar, &bdf, other, &counts));
  *floor = deviation(j->reference, other);
  return COROT_OK;
}

static corot_status measure_all(const arguments *a, job *j, result *rows) {
  variant variants[32];
  int nvariant = list_variants(variants), nrow = 0, first[33] = {0}, nshown = 0;
  double floor;
  COROT_TRY(make_reference(j, &floor));
  if (a->json)
    report_object(json_pack("{s:s, s:i, s:i, s:s, s:f}", "bench", "precision reference", "tets",
                            corot_model_mesh(j->bar.model)->ntet, "unknowns",
                            corot_model_ndof(j->bar.model), "strain", a->bar.strain, "floor_m",
                            floor));
  else
    printf(
        "%d tets, %d degrees of freedom, strain %s; the references are %.1e m apart\n"
        "%-18s %12s  %10s %10s %8s %8s %8s %6s %5s %5s\n",
        corot_model_mesh(j->bar.model)->ntet, corot_model_ndof(j->bar.model), a->bar.strain, floor,
        "method", "", "error", "CPU", "nst", "nfe", "nni", "nfact", "netf", "ncfn");
  for (int k = 0; k < nvariant; k++) {
    if (a->only && strncmp(variants[k].name, a->only, strlen(a->only)) != 0) continue;
    first[nshown++] = nrow;
    COROT_TRY(measure_variant(a, j, &variants[k], floor, rows, &nrow));
  }
  first[nshown] = nrow;
  if (!a->json) printf("\nfastest within\n");
  print_fastest(a->json, rows, nrow);
  if (!a->json) printf("\n");
  for (int k = 0; k < nshown; k++)
    print_fit(a->json, &rows[first[k]], first[k + 1] - first[k], floor);
  return COROT_OK;
}

static corot_status run(const arguments *a) {
  job j = {0};
  result *rows = calloc(MOST_ROWS, sizeof *rows);
  corot_model *model;
  corot_status status =
      rows ? bar_model(&a->bar, &model) : corot_fail(COROT_ENOMEM, "out of memory");
  if (!status) status = motion_create(model, &j.bar);
  if (!status) status = measure_all(a, &j, rows);
  motion_destroy(&j.bar);
  free(rows);
  return status;
}

static const struct option known[] = {{"json", no_argument, NULL, 'j'},
                                      {"mesh", required_argument, NULL, 'm'},
                                      {"cells", required_argument, NULL, 'c'},
                                      {"strain", required_argument, NULL, 's'},
                                      {"only", required_argument, NULL, 'o'},
                                      {"limit", required_argument, NULL, 'l'},
                                      {"repeat", required_argument, NULL, 'n'},
                                      {"help", no_argument, NULL, 'h'},
                                      {0}};

static int take(arguments *a, int answer, char **argv) {
  int taken = take_bar_option(program, answer, &a->bar);
  if (taken >= 0) return taken;
  char *end;
  switch (answer) {
    case 'j':
      a->json = true;
      return EXIT_OK;
    case 'o':
      a->only = optarg;
      return EXIT_OK;
    case 'l':
      a->limit = strtod(optarg, &end);
      if (end != optarg && !*end && a->limit > 0) return EXIT_OK;
      return usage_error(program, "--limit %s: expected a number > 0", optarg);
    case 'n':
      return take_repeat(program, MOST_RUNS, &a->nrun);
    default:
      return option_error(program, answer, argv, known);
  }
}

int command_precision(int argc, char **argv) {
  arguments a = {.bar = bar_source_default("green"), .limit = 2, .nrun = 3};
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", known, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    int code = take(&a, answer, argv);
    if (code != EXIT_OK) return code;
  }
  if (optind < argc) return usage_error(program, "unexpected: %s", argv[optind]);
  corot_status status = run(&a);
  return status ? failure(status) : EXIT_OK;
}
