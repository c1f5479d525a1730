/* The tree itself: nodes, look-up, and the sentence that shows a place in the file. */
#include "config.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Memory --- */

/* Memory is handed out from blocks and freed with the tree. */
typedef struct config_block {
  struct config_block *next;
  size_t used, size;
  max_align_t data[];
} config_block;

static config_block *block_create(size_t size) {
  config_block *block = calloc(1, sizeof *block + size);
  if (block) block->size = size;
  return block;
}

void *config_alloc(config *tree, size_t count, size_t size) {
  enum { ALIGN = sizeof(max_align_t), BLOCK = 1 << 16 };
  if (size && count > (SIZE_MAX / 2 - ALIGN) / size) return NULL;
  size_t bytes = (count * size + ALIGN - 1) / ALIGN * ALIGN;

  config_block *block = tree->block;
  if (!block || block->size - block->used < bytes) {
    block = block_create(bytes > BLOCK ? bytes : BLOCK);
    if (!block) return NULL;
    block->next = tree->block;
    tree->block = block;
  }
  void *memory = (char *)block->data + block->used;
  block->used += bytes;
  return memory;
}

char *config_copy(config *tree, const char *text, size_t length) {
  char *copy = config_alloc(tree, length + 1, 1);
  if (copy && length) memcpy(copy, text, length);
  return copy;
}

const char *config_beside(config *tree, const char *path, const char *file) {
  const char *slash = strrchr(path, '/');
  size_t folder = slash && file[0] != '/' ? (size_t)(slash - path) + 1 : 0;
  size_t length = strlen(file);
  char *joined = config_alloc(tree, folder + length + 1, 1);
  if (!joined) return NULL;
  memcpy(joined, path, folder);
  memcpy(joined + folder, file, length);
  return joined;
}

void config_destroy(config *tree) {
  if (!tree) return;
  while (tree->block) {
    config_block *next = tree->block->next;
    free(tree->block);
    tree->block = next;
  }
  free(tree);
}

/* --- Nodes --- */

config_node *config_node_create(config *tree, config_kind kind) {
  config_node *node = config_alloc(tree, 1, sizeof *node);
  if (node) node->kind = kind;
  return node;
}

void config_append(config_node *parent, config_node *node) {
  node->parent = parent;
  node->next = NULL;
  if (parent->last)
    parent->last->next = node;
  else
    parent->child = node;
  parent->last = node;
  parent->nchild++;
}

void config_remove(config_node *node) {
  config_node *parent = node->parent, *before = NULL;
  for (config_node *c = parent->child; c != node; c = c->next) before = c;
  if (before)
    before->next = node->next;
  else
    parent->child = node->next;
  if (parent->last == node) parent->last = before;
  parent->nchild--;
  node->parent = node->next = NULL;
}

corot_status config_add_text(config *tree, config_node *map, const char *key, const char *text) {
  config_node *node = config_node_create(tree, CONFIG_SCALAR);
  if (node) node->text = config_copy(tree, text, strlen(text));
  if (!node || !node->text) return corot_fail(COROT_ENOMEM, "out of memory");
  node->key = key;
  config_append(map, node);
  return COROT_OK;
}

corot_status config_add_number(config *tree, config_node *map, const char *key, double number) {
  char text[32];
  snprintf(text, sizeof text, "%.17g", number);
  COROT_TRY(config_add_text(tree, map, key, text));
  map->last->number = number;
  return COROT_OK;
}

/* The child named by the first `length` characters of `segment`. */
static config_node *find_child(config_node *node, const char *segment, size_t length) {
  if (node->kind == CONFIG_MAP) {
    for (config_node *c = node->child; c; c = c->next)
      if (strlen(c->key) == length && memcmp(c->key, segment, length) == 0) return c;
    return NULL;
  }
  char *end;
  long index = strtol(segment, &end, 10);
  if (node->kind != CONFIG_LIST || length == 0 || end != segment + length || index < 0) return NULL;
  config_node *c = node->child;
  while (c && index-- > 0) c = c->next;
  return c;
}

config_node *config_find(config_node *node, const char *path) {
  while (node && *path) {
    size_t length = strcspn(path, ".");
    node = find_child(node, path, length);
    path += length + (path[length] == '.');
  }
  return node;
}

bool config_is_null(const config_node *node) {
  static const char *const spelling[] = {"", "~", "null", "Null", "NULL"};
  if (node->kind != CONFIG_SCALAR || node->quoted) return false;
  for (size_t i = 0; i < sizeof spelling / sizeof *spelling; i++)
    if (strcmp(node->text, spelling[i]) == 0) return true;
  return false;
}

/* --- Numbers --- */

static const char *skip_digits(const char *s) {
  while (*s >= '0' && *s <= '9') s++;
  return s;
}

/* [+-] digits [. digits] [e [+-] digits], where the digits before or after the point may be
   missing. A leading zero, as in 010, would be octal to some readers. */
