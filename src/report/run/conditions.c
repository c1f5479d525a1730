/* From the scenario and its groups to marks on the surface. */
#include "conditions.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "report/page/encode.h"
#include "report/read/lookup.h"

typedef struct conditions {
  const run_folder *run;
  const fields *f;
  const surface *s;
  int nframe;
  const double *t; /* [nframe] */
  int *number;     /* [f->nnode] among the surface's nodes; -1: inside */
} conditions;

/* --- Where marks stand --- */

/* Places that marks may have: faces, or nodes three times. */
typedef struct places {
  int n;
  int (*at)[3]; /* [n] nodes of the surface */
} places;

static corot_status places_create(size_t most, places *p) {
  *p = (places){.at = malloc((most + 1) * sizeof *p->at)};
  return p->at ? COROT_OK : corot_fail(COROT_ENOMEM, "%zu places: out of memory", most);
}

static void add_place(const conditions *c, const json_t *a, const json_t *b, const json_t *d,
                      places *p) {
  const json_t *node[3] = {a, b, d};
  for (int k = 0; k < 3; k++) {
    json_int_t n = json_is_integer(node[k]) ? json_integer_value(node[k]) : -1;
    if (n < 0 || n >= c->f->nnode || c->number[n] < 0) return;
    p->at[p->n][k] = c->number[n];
  }
  p->n++;
}

static corot_status find_nodes(const conditions *c, const json_t *group, places *p) {
  const json_t *list = lookup(group, "nodes");
  COROT_TRY(places_create(json_array_size(list), p));
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *n = json_array_get(list, i);
    add_place(c, n, n, n, p);
  }
  return COROT_OK;
}

static corot_status find_faces(const conditions *c, const json_t *group, places *p) {
  const json_t *list = lookup(group, "faces");
  COROT_TRY(places_create(json_array_size(list), p));
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *n = json_array_get(list, i);
    add_place(c, json_array_get(n, 0), json_array_get(n, 1), json_array_get(n, 2), p);
  }
  return COROT_OK;
}

static void middle(const conditions *c, const int at[3], double x[3]) {
  for (int i = 0; i < 3; i++) {
    x[i] = 0;
    for (int k = 0; k < 3; k++) x[i] += c->f->x[c->s->node[at[k]]][i] / 3;
  }
}

static void bounds(const conditions *c, const places *p, double low[3], double *size) {
  double high[3] = {-INFINITY, -INFINITY, -INFINITY}, x[3];
  low[0] = low[1] = low[2] = INFINITY;
  for (int i = 0; i < p->n; i++) {
    middle(c, p->at[i], x);
    for (int k = 0; k < 3; k++) low[k] = fmin(low[k], x[k]), high[k] = fmax(high[k], x[k]);
  }
  *size = 0;
  for (int k = 0; k < 3; k++) *size = fmax(*size, high[k] - low[k]);
}

static int ascending(const void *a, const void *b) {
  int p = *(const int *)a, q = *(const int *)b;
  return (p > q) - (p < q);
}

/* The number of the cube that a place is in, and how far off its middle it is. */
static int cube_of(int most, const double low[3], double size, const double x[3],
                   double *distance) {
  int cube = 0;
  *distance = 0;
  for (int k = 0; k < 3; k++) {
    double along = size > 0 ? most * (x[k] - low[k]) / size : 0;
    int cell = along < most ? (int)along : most - 1;
    cube = cube * most + cell;
    *distance += (along - cell - 0.5) * (along - cell - 0.5);
  }
  return cube;
}

/* Keeps, in each of the cubes that cut the longest side of all places into `most`, the place that
   is nearest to the cube's middle. */
static corot_status pick(const conditions *c, int most, places *p) {
  double low[3], size, x[3];
  bounds(c, p, low, &size);
  int ncube = most * most * most, kept = 0;
  int *best = calloc((size_t)ncube, sizeof *best); /* one more than its number */
  double *off = malloc((size_t)ncube * sizeof *off);
  bool complete = best && off;
  for (int i = 0; complete && i < p->n; i++) {
    double distance;
    middle(c, p->at[i], x);
    int cube = cube_of(most, low, size, x, &distance);
    if (best[cube] && !(distance < off[cube])) continue;
    best[cube] = i + 1, off[cube] = distance;
  }
  if (complete) qsort(best, (size_t)ncube, sizeof *best, ascending);
  for (int k = 0; complete && k < ncube; k++)
    if (best[k]) memmove(p->at[kept++], p->at[best[k] - 1], sizeof *p->at);
  p->n = kept;
  free(best);
  free(off);
  return complete ? COROT_OK : corot_fail(COROT_ENOMEM, "%d cubes: out of memory", ncube);
}

