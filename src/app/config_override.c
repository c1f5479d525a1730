#include <stdio.h>
#include <string.h>

#include "config.h"

static corot_status no_memory(void) { return corot_fail(COROT_ENOMEM, "out of memory"); }

/* The value, read with the whole assignment as its place. */
static corot_status parse_value(config *tree, const char *assignment, config_node **value) {
  const char *text = strchr(assignment, '=') + 1;
  size_t length = strlen(assignment);
  config_source *s = config_alloc(tree, 1, sizeof *s);
  char *name = config_alloc(tree, length + sizeof "--set ", 1);
  char *copy = config_copy(tree, text, strlen(text));
  if (!s || !name || !copy) return no_memory();
  snprintf(name, length + sizeof "--set ", "--set %s", assignment);
  *s = (config_source){.name = name, .text = copy, .size = strlen(text)};
  COROT_TRY(config_parse(tree, s, false, value));
  if (!*value) {
    *value = config_node_create(tree, CONFIG_SCALAR);
    if (!*value) return no_memory();
    (*value)->text = "";
    (*value)->source = s;
  }
  return COROT_OK;
}

/* The child of a map under this key, made if need be: a map, to be filled or replaced. */
static corot_status enter_map(config *tree, const config_source *source, config_node *map,
                              const char *key, config_node **child) {
  *child = NULL;
  for (config_node *c = map->child; c; c = c->next)
    if (strcmp(c->key, key) == 0) *child = c;
  if (*child) return COROT_OK;
  config_node *node = config_node_create(tree, CONFIG_MAP);
  if (!node) return no_memory();
  node->key = key;
  node->source = source;
  config_append(map, node);
  *child = node;
  return COROT_OK;
}

static corot_status enter_list(const config_source *source, config_node *list, const char *index,
                               config_node **child) {
  *child = strspn(index, "0123456789") == strlen(index) ? config_find(list, index) : NULL;
  if (*child) return COROT_OK;
  char path[128];
  config_path(list, sizeof path, path);
  return corot_fail(COROT_EFORMAT, "%s: %s is a list of %d; \"%s\" is no entry of it%s",
                    source->name, path, list->nchild, index,
                    list->nchild ? ", they are numbered from 0" : "");
}

/* One step from `node` towards the place to be set. */
static corot_status enter(config *tree, const config_source *source, config_node *node,
                          const char *segment, config_node **child) {
  if (node->kind == CONFIG_LIST) return enter_list(source, node, segment, child);
  if (node->kind == CONFIG_SCALAR && config_is_null(node)) node->kind = CONFIG_MAP;
  if (node->kind == CONFIG_MAP) return enter_map(tree, source, node, segment, child);
  char path[128];
  config_path(node, sizeof path, path);
  return corot_fail(COROT_EFORMAT, "%s: %s is a single value, not a map", source->name, path);
}

/* Puts `value` in the place of `node`, which keeps its key and its neighbours. */
static void replace(config_node *node, const config_node *value) {
  node->kind = value->kind;
  node->quoted = value->quoted;
  node->text = value->text;
  node->source = value->source;
  node->at = node->key_at = value->at;
  node->child = value->child;
  node->last = value->last;
  node->nchild = value->nchild;
  for (config_node *c = node->child; c; c = c->next) c->parent = node;
}

corot_status config_override(config *tree, const char *assignment) {
  size_t length = strcspn(assignment, "=");
  if (assignment[length] != '=' || length == 0)
    return corot_fail(COROT_EFORMAT, "--set %s: expected KEY=VALUE, such as integrator.rtol=1e-6",
                      assignment);
  config_node *value = NULL, *node = tree->root;
  COROT_TRY(parse_value(tree, assignment, &value));
  const config_source *source = value->source;
  char *path = config_copy(tree, assignment, length);
  if (!path) return no_memory();
  for (char *segment = path; segment;) {
    char *dot = strchr(segment, '.');
    if (dot) *dot = '\0';
    if (!*segment) return corot_fail(COROT_EFORMAT, "%s: a key is empty", source->name);
    COROT_TRY(enter(tree, source, node, segment, &node));
    segment = dot ? dot + 1 : NULL;
  }
  replace(node, value);
  return COROT_OK;
}
