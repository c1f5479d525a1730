/* corot-bench kernels: every evaluation of the model, beside its floor. */
#include <stdlib.h>

#include "bench.h"
#include "core/element/strain.h"
#include "core/lanes/widths.h"
#include "machine.h"
#include "report.h"
#include "solvers.h"

static const char help[] =
    "usage: corot-bench kernels [--json] [--tets N]... [--large] [--order N] [--peak N] [--lanes "
    "N]\n"
    "\n"
    "Time of each evaluation and of the linear solvers per tet, and the floor that memory and\n"
    "arithmetic of this machine put under it, measured at the same time. Exit code 5 if a\n"
    "time lies below its floor: then the floor is wrong.\n"
    "\n"
    "      --json     one JSON object a line\n"
    "      --tets N   size of the box, rounded to whole cells; may be given again for more sizes\n"
    "                 (default: 18432, which the caches of most machines hold)\n"
    "      --large    147456 tets as well, which they do not\n"
    "      --order N  of the tets: 1, four nodes; 2, ten nodes (default: 1)\n"
    "      --peak N   Gflop/s of this machine in place of those measured\n"
    "      --lanes N  no vectors of more than N doubles: 8 (AVX-512), 4 (AVX2), 2\n"
    "\n"
    "force           internal forces, frames exact, no damping\n"
    "force-held      the same with held frames\n"
    "force-damped    with viscous forces, frames exact\n"
    "rhs             the first-order system, as an integrator calls it; damped\n"
    "jacobian        K and D with the frames held; damped\n"
    "jacobian-exact  K and D with the variation of the frames\n"
    "jvp             the derivative in a direction, nothing left out\n"
    "frames          update of the held frames\n"
    "energy          energies and powers\n"
    "combine         a M + b D + c K as compressed columns, from K and D\n"
    "factor          first factorisation (pcg: preconditioner), with the choice of pivots\n"
    "refactor        every further one\n"
    "solve           one right-hand side\n"
    "\n"
    "example: corot-bench kernels --json --tets 18432\n";

static corot_status residual(void *data) {
  specimen *s = data;
  return corot_residual(s->model, s->state, 0, s->u, s->v, s->r);
}

static corot_status rhs(void *data) {
  specimen *s = data;
  return corot_rhs(s->model, s->state, 0, s->y, s->ydot);
}

static corot_status jacobian(void *data) {
  specimen *s = data;
  return corot_jacobian(s->model, s->state, 0, s->u, s->v, COROT_TANGENT_HELD, s->K, s->D);
}

static corot_status jacobian_exact(void *data) {
  specimen *s = data;
  return corot_jacobian(s->model, s->state, 0, s->u, s->v, COROT_TANGENT_EXACT, s->K, s->D);
}

static corot_status jvp(void *data) {
  specimen *s = data;
  return corot_jvp(s->model, s->state, 0, s->u, s->v, COROT_TANGENT_EXACT, s->du, s->dv, s->r);
}

static corot_status frames(void *data) {
  specimen *s = data;
  return corot_frames_update(s->model, s->state, 0, s->u, NULL);
}

static corot_status energy(void *data) {
  specimen *s = data;
  corot_energies e;
  return corot_energy(s->model, s->state, 0, s->u, s->v, &e);
}

typedef struct combination {
  const specimen *specimen;
  const corot_csc *csc;
  double *value;
} combination;

static corot_status combine(void *data) {
  combination *c = data;
  const specimen *s = c->specimen;
  corot_csc_combine(s->model, c->csc, 1, 1e-2, (const double(*)[9])s->D, 1e-4,
                    (const double(*)[9])s->K, c->value);
  return COROT_OK;
}

static corot_status measure(bool json, const char *bench, const char *strain, const specimen *s,
                            piece_of_work *work, void *data, cost least) {
  row r = {.bench = bench, .strain = strain, .ntet = s->ntet, .n = s->n, .least = least};
  COROT_TRY(timing_of(work, data, &r.time));
  report_row(json, &r);
  return COROT_OK;
}

static corot_status undamped(bool json, const char *strain, specimen *s) {
  double steps = cost_polar_steps(s);
  COROT_TRY(measure(json, "force", strain, s, residual, s, cost_force(s, false, steps)));
  corot_state_use(s->state, COROT_FRAMES_HELD);
  return measure(json, "force-held", strain, s, residual, s, cost_force(s, true, steps));
}