/* --- What they are --- */

static double number_at(const json_t *list, size_t i) {
  const json_t *x = json_array_get(list, i);
  return json_is_number(x) ? json_number_value(x) : NAN;
}

/* "NAME: x, y held", or how it moves. */
static void describe_support(const json_t *map, size_t size, char *text) {
  const char *name = lookup_text(map, "group");
  const json_t *fix = lookup(map, "fix"), *axis = lookup(map, "rotate.axis");
  const json_t *v = lookup(map, "translate.velocity");
  if (json_is_array(fix)) {
    int used = snprintf(text, size, "%.64s: ", name);
    for (size_t i = 0; i < json_array_size(fix) && i < 3; i++) {
      const char *word = json_string_value(json_array_get(fix, i));
      used += snprintf(text + used, size - (size_t)used, "%s%.8s", i ? ", " : "", word ? word : "");
    }
    snprintf(text + used, size - (size_t)used, " held");
  } else if (axis)
    snprintf(text, size, "%.64s: turned about (%.4g, %.4g, %.4g) at %.4g rad/s", name,
             number_at(axis, 0), number_at(axis, 1), number_at(axis, 2),
             lookup_number(map, "rotate.rate"));
  else if (v)
    snprintf(text, size, "%.64s: moved at (%.4g, %.4g, %.4g) m/s", name, number_at(v, 0),
             number_at(v, 1), number_at(v, 2));
  else
    snprintf(text, size, "%.64s: moved", name);
}

/* Whether a list of words has a component; a support that moves holds all. */
static bool holds(const json_t *fix, int component) {
  if (!json_is_array(fix)) return true;
  for (size_t i = 0; i < json_array_size(fix); i++) {
    const char *word = json_string_value(json_array_get(fix, i));
    if (word && word[0] == "xyz"[component] && !word[1]) return true;
  }
  return false;
}

static corot_status write_support(const conditions *c, const json_t *map, FILE *out) {
  char text[256];
  const json_t *fix = lookup(map, "fix");
  places p;
  describe_support(map, sizeof text, text);
  COROT_TRY(find_nodes(c, json_object_get(c->run->groups, lookup_text(map, "group")), &p));
  corot_status status = pick(c, CONDITIONS_NODES, &p);
  fputs("{\"text\":", out);
  encode_text(text, out);
  fprintf(out, ",\"moving\":%s,\"held\":[%d,%d,%d],\"nodes\":[",
          json_is_array(fix) ? "false" : "true", holds(fix, 0), holds(fix, 1), holds(fix, 2));
  for (int i = 0; i < p.n; i++) fprintf(out, "%s%d", i ? "," : "", p.at[i][0]);
  fputs("]}", out);
  free(p.at);
  return status;
}

/* Piecewise linear in time, constant beyond the ends; of equal times the later value counts. NAN:
   not such a list. */
static double amplitude(const json_t *list, double t) {
  if (!list) return 1;
  size_t n = json_array_size(list), k = 0;
  if (n == 0) return NAN;
  while (k < n && number_at(json_array_get(list, k), 0) <= t) k++;
  if (k == 0) return number_at(json_array_get(list, 0), 1);
  const json_t *a = json_array_get(list, k - 1), *b = json_array_get(list, k < n ? k : k - 1);
  double ta = number_at(a, 0), tb = number_at(b, 0), va = number_at(a, 1), vb = number_at(b, 1);
  return tb > ta ? va + (vb - va) * (t - ta) / (tb - ta) : va;
}

static void write_factors(const conditions *c, const json_t *list, FILE *out) {
  bool still = run_folder_is_static(c->run);
  double end = run_folder_unit(c->run);
  if (isnan(amplitude(list, 0))) {
    fputs("null", out);
    return;
  }
  fputc('[', out);
  for (int i = 0; i < c->nframe; i++) {
    double factor = still ? c->t[i] / end * amplitude(list, end) : amplitude(list, c->t[i]);
    if (i) fputc(',', out);
    encode_number(factor, out);
  }
  fputc(']', out);
}

