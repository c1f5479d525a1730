/* Prescribed motion of supports. */
#include <stdlib.h>
#include <string.h>

#include "core/base/fault.h"
#include "definition.h"
#include "inputs.h"

static bool turns(const corot_motion *from) {
  return from->kind == COROT_ROTATE || from->kind == COROT_TURN;
}

/* At a constant rate for a time; else by an amplitude. */
static bool has_span(const corot_motion *from) {
  return from->kind == COROT_ROTATE || from->kind == COROT_TRANSLATE;
}

static void unit_axis(const corot_motion *from, double axis[3]) {
  double length = sqrt(from->axis[0] * from->axis[0] + from->axis[1] * from->axis[1] +
                       from->axis[2] * from->axis[2]);
  for (int c = 0; c < 3; c++) axis[c] = turns(from) ? from->axis[c] / length : 0;
}

/* Kind, numbers and times of one motion alone. */
static corot_status check_numbers(const corot_motion *from, int k) {
  double length = 0, size = 0;
  for (int c = 0; c < 3; c++) {
    length += from->axis[c] * from->axis[c];
    size += fabs(from->center[c]) + fabs(from->velocity[c]) + fabs(from->direction[c]);
  }
  if (from->kind < COROT_ROTATE || from->kind > COROT_MOVE)
    return corot_fail_at("motion", k, "kind", "no kind of motion has the number %d",
                         (int)from->kind);
  if (turns(from) && !(length > 0 && isfinite(length)))
    return corot_fail_at("motion", k, "axis", "the axis has no direction: it is [%g, %g, %g]",
                         from->axis[0], from->axis[1], from->axis[2]);
  if (!isfinite(size + from->rate + from->angle))
    return corot_fail_at("motion", k, "", "a number is not finite");
  if (has_span(from) && (!isfinite(from->from) || !(from->from < from->to)))
    return corot_fail_at("motion", k, "to",
                         "it goes from t = %g to t = %g s: to must be later than from", from->from,
                         from->to);
  return COROT_OK;
}

/* Whether two motions of one group add up: any translations, or turns about the same axis. */
static bool adds_up(const corot_motion *a, const corot_motion *b) {
  double of_a[3], of_b[3], off = 0;
  if (turns(a) != turns(b)) return false;
  if (!turns(a)) return true;
  unit_axis(a, of_a);
  unit_axis(b, of_b);
  for (int c = 0; c < 3; c++) off += fabs(of_a[c] - of_b[c]) + fabs(a->center[c] - b->center[c]);
  return off == 0;
}

/* Motions of one group add up; those of constant rate follow one another. */
static corot_status check_sequence(const corot_model_def *def, int k) {
  const corot_motion *from = &def->motion[k];
  for (int i = 0; i < k; i++) {
    const corot_motion *before = &def->motion[i];
    const corot_fault at = {
        .entry = "motion", .index = k, .field = "", .other = "motion", .other_index = i};
    if (!from->group || !before->group || strcmp(before->group, from->group) != 0) continue;
    if (!adds_up(before, from))
      return corot_fail_about(&at, "does not continue the other motion of %s: it has to %s",
                              from->group,
                              turns(before) ? "turn about the same axis" : "translate");
    if (has_span(before) && has_span(from) && from->from < before->to && before->from < from->to)
      return corot_fail_about(&at, "group '%s' is already moving from t = %g to t = %g s",
                              from->group, before->from, before->to);
  }
  return COROT_OK;
}

/* The amplitude of a motion, which takes its time. */
static corot_status make_amplitude(const corot_motion *from, int k, amplitude *to) {
  COROT_TRY(corot_amplitude_create(&from->amplitude, "motion", k, to));
  double jump = corot_amplitude_jump(to);
  if (isnan(jump)) return COROT_OK;
  int point = 1;
  while (to->time[point - 1] != jump || to->time[point] != jump) point++;
  corot_amplitude_clear(to);
  return corot_fail_about(
      &(corot_fault){.entry = "motion", .index = k, .field = "amplitude.time", .point = point},
      "its amplitude jumps at t = %g, and group '%s' cannot be in two places: let it take a time",
      jump, from->group ? from->group : "");
}

