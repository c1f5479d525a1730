/* What holds, moves and pulls the body. */
#include <math.h>

#include "scenario_parts.h"

/* --- Boundary --- */

static void read_fix(config_node *node, corot_fix *fix) {
  fix->group = text_at(node, "group");
  for (const config_node *axis = config_find(node, "fix")->child; axis; axis = axis->next)
    fix->component[axis->text[0] - 'x'] = true;
}

static corot_status read_span(config_node *node, corot_motion *motion) {
  motion->from = number_at(node, "from");
  motion->to = text_is(node, "to", "end") ? INFINITY : number_at(node, "to");
  if (motion->to > motion->from) return COROT_OK;
  return config_fail(config_find(node, "to"), "must be later than from, %g s", motion->from);
}

static corot_status read_rotation(config_node *node, corot_motion *motion) {
  double *axis = motion->axis;
  vector_at(node, "axis", axis);
  vector_at(node, "center", motion->center);
  motion->kind = COROT_ROTATE;
  motion->rate = number_at(node, "rate");
  double square = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
  if (!(square > 0 && isfinite(square)))
    return config_fail(config_find(node, "axis"), "[%g, %g, %g] has no direction", axis[0], axis[1],
                       axis[2]);
  return read_span(node, motion);
}

static corot_status read_translation(config_node *node, corot_motion *motion) {
  vector_at(node, "velocity", motion->velocity);
  motion->kind = COROT_TRANSLATE;
  return read_span(node, motion);
}

/* The direction and the place of what a motion turns about; the same for all translations. */
static void turning(const corot_motion *m, double about[6]) {
  const double *a = m->axis;
  double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  for (int k = 0; k < 3; k++) {
    about[k] = m->kind == COROT_ROTATE ? a[k] / length : 0;
    about[3 + k] = m->center[k];
  }
}

/* Motions of one group follow one another. */
static corot_status check_sequence(const scenario *s, config_node *node, const corot_motion *m) {
  double about[6], before[6];
  turning(m, about);
  for (const corot_motion *other = s->motion; other < m; other++) {
    if (strcmp(other->group, m->group) != 0) continue;
    turning(other, before);
    bool same = other->kind == m->kind;
    for (int k = 0; k < 6; k++) same = same && before[k] == about[k];
    if (!same)
      return config_fail(node, "does not continue the other motion of %s: it has to %s", m->group,
                         other->kind == COROT_ROTATE ? "turn about the same axis" : "translate");
    if (m->from < other->to && other->from < m->to)
      return config_fail(node, "%s is moving already, from t = %g s to t = %g s", m->group,
                         other->from, other->to);
  }
  return COROT_OK;
}

static corot_status read_boundary(scenario *s) {
  config_node *list = config_find(s->source->root, "boundary");
  corot_fix *fix = config_alloc(s->source, (size_t)list->nchild, sizeof *fix);
  corot_motion *motion = config_alloc(s->source, (size_t)list->nchild, sizeof *motion);
  if (!fix || !motion) return no_memory();
  s->fix = fix;
  s->motion = motion;
  for (config_node *c = list->child; c; c = c->next) {
    config_node *rotate = config_find(c, "rotate"), *translate = config_find(c, "translate");
    if (!rotate && !translate) {
      read_fix(c, &fix[s->nfix++]);
      continue;
    }
    corot_motion *m = &motion[s->nmotion++];
    m->group = text_at(c, "group");
    COROT_TRY(rotate ? read_rotation(rotate, m) : read_translation(translate, m));
    COROT_TRY(check_sequence(s, rotate ? rotate : translate, m));
  }
  return COROT_OK;
}

/* --- Loads --- */

static corot_status read_amplitude(config *tree, const config_node *list, corot_amplitude *a) {
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

const char *const scenario_load_words[] = {
    [COROT_TRACTION] = "traction",
    [COROT_GRAVITY] = "gravity",
    [COROT_FORCE] = "force",
    [COROT_PRESSURE] = "pressure",
};

static corot_status read_load(config *tree, config_node *node, corot_load *load) {
  config_node *group = config_find(node, "group"), *amplitude = config_find(node, "amplitude");
  config_node *value = NULL;
  for (int kind = COROT_TRACTION; !value; kind++) {
    value = config_find(node, scenario_load_words[kind]);
    load->kind = (corot_load_kind)kind;
  }
  if (load->kind == COROT_GRAVITY && group)
    return config_fail_key(group, "gravity acts on the whole body: no group");
  if (load->kind != COROT_GRAVITY && !group)
    return config_fail(node, "group is missing, on which the %s acts", value->key);
  load->group = group ? group->text : NULL;
  if (load->kind == COROT_PRESSURE)
    load->value[0] = value->number;
  else
    vector_at(node, value->key, load->value);
  return amplitude ? read_amplitude(tree, amplitude, &load->amplitude) : COROT_OK;
}

corot_status scenario_read_conditions(scenario *s) {
  COROT_TRY(read_boundary(s));
  config_node *list = config_find(s->source->root, "loads");
  corot_load *load = config_alloc(s->source, (size_t)list->nchild, sizeof *load);
  if (!load) return no_memory();
  s->load = load;
  for (config_node *c = list->child; c; c = c->next)
    COROT_TRY(read_load(s->source, c, &load[s->nload++]));
  return COROT_OK;
}
