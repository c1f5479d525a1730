/* corot-bench threads: what threads gain, as ratios of one and several side by side. */
#include <corot/integrate.h>
#include <stdlib.h>
#include <string.h>

#include "app/run/run_clock.h"
#include "bench.h"
#include "core/base/team.h"
#include "report.h"
#include "solid.h"

static const char help[] =
    "usage: corot-bench threads [--json] [--threads N] [--tets N]... [--order N]\n"
    "\n"
    "Wall times of one thread over those of several, which take turns, and the median of their\n"
    "ratios: of a force, of a tangent, of an energy, and of eight steps of cvode by conjugate\n"
    "gradients. Results are the same to the last bit, or the command fails. Beside it the limit:\n"
    "the same ratio of a loop of arithmetic alone, which nothing keeps from being shared out, so\n"
    "what the machine has to give while this runs.\n"
    "\n"
    "      --threads N   how many (default: one for each processor, 2 at least)\n"
    "      --tets N      about so many (may be repeated; default: 337, 2000, 20000, 200000); with\n"
    "                    337 the number is what the size says, which is to be 1\n"
    "      --order N     of the tets: 1 or 2\n"
    "      --json        one JSON object a line\n"
    "\n"
    "example: corot-bench threads --tets 20000\n";

enum { MOST_SIZES = 8, SMALL = 1000, NSTEP = 8 };

typedef struct options {
  bool json;
  int threads, order, nsize, size[MOST_SIZES];
} options;

/* What is timed, by one thread or several: each has a state of its own. */
typedef struct side {
  const specimen *s;
  corot_state *state;
  corot_integrator *integrator;
  team *team; /* of the loop of arithmetic */
  double *r;
  double (*K)[9], (*D)[9];
  corot_energies e;
} side;

typedef corot_status one_call(side *of);

static corot_status call_force(side *of) {
  const specimen *s = of->s;
  return corot_residual(s->model, of->state, 0, s->u, s->v, of->r);
}

static corot_status call_tangent(side *of) {
  const specimen *s = of->s;
  return corot_jacobian(s->model, of->state, 0, s->u, s->v, COROT_TANGENT_EXACT, of->K, of->D);
}

static corot_status call_energy(side *of) {
  const specimen *s = of->s;
  return corot_energy(s->model, of->state, 0, s->u, s->v, &of->e);
}

/* Not timed: they are made anew for each measurement. */
static corot_status prepare_steps(side *of) {
  corot_integrator_def def = corot_integrator_defaults();
  def.linear.solver = "pcg";
  if (of->integrator) corot_integrator_destroy(of->integrator);
  of->integrator = NULL;
  return corot_integrator_create(&def, of->s->model, of->state, 0, of->s->u, of->s->v,
                                 &of->integrator);
}

static corot_status call_steps(side *of) {
  corot_step step;
  for (int k = 0; k < NSTEP; k++) COROT_TRY(corot_integrator_step(of->integrator, 1, &step));
  return corot_integrator_at(of->integrator, step.t, of->r, NULL);
}

static volatile double kept;

static void arithmetic(void *work, int part) {
  double x = 1 + part;
  (void)work;
  for (int k = 0; k < 400000; k++) x = x * 0.999 + 0.001;
  kept = x;
}

/* So many parts that teams of most sizes share them out evenly. */
static corot_status call_limit(side *of) {
  corot_team_run(of->team, 24, arithmetic, NULL);
  return COROT_OK;
}

typedef struct comparison {
  double one, several; /* medians [s] */
  double ratio, spread;
} comparison;

/* What is timed, and what is done before. */
typedef struct piece {
  const char *what;
  one_call *prepare, *call; /* the first may be NULL */
} piece;

static corot_status seconds_of(const piece *p, side *of, int ncall, double *out) {
  if (p->prepare) COROT_TRY(p->prepare(of));
  double start = wall_clock();
  for (int k = 0; k < ncall; k++) COROT_TRY(p->call(of));
  *out = (wall_clock() - start) / ncall;
  return COROT_OK;
}

/* In turn, until a second is over, 7 times at least; a batch takes a millisecond. */
static corot_status compare(const piece *p, side side_of[2], comparison *out) {
  enum { MOST = 101, LEAST = 7 };
  double time[2][MOST], ratio[MOST], start = wall_clock();
  int n = 0, ncall;
  COROT_TRY(seconds_of(p, &side_of[1], 1, &time[1][0]));
  COROT_TRY(seconds_of(p, &side_of[0], 1, &time[0][0]));
  ncall = !p->prepare && time[0][0] < 1e-3 ? (int)(1e-3 / time[0][0]) + 1 : 1;
  for (; n < MOST && (n < LEAST || wall_clock() - start < 1); n++) {
    for (int k = 0; k < 2; k++) COROT_TRY(seconds_of(p, &side_of[k], ncall, &time[k][n]));
    ratio[n] = time[0][n] / time[1][n];
  }
  timing all = timing_summary(n, ratio);
  *out = (comparison){timing_summary(n, time[0]).median, timing_summary(n, time[1]).median,
                      all.median, all.spread};
  return COROT_OK;
}

