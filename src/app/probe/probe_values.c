/* From fields to the numbers of a probe. */
#include <math.h>
#include <string.h>

#include "app/scenario/probe_location.h"
#include "probe_parts.h"

unsigned probe_needs(const probe_def *p) {
  static const unsigned of_part[] = {
      [PART_TOTAL] = NEEDS_INTERNAL | NEEDS_INERTIAL | NEEDS_LOAD,
      [PART_INTERNAL] = NEEDS_INTERNAL | NEEDS_VISCOUS, /* or it would be in it */
      [PART_VISCOUS] = NEEDS_VISCOUS,
      [PART_INERTIAL] = NEEDS_INERTIAL,
      [PART_LOAD] = NEEDS_LOAD,
  };
  switch (p->of) {
    case PROBE_VELOCITY:
      return NEEDS_VELOCITY;
    case PROBE_ACCELERATION:
      return NEEDS_ACCELERATION;
    case PROBE_REACTION:
      return of_part[p->part];
    case PROBE_FORCE:
      return NEEDS_LOAD;
    case PROBE_MOMENTUM:
    case PROBE_ANGULAR_MOMENTUM:
    case PROBE_KINETIC:
      return p->body ? 0 : NEEDS_MOMENTUM;
    default:
      return 0;
  }
}

/* --- Samples --- */

static double length_of(const double x[3]) { return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]); }

/* 2 sin a = |vee R|, 2 cos a = tr R - 1: right for small angles, too. */
static double angle_of(const double R[9]) {
  const double axis[3] = {R[7] - R[5], R[2] - R[6], R[3] - R[1]};
  return atan2(length_of(axis), R[0] + R[4] + R[8] - 1);
}

/* The tensors of the library end with yz, xz, which is where zx stands. */
static void pick(const probe *p, const double *row, double out[6]) {
  int component = p->def->component;
  if (p->def->of == PROBE_FRAME_ANGLE)
    out[0] = angle_of(row);
  else if (component == COMPONENT_MAGNITUDE)
    out[0] = length_of(row);
  else if (component)
    out[0] = row[component - p->quantity->component];
  else
    memcpy(out, row, (size_t)p->n * sizeof *out);
}

static int row_of(const samples *s, int i) {
  return (s->row ? s->row[i / s->per] : i / s->per) * s->per + i % s->per;
}

static double weight_of(const samples *s, const probe_fields *f, int i) {
  if (s->weight) return s->weight[i];
  return s->by_volume ? f->tets.volume[row_of(s, i) / s->per] : 1;
}

static void take_sum(const probe *p, const probe_fields *f, const double *first, double *value) {
  const samples *s = &p->samples;
  double weights = 0, out[6];
  for (int c = 0; c < p->n; c++) value[c] = 0;
  for (int i = 0; i < s->n; i++) {
    double weight = weight_of(s, f, i);
    pick(p, first + (size_t)s->stride * (size_t)(s->place ? i : row_of(s, i)), out);
    for (int c = 0; c < p->n; c++) value[c] += weight * out[c];
    weights += weight;
  }
  for (int c = 0; p->def->take == TAKE_MEAN && c < p->n; c++) value[c] /= weights;
}

/* Of each column by itself. */
static void take_extreme(probe *p, const corot_mesh *mesh, const double *first, double *value) {
  const samples *s = &p->samples;
  int at[6] = {0};
  double out[6];
  for (int i = 0; i < s->n; i++) {
    pick(p, first + (size_t)s->stride * (size_t)(s->place ? i : row_of(s, i)), out);
    for (int c = 0; c < p->n; c++) {
      bool further = p->def->take == TAKE_MAX ? out[c] > value[c] : out[c] < value[c];
      if (i == 0 || further) value[c] = out[c], at[c] = i;
    }
  }
  for (int c = 0; c < p->n; c++) p->where[c] = samples_where(p, mesh, at[c]);
}

static corot_status take_samples(probe *p, const probe_fields *f, const double *first,
                                 double *value) {
  const samples *s = &p->samples;
  if (probe_is_local(p->def) && s->n == 1)
    pick(p, first + (size_t)s->stride * (size_t)(s->place ? 0 : row_of(s, 0)), value);
  else if (p->def->take == TAKE_MAX || p->def->take == TAKE_MIN)
    take_extreme(p, corot_model_mesh(f->model), first, value);
  else
    take_sum(p, f, first, value);
  return COROT_OK;
}

/* --- Sums over nodes --- */

/* Adds a force at a node and, if there is room for them, its moments. */
static void add_force(const probe *p, const probe_fields *f, const probe_moment *now, int n,
                      const double force[3], double *sum, double *moment) {
  const corot_mesh *mesh = corot_model_mesh(f->model);
  double arm[3];
  for (int c = 0; c < 3; c++) {
    arm[c] = mesh->x[n][c] + now->displacement[n][c] - p->def->about[c];
    if (sum) sum[c] += force[c];
  }
  for (int c = 0; moment && c < 3; c++) {
    int i = (c + 1) % 3, j = (c + 2) % 3;
    moment[c] += arm[i] * force[j] - arm[j] * force[i];
  }
}

