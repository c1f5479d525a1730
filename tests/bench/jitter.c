/* corot-bench jitter: how even the steps of an animation are. */
#include <corot/integrate.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/run/run_clock.h"
#include "bench.h"
#include "report.h"

static const char help[] =
    "usage: corot-bench jitter [--json] [--cells I,J,K] [--levels N] [--end T] [--repeat N]\n"
    "\n"
    "Wall time of each step of a bar (see corot-bench run --help) in steps of 30 ms by backward\n"
    "Euler, as in an animation that must not stall: that of Hauth & Strasser (2004, section 7.4)\n"
    "did where an update of the frames came with a factorisation. Frames are held, or\n"
    "extrapolated, for 0.3 s; iterations end at 1e-6. The same steps are done several times and\n"
    "the least time of each counts, so that what else the machine does is left out.\n"
    "  median  of all steps\n"
    "  factor  the largest of those with a factorisation, or the set-up of a preconditioner\n"
    "  else    the largest of the others\n"
    "  ratio   the largest of all to the median\n"
    "  its     iterations of conjugate gradients\n"
    "\n"
    "      --cells I,J,K  of the box 0.1 x 0.1 x 0.6 m (default: 1,1,12)\n"
    "      --levels N     refined so many times, 0 to 4 (default: 2: 4608 tets)\n"
    "      --end T        whole seconds to simulate (default: 10)\n"
    "      --repeat N     times (default: 3)\n"
    "      --json         one JSON object a line\n"
    "\n"
    "example: OPENBLAS_NUM_THREADS=1 corot-bench jitter --levels 1\n";

static const char program[] = "corot-bench jitter";

static const double step_length = 0.03; /* [s] */
enum { MOST_RUNS = 100 };

typedef struct options {
  bool json;
  bar_source bar;
  int nlevel, end, nrun;
} options;

static const struct way {
  const char *name, *solver, *preconditioner;
  corot_frames frames;
  corot_solution solution;
} ways[] = {
    {"linear, held", "klu", "auto", COROT_FRAMES_HELD, COROT_SOLUTION_LINEAR},
    {"linear, held", "cholmod", "auto", COROT_FRAMES_HELD, COROT_SOLUTION_LINEAR},
    {"linear, held", "pcg", "block-jacobi", COROT_FRAMES_HELD, COROT_SOLUTION_LINEAR},
    {"linear, held", "pcg", "incomplete-cholesky", COROT_FRAMES_HELD, COROT_SOLUTION_LINEAR},
    {"linear, held", "pcg", "hierarchical", COROT_FRAMES_HELD, COROT_SOLUTION_LINEAR},
    {"linear, held", "pcg", "multigrid", COROT_FRAMES_HELD, COROT_SOLUTION_LINEAR},
    {"newton, held", "cholmod", "auto", COROT_FRAMES_HELD, COROT_SOLUTION_NEWTON},
    {"newton, extrapolated", "cholmod", "auto", COROT_FRAMES_EXTRAPOLATED, COROT_SOLUTION_NEWTON},
    {"newton, exact", "cholmod", "auto", COROT_FRAMES_EXACT, COROT_SOLUTION_NEWTON},
    {"newton, exact", "pcg", "multigrid", COROT_FRAMES_EXACT, COROT_SOLUTION_NEWTON},
};
enum { NWAY = sizeof ways / sizeof *ways };

typedef struct body {
  corot_model *model;
  corot_refinement *levels;
  corot_state *state;
  double *zero; /* [n] */
} body;

static void body_clear(body *b) {
  free(b->zero);
  corot_state_destroy(b->state);
  corot_model_destroy(b->model);
  corot_refinement_destroy(b->levels);
}

/* What is known of the steps. */
typedef struct film {
  int nstep;
  double *seconds; /* [nstep] least so far */
  bool *factored;  /* [nstep] with a factorisation */
  char solver[64];
  corot_statistics counts;
} film;

static corot_status shoot(corot_integrator *integrator, corot_frame_clock *clock, film *f) {
  for (int k = 0; k < f->nstep; k++) {
    corot_step step;
    corot_frame_event event;
    long before = corot_integrator_statistics(integrator).nfactor;
    double start = wall_clock();
    COROT_TRY(corot_integrator_step(integrator, (k + 1) * step_length, &step));
    COROT_TRY(corot_frame_clock_tick(clock, step.t, &event));
    f->seconds[k] = fmin(f->seconds[k], wall_clock() - start);
    f->factored[k] = corot_integrator_statistics(integrator).nfactor > before;
  }
  snprintf(f->solver, sizeof f->solver, "%s", corot_integrator_chosen(integrator).linear_solver);
  f->counts = corot_integrator_statistics(integrator);
  return COROT_OK;
}

static corot_status run(const body *b, const struct way *way, film *f) {
  corot_integrator_def def = corot_integrator_defaults();
  corot_frame_policy policy = corot_frame_policy_defaults();
  def.method = "backward-euler", def.step = step_length, def.solution = way->solution;
  def.linear.solver = way->solver, def.linear.preconditioner = way->preconditioner;
  def.linear.tolerance = 1e-6, def.linear.refinement = b->levels;
  def.newton_tolerance = 1e-6;
  policy.frames = way->frames;
  policy.interval = way->frames == COROT_FRAMES_EXACT ? 0 : 0.3;
  corot_integrator *integrator = NULL;
  corot_frame_clock *clock = NULL;
  corot_status status =
      corot_integrator_create(&def, b->model, b->state, 0, b->zero, b->zero, &integrator);
  if (!status)
    status = corot_frame_clock_create(&policy, b->model, b->state, integrator, 0, b->zero, b->zero,
                                      &clock);
  if (!status) status = shoot(integrator, clock, f);
  corot_frame_clock_destroy(clock);
  corot_integrator_destroy(integrator);
  return status;
}