bool config_is_decimal(const char *s) {
  if (*s == '+' || *s == '-') s++;
  const char *point = skip_digits(s);
  if (*s == '0' && point > s + 1) return false;
  ptrdiff_t ndigit = point - s;
  if (*point == '.') {
    s = skip_digits(point + 1);
    ndigit += s - point - 1;
  } else {
    s = point;
  }
  if (ndigit == 0) return false;
  if (*s == 'e' || *s == 'E') {
    s++;
    if (*s == '+' || *s == '-') s++;
    const char *end = skip_digits(s);
    if (end == s) return false;
    s = end;
  }
  return *s == '\0';
}

bool config_parse_number(const config_node *node, double *number) {
  if (node->kind != CONFIG_SCALAR || node->quoted || !config_is_decimal(node->text)) return false;
  double value = strtod(node->text, NULL);
  if (!(value - value == 0)) return false;
  *number = value;
  return true;
}

/* --- Messages --- */

/* Whether it was written where a list could stand, and made the only entry of one. */
static bool stands_for_list(const config_node *n) {
  return n->source && n->source == n->parent->source && n->at == n->parent->at;
}

void config_path(const config_node *node, size_t size, char *path) {
  /* from the root down: find the ancestor at each depth */
  int depth = 0;
  for (const config_node *n = node; n->parent; n = n->parent) depth++;
  size_t used = 0;
  path[0] = '\0';
  for (; depth > 0 && used < size; depth--) {
    const config_node *n = node;
    for (int i = 1; i < depth; i++) n = n->parent;
    if (n->key) {
      used += (size_t)snprintf(path + used, size - used, "%s%s", used ? "." : "", n->key);
    } else if (!stands_for_list(n)) {
      int index = 0;
      for (const config_node *c = n->parent->child; c != n; c = c->next) index++;
      used += (size_t)snprintf(path + used, size - used, "[%d]", index);
    }
  }
}

static bool is_continuation(char c) { return ((unsigned char)c & 0xC0) == 0x80; }

/* The line around `at`, at most WIDTH bytes of it, and the column of `at` in characters. */
typedef struct excerpt {
  int line, column;
  const char *text;
  int length;
  int caret; /* characters of `text` before the place */
} excerpt;

static excerpt excerpt_of(const config_source *source, size_t at) {
  enum { WIDTH = 96 };
  const char *text = source->text;
  if (at > source->size) at = source->size;
  excerpt e = {.line = 1, .column = 1};
  size_t begin = 0, end = at;
  for (size_t i = 0; i < at; i++)
    if (text[i] == '\n') e.line++, begin = i + 1;
  while (end < source->size && text[end] != '\n' && text[end] != '\r') end++;
  if (begin == 0 && end >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) begin = 3;
  for (size_t i = begin; i < at; i++) e.column += !is_continuation(text[i]);

  /* long lines: a window that holds the place */
  if (at > begin && at - begin > WIDTH / 2 && end - begin > WIDTH) begin = at - WIDTH / 2;
  if (end - begin > WIDTH) end = begin + WIDTH;
  while (begin < at && is_continuation(text[begin])) begin++;
  while (end > at && end < source->size && is_continuation(text[end])) end--;
  for (size_t i = begin; i < at; i++) e.caret += !is_continuation(text[i]);
  e.text = text + begin;
  e.length = (int)(end - begin);
  return e;
}

static corot_status tell_at(const config_source *source, size_t at, const char *message) {
  if (!source) return corot_fail(COROT_EFORMAT, "%s", message);
  if (!source->lines) return corot_fail(COROT_EFORMAT, "%s: %s", source->name, message);
  excerpt e = excerpt_of(source, at);
  char line[128];
  snprintf(line, sizeof line, "%.*s", e.length, e.text);
  for (char *c = line; *c; c++)
    if (*c == '\t') *c = ' ';
  return corot_fail(COROT_EFORMAT, "%s:%d:%d: %s\n  %s\n  %*s^", source->name, e.line, e.column,
                    message, line, e.caret, "");
}

static corot_status fail_at(const config_source *source, size_t at, const char *message) {
  corot_status status = tell_at(source, at, message);
  config_failed_at(source, at);
  return status;
}

corot_status config_fail_at(const config_source *source, size_t at, const char *format, ...) {
  char message[3600];
  va_list args;
  va_start(args, format);
  vsnprintf(message, sizeof message, format, args);
  va_end(args);
  return fail_at(source, at, message);
}

/* A node that no source has, a default, is shown where the map that lacks it stands. */
static corot_status fail_node(const config_node *node, bool key, const char *format, va_list args) {
  char path[128], message[3600];
  config_path(node, sizeof path, path);
  int used = snprintf(message, sizeof message, "%s%s", path, *path ? ": " : "");
  vsnprintf(message + used, sizeof message - (size_t)used, format, args);
  while (!node->source && node->parent) node = node->parent, key = true;
  return fail_at(node->source, key && node->key ? node->key_at : node->at, message);
}

corot_status config_fail(const config_node *node, const char *format, ...) {
  va_list args;
  va_start(args, format);
  corot_status status = fail_node(node, false, format, args);
  va_end(args);
  return status;
}

corot_status config_fail_key(const config_node *node, const char *format, ...) {
  va_list args;
  va_start(args, format);
  corot_status status = fail_node(node, true, format, args);
  va_end(args);
  return status;
}
