/* Finding a key in a table, and what its columns say in words. */
#include "schema.h"

#include <stdio.h>
#include <string.h>

const schema_key *schema_child(const schema *table, const char *path, const schema_key *previous) {
  size_t length = strlen(path);
  const schema_key *first = previous ? previous + 1 : table->key;
  for (const schema_key *k = first; k < table->key + table->nkey; k++) {
    const char *rest = k->path;
    if (length) {
      if (strncmp(rest, path, length) != 0 || rest[length] != '.') continue;
      rest += length + 1;
    }
    if (!strchr(rest, '.')) return k;
  }
  return NULL;
}

const schema_key *schema_find(const schema *table, const char *path) {
  for (int i = 0; i < table->nkey; i++)
    if (strcmp(table->key[i].path, path) == 0) return &table->key[i];
  return NULL;
}

void schema_inside(const schema_key *key, size_t size, char *path) {
  bool elsewhere = key->type == SCHEMA_LIST && key->words;
  const char *suffix = key->type == SCHEMA_LIST ? "[]" : key->type == SCHEMA_NAMED ? ".NAME" : "";
  snprintf(path, size, "%s%s", elsewhere ? key->words : key->path, elsewhere ? "" : suffix);
}

const char *schema_range_words(schema_range range) {
  switch (range) {
    case SCHEMA_POSITIVE:
      return "> 0";
    case SCHEMA_NOT_NEGATIVE:
      return ">= 0";
    case SCHEMA_FRACTION:
      return "> 0, < 1";
    case SCHEMA_ORDER:
      return "1 to 5";
    case SCHEMA_STAGE_ORDER:
      return "2 to 8";
    case SCHEMA_UNIT:
      return "0 to 1";
    case SCHEMA_POISSON:
      return "> -1, < 0.5";
    default:
      return "";
  }
}
