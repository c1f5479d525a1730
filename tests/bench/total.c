/* corot-bench total: error of space and time together against CPU time, beside CalculiX. */
#include <corot/ode.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/run/run_clock.h"
#include "bench.h"
#include "calculix.h"
#include "motion.h"
#include "report.h"

static const char help[] =
    "usage: corot-bench total [--json] [--mesh FILE | --cells I,J,K] [--only NAME] [--limit S]\n"
    "                         [--repeat N]\n"
    "\n"
    "40 s of the bar (see corot-bench run --help) under strain green, how wrong all of it is, and\n"
    "what it costs: on four-node tets, once and twice refined, on ten-node tets, and on few of "
    "them\n"
    "that are shorter near the base; and, where its program ccx is in PATH, by CalculiX. There "
    "the\n"
    "time is that of the process, reading its deck included, and nothing damps but the method; "
    "here\n"
    "that of the integrator and its creation.\n"
    "From 10 s on the corner swings about where it would be at rest. Its mean, period and "
    "amplitude,\n"
    "weighted by a cosine bell from 10 to 40 s, are compared with what finer and finer meshes of\n"
    "ten-node tets come to. The error is the largest of three: of the mean and "
    "of\n"
    "the period, relative, and of the amplitude in terms of the mean.\n"
    "\n"
    "      --json       one JSON object a line\n"
    "      --mesh FILE  a mesh in place of the box of 2 x 2 x 12 cells, 288 tets\n"
    "      --only TEXT  bodies whose name has it, e.g. ten-node\n"
    "      --limit S    no finer tolerance once a run takes longer, in s of CPU time (default: "
    "60)\n"
    "      --repeat N   runs, of which the fastest counts (default: 1)\n"
    "\n"
    "example: corot-bench total --mesh models/bar/bar.msh --only ten-node\n";

static const char program[] = "corot-bench total";

enum { MOST_RUNS = 100, MOST_SAMPLES = 10000, MOST_NAME = 64 };

typedef struct arguments {
  bool json;
  bar_source bar;
  const char *only;
  double limit;
  int nrun;
} arguments;

/* How the corner's ux goes on from 10 s. */
typedef struct swing {
  double mean;      /* [m] */
  double amplitude; /* [m] */
  double period;    /* [s] */
} swing;

/* The mean is the equilibrium's: ten-node tets, hexahedra of 8 nodes with reduced pressure, and of
   27 agree on 0.3447 +- 0.0003 m when extrapolated. Amplitude and period are those of 4 x 4 x 16
   graded cells of ten-node tets (0.3435 m, 0.0231 m, 3.207 s), carried on to that mean along a line
   through 2 x 2 x 8 cells (0.3419 m, 0.0224 m, 3.191 s): known to 0.0004 m and 0.005 s. */
static const swing truth = {0.3447, 0.0236, 3.217};

typedef struct result {
  char body[MOST_NAME];
  char method[MOST_NAME];
  int nelement, n; /* n: degrees of freedom */
  swing found;
  double error; /* relative */
  double cpu;   /* [s] */
} result;

/* --- From samples to errors --- */

enum { FROM = 10, TO = 40 };

/* The mean of (ux - about)^power under the bell, by the trapezoidal rule. */
static double weighted(int n, const double (*sample)[2], double about, int power) {
  const double pi = 3.14159265358979323846;
  double sum = 0, weight = 0, before[2] = {0};
  for (int k = 1; k < n; k++) {
    double t = sample[k][0], h = t - sample[k - 1][0];
    if (t < FROM || t > TO * (1 + 1e-9)) continue;
    double bell = sin(pi * (t - FROM) / (TO - FROM)), w = bell * bell;
    double now[2] = {w * pow(sample[k][1] - about, power), w};
    sum += 0.5 * h * (now[0] + before[0]), weight += 0.5 * h * (now[1] + before[1]);
    before[0] = now[0], before[1] = now[1];
  }
  return sum / weight;
}

