/* From grids to cells: all combinations, less those excluded, in an order that does not depend on
   how the file is written. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "app/text/suggest.h"
#include "app/text/text_stream.h"
#include "study.h"

enum { MAX_CELLS = 100000, MAX_COLUMNS = 64 };

/* --- Columns --- */

typedef struct columns {
  int n;
  const char *name[MAX_COLUMNS];
} columns;

static bool has_column(const columns *c, const char *name) {
  for (int i = 0; i < c->n; i++)
    if (strcmp(c->name[i], name) == 0) return true;
  return false;
}

static corot_status add_columns(const grid *g, columns *c) {
  for (int i = 0; i < g->naxis; i++)
    for (int k = 0; k < g->axis[i].point->nplace; k++) {
      const char *name = g->axis[i].point->place[k].key;
      if (has_column(c, name)) continue;
      if (c->n == MAX_COLUMNS)
        return config_fail(g->axis[i].node, "more than %d columns", MAX_COLUMNS);
      c->name[c->n++] = name;
    }
  return COROT_OK;
}

/* Fails at a node that should name a column and does not. */
static corot_status no_column(const config_node *node, bool key, const char *name,
                              const columns *c) {
  char known[512] = "";
  size_t used = 0;
  for (int i = 0; i < c->n && used < sizeof known; i++)
    used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", c->name[i]);
  const char *near = suggest(name, c->n, c->name);
  corot_status (*fail)(const config_node *, const char *, ...) =
      key ? config_fail_key : config_fail;
  if (near) return fail(node, "no axis varies %.64s; did you mean %s?", name, near);
  return fail(node, "no axis varies %.64s; those varied are: %s", name, known);
}

static corot_status check_names(const config_node *list, const columns *c) {
  for (const config_node *name = list ? list->child : NULL; name; name = name->next)
    if (!has_column(c, name->text)) return no_column(name, false, name->text, c);
  return COROT_OK;
}

static corot_status check_exclude(const grid *g, const columns *c) {
  for (int i = 0; i < g->nexclude; i++) {
    const config_node *entry = g->exclude[i];
    if (entry->nchild == 0) return config_fail(entry, "an empty entry excludes everything");
    for (const config_node *n = entry->child; n; n = n->next)
      if (!has_column(c, n->key)) return no_column(n, true, n->key, c);
  }
  return COROT_OK;
}

static corot_status check_columns(const study *s) {
  columns all = {0};
  for (int i = 0; i < s->ngrid; i++) COROT_TRY(add_columns(&s->grid[i], &all));
  for (int i = 0; i < s->ngrid; i++) COROT_TRY(check_exclude(&s->grid[i], &all));
  COROT_TRY(check_names(s->group, &all));
  return s->tolerance->source ? check_names(s->tolerance, &all) : COROT_OK;
}

/* --- One cell --- */

static const setting *coordinate(const cell *c, const char *column) {
  for (int i = 0; i < c->nplace; i++)
    if (strcmp(c->place[i].key, column) == 0) return &c->place[i];
  return NULL;
}

static bool is_excluded(const grid *g, const cell *c) {
  for (int i = 0; i < g->nexclude; i++) {
    bool match = true;
    for (const config_node *n = g->exclude[i]->child; n && match; n = n->next) {
      const setting *p = coordinate(c, n->key);
      match = p && study_same_value(p->value, n);
    }
    if (match) return true;
  }
  return false;
}

static int by_key(const void *a, const void *b) {
  return strcmp(((const setting *)a)->key, ((const setting *)b)->key);
}

/* The cell at one combination of points. What the study sets comes first, then what the grid does,
   then what the axes do, in the order of the keys: a map before what is in it. */
static corot_status place_cell(study *s, const grid *g, const int *at, cell *out) {
  int nplace = 0, naxis_set = 0, below = s->nset + g->nset;
  for (int i = 0; i < g->naxis; i++) {
    nplace += g->axis[i].point[at[i]].nplace;
    naxis_set += g->axis[i].point[at[i]].nset;
  }
  setting *place = config_alloc(s->tree, (size_t)nplace, sizeof *place);
  setting *set = config_alloc(s->tree, (size_t)(below + naxis_set), sizeof *set);
  if (!place || !set) return no_memory();
  *out = (cell){.nplace = nplace, .place = place, .nset = below + naxis_set, .set = set};

  for (int i = 0; i < below; i++) set[i] = i < s->nset ? s->set[i] : g->set[i - s->nset];
  setting *next_place = place, *next = set + below;
  for (int i = 0; i < g->naxis; i++) {
    const axis_point *p = &g->axis[i].point[at[i]];
    for (int k = 0; k < p->nplace; k++) *next_place++ = p->place[k];
    for (int k = 0; k < p->nset; k++) *next++ = p->set[k];
  }
  qsort(place, (size_t)nplace, sizeof *place, by_key);
  qsort(set + below, (size_t)naxis_set, sizeof *set, by_key);
  return COROT_OK;
}

static void find_tolerance(const study *s, cell *c) {
  double number;
  for (const config_node *k = s->tolerance->child; k && !c->tolerance; k = k->next) {
    const setting *p = coordinate(c, k->text);
    if (p && config_parse_number(p->value, &number)) c->tolerance = p;
  }
}