corot_status corot_motion_check(const corot_model_def *def, int k) {
  const corot_motion *from = &def->motion[k];
  COROT_TRY(check_numbers(from, k));
  COROT_TRY(check_sequence(def, k));
  if (has_span(from)) return COROT_OK;
  amplitude made;
  COROT_TRY(make_amplitude(from, k, &made));
  corot_amplitude_clear(&made);
  return COROT_OK;
}

static bool has_node(const corot_mesh *mesh, const char *name, int node) {
  const corot_group *group = corot_mesh_find_group(mesh, name);
  for (int i = 0; i < group->nnode; i++)
    if (group->node[i] == node) return true;
  return false;
}

/* Motion k cannot have component c of a node, which a fix or an earlier motion has. */
static corot_status refuse_held(const corot_model_def *def, const corot_mesh *mesh, int k, int node,
                                int c) {
  corot_fault at = {.entry = "motion", .index = k, .field = "group", .other = "motion"};
  const char *group = def->motion[k].group, *other = NULL;
  for (int i = 0; i < def->nfix && !other; i++)
    if (def->fix[i].component[c] && has_node(mesh, def->fix[i].group, node))
      at.other = "fix", at.other_index = i, other = def->fix[i].group;
  for (int i = 0; i < k && !other; i++)
    if (has_node(mesh, def->motion[i].group, node))
      at.other_index = i, other = def->motion[i].group;
  return corot_fail_about(&at, "node %d of group '%s' is already held in %c: it is in '%s', too",
                          node, group, "xyz"[c], other);
}

/* A node may be held by one condition only. */
static corot_status claim(const corot_model_def *def, const corot_mesh *mesh,
                          const corot_group *group, int k, char (*held)[3]) {
  for (int i = 0; i < group->nnode; i++) {
    int n = group->node[i];
    for (int c = 0; c < 3; c++) {
      if (held[n][c]) return refuse_held(def, mesh, k, n, c);
      held[n][c] = 1;
    }
  }
  return COROT_OK;
}

/* The motion on the same group, of which `from` is a part; NULL if it starts one of its own. */
static motion *joined(const corot_model *m, const corot_motion *from) {
  for (int k = 0; k < m->nmotion; k++)
    if (strcmp(m->motion[k].group, from->group) == 0) return &m->motion[k];
  return NULL;
}