/* Between the first and the last time that the mean is passed upward. */
static double period(int n, const double (*sample)[2], double mean) {
  double first = 0, last = 0;
  int count = 0;
  for (int k = 1; k < n; k++) {
    const double *a = sample[k - 1], *b = sample[k];
    if (a[0] < FROM || !(a[1] <= mean && b[1] > mean)) continue;
    last = a[0] + (mean - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    if (count++ == 0) first = last;
  }
  return (last - first) / (count - 1);
}

static void rate(int n, const double (*sample)[2], result *r) {
  swing *s = &r->found;
  s->mean = weighted(n, sample, 0, 1);
  s->amplitude = sqrt(2 * weighted(n, sample, s->mean, 2));
  s->period = period(n, sample, s->mean);
  double rest = fabs(s->mean / truth.mean - 1), phase = fabs(s->period / truth.period - 1);
  r->error = fmax(fmax(rest, phase), fabs(s->amplitude - truth.amplitude) / truth.mean);
}

static void print_heading(bool json) {
  if (json)
    report_object(json_pack("{s:s, s:f, s:f, s:f}", "bench", "total reference", "mean_m",
                            truth.mean, "amplitude_m", truth.amplitude, "period_s", truth.period));
  else
    printf(
        "the truth: mean %.4f m, amplitude %.4f m, period %.3f s\n"
        "%-30s %-18s %9s %9s %8s %10s %8s %8s %9s\n",
        truth.mean, truth.amplitude, truth.period, "body", "method", "elements", "unknowns", "mean",
        "amplitude", "period", "error", "CPU [s]");
}

static void print_result(bool json, const result *r) {
  const swing *s = &r->found;
  if (json)
    report_object(json_pack("{s:s, s:s, s:s, s:i, s:i, s:f, s:f, s:f, s:f, s:f}", "bench", "total",
                            "body", r->body, "method", r->method, "elements", r->nelement,
                            "unknowns", r->n, "mean_m", s->mean, "amplitude_m", s->amplitude,
                            "period_s", s->period, "error", r->error, "cpu_s", r->cpu));
  else
    printf("%-30s %-18s %9d %9d %8.4f %10.4f %8.3f %7.2f%% %9.3f\n", r->body, r->method,
           r->nelement, r->n, s->mean, s->amplitude, s->period, 100 * r->error, r->cpu);
}

/* --- Here --- */

typedef struct body {
  const char *name;
  bar_source bar;
  int nlevel;
} body;

static const struct {
  const char *name, *method;
  int order;
  double rtol;
} methods[] = {{"arkode 4, 1e-2", "arkode", 4, 1e-2}, {"arkode 4, 1e-3", "arkode", 4, 1e-3},
               {"arkode 4, 1e-4", "arkode", 4, 1e-4}, {"cvode, 1e-3", "cvode", 0, 1e-3},
               {"cvode, 1e-4", "cvode", 0, 1e-4},     {"cvode, 1e-5", "cvode", 0, 1e-5}};

static corot_status measure(const arguments *a, motion *m, int method, result *r) {
  corot_integrator_def def = corot_integrator_defaults();
  def.method = methods[method].method, def.rtol = methods[method].rtol;
  if (methods[method].order) def.order = methods[method].order;
  double ux[NOUTPUT], sample[NOUTPUT][2];
  corot_statistics counts;
  r->cpu = INFINITY;
  for (int k = 0; k < a->nrun; k++) {
    double start = cpu_clock();
    COROT_TRY(motion_run(m, &def, ux, &counts));
    r->cpu = fmin(r->cpu, cpu_clock() - start);
  }
  for (int k = 0; k < NOUTPUT; k++) sample[k][0] = 0.1 * k, sample[k][1] = ux[k];
  rate(NOUTPUT, sample, r);
  return COROT_OK;
}

/* By every method; those of a family only until one takes too long. */
static corot_status measure_body(const arguments *a, const body *b, motion *m) {
  const char *too_long = "";
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    if (strcmp(methods[k].method, too_long) == 0) continue;
    result r = {.nelement = corot_model_mesh(m->model)->ntet, .n = corot_model_ndof(m->model)};
    snprintf(r.body, sizeof r.body, "%s", b->name);
    snprintf(r.method, sizeof r.method, "%s", methods[k].name);
    COROT_TRY(measure(a, m, (int)k, &r));
    print_result(a->json, &r);
    if (r.cpu > a->limit) too_long = methods[k].method;
  }
  return COROT_OK;
}

