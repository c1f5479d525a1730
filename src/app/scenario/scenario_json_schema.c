/* The table as a JSON Schema (draft 2020-12), for editors and other programs. */
#include <math.h>
#include <string.h>

#include "app/config/unit.h"
#include "app/text/json_text.h"
#include "scenario_keys.h"

static json_t *map_schema(const char *path);

static json_t *of_type(const char *type) { return json_pack("{s:s}", "type", type); }

/* A bound, as a whole number where it is one. */
static json_t *bound(double x) { return x == (int)x ? json_integer((int)x) : json_real(x); }

static json_t *ranged(const char *type, schema_range range) {
  const schema_bounds *b = &schema_ranges[range];
  json_t *s = of_type(type);
  if (isfinite(b->least))
    s = json_text_with(s, b->above ? "exclusiveMinimum" : "minimum", bound(b->least));
  if (isfinite(b->most))
    s = json_text_with(s, b->below ? "exclusiveMaximum" : "maximum", bound(b->most));
  return s;
}

static json_t *words_list(const char *words) {
  json_t *list = json_array();
  while (*words) {
    size_t length = strcspn(words, "|");
    if (json_array_append_new(list, json_stringn(words, length))) {
      json_decref(list);
      return NULL;
    }
    words += length + (words[length] == '|');
  }
  return list;
}

/* A number of a key with a unit may have one behind it. */
static json_t *quantity_schema(const schema_key *key) {
  measured_unit u;
  json_t *number = ranged("number", key->range);
  if (!unit_of_key(key->unit, &u)) return number;
  return json_pack("{s:[o, {s:s, s:s}]}", "anyOf", number, "type", "string", "pattern",
                   "^[+-]?[0-9.]+([eE][+-]?[0-9]+)? *[^0-9 ,:_*/^.+-]");
}

static json_t *scalar_schema(const char *type, const schema_key *key) {
  json_t *number = strcmp(type, "number") == 0 ? quantity_schema(key) : ranged(type, key->range);
  if (!key->words) return number;
  return json_pack("{s:[o, {s:s}]}", "anyOf", number, "const", key->words);
}

static json_t *list_schema(json_t *items, int least, int most) {
  json_t *s = json_text_with(of_type("array"), "items", items);
  if (least) s = json_text_with(s, "minItems", json_integer(least));
  return most ? json_text_with(s, "maxItems", json_integer(most)) : s;
}

/* [time, value]; the time may have a unit. */
static json_t *pair_schema(void) {
  static const schema_key time = {.unit = "s"}, factor = {.unit = ""};
  json_t *pair =
      json_pack("{s:[o, o]}", "prefixItems", quantity_schema(&time), quantity_schema(&factor));
  pair = json_text_with(pair, "type", json_string("array"));
  pair = json_text_with(pair, "minItems", json_integer(2));
  return json_text_with(pair, "maxItems", json_integer(2));
}

/* Numbers, texts and lists of them; NULL: another type. */
static json_t *plain_schema(const schema_key *key) {
  switch (key->type) {
    case SCHEMA_TEXT:
      return of_type("string");
    case SCHEMA_CHOICE:
      if (strcmp(key->words, "true|false") == 0) return of_type("boolean");
      return json_pack("{s:o}", "enum", words_list(key->words));
    case SCHEMA_NUMBER:
      return scalar_schema("number", key);
    case SCHEMA_INTEGER:
      return scalar_schema("integer", key);
    case SCHEMA_DURATION:
      return json_pack("{s:[o, o]}", "anyOf", ranged("number", key->range), of_type("string"));
    case SCHEMA_VECTOR:
      return list_schema(quantity_schema(key), 3, 3);
    case SCHEMA_COUNTS:
      return list_schema(ranged("integer", key->range), 3, 3);
    case SCHEMA_INTEGERS:
      return list_schema(ranged("integer", key->range), 1, 0);
    case SCHEMA_WORDS:
      return json_text_with(list_schema(json_pack("{s:o}", "enum", words_list(key->words)), 1, 0),
                            "uniqueItems", json_true());
    case SCHEMA_TEXTS:
      return json_pack("{s:[o, o]}", "anyOf", of_type("string"),
                       list_schema(of_type("string"), 1, 0));
    case SCHEMA_VALUES:
      return list_schema(json_object(), 1, 0);
    case SCHEMA_OPEN:
      return of_type("object");
    case SCHEMA_OPENS:
      return list_schema(of_type("object"), 0, 0);
    default:
      return NULL;
  }
}