/* "traction on NAME: (x, y, z) Pa"; returns its vector, NULL: a pressure. */
static const json_t *describe_load(const json_t *map, size_t size, char *text) {
  static const char *const kind[][2] = {{"traction", "Pa"}, {"force", "N"}, {"gravity", "m/s^2"}};
  const char *name = lookup_text(map, "group");
  for (int k = 0; k < 3; k++) {
    const json_t *v = lookup(map, kind[k][0]);
    if (!v) continue;
    snprintf(text, size, "%s%s%.64s: (%.4g, %.4g, %.4g) %s", kind[k][0], *name ? " on " : "", name,
             number_at(v, 0), number_at(v, 1), number_at(v, 2), kind[k][1]);
    return v;
  }
  snprintf(text, size, "pressure on %.64s: %.4g Pa", name, lookup_number(map, "pressure"));
  return NULL;
}

static corot_status find_arrows(const conditions *c, const json_t *map, places *p) {
  const json_t *group = json_object_get(c->run->groups, lookup_text(map, "group"));
  if (lookup(map, "force")) return find_nodes(c, group, p);
  return find_faces(c, lookup(map, "gravity") ? NULL : group, p);
}

static corot_status write_load(const conditions *c, const json_t *map, FILE *out) {
  char text[256];
  const json_t *v = describe_load(map, sizeof text, text);
  /* where its arrows stand */
  places p;
  COROT_TRY(find_arrows(c, map, &p));
  corot_status status = pick(c, CONDITIONS_ARROWS, &p);
  /* what it is, where, and how it changes in time */
  fputs("{\"text\":", out);
  encode_text(text, out);
  fprintf(out, ",\"whole\":%s,\"vector\":", lookup(map, "gravity") ? "true" : "false");
  if (v) {
    for (size_t i = 0; i < 3; i++) {
      fputc(i ? ',' : '[', out);
      encode_number(number_at(v, i), out);
    }
    fputc(']', out);
  } else
    fputs(lookup_number(map, "pressure") < 0 ? "\"out\"" : "\"in\"", out);
  fputs(",\"at\":[", out);
  for (int i = 0; i < p.n; i++)
    fprintf(out, "%s%d,%d,%d", i ? "," : "", p.at[i][0], p.at[i][1], p.at[i][2]);
  fputs("],\"factor\":", out);
  write_factors(c, lookup(map, "amplitude"), out);
  fputc('}', out);
  free(p.at);
  return status;
}

/* --- All of them --- */

typedef corot_status writer(const conditions *c, const json_t *map, FILE *out);

static corot_status write_list(const conditions *c, const char *name, const json_t *list,
                               writer *write, FILE *out) {
  fprintf(out, ",\"%s\":[", name);
  const char *separator = "";
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *map = json_array_get(list, i);
    if (!json_is_object(map)) continue;
    fputs(separator, out);
    COROT_TRY(write(c, map, out));
    separator = ",";
  }
  fputc(']', out);
  return COROT_OK;
}

corot_status conditions_write(const run_folder *run, const fields *f, const surface *s, int nframe,
                              const double *t, FILE *out) {
  if (!run->groups) return COROT_OK;
  conditions c = {.run = run, .f = f, .s = s, .nframe = nframe, .t = t};
  c.number = malloc((size_t)f->nnode * sizeof *c.number);
  if (!c.number) return corot_fail(COROT_ENOMEM, "%d nodes: out of memory", f->nnode);
  for (int i = 0; i < f->nnode; i++) c.number[i] = -1;
  for (int i = 0; i < s->nnode && !s->stands; i++) c.number[s->node[i]] = i;
  for (int i = 0; i < f->nnode && s->stands; i++) c.number[i] = s->stands[i];
  const json_t *boundary = lookup(run->result, "scenario.boundary");
  corot_status status = write_list(&c, "supports", boundary, write_support, out);
  if (status == COROT_OK)
    status = write_list(&c, "loads", lookup(run->result, "scenario.loads"), write_load, out);
  free(c.number);
  return status;
}
