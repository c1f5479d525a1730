/* Text to tree, by way of libfyaml's event stream: the tree is ours, so that sizes, depth and
   repetition are bounded whatever the file says. */
#include <errno.h>
#include <libfyaml.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "config.h"

typedef struct anchor {
  const char *name;
  const config_node *node;
  struct anchor *next;
} anchor;

typedef struct reader {
  config *tree;
  const config_source *source;
  struct fy_diag *diag;
  struct fy_parser *parser;
  anchor *anchor; /* latest first */
  size_t at;      /* of the last event that had a place */
} reader;

/* What matters of an event. */
typedef struct event {
  enum fy_event_type type;
  size_t at;
  const char *text;   /* of a scalar; the name an alias refers to */
  const char *anchor; /* NULL: none */
  bool quoted;
} event;

/* --- Events --- */

static size_t offset_of(const config_source *source, int line, int column) {
  size_t at = 0;
  while (line > 1 && at < source->size) line -= source->text[at++] == '\n';
  while (column > 1 && at < source->size && source->text[at] != '\n') {
    at++;
    while (at < source->size && ((unsigned char)source->text[at] & 0xC0) == 0x80) at++;
    column--;
  }
  return at;
}

/* The head of a block scalar that is to be indented by 0, "|0" or ">-0"; NULL: there is none. */
static const char *find_flat_block(const config_source *source) {
  const char *begin = source->text, *end = begin + source->size;
  for (const char *s = begin; s < end; s++) {
    if ((*s != '|' && *s != '>') || (s > begin && !strchr(" \t\n", s[-1]))) continue;
    const char *digit = s + 1;
    if (digit < end && (*digit == '-' || *digit == '+')) digit++;
    if (digit < end && *digit == '0') return s;
  }
  return NULL;
}

/* libfyaml has words for everything but such a block, and that memory ran out. */
static corot_status wordless_error(reader *r) {
  const char *block = find_flat_block(r->source);
  if (!block) return no_memory();
  return config_fail_at(r->source, (size_t)(block - r->source->text),
                        "the indentation of a block scalar is 1 to 9, not 0");
}

static corot_status syntax_error(reader *r) {
  void *previous = NULL;
  const struct fy_diag_error *e = fy_diag_errors_iterate(r->diag, &previous);
  if (!e) return wordless_error(r);
  return config_fail_at(r->source, offset_of(r->source, e->line, e->column), "%s", e->msg);
}

static corot_status copy_token(reader *r, struct fy_token *token, const char **text) {
  size_t length = 0;
  const char *s = token ? fy_token_get_text(token, &length) : "";
  /* without memory libfyaml takes a text for an empty one */
  if (token && length == 0 && fy_token_get_text_length(token) != 0) return no_memory();
  /* it can only be written between double quotes, and libfyaml's mark is behind the first */
  if (s && memchr(s, '\0', length))
    return config_fail_at(r->source, r->at > 0 ? r->at - 1 : 0,
                          "text cannot hold the character U+0000");
  *text = s ? config_copy(r->tree, s, length) : NULL;
  return *text ? COROT_OK : no_memory();
}

/* The tokens of an event: what it stands for, its anchor and its tag. */
typedef struct tokens {
  struct fy_token *value, *anchor, *tag;
} tokens;

static tokens tokens_of(const struct fy_event *e) {
  switch (e->type) {
    case FYET_SCALAR:
      return (tokens){e->scalar.value, e->scalar.anchor, e->scalar.tag};
    case FYET_ALIAS:
      return (tokens){e->alias.anchor, NULL, NULL};
    case FYET_SEQUENCE_START:
      return (tokens){e->sequence_start.sequence_start, e->sequence_start.anchor,
                      e->sequence_start.tag};
    case FYET_MAPPING_START:
      return (tokens){e->mapping_start.mapping_start, e->mapping_start.anchor,
                      e->mapping_start.tag};
    default:
      return (tokens){NULL, NULL, NULL};
  }
}

static corot_status take_event(reader *r, const struct fy_event *e, event *out) {
  tokens token = tokens_of(e);
  const struct fy_mark *mark = token.value ? fy_token_start_mark(token.value) : NULL;
  if (mark) r->at = mark->input_pos;
  *out = (event){.type = e->type, .at = r->at};
  if (token.tag) return config_fail_at(r->source, r->at, "tags (\"!\") mean nothing here");
  if (e->type == FYET_SCALAR || e->type == FYET_ALIAS)
    COROT_TRY(copy_token(r, token.value, &out->text));
  if (e->type == FYET_SCALAR) {
    enum fy_scalar_style style = token.value ? fy_token_scalar_style(token.value) : FYSS_PLAIN;
    out->quoted = style != FYSS_PLAIN && style != FYSS_ANY;
    bool quotes = style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED;
    if (mark && quotes && r->at > 0) out->at = r->at - 1; /* libfyaml's mark is behind the quote */
  }
  if (token.anchor) COROT_TRY(copy_token(r, token.anchor, &out->anchor));
  return COROT_OK;
}

