#include "json_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

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

static void write_value(const json_t *value, int indent, FILE *out);

static void write_plain(const json_t *value, FILE *out) {
  if (json_is_real(value)) {
    char text[48];
    json_text_number(json_real_value(value), sizeof text, text);
    fputs(text, out);
  } else {
    json_dumpf(value, out, JSON_ENCODE_ANY);
  }
}

/* Nothing below it but numbers, words and lists of them. */
static bool is_flat(const json_t *list) {
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *item = json_array_get(list, i);
    if (json_is_object(item) || (json_is_array(item) && !is_flat(item))) return false;
  }
  return true;
}

static void write_list(const json_t *list, int indent, FILE *out) {
  bool flat = is_flat(list);
  fputc('[', out);
  for (size_t i = 0; i < json_array_size(list); i++) {
    if (i) fputs(flat ? ", " : ",", out);
    if (!flat) fprintf(out, "\n%*s", indent + 2, "");
    write_value(json_array_get(list, i), indent + 2, out);
  }
  if (!flat) fprintf(out, "\n%*s", indent, "");
  fputc(']', out);
}

static void write_map(const json_t *map, int indent, FILE *out) {
  const char *separator = "";
  fputc('{', out);
  /* jansson's iteration wants a pointer to what it will not change */
  void *i = json_object_iter((json_t *)map);
  for (; i; i = json_object_iter_next((json_t *)map, i)) {
    json_t *key = json_string(json_object_iter_key(i));
    fprintf(out, "%s\n%*s", separator, indent + 2, "");
    json_dumpf(key, out, JSON_ENCODE_ANY);
    fputs(": ", out);
    write_value(json_object_iter_value(i), indent + 2, out);
    json_decref(key);
    separator = ",";
  }
  if (*separator) fprintf(out, "\n%*s", indent, "");
  fputc('}', out);
}

static void write_value(const json_t *value, int indent, FILE *out) {
  if (json_is_array(value))
    write_list(value, indent, out);
  else if (json_is_object(value))
    write_map(value, indent, out);
  else
    write_plain(value, out);
}

void json_text_write(const json_t *value, FILE *out) {
  write_value(value, 0, out);
  fputc('\n', out);
}

void json_text_quote(const char *s, FILE *out) {
  json_t *string = json_string(s);
  json_dumpf(string, out, JSON_ENCODE_ANY);
  json_decref(string);
}

json_t *json_text_real(double x) { return isfinite(x) ? json_real(x) : json_null(); }
