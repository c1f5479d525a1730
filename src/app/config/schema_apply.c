/* A tree held against the table: types, ranges, missing and unknown keys, defaults. */
#include <stdio.h>
#include <string.h>

#include "app/text/suggest.h"
#include "schema.h"
#include "schema_number.h"

enum { PATH = 128, LIST = 512 };

/* A tree on its way through a table. */
typedef struct application {
  const schema *table;
  config *tree;
} application;

static corot_status apply_map(const application *a, config_node *map, const char *path);

/* --- Words for messages --- */

static const char *last_segment(const char *path) {
  const char *dot = strrchr(path, '.');
  return dot ? dot + 1 : path;
}

/* "a|b|c" as "a, b, c". */
static void comma_list(const char *words, size_t size, char *list) {
  size_t used = 0;
  for (; *words && used + 3 < size; words++) {
    if (*words == '|') list[used++] = ',';
    list[used++] = *words == '|' ? ' ' : *words;
  }
  list[used] = '\0';
}

/* The keys of a map as "a|b|c". */
static void keys_of(const schema *table, const char *path, size_t size, char *words) {
  size_t used = 0;
  words[0] = '\0';
  for (const schema_key *k = NULL; (k = schema_child(table, path, k)) && used < size;)
    used +=
        (size_t)snprintf(words + used, size - used, "%s%s", used ? "|" : "", last_segment(k->path));
}

static bool among(const char *word, const char *words) {
  size_t length = strlen(word);
  while (words && *words) {
    size_t n = strcspn(words, "|");
    if (n == length && memcmp(word, words, n) == 0) return true;
    words += n + (words[n] == '|');
  }
  return false;
}

static const char *synonym(const schema *table, const char *path, const char *key) {
  for (int i = 0; i < table->nsynonym; i++) {
    const schema_synonym *s = &table->synonym[i];
    if (strcmp(s->path, path) == 0 && strcmp(s->key, key) == 0) return s->name;
  }
  return NULL;
}

static corot_status unknown_key(const schema *table, const config_node *node, const char *path) {
  char words[LIST], list[LIST], near[PATH];
  const char *meant = synonym(table, path, node->key);
  if (meant) return config_fail_key(node, "unknown key; did you mean %s?", meant);
  keys_of(table, path, sizeof words, words);
  suggest_among(node->key, words, sizeof near, near);
  if (*near) return config_fail_key(node, "unknown key; did you mean %s?", near);
  for (int i = 0; i < table->nkey; i++)
    if (strcmp(last_segment(table->key[i].path), node->key) == 0)
      return config_fail_key(node, "unknown key here; did you mean %s?", table->key[i].path);
  comma_list(words, sizeof list, list);
  return config_fail_key(node, "unknown key; known here: %s", list);
}

/* --- Numbers --- */

typedef corot_status check_function(config_node *node, schema_demand wanted);

static corot_status check_entries(config_node *list, schema_demand wanted, check_function *check) {
  for (config_node *c = list->child; c; c = c->next) COROT_TRY(check(c, wanted));
  return COROT_OK;
}

/* A number or whole number, or the one word that stands for zero. */
static corot_status check_scalar(config_node *node, const schema_key *key, check_function *check) {
  if (key->words && node->kind == CONFIG_SCALAR && strcmp(node->text, key->words) == 0)
    return COROT_OK;
  double ignored;
  size_t digits;
  if (key->words && !config_parse_number(node, &ignored) && !schema_unit_behind(node, &digits)) {
    char what[64];
    snprintf(what, sizeof what, "a number or %s", key->words);
    return schema_expected(node, what);
  }
  return check(node, (schema_demand){key->range, key->unit});
}

/* --- Other values --- */

static corot_status check_text(const config_node *node) {
  if (node->kind != CONFIG_SCALAR) return schema_expected(node, "text");
  return COROT_OK;
}

static corot_status check_choice(const config_node *node, const schema_key *key) {
  char list[LIST], near[PATH];
  comma_list(key->words, sizeof list, list);
  if (node->kind != CONFIG_SCALAR) return schema_expected(node, list);
  if (among(node->text, key->words)) return COROT_OK;
  suggest_among(node->text, key->words, sizeof near, near);
  if (*near) return config_fail(node, "unknown: %.40s; did you mean %s?", node->text, near);
  return config_fail(node, "expected one of %s; found %.40s", list, node->text);
}

