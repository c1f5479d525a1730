/* What holds, moves and pulls the body. */
#include <math.h>

#include "scenario_parts.h"

/* --- Boundary --- */

static void read_fix(config_node *node, corot_fix *fix) {
  fix->group = text_at(node, "group");
  for (const config_node *axis = config_find(node, "fix")->child; axis; axis = axis->next)
    fix->component[axis->text[0] - 'x'] = true;
}

static void read_span(config_node *node, corot_motion *motion) {
  motion->from = number_at(node, "from");
  motion->to = text_is(node, "to", "end") ? INFINITY : number_at(node, "to");
}

static void read_axis(config_node *node, corot_motion *motion) {
  vector_at(node, "axis", motion->axis);
  vector_at(node, "center", motion->center);
}

static void read_rotation(config_node *node, corot_motion *motion) {
  motion->kind = COROT_ROTATE;
  motion->rate = number_at(node, "rate");
  read_axis(node, motion);
  read_span(node, motion);
}

static void read_translation(config_node *node, corot_motion *motion) {
  vector_at(node, "velocity", motion->velocity);
  motion->kind = COROT_TRANSLATE;
  read_span(node, motion);
}

static corot_status read_move(scenario *s, config_node *node, corot_motion *motion) {
  config_node *rotate = config_find(node, "rotate");
  motion->kind = rotate ? COROT_TURN : COROT_MOVE;
  if (rotate) {
    motion->angle = number_at(rotate, "angle");
    read_axis(rotate, motion);
  } else {
    vector_at(node, "direction", motion->direction);
  }
  return scenario_read_amplitude(s, config_find(node, "amplitude"), &motion->amplitude);
}

static corot_status read_motion(scenario *s, config_node *entry, corot_motion *m) {
  config_node *rotate = config_find(entry, "rotate"), *move = config_find(entry, "move");
  m->group = text_at(entry, "group");
  if (move) return read_move(s, move, m);
  if (rotate)
    read_rotation(rotate, m);
  else
    read_translation(config_find(entry, "translate"), m);
  return COROT_OK;
}

static corot_status read_boundary(scenario *s) {
  config_node *list = config_find(s->source->root, "boundary");
  corot_fix *fix = config_alloc(s->source, (size_t)list->nchild, sizeof *fix);
  corot_motion *motion = config_alloc(s->source, (size_t)list->nchild, sizeof *motion);
  if (!fix || !motion) return no_memory();
  s->model.fix = fix;
  s->model.motion = motion;
  for (config_node *c = list->child; c; c = c->next) {
    if (config_find(c, "fix"))
      read_fix(c, &fix[s->model.nfix++]);
    else
      COROT_TRY(config_keep(s->source, read_motion(s, c, &motion[s->model.nmotion++])));
  }
  return COROT_OK;
}

/* --- Loads --- */

static corot_status read_load(scenario *s, config_node *node, corot_load *load) {
  config_node *group = config_find(node, "group"), *amplitude = config_find(node, "amplitude");
  config_node *value = NULL;
  for (int kind = COROT_TRACTION; !value; kind++) {
    value = config_find(node, words_load[kind]);
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
  return amplitude ? scenario_read_amplitude(s, amplitude, &load->amplitude) : COROT_OK;
}

corot_status scenario_read_conditions(scenario *s) {
  COROT_TRY(read_boundary(s));
  config_node *list = config_find(s->source->root, "loads");
  corot_load *load = config_alloc(s->source, (size_t)list->nchild, sizeof *load);
  if (!load) return no_memory();
  s->model.load = load;
  for (config_node *c = list->child; c; c = c->next)
    COROT_TRY(config_keep(s->source, read_load(s, c, &load[s->model.nload++])));
  return COROT_OK;
}