static bool wanted(const arguments *a, const char *name) {
  return !a->only || strncmp(name, a->only, strlen(a->only)) == 0;
}

/* --- By CalculiX --- */

static corot_status calculix_create(int nnode, int nelement, int size, const char *type,
                                    calculix_body *b) {
  *b = (calculix_body){.type = type, .nnode = nnode, .nelement = nelement, .size = size};
  b->x = calloc(nnode, sizeof *b->x);
  b->force = calloc(nnode, sizeof *b->force);
  b->held = calloc(nnode, sizeof *b->held);
  b->node = calloc((size_t)nelement * size, sizeof *b->node);
  if (b->x && b->force && b->held && b->node) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "out of memory");
}

static void calculix_destroy(calculix_body *b) {
  free(b->x), free(b->force), free(b->held), free(b->node);
}

/* The ten-node tets of a model, with its supports, and the forces on its nodes that its loads come
   to: the residual of the body at rest. */
static corot_status from_model(motion *m, calculix_body *b) {
  const corot_mesh *mesh = corot_model_mesh(m->model);
  const int(*dof)[3] = corot_model_dof(m->model);
  COROT_TRY(calculix_create(mesh->nnode, mesh->ntet, 10, "C3D10", b));
  memcpy(b->x, mesh->x, mesh->nnode * sizeof *b->x);
  for (int e = 0; e < mesh->ntet; e++) {
    memcpy(b->node + 10 * e, mesh->tet[e], sizeof mesh->tet[e]);
    memcpy(b->node + 10 * e + 4, mesh->mid[e], sizeof mesh->mid[e]);
  }
  COROT_TRY(corot_residual(m->model, m->state, FROM, m->zero, m->zero, m->u));
  for (int k = 0; k < mesh->nnode; k++)
    for (int c = 0; c < 3; c++) {
      if (dof[k][c] < 0)
        b->held[k] = true;
      else
        b->force[k][c] = m->u[dof[k][c]];
      if (dof[k][c] == m->probe) b->probe = k;
    }
  return COROT_OK;
}

/* A box of hexahedra: nodes along x first, then y, then z. */
static corot_status from_cells(const int cells[3], calculix_body *b) {
  static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  int nx = cells[0] + 1, nxy = nx * (cells[1] + 1), nnode = nxy * (cells[2] + 1);
  COROT_TRY(calculix_create(nnode, cells[0] * cells[1] * cells[2], 8, "C3D8I", b));
  for (int k = 0; k < nnode; k++) {
    int at[3] = {k % nx, k % nxy / nx, k / nxy};
    for (int c = 0; c < 3; c++) b->x[k][c] = (c < 2 ? 0.1 : 0.6) * at[c] / cells[c];
    b->held[k] = at[2] == 0;
  }
  for (int e = 0; e < b->nelement; e++) {
    int i = e % cells[0], j = e / cells[0] % cells[1], k = e / cells[0] / cells[1];
    for (int c = 0; c < 8; c++) {
      int node = i + corner[c][0] + nx * (j + corner[c][1]) + nxy * (k + corner[c][2]);
      b->node[8 * e + c] = node;
      /* 200 Pa on 0.01 m^2, a quarter of each top face at each of its corners */
      if (node >= nnode - nxy) b->force[node][0] += 200 * 0.01 / cells[0] / cells[1] / 4;
    }
  }
  b->probe = nnode - 1;
  return COROT_OK;
}

static corot_status measure_calculix(const arguments *a, const calculix_body *b, const char *of) {
  static const double steps[] = {0.2, 0.1, 0.05};
  double(*sample)[2] = malloc(MOST_SAMPLES * sizeof *sample);
  if (!sample) return corot_fail(COROT_ENOMEM, "out of memory");
  corot_status status = COROT_OK;
  int nheld = 0, n;
  for (int k = 0; k < b->nnode; k++) nheld += b->held[k];
  for (size_t k = 0; k < sizeof steps / sizeof *steps && !status; k++) {
    result r = {.nelement = b->nelement, .n = 3 * (b->nnode - nheld)};
    snprintf(r.body, sizeof r.body, "%s", of);
    snprintf(r.method, sizeof r.method, "*DYNAMIC, %g s", steps[k]);
    status = calculix_run(b, steps[k], MOST_SAMPLES, sample, &n, &r.cpu);
    if (status) break;
    rate(n, sample, &r);
    print_result(a->json, &r);
    if (r.cpu > a->limit) break;
  }
  free(sample);
  return status;
}