static corot_status check_three(config_node *node, const schema_key *key, check_function *check) {
  bool whole = key->type == SCHEMA_COUNTS;
  if (node->kind != CONFIG_LIST || node->nchild != 3)
    return schema_expected(node, whole ? "three whole numbers, such as [2, 2, 12]"
                                       : "three numbers, such as [0.0, 0.0, -9.81]");
  return check_entries(node, (schema_demand){key->range, key->unit}, check);
}

static corot_status check_integers(config_node *node, const schema_key *key) {
  if (node->kind != CONFIG_LIST || node->nchild == 0)
    return schema_expected(node, "a list of whole numbers, such as [3, 39, 64]");
  return check_entries(node, (schema_demand){key->range, key->unit}, schema_check_integer);
}

static corot_status check_words(const config_node *node, const schema_key *key) {
  if (node->kind != CONFIG_LIST || node->nchild == 0) {
    char list[LIST], what[LIST + 32];
    comma_list(key->words, sizeof list, list);
    snprintf(what, sizeof what, "a list of words, such as [%s]", list);
    return schema_expected(node, what);
  }
  for (const config_node *c = node->child; c; c = c->next) {
    COROT_TRY(check_choice(c, key));
    for (const config_node *before = node->child; before != c; before = before->next)
      if (strcmp(before->text, c->text) == 0) return config_fail(c, "%s is given twice", c->text);
  }
  return COROT_OK;
}

static corot_status check_pairs(config_node *node) {
  if (node->kind != CONFIG_LIST || node->nchild == 0)
    return schema_expected(node,
                           "a list of [time, value], such as [[0.0, 0.0], [10.0, 1.0]], or a map");
  for (config_node *c = node->child; c; c = c->next) {
    if (c->kind != CONFIG_LIST || c->nchild != 2) return schema_expected(c, "a pair [time, value]");
    COROT_TRY(schema_check_number(c->child, (schema_demand){SCHEMA_ANY, "s"}));
    COROT_TRY(schema_check_number(c->last, (schema_demand){SCHEMA_ANY, ""}));
  }
  return COROT_OK;
}

static corot_status check_values(const config_node *node) {
  if (node->kind != CONFIG_LIST) return schema_expected(node, "a list of values, such as [1, 2]");
  if (node->nchild == 0) return config_fail(node, "the list is empty");
  return COROT_OK;
}

static corot_status check_open(const config_node *node) {
  if (node->kind != CONFIG_MAP) return schema_expected(node, "a map");
  for (const config_node *c = node->child; c; c = c->next)
    if (!*c->key) return config_fail_key(c, "a key is empty");
  return COROT_OK;
}

static corot_status check_opens(const config_node *node) {
  if (node->kind != CONFIG_LIST)
    return schema_expected(node, "a list of maps, each begun by \"- \"");
  for (const config_node *c = node->child; c; c = c->next) COROT_TRY(check_open(c));
  return COROT_OK;
}

/* A value that stands alone becomes the first in a list or map. */
static corot_status wrap(const application *a, config_node *node, config_kind kind,
                         const char *key) {
  config_node *value = config_node_create(a->tree, CONFIG_SCALAR);
  if (!value) return corot_fail(COROT_ENOMEM, "out of memory");
  *value = *node;
  value->key = key;
  node->kind = kind;
  config_append(node, value);
  return COROT_OK;
}

static corot_status apply_texts(const application *a, config_node *node) {
  if (node->kind == CONFIG_SCALAR) COROT_TRY(wrap(a, node, CONFIG_LIST, NULL));
  if (node->kind != CONFIG_LIST || node->nchild == 0)
    return schema_expected(node, "a text, or a list");
  for (const config_node *c = node->child; c; c = c->next) COROT_TRY(check_text(c));
  return COROT_OK;
}

/* --- Maps --- */

typedef corot_status apply_function(const application *a, config_node *node, const char *path);

static corot_status apply_named(const application *a, config_node *map, const char *path,
                                apply_function *apply) {
  if (map->kind != CONFIG_MAP) return schema_expected(map, "a map of names");
  for (config_node *c = map->child; c; c = c->next) {
    corot_status status = *c->key ? apply(a, c, path) : config_fail_key(c, "a name is empty");
    COROT_TRY(config_keep(a->tree, status));
  }
  return COROT_OK;
}