static corot_status damped(bool json, const char *strain, specimen *s) {
  double n = cost_polar_steps(s);
  COROT_TRY(measure(json, "force-damped", strain, s, residual, s, cost_force(s, false, n)));
  COROT_TRY(measure(json, "rhs", strain, s, rhs, s, cost_rhs(s, n)));
  COROT_TRY(measure(json, "jacobian", strain, s, jacobian, s, cost_jacobian(s, false, n)));
  COROT_TRY(
      measure(json, "jacobian-exact", strain, s, jacobian_exact, s, cost_jacobian(s, true, n)));
  COROT_TRY(measure(json, "jvp", strain, s, jvp, s, cost_jvp(s, n)));
  COROT_TRY(measure(json, "frames", strain, s, frames, s, cost_frames(s, n)));
  return measure(json, "energy", strain, s, energy, s, cost_energy(s, n));
}

static corot_status matrices(bool json, specimen *s) {
  combination c = {.specimen = s};
  corot_csc *csc;
  COROT_TRY(jacobian(s));
  COROT_TRY(corot_csc_create(s->model, COROT_FULL, &csc));
  c.csc = csc, c.value = malloc(csc->nnz * sizeof *c.value);
  corot_status status = COROT_OK;
  if (!c.value) status = corot_fail(COROT_ENOMEM, "no memory for a matrix");
  if (!status) status = measure(json, "combine", NULL, s, combine, &c, cost_combine(s, csc));
  free(c.value);
  corot_csc_destroy(csc);
  return status ? status : solvers_measure(json, s);
}

static corot_status all(bool json, corot_mesh *mesh) {
  for (int k = 0; k < NSTRAIN; k++) {
    const char *strain = strain_measures[k].name;
    for (int pass = 0; pass < 2; pass++) {
      specimen s;
      COROT_TRY(solid_create(mesh, strain, pass == 1, &s));
      if (k == 0 && pass == 0) report_heading(json, s.ntet, s.n);
      corot_status status = pass == 0 ? undamped(json, strain, &s) : damped(json, strain, &s);
      if (!status && pass == 1 && k == POLAR) status = matrices(json, &s);
      solid_clear(&s);
      COROT_TRY(status);
    }
  }
  return COROT_OK;
}

static corot_status of_size(bool json, int order, int ntet) {
  corot_mesh *mesh;
  COROT_TRY(solid_mesh(ntet, order, &mesh));
  corot_status status = all(json, mesh);
  corot_mesh_destroy(mesh);
  return status;
}

static int of_sizes(bool json, int order, int nsize, const int *ntet) {
  report_machine(json);
  for (int k = 0; k < nsize; k++) {
    corot_status status = of_size(json, order, ntet[k]);
    if (status) return failure(status);
  }
  corot_status status = report_check();
  return status ? failure(status) : EXIT_OK;
}

int command_kernels(int argc, char **argv) {
  static const char program[] = "corot-bench kernels";
  static const struct option known[] = {
      {"json", no_argument, NULL, 'j'},       {"tets", required_argument, NULL, 't'},
      {"large", no_argument, NULL, 'l'},      {"order", required_argument, NULL, 'o'},
      {"peak", required_argument, NULL, 'p'}, {"lanes", required_argument, NULL, 'w'},
      {"help", no_argument, NULL, 'h'},       {0}};
  enum { MOST = 16 };
  int ntet[MOST], nsize = 0, lanes, order = 1;
  double peak;
  bool json = false, large = false;
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", known, NULL)) != -1;) switch (answer) {
      case 'j':
        json = true;
        break;
      case 'l':
        large = true;
        break;
      case 't':
        if (nsize == MOST - 1) return usage_error(program, "--tets: more than %d sizes", MOST - 1);
        if (!parse_count(optarg, 100 * 1000 * 1000, &ntet[nsize++]))
          return usage_error(program, "--tets %s: expected a whole number > 0", optarg);
        break;
      case 'o':
        if (!parse_count(optarg, 2, &order)) return usage_error(program, "--order: 1 or 2");
        break;
      case 'p':
        if (!parse_positive(optarg, &peak))
          return usage_error(program, "--peak %s: not > 0", optarg);
        machine_set_peak(1e9 * peak);
        break;
      case 'w':
        if (!parse_count(optarg, W, &lanes)) return usage_error(program, "--lanes: 8, 4 or 2");
        corot_lanes_limit(lanes);
        break;
      case 'h':
        fputs(help, stdout);
        return EXIT_OK;
      default:
        return option_error(program, answer, argv, known);
    }
  if (optind < argc) return usage_error(program, "unexpected: %s", argv[optind]);
  if (nsize == 0) ntet[nsize++] = 18432;
  if (large) ntet[nsize++] = 147456;
  return of_sizes(json, order, nsize, ntet);
}
