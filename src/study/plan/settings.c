/* Keys of a scenario and values for them, as a study file writes them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "app/text/text_stream.h"
#include "study.h"

/* --- Values --- */

/* Reads back as the same word wherever it stands. */
static bool is_plain(const char *text) {
  static const char safe[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./ ";
  size_t length = strlen(text);
  return length > 0 && strspn(text, safe) == length && text[0] != ' ' && text[length - 1] != ' ';
}

static corot_status write_word(const char *text, bool quoted, FILE *out) {
  if (quoted || !is_plain(text)) return json_text_quote(text, out);
  fputs(text, out);
  return COROT_OK;
}

static corot_status write_value(const config_node *value, FILE *out) {
  if (value->kind == CONFIG_SCALAR) {
    if (!config_is_null(value)) return write_word(value->text, value->quoted, out);
    fputs("null", out);
    return COROT_OK;
  }
  bool map = value->kind == CONFIG_MAP;
  fputc(map ? '{' : '[', out);
  for (const config_node *c = value->child; c; c = c->next) {
    if (c != value->child) fputs(", ", out);
    if (map) {
      COROT_TRY(write_word(c->key, false, out));
      fputs(": ", out);
    }
    COROT_TRY(write_value(c, out));
  }
  fputc(map ? '}' : ']', out);
  return COROT_OK;
}

corot_status study_value_text(config *tree, const config_node *value, const char **text) {
  char *buffer = NULL;
  size_t size = 0;
  FILE *out = text_open(&buffer, &size);
  if (!out) return no_memory();
  bool written = write_value(value, out) == COROT_OK;
  written &= text_close(out) == 0;
  *text = written ? config_copy(tree, buffer, size) : NULL;
  free(buffer);
  return *text ? COROT_OK : no_memory();
}

static json_t *scalar_json(const config_node *value) {
  double number;
  if (config_is_null(value)) return json_null();
  if (!config_parse_number(value, &number)) return json_string(value->text);
  bool whole = !strpbrk(value->text, ".eE") && number > -1e15 && number < 1e15;
  return whole ? json_integer((json_int_t)number) : json_real(number);
}

json_t *study_value_json(const config_node *value) {
  if (value->kind == CONFIG_SCALAR) return scalar_json(value);
  bool map = value->kind == CONFIG_MAP;
  json_t *json = map ? json_object() : json_array();
  for (const config_node *c = value->child; c; c = c->next) {
    json_t *item = study_value_json(c);
    if (map ? json_object_set_new(json, c->key, item) : json_array_append_new(json, item)) {
      json_decref(json);
      return NULL;
    }
  }
  return json;
}

static int compare_scalars(const config_node *a, const config_node *b) {
  double x = 0, y = 0;
  bool first = config_parse_number(a, &x), second = config_parse_number(b, &y);
  if (first || second) return first && second ? (x > y) - (x < y) : second - first;
  first = config_is_null(a);
  second = config_is_null(b);
  return first || second ? second - first : strcmp(a->text, b->text);
}

int study_compare_values(const config_node *a, const config_node *b) {
  if (a->kind != b->kind) return (int)a->kind - (int)b->kind;
  if (a->kind == CONFIG_SCALAR) return compare_scalars(a, b);
  const config_node *c = a->child, *d = b->child;
  for (; c && d; c = c->next, d = d->next) {
    int order = c->key ? strcmp(c->key, d->key) : 0;
    if (order == 0) order = study_compare_values(c, d);
    if (order != 0) return order;
  }
  return (c != NULL) - (d != NULL);
}

bool study_same_value(const config_node *a, const config_node *b) {
  return study_compare_values(a, b) == 0;
}

double study_tolerance(const setting *tolerance) {
  double number;
  if (!tolerance || !config_parse_number(tolerance->value, &number)) return NAN;
  return strcmp(tolerance->key, "mesh.refine") == 0 ? exp2(-number) : number;
}

/* --- Settings --- */

static int by_key(const void *a, const void *b) {
  return strcmp(((const setting *)a)->key, ((const setting *)b)->key);
}

corot_status study_read_settings(config *tree, const config_node *map, int *nset,
                                 const setting **out) {
  setting *set = config_alloc(tree, (size_t)map->nchild, sizeof *set);
  if (!set) return no_memory();
  int n = 0;
  for (const config_node *c = map->child; c; c = c->next) set[n++] = (setting){c->key, c};
  qsort(set, (size_t)n, sizeof *set, by_key);
  *nset = n;
  *out = set;
  return COROT_OK;
}
