/* What a consistent mass hands on from moving supports to the free nodes. With M, and the matrix C
   of the mass damping, in parts of free nodes f and of nodes s whose motion is prescribed,

     M_ff v_f' = r(u, v, t) - M_fs a_s(t) - C_fs v_s(t).

   The velocities and accelerations of a motion are those of two fields, times factors of time alone
   (corot_motion_fields): M_fs and C_fs times the fields are summed once. Where the velocity of a
   motion jumps, the elements are lumped (mass.c), and there is nothing to sum. */
#include <stdlib.h>

#include "model.h"

/* The part of node s in what drags node f, if that is free. */
static void add_pair(const corot_model *m, const motion *a, int pair, int f, int s,
                     motion_drag *all) {
  for (int c = 0; c < 3; c++) {
    int i = m->dof[f][c];
    if (i < 0) continue;
    double field[2];
    corot_motion_fields(a, m->mesh->x[s], c, field);
    all[i].dof = i, all[i].component = c;
    for (int k = 0; k < 2; k++) {
      all[i].mass[k] += m->mass_pair[pair] * field[k];
      if (m->damping_pair) all[i].damping[k] += m->damping_pair[pair] * field[k];
    }
  }
}

/* Sums of all pairs of a node of motion a and a free one: all [ndof]. */
static void add_pairs(const corot_model *m, const motion *a, const bool *of_it, motion_drag *all) {
  const pattern *p = &solid_of(m)->pattern;
  for (int b = 0; b < p->nnode; b++)
    for (int k = p->colptr[b]; k < p->colptr[b + 1]; k++) {
      if (m->mass_pair[k] == 0) continue;
      if (of_it[b]) add_pair(m, a, k, p->row[k], b, all);
      if (of_it[p->row[k]]) add_pair(m, a, k, b, p->row[k], all);
    }
}

static bool is_nothing(const motion_drag *d) {
  return d->mass[0] == 0 && d->mass[1] == 0 && d->damping[0] == 0 && d->damping[1] == 0;
}

/* Takes the room, of which it keeps what drags. */
static corot_status make(const corot_model *m, motion *a, bool *of_it, motion_drag *all) {
  for (int i = 0; i < a->nnode; i++) of_it[a->node[i]] = true;
  add_pairs(m, a, of_it, all);
  int n = 0;
  for (int i = 0; i < m->ndof; i++) n += !is_nothing(&all[i]);
  a->drag = malloc((n + 1) * sizeof *a->drag);
  if (!a->drag) return corot_fail(COROT_ENOMEM, "no memory for the drag of group '%s'", a->group);
  for (int i = 0; i < m->ndof; i++)
    if (!is_nothing(&all[i])) a->drag[a->ndrag++] = all[i];
  return COROT_OK;
}

corot_status corot_drags_create(corot_model *m) {
  corot_status status = COROT_OK;
  for (int k = 0; k < m->nmotion && m->mass_pair && !status; k++) {
    bool *of_it = calloc(m->mesh->nnode, sizeof *of_it);
    motion_drag *all = calloc(m->ndof, sizeof *all);
    status = of_it && all ? make(m, &m->motion[k], of_it, all)
                          : corot_fail(COROT_ENOMEM, "no memory for the drag of %d nodes",
                                       m->motion[k].nnode);
    free(of_it);
    free(all);
  }
  return status;
}

void corot_drags_apply(const corot_model *m, const instant *now, double *f) {
  for (int k = 0; k < m->nmotion && now->moving; k++) {
    const motion *a = &m->motion[k];
    double velocity[3][2], acceleration[3][2];
    if (a->ndrag == 0) continue;
    corot_motion_factors(a, now, velocity, acceleration);
    for (int i = 0; i < a->ndrag; i++) {
      const motion_drag *d = &a->drag[i];
      const double *v = velocity[d->component], *by = acceleration[d->component];
      f[d->dof] -= d->mass[0] * by[0] + d->mass[1] * by[1];
      f[d->dof] -= d->damping[0] * v[0] + d->damping[1] * v[1];
    }
  }
}
