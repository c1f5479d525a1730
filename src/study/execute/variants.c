/* Settings made into a study of their own, then carried out as one. */
#include "variants.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "store.h"
#include "study/plan/plan.h"

/* --- As a study --- */

static const config_source generated = {.name = "the variants of a scenario", .text = ""};

/* A node under `key`; in a list, NULL. */
static config_node *add(config *tree, config_node *parent, config_kind kind, const char *key) {
  config_node *node = config_node_create(tree, kind);
  if (!node) return NULL;
  node->source = &generated;
  node->key = key;
  if (parent) config_append(parent, node);
  return node;
}

static corot_status add_text(config *tree, config_node *map, const char *key, const char *text) {
  config_node *node = add(tree, map, CONFIG_SCALAR, key);
  char *copy = config_copy(tree, text, strlen(text));
  if (!node || !copy) return no_memory();
  node->text = copy;
  node->quoted = true;
  return COROT_OK;
}

static bool is_at_or_below(const char *key, const char *above) {
  size_t length = strlen(above);
  return strncmp(key, above, length) == 0 && (key[length] == '\0' || key[length] == '.');
}

/* A later setting takes the place of those of the same key and below it; what then remains may be
   applied in the order of the keys. */
static corot_status add_setting(config *tree, config_node *map, const char *assignment) {
  const char *key = NULL;
  config_node *value = NULL;
  COROT_TRY(config_parse_assignment(tree, assignment, &key, &value));
  for (config_node *c = map->child, *next; c; c = next) {
    next = c->next;
    if (is_at_or_below(c->key, key)) config_remove(c);
  }
  value->key = key;
  config_append(map, value);
  return COROT_OK;
}

static corot_status add_settings(config *tree, config_node *parent, int nset,
                                 const char *const *set) {
  config_node *map = add(tree, parent, CONFIG_MAP, "set");
  if (!map) return no_memory();
  for (int i = 0; i < nset; i++) COROT_TRY(add_setting(tree, map, set[i]));
  return COROT_OK;
}

static corot_status add_axis(config *tree, const variants *v, config_node *axes) {
  config_node *entry = add(tree, axes, CONFIG_MAP, NULL);
  if (!entry) return no_memory();
  COROT_TRY(add_text(tree, entry, "name", "run"));
  config_node *list = add(tree, entry, CONFIG_LIST, "variants");
  if (!list) return no_memory();
  for (int i = 0; i < v->nvariant; i++) {
    config_node *item = add(tree, list, CONFIG_MAP, NULL);
    if (!item) return no_memory();
    COROT_TRY(add_text(tree, item, "label", v->variant[i].label));
    COROT_TRY(add_settings(tree, item, v->variant[i].nset, v->variant[i].set));
  }
  return COROT_OK;
}

static corot_status add_title(config *tree, const variants *v) {
  const char *of = *v->scenario->title ? v->scenario->title : v->scenario->path;
  size_t size = strlen(v->what) + strlen(of) + sizeof ": ";
  char *title = config_alloc(tree, size, 1);
  if (!title) return no_memory();
  snprintf(title, size, "%s: %s", v->what, of);
  return add_text(tree, tree->root, "study", title);
}

static corot_status fill(config *tree, const variants *v) {
  tree->root = add(tree, NULL, CONFIG_MAP, NULL);
  if (!tree->root) return no_memory();
  COROT_TRY(add_title(tree, v));
  COROT_TRY(add_text(tree, tree->root, "base", v->scenario->path));
  COROT_TRY(add_settings(tree, tree->root, v->nset, v->set));
  config_node *axes = add(tree, tree->root, CONFIG_LIST, "axes");
  if (!axes) return no_memory();
  COROT_TRY(add_axis(tree, v, axes));
  return add_text(tree, tree->root, "reference", "none");
}

static corot_status make_study(const variants *v, study **out) {
  config *tree = calloc(1, sizeof *tree);
  corot_status status = tree ? fill(tree, v) : no_memory();
  if (status == COROT_OK) return study_from_tree(tree, "runs", out);
  config_destroy(tree);
  return status;
}

static corot_status plan(const variants *v, manifest **out) {
  study *s = NULL;
  COROT_TRY(make_study(v, &s));
  s->still = v->still;
  corot_status status = plan_study(s, out);
  study_destroy(s);
  return status;
}

/* --- Carrying it out --- */

static void find_runs(const variants *v, const manifest *m, int *run) {
  for (int i = 0; i < m->ncell; i++) {
    const char *label = json_string_value(json_object_get(m->cell[i].settings, "run"));
    for (int k = 0; label && k < v->nvariant; k++)
      if (strcmp(label, v->variant[k].label) == 0) run[k] = m->cell[i].run;
  }
}

corot_status variants_execute(const variants *v, const execute_options *options, manifest **out,
                              int *run, int *signal_number) {
  manifest *m = NULL;
  COROT_TRY(plan(v, &m));
  /* carry out what is missing */
  store_lock lock;
  execute_totals totals;
  corot_status status =
      store_enter(options->dir, m, options->shard, options->nshard, options->force, &lock);
  if (status == COROT_OK) {
    status = execute_study(m, options, &totals, signal_number);
    if (status == COROT_OK) status = store_check(options->dir, lock);
    store_leave(lock);
  }
  /* runs that were lost would be missing below */
  if (status == COROT_OK && totals.nlost > 0 && !*signal_number)
    status = corot_fail(COROT_EIO,
                        "%d runs stopped for reasons from outside; the same command "
                        "tries them again",
                        totals.nlost);
  if (status != COROT_OK) {
    manifest_destroy(m);
    return status;
  }
  find_runs(v, m, run);
  *out = m;
  return COROT_OK;
}
