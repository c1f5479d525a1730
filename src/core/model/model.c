/* What a model says of itself, and its end. */
#include <stdlib.h>

#include "core/system/levels.h"

void corot_model_destroy(corot_model *m) {
  if (!m) return;
  corot_loads_destroy(m);
  corot_motions_destroy(m);
  free(m->kink);
  free(m->material);
  free(m->dof);
  free(m->mass);
  free(m->inverse_mass);
  free(m->mass_damping);
  free(m->mass_pair);
  free(m->damping_pair);
  corot_levels_destroy(m->levels);
  corot_tets_clear(&m->tets);
  corot_dilatation_clear(&m->dilatation);
  corot_pattern_clear(&m->pattern);
  corot_mesh_destroy(m->mesh);
  free(m);
}

void corot_model_spread(const corot_model *m, const double *values, double *nodal, int stride) {
  for (int n = 0; n < m->mesh->nnode; n++)
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      nodal[n * stride + c] = i >= 0 ? values[i] : 0;
    }
}

int corot_model_kinks(const corot_model *m, double t0, double t1, int max, double *time) {
  int n = 0;
  for (int k = 0; k < m->nkink; k++)
    if (m->kink[k] > t0 && m->kink[k] < t1) {
      if (n < max) time[n] = m->kink[k];
      n++;
    }
  return n;
}

double corot_model_horizon(const corot_model *m, double t) {
  double horizon = INFINITY;
  for (int k = 0; k < m->nload; k++)
    horizon = fmin(horizon, corot_amplitude_horizon(&m->load[k].amplitude, t));
  for (int k = 0; k < m->nmotion; k++)
    for (int i = 0; i < m->motion[k].nlaw; i++)
      horizon = fmin(horizon, corot_amplitude_horizon(&m->motion[k].law[i].amplitude, t));
  return horizon;
}

bool corot_model_approximate_stiffness(const corot_model *m) { return m->levels != NULL; }

const corot_mesh *corot_model_mesh(const corot_model *m) { return m->mesh; }

const char *corot_model_strain(const corot_model *m) {
  return m->levels ? m->levels->name : strain_measures[m->strain].name;
}

bool corot_model_matrices_by_frames(const corot_model *m) {
  bool parts_in_them = m->levels && m->levels->place;
  bool rates_in_them = m->objective && m->damped;
  return corot_strain_traits(m->strain)->linear_in_frames && !parts_in_them && !rates_in_them;
}

corot_viscosity corot_model_viscosity(const corot_model *m) {
  return m->objective ? COROT_OBJECTIVE : COROT_COROTATED;
}

int corot_model_ndof(const corot_model *m) { return m->ndof; }
const int (*corot_model_dof(const corot_model *m))[3] { return (const int(*)[3])m->dof; }
const double *corot_model_mass(const corot_model *m) { return m->mass; }
double corot_model_length(const corot_model *m) { return m->length; }
double corot_model_frequency(const corot_model *m) { return m->frequency; }
double corot_model_damping_time(const corot_model *m) { return m->damping_time; }

bool corot_model_moves(const corot_model *m) { return m->nmotion > 0; }

static size_t mesh_bytes(const corot_mesh *mesh) {
  size_t bytes = sizeof *mesh + mesh->nnode * sizeof *mesh->x + mesh->ntet * sizeof *mesh->tet;
  for (int k = 0; k < mesh->ngroup; k++) {
    const corot_group *g = &mesh->group[k];
    bytes += sizeof *g + strlen(g->name) + 1 + g->nnode * sizeof *g->node +
             g->ntri * sizeof *g->tri + g->ntet * sizeof *g->tet;
  }
  return bytes;
}

size_t corot_model_bytes(const corot_model *m) {
  const tets *t = &m->tets;
  const pattern *p = &m->pattern;
  size_t bytes = sizeof *m + mesh_bytes(m->mesh) + m->nmaterial * sizeof *m->material +
                 m->mesh->nnode * sizeof *m->dof;
  if (m->mass) bytes += 2 * m->ndof * sizeof *m->mass; /* parts of a hierarchy have none */
  for (int k = 0; k < m->nload; k++) {
    const load *l = &m->load[k];
    bytes += sizeof *l + corot_amplitude_bytes(&l->amplitude) + l->ntri * sizeof *l->tri;
    if (l->force) bytes += m->ndof * sizeof *l->force + l->nheld * sizeof *l->held;
  }
  for (int k = 0; k < m->nmotion; k++) {
    const motion *a = &m->motion[k];
    bytes += sizeof *a + a->nnode * sizeof *a->node + a->nspan * sizeof *a->span;
    for (int i = 0; i < a->nlaw; i++)
      bytes += sizeof *a->law + corot_amplitude_bytes(&a->law[i].amplitude);
  }
  bytes += m->nkink * sizeof *m->kink;
  if (m->mass_damping) bytes += m->ndof * sizeof *m->mass_damping;
  if (m->mass_pair) bytes += p->nblock * sizeof *m->mass_pair;
  if (m->damping_pair) bytes += p->nblock * sizeof *m->damping_pair;
  bytes += t->nblock * (sizeof *t->block + W * sizeof *t->number);
  bytes += corot_dilatation_bytes(&m->dilatation, t);
  if (t->rest_basis) bytes += t->nblock * sizeof *t->rest_basis;
  bytes +=
      (2 * (size_t)p->nnode + 2 + p->nblock + p->nchunk + 1 + p->first[p->nnode]) * sizeof(int) +
      t->nblock * sizeof *p->place;
  if (m->levels) bytes += corot_levels_bytes(m);
  return bytes;
}