static corot_status measure_hexahedra(const arguments *a) {
  static const struct {
    const char *name;
    int cells[3];
  } boxes[] = {{"CalculiX C3D8I, 1 x 1 x 6", {1, 1, 6}},
               {"CalculiX C3D8I, 2 x 2 x 12", {2, 2, 12}}};
  for (size_t k = 0; k < sizeof boxes / sizeof *boxes; k++) {
    if (!wanted(a, boxes[k].name)) continue;
    calculix_body b = {0};
    corot_status status = from_cells(boxes[k].cells, &b);
    if (!status) status = measure_calculix(a, &b, boxes[k].name);
    calculix_destroy(&b);
    COROT_TRY(status);
  }
  return COROT_OK;
}

/* --- All of it --- */

static corot_status measure_one(const arguments *a, const body *b, bool calculix) {
  char name[MOST_NAME];
  snprintf(name, sizeof name, "CalculiX C3D10, %s", b->name);
  bool other = calculix && b->bar.order == 2 && wanted(a, name);
  if (!other && !wanted(a, b->name)) return COROT_OK;
  motion m = {0};
  corot_model *model;
  COROT_TRY(bar_model_refined(&b->bar, b->nlevel, &model, NULL));
  corot_status status = motion_create(model, &m);
  if (!status && wanted(a, b->name)) status = measure_body(a, b, &m);
  calculix_body c = {0};
  if (!status && other) status = from_model(&m, &c);
  if (!status && other) status = measure_calculix(a, &c, name);
  calculix_destroy(&c);
  motion_destroy(&m);
  return status;
}

static corot_status run(const arguments *a) {
  bar_source four = a->bar, ten = four, graded = bar_source_default("green");
  four.order = 1, ten.order = 2;
  graded.order = 2, graded.box.cells[2] = 8, graded.grading = 1.75;
  graded.box.split = COROT_BOX_SYMMETRIC;
  const body bodies[] = {{"four-node", four, 0},
                         {"four-node, refined", four, 1},
                         {"four-node, refined twice", four, 2},
                         {"ten-node", ten, 0},
                         {"graded ten-node", graded, 0}};
  bool calculix = calculix_found();
  print_heading(a->json);
  for (size_t k = 0; k < sizeof bodies / sizeof *bodies; k++)
    COROT_TRY(measure_one(a, &bodies[k], calculix));
  if (calculix) return measure_hexahedra(a);
  if (!a->json) printf("There is no ccx in PATH: nothing of CalculiX to compare with.\n");
  return COROT_OK;
}

static const struct option known[] = {
    {"json", no_argument, NULL, 'j'},        {"mesh", required_argument, NULL, 'm'},
    {"cells", required_argument, NULL, 'c'}, {"only", required_argument, NULL, 'o'},
    {"limit", required_argument, NULL, 'l'}, {"repeat", required_argument, NULL, 'n'},
    {"help", no_argument, NULL, 'h'},        {0}};

static int take(arguments *a, int answer, char **argv) {
  int taken = take_bar_option(program, answer, &a->bar);
  if (taken >= 0) return taken;
  switch (answer) {
    case 'j':
      a->json = true;
      return EXIT_OK;
    case 'o':
      a->only = optarg;
      return EXIT_OK;
    case 'l':
      if (parse_positive(optarg, &a->limit)) return EXIT_OK;
      return usage_error(program, "--limit %s: expected a number > 0", optarg);
    case 'n':
      return take_repeat(program, MOST_RUNS, &a->nrun);
    default:
      return option_error(program, answer, argv, known);
  }
}

int command_total(int argc, char **argv) {
  arguments a = {.bar = bar_source_default("green"), .limit = 60, .nrun = 1};
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
