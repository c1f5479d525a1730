/* The table for people. */
#include <stdio.h>
#include <string.h>

#include "schema.h"

static const char *const type_words[] = {
    [SCHEMA_MAP] = "map",
    [SCHEMA_NAMED] = "map of names",
    [SCHEMA_NAMED_TEXTS] = "map of texts",
    [SCHEMA_NAMED_SHORT] = "map of names",
    [SCHEMA_LIST] = "list of maps",
    [SCHEMA_MAPS] = "map or list",
    [SCHEMA_SHORT] = "map or value",
    [SCHEMA_TEXT] = "text",
    [SCHEMA_CHOICE] = "choice",
    [SCHEMA_NUMBER] = "number",
    [SCHEMA_INTEGER] = "integer",
    [SCHEMA_DURATION] = "duration",
    [SCHEMA_VECTOR] = "3 numbers",
    [SCHEMA_COUNTS] = "3 integers",
    [SCHEMA_INTEGERS] = "integers",
    [SCHEMA_WORDS] = "list of words",
    [SCHEMA_CURVE] = "pairs or map",
    [SCHEMA_STATES] = "word, map or list",
    [SCHEMA_TEXTS] = "text or list",
    [SCHEMA_VALUES] = "list of values",
    [SCHEMA_OPEN] = "map of keys",
    [SCHEMA_OPENS] = "list of maps",
};

static const char *default_words(const schema_key *key) {
  switch (key->status) {
    case SCHEMA_REQUIRED:
      return "required";
    case SCHEMA_ONE_OF:
      return "one of";
    case SCHEMA_AT_MOST_ONE:
      return "at most 1";
    default:
      return key->fallback && key->type != SCHEMA_MAP ? key->fallback : "-";
  }
}

static void type_and_range(const schema_key *key, size_t size, char *text) {
  const char *range = schema_ranges[key->range].words;
  snprintf(text, size, "%s%s%s", type_words[key->type], *range ? " " : "", range);
}

/* "a, b, c" */
static void print_words(const char *words, FILE *out) {
  for (const char *w = words; *w;) {
    int length = (int)strcspn(w, "|");
    fprintf(out, "%s%.*s", w > words ? ", " : "", length, w);
    w += length + (w[length] == '|');
  }
}

static void print_key(const schema_key *key, FILE *out) {
  char type[48];
  type_and_range(key, sizeof type, type);
  fprintf(out, "%-35s %-19s %-8s %-10s %s", key->path, type, *key->unit ? key->unit : "-",
          default_words(key), key->doc);
  if (key->words && key->type != SCHEMA_LIST) {
    bool alternative = key->type == SCHEMA_NUMBER || key->type == SCHEMA_INTEGER;
    fputs(alternative ? " [or " : " [", out);
    print_words(key->words, out);
    fputc(']', out);
  }
  fputc('\n', out);
}

/* Whether `key` is `prefix` or below it; the [] of lists need not be written. */
static bool begins_with(const char *key, const char *prefix) {
  while (*prefix) {
    if (strncmp(key, "[]", 2) == 0 && *prefix != '[') key += 2;
    if (*key++ != *prefix++) return false;
  }
  return *key == '\0' || *key == '.' || *key == '[';
}

int schema_print(const schema *table, const char *prefix, FILE *out) {
  int n = 0;
  for (int i = 0; i < table->nkey; i++) {
    const schema_key *key = &table->key[i];
    if (*prefix && !begins_with(key->path, prefix)) continue;
    if (n++ == 0)
      fprintf(out, "%-35s %-19s %-8s %-10s %s\n", "KEY", "TYPE", "UNIT", "DEFAULT", "MEANING");
    print_key(key, out);
  }
  return n;
}
