/* What a study measures: norms of the errors, and quantities, which all of its runs are asked for.
 */
#include <stdio.h>
#include <string.h>

#include "app/scenario/scenario_quantities.h"
#include "app/text/no_memory.h"
#include "app/text/suggest.h"
#include "study.h"

static bool is_norm(const char *text) {
  size_t length = strlen(text);
  for (const char *w = STUDY_NORMS; *w;) {
    size_t n = strcspn(w, "|");
    if (n == length && memcmp(w, text, n) == 0) return true;
    w += n + (w[n] == '|');
  }
  return false;
}

/* A word that is no quantity may have been meant for a norm. */
static corot_status no_measure(const config_node *node, size_t at) {
  char near[32] = "";
  if (!strpbrk(node->text, "(@,)")) {
    suggest_among(node->text, STUDY_NORMS, sizeof near, near);
    if (*near) return config_fail(node, "%.64s is no measure; did you mean %s?", node->text, near);
    return config_fail(node,
                       "%.64s is no measure: expected displacement, velocity, energy, mixed, or a "
                       "quantity such as max(corner.ux)",
                       node->text);
  }
  return scenario_quantity_fail(&(quantity_def){.node = node}, at);
}

/* `set` has room for its setting, after those of the study. */
static corot_status add_quantity(study *s, const config_node *node, const quantity *of,
                                 study_quantity *list, setting *set) {
  char text[QUANTITY_TEXT], key[sizeof "quantities." + QUANTITY_TEXT] = "quantities.";
  quantity_print(of, text);
  quantity_name(of, key + strlen(key));
  for (int i = 0; i < s->nquantity; i++) {
    if (strcmp(list[i].text, text) == 0) return COROT_OK;
    if (strcmp(list[i].name, strchr(key, '.') + 1) == 0)
      return config_fail(node, "%.64s and %.64s have one name, %s", list[i].text, text,
                         list[i].name);
  }
  const char *kept = config_copy(s->tree, key, strlen(key));
  const char *of_text = config_copy(s->tree, text, strlen(text));
  if (!kept || !of_text) return no_memory();
  set[s->nset + s->nquantity] = (setting){kept, node};
  list[s->nquantity++] = (study_quantity){.text = of_text, .name = strchr(kept, '.') + 1};
  return COROT_OK;
}

/* The first entry is what cells are compared by. */
static corot_status read_measure(study *s, const config_node *node, bool first,
                                 study_quantity *list, setting *set) {
  quantity q;
  size_t at;
  if (is_norm(node->text)) {
    if (s->still && strcmp(node->text, "velocity") == 0)
      return config_fail(node, "nothing moves in a static study");
    if (first) s->measure = node->text;
    return COROT_OK;
  }
  corot_status status = quantity_parse(node->text, &q, &at);
  if (status != COROT_OK) return no_measure(node, at);
  COROT_TRY(add_quantity(s, node, &q, list, set));
  if (first) s->measure = list[0].text;
  return COROT_OK;
}

corot_status study_read_measures(study *s) {
  const config_node *entries = config_find(s->tree->root, "measure");
  size_t n = (size_t)entries->nchild;
  study_quantity *list = config_alloc(s->tree, n, sizeof *list);
  setting *set = config_alloc(s->tree, n + (size_t)s->nset, sizeof *set);
  if (!list || !set) return no_memory();
  for (int i = 0; i < s->nset; i++) set[i] = s->set[i];
  for (const config_node *c = entries->child; c; c = c->next)
    COROT_TRY(read_measure(s, c, c == entries->child, list, set));
  s->quantity = list;
  s->nset += s->nquantity;
  s->set = set;
  return COROT_OK;
}