/* Sorts the times. */
static void report(const options *o, const struct way *way, film *f) {
  double largest[2] = {0}; /* without and with a factorisation */
  for (int k = 0; k < f->nstep; k++)
    largest[f->factored[k]] = fmax(largest[f->factored[k]], f->seconds[k]);
  double median = timing_summary(f->nstep, f->seconds).median;
  double ratio = fmax(largest[0], largest[1]) / median;
  if (o->json) {
    report_object(json_pack("{s:s, s:s, s:s, s:f, s:f, s:f, s:f, s:i, s:i, s:i}", "bench", "jitter",
                            "way", way->name, "solver", f->solver, "median_s", median,
                            "largest_with_factor_s", largest[1], "largest_else_s", largest[0],
                            "ratio", ratio, "factorisations", (int)f->counts.nfactor, "newton",
                            (int)f->counts.nni, "iterations", (int)f->counts.nli));
    return;
  }
  printf("%-21s %-25s %7.2f %7.2f %7.2f %7.1f %7ld %8ld\n", way->name, f->solver, 1e3 * median,
         1e3 * largest[1], 1e3 * largest[0], ratio, f->counts.nfactor, f->counts.nli);
  fflush(stdout);
}

static corot_status measure(const options *o, const body *b, const struct way *way) {
  film f = {.nstep = (int)(o->end / step_length)};
  f.seconds = malloc(f.nstep * sizeof *f.seconds);
  f.factored = malloc(f.nstep * sizeof *f.factored);
  corot_status status = COROT_OK;
  if (!f.seconds || !f.factored)
    status = corot_fail(COROT_ENOMEM, "no memory for %d steps", f.nstep);
  for (int k = 0; k < f.nstep && !status; k++) f.seconds[k] = INFINITY;
  for (int k = 0; k < o->nrun && !status; k++) status = run(b, way, &f);
  if (!status) report(o, way, &f);
  free(f.seconds);
  free(f.factored);
  return status;
}

static corot_status measure_all(const options *o) {
  body b = {0};
  COROT_TRY(bar_model_refined(&o->bar, o->nlevel, &b.model, &b.levels));
  int n = corot_model_ndof(b.model);
  corot_status status = corot_state_create(b.model, &b.state);
  b.zero = calloc(n, sizeof *b.zero);
  if (!status && !b.zero) status = corot_fail(COROT_ENOMEM, "no memory for %d unknowns", n);
  if (!status && !o->json)
    printf(
        "\n%d tets, %d degrees of freedom; ms of wall time a step\n%-21s %-25s %7s %7s %7s %7s "
        "%7s %8s\n",
        corot_model_mesh(b.model)->ntet, n, "way", "solver", "median", "factor", "else", "ratio",
        "factors", "its");
  for (int k = 0; k < NWAY && !status; k++) {
    status = measure(o, &b, &ways[k]);
    if (status == COROT_EINVAL && strcmp(ways[k].solver, "cholmod") == 0)
      status = COROT_OK; /* not in this build */
  }
  body_clear(&b);
  return status;
}

static int take_option(int answer, options *o) {
  int code = take_bar_option(program, answer, &o->bar);
  if (code >= 0) return code;
  if (answer == 'r') return take_repeat(program, MOST_RUNS, &o->nrun);
  if (answer == 'e') {
    if (parse_count(optarg, 1000, &o->end)) return EXIT_OK;
    return usage_error(program, "--end %s: expected whole seconds, 1 to 1000", optarg);
  }
  if (strcmp(optarg, "0") == 0) {
    o->nlevel = 0;
    return EXIT_OK;
  }
  if (parse_count(optarg, 4, &o->nlevel)) return EXIT_OK;
  return usage_error(program, "--levels %s: expected 0 to 4", optarg);
}

static int read_options(int argc, char **argv, options *o) {
  static const struct option known[] = {{"json", no_argument, NULL, 'j'},
                                        {"cells", required_argument, NULL, 'c'},
                                        {"levels", required_argument, NULL, 'l'},
                                        {"end", required_argument, NULL, 'e'},
                                        {"repeat", required_argument, NULL, 'r'},
                                        {"help", no_argument, NULL, 'h'},
                                        {0}};
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", known, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    if (answer == '?' || answer == ':') return option_error(program, answer, argv, known);
    if (answer == 'j') {
      o->json = true;
      continue;
    }
    int code = take_option(answer, o);
    if (code != EXIT_OK) return code;
  }
  return optind < argc ? usage_error(program, "unexpected: %s", argv[optind]) : -1;
}

int command_jitter(int argc, char **argv) {
  options o = {.bar = bar_source_default("polar"), .nlevel = 2, .end = 10, .nrun = 3};
  o.bar.box.cells[0] = o.bar.box.cells[1] = 1;
  int code = read_options(argc, argv, &o);
  if (code >= 0) return code;
  report_machine(o.json);
  corot_status status = measure_all(&o);
  return status ? failure(status) : EXIT_OK;
}
