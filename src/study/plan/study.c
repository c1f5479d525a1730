/* Reads the tree of a file, which the schema has checked, into a study. */
#include "study.h"

#include <stdlib.h>
#include <string.h>

#include "app/command/cli.h"
#include "app/text/no_memory.h"

/* The file's name without folder and ending. */
static const char *name_of(config *tree, const char *path) {
  const char *slash = strrchr(path, '/');
  const char *name = slash ? slash + 1 : path;
  const char *dot = strrchr(name, '.');
  return config_copy(tree, name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
}

/* The base must be there, and be a scenario. */
static corot_status check_base(const study *s) {
  config *base = NULL;
  corot_status status = config_read(s->base, &base);
  if (read_failure(status, s->base) == COROT_EFORMAT && status == COROT_EIO)
    return config_fail(s->base_node, "%s", corot_error());
  COROT_TRY(status);
  bool is_study = false;
  for (const config_node *c = base->root->child; c; c = c->next)
    is_study |= schema_find(&study_schema, c->key) && !schema_find(&scenario_schema, c->key);
  config_destroy(base);
  if (!is_study) return COROT_OK;
  return config_fail(s->base_node, "%s is a study itself; a base is a scenario", s->base);
}

static corot_status read_heads(study *s, const char *path) {
  config_node *root = s->tree->root;
  s->title = config_find(root, "study")->text;
  s->base_node = config_find(root, "base");
  s->path = config_copy(s->tree, path, strlen(path));
  s->name = name_of(s->tree, path);
  s->base = config_beside(s->tree, path, s->base_node->text);
  if (!s->path || !s->name || !s->base) return no_memory();
  if (!*s->title) return config_fail(config_find(root, "study"), "the title is empty");
  s->still = strcmp(config_find(root, "static")->text, "true") == 0;
  s->repeat = (int)config_find(root, "repeat")->number;
  s->tolerance = config_find(root, "tolerance");
  s->group = config_find(root, "group");
  s->cost = config_find(root, "cost")->text;
  return check_base(s);
}

/* Whether somebody has said how references are run. */
static bool asks_for_runs(config_node *reference) {
  static const char *const key[] = {"use", "rtol", "methods", "set"};
  bool asks = false;
  for (size_t i = 0; i < sizeof key / sizeof *key; i++)
    asks |= config_find(reference, key[i])->source != NULL;
  return asks;
}

static corot_status read_reference(study *s) {
  config_node *node = config_find(s->tree->root, "reference");
  const config_node *methods = config_find(node, "methods");
  s->referred =
      strcmp(config_find(node, "use")->text, "auto") == 0 && (!s->all_known || asks_for_runs(node));
  if (methods->nchild != 2)
    return config_fail(methods, "two methods: how far they agree is what is known");
  if (s->still && methods->source)
    return config_fail(methods, "a static study has no methods: its references are Newton's");
  s->reference_is_own = strcmp(config_find(node, "mesh")->text, "own") == 0;
  COROT_TRY(study_read_settings(s->tree, config_find(node, "set"), &s->nreference_set,
                                &s->reference_set));
  s->reference_is_open = !methods->source;
  for (int i = 0; i < s->nreference_set; i++)
    if (strncmp(s->reference_set[i].key, "integrator", 10) == 0) s->reference_is_open = false;
  s->reference_method[0] = methods->child->text;
  s->reference_method[1] = methods->last->text;
  s->reference_rtol = config_find(node, "rtol")->number;
  return COROT_OK;
}

/* The entries of one list after those of the other. */
static corot_status join(config *tree, const config_node *a, const config_node *b, int *n,
                         const config_node *const **out) {
  int count = a->nchild + (b ? b->nchild : 0);
  const config_node **entry = config_alloc(tree, (size_t)count + 1, sizeof *entry);
  if (!entry) return no_memory();
  int k = 0;
  for (const config_node *c = a->child; c; c = c->next) entry[k++] = c;
  for (const config_node *c = b ? b->child : NULL; c; c = c->next) entry[k++] = c;
  *n = count;
  *out = entry;
  return COROT_OK;
}

/* One grid; `node` NULL: the one of a study that has no list of them. */
static corot_status read_grid(study *s, config_node *node, int nabove, const axis *above, grid *g) {
  config_node *root = s->tree->root;
  const config_node *exclude = node ? config_find(node, "exclude") : NULL;
  COROT_TRY(join(s->tree, config_find(root, "exclude"), exclude, &g->nexclude, &g->exclude));
  g->naxis = nabove;
  g->axis = above;
  if (node) {
    COROT_TRY(study_read_settings(s->tree, config_find(node, "set"), &g->nset, &g->set));
    COROT_TRY(
        study_read_axes(s->tree, config_find(node, "axes"), nabove, above, &g->naxis, &g->axis));
  }
  if (g->naxis == 0) return config_fail_key(node ? node : root, "axes is missing: nothing varies");
  return COROT_OK;
}

static corot_status read_grids(study *s) {
  config_node *root = s->tree->root, *list = config_find(root, "grids");
  int nabove;
  const axis *above;
  COROT_TRY(study_read_axes(s->tree, config_find(root, "axes"), 0, NULL, &nabove, &above));
  grid *g = config_alloc(s->tree, (size_t)list->nchild + 1, sizeof *g);
  if (!g) return no_memory();
  s->grid = g;
  if (!list->child) COROT_TRY(read_grid(s, NULL, nabove, above, &g[s->ngrid++]));
  for (config_node *c = list->child; c; c = c->next)
    COROT_TRY(read_grid(s, c, nabove, above, &g[s->ngrid++]));
  return COROT_OK;
}

static corot_status check_kind(config_node *root) {
  const config_node *mesh = config_find(root, "mesh");
  if (!mesh || config_find(root, "base")) return COROT_OK;
  return config_fail_key(mesh,
                         "this is a scenario; a study names one as its base, and what varies");
}

static corot_status read_all(study *s, const char *path) {
  COROT_TRY(check_kind(s->tree->root));
  COROT_TRY(schema_apply(&study_schema, s->tree));
  COROT_TRY(read_heads(s, path));
  COROT_TRY(study_read_settings(s->tree, config_find(s->tree->root, "set"), &s->nset, &s->set));
  COROT_TRY(study_read_measures(s));
  COROT_TRY(read_reference(s));
  COROT_TRY(read_grids(s));
  return study_make_cells(s);
}

corot_status study_from_tree(config *tree, const char *path, study **out) {
  study *s = calloc(1, sizeof *s);
  if (!s) {
    config_destroy(tree);
    return no_memory();
  }
  s->tree = tree;
  corot_status status = read_all(s, path);
  if (status == COROT_OK)
    *out = s;
  else
    study_destroy(s);
  return status;
}

corot_status study_read(const char *path, study **out) {
  config *tree = NULL;
  COROT_TRY(config_read(path, &tree));
  return study_from_tree(tree, path, out);
}

corot_status study_read_text(const char *path, const char *text, size_t size, study **out) {
  config *tree = NULL;
  COROT_TRY(config_read_text(path, text, size, &tree));
  return study_from_tree(tree, path, out);
}

void study_destroy(study *s) {
  if (!s) return;
  json_decref(s->pilot);
  config_destroy(s->tree);
  free(s);
}
