/* Prescribed motion of supports. */
#include <stdio.h>
#include <stdlib.h>

#include "model.h"

static bool turns(const corot_motion *from) {
  return from->kind == COROT_ROTATE || from->kind == COROT_TURN;
}

/* At a constant rate for a time; else by an amplitude. */
static bool has_span(const corot_motion *from) {
  return from->kind == COROT_ROTATE || from->kind == COROT_TRANSLATE;
}

static corot_status check(const corot_motion *from, int k) {
  double length = 0, size = 0;
  for (int c = 0; c < 3; c++) {
    length += from->axis[c] * from->axis[c];
    size += fabs(from->center[c]) + fabs(from->velocity[c]) + fabs(from->direction[c]);
  }
  if (from->kind < COROT_ROTATE || from->kind > COROT_MOVE)
    return corot_fail(COROT_EINVAL, "motion %d: no kind of motion has the number %d", k,
                      (int)from->kind);
  if (turns(from) && !(length > 0 && isfinite(length)))
    return corot_fail(COROT_EINVAL, "motion %d: the axis has no direction", k);
  if (!isfinite(size + from->rate + from->angle))
    return corot_fail(COROT_EINVAL, "motion %d: a number is not finite", k);
  if (has_span(from) && (!isfinite(from->from) || !(from->from < from->to)))
    return corot_fail(COROT_EINVAL, "motion %d: it goes from t = %g to t = %g", k, from->from,
                      from->to);
  return COROT_OK;
}

/* A node may be held by one condition only. */
static corot_status claim(const corot_group *group, int k, char (*held)[3]) {
  for (int i = 0; i < group->nnode; i++) {
    int n = group->node[i];
    for (int c = 0; c < 3; c++) {
      if (held[n][c])
        return corot_fail(COROT_EINVAL, "motion %d: node %d of group '%s' is already held in %c", k,
                          n, group->name, "xyz"[c]);
      held[n][c] = 1;
    }
  }
  return COROT_OK;
}

static void unit_axis(const corot_motion *from, double axis[3]) {
  double length = sqrt(from->axis[0] * from->axis[0] + from->axis[1] * from->axis[1] +
                       from->axis[2] * from->axis[2]);
  for (int c = 0; c < 3; c++) axis[c] = turns(from) ? from->axis[c] / length : 0;
}

/* The motion on the same group that `from` is a part of: any translation, or a turn about the same
   axis; NULL if it starts one of its own. */
static motion *joined(const corot_model *m, const corot_motion *from) {
  double axis[3];
  unit_axis(from, axis);
  for (int k = 0; k < m->nmotion; k++) {
    motion *a = &m->motion[k];
    if (a->turns != turns(from) || strcmp(a->group, from->group) != 0) continue;
    double off = 0;
    for (int c = 0; c < 3; c++)
      off += fabs(a->axis[c] - axis[c]) + fabs(a->center[c] - from->center[c]);
    if (!a->turns || off == 0) return a;
  }
  return NULL;
}

/* A motion without spans or laws yet, of which it may have as many as there are motions. */
static corot_status start(corot_model *m, const corot_motion *from, int k, int most,
                          char (*held)[3]) {
  const corot_group *group;
  COROT_TRY(corot_model_find_group(m->mesh, from->group, "motion", &group));
  COROT_TRY(claim(group, k, held));
  motion *to = &m->motion[m->nmotion++];
  to->turns = turns(from);
  unit_axis(from, to->axis);
  for (int c = 0; c < 3; c++) to->center[c] = from->center[c];
  size_t length = strlen(from->group) + 1;
  to->group = malloc(length);
  to->node = malloc(group->nnode * sizeof *to->node);
  to->span = malloc(most * sizeof *to->span);
  to->law = calloc(most, sizeof *to->law);
  if (!to->group || !to->node || !to->span || !to->law)
    return corot_fail(COROT_ENOMEM, "no memory for motion %d", k);
  memcpy(to->group, from->group, length);
  memcpy(to->node, group->node, group->nnode * sizeof *to->node);
  to->nnode = group->nnode;
  return COROT_OK;
}

static corot_status add_span(motion *to, const corot_motion *from, int k) {
  motion_span *span = &to->span[to->nspan];
  for (int i = 0; i < to->nspan; i++)
    if (from->from < to->span[i].to && to->span[i].from < from->to)
      return corot_fail(COROT_EINVAL,
                        "motion %d: group '%s' is already moving from t = %g to t = %g", k,
                        from->group, to->span[i].from, to->span[i].to);
  *span = (motion_span){.rate = from->rate, .from = from->from, .to = from->to};
  for (int c = 0; c < 3; c++) span->velocity[c] = from->velocity[c];
  to->nspan++;
  return COROT_OK;
}

static corot_status add_law(motion *to, const corot_motion *from, int k) {
  motion_law *law = &to->law[to->nlaw];
  char user[32];
  snprintf(user, sizeof user, "motion %d: ", k);
  COROT_TRY(corot_amplitude_create(&from->amplitude, user, &law->amplitude));
  to->nlaw++;
  double jump = corot_amplitude_jump(&law->amplitude);
  if (!isnan(jump))
    return corot_fail(COROT_EINVAL,
                      "motion %d: its amplitude jumps at t = %g, and group '%s' cannot be in two "
                      "places: let it take a time",
                      k, jump, from->group);
  law->angle = from->angle;
  for (int c = 0; c < 3; c++) law->direction[c] = from->direction[c];
  return COROT_OK;
}

