/* Finding a key in a table, and what its columns say in words. */
#include "schema.h"

#include <math.h>
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
  bool named = key->type == SCHEMA_NAMED || key->type == SCHEMA_NAMED_SHORT;
  const char *suffix = key->type == SCHEMA_LIST ? "[]" : named ? ".NAME" : "";
  snprintf(path, size, "%s%s", elsewhere ? key->words : key->path, elsewhere ? "" : suffix);
}

const schema_bounds schema_ranges[] = {
    [SCHEMA_ANY] = {.words = "", .least = -INFINITY, .most = INFINITY},
    [SCHEMA_POSITIVE] = {.words = "> 0", .least = 0, .above = true, .most = INFINITY},
    [SCHEMA_NOT_NEGATIVE] = {.words = ">= 0", .least = 0, .most = INFINITY},
    [SCHEMA_FRACTION] = {.words = "> 0, < 1", .least = 0, .above = true, .most = 1, .below = true},
    [SCHEMA_UNIT] = {.words = "0 to 1", .least = 0, .most = 1},
    [SCHEMA_ORDER] = {.words = "1 to 5", .least = 1, .most = 5},
    [SCHEMA_STAGE_ORDER] = {.words = "2 to 8", .least = 2, .most = 8},
    [SCHEMA_POISSON] =
        {.words = "> -1, < 0.5", .least = -1, .above = true, .most = 0.5, .below = true},
};

bool schema_in_range(double x, schema_range range) {
  const schema_bounds *b = &schema_ranges[range];
  return (b->above ? x > b->least : x >= b->least) && (b->below ? x < b->most : x <= b->most);
}
