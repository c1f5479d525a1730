/* KEY=VALUE of the command line, set into a tree as if it stood in the file. */
#include <stdio.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "config.h"

enum { NAME_MOST = 200 }; /* bytes of an assignment in messages, so that the reason has room */

/* The value, read with the whole assignment as its place. */
static corot_status parse_value(config *tree, const char *assignment, config_node **out) {
  config_node *value = NULL;
  const char *text = strchr(assignment, '=') + 1;
  int length = (int)strnlen(assignment, NAME_MOST + 1);
  config_source *s = config_alloc(tree, 1, sizeof *s);
  char *name = config_alloc(tree, NAME_MOST + sizeof "--set ...", 1);
  char *copy = config_copy(tree, text, strlen(text));
  if (!s || !name || !copy) return no_memory();
  snprintf(name, NAME_MOST + sizeof "--set ...", "--set %.*s%s", NAME_MOST, assignment,
           length > NAME_MOST ? "..." : "");
  *s = (config_source){.name = name, .text = copy, .size = strlen(text)};
  COROT_TRY(config_parse(tree, s, false, &value));
  if (!value) {
    value = config_node_create(tree, CONFIG_SCALAR);
    if (!value) return no_memory();
    value->text = "";
    value->source = s;
  }
  *out = value;
  return COROT_OK;
}

/* The child of a map under this key, made if need be: a map, to be filled or replaced. */
static corot_status enter_map(config *tree, const config_node *value, config_node *map,
                              const char *key, config_node **child) {
  *child = NULL;
  for (config_node *c = map->child; c; c = c->next)
    if (strcmp(c->key, key) == 0) *child = c;
  if (*child) return COROT_OK;
  config_node *node = config_node_create(tree, CONFIG_MAP);
  if (!node) return no_memory();
  node->key = key;
  node->source = value->source;
  node->at = node->key_at = value->key_at;
  config_append(map, node);
  *child = node;
  return COROT_OK;
}

static corot_status enter_list(const config_node *value, config_node *list, const char *index,
                               config_node **child) {
  *child = strspn(index, "0123456789") == strlen(index) ? config_find(list, index) : NULL;
  if (*child) return COROT_OK;
  char path[128];
  config_path(list, sizeof path, path);
  return config_fail_at(value->source, value->key_at,
                        "%s is a list of %d; \"%s\" is no entry of it%s", path, list->nchild, index,
                        list->nchild ? ", they are numbered from 0" : "");
}

/* One step from `node` towards the place to be set. */
static corot_status enter(config *tree, const config_node *value, config_node *node,
                          const char *segment, config_node **child) {
  if (node->kind == CONFIG_LIST) return enter_list(value, node, segment, child);
  if (node->kind == CONFIG_SCALAR && config_is_null(node)) node->kind = CONFIG_MAP;
  if (node->kind == CONFIG_MAP) return enter_map(tree, value, node, segment, child);
  char path[128];
  config_path(node, sizeof path, path);
  return config_fail_at(value->source, value->key_at, "%s is a single value, not a map", path);
}

static corot_status copy_below(config *tree, config_node *node, const config_node *from);

/* Kind, text and place of `from`, and copies of what is below it. */
static corot_status copy_value(config *tree, config_node *node, const config_node *from) {
  node->kind = from->kind;
  node->quoted = from->quoted;
  node->text = from->text;
  node->source = from->source;
  node->key_at = from->key_at;
  node->at = from->at;
  node->child = node->last = NULL;
  node->nchild = 0;
  return copy_below(tree, node, from);
}

static corot_status copy_below(config *tree, config_node *node, const config_node *from) {
  for (const config_node *c = from->child; c; c = c->next) {
    config_node *copy = config_node_create(tree, CONFIG_SCALAR);
    if (!copy) return no_memory();
    copy->key = c->key;
    COROT_TRY(copy_value(tree, copy, c));
    config_append(node, copy);
  }
  return COROT_OK;
}

corot_status config_set(config *tree, const char *path, const config_node *value) {
  config_node *node = tree->root;
  char *segment = config_copy(tree, path, strlen(path));
  if (!segment) return no_memory();
  while (segment) {
    char *dot = strchr(segment, '.');
    if (dot) *dot = '\0';
    if (!*segment) return config_fail_at(value->source, value->key_at, "a key is empty");
    COROT_TRY(enter(tree, value, node, segment, &node));
    segment = dot ? dot + 1 : NULL;
  }
  return copy_value(tree, node, value);
}

corot_status config_parse_assignment(config *tree, const char *assignment, const char **path,
                                     config_node **value) {
  size_t length = strcspn(assignment, "=");
  if (assignment[length] != '=' || length == 0)
    return corot_fail(COROT_EFORMAT, "--set %s: expected KEY=VALUE, such as integrator.rtol=1e-6",
                      assignment);
  const char *copy = config_copy(tree, assignment, length);
  if (!copy) return no_memory();
  COROT_TRY(parse_value(tree, assignment, value));
  *path = copy;
  return COROT_OK;
}

corot_status config_override(config *tree, const char *assignment) {
  const char *path = NULL;
  config_node *value = NULL;
  COROT_TRY(config_parse_assignment(tree, assignment, &path, &value));
  return config_set(tree, path, value);
}
