/* What a study measures: norms of the errors, and quantities, which all of its runs are asked for,
   with what is known of their values. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/scenario_quantities.h"
#include "app/text/no_memory.h"
#include "app/text/suggest.h"
#include "study.h"

/* The measures of a study while they are read: `list` and `set` have room for all of them. */
typedef struct reading {
  study *s;
  study_quantity *list;
  setting *set; /* after those of the study */
  int nset;
} reading;

static bool is_norm(const char *text) {
  size_t length = strlen(text);
  for (const char *w = STUDY_NORMS; *w;) {
    size_t n = strcspn(w, "|");
    if (n == length && memcmp(w, text, n) == 0) return true;
    w += n + (w[n] == '|');
  }
  return false;
}

/* A word that is no quantity may have been meant for a norm. */
static corot_status no_measure(const config_node *node, size_t at) {
  char near[32] = "";
  if (!strpbrk(node->text, "(@,)")) {
    suggest_among(node->text, STUDY_NORMS "|" STUDY_TOTAL, sizeof near, near);
    if (*near) return config_fail(node, "%.64s is no measure; did you mean %s?", node->text, near);
    return config_fail(node,
                       "%.64s is no measure: expected displacement, velocity, energy, mixed, or a "
                       "quantity such as max(corner.ux)",
                       node->text);
  }
  return scenario_quantity_fail(&(quantity_def){.node = node}, at);
}

/* --- Quantities of the scenario, by name --- */

/* What the base, or the study in its place, calls by that name; NULL: nothing. The study's own. */
static corot_status find_named(const study *s, const char *name, const char **text) {
  config *base = NULL;
  COROT_TRY(config_read(s->base, &base));
  const config_node *map = config_find(base->root, "quantities"), *found = NULL;
  for (const config_node *c = map ? map->child : NULL; c; c = c->next)
    if (c->kind == CONFIG_SCALAR && strcmp(c->key, name) == 0) found = c;
  for (int i = 0; i < s->nset; i++)
    if (strncmp(s->set[i].key, "quantities.", 11) == 0 && strcmp(s->set[i].key + 11, name) == 0)
      found = s->set[i].value;
  bool is_text = found && found->kind == CONFIG_SCALAR;
  *text = is_text ? config_copy(s->tree, found->text, strlen(found->text)) : NULL;
  config_destroy(base);
  return is_text && !*text ? no_memory() : COROT_OK;
}

/* --- Quantities of the study --- */

/* The number of the quantity of that text; -1: there is none. */
static int place_of(const reading *r, const char *text) {
  for (int i = 0; i < r->s->nquantity; i++)
    if (strcmp(r->list[i].text, text) == 0) return i;
  return -1;
}

/* Appends one; `name` NULL: it has none in the scenario, and gets one by a setting. */
static corot_status append_quantity(reading *r, const config_node *node, const quantity *of,
                                    const char *name) {
  char text[QUANTITY_TEXT], key[sizeof "quantities." + QUANTITY_TEXT] = "quantities.";
  char *made = key + strlen(key);
  study *s = r->s;
  quantity_print(of, text);
  quantity_name(of, made);
  if (name) snprintf(made, QUANTITY_TEXT, "%s", name);
  for (int i = 0; i < s->nquantity; i++)
    if (strcmp(r->list[i].name, made) == 0)
      return config_fail(node, "%.64s and %.64s have one name, %s", r->list[i].text, text, made);
  const char *kept = config_copy(s->tree, key, strlen(key));
  const char *of_text = config_copy(s->tree, text, strlen(text));
  if (!kept || !of_text) return no_memory();
  if (!name) r->set[r->nset++] = (setting){kept, node};
  r->list[s->nquantity++] =
      (study_quantity){.text = of_text, .name = strchr(kept, '.') + 1, .scale = 1};
  return COROT_OK;
}

/* The number of the quantity that is written so, or called so in the scenario, where it is
   appended if need be; -1: nobody measures it. */
static corot_status find_quantity(reading *r, const config_node *node, const char *written,
                                  int *place) {
  quantity q;
  size_t at;
  char text[QUANTITY_TEXT];
  const char *named = NULL;
  *place = -1;
  if (quantity_parse(written, &q, &at) != COROT_OK) {
    COROT_TRY(find_named(r->s, written, &named));
    if (!named || quantity_parse(named, &q, &at) != COROT_OK) return COROT_OK;
  }
  quantity_print(&q, text);
  *place = place_of(r, text);
  if (*place >= 0 || !named) return COROT_OK;
  *place = r->s->nquantity;
  return append_quantity(r, node, &q, written);
}