corot_status corot_motions_create(const corot_model_def *def, corot_model *m, char (*held)[3]) {
  m->motion = calloc(def->nmotion + 1, sizeof *m->motion);
  if (!m->motion) return corot_fail(COROT_ENOMEM, "no memory for %d motions", def->nmotion);
  for (int k = 0; k < def->nmotion; k++) {
    const corot_motion *from = &def->motion[k];
    COROT_TRY(check(from, k));
    motion *to = from->group ? joined(m, from) : NULL;
    if (!to) {
      COROT_TRY(start(m, from, k, def->nmotion, held));
      to = &m->motion[m->nmotion - 1];
    }
    COROT_TRY(has_span(from) ? add_span(to, from, k) : add_law(to, from, k));
  }
  return COROT_OK;
}

void corot_motions_destroy(corot_model *m) {
  for (int k = 0; k < m->nmotion; k++) {
    free(m->motion[k].group);
    free(m->motion[k].node);
    free(m->motion[k].span);
    for (int i = 0; i < m->motion[k].nlaw; i++)
      corot_amplitude_clear(&m->motion[k].law[i].amplitude);
    free(m->motion[k].law);
  }
  free(m->motion);
}

/* Where a motion stands at t, and how fast it goes, at an instant. */
typedef struct progress {
  double angle, rate, shift[3], velocity[3];
} progress;

static progress progress_at(const motion *a, const instant *now) {
  progress p = {0};
  double t = now->t, phase = isnan(now->side) ? t : now->side;
  for (int k = 0; k < a->nspan; k++) {
    const motion_span *s = &a->span[k];
    if (phase < s->from) continue;
    bool moving = phase < s->to;
    double lasted = moving ? t - s->from : s->to - s->from;
    p.angle += s->rate * lasted;
    p.rate += moving ? s->rate : 0;
    for (int c = 0; c < 3; c++) {
      p.shift[c] += s->velocity[c] * lasted;
      p.velocity[c] += moving ? s->velocity[c] : 0;
    }
  }
  for (int k = 0; k < a->nlaw; k++) {
    const motion_law *l = &a->law[k];
    double factor = corot_amplitude_at(&l->amplitude, phase, t);
    double change = corot_amplitude_rate(&l->amplitude, phase, t);
    p.angle += factor * l->angle;
    p.rate += change * l->angle;
    for (int c = 0; c < 3; c++) {
      p.shift[c] += factor * l->direction[c];
      p.velocity[c] += change * l->direction[c];
    }
  }
  return p;
}

/* w = axis x (X - center); d = its part along the axis is none, so Rodrigues' formula reads
   u = sin(angle) w + (1 - cos(angle)) axis x w. */
static void spin_arms(const motion *a, const double X[3], double w[3], double d[3]) {
  double arm[3];
  for (int c = 0; c < 3; c++) arm[c] = X[c] - a->center[c];
  for (int c = 0; c < 3; c++) {
    int i = (c + 1) % 3, j = (c + 2) % 3;
    w[c] = a->axis[i] * arm[j] - a->axis[j] * arm[i];
  }
  for (int c = 0; c < 3; c++) {
    int i = (c + 1) % 3, j = (c + 2) % 3;
    d[c] = a->axis[i] * w[j] - a->axis[j] * w[i];
  }
}

void corot_model_displacement(const corot_model *m, const instant *now, const double *u,
                              double *nodal, int stride) {
  corot_model_spread(m, u, nodal, stride);
  for (int k = 0; k < m->nmotion; k++) {
    const motion *a = &m->motion[k];
    progress p = progress_at(a, now);
    double sine = sin(p.angle), half = sin(p.angle / 2), versine = 2 * half * half;
    for (int i = 0; i < a->nnode; i++) {
      double w[3], d[3];
      spin_arms(a, m->mesh->x[a->node[i]], w, d);
      for (int c = 0; c < 3; c++)
        nodal[a->node[i] * stride + c] = a->turns ? sine * w[c] + versine * d[c] : p.shift[c];
    }
  }
}

void corot_model_velocity(const corot_model *m, const instant *now, const double *v, double *nodal,
                          int stride) {
  corot_model_spread(m, v, nodal, stride);
  for (int k = 0; k < m->nmotion; k++) {
    const motion *a = &m->motion[k];
    progress p = progress_at(a, now);
    double cosine = cos(p.angle), sine = sin(p.angle);
    for (int i = 0; i < a->nnode; i++) {
      double w[3], d[3];
      spin_arms(a, m->mesh->x[a->node[i]], w, d);
      for (int c = 0; c < 3; c++)
        nodal[a->node[i] * stride + c] =
            a->turns ? p.rate * (cosine * w[c] + sine * d[c]) : p.velocity[c];
    }
  }
}

bool corot_motions_carry(const corot_model *m, const instant *now, rigid_motion *all) {
  const motion *moving = NULL;
  progress p = {0}, of_it = {0};
  if (isnan(now->side)) return false;
  for (int k = 0; k < m->nmotion; k++) {
    const motion *a = &m->motion[k];
    p = progress_at(a, now);
    if (p.rate == 0 && p.velocity[0] == 0 && p.velocity[1] == 0 && p.velocity[2] == 0) continue;
    if (moving || a->nlaw > 0) return false;
    moving = a, of_it = p;
  }
  if (!moving || m->body_nnode * 3 - m->body_ndof != 3 * moving->nnode) return false;
  for (int c = 0; c < 3; c++) {
    all->velocity[c] = moving->turns ? 0 : of_it.velocity[c];
    all->spin[c] = moving->turns ? of_it.rate * moving->axis[c] : 0;
    all->center[c] = moving->center[c];
  }
  return true;
}