/* What of a reaction acts on a component of a node, which is held. */
static double reaction_at(const probe_def *p, const corot_nodal_forces *f, int n, int c) {
  switch (p->part) {
    case PART_INTERNAL:
      return f->internal[n][c];
    case PART_VISCOUS:
      return f->viscous[n][c];
    case PART_INERTIAL:
      return f->inertial[n][c];
    case PART_LOAD:
      return f->load[n][c];
    default:
      return f->internal[n][c] + (f->viscous ? f->viscous[n][c] : 0) + f->inertial[n][c] -
             f->load[n][c];
  }
}

/* The vector at a node that a sum is of: a reaction, a load, or a momentum. */
static void vector_at_node(const probe *p, const probe_fields *f, int n, double x[3]) {
  const int *dof = corot_model_dof(f->model)[n];
  for (int c = 0; c < 3; c++) {
    bool held = dof[c] < 0;
    if (p->def->of == PROBE_FORCE)
      x[c] = f->forces.load[n][c];
    else if (p->def->of == PROBE_REACTION)
      x[c] = held ? reaction_at(p->def, &f->forces, n, c) : 0;
    else
      x[c] = held ? 0 : f->momentum[dof[c]];
  }
}

static void sum_nodes(const probe *p, const probe_fields *f, const probe_moment *now,
                      double *value) {
  const samples *s = &p->samples;
  probe_of of = p->def->of;
  for (int c = 0; c < p->n; c++) value[c] = 0;
  for (int i = 0; i < s->n; i++) {
    int n = row_of(s, i);
    double x[3];
    vector_at_node(p, f, n, x);
    if (of == PROBE_KINETIC) {
      const int *dof = corot_model_dof(f->model)[n];
      for (int c = 0; c < 3; c++) value[0] += dof[c] < 0 ? 0 : 0.5 * x[c] * now->v[dof[c]];
    } else if (of == PROBE_ANGULAR_MOMENTUM) {
      add_force(p, f, now, n, x, NULL, value);
    } else {
      add_force(p, f, now, n, x, value, p->n == 6 ? value + 3 : NULL);
    }
  }
}

/* --- Sums over tets, and the whole body --- */

static void sum_tets(const probe *p, const probe_fields *f, double *value) {
  const samples *s = &p->samples;
  value[0] = 0;
  for (int i = 0; i < s->n; i++) {
    int e = row_of(s, i);
    value[0] += p->def->of == PROBE_VOLUME ? s->value[e] * f->tets.volume[e] : s->value[e];
  }
}

/* What the ledger has; false: it does not. */
static bool of_ledger(const probe *p, const ledger *now, double *value) {
  const double *about = p->def->about, *m = now->momentum;
  if (!p->def->body) return false;
  switch (p->def->of) {
    case PROBE_ELASTIC:
      value[0] = now->elastic;
      return true;
    case PROBE_KINETIC:
      value[0] = now->kinetic;
      return true;
    case PROBE_DISSIPATED:
      value[0] = now->dissipated;
      return true;
    case PROBE_EXTERNAL_WORK:
      value[0] = now->external_work;
      return true;
    case PROBE_BALANCE:
      value[0] = now->balance;
      return true;
    case PROBE_FRAME_ENERGY:
      value[0] = now->frame_energy;
      return true;
    case PROBE_MOMENTUM:
      memcpy(value, m, sizeof now->momentum);
      return true;
    case PROBE_ANGULAR_MOMENTUM:
      for (int c = 0; c < 3; c++) {
        int i = (c + 1) % 3, j = (c + 2) % 3;
        value[c] = now->angular_momentum[c] - (about[i] * m[j] - about[j] * m[i]);
      }
      return true;
    default:
      return false;
  }
}

corot_status probe_value(probe *p, const probe_fields *f, const probe_moment *now, double *value) {
  const samples *s = &p->samples;
  if (of_ledger(p, now->ledger, value)) return COROT_OK;
  switch (p->quantity->carrier) {
    case SUM_OVER_NODES:
      sum_nodes(p, f, now, value);
      return COROT_OK;
    case SUM_OVER_TETS:
      sum_tets(p, f, value);
      return COROT_OK;
    case OF_NODES: {
      const double(*field)[3] = p->def->of == PROBE_DISPLACEMENT ? now->displacement
                                : p->def->of == PROBE_VELOCITY
                                    ? (const double(*)[3])f->velocity
                                    : (const double(*)[3])f->acceleration;
      return take_samples(p, f, field[0], value);
    }
    default:
      if (s->points)
        COROT_TRY(corot_points_evaluate(s->points, now->state, now->t, now->u, &s->at));
      if (s->traction) samples_find_tractions(&p->samples, f->model, now->displacement);
      return take_samples(p, f, s->value, value);
  }
}