/* Also maps, and what may stand for one. */
static json_t *value_schema(const schema_key *key) {
  char inside[128];
  schema_inside(key, sizeof inside, inside);
  switch (key->type) {
    case SCHEMA_MAP:
      return map_schema(inside);
    case SCHEMA_NAMED:
      return json_text_with(
          json_text_with(of_type("object"), "additionalProperties", map_schema(inside)),
          "maxProperties", json_integer(CONFIG_MOST_KEYS));
    case SCHEMA_NAMED_TEXTS:
      return json_text_with(
          json_text_with(of_type("object"), "additionalProperties", of_type("string")),
          "maxProperties", json_integer(CONFIG_MOST_KEYS));
    case SCHEMA_LIST:
      return list_schema(map_schema(inside), 0, 0);
    case SCHEMA_MAPS:
      return json_pack("{s:[o, o]}", "anyOf", map_schema(inside),
                       list_schema(map_schema(inside), 1, 0));
    case SCHEMA_SHORT:
      return json_pack("{s:[o, o]}", "anyOf", map_schema(inside),
                       value_schema(schema_child(&scenario_schema, inside, NULL)));
    case SCHEMA_CURVE:
      return json_pack("{s:[o, o]}", "anyOf", list_schema(pair_schema(), 1, 0), map_schema(inside));
    case SCHEMA_STATES:
      return json_pack("{s:[{s:o}, o, o]}", "anyOf", "enum", words_list(key->words),
                       map_schema(inside), list_schema(map_schema(inside), 1, 0));
    default:
      return plain_schema(key);
  }
}

/* The default as the table has it: a number, a word, an empty map or list, or a list of zeros. */
static json_t *default_value(const char *text) {
  if (strcmp(text, "''") == 0) return json_string("");
  json_t *value = json_loads(text, JSON_DECODE_ANY, NULL);
  return value ? value : json_string(text);
}

static json_t *key_schema(const schema_key *key) {
  json_t *s = json_text_with(value_schema(key), "description", json_string(key->doc));
  if (*key->unit) s = json_text_with(s, "unit", json_string(key->unit));
  if (key->fallback) s = json_text_with(s, "default", default_value(key->fallback));
  return s;
}

static json_t *map_schema(const char *path) {
  json_t *properties = json_object(), *required = json_array(), *one_of = json_array();
  bool none = false; /* of those of which there is at most one */
  for (const schema_key *k = NULL; (k = schema_child(&scenario_schema, path, k));) {
    const char *dot = strrchr(k->path, '.');
    const char *name = dot ? dot + 1 : k->path;
    properties = json_text_with(properties, name, key_schema(k));
    if (k->status == SCHEMA_REQUIRED) required = json_text_push(required, json_string(name));
    none |= k->status == SCHEMA_AT_MOST_ONE;
    if (k->status == SCHEMA_ONE_OF || k->status == SCHEMA_AT_MOST_ONE)
      one_of = json_text_push(one_of, json_pack("{s:[s]}", "required", name));
  }
  if (none)
    one_of = json_text_push(one_of, json_pack("{s:{s:o}}", "not", "anyOf", json_copy(one_of)));
  json_t *s = json_text_with(of_type("object"), "properties", properties);
  if (!required || !one_of) s = json_text_with(s, "required", NULL); /* no memory */
  if (json_array_size(required)) s = json_text_with(s, "required", json_incref(required));
  if (json_array_size(one_of)) s = json_text_with(s, "oneOf", json_incref(one_of));
  json_decref(required);
  json_decref(one_of);
  return json_text_with(s, "additionalProperties", json_false());
}

json_t *schema_json(void) {
  json_t *s = map_schema("");
  s = json_text_with(s, "$schema", json_string("https://json-schema.org/draft/2020-12/schema"));
  return json_text_with(s, "title", json_string("corot scenario"));
}