/* A motion without spans or laws yet, of which it may have as many as there are motions. */
static corot_status start(const corot_model_def *def, corot_model *m, int k, char (*held)[3]) {
  const corot_motion *from = &def->motion[k];
  const corot_group *group;
  size_t most = (size_t)def->nmotion;
  COROT_TRY(corot_definition_nodes(m->mesh, "motion", k, from->group, &group));
  COROT_TRY(claim(def, m->mesh, group, k, held));
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

static void add_span(motion *to, const corot_motion *from) {
  motion_span *span = &to->span[to->nspan++];
  *span = (motion_span){.rate = from->rate, .from = from->from, .to = from->to};
  for (int c = 0; c < 3; c++) span->velocity[c] = from->velocity[c];
}

static corot_status add_law(motion *to, const corot_motion *from, int k) {
  motion_law *law = &to->law[to->nlaw];
  COROT_TRY(make_amplitude(from, k, &law->amplitude));
  to->nlaw++;
  law->angle = from->angle;
  for (int c = 0; c < 3; c++) law->direction[c] = from->direction[c];
  return COROT_OK;
}

corot_status corot_motions_create(const corot_model_def *def, corot_model *m, char (*held)[3]) {
  m->motion = calloc(def->nmotion + 1, sizeof *m->motion);
  if (!m->motion) return corot_fail(COROT_ENOMEM, "no memory for %d motions", def->nmotion);
  for (int k = 0; k < def->nmotion; k++) {
    const corot_motion *from = &def->motion[k];
    motion *to = from->group ? joined(m, from) : NULL;
    if (!to) {
      COROT_TRY(start(def, m, k, held));
      to = &m->motion[m->nmotion - 1];
    }
    if (has_span(from))
      add_span(to, from);
    else
      COROT_TRY(add_law(to, from, k));
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
    free(m->motion[k].drag);
  }
  free(m->motion);
}

/* Where a motion stands at t, and how fast it goes, at an instant. */
typedef struct progress {
  double angle, rate, shift[3], velocity[3];
  double speeding, acceleration[3]; /* what rate and velocity change by [rad/s^2], [m/s^2] */
} progress;

static progress progress_at(const motion *a, const instant *now) {
  progress p = {0};
  double t = now->t, phase = isnan(now->side) ? t : now->side;
  /* spans of constant rate: those that are over have left their whole way */
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
  /* what follows amplitudes */
  for (int k = 0; k < a->nlaw; k++) {
    const motion_law *l = &a->law[k];
    double factor = corot_amplitude_at(&l->amplitude, phase, t);
    double change = corot_amplitude_rate(&l->amplitude, phase, t);
    double second = corot_amplitude_second(&l->amplitude, phase, t);
    p.angle += factor * l->angle;
    p.rate += change * l->angle;
    p.speeding += second * l->angle;
    for (int c = 0; c < 3; c++) {
      p.shift[c] += factor * l->direction[c];
      p.velocity[c] += change * l->direction[c];
      p.acceleration[c] += second * l->direction[c];
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

void corot_motions_displace(const corot_model *m, const instant *now, double *nodal, int stride) {
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

void corot_motions_move(const corot_model *m, const instant *now, double *nodal, int stride) {
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

void corot_motions_accelerate(const corot_model *m, const instant *now, double *nodal, int stride) {
  for (int k = 0; k < m->nmotion && now->moving; k++) {
    const motion *of = &m->motion[k];
    double velocity[3][2], by[3][2], field[2];
    corot_motion_factors(of, now, velocity, by);
    for (int i = 0; i < of->nnode; i++)
      for (int c = 0; c < 3; c++) {
        corot_motion_fields(of, m->mesh->x[of->node[i]], c, field);
        nodal[of->node[i] * stride + c] = by[c][0] * field[0] + by[c][1] * field[1];
      }
  }
}

void corot_supports_place(const corot_model *m, const instant *now, int k, double *nodal,
                          int stride) {
  if (k == 0) corot_motions_displace(m, now, nodal, stride);
  if (k == 1) corot_motions_move(m, now, nodal, stride);
  if (k == 2) corot_motions_accelerate(m, now, nodal, stride);
  if (inputs_move(now) && (k < 2 || now->moving)) corot_paths_place(now, k, nodal, stride);
}

void corot_model_displacement(const corot_model *m, const instant *now, const double *u,
                              double *nodal, int stride) {
  corot_model_spread(m, u, nodal, stride);
  corot_supports_place(m, now, 0, nodal, stride);
}

void corot_model_velocity(const corot_model *m, const instant *now, const double *v, double *nodal,
                          int stride) {
  corot_model_spread(m, v, nodal, stride);
  corot_supports_place(m, now, 1, nodal, stride);
}

void corot_model_acceleration(const corot_model *m, const instant *now, const double *a,
                              double *nodal, int stride) {
  corot_model_spread(m, a, nodal, stride);
  corot_supports_place(m, now, 2, nodal, stride);
}

bool corot_motion_jolts(const motion *a) {
  bool any = a->nspan > 0;
  for (int k = 0; k < a->nlaw; k++) any |= corot_amplitude_nkink(&a->law[k].amplitude) > 0;
  return any;
}

/* Of a turn w and d of spin_arms, of a translation one and nothing. */
void corot_motion_fields(const motion *a, const double X[3], int c, double field[2]) {
  double w[3], d[3];
  spin_arms(a, X, w, d);
  field[0] = a->turns ? w[c] : 1;
  field[1] = a->turns ? d[c] : 0;
}

/* From u = sin(angle) w + (1 - cos(angle)) d by differentiation. */
void corot_motion_factors(const motion *a, const instant *now, double velocity[3][2],
                          double acceleration[3][2]) {
  progress p = progress_at(a, now);
  double cosine = cos(p.angle), sine = sin(p.angle), square = p.rate * p.rate;
  for (int c = 0; c < 3; c++) {
    velocity[c][0] = a->turns ? p.rate * cosine : p.velocity[c];
    velocity[c][1] = a->turns ? p.rate * sine : 0;
    acceleration[c][0] = a->turns ? p.speeding * cosine - square * sine : p.acceleration[c];
    acceleration[c][1] = a->turns ? p.speeding * sine + square * cosine : 0;
  }
}

bool corot_motions_carry(const corot_model *m, const instant *now, rigid_motion *all) {
  const motion *moving = NULL;
  progress p = {0}, of_it = {0};
  if (isnan(now->side) || inputs_move(now)) return false;
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
