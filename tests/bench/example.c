/* corot-bench run: a whole simulation, the second example of Hauth & Strasser (2004). */
#include <corot/integrate.h>
#include <stdlib.h>
#include <string.h>

#include "app/run/run_clock.h"
#include "bench.h"
#include "cost.h"
#include "report.h"

static const char help[] =
    "usage: corot-bench run [--json] [--mesh FILE | --cells I,J,K] [--strain NAME] [--rtol X]\n"
    "                       [--linear-solver NAME] [--repeat N]\n"
    "\n"
    "CPU time of 40 s of a bar under a shear load, the second example of Hauth & Strasser (2004):\n"
    "lambda = 1e5 Pa, mu = 1e4 Pa, damping 10 and 1 Pa s, density 1000 kg/m^3; held at its lowest\n"
    "face, 200 Pa along x on its highest, reached in 10 s; frames exact. Creation of the "
    "integrator\n"
    "is part of the time, that of mesh and model is not.\n"
    "\n"
    "      --json                 one JSON object\n"
    "      --mesh FILE            a mesh in place of the box\n"
    "      --cells I,J,K          cells of the box 0.1 x 0.1 x 0.6 m (default: 2,2,12, 288 tets)\n"
    "      --strain NAME          cauchy, warp, polar, hybrid or green (default: polar)\n"
    "      --rtol X               relative tolerance (default: 1e-4)\n"
    "      --linear-solver NAME   auto, klu or cholmod (default: auto)\n"
    "      --repeat N             runs, of which the median counts (default: 5)\n"
    "\n"
    "example: corot-bench run --strain hybrid --rtol 1e-5\n";

static const char program[] = "corot-bench run";

enum { MOST_RUNS = 1000 };

typedef struct arguments {
  bool json;
  bar_source bar;
  corot_integrator_def integrator;
  int nrun;
} arguments;

typedef struct outcome {
  double cpu, wall; /* [s] */
  corot_statistics counts;
  corot_integrator_choice choice;
} outcome;

static corot_status integrate(const arguments *a, const corot_model *model, corot_state *state,
                              const double *zero, outcome *out) {
  static const double stop[] = {10, 40}; /* the load's kink, the end */
  double start = cpu_clock(), started = wall_clock();
  corot_integrator *integrator;
  COROT_TRY(corot_integrator_create(&a->integrator, model, state, 0, zero, zero, &integrator));
  corot_status status = COROT_OK;
  corot_step step = {0};
  for (int k = 0; k < 2; k++)
    while (!status && step.t < stop[k]) status = corot_integrator_step(integrator, stop[k], &step);
  out->cpu = cpu_clock() - start;
  out->wall = wall_clock() - started;
  out->counts = corot_integrator_statistics(integrator);
  out->choice = corot_integrator_chosen(integrator);
  corot_integrator_destroy(integrator);
  return status;
}

typedef struct phase {
  const char *name;
  double seconds; /* of the run */
  double floor;   /* least seconds by memory and arithmetic; 0: not known */
} phase;

enum { NPHASE = 8 };

static corot_status find_floors(const corot_model *model, const outcome *o, phase out[NPHASE]) {
  const corot_statistics *c = &o->counts;
  const double polar_steps = 3; /* at the strains of the bar */
  const specimen s = {.model = (corot_model *)model,
                      .ntet = corot_model_mesh(model)->ntet,
                      .n = corot_model_ndof(model)};
  bool cholesky = strncmp(o->choice.linear_solver, "cholmod", 7) == 0;
  corot_csc *full;
  solver_cost direct;
  COROT_TRY(corot_csc_create(model, COROT_FULL, &full));
  corot_status status = cost_direct(full, cholesky, &direct);
  if (!status) {
    const cost least[] = {cost_force(&s, false, polar_steps),
                          cost_jacobian(&s, false, polar_steps),
                          cost_combine(&s, full),
                          direct.factor,
                          direct.solve,
                          cost_energy(&s, polar_steps)};
    const long count[] = {c->nfe, c->nje, c->nsetups, c->nfactor, c->nsolve, c->nfeQ};
    for (int k = 0; k < 6; k++) out[k].floor = (double)count[k] * report_floor(&least[k]);
  }
  corot_csc_destroy(full);
  return status;
}

static corot_status phases_of(const corot_model *model, const outcome *o, phase out[NPHASE]) {
  const corot_statistics *c = &o->counts;
  double rest = o->wall; /* as the phases are */
  const phase timed[] = {{"force", c->force_s, 0},          {"assembly", c->assembly_s, 0},
                         {"combine", c->combine_s, 0},      {"factor", c->factor_s, 0},
                         {"solve", c->solve_s, 0},          {"work", c->work_s, 0},
                         {"integrator", c->integrator_s, 0}};
  for (int k = 0; k < NPHASE - 1; k++) {
    out[k] = timed[k];
    rest -= timed[k].seconds;
  }
  out[NPHASE - 1] = (phase){"other", rest, 0};
  return find_floors(model, o, out);
}

