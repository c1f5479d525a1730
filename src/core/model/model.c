/* What a model says of itself, and its end. */
#include <stdlib.h>

#include "core/mesh/mesh.h"
#include "model.h"

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
  free(m->node_mass);
  free(m->mass_pair);
  free(m->damping_pair);
  corot_system_clear(&m->system);
  corot_mesh_destroy(m->mesh);
  free(m);
}

void corot_model_spread(const corot_model *m, const double *values, double *nodal, int stride) {
  corot_model_spread_part(m, values, 0, m->mesh->nnode, nodal, stride);
}

void corot_model_spread_part(const corot_model *m, const double *values, int from, int end,
                             double *nodal, int stride) {
  for (int n = from; n < end; n++)
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

bool corot_model_approximate_stiffness(const corot_model *m) { return m->system.nterm > 1; }

const corot_mesh *corot_model_mesh(const corot_model *m) { return m->mesh; }

const char *corot_model_strain(const corot_model *m) { return m->system.name; }

bool corot_model_matrices_by_frames(const corot_model *m) {
  const solid *body = solid_of(m);
  bool rates_in_them = body->objective && body->damped;
  return corot_strain_traits(body->strain)->linear_in_frames && !rates_in_them &&
         !corot_system_adds_matrices(&m->system);
}

corot_viscosity corot_model_viscosity(const corot_model *m) {
  return solid_of(m)->objective ? COROT_OBJECTIVE : COROT_COROTATED;
}

int corot_model_ndof(const corot_model *m) { return m->ndof; }
const int (*corot_model_dof(const corot_model *m))[3] { return (const int(*)[3])m->dof; }
const double *corot_model_mass(const corot_model *m) { return m->mass; }
double corot_model_length(const corot_model *m) { return m->length; }
double corot_model_frequency(const corot_model *m) { return m->frequency; }
double corot_model_damping_time(const corot_model *m) { return m->damping_time; }

bool corot_model_moves(const corot_model *m) { return m->nmotion > 0; }

size_t corot_model_bytes(const corot_model *m) {
  size_t nblock = (size_t)solid_of(m)->pattern.nblock;
  size_t bytes = sizeof *m + corot_mesh_bytes(m->mesh) + m->nmaterial * sizeof *m->material +
                 m->mesh->nnode * sizeof *m->dof + corot_system_bytes(&m->system);
  bytes += 2 * m->ndof * sizeof *m->mass;

  /* loads and motions */
  for (int k = 0; k < m->nload; k++) {
    const load *l = &m->load[k];
    bytes += sizeof *l + corot_amplitude_bytes(&l->amplitude) + l->nface * sizeof *l->face;
    if (l->force) bytes += m->ndof * sizeof *l->force + l->nheld * sizeof *l->held;
  }
  for (int k = 0; k < m->nmotion; k++) {
    const motion *a = &m->motion[k];
    bytes += sizeof *a + a->nnode * sizeof *a->node + a->nspan * sizeof *a->span +
             a->ndrag * sizeof *a->drag;
    for (int i = 0; i < a->nlaw; i++)
      bytes += sizeof *a->law + corot_amplitude_bytes(&a->law[i].amplitude);
  }
  bytes += m->nkink * sizeof *m->kink;

  /* and what is there of the mass beside its diagonal */
  bytes += m->mesh->nnode * sizeof *m->node_mass;
  if (m->mass_damping) bytes += m->ndof * sizeof *m->mass_damping;
  if (m->mass_pair) bytes += nblock * sizeof *m->mass_pair;
  if (m->damping_pair) bytes += nblock * sizeof *m->damping_pair;
  return bytes;
}
