/* What local refinement saves: unknowns for a displacement to some accuracy, of ten-node tets that
   are cut where the indicators of the space error say so, and of ones that are all cut into eight.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <corot/space.h>
#include <corot/statics.h>

#include "bench.h"

static const char help[] =
    "usage: corot-bench local [--fraction F] [--within E]\n"
    "\n"
    "Unknowns that ten-node tets need for a displacement to E (default 0.005) of it, of an L and "
    "a\n"
    "notched bar of boxes: cut where a fraction F (default 0.5) of the error is, and cut "
    "everywhere.\n"
    "The reference is where the local values go as their estimated error goes to zero.\n";

enum { STEPS = 40 };

/* A body of boxes, clamped at a plane, pulled at another; `at` sinks in z. */
typedef struct sample {
  const char *name;
  double size[3];
  int cells[3];
  bool (*has)(const double x[3]); /* which of the cells it has */
  int axis;                       /* of the clamped plane */
  double clamped, end;            /* which is where, and the end's x */
  double at[3];
} sample;

static bool in_ell(const double x[3]) { return !(x[0] > 1 && x[2] > 1); }
static bool in_notched(const double x[3]) { return !(fabs(x[0] - 2) < 0.25 && x[2] > 0.5); }

static const sample samples[] = {
    {"L", {2, 0.5, 2}, {4, 1, 4}, in_ell, 2, 2, 2, {2, 0.25, 0.5}},
    {"notch", {4, 0.5, 1}, {16, 2, 4}, in_notched, 0, 0, 4, {4, 0.25, 0.5}},
};

/* One solution. */
typedef struct answer {
  int n;
  double value, missing; /* estimated */
} answer;

/* --- Mesh --- */

/* The tets of a box that the body has. */
static corot_status cut_out(const sample *s, const corot_mesh *box, corot_mesh **mesh) {
  int *number = calloc((size_t)box->nnode, sizeof *number), ntet = 0, nnode = 0;
  int(*tet)[4] = calloc((size_t)box->ntet, sizeof *tet);
  double(*x)[3] = calloc((size_t)box->nnode, sizeof *x);
  corot_status status = COROT_ENOMEM;
  for (int e = 0; number && tet && x && e < box->ntet; e++) {
    double middle[3] = {0};
    for (int k = 0; k < 12; k++) middle[k % 3] += 0.25 * box->x[box->tet[e][k / 3]][k % 3];
    if (!s->has(middle)) continue;
    for (int k = 0; k < 4; k++) {
      int from = box->tet[e][k];
      if (!number[from]) memcpy(x[nnode], box->x[from], sizeof *x), number[from] = ++nnode;
      tet[ntet][k] = number[from] - 1;
    }
    ntet++;
  }
  if (ntet > 0)
    status = corot_mesh_create(nnode, (const double(*)[3])x, ntet, (const int(*)[4])tet, mesh);
  free(number), free(tet), free(x);
  return status;
}

static corot_status make_mesh(const sample *s, corot_mesh **mesh) {
  corot_box box = corot_box_defaults();
  corot_mesh *all, *part = NULL;
  memcpy(box.size, s->size, sizeof box.size);
  memcpy(box.cells, s->cells, sizeof box.cells);
  COROT_TRY(corot_mesh_box(&box, &all));
  corot_status status = cut_out(s, all, &part);
  corot_mesh_destroy(all);
  if (!status) status = corot_mesh_group_plane(part, "clamped", s->axis, s->clamped, 0);
  if (!status) status = corot_mesh_group_plane(part, "end", 0, s->end, 0);
  if (!status) status = corot_mesh_change_order(part, 2, mesh);
  corot_mesh_destroy(part);
  return status;
}

/* --- A solution --- */

static corot_status solve_model(const corot_model *model, double *u) {
  corot_statics_def def = corot_statics_defaults();
  corot_statics *statics;
  COROT_TRY(corot_statics_create(&def, model, 0, NULL, &statics));
  corot_status status = corot_statics_solve(statics);
  if (!status) corot_statics_at(statics, u);
  corot_statics_destroy(statics);
  return status;
}

static corot_status ask(const sample *s, const corot_model *model, double *u, double *goal,
                        double *indicator, answer *a) {
  corot_location at;
  corot_space_total total;
  COROT_TRY(solve_model(model, u));
  COROT_TRY(corot_mesh_locate(corot_model_mesh(model), s->at, &at));
  *a = (answer){.n = corot_model_ndof(model)};
  for (int k = 0; k < at.nnode; k++) {
    int i = corot_model_dof(model)[at.node[k]][2];
    if (i < 0) continue;
    goal[i] += at.weight[k];
    a->value += at.weight[k] * u[i];
  }
  const corot_space_moment now = {.u = u, .still = true, .factor = 1};
  COROT_TRY(corot_space_indicators(model, &now, goal, NULL, indicator, &total));
  a->missing = total.goal;
  return COROT_OK;
}