static void print_json(const arguments *a, const corot_model *model, const outcome *o,
                       const timing *cpu, const phase phases[NPHASE]) {
  const corot_statistics *c = &o->counts;
  json_t *j = json_pack(
      "{s:s, s:s, s:f, s:s, s:i, s:i, s:i, s:f, s:f, s:f, s:I, s:I, s:I, s:I, s:I}", "bench", "run",
      "strain", a->bar.strain, "rtol", a->integrator.rtol, "solver", o->choice.linear_solver,
      "order", o->choice.max_order, "tets", corot_model_mesh(model)->ntet, "unknowns",
      corot_model_ndof(model), "cpu_s", cpu->median, "min_cpu_s", cpu->min, "spread_cpu_s",
      cpu->spread, "nst", (json_int_t)c->nst, "nfe", (json_int_t)c->nfe, "nni", (json_int_t)c->nni,
      "nje", (json_int_t)c->nje, "nfactor", (json_int_t)c->nfactor);
  json_t *seconds = json_object(), *floors = json_object();
  for (int k = 0; k < NPHASE; k++) {
    json_object_set_new(seconds, phases[k].name, json_real(phases[k].seconds));
    if (phases[k].floor > 0)
      json_object_set_new(floors, phases[k].name, json_real(phases[k].floor));
  }
  json_object_set_new(j, "phases_s", seconds);
  json_object_set_new(j, "floors_s", floors);
  report_object(j);
}

static void print_table(const arguments *a, const corot_model *model, const outcome *o,
                        const timing *cpu, const phase phases[NPHASE]) {
  const corot_statistics *c = &o->counts;
  printf("%s, %d tets, %d degrees of freedom, strain %s, rtol %g, order %d, %s\n",
         a->bar.mesh ? a->bar.mesh : "box", corot_model_mesh(model)->ntet, corot_model_ndof(model),
         a->bar.strain, a->integrator.rtol, o->choice.max_order, o->choice.linear_solver);
  printf("CPU time of 40 s: median %.4f s, minimum %.4f s, quartiles %.4f s apart, of %d runs\n",
         cpu->median, cpu->min, cpu->spread, a->nrun);
  printf("%ld steps, %ld evaluations, %ld iterations, %ld assemblies, %ld factorisations\n", c->nst,
         c->nfe, c->nni, c->nje, c->nfactor);
  printf("%-10s %8s %8s %10s %10s\n", "wall time", "s", "%", "us a step", "its floor");
  for (int k = 0; k < NPHASE; k++) {
    double us = 1e6 / (double)c->nst;
    printf("%-10s %8.4f %8.1f %10.2f", phases[k].name, phases[k].seconds,
           100 * phases[k].seconds / o->wall, us * phases[k].seconds);
    if (phases[k].floor > 0) printf(" %10.2f", us * phases[k].floor);
    putchar('\n');
  }
}

static int by_cpu(const void *a, const void *b) {
  double x = ((const outcome *)a)->cpu, y = ((const outcome *)b)->cpu;
  return (x > y) - (x < y);
}

/* The phases shown are those of the run in the middle. */
static corot_status repeat(const arguments *a, const corot_model *model, corot_state *state,
                           double *zero, outcome *outcomes, double *cpu) {
  for (int k = 0; k < a->nrun; k++) {
    COROT_TRY(integrate(a, model, state, zero, &outcomes[k]));
    cpu[k] = outcomes[k].cpu;
  }
  qsort(outcomes, a->nrun, sizeof *outcomes, by_cpu);
  timing time = timing_summary(a->nrun, cpu);
  const outcome *middle = &outcomes[a->nrun / 2];
  phase phases[NPHASE];
  COROT_TRY(phases_of(model, middle, phases));
  (a->json ? print_json : print_table)(a, model, middle, &time, phases);
  return COROT_OK;
}

static corot_status run(const arguments *a) {
  corot_model *model = NULL;
  corot_state *state = NULL;
  COROT_TRY(bar_model(&a->bar, &model));
  corot_status status = corot_state_create(model, &state);
  double *zero = calloc(corot_model_ndof(model), sizeof *zero);
  outcome *outcomes = calloc(a->nrun, sizeof *outcomes);
  double *cpu = calloc(a->nrun, sizeof *cpu);
  if (!status && (!zero || !outcomes || !cpu)) status = corot_fail(COROT_ENOMEM, "out of memory");
  if (!status) status = repeat(a, model, state, zero, outcomes, cpu);
  free(zero), free(outcomes), free(cpu);
  corot_state_destroy(state);
  corot_model_destroy(model);
  return status;
}

static const struct option known[] = {{"json", no_argument, NULL, 'j'},
                                      {"mesh", required_argument, NULL, 'm'},
                                      {"cells", required_argument, NULL, 'c'},
                                      {"strain", required_argument, NULL, 's'},
                                      {"rtol", required_argument, NULL, 'r'},
                                      {"linear-solver", required_argument, NULL, 'l'},
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
    case 'l':
      a->integrator.linear.solver = optarg;
      return EXIT_OK;
    case 'r':
      a->integrator.rtol = strtod(optarg, &end);
      if (end != optarg && !*end && a->integrator.rtol > 0) return EXIT_OK;
      return usage_error(program, "--rtol %s: expected a number > 0", optarg);
    case 'n':
      return take_repeat(program, MOST_RUNS, &a->nrun);
    default:
      return option_error(program, answer, argv, known);
  }
}

int command_example(int argc, char **argv) {
  arguments a = {
      .bar = bar_source_default("polar"), .integrator = corot_integrator_defaults(), .nrun = 5};
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
