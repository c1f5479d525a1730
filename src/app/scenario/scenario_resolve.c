/* A checked tree as JSON. */
#include <stdio.h>
#include <string.h>

#include "app/text/json_text.h"
#include "scenario_keys.h"

static json_t *resolve_map(const config_node *map, const char *path);

static json_t *number(const config_node *node, bool whole) {
  return whole ? json_integer((json_int_t)node->number) : json_real(node->number);
}

/* A list, each entry made by the same rule. */
static json_t *numbers(const config_node *list, bool whole) {
  json_t *array = json_array();
  for (const config_node *c = list->child; c; c = c->next) {
    json_t *item = c->kind == CONFIG_LIST ? numbers(c, whole) : number(c, whole);
    if (json_array_append_new(array, item)) {
      json_decref(array);
      return NULL;
    }
  }
  return array;
}

static json_t *texts(const config_node *list) {
  json_t *array = json_array();
  for (const config_node *c = list->child; c; c = c->next) {
    if (json_array_append_new(array, json_string(c->text))) {
      json_decref(array);
      return NULL;
    }
  }
  return array;
}

static json_t *maps(const config_node *list, const char *path) {
  json_t *array = json_array();
  for (const config_node *c = list->child; c; c = c->next) {
    if (json_array_append_new(array, resolve_map(c, path))) {
      json_decref(array);
      return NULL;
    }
  }
  return array;
}

static json_t *named(const config_node *map, const char *path) {
  json_t *object = json_object();
  for (const config_node *c = map->child; c; c = c->next) {
    if (json_object_set_new(object, c->key, resolve_map(c, path))) {
      json_decref(object);
      return NULL;
    }
  }
  return object;
}

static json_t *named_texts(const config_node *map) {
  json_t *object = json_object();
  for (const config_node *c = map->child; c; c = c->next)
    object = json_text_with(object, c->key, json_string(c->text));
  return object;
}

/* A word, however it was written. */
static json_t *states(const config_node *node, const char *path) {
  const config_node *only = node->nchild == 1 ? node->child : NULL;
  if (node->kind == CONFIG_LIST) return maps(node, path);
  if (node->kind == CONFIG_MAP && only && strcmp(only->key, "from") == 0) node = only;
  return node->kind == CONFIG_SCALAR ? json_string(node->text) : resolve_map(node, path);
}

/* By the type of its key. */
static json_t *resolve_value(const config_node *node, const schema_key *key) {
  char inside[128];
  schema_inside(key, sizeof inside, inside);
  bool whole =
      key->type == SCHEMA_INTEGER || key->type == SCHEMA_INTEGERS || key->type == SCHEMA_COUNTS;
  switch (key->type) {
    case SCHEMA_MAP:
    case SCHEMA_SHORT:
      return resolve_map(node, inside);
    case SCHEMA_NAMED:
      return named(node, inside);
    case SCHEMA_NAMED_TEXTS:
      return named_texts(node);
    case SCHEMA_LIST:
    case SCHEMA_MAPS:
      return node->kind == CONFIG_LIST ? maps(node, inside) : resolve_map(node, inside);
    case SCHEMA_STATES:
      return states(node, inside);
    case SCHEMA_CURVE:
      return node->kind == CONFIG_MAP ? resolve_map(node, inside) : numbers(node, false);
    case SCHEMA_CHOICE:
      if (strcmp(key->words, "true|false") == 0)
        return json_boolean(strcmp(node->text, "true") == 0);
      return json_string(node->text);
    case SCHEMA_TEXT:
      return json_string(node->text);
    case SCHEMA_WORDS:
    case SCHEMA_TEXTS:
      return texts(node);
    case SCHEMA_NUMBER:
    case SCHEMA_INTEGER:
      if (key->words && strcmp(node->text, key->words) == 0) return json_string(node->text);
      return number(node, whole);
    case SCHEMA_DURATION:
      return number(node, false);
    default:
      return numbers(node, whole);
  }
}

static json_t *resolve_map(const config_node *map, const char *path) {
  json_t *object = json_object();
  for (const schema_key *k = NULL; (k = schema_child(&scenario_schema, path, k));) {
    const char *dot = strrchr(k->path, '.');
    const char *name = dot ? dot + 1 : k->path;
    const config_node *c = map->child;
    while (c && strcmp(c->key, name) != 0) c = c->next;
    if (c && json_object_set_new(object, name, resolve_value(c, k))) {
      json_decref(object);
      return NULL;
    }
  }
  return object;
}

json_t *schema_resolve(const config *tree) { return resolve_map(tree->root, ""); }
