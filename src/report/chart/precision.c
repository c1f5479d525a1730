/* One curve a series, error against cost, and the hull of the best. */
#include "precision.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder_owner.h"
#include "app/text/escape.h"
#include "chart.h"
#include "precision_scripts.h"
#include "report/page/save.h"

/* The points of all series, one after the other. */
typedef struct points {
  double *x, *y, *low, *high; /* [ncell] */
  chart_series *series;       /* [nseries] */
} points;

static void points_free(points *p) {
  free(p->x);
  free(p->y);
  free(p->low);
  free(p->high);
  free(p->series);
}

static corot_status collect(const precision *p, points *all) {
  const study_table *t = p->table;
  size_t n = (size_t)t->ncell + 1;
  *all = (points){
      .x = malloc(n * sizeof *all->x),
      .y = malloc(n * sizeof *all->y),
      .low = malloc(n * sizeof *all->low),
      .high = malloc(n * sizeof *all->high),
      .series = calloc((size_t)t->nseries + 1, sizeof *all->series),
  };
  if (!all->x || !all->y || !all->low || !all->high || !all->series) {
    points_free(all);
    return corot_fail(COROT_ENOMEM, "out of memory");
  }
  /* cells come sorted by series, so that the points of each stand together */
  for (int i = 0, k = 0; i < t->ncell; i++) {
    const study_cell *c = &t->cell[i];
    chart_series *s = &all->series[c->series];
    if (!s->name)
      *s = (chart_series){t->series[c->series], 0, all->x + k, all->y + k, all->low + k,
                          all->high + k};
    if (!study_cell_rated(c, p->error)) continue;
    all->x[k] = c->cost[p->cost];
    all->y[k] = fabs(c->error[p->error]);
    all->low[k] = c->low[p->cost], all->high[k] = c->high[p->cost];
    s->npoint++;
    k++;
  }
  return COROT_OK;
}

static corot_status write_svg(const void *what, FILE *out) {
  chart_write(what, out);
  return COROT_OK;
}

static corot_status draw(const precision *p, const points *all, const char *path) {
  const study_table *t = p->table;
  char note[128], label[160];
  study_left_out(t, p->error, sizeof note, note);
  study_error_label(t->error_name[p->error], sizeof label, label);
  chart c = {
      .title = *t->title ? t->title : "Work and precision",
      .note = *note ? note : NULL,
      .x = {study_cost_label[p->cost], true},
      .y = {label, true},
      .nseries = t->nseries,
      .series = all->series,
      .floor = study_floor(t, p->error),
      .floor_label = t->known[p->error] ? "floor: how far off the known value may be"
                                        : "floor: ten times what the references differ by",
  };
  return save_text(path, write_svg, &c);
}

static void csv_number(double x, FILE *out) {
  if (isfinite(x)) fprintf(out, "%.17g", x);
}

static corot_status write_csv(const void *what, FILE *out) {
  static const char *const status[] = {"rated", "failed", "missing"};
  const precision *p = what;
  const study_table *t = p->table;
  fprintf(out, "number,series,tolerance,%s,error,status,low,high,floor,id,reason\n",
          study_cost_word[p->cost]);
  for (int i = 0; i < t->ncell; i++) {
    const study_cell *c = &t->cell[i];
    const double value[] = {c->tolerance, c->cost[p->cost], fabs(c->error[p->error])};
    fprintf(out, "%d,", c->series);
    escape_csv(t->series[c->series], out);
    for (int k = 0; k < 3; k++) fputc(',', out), csv_number(value[k], out);
    bool below = c->status == STUDY_DONE && c->unrated[p->error];
    fprintf(out, ",%s,", below ? "below-floor" : status[c->status]);
    csv_number(c->low[p->cost], out), fputc(',', out);
    csv_number(c->high[p->cost], out), fputc(',', out);
    csv_number(t->floor[p->error], out), fputc(',', out);
    escape_csv(c->id, out), fputc(',', out);
    escape_csv(c->reason, out), fputc('\n', out);
  }
  return COROT_OK;
}

/* BASE with a suffix; the caller's to free. */
static char *with_suffix(const char *base, const char *suffix) {
  size_t length = strlen(base), size = length + strlen(suffix) + 1;
  char *path = malloc(size);
  if (path) snprintf(path, size, "%s%s", base, suffix);
  return path;
}

static corot_status save(const char *base, const char *suffix, save_writer *write,
                         const void *what) {
  char *path = with_suffix(base, suffix);
  if (!path) return corot_fail(COROT_ENOMEM, "%s: out of memory", base);
  corot_status status = save_text(path, write, what);
  free(path);
  return status;
}

corot_status precision_permit(const char *base) {
  static const struct {
    const char *suffix, *mark; /* by which corot's own are known */
  } file[] = {{".svg", CHART_MARK},
              {".csv", "number,series,tolerance,"},
              {".gp", "# Draws the diagram with gnuplot"},
              {".py", "Draws the diagram with matplotlib"}};
  for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
    char *path = with_suffix(base, file[i].suffix);
    if (!path) return corot_fail(COROT_ENOMEM, "%s: out of memory", base);
    corot_status status = file_permit(path, file[i].mark);
    free(path);
    COROT_TRY(status);
  }
  return COROT_OK;
}

static corot_status write_all(const precision *p, const points *all, const char *base) {
  char *svg = with_suffix(base, ".svg");
  if (!svg) return corot_fail(COROT_ENOMEM, "%s: out of memory", base);
  corot_status status = draw(p, all, svg);
  free(svg);
  COROT_TRY(status);
  const char *slash = strrchr(base, '/');
  precision_script script = {
      .table = p->table, .cost = p->cost, .error = p->error, .name = slash ? slash + 1 : base};
  COROT_TRY(save(base, ".csv", write_csv, p));
  COROT_TRY(save(base, ".gp", precision_gnuplot, &script));
  return save(base, ".py", precision_matplotlib, &script);
}

corot_status precision_write(const precision *p, const char *base) {
  points all;
  COROT_TRY(collect(p, &all));
  corot_status status = write_all(p, &all, base);
  points_free(&all);
  return status;
}
