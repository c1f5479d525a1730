/* Loads: constant force vectors on the free degrees of freedom, each with an amplitude in time. */
#include <stdlib.h>

#include "core/model.h"

static void add_force(const corot_model *m, double *force, int node, const double value[3],
                      double factor) {
  for (int c = 0; c < 3; c++)
    if (m->dof[node][c] >= 0) force[m->dof[node][c]] += factor * value[c];
}

/* A third of each face's traction to each of its nodes. */
static corot_status add_traction(const corot_model *m, const corot_load *load, double *force) {
  const corot_group *group;
  COROT_TRY(model_find_group(m->mesh, load->group, "traction", &group));
  if (!group->ntri)
    return corot_fail(COROT_EINVAL, "traction: group '%s' has no faces", load->group);
  for (int f = 0; f < group->ntri; f++) {
    const int *n = group->tri[f];
    double a[3], b[3];
    for (int c = 0; c < 3; c++) {
      a[c] = m->mesh->x[n[1]][c] - m->mesh->x[n[0]][c];
      b[c] = m->mesh->x[n[2]][c] - m->mesh->x[n[0]][c];
    }
    double nx = a[1] * b[2] - a[2] * b[1], ny = a[2] * b[0] - a[0] * b[2],
           nz = a[0] * b[1] - a[1] * b[0];
    double area = 0.5 * sqrt(nx * nx + ny * ny + nz * nz);
    for (int k = 0; k < 3; k++) add_force(m, force, n[k], load->value, area / 3);
  }
  return COROT_OK;
}

static corot_status copy_amplitude(const corot_amplitude *a, int k, dead_load *load) {
  for (int i = 0; i < a->n; i++) {
    if (!isfinite(a->time[i]) || !isfinite(a->value[i]))
      return corot_fail(COROT_EINVAL, "load %d: point %d of the amplitude is not finite", k, i);
    if (i > 0 && !(a->time[i] > a->time[i - 1]))
      return corot_fail(COROT_EINVAL, "load %d: the amplitude's times do not increase at point %d",
                        k, i);
  }
  if (a->n <= 0) return COROT_OK;
  load->time = malloc(a->n * sizeof *load->time);
  load->value = malloc(a->n * sizeof *load->value);
  if (!load->time || !load->value) return corot_fail(COROT_ENOMEM, "no memory for load %d", k);
  memcpy(load->time, a->time, a->n * sizeof *load->time);
  memcpy(load->value, a->value, a->n * sizeof *load->value);
  load->n = a->n;
  return COROT_OK;
}

corot_status loads_create(const corot_model_def *def, corot_model *m) {
  m->load = calloc(def->nload + 1, sizeof *m->load);
  if (!m->load) return corot_fail(COROT_ENOMEM, "no memory for %d loads", def->nload);
  m->nload = def->nload;
  for (int k = 0; k < def->nload; k++) {
    const corot_load *from = &def->load[k];
    dead_load *to = &m->load[k];
    if (from->kind != COROT_TRACTION && from->kind != COROT_GRAVITY)
      return corot_fail(COROT_EINVAL, "load %d: no kind of load has the number %d", k,
                        (int)from->kind);
    for (int c = 0; c < 3; c++)
      if (!isfinite(from->value[c]))
        return corot_fail(COROT_EINVAL, "load %d: component %d is not finite", k, c);
    COROT_TRY(copy_amplitude(&from->amplitude, k, to));
    to->force = calloc(m->ndof, sizeof *to->force);
    if (!to->force) return corot_fail(COROT_ENOMEM, "no memory for load %d", k);
    if (from->kind == COROT_TRACTION) {
      COROT_TRY(add_traction(m, from, to->force));
    } else {
      for (int n = 0; n < m->mesh->nnode; n++)
        for (int c = 0; c < 3; c++) {
          int i = m->dof[n][c];
          if (i >= 0) to->force[i] = m->mass[i] * from->value[c];
        }
    }
  }
  return COROT_OK;
}

void loads_destroy(corot_model *m) {
  for (int k = 0; k < m->nload; k++) {
    free(m->load[k].force);
    free(m->load[k].time);
    free(m->load[k].value);
  }
  free(m->load);
}

static double amplitude_at(const dead_load *load, double t) {
  int n = load->n;
  const double *time = load->time, *value = load->value;
  if (n == 0) return 1;
  if (!(t > time[0])) return value[0];
  if (t >= time[n - 1]) return value[n - 1];
  int k = 1;
  while (time[k] < t) k++;
  double s = (t - time[k - 1]) / (time[k] - time[k - 1]);
  return (1 - s) * value[k - 1] + s * value[k];
}

int corot_model_kinks(const corot_model *m, double t0, double t1, int max, double *time) {
  int n = 0;
  for (double last = t0;; n++) { /* the next kink after the last one */
    double next = INFINITY;
    for (int k = 0; k < m->nload; k++)
      for (int i = 0; i < m->load[k].n; i++)
        if (m->load[k].time[i] > last) {
          next = fmin(next, m->load[k].time[i]);
          break;
        }
    if (!(next < t1)) return n;
    if (n < max) time[n] = next;
    last = next;
  }
}

void loads_force(const corot_model *m, double t, double *f) {
  memset(f, 0, m->ndof * sizeof *f);
  for (int k = 0; k < m->nload; k++) {
    double a = amplitude_at(&m->load[k], t);
    const double *force = m->load[k].force;
    if (a != 0)
      for (int i = 0; i < m->ndof; i++) f[i] += a * force[i];
  }
}
