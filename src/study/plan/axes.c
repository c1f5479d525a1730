/* The axes of a study: each becomes a list of points, whatever way it is written. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "study.h"

/* The value as one given for a key that is written elsewhere. */
static corot_status value_for(config *tree, const config_node *key, const char *name,
                              const config_node *value, setting *out) {
  config_node *copy = config_node_create(tree, CONFIG_SCALAR);
  if (!copy) return no_memory();
  *copy = *value;
  copy->key = name;
  copy->key_at = key->at;
  copy->parent = copy->next = NULL;
  *out = (setting){name, copy};
  return COROT_OK;
}

/* Points that set one key, or several, to values that are their coordinates as well. */
static corot_status make_points(config *tree, const config_node *node, int npoint, int nkey,
                                axis *a, setting **out) {
  axis_point *point = config_alloc(tree, (size_t)npoint, sizeof *point);
  setting *set = config_alloc(tree, (size_t)npoint * (size_t)nkey, sizeof *set);
  if (!point || !set) return no_memory();
  for (int i = 0; i < npoint; i++) {
    const setting *of_point = set + (size_t)i * (size_t)nkey;
    point[i] = (axis_point){nkey, nkey, of_point, of_point};
  }
  *a = (axis){node, npoint, point};
  *out = set;
  return COROT_OK;
}

static corot_status read_values(config *tree, config_node *node, axis *a) {
  const config_node *key = config_find(node, "key"), *list = config_find(node, "values");
  setting *set = NULL;
  COROT_TRY(make_points(tree, node, list->nchild, 1, a, &set));
  for (const config_node *c = list->child; c; c = c->next)
    COROT_TRY(value_for(tree, key, key->text, c, set++));
  return COROT_OK;
}

/* --- Values at equal ratios --- */

/* How many there are, and by how many decades one follows the other. */
static corot_status plan_log(config_node *log, int *npoint, double *decades) {
  double span = log10(config_find(log, "to")->number / config_find(log, "from")->number);
  const config_node *points = config_find(log, "points"), *dense = config_find(log, "per_decade");
  double count = points ? points->number : floor(fabs(span) * dense->number + 1e-9) + 1;
  if (!(count <= 1000)) return config_fail(log, "%g values; 1000 is the most", count);
  if (points && count < 2 && span != 0)
    return config_fail(points, "`from` and `to` differ: at least 2 points");
  *npoint = (int)count;
  *decades = points ? (count > 1 ? span / (count - 1) : 0) : copysign(1 / dense->number, span);
  return COROT_OK;
}

/* The k-th value: `from` and `to` as they are written, those between rounded to four digits. */
static corot_status log_value(config *tree, config_node *log, int k, int npoint, double decades,
                              config_node **out) {
  const config_node *from = config_find(log, "from"), *to = config_find(log, "to");
  config_node *value = config_node_create(tree, CONFIG_SCALAR);
  char text[32];
  double exact = from->number * pow(10, k * decades);
  snprintf(text, sizeof text, "%.4g", exact);
  bool last = k == npoint - 1 && fabs(exact - to->number) <= 1e-9 * to->number;
  if (!value) return no_memory();
  *value = k == 0 ? *from : last ? *to : *log;
  if (k > 0 && !last) {
    value->kind = CONFIG_SCALAR;
    value->text = config_copy(tree, text, strlen(text));
    value->child = value->last = NULL;
    value->nchild = 0;
    if (!value->text) return no_memory();
  }
  *out = value;
  return COROT_OK;
}

static corot_status read_log(config *tree, config_node *node, axis *a) {
  config_node *key = config_find(node, "key"), *log = config_find(node, "log");
  int npoint = 0;
  double decades = 0;
  setting *set = NULL;
  COROT_TRY(plan_log(log, &npoint, &decades));
  COROT_TRY(make_points(tree, node, npoint, 1, a, &set));
  for (int k = 0; k < npoint; k++) {
    config_node *value = NULL;
    COROT_TRY(log_value(tree, log, k, npoint, decades, &value));
    COROT_TRY(value_for(tree, key, key->text, value, &set[k]));
  }
  return COROT_OK;
}

/* --- Several keys together --- */

static corot_status check_zip(const config_node *zip) {
  if (zip->nchild == 0) return config_fail(zip, "the map is empty");
  for (const config_node *c = zip->child; c; c = c->next) {
    if (c->kind != CONFIG_LIST || c->nchild == 0)
      return config_fail(c, "expected a list of values");
    if (c->nchild != zip->child->nchild)
      return config_fail(c, "%d values, but %s has %d", c->nchild, zip->child->key,
                         zip->child->nchild);
  }
  return COROT_OK;
}

