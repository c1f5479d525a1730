/* One row of forces a moment: every measure evaluated on the state of the run. */
#include "compare.h"

#include <math.h>
#include <stdlib.h>

#include "app/folder/write_csv.h"

/* Internal force of one measure on all nodes. */
typedef struct force {
  double (*pressure)[3], (*shear)[3]; /* [nnode] of the lambda term and of the mu term [N] */
  bool known;                         /* false: a tet is inverted */
} force;

typedef struct comparison {
  const corot_model *model;
  int nnode, nmeasure;
  const char *const *measure; /* [nmeasure] */
  force green, other;
  double (*memory)[3]; /* [4 nnode] of both forces */
  force_error *error;  /* [nmeasure] of one row */
  table *table;
} comparison;

static bool wants_comparison(const scenario *s) { return s->ncompare > 0; }

static corot_status close_comparison(void *writer) {
  comparison *c = writer;
  corot_status status = table_close(c->table);
  free(c->memory);
  free(c->error);
  free(c);
  return status;
}

static corot_status open_all(comparison *c, const writer_source *source) {
  size_t nnode = (size_t)c->nnode;
  c->memory = malloc(4 * nnode * sizeof *c->memory);
  c->error = malloc((size_t)c->nmeasure * sizeof *c->error);
  if (!c->memory || !c->error) return corot_fail(COROT_ENOMEM, "the comparison: out of memory");
  c->green = (force){.pressure = c->memory, .shear = c->memory + nnode};
  c->other = (force){.pressure = c->memory + 2 * nnode, .shear = c->memory + 3 * nnode};
  if (source->from)
    return table_resume(source->dir, comparison_writer.file, source->from, &c->table);
  return compare_open(source->dir, c->nmeasure, c->measure, &c->table);
}

static corot_status open_comparison(const writer_source *source, void **writer) {
  comparison *c = calloc(1, sizeof *c);
  if (!c) return corot_fail(COROT_ENOMEM, "the comparison: out of memory");
  *c = (comparison){.model = source->model,
                    .nnode = corot_model_mesh(source->model)->nnode,
                    .nmeasure = source->scenario->ncompare,
                    .measure = source->scenario->compare};
  corot_status status = open_all(c, source);
  if (status != COROT_OK) {
    close_comparison(c);
    return status;
  }
  *writer = c;
  return COROT_OK;
}

static table *table_of_comparison(const void *writer) {
  return ((const comparison *)writer)->table;
}

static corot_status find_force(const comparison *c, corot_state *state, double t, const double *u,
                               const char *measure, force *f) {
  corot_status status = corot_internal_force(c->model, state, t, u, measure, 1, 0, f->pressure);
  if (status == COROT_OK)
    status = corot_internal_force(c->model, state, t, u, measure, 0, 1, f->shear);
  f->known = status == COROT_OK;
  return status > 0 ? COROT_OK : status;
}

/* Against nothing there is no relative error. */
static double ratio(double difference2, double size2) {
  return size2 > 0 ? sqrt(difference2 / size2) : NAN;
}

/* |f - g| / |g| over all nodes, of both terms and of their sum. */
static force_error error_of(const comparison *c) {
  const force *f = &c->other, *g = &c->green;
  if (!f->known || !g->known) return (force_error){NAN, NAN, NAN};
  double difference[3] = {0}, size[3] = {0}; /* squared: total, pressure, shear */
  for (int n = 0; n < c->nnode; n++)
    for (int k = 0; k < 3; k++) {
      double p = f->pressure[n][k] - g->pressure[n][k], s = f->shear[n][k] - g->shear[n][k];
      double gp = g->pressure[n][k], gs = g->shear[n][k];
      difference[0] += (p + s) * (p + s), size[0] += (gp + gs) * (gp + gs);
      difference[1] += p * p, size[1] += gp * gp;
      difference[2] += s * s, size[2] += gs * gs;
    }
  return (force_error){.total = ratio(difference[0], size[0]),
                       .pressure = ratio(difference[1], size[1]),
                       .shear = ratio(difference[2], size[2])};
}

static corot_status write_comparison(void *writer, const moment *now) {
  comparison *c = writer;
  COROT_TRY(find_force(c, now->state, now->t, now->u, "green", &c->green));
  for (int i = 0; i < c->nmeasure; i++) {
    COROT_TRY(find_force(c, now->state, now->t, now->u, c->measure[i], &c->other));
    c->error[i] = error_of(c);
  }
  return compare_row(c->table, now->t, c->nmeasure, c->error);
}

const writer_ops comparison_writer = {
    .file = "compare.csv",
    .wanted = wants_comparison,
    .open = open_comparison,
    .moment = write_comparison,
    .table = table_of_comparison,
    .close = close_comparison,
};
