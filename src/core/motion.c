/* Prescribed motion of supports. */
#include <stdlib.h>

#include "core/model.h"

static corot_status check(const corot_motion *from, int k) {
  double length = 0, size = 0;
  for (int c = 0; c < 3; c++) {
    length += from->axis[c] * from->axis[c];
    size += fabs(from->center[c]) + fabs(from->velocity[c]);
  }
  if (from->kind == COROT_ROTATE && !(length > 0 && isfinite(length)))
    return corot_fail(COROT_EINVAL, "motion %d: the axis has no direction", k);
  if (!isfinite(size + from->rate))
    return corot_fail(COROT_EINVAL, "motion %d: a number is not finite", k);
  if (!isfinite(from->from) || !(from->from < from->to))
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

static corot_status create(const corot_model *m, const corot_motion *from, int k, char (*held)[3],
                           motion *to) {
  const corot_group *group;
  COROT_TRY(check(from, k));
  COROT_TRY(model_find_group(m->mesh, from->group, "motion", &group));
  COROT_TRY(claim(group, k, held));
  to->kind = from->kind;
  to->rate = from->rate, to->from = from->from, to->to = from->to;
  double length = sqrt(from->axis[0] * from->axis[0] + from->axis[1] * from->axis[1] +
                       from->axis[2] * from->axis[2]);
  for (int c = 0; c < 3; c++) {
    to->axis[c] = from->kind == COROT_ROTATE ? from->axis[c] / length : 0;
    to->center[c] = from->center[c];
    to->velocity[c] = from->velocity[c];
  }
  to->node = malloc(group->nnode * sizeof *to->node);
  if (!to->node) return corot_fail(COROT_ENOMEM, "no memory for motion %d", k);
  memcpy(to->node, group->node, group->nnode * sizeof *to->node);
  to->nnode = group->nnode;
  return COROT_OK;
}

corot_status motions_create(const corot_model_def *def, corot_model *m, char (*held)[3]) {
  m->motion = calloc(def->nmotion + 1, sizeof *m->motion);
  if (!m->motion) return corot_fail(COROT_ENOMEM, "no memory for %d motions", def->nmotion);
  m->nmotion = def->nmotion;
  for (int k = 0; k < def->nmotion; k++)
    COROT_TRY(create(m, &def->motion[k], k, held, &m->motion[k]));
  return COROT_OK;
}

void motions_destroy(corot_model *m) {
  for (int k = 0; k < m->nmotion; k++) free(m->motion[k].node);
  free(m->motion);
}

/* How long the motion has lasted at t, and whether it goes on, by the law in force at `phase`. */
static double lasted(const motion *a, double phase, double t, bool *moving) {
  *moving = phase >= a->from && phase < a->to;
  if (*moving) return t - a->from;
  return phase < a->from ? 0 : a->to - a->from;
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

void model_displacement(const corot_model *m, double phase, double t, const double *u,
                        double *nodal, int stride) {
  model_spread(m, u, nodal, stride);
  for (int k = 0; k < m->nmotion; k++) {
    const motion *a = &m->motion[k];
    bool moving;
    double s = lasted(a, isnan(phase) ? t : phase, t, &moving);
    double sine = sin(a->rate * s), half = sin(a->rate * s / 2), versine = 2 * half * half;
    for (int i = 0; i < a->nnode; i++) {
      double w[3], d[3];
      spin_arms(a, m->mesh->x[a->node[i]], w, d);
      for (int c = 0; c < 3; c++)
        nodal[a->node[i] * stride + c] =
            a->kind == COROT_ROTATE ? sine * w[c] + versine * d[c] : a->velocity[c] * s;
    }
  }
}

void model_velocity(const corot_model *m, double phase, double t, const double *v, double *nodal,
                    int stride) {
  model_spread(m, v, nodal, stride);
  for (int k = 0; k < m->nmotion; k++) {
    const motion *a = &m->motion[k];
    bool moving;
    double s = lasted(a, isnan(phase) ? t : phase, t, &moving);
    double cosine = cos(a->rate * s), sine = sin(a->rate * s);
    if (!moving) continue; /* at rest: spread has set zero */
    for (int i = 0; i < a->nnode; i++) {
      double w[3], d[3];
      spin_arms(a, m->mesh->x[a->node[i]], w, d);
      for (int c = 0; c < 3; c++)
        nodal[a->node[i] * stride + c] =
            a->kind == COROT_ROTATE ? a->rate * (cosine * w[c] + sine * d[c]) : a->velocity[c];
    }
  }
}