static corot_status read_zip(config *tree, config_node *node, axis *a) {
  const config_node *zip = config_find(node, "zip");
  COROT_TRY(check_zip(zip));
  int nkey = zip->nchild, k = 0;
  setting *set = NULL;
  COROT_TRY(make_points(tree, node, zip->child->nchild, nkey, a, &set));
  for (const config_node *list = zip->child; list; list = list->next, k++) {
    config_node key = *list;
    key.at = list->key_at;
    int i = 0;
    for (const config_node *c = list->child; c; c = c->next, i++)
      COROT_TRY(value_for(tree, &key, list->key, c, &set[i * nkey + k]));
  }
  return COROT_OK;
}

/* --- Labelled sets of keys --- */

static corot_status read_variants(config *tree, config_node *node, axis *a) {
  const config_node *list = config_find(node, "variants"), *name = config_find(node, "name");
  if (list->nchild == 0) return config_fail(list, "the list is empty");
  const char *column = name ? name->text : "variant";
  axis_point *point = config_alloc(tree, (size_t)list->nchild, sizeof *point);
  setting *place = config_alloc(tree, (size_t)list->nchild, sizeof *place);
  if (!point || !place) return no_memory();
  *a = (axis){node, list->nchild, point};
  for (config_node *c = list->child; c; c = c->next, point++, place++) {
    config_node *label = config_find(c, "label");
    for (config_node *b = list->child; b != c; b = b->next)
      if (strcmp(config_find(b, "label")->text, label->text) == 0)
        return config_fail(label, "%s is the label of another variant", label->text);
    *point = (axis_point){.nplace = 1, .place = place};
    *place = (setting){column, label};
    COROT_TRY(study_read_settings(tree, config_find(c, "set"), &point->nset, &point->set));
  }
  return COROT_OK;
}

/* --- All of them --- */

static corot_status read_axis(config *tree, config_node *node, axis *a) {
  const config_node *values = config_find(node, "values"), *log = config_find(node, "log");
  const config_node *key = config_find(node, "key"), *name = config_find(node, "name");
  const config_node *range = values ? values : log;
  if (key && !range) return config_fail_key(key, "values or log is missing");
  if (values && log) return config_fail_key(log, "values and log exclude each other");
  if (!key && range) return config_fail_key(range, "key is missing, whose values these are");
  if (key && !*key->text) return config_fail(key, "the key is empty");
  if (name && !config_find(node, "variants"))
    return config_fail_key(name, "is for variants: keys name their columns themselves");
  if (values) return read_values(tree, node, a);
  if (log) return read_log(tree, node, a);
  if (config_find(node, "zip")) return read_zip(tree, node, a);
  return read_variants(tree, node, a);
}

static bool shares_a_key(int na, const setting *a, int nb, const setting *b, const setting **key) {
  for (int i = 0; i < na; i++)
    for (int j = 0; j < nb; j++)
      if (strcmp(a[i].key, b[j].key) == 0) {
        *key = &a[i];
        return true;
      }
  return false;
}

/* Neither a column nor a key of two axes is the same; variants may set different keys. */
static corot_status check_apart(const axis *a, const axis *b) {
  const setting *key;
  for (int i = 0; i < a->npoint; i++)
    for (int j = 0; j < b->npoint; j++) {
      const axis_point *p = &a->point[i], *q = &b->point[j];
      if (shares_a_key(p->nplace, p->place, q->nplace, q->place, &key) ||
          shares_a_key(p->nset, p->set, q->nset, q->set, &key))
        return config_fail(a->node, "%s is varied by another axis, too", key->key);
    }
  return COROT_OK;
}

corot_status study_read_axes(config *tree, const config_node *list, int nabove, const axis *above,
                             int *naxis, const axis **axes) {
  axis *a = config_alloc(tree, (size_t)(nabove + list->nchild), sizeof *a);
  if (!a) return no_memory();
  int n = 0;
  for (; n < nabove; n++) a[n] = above[n];
  for (config_node *c = list->child; c; c = c->next, n++) {
    COROT_TRY(read_axis(tree, c, &a[n]));
    for (int i = 0; i < n; i++) COROT_TRY(check_apart(&a[n], &a[i]));
  }
  *naxis = n;
  *axes = a;
  return COROT_OK;
}