/* Names without a text are dropped. */
static corot_status apply_named_texts(config_node *map) {
  if (map->kind != CONFIG_MAP) return schema_expected(map, "a map of names");
  for (config_node *c = map->child, *next; c; c = next) {
    next = c->next;
    if (!*c->key) return config_fail_key(c, "a name is empty");
    COROT_TRY(check_text(c));
    if (config_is_null(c)) config_remove(c);
  }
  return COROT_OK;
}

static corot_status apply_list(const application *a, config_node *list, const char *path) {
  if (list->kind != CONFIG_LIST)
    return schema_expected(list, "a list of maps, each begun by \"- \"");
  for (config_node *c = list->child; c; c = c->next)
    COROT_TRY(config_keep(a->tree, apply_map(a, c, path)));
  return COROT_OK;
}

static corot_status apply_maps(const application *a, config_node *node, const char *path) {
  if (node->kind == CONFIG_MAP) return apply_map(a, node, path);
  if (node->kind != CONFIG_LIST || node->nchild == 0)
    return schema_expected(node, "a map or a list of maps");
  return apply_list(a, node, path);
}

/* A single value becomes a map of its own with that value under the first key. */
static corot_status expand_short(const application *a, config_node *node, const char *path) {
  if (node->kind != CONFIG_SCALAR) return COROT_OK;
  return wrap(a, node, CONFIG_MAP, last_segment(schema_child(a->table, path, NULL)->path));
}

static corot_status apply_curve(const application *a, config_node *node, const char *path) {
  return node->kind == CONFIG_MAP ? apply_map(a, node, path) : check_pairs(node);
}

static corot_status apply_states(const application *a, config_node *node, const schema_key *key) {
  return node->kind == CONFIG_SCALAR ? check_choice(node, key) : apply_maps(a, node, key->path);
}

static corot_status apply_short(const application *a, config_node *node, const char *path) {
  COROT_TRY(expand_short(a, node, path));
  return apply_map(a, node, path);
}

corot_status schema_expand(const schema *table, config *tree) {
  application a = {.table = table, .tree = tree};
  const schema_key *key = NULL;
  while ((key = schema_child(table, "", key))) {
    bool expands = key->type == SCHEMA_SHORT || key->type == SCHEMA_STATES;
    config_node *node = expands ? config_find(tree->root, key->path) : NULL;
    char inside[PATH];
    schema_inside(key, sizeof inside, inside);
    if (node && !config_is_null(node)) COROT_TRY(expand_short(&a, node, inside));
  }
  return COROT_OK;
}

/* What has keys of its own. */
static corot_status apply_nested(const application *a, config_node *node, const schema_key *key) {
  char inside[PATH];
  schema_inside(key, sizeof inside, inside);
  switch (key->type) {
    case SCHEMA_NAMED:
      return apply_named(a, node, inside, apply_map);
    case SCHEMA_NAMED_SHORT:
      return apply_named(a, node, inside, apply_short);
    case SCHEMA_LIST:
      return apply_list(a, node, inside);
    case SCHEMA_MAPS:
      return apply_maps(a, node, inside);
    case SCHEMA_SHORT:
      return apply_short(a, node, inside);
    case SCHEMA_CURVE:
      return apply_curve(a, node, inside);
    default:
      return apply_map(a, node, inside);
  }
}

/* By the type of its key. */
static corot_status apply_value(const application *a, config_node *node, const schema_key *key) {
  switch (key->type) {
    case SCHEMA_MAP:
    case SCHEMA_NAMED:
    case SCHEMA_NAMED_SHORT:
    case SCHEMA_LIST:
    case SCHEMA_MAPS:
    case SCHEMA_SHORT:
    case SCHEMA_CURVE:
      return apply_nested(a, node, key);
    case SCHEMA_NAMED_TEXTS:
      return apply_named_texts(node);
    case SCHEMA_TEXT:
      return check_text(node);
    case SCHEMA_CHOICE:
      return check_choice(node, key);
    case SCHEMA_NUMBER:
      return check_scalar(node, key, schema_check_number);
    case SCHEMA_INTEGER:
      return check_scalar(node, key, schema_check_integer);
    case SCHEMA_DURATION:
      return schema_check_duration(node, key->range);
    case SCHEMA_VECTOR:
      return check_three(node, key, schema_check_number);
    case SCHEMA_COUNTS:
      return check_three(node, key, schema_check_integer);
    case SCHEMA_INTEGERS:
      return check_integers(node, key);
    case SCHEMA_WORDS:
      return check_words(node, key);
    case SCHEMA_STATES:
      return apply_states(a, node, key);
    case SCHEMA_TEXTS:
      return apply_texts(a, node);
    case SCHEMA_VALUES:
      return check_values(node);
    case SCHEMA_OPEN:
      return check_open(node);
    case SCHEMA_OPENS:
      return check_opens(node);
  }
  return COROT_OK;
}

