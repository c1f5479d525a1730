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

static corot_status read_axis(config_node *node, corot_motion *motion) {
  double *axis = motion->axis;
  vector_at(node, "axis", axis);
  vector_at(node, "center", motion->center);
  double square = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
  if (square > 0 && isfinite(square)) return COROT_OK;
  return config_fail(config_find(node, "axis"), "[%g, %g, %g] has no direction", axis[0], axis[1],
                     axis[2]);
}

static corot_status read_rotation(config_node *node, corot_motion *motion) {
  motion->kind = COROT_ROTATE;
  motion->rate = number_at(node, "rate");
  COROT_TRY(read_axis(node, motion));
  return read_span(node, motion);
}

static corot_status read_translation(config_node *node, corot_motion *motion) {
  vector_at(node, "velocity", motion->velocity);
  motion->kind = COROT_TRANSLATE;
  return read_span(node, motion);
}

static corot_status read_move(scenario *s, config_node *node, corot_motion *motion) {
  config_node *rotate = config_find(node, "rotate");
  motion->kind = rotate ? COROT_TURN : COROT_MOVE;
  if (rotate) {
    motion->angle = number_at(rotate, "angle");
    COROT_TRY(read_axis(rotate, motion));
  } else {
    vector_at(node, "direction", motion->direction);
  }
  return scenario_read_amplitude(s, config_find(node, "amplitude"), false, &motion->amplitude);
}

static bool turns(const corot_motion *m) {
  return m->kind == COROT_ROTATE || m->kind == COROT_TURN;
}

static bool has_span(const corot_motion *m) {
  return m->kind == COROT_ROTATE || m->kind == COROT_TRANSLATE;
}

/* The direction and the place of what a motion turns about; the same for all translations. */
static void turning(const corot_motion *m, double about[6]) {
  const double *a = m->axis;
  double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  for (int k = 0; k < 3; k++) {
    about[k] = turns(m) ? a[k] / length : 0;
    about[3 + k] = m->center[k];
  }
}

/* Motions of one group add up; those of constant rate follow one another. */
static corot_status check_sequence(const scenario *s, config_node *node, const corot_motion *m) {
  double about[6], before[6];
  turning(m, about);
  for (const corot_motion *other = s->motion; other < m; other++) {
    if (strcmp(other->group, m->group) != 0) continue;
    turning(other, before);
    bool same = turns(other) == turns(m);
    for (int k = 0; k < 6; k++) same = same && before[k] == about[k];
    if (!same)
      return config_fail(node, "does not continue the other motion of %s: it has to %s", m->group,
                         turns(other) ? "turn about the same axis" : "translate");
    bool spans = has_span(m) && has_span(other);
    if (spans && m->from < other->to && other->from < m->to)
      return config_fail(node, "%s is moving already, from t = %g s to t = %g s", m->group,
                         other->from, other->to);
  }
  return COROT_OK;
}

static corot_status read_motion(scenario *s, config_node *entry, corot_motion *m) {
  config_node *rotate = config_find(entry, "rotate"), *move = config_find(entry, "move");
  config_node *translate = config_find(entry, "translate");
  m->group = text_at(entry, "group");
  COROT_TRY(rotate ? read_rotation(rotate, m)
            : move ? read_move(s, move, m)
                   : read_translation(translate, m));
  return check_sequence(s, rotate ? rotate : move ? move : translate, m);
}

static corot_status read_boundary(scenario *s) {
  config_node *list = config_find(s->source->root, "boundary");
  corot_fix *fix = config_alloc(s->source, (size_t)list->nchild, sizeof *fix);
  corot_motion *motion = config_alloc(s->source, (size_t)list->nchild, sizeof *motion);
  if (!fix || !motion) return no_memory();
  s->fix = fix;
  s->motion = motion;
  for (config_node *c = list->child; c; c = c->next) {
    if (config_find(c, "fix"))
      read_fix(c, &fix[s->nfix++]);
    else
      COROT_TRY(read_motion(s, c, &motion[s->nmotion++]));
  }
  return COROT_OK;
}

/* --- Loads --- */

const char *const scenario_load_words[] = {
    [COROT_TRACTION] = "traction",
    [COROT_GRAVITY] = "gravity",
    [COROT_FORCE] = "force",
    [COROT_PRESSURE] = "pressure",
};

static corot_status read_load(scenario *s, config_node *node, corot_load *load) {
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
  return amplitude ? scenario_read_amplitude(s, amplitude, true, &load->amplitude) : COROT_OK;
}

corot_status scenario_read_conditions(scenario *s) {
  COROT_TRY(read_boundary(s));
  config_node *list = config_find(s->source->root, "loads");
  corot_load *load = config_alloc(s->source, (size_t)list->nchild, sizeof *load);
  if (!load) return no_memory();
  s->load = load;
  for (config_node *c = list->child; c; c = c->next) COROT_TRY(read_load(s, c, &load[s->nload++]));
  return COROT_OK;
}