static corot_status next_event(reader *r, event *out) {
  struct fy_event *e = fy_parser_parse(r->parser);
  if (!e) return syntax_error(r);
  corot_status status = take_event(r, e, out);
  fy_parser_event_free(r->parser, e);
  return status;
}

/* --- Values --- */

static corot_status new_node(reader *r, config_kind kind, config_node **node) {
  if (++r->tree->nnode > CONFIG_MOST_VALUES)
    return config_fail_at(r->source, r->at, "more than %d values, the limit of a file",
                          CONFIG_MOST_VALUES);
  *node = config_node_create(r->tree, kind);
  if (!*node) return no_memory();
  (*node)->source = r->source;
  return COROT_OK;
}

static corot_status copy_node(reader *r, const config_node *from, config_node **out) {
  config_node *node;
  COROT_TRY(new_node(r, from->kind, &node));
  node->quoted = from->quoted;
  node->text = from->text;
  node->key = from->key;
  node->key_at = from->key_at;
  node->at = from->at;
  for (const config_node *c = from->child; c; c = c->next) {
    config_node *child;
    COROT_TRY(copy_node(r, c, &child));
    config_append(node, child);
  }
  *out = node;
  return COROT_OK;
}

static corot_status read_alias(reader *r, const event *e, config_node **out) {
  for (const anchor *a = r->anchor; a; a = a->next)
    if (strcmp(a->name, e->text) == 0) return copy_node(r, a->node, out);
  return config_fail_at(r->source, e->at, "no anchor &%s stands before this", e->text);
}

static corot_status read_value(reader *r, const event *first, int depth, config_node **out);

static corot_status read_list(reader *r, config_node *list, int depth) {
  for (;;) {
    event e;
    config_node *item;
    COROT_TRY(next_event(r, &e));
    if (e.type == FYET_SEQUENCE_END) return COROT_OK;
    COROT_TRY(read_value(r, &e, depth, &item));
    config_append(list, item);
  }
}

static corot_status check_key(reader *r, const config_node *map, const event *key) {
  if (key->type != FYET_SCALAR) return config_fail_at(r->source, key->at, "a key must be a word");
  for (const config_node *c = map->child; c; c = c->next)
    if (strcmp(c->key, key->text) == 0)
      return config_fail_at(r->source, key->at, "%.64s: given twice", key->text);
  if (map->nchild >= CONFIG_MOST_KEYS)
    return config_fail_at(r->source, key->at, "more than %d keys in one map, the limit of a file",
                          CONFIG_MOST_KEYS);
  return COROT_OK;
}

static corot_status read_map(reader *r, config_node *map, int depth) {
  for (;;) {
    event key, e;
    config_node *value;
    COROT_TRY(next_event(r, &key));
    if (key.type == FYET_MAPPING_END) return COROT_OK;
    COROT_TRY(check_key(r, map, &key));
    COROT_TRY(next_event(r, &e));
    COROT_TRY(read_value(r, &e, depth, &value));
    value->key = key.text;
    value->key_at = key.at;
    config_append(map, value);
  }
}

static corot_status add_anchor(reader *r, const char *name, const config_node *node) {
  anchor *a = config_alloc(r->tree, 1, sizeof *a);
  if (!a) return no_memory();
  *a = (anchor){name, node, r->anchor};
  r->anchor = a;
  return COROT_OK;
}

static corot_status read_value(reader *r, const event *first, int depth, config_node **out) {
  config_node *node = NULL;
  if (depth > CONFIG_MOST_LEVELS)
    return config_fail_at(r->source, first->at, "nested deeper than %d levels, the limit of a file",
                          CONFIG_MOST_LEVELS);
  /* the node by its kind, and what is in it */
  switch (first->type) {
    case FYET_ALIAS:
      return read_alias(r, first, out);
    case FYET_SCALAR:
      COROT_TRY(new_node(r, CONFIG_SCALAR, &node));
      node->text = first->text;
      node->quoted = first->quoted;
      node->at = first->at;
      break;
    case FYET_SEQUENCE_START:
      COROT_TRY(new_node(r, CONFIG_LIST, &node));
      node->at = first->at;
      COROT_TRY(read_list(r, node, depth + 1));
      break;
    case FYET_MAPPING_START:
      COROT_TRY(new_node(r, CONFIG_MAP, &node));
      node->at = first->at;
      COROT_TRY(read_map(r, node, depth + 1));
      break;
    default:
      return config_fail_at(r->source, first->at, "a value is missing");
  }
  /* it may be repeated by its name from here on */
  if (first->anchor) COROT_TRY(add_anchor(r, first->anchor, node));
  *out = node;
  return COROT_OK;
}

/* --- Documents --- */

static corot_status read_document(reader *r, config_node **out) {
  config_node *root = NULL;
  event e;
  COROT_TRY(next_event(r, &e)); /* start of the stream */
  COROT_TRY(next_event(r, &e));
  if (e.type == FYET_DOCUMENT_START) {
    COROT_TRY(next_event(r, &e));
    COROT_TRY(read_value(r, &e, 0, &root));
    COROT_TRY(next_event(r, &e)); /* its end */
    COROT_TRY(next_event(r, &e));
    if (e.type == FYET_DOCUMENT_START)
      return config_fail_at(r->source, r->at, "a second document begins after this");
  }
  *out = root;
  return COROT_OK;
}

