/* Factors in time, of loads and of moving supports. */
#include <stdio.h>

#include "core/model/amplitude.h"
#include "curve_file.h"
#include "scenario_parts.h"

static corot_status read_list(config *tree, const config_node *list, corot_amplitude *a) {
  double *time = config_alloc(tree, 2 * (size_t)list->nchild, sizeof *time);
  if (!time) return no_memory();
  double *value = time + list->nchild;
  const config_node *pair = list->child;
  for (int i = 0; i < list->nchild; i++, pair = pair->next) {
    time[i] = pair->child->number;
    value[i] = pair->child->next->number;
  }
  *a = (corot_amplitude){.n = list->nchild, .time = time, .value = value};
  return COROT_OK;
}

/* The file is as much a part of the scenario as points that stand in it: its sum enters the
   resolved scenario, and so the identity of a run. */
static corot_status read_table(scenario *s, config_node *map, bool jumps, corot_amplitude *a) {
  const config_node *file = config_find(map, "file"), *sum = config_find(map, "sha256");
  if (!*file->text) return config_fail(file, "the name is empty");
  const char *path = config_beside(s->source, s->path, file->text);
  if (!path) return no_memory();
  curve c;
  COROT_TRY(curve_file_read(s->source, file, path, jumps, &c));
  if (!sum) COROT_TRY(config_add_text(s->source, map, "sha256", c.digest));
  if (sum && strcmp(sum->text, c.digest) != 0)
    return config_fail(sum,
                       "%s has another sum, %s: it is not the file this scenario was made with",
                       path, c.digest);
  *a = (corot_amplitude){.n = c.n, .time = c.time, .value = c.value};
  return COROT_OK;
}

static corot_status read_points(scenario *s, config_node *node, bool jumps, corot_amplitude *a) {
  if (node->kind == CONFIG_MAP) return read_table(s, node, jumps, a);
  return read_list(s->source, node, a);
}

static void read_sine(config_node *node, corot_amplitude *a) {
  *a = (corot_amplitude){.curve = COROT_CURVE_SINE,
                         .frequency = number_at(node, "frequency"),
                         .phase = number_at(node, "phase"),
                         .offset = number_at(node, "offset")};
}

/* The value of a list at which a jump ends. */
static corot_status refuse_jumps(const config_node *list, const char *why) {
  const config_node *before = NULL;
  for (const config_node *c = list->child; c; before = c, c = c->next)
    if (before && c->child->number == before->child->number)
      return config_fail(c->child, "the second point at %s: %s", c->child->text, why);
  return COROT_OK;
}

corot_status scenario_read_amplitude(scenario *s, config_node *node, bool jumps,
                                     corot_amplitude *a) {
  bool map = node->kind == CONFIG_MAP;
  config_node *sine = map ? config_find(node, "sine") : NULL;
  config_node *smooth = map ? config_find(node, "smooth") : NULL, *points = smooth ? smooth : node;
  config_node *sum = map ? config_find(node, "sha256") : NULL;
  /* what one form of amplitude allows and another does not */
  if (sum && (sine || smooth)) return config_fail_key(sum, "is for a file");
  if (points->kind == CONFIG_LIST && smooth)
    COROT_TRY(refuse_jumps(points, "a smooth amplitude has no jumps"));
  if (points->kind == CONFIG_LIST && !jumps)
    COROT_TRY(refuse_jumps(points, "a support cannot be in two places; let it take a time"));
  if (sine)
    read_sine(sine, a);
  else
    COROT_TRY(read_points(s, points, jumps && !smooth, a));
  if (smooth) a->curve = COROT_CURVE_SMOOTH;

  /* made once, for what only the core can refuse */
  amplitude made;
  corot_status status = corot_amplitude_create(a, "", &made);
  if (status == COROT_EINVAL) return config_fail(points, "%s", corot_error());
  COROT_TRY(status);
  corot_amplitude_clear(&made);
  return COROT_OK;
}

corot_status scenario_check_moved_start(const config_node *node, const corot_amplitude *a) {
  amplitude made;
  COROT_TRY(corot_amplitude_create(a, "", &made));
  double at = corot_amplitude_at(&made, NAN, 0), most = fmax(fabs(made.least), fabs(made.most));
  corot_amplitude_clear(&made);
  if (fabs(at) <= 1e-6 * most) return COROT_OK;
  char hint[96] = "";
  if (a->curve == COROT_CURVE_SINE)
    snprintf(hint, sizeof hint, " (a sine with this phase does with offset: %.17g)",
             -sin(a->phase));
  return config_fail(node,
                     "is %g at t = 0, and the support away from where it holds a body at rest: "
                     "begin at 0%s, or with start: equilibrium",
                     at, hint);
}

void scenario_describe_amplitude(const corot_amplitude *a, size_t size, char *text) {
  amplitude made;
  *text = '\0';
  if (a->curve == COROT_CURVE_SINE) {
    int used = snprintf(text, size, "sine of %g Hz", a->frequency);
    if (a->phase != 0)
      used += snprintf(text + used, size - (size_t)used, ", phase %g rad", a->phase);
    if (a->offset != 0) snprintf(text + used, size - (size_t)used, ", offset %g", a->offset);
    return;
  }
  if (a->n == 0 || corot_amplitude_create(a, "", &made)) return;
  /* points: how many, jumps, and their extent */
  bool smooth = a->curve == COROT_CURVE_SMOOTH;
  int used = snprintf(text, size, "%s%d point%s", smooth ? "smooth through " : "", a->n,
                      a->n == 1 ? "" : "s");
  int njump = 0;
  for (int i = 1; i < a->n; i++) njump += a->time[i] == a->time[i - 1];
  if (njump)
    used += snprintf(text + used, size - (size_t)used, ", %d jump%s", njump, njump == 1 ? "" : "s");
  snprintf(text + used, size - (size_t)used, ", t = %g to %g s, values %g to %g", a->time[0],
           a->time[a->n - 1], made.least, made.most);
  corot_amplitude_clear(&made);
}
