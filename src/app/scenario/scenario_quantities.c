/* The numbers that are asked for, and what is wrong with one, told with its place in the file. */
#include "scenario_quantities.h"

#include <stdio.h>
#include <string.h>

#include "scenario_parts.h"

/* Where the text of a node begins in its source; false: it does not stand there as it is. */
static bool find_text(const config_node *node, size_t *begin) {
  const config_source *source = node->source;
  size_t length = strlen(node->text);
  if (!source || !source->lines) return false;
  for (size_t at = node->at; at <= node->at + 1; at++) {
    if (at > source->size || source->size - at < length) continue;
    if (memcmp(source->text + at, node->text, length) != 0) continue;
    *begin = at;
    return true;
  }
  return false;
}

/* Of a --set, which is no file: with the text under it. corot_error() is the reason. */
static corot_status fail_in_setting(const config_source *source, const char *path, const char *text,
                                    size_t at) {
  char head[400];
  bool says_path = strstr(source->name, path) != NULL;
  snprintf(head, sizeof head, "%.256s%s%s", source->name, says_path ? "" : ": ",
           says_path ? "" : path);
  return quantity_point(head, text, at);
}

corot_status scenario_quantity_fail(const quantity_def *q, size_t at) {
  const config_source *source = q->node->source;
  char reason[600], path[128];
  size_t begin;
  snprintf(reason, sizeof reason, "%s", corot_error());
  config_path(q->node, sizeof path, path);
  if (find_text(q->node, &begin))
    return config_fail_at(q->node->source, begin + at, "%s: %s", path, reason);
  if (source && !source->lines) return fail_in_setting(source, path, q->node->text, at);
  return config_fail(q->node, "%.200s: %s", q->node->text, reason);
}

static corot_status read_quantity(const config_node *node, double end, quantity_def *q) {
  size_t at;
  q->name = node->key;
  q->node = node;
  if (!scenario_is_column_name(node->key))
    return config_fail_key(node, "the name of a quantity is made of letters, digits, _ and -");
  if (quantity_parse(node->text, &q->quantity, &at) == COROT_OK &&
      quantity_check_window(&q->quantity, end, &at) == COROT_OK)
    return COROT_OK;
  return scenario_quantity_fail(q, at);
}

corot_status scenario_read_quantities(scenario *s) {
  const config_node *map = config_find(s->source->root, "quantities");
  if (!map) return COROT_OK;
  quantity_def *q = config_alloc(s->source, (size_t)map->nchild, sizeof *q);
  if (!q) return no_memory();
  s->quantity = q;
  for (const config_node *c = map->child; c; c = c->next)
    COROT_TRY(config_keep(s->source, read_quantity(c, s->t_end, &q[s->nquantity++])));
  return COROT_OK;
}
