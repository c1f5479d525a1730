/* Energy and momentum of a run against what they should be. */
#include <corot/ode.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "errors.h"

/* The columns of energy.csv, in their order. */
enum { T, KINETIC, ELASTIC, DISSIPATED, WORK, BALANCE, FRAMES, PX, PY, PZ, NCOLUMN };
static const char header[] =
    "t,kinetic,elastic,dissipated,external_work,balance,frame_energy,px,py,pz,";

/* --- The impulse of the loads --- */

/* Forces of known size act on every degree of freedom, and nothing else from outside. */
static bool has_known_impulse(const corot_model *model, const scenario *s) {
  bool known = corot_model_ndof(model) == 3 * corot_model_mesh(model)->nnode;
  for (int i = 0; i < s->nload; i++) known &= s->load[i].kind != COROT_PRESSURE;
  for (int i = 0; i < s->nmaterial; i++) known &= s->material[i].damping_mass == 0;
  return known;
}

/* Sum of the loads at t: the force on a body at rest. */
static corot_status total_force(yardstick *y, double t, double F[3]) {
  size_t n = (size_t)corot_model_ndof(y->model);
  double *zero = y->work, *r = y->work + 2 * n;
  memset(zero, 0, 2 * n * sizeof *zero);
  COROT_TRY(corot_residual(y->model, y->state, t, zero, zero + n, r));
  const int(*dof)[3] = corot_model_dof(y->model);
  for (int c = 0; c < 3; c++) F[c] = 0;
  for (int i = 0; i < corot_model_mesh(y->model)->nnode; i++)
    for (int c = 0; c < 3; c++) F[c] += r[dof[i][c]];
  return COROT_OK;
}

/* By Gauss' rule of three points, which never looks at a kink itself, where a load may jump. */
static corot_status add_part(yardstick *y, double from, double to, double impulse[3]) {
  static const double at[] = {0.1127016653792583, 0.5, 0.8872983346207417};
  static const double weight[] = {5. / 18, 8. / 18, 5. / 18};
  for (int k = 0; k < 3; k++) {
    double F[3];
    COROT_TRY(total_force(y, from + at[k] * (to - from), F));
    for (int c = 0; c < 3; c++) impulse[c] += weight[k] * (to - from) * F[c];
  }
  return COROT_OK;
}

/* Between kinks: in one part where loads are linear; where one is a sine or a spline, in sixteen
   parts of what one step may go, in each of which it is nearly a polynomial. */
static corot_status add_impulse(yardstick *y, double from, double to, double impulse[3]) {
  while (from < to) {
    double horizon = corot_model_horizon(y->model, from), stop = fmin(horizon, to);
    int n = horizon == INFINITY ? 1 : 16;
    for (int i = 0; i < n; i++) {
      double length = (stop - from) / n;
      COROT_TRY(add_part(y, from + i * length, from + (i + 1) * length, impulse));
    }
    from = stop;
  }
  return COROT_OK;
}

static corot_status advance_impulse(yardstick *y, double from, double to, double impulse[3]) {
  int nkink = corot_model_kinks(y->model, from, to, 0, NULL);
  double *kink = malloc(((size_t)nkink + 1) * sizeof *kink);
  if (!kink) return corot_fail(COROT_ENOMEM, "out of memory");
  corot_model_kinks(y->model, from, to, nkink, kink);
  kink[nkink] = to;
  corot_status status = COROT_OK;
  for (int i = 0; i <= nkink && status == COROT_OK; from = kink[i++])
    status = add_impulse(y, from, kink[i], impulse);
  free(kink);
  return status;
}

/* --- The table --- */

typedef struct books {
  double imbalance, energy;  /* largest so far [J] */
  double distance, momentum; /* the same [kg m/s] */
  bool by_impulse;
  bool begun;
  double t, impulse[3]; /* up to t, the momentum of the start included */
} books;

static double length3(const double x[3]) { return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]); }

static corot_status enter_row(yardstick *y, const double *row, books *b) {
  b->imbalance = fmax(b->imbalance, fabs(row[BALANCE]));
  b->energy = fmax(b->energy, row[KINETIC] + row[ELASTIC] + row[DISSIPATED]);
  if (!b->by_impulse) return COROT_OK;
  if (!b->begun)
    for (int c = 0; c < 3; c++) b->impulse[c] = row[PX + c];
  b->begun = true;
  COROT_TRY(advance_impulse(y, b->t, row[T], b->impulse));
  b->t = row[T];
  double apart[3];
  for (int c = 0; c < 3; c++) apart[c] = row[PX + c] - b->impulse[c];
  b->distance = fmax(b->distance, length3(apart));
  b->momentum = fmax(b->momentum, fmax(length3(b->impulse), length3(row + PX)));
  return COROT_OK;
}

static bool read_row(const char *line, double *row) {
  for (int i = 0; i < NCOLUMN; i++) {
    char *end;
    row[i] = strtod(line, &end);
    if (end == line || *end != ',') return false; /* more columns follow */
    line = end + 1;
  }
  return true;
}

static corot_status read_table(yardstick *y, FILE *file, const char *path, books *b) {
  char line[1024];
  double row[NCOLUMN];
  if (!fgets(line, sizeof line, file) || strncmp(line, header, sizeof header - 1) != 0)
    return ferror(file) ? corot_fail(COROT_EIO, "%s: cannot read it", path)
                        : corot_fail(COROT_EFORMAT, "%s: not a table of energies", path);
  for (int number = 2; fgets(line, sizeof line, file); number++) {
    if (!read_row(line, row)) return corot_fail(COROT_EFORMAT, "%s:%d: not a row", path, number);
    COROT_TRY(enter_row(y, row, b));
  }
  return ferror(file) ? corot_fail(COROT_EIO, "%s: cannot read it", path) : COROT_OK;
}

corot_status drift_measure(yardstick *y, const scenario *s, const char *dir, drift *out) {
  char *path = folder_path(dir, "energy.csv");
  if (!path) return COROT_ENOMEM;
  books b = {.by_impulse = has_known_impulse(y->model, s)};
  FILE *file = fopen(path, "re");
  corot_status status = file ? read_table(y, file, path, &b)
                             : corot_fail(errno == ENOENT ? COROT_EFORMAT : COROT_EIO,
                                          "%s: cannot open it: %s", path, strerror(errno));
  if (file) fclose(file);
  free(path);
  COROT_TRY(status);
  *out = (drift){.energy = b.energy > 0 ? b.imbalance / b.energy : NAN,
                 .momentum = b.momentum > 0 ? b.distance / b.momentum : NAN};
  return COROT_OK;
}