static void show(const options *o, const specimen *s, int threads, const char *what,
                 const comparison *c, double limit) {
  if (o->json) {
    report_object(json_pack("{s:s, s:s, s:i, s:i, s:f, s:f, s:f, s:f, s:f}", "bench", "threads",
                            "what", what, "tets", s->ntet, "threads", threads, "one_s", c->one,
                            "several_s", c->several, "speedup", c->ratio, "spread", c->spread,
                            "limit", limit));
    return;
  }
  printf("%8d tets  %-8s %2d threads  %10.4f ms  %10.4f ms  %5.2f times  (+-%.2f; limit %.2f)\n",
         s->ntet, what, threads, 1e3 * c->one, 1e3 * c->several, c->ratio, c->spread, limit);
}

static corot_status same(const char *what, const void *a, const void *b, size_t bytes) {
  if (memcmp(a, b, bytes) == 0) return COROT_OK;
  return corot_fail(COROT_EINVAL, "threads: %s is not the same as by one thread", what);
}

static corot_status check(const char *what, const specimen *s, const side of[2]) {
  size_t nblock = (size_t)corot_model_nblock(s->model);
  COROT_TRY(same(what, of[0].r, of[1].r, (size_t)s->n * sizeof *of->r));
  COROT_TRY(same(what, of[0].K, of[1].K, nblock * sizeof *of->K));
  COROT_TRY(same(what, of[0].D, of[1].D, nblock * sizeof *of->D));
  return same(what, &of[0].e, &of[1].e, sizeof of->e);
}

static corot_status side_create(const specimen *s, int threads, side *out) {
  size_t nblock = (size_t)corot_model_nblock(s->model);
  out->s = s;
  out->r = calloc((size_t)s->n, sizeof *out->r);
  out->K = calloc(nblock, sizeof *out->K), out->D = calloc(nblock, sizeof *out->D);
  if (!out->r || !out->K || !out->D) return corot_fail(COROT_ENOMEM, "out of memory");
  COROT_TRY(corot_team_create(threads, &out->team));
  COROT_TRY(corot_state_create(s->model, &out->state));
  return corot_state_threads(out->state, threads);
}

static void side_clear(side *of) {
  corot_integrator_destroy(of->integrator);
  corot_state_destroy(of->state);
  corot_team_destroy(of->team);
  free(of->r), free(of->K), free(of->D);
}

static corot_status measure(const options *o, const specimen *s, side of[2]) {
  static const piece alone = {"limit", NULL, call_limit};
  static const piece rows[] = {{"force", NULL, call_force},
                               {"tangent", NULL, call_tangent},
                               {"energy", NULL, call_energy},
                               {"steps", prepare_steps, call_steps}};
  int threads = corot_state_thread_count(of[1].state);
  comparison limit, c;
  COROT_TRY(compare(&alone, of, &limit));
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    COROT_TRY(compare(&rows[k], of, &c));
    COROT_TRY(check(rows[k].what, s, of));
    show(o, s, threads, rows[k].what, &c, limit.ratio);
  }
  return COROT_OK;
}

static corot_status measure_size(const options *o, int ntet) {
  corot_mesh *mesh = NULL;
  specimen s = {0};
  side of[2] = {{0}};
  COROT_TRY(solid_mesh(ntet, o->order, &mesh));
  corot_status status = solid_create(mesh, "polar", true, &s);
  corot_mesh_destroy(mesh);
  int threads = ntet < SMALL && !status ? corot_model_threads(s.model) : o->threads;
  if (!status) status = side_create(&s, 1, &of[0]);
  if (!status) status = side_create(&s, threads, &of[1]);
  if (!status) status = measure(o, &s, of);
  for (int k = 0; k < 2; k++) side_clear(&of[k]);
  solid_clear(&s);
  return status;
}

static int read_options(int argc, char **argv, options *o) {
  static const char program[] = "corot-bench threads";
  static const struct option known[] = {
      {"json", no_argument, NULL, 'j'},       {"threads", required_argument, NULL, 't'},
      {"tets", required_argument, NULL, 'n'}, {"order", required_argument, NULL, 'o'},
      {"help", no_argument, NULL, 'h'},       {0}};
  *o = (options){.order = 1, .threads = corot_processors()};
  if (o->threads < 2) o->threads = 2;
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", known, NULL)) != -1;) {
    switch (answer) {
      case 'h':
        fputs(help, stdout);
        return EXIT_OK;
      case 'j':
        o->json = true;
        break;
      case 't':
        if (!parse_count(optarg, COROT_MOST_THREADS, &o->threads))
          return usage_error(program, "--threads: 1 to %d", COROT_MOST_THREADS);
        break;
      case 'n':
        if (o->nsize == MOST_SIZES)
          return usage_error(program, "--tets: %d times at most", MOST_SIZES);
        if (!parse_count(optarg, 100 * 1000 * 1000, &o->size[o->nsize++]))
          return usage_error(program, "--tets %s: expected a whole number > 0", optarg);
        break;
      case 'o':
        if (!parse_count(optarg, 2, &o->order)) return usage_error(program, "--order: 1 or 2");
        break;
      default:
        return option_error(program, answer, argv, known);
    }
  }
  if (optind < argc) return usage_error(program, "unexpected: %s", argv[optind]);
  return -1;
}

int command_threads(int argc, char **argv) {
  static const int sizes[] = {337, 2000, 20000, 200000};
  options o;
  int code = read_options(argc, argv, &o);
  if (code >= 0) return code;
  if (o.nsize == 0)
    for (int k = 0; k < 4; k++) o.size[o.nsize++] = sizes[k];
  report_machine(o.json);
  corot_status status = COROT_OK;
  for (int k = 0; k < o.nsize && !status; k++) status = measure_size(&o, o.size[k]);
  return status ? failure(status) : EXIT_OK;
}
