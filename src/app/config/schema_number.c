/* Numbers, with a unit behind them or without. */
#include "schema_number.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "unit.h"

enum { WORDS = 128 };

/* What stands there, in words. */
static void describe(const config_node *node, size_t size, char *text) {
  if (node->kind == CONFIG_MAP)
    snprintf(text, size, "a map");
  else if (node->kind == CONFIG_LIST)
    snprintf(text, size, "a list of %d", node->nchild);
  else if (node->quoted)
    snprintf(text, size, "the text \"%.40s\"", node->text);
  else if (config_is_null(node))
    snprintf(text, size, "nothing");
  else
    snprintf(text, size, "%.40s", node->text);
}

corot_status schema_expected(const config_node *node, const char *what) {
  char found[WORDS];
  describe(node, sizeof found, found);
  return config_fail(node, "expected %s, found %s", what, found);
}

const char *schema_unit_behind(const config_node *node, size_t *digits) {
  if (node->kind != CONFIG_SCALAR) return NULL;
  const char *text = node->text;
  char number[64];
  size_t length = strspn(text, "+-.0123456789");
  const char *exponent = text + length;
  if (length && (*exponent == 'e' || *exponent == 'E')) {
    size_t sign = exponent[1] == '+' || exponent[1] == '-' ? 1 : 0;
    size_t more = strspn(exponent + 1 + sign, "0123456789");
    if (more) length += 1 + sign + more;
  }
  snprintf(number, sizeof number, "%.*s", (int)length, text);
  if (length == 0 || length >= sizeof number || !config_is_decimal(number)) return NULL;
  const char *behind = text + length + strspn(text + length, " ");
  bool letter = strcspn(behind, "_0123456789:,.+-*/^") > 0;
  *digits = length;
  return *behind && letter ? behind : NULL;
}

/* A number with a unit behind it. */
static corot_status check_quantity(config_node *node, const char *behind, size_t digits,
                                   const char *unit) {
  measured_unit given, wanted;
  char wrong[WORDS], near[WORDS];
  if (!unit_of_key(unit, &wanted)) {
    if (strpbrk(behind, "_0123456789")) /* no unit is meant */
      return schema_expected(node, "a finite number in decimal, such as 1.5 or 1.0e-3");
    return schema_expected(node, "a number without a unit");
  }
  bool known = unit_parse(behind, &given, sizeof wrong, wrong);
  if (!known && *wrong) {
    unit_suggest(wrong, sizeof near, near);
    if (!*near && strpbrk(wrong, "0123456789")) /* no unit is meant */
      return schema_expected(node, "a finite number in decimal, such as 1.5 or 1.0e-3");
    if (*near)
      return config_fail(node, "unknown unit %.40s; did you mean %s? (in SI: %s)", wrong, near,
                         unit);
  }
  if (!known || !unit_same(&given, &wanted)) {
    char found[WORDS];
    describe(node, sizeof found, found);
    return config_fail(node, "expected a number in %s, or with another unit of the kind, found %s",
                       unit, found);
  }
  node->number = unit_scale(node->text, digits, &given);
  if (!(node->number - node->number == 0)) return schema_expected(node, "a finite number");
  return COROT_OK;
}

corot_status schema_check_number(config_node *node, schema_demand wanted) {
  size_t digits;
  const char *behind = schema_unit_behind(node, &digits);
  if (behind) {
    COROT_TRY(check_quantity(node, behind, digits, wanted.unit));
  } else if (!config_parse_number(node, &node->number)) {
    if (node->quoted) return schema_expected(node, "a number (without quotes)");
    bool some = node->kind == CONFIG_SCALAR && strpbrk(node->text, "0123456789.");
    return schema_expected(node,
                           some ? "a finite number in decimal, such as 1.5 or 1.0e-3" : "a number");
  }
  if (!schema_in_range(node->number, wanted.range))
    return config_fail(node, "must be %s, found %s", schema_ranges[wanted.range].words, node->text);
  return COROT_OK;
}

corot_status schema_check_integer(config_node *node, schema_demand wanted) {
  COROT_TRY(schema_check_number(node, wanted));
  if (node->number != floor(node->number)) return schema_expected(node, "a whole number");
  if (fabs(node->number) > INT_MAX) return config_fail(node, "must be at most %d", INT_MAX);
  return COROT_OK;
}

/* A number of seconds, or one with its unit after it; the node's number is in seconds. */
corot_status schema_check_duration(config_node *node, schema_range range) {
  static const struct {
    const char *name;
    double seconds;
  } units[] = {{"s", 1}, {"min", 60}, {"h", 3600}, {"d", 86400}};
  const char *text = node->kind == CONFIG_SCALAR ? node->text : "";
  size_t length = strlen(text); /* of the number */
  while (length > 0 && !strchr("0123456789.", text[length - 1])) length--;
  const char *word = text + length + strspn(text + length, " ");
  double seconds = *word ? 0 : 1;
  for (size_t i = 0; i < sizeof units / sizeof *units; i++)
    if (strcmp(word, units[i].name) == 0) seconds = units[i].seconds;
  char digits[64];
  snprintf(digits, sizeof digits, "%.*s", (int)length, text);
  config_node number = {.kind = CONFIG_SCALAR, .text = digits};
  if (!(seconds > 0) || length >= sizeof digits || !config_parse_number(&number, &node->number))
    return schema_expected(node,
                           "seconds, such as 600, or a number and s, min, h or d, such as 10 min");
  node->number *= seconds;
  if (!schema_in_range(node->number, range))
    return config_fail(node, "must be %s, found %s", schema_ranges[range].words, node->text);
  return COROT_OK;
}