static corot_status apply_key(const application *a, config_node *c, const schema_key *key) {
  if (!config_is_null(c)) return apply_value(a, c, key);
  config_remove(c);
  return COROT_OK;
}

/* *strange: there is a key that the table does not know. */
static corot_status apply_given(const application *a, config_node *map, const char *path,
                                bool *strange) {
  for (config_node *c = map->child, *next; c; c = next) {
    next = c->next;
    const schema_key *key = NULL;
    while ((key = schema_child(a->table, path, key)) &&
           strcmp(last_segment(key->path), c->key) != 0)
      continue;
    *strange |= !key;
    corot_status status = key ? apply_key(a, c, key) : unknown_key(a->table, c, path);
    COROT_TRY(config_keep(a->tree, status));
  }
  return COROT_OK;
}

static corot_status parse_default(config *tree, const char *text, config_node **node) {
  static const config_source table = {.name = "default"};
  config_source *source = config_alloc(tree, 1, sizeof *source);
  if (!source) return corot_fail(COROT_ENOMEM, "out of memory");
  *source = table;
  source->text = text;
  source->size = strlen(text);
  COROT_TRY(config_parse(tree, source, false, node));
  (*node)->source = NULL;
  for (config_node *c = (*node)->child; c; c = c->next) c->source = NULL;
  return COROT_OK;
}

/* Numbers and words stand for themselves: most defaults need no parser. */
static bool is_word(const char *text) {
  static const char first[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
  static const char rest[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.+-";
  return *text && strchr(first, *text) && text[strspn(text, rest)] == '\0';
}

static corot_status add_default(const application *a, config_node *map, const schema_key *key) {
  const char *name = last_segment(key->path);
  if (is_word(key->fallback)) {
    COROT_TRY(config_add_text(a->tree, map, name, key->fallback));
  } else {
    config_node *node = NULL;
    COROT_TRY(parse_default(a->tree, key->fallback, &node));
    node->key = name;
    config_append(map, node);
  }
  return apply_value(a, map->last, key);
}

/* Exactly one, or at most one, of the keys marked so. */
static corot_status check_one_of(const schema *table, const config_node *map, const char *path) {
  const config_node *found = NULL;
  char words[LIST] = "";
  size_t used = 0;
  for (const schema_key *k = NULL; (k = schema_child(table, path, k));) {
    if (k->status != SCHEMA_ONE_OF && k->status != SCHEMA_AT_MOST_ONE) continue;
    const char *name = last_segment(k->path);
    if (k->status == SCHEMA_ONE_OF)
      used += (size_t)snprintf(words + used, sizeof words - used, "%s%s", used ? " or " : "", name);
    for (const config_node *c = map->child; c; c = c->next) {
      if (strcmp(c->key, name) != 0) continue;
      if (found) return config_fail_key(c, "%s and %s exclude each other", found->key, c->key);
      found = c;
    }
  }
  if (used && !found) return config_fail_key(map, "%s is missing", words);
  return COROT_OK;
}

static corot_status apply_map(const application *a, config_node *map, const char *path) {
  if (map->kind != CONFIG_MAP) return schema_expected(map, "a map");
  bool strange = false; /* what is missing may be there under another name */
  COROT_TRY(apply_given(a, map, path, &strange));
  if (!strange) COROT_TRY(config_keep(a->tree, check_one_of(a->table, map, path)));
  for (const schema_key *k = NULL; (k = schema_child(a->table, path, k));) {
    const char *name = last_segment(k->path);
    bool given = false;
    for (const config_node *c = map->child; c; c = c->next) given |= strcmp(c->key, name) == 0;
    if (given) continue;
    if (k->status == SCHEMA_REQUIRED && !strange)
      COROT_TRY(config_keep(a->tree, config_fail_key(map, "%s is missing (%s)", name, k->doc)));
    if (k->fallback) COROT_TRY(add_default(a, map, k));
  }
  return COROT_OK;
}

corot_status schema_apply(const schema *table, config *tree) {
  application a = {table, tree};
  COROT_TRY(config_keep(tree, apply_map(&a, tree->root, "")));
  return config_kept(tree);
}