/* One entry of `measure`; *measure: what cells are compared by if it is the first. */
static corot_status read_measure(reading *r, const config_node *node, const char **measure) {
  quantity q;
  size_t at;
  int place;
  *measure = node->text;
  if (is_norm(node->text)) {
    if (r->s->still && strcmp(node->text, "velocity") == 0)
      return config_fail(node, "nothing moves in a static study");
    return COROT_OK;
  }
  if (strcmp(node->text, STUDY_TOTAL) == 0) return COROT_OK;
  corot_status status = quantity_parse(node->text, &q, &at);
  COROT_TRY(find_quantity(r, node, node->text, &place));
  if (place < 0 && status != COROT_OK) {
    (void)quantity_parse(node->text, &q, &at); /* the reason once more */
    return no_measure(node, at);
  }
  if (place < 0) {
    place = r->s->nquantity;
    COROT_TRY(append_quantity(r, node, &q, NULL));
  }
  *measure = r->list[place].text;
  return COROT_OK;
}

/* --- Known values --- */

/* What may have been meant: a quantity that is measured, or a name of the base's. */
static corot_status no_quantity(const reading *r, const config_node *node) {
  config *base = NULL;
  COROT_TRY(config_read(r->s->base, &base));
  const config_node *map = config_find(base->root, "quantities");
  size_t most = (size_t)(r->s->nquantity + (map ? map->nchild : 0)) + 1;
  const char **word = calloc(most, sizeof *word);
  int n = 0;
  for (int i = 0; word && i < r->s->nquantity; i++) word[n++] = r->list[i].text;
  for (const config_node *c = word && map ? map->child : NULL; c; c = c->next) word[n++] = c->key;
  const char *near = word ? suggest(node->key, n, word) : NULL;
  corot_status status =
      !word  ? no_memory()
      : near ? config_fail_key(node, "%.64s is not measured; did you mean %.64s?", node->key, near)
             : config_fail_key(node,
                               "%.64s is not measured: expected a quantity of measure, or the name "
                               "of one of the scenario's",
                               node->key);
  free(word);
  config_destroy(base);
  return status;
}

static corot_status read_known(reading *r, config_node *node) {
  const config_node *value = config_find(node, "value");
  double scale = config_find(node, "scale")->number;
  int place;
  COROT_TRY(find_quantity(r, node, node->key, &place));
  if (place < 0) return no_quantity(r, node);
  study_quantity *q = &r->list[place];
  if (q->known) return config_fail_key(node, "%.64s has a known value already", q->text);
  if (value->number == 0 && scale == 0)
    return config_fail(value, "no error is relative to 0: a known value of 0 wants a scale");
  q->known = true;
  q->value = value->number;
  q->within = config_find(node, "within")->number;
  q->scale = scale > 0 ? scale : fabs(value->number);
  return COROT_OK;
}

/* --- All of it --- */

/* Whether the text of an entry is of something with a known value. */
static bool is_known(const reading *r, const char *measure) {
  int place = place_of(r, measure);
  return strcmp(measure, STUDY_TOTAL) == 0 || (place >= 0 && r->list[place].known);
}

static corot_status read_all(reading *r, const config_node *entries, config_node *known) {
  study *s = r->s;
  const char **measure = config_alloc(s->tree, (size_t)entries->nchild, sizeof *measure);
  if (!measure) return no_memory();
  /* with known values and nothing else said it is their total that is measured */
  bool open = !entries->source && known->nchild > 0;
  measure[0] = STUDY_TOTAL;
  int n = open;
  for (const config_node *c = open ? NULL : entries->child; c; c = c->next) {
    COROT_TRY(read_measure(r, c, &measure[n++]));
    if (known->nchild == 0 && strcmp(c->text, STUDY_TOTAL) == 0)
      return config_fail(c, "total is of known values: reference.known has none");
  }
  for (config_node *c = known->child; c; c = c->next) COROT_TRY(read_known(r, c));
  s->measure = measure[0];
  s->all_known = known->nchild > 0;
  for (int i = 0; i < n; i++) s->all_known &= is_known(r, measure[i]);
  return COROT_OK;
}

corot_status study_read_measures(study *s) {
  const config_node *entries = config_find(s->tree->root, "measure");
  config_node *known = config_find(s->tree->root, "reference.known");
  size_t n = (size_t)entries->nchild + (size_t)known->nchild;
  reading r = {.s = s, .nset = s->nset};
  r.list = config_alloc(s->tree, n, sizeof *r.list);
  r.set = config_alloc(s->tree, n + (size_t)s->nset, sizeof *r.set);
  if (!r.list || !r.set) return no_memory();
  for (int i = 0; i < s->nset; i++) r.set[i] = s->set[i];
  COROT_TRY(read_all(&r, entries, known));
  s->quantity = r.list;
  s->nset = r.nset;
  s->set = r.set;
  return COROT_OK;
}