/* The length of the UTF-8 sequence at s [n] if YAML allows the character; 0 if not. libfyaml would
   take anything else for the end of the file. */
static size_t character(const unsigned char *s, size_t n) {
  if (s[0] < 0x80) {
    bool printable = s[0] >= 0x20 && s[0] != 0x7F;
    return printable || s[0] == '\t' || s[0] == '\n' || s[0] == '\r';
  }
  size_t length = s[0] >= 0xF0 ? 4 : s[0] >= 0xE0 ? 3 : 2;
  static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (s[0] < 0xC2 || s[0] > 0xF4 || length > n) return 0;
  unsigned code = s[0] & (0xFFu >> (length + 1));
  for (size_t i = 1; i < length; i++) {
    if ((s[i] & 0xC0) != 0x80) return 0;
    code = code << 6 | (s[i] & 0x3Fu);
  }
  bool control = code < 0xA0 && code != 0x85;
  bool surrogate = code >= 0xD800 && code < 0xE000;
  if (code < least[length] || code > 0x10FFFF || control || surrogate) return 0;
  return code == 0xFFFE || code == 0xFFFF ? 0 : length;
}

static corot_status check_text(const config_source *source) {
  const unsigned char *s = (const unsigned char *)source->text;
  for (size_t at = 0, length; at < source->size; at += length) {
    length = character(s + at, source->size - at);
    if (!length)
      return corot_fail(COROT_EFORMAT, "%s: byte %zu (0x%02X) is not text in UTF-8", source->name,
                        at, s[at]);
  }
  return COROT_OK;
}

corot_status config_parse(config *tree, const config_source *source, bool json,
                          config_node **node) {
  COROT_TRY(check_text(source));
  reader r = {.tree = tree, .source = source};
  corot_status status = COROT_ENOMEM;
  /* libfyaml is to keep its complaints for us instead of printing them */
  struct fy_diag_cfg quiet;
  fy_diag_cfg_default(&quiet);
  quiet.fp = NULL;
  r.diag = fy_diag_create(&quiet);
  if (r.diag) {
    fy_diag_set_collect_errors(r.diag, true);
    struct fy_parse_cfg cfg = {.flags = json ? FYPCF_JSON_FORCE : FYPCF_JSON_NONE, .diag = r.diag};
    r.parser = fy_parser_create(&cfg);
  }
  if (!r.parser || fy_parser_set_string(r.parser, source->text, source->size))
    corot_fail(status, "out of memory");
  else
    status = read_document(&r, node);
  if (r.parser) fy_parser_destroy(r.parser);
  if (r.diag) fy_diag_destroy(r.diag);
  return status;
}

/* --- Files --- */

enum { MOST_BYTES = CONFIG_MOST_MIB << 20 };

static bool ends_in(const char *text, const char *end) {
  size_t n = strlen(text), m = strlen(end);
  return n >= m && strcmp(text + n - m, end) == 0;
}

/* Parses text that the tree owns. */
static corot_status read_root(config *tree, const char *path, const char *text, size_t size) {
  config_source *source = config_alloc(tree, 1, sizeof *source);
  char *name = config_copy(tree, path, strlen(path));
  if (!source || !name) return no_memory();
  *source = (config_source){.name = name, .text = text, .size = size, .lines = true};
  COROT_TRY(config_parse(tree, source, ends_in(path, ".json"), &tree->root));
  if (!tree->root) return corot_fail(COROT_EFORMAT, "%s: the file is empty", path);
  if (tree->root->kind != CONFIG_MAP)
    return config_fail(tree->root, "expected a map of keys and values");
  return COROT_OK;
}

corot_status config_read_text(const char *path, const char *text, size_t size, config **out) {
  config *tree = calloc(1, sizeof *tree);
  char *copy = tree ? config_copy(tree, text, size) : NULL;
  corot_status status = copy ? read_root(tree, path, copy, size) : no_memory();
  if (status == COROT_OK)
    *out = tree;
  else
    config_destroy(tree);
  return status;
}

static corot_status read_file(const char *path, FILE *file, char *text, size_t *size) {
  *size = fread(text, 1, MOST_BYTES + 1, file);
  if (ferror(file)) return corot_fail(COROT_EIO, "%s: %s", path, strerror(errno));
  if (*size > MOST_BYTES)
    return corot_fail(COROT_EFORMAT, "%s: larger than %d MiB, the limit for a scenario", path,
                      CONFIG_MOST_MIB);
  return COROT_OK;
}

corot_status config_read(const char *path, config **tree) {
  FILE *file = fopen(path, "rb");
  if (!file) return corot_fail(COROT_EIO, "%s: %s", path, strerror(errno));
  char *text = malloc(MOST_BYTES + 1);
  size_t size = 0;
  corot_status status = text ? read_file(path, file, text, &size) : no_memory();
  if (status == COROT_OK) status = config_read_text(path, text, size, tree);
  free(text);
  fclose(file);
  return status;
}