static bool names_series(const study *s, const cell *c, const setting *place) {
  if (!s->group) return place != c->tolerance;
  for (const config_node *name = s->group->child; name; name = name->next)
    if (strcmp(name->text, place->key) == 0) return true;
  return false;
}

/* Words stand for themselves, numbers need their key: "cvode, max_order 2". */
static corot_status describe(config *tree, const setting *place, FILE *out) {
  double number;
  const char *dot = strrchr(place->key, '.'), *text;
  const char *name = dot ? dot + 1 : place->key;
  if (config_parse_number(place->value, &number)) {
    fprintf(out, "%s %.6g", name, number);
  } else if (place->value->kind == CONFIG_SCALAR && !config_is_null(place->value)) {
    fputs(place->value->text, out);
  } else {
    COROT_TRY(study_value_text(tree, place->value, &text));
    fprintf(out, "%s %s", name, text);
  }
  return COROT_OK;
}

static corot_status name_series(study *s, cell *c) {
  char *buffer = NULL;
  size_t size = 0;
  FILE *out = text_open(&buffer, &size);
  if (!out) return no_memory();
  corot_status status = COROT_OK;
  const char *separator = "";
  for (int i = 0; i < c->nplace && status == COROT_OK; i++) {
    if (!names_series(s, c, &c->place[i])) continue;
    fputs(separator, out);
    status = describe(s->tree, &c->place[i], out);
    separator = ", ";
  }
  bool written = text_close(out) == 0;
  if (written && status == COROT_OK) c->series = size ? config_copy(s->tree, buffer, size) : "all";
  free(buffer);
  if (status != COROT_OK) return status;
  return c->series ? COROT_OK : no_memory();
}

/* --- All of them --- */

/* The next combination, the last axis fastest; false: there is none. */
static bool advance(const grid *g, int *at) {
  for (int i = g->naxis - 1; i >= 0; i--) {
    if (++at[i] < g->axis[i].npoint) return true;
    at[i] = 0;
  }
  return false;
}

static corot_status add_grid(study *s, const grid *g) {
  int *at = config_alloc(s->tree, (size_t)g->naxis + 1, sizeof *at);
  if (!at) return no_memory();
  do {
    cell *c = &s->cell[s->ncell];
    COROT_TRY(place_cell(s, g, at, c));
    if (is_excluded(g, c)) continue;
    find_tolerance(s, c);
    COROT_TRY(name_series(s, c));
    s->ncell++;
  } while (advance(g, at));
  return COROT_OK;
}

static double tolerance_of(const cell *c) {
  return c->tolerance ? study_tolerance(c->tolerance) : 0;
}

/* By series, from coarse to fine in each by one kind of tolerance, then by the coordinates. */
static int by_place(const void *first, const void *second) {
  const cell *a = first, *b = second;
  int order = strcmp(a->series, b->series);
  if (order != 0) return order;
  order = strcmp(a->tolerance ? a->tolerance->key : "", b->tolerance ? b->tolerance->key : "");
  if (order != 0) return order;
  double x = tolerance_of(a), y = tolerance_of(b);
  if (x != y) return x > y ? -1 : 1;
  for (int i = 0; i < a->nplace && i < b->nplace; i++) {
    order = strcmp(a->place[i].key, b->place[i].key);
    if (order == 0) order = study_compare_values(a->place[i].value, b->place[i].value);
    if (order != 0) return order;
  }
  return a->nplace - b->nplace;
}

static bool same_settings(const cell *a, const cell *b) {
  bool same = a->nset == b->nset;
  for (int i = 0; same && i < a->nset; i++)
    same = strcmp(a->set[i].key, b->set[i].key) == 0 &&
           study_same_value(a->set[i].value, b->set[i].value);
  return same;
}

/* Grids may have cells in common, but not cells that a table could not tell apart. */
static corot_status merge_cells(study *s) {
  int n = 0;
  for (int i = 0; i < s->ncell; i++) {
    if (n > 0 && by_place(&s->cell[n - 1], &s->cell[i]) == 0) {
      if (same_settings(&s->cell[n - 1], &s->cell[i])) continue;
      return config_fail_key(config_find(s->tree->root, "grids"),
                             "the same cell of the axes (%s) is set differently by two grids: "
                             "what they differ in must be an axis",
                             s->cell[i].series);
    }
    s->cell[n++] = s->cell[i];
  }
  s->ncell = n;
  return COROT_OK;
}

corot_status study_make_cells(study *s) {
  COROT_TRY(check_columns(s));
  double most = 0;
  for (int i = 0; i < s->ngrid; i++) {
    double points = 1;
    for (int k = 0; k < s->grid[i].naxis; k++) points *= s->grid[i].axis[k].npoint;
    most += points;
  }
  if (most > MAX_CELLS)
    return config_fail(s->tree->root, "%g combinations; %d is the most", most, MAX_CELLS);
  s->cell = config_alloc(s->tree, (size_t)most, sizeof *s->cell);
  if (!s->cell) return no_memory();
  for (int i = 0; i < s->ngrid; i++) COROT_TRY(add_grid(s, &s->grid[i]));
  if (s->ncell == 0)
    return config_fail_key(config_find(s->tree->root, "exclude"), "nothing is left to run");
  qsort(s->cell, (size_t)s->ncell, sizeof *s->cell, by_place);
  return merge_cells(s);
}
