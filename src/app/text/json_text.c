/* A writer and a reader around jansson that know when memory ran out. */
#include "json_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "no_memory.h"

static _Thread_local bool starved;

/* Where jansson's lexer (2.14) finds no memory for a longer string, it looks for the closing quote
   beyond the end of the block that it has: there is one behind every block. */
static void *watched_malloc(size_t size) {
  char *memory = malloc(size + 1);
  if (memory)
    memory[size] = '"';
  else
    starved = true;
  return memory;
}

/* For what is allocated from here on: both kinds are freed by free(). */
static void watch(void) {
  static bool watching; /* twice does no harm */
  if (!watching) json_set_alloc_funcs(watched_malloc, free);
  watching = true;
}

bool json_text_starved(void) {
  bool answer = starved;
  watch();
  starved = false;
  return answer;
}

void json_text_starve(void) { starved = true; }

corot_status json_text_parse(const char *path, const char *text, size_t size, json_t **out) {
  json_error_t error;
  bool before = json_text_starved();
  json_t *value = json_loadb(text, size, 0, &error);
  bool now = json_text_starved();
  starved = before;
  if (value && !now) {
    *out = value;
    return COROT_OK;
  }
  json_decref(value);
  if (now) return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  return corot_fail(COROT_EFORMAT, "%s:%d:%d: %s", path, error.line, error.column, error.text);
}

void json_text_number(double x, size_t size, char *text) {
  char digits[40];
  for (int precision = 15; precision <= 17; precision++) {
    snprintf(digits, sizeof digits, "%.*g", precision, x);
    if (strtod(digits, NULL) == x) break;
  }
  size_t mantissa = strcspn(digits, "e");
  const char *point = memchr(digits, '.', mantissa) ? "" : ".0";
  snprintf(text, size, "%.*s%s%s", (int)mantissa, digits, point, digits + mantissa);
}

json_t *json_text_with(json_t *object, const char *key, json_t *value) {
  if (!json_object_set_new(object, key, value)) return object;
  json_decref(object);
  return NULL;
}

json_t *json_text_push(json_t *list, json_t *value) {
  if (!json_array_append_new(list, value)) return list;
  json_decref(list);
  return NULL;
}

json_t *json_text_string(const char *s) {
  json_t *string = json_string(s);
  size_t size = strlen(s) + 1;
  char *copy = string ? NULL : malloc(size);
  if (!copy) return string;
  for (size_t i = 0; i < size; i++) copy[i] = s[i] & 0x80 ? '?' : s[i];
  string = json_string(copy);
  free(copy);
  return string;
}

/* --- Text --- */

/* How many bytes at `s`, which stand in a string, YAML wants escaped although JSON does not: DEL
   and the control characters U+0080 to U+009F. */
static int control_length(const char *s) {
  const unsigned char *c = (const unsigned char *)s;
  return c[0] == 0x7f ? 1 : c[0] == 0xc2 && (c[1] & 0xe0) == 0x80 ? 2 : 0;
}

/* The same text with them escaped; takes `text` over. */
static char *escape_controls(char *text) {
  size_t n = 0;
  for (const char *s = text; *s; s++) n += control_length(s) > 0;
  if (n == 0) return text;
  char *escaped = malloc(strlen(text) + 5 * n + 1), *to = escaped;
  for (const char *s = text; escaped && *s;) {
    int length = control_length(s);
    if (length)
      to += sprintf(to, "\\u00%02x", (unsigned char)s[length - 1]);
    else
      *to++ = *s;
    s += length ? length : 1;
  }
  if (escaped) *to = '\0';
  free(text);
  return escaped;
}

char *json_text_dump_plain(const json_t *value, size_t flags) {
  bool before = json_text_starved();
  char *text = value ? json_dumps(value, flags | JSON_ENCODE_ANY) : NULL;
  bool now = json_text_starved();
  starved = before || now;
  if (text && !now) return text;
  free(text);
  return NULL;
}

char *json_text_dump(const json_t *value, size_t flags) {
  char *text = json_text_dump_plain(value, flags);
  return text ? escape_controls(text) : NULL;
}

/* --- Files --- */

static corot_status write_value(const json_t *value, int indent, FILE *out);

static corot_status write_dump(const json_t *value, FILE *out) {
  char *text = json_text_dump(value, 0);
  if (!text) return no_memory();
  fputs(text, out);
  free(text);
  return COROT_OK;
}

static corot_status write_plain(const json_t *value, FILE *out) {
  if (!json_is_real(value)) return write_dump(value, out);
  char text[48];
  json_text_number(json_real_value(value), sizeof text, text);
  fputs(text, out);
  return COROT_OK;
}

/* Nothing below it but numbers, words and lists of them. */
static bool is_flat(const json_t *list) {
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *item = json_array_get(list, i);
    if (json_is_object(item) || (json_is_array(item) && !is_flat(item))) return false;
  }
  return true;
}

static corot_status write_list(const json_t *list, int indent, FILE *out) {
  bool flat = is_flat(list);
  fputc('[', out);
  for (size_t i = 0; i < json_array_size(list); i++) {
    if (i) fputs(flat ? ", " : ",", out);
    if (!flat) fprintf(out, "\n%*s", indent + 2, "");
    COROT_TRY(write_value(json_array_get(list, i), indent + 2, out));
  }
  if (!flat) fprintf(out, "\n%*s", indent, "");
  fputc(']', out);
  return COROT_OK;
}

static corot_status write_map(const json_t *map, int indent, FILE *out) {
  const char *separator = "";
  fputc('{', out);
  /* jansson's iteration wants a pointer to what it will not change */
  void *i = json_object_iter((json_t *)map);
  for (; i; i = json_object_iter_next((json_t *)map, i)) {
    fprintf(out, "%s\n%*s", separator, indent + 2, "");
    COROT_TRY(json_text_quote(json_object_iter_key(i), out));
    fputs(": ", out);
    COROT_TRY(write_value(json_object_iter_value(i), indent + 2, out));
    separator = ",";
  }
  if (*separator) fprintf(out, "\n%*s", indent, "");
  fputc('}', out);
  return COROT_OK;
}

static corot_status write_value(const json_t *value, int indent, FILE *out) {
  if (json_is_array(value)) return write_list(value, indent, out);
  if (json_is_object(value)) return write_map(value, indent, out);
  return write_plain(value, out);
}

corot_status json_text_write(const json_t *value, FILE *out) {
  COROT_TRY(write_value(value, 0, out));
  fputc('\n', out);
  return COROT_OK;
}

corot_status json_text_show(const json_t *value) {
  return value && !json_text_starved() ? json_text_write(value, stdout) : no_memory();
}

corot_status json_text_quote(const char *s, FILE *out) {
  json_t *string = json_text_string(s);
  corot_status status = string ? write_dump(string, out) : no_memory();
  json_decref(string);
  return status;
}

json_t *json_text_real(double x) { return isfinite(x) ? json_real(x) : json_null(); }