/* The answer, and the mesh that is cut by it: everywhere, for a fraction of 0. */
static corot_status go_on(const sample *s, double fraction, corot_mesh **mesh, answer *a) {
  const corot_material steel = {.lambda = 1.2e11, .mu = 8e10, .density = 7850};
  const corot_fix fix = {"clamped", {true, true, true}};
  const corot_load load = {COROT_TRACTION, "end", {0, 0, -1e6}, {0}};
  corot_model_def def = corot_model_defaults();
  corot_model *model;
  corot_mesh *fine = NULL;
  def.strain = "cauchy", def.mesh = *mesh;
  def.nmaterial = 1, def.material = &steel;
  def.nfix = 1, def.fix = &fix, def.nload = 1, def.load = &load;
  COROT_TRY(corot_model_create(&def, &model));
  size_t n = (size_t)corot_model_ndof(model), ntet = (size_t)(*mesh)->ntet;
  double *room = calloc(2 * n + ntet, sizeof *room);
  int *mark = calloc(ntet, sizeof *mark), nmark;
  corot_status status = room && mark ? COROT_OK : corot_fail(COROT_ENOMEM, "out of memory");
  if (!status) status = ask(s, model, room, room + n, room + 2 * n, a);
  if (!status && fraction > 0)
    status = corot_space_mark((int)ntet, room + 2 * n, fraction, &nmark, mark);
  if (!status && fraction > 0)
    status = corot_mesh_refine_marked(*mesh, nmark, mark, &fine, NULL);
  else if (!status)
    status = corot_mesh_refine(*mesh, 1, COROT_DIAGONAL_CONSISTENT, &fine, NULL);
  free(room), free(mark);
  corot_model_destroy(model);
  if (!status) corot_mesh_destroy(*mesh), *mesh = fine;
  return status;
}

/* All answers until the estimate is below a part of the value, or there are too many unknowns. */
static corot_status refine(const sample *s, double fraction, double part, int most, answer *a,
                           int *count) {
  corot_mesh *mesh;
  COROT_TRY(make_mesh(s, &mesh));
  corot_status status = COROT_OK;
  for (*count = 0; !status && *count < STEPS; ++*count) {
    const answer *last = &a[*count - 1];
    if (*count && (fabs(last->missing) < part * fabs(last->value) || last->n > most)) break;
    status = go_on(s, fraction, &mesh, &a[*count]);
  }
  corot_mesh_destroy(mesh);
  return status;
}

/* --- What they say --- */

/* Unknowns at which the error is that part, between two answers or beyond the last two. */
static double needed(int count, const answer *a, double exact, double part) {
  int k = 1;
  while (k < count - 1 && fabs(exact - a[k].value) > part * fabs(exact)) k++;
  double from = log(fabs(exact - a[k - 1].value)), to = log(fabs(exact - a[k].value));
  double x = (log(part * fabs(exact)) - from) / (to - from);
  return exp(log(a[k - 1].n) + x * log((double)a[k].n / a[k - 1].n));
}

static corot_status compare(const sample *s, double fraction, double within) {
  answer local[STEPS], uniform[STEPS];
  int nlocal, nuniform;
  COROT_TRY(refine(s, fraction, 0.5 * within, 20000, local, &nlocal));
  COROT_TRY(refine(s, 0, 0.5 * within, 20000, uniform, &nuniform));
  const answer *a = &local[nlocal - 2], *b = &local[nlocal - 1];
  double exact = b->value + b->missing * (b->value - a->value) / (a->missing - b->missing);
  printf("%s: %.5e m\n", s->name, exact);
  for (int k = 0; k < nlocal + nuniform; k++) {
    const answer *c = k < nlocal ? &local[k] : &uniform[k - nlocal];
    printf("  %-8s%9d unknowns  %.5e m  off by %7.3f %%, estimated %7.3f %%\n",
           k < nlocal ? "local" : "uniform", c->n, c->value, 100 * (exact / c->value - 1),
           100 * c->missing / c->value);
  }
  double few = needed(nlocal, local, exact, within),
         many = needed(nuniform, uniform, exact, within);
  printf("  to %g: local %.0f, uniform %.0f unknowns, %.1f times as many\n", within, few, many,
         many / few);
  fflush(stdout);
  return COROT_OK;
}

int command_local(int argc, char **argv) {
  static const struct option known[] = {{"fraction", required_argument, NULL, 'f'},
                                        {"within", required_argument, NULL, 'w'},
                                        {"help", no_argument, NULL, 'h'},
                                        {0}};
  const char *program = "corot-bench local";
  double fraction = 0.5, within = 0.005;
  opterr = 0;
  for (int option; (option = getopt_long(argc, argv, ":h", known, NULL)) != -1;) {
    if (option == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    if (option != 'f' && option != 'w') return option_error(program, option, argv, known);
    double *to = option == 'f' ? &fraction : &within;
    *to = strtod(optarg, NULL);
    if (!(*to > 0 && *to < 1)) return usage_error(program, "not between 0 and 1: %s", optarg);
  }
  if (optind < argc) return usage_error(program, "unexpected: %s", argv[optind]);
  for (size_t k = 0; k < sizeof samples / sizeof *samples; k++)
    if (compare(&samples[k], fraction, within) != COROT_OK) {
      fprintf(stderr, "%s: %s\n", program, corot_error());
      return EXIT_FAILURE;
    }
  return EXIT_OK;
}
