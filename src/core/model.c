#include "core/model.h"

#include <stdlib.h>

corot_model_def corot_model_defaults(void) { return (corot_model_def){.strain = "polar"}; }

static corot_status find_strain(const char *name, int *strain) {
  for (int k = 0; k < NSTRAIN; k++)
    if (name && strcmp(name, strain_measures[k].name) == 0) {
      *strain = k;
      return COROT_OK;
    }
  return corot_fail(COROT_EINVAL, "no strain measure '%s': cauchy, warp, polar, hybrid or green",
                    name ? name : "");
}

corot_status model_find_group(const corot_mesh *mesh, const char *name, const char *user,
                              const corot_group **group) {
  *group = name ? corot_mesh_find_group(mesh, name) : NULL;
  if (*group) return COROT_OK;
  return corot_fail(COROT_EINVAL, "%s: the mesh has no group '%s'", user, name ? name : "");
}

static corot_status check_material(const corot_material *m, int k) {
  if (!(m->mu > 0) || !isfinite(m->mu))
    return corot_fail(COROT_EINVAL, "material %d: mu = %g is not positive", k, m->mu);
  if (!(3 * m->lambda + 2 * m->mu > 0) || !isfinite(m->lambda))
    return corot_fail(COROT_EINVAL, "material %d: 3 lambda + 2 mu = %g is not positive", k,
                      3 * m->lambda + 2 * m->mu);
  if (!(m->density > 0) || !isfinite(m->density))
    return corot_fail(COROT_EINVAL, "material %d: density = %g is not positive", k, m->density);
  if (!(m->damping_lambda >= 0) || !isfinite(m->damping_lambda))
    return corot_fail(COROT_EINVAL, "material %d: damping_lambda = %g is negative", k,
                      m->damping_lambda);
  if (!(m->damping_mu >= 0) || !isfinite(m->damping_mu))
    return corot_fail(COROT_EINVAL, "material %d: damping_mu = %g is negative", k, m->damping_mu);
  return COROT_OK;
}

/* of_tet [ntet]: the material that fills each tet. */
static corot_status assign_materials(const corot_model_def *def, corot_model *m, int *of_tet) {
  m->nmaterial = def->nmaterial;
  m->material = calloc(def->nmaterial + 1, sizeof *m->material);
  if (!m->material) return corot_fail(COROT_ENOMEM, "no memory for %d materials", def->nmaterial);

  int ntet = m->mesh->ntet, rest = -1;
  for (int e = 0; e < ntet; e++) of_tet[e] = -1;
  for (int k = 0; k < def->nmaterial; k++) {
    const corot_material *from = &def->material[k];
    COROT_TRY(check_material(from, k));
    m->material[k] =
        (material){from->lambda, from->mu, from->damping_lambda, from->damping_mu, from->density};
    m->damped |= from->damping_lambda > 0 || from->damping_mu > 0;
    if (!from->group) {
      if (rest >= 0)
        return corot_fail(COROT_EINVAL, "materials %d and %d both have no group", rest, k);
      rest = k;
      continue;
    }
    const corot_group *group;
    COROT_TRY(model_find_group(m->mesh, from->group, "material", &group));
    if (!group->ntet)
      return corot_fail(COROT_EINVAL, "material: group '%s' has no tets", from->group);
    for (int i = 0; i < group->ntet; i++) {
      int e = group->tet[i];
      if (of_tet[e] >= 0)
        return corot_fail(COROT_EINVAL, "tet %d belongs to materials %d and %d", e, of_tet[e], k);
      of_tet[e] = k;
    }
  }
  for (int e = 0; e < ntet; e++) {
    if (of_tet[e] < 0) of_tet[e] = rest;
    if (of_tet[e] < 0) return corot_fail(COROT_EINVAL, "tet %d has no material", e);
  }
  return COROT_OK;
}

/* Numbers the components that no support holds. */
static corot_status number_dofs(const corot_model_def *def, corot_model *m) {
  int nnode = m->mesh->nnode;
  m->dof = calloc(nnode, sizeof *m->dof);
  if (!m->dof) return corot_fail(COROT_ENOMEM, "no memory for %d nodes", nnode);
  for (int k = 0; k < def->nfix; k++) {
    const corot_group *group;
    COROT_TRY(model_find_group(m->mesh, def->fix[k].group, "fix", &group));
    for (int i = 0; i < group->nnode; i++)
      for (int c = 0; c < 3; c++)
        if (def->fix[k].component[c]) m->dof[group->node[i]][c] = -1;
  }
  for (int n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++)
      if (m->dof[n][c] == 0) m->dof[n][c] = m->ndof++;
  if (m->ndof == 0) return corot_fail(COROT_EINVAL, "every node is fixed: nothing can move");
  return COROT_OK;
}

/* Row-sum lumping: a quarter of each tet's mass to each of its nodes. */
static corot_status lump_mass(corot_model *m) {
  int nnode = m->mesh->nnode;
  double *nodal = calloc(nnode, sizeof *nodal);
  m->mass = malloc(m->ndof * sizeof *m->mass);
  m->inverse_mass = malloc(m->ndof * sizeof *m->inverse_mass);
  if (!nodal || !m->mass || !m->inverse_mass) {
    free(nodal);
    return corot_fail(COROT_ENOMEM, "no memory for the mass of %d nodes", nnode);
  }
  for (int b = 0; b < m->tets.nblock; b++) {
    const tet_block *block = &m->tets.block[b];
    for (int l = 0; l < block->ntet; l++)
      for (int a = 0; a < 4; a++)
        nodal[block->node[a][l]] += m->material[block->material].density * block->volume[l] / 4;
  }
  for (int n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      if (i >= 0) m->mass[i] = nodal[n], m->inverse_mass[i] = 1 / nodal[n];
    }
  free(nodal);
  return COROT_OK;
}

static void find_scales(corot_model *m) {
  corot_mesh_quality q = corot_mesh_measure(m->mesh);
  double diagonal2 = 0;
  for (int c = 0; c < 3; c++) diagonal2 += (q.max[c] - q.min[c]) * (q.max[c] - q.min[c]);
  m->length = sqrt(diagonal2);
  m->frequency = m->damping_time = INFINITY;
  for (int k = 0; k < m->nmaterial; k++) {
    const material *a = &m->material[k];
    m->frequency = fmin(m->frequency, sqrt(a->mu / a->density) / m->length);
    m->damping_time = fmin(m->damping_time, a->damping_mu / a->mu);
    if (a->lambda > 0) m->damping_time = fmin(m->damping_time, a->damping_lambda / a->lambda);
  }
}

static corot_status build(const corot_model_def *def, corot_model *m) {
  if (!def->mesh) return corot_fail(COROT_EINVAL, "the model has no mesh");
  COROT_TRY(find_strain(def->strain, &m->strain));
  COROT_TRY(corot_mesh_copy(def->mesh, &m->mesh));

  int *of_tet = malloc(m->mesh->ntet * sizeof *of_tet);
  if (!of_tet) return corot_fail(COROT_ENOMEM, "no memory for %d tets", m->mesh->ntet);
  corot_status status = assign_materials(def, m, of_tet);
  if (!status)
    status = tets_create(m->mesh, m->nmaterial, of_tet,
                         strain_measures[m->strain].frame == FRAME_WARP, &m->tets);
  free(of_tet);
  COROT_TRY(status);

  COROT_TRY(number_dofs(def, m));
  COROT_TRY(lump_mass(m));
  COROT_TRY(loads_create(def, m));
  COROT_TRY(pattern_create(m->mesh->nnode, &m->tets, &m->pattern));
  find_scales(m);
  return COROT_OK;
}

corot_status corot_model_create(const corot_model_def *def, corot_model **model) {
  corot_model *m = calloc(1, sizeof *m);
  if (!m) return corot_fail(COROT_ENOMEM, "no memory for a model");
  corot_status status = build(def, m);
  if (status) {
    corot_model_destroy(m);
    return status;
  }
  *model = m;
  return COROT_OK;
}

void corot_model_destroy(corot_model *m) {
  if (!m) return;
  loads_destroy(m);
  free(m->material);
  free(m->dof);
  free(m->mass);
  free(m->inverse_mass);
  tets_clear(&m->tets);
  pattern_clear(&m->pattern);
  corot_mesh_destroy(m->mesh);
  free(m);
}

void model_spread(const corot_model *m, const double *values, double *nodal, int stride) {
  for (int n = 0; n < m->mesh->nnode; n++)
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      nodal[n * stride + c] = i >= 0 ? values[i] : 0;
    }
}

const corot_mesh *corot_model_mesh(const corot_model *m) { return m->mesh; }
const char *corot_model_strain(const corot_model *m) { return strain_measures[m->strain].name; }
int corot_model_ndof(const corot_model *m) { return m->ndof; }
const int (*corot_model_dof(const corot_model *m))[3] { return (const int(*)[3])m->dof; }
const double *corot_model_mass(const corot_model *m) { return m->mass; }
double corot_model_length(const corot_model *m) { return m->length; }
double corot_model_frequency(const corot_model *m) { return m->frequency; }
double corot_model_damping_time(const corot_model *m) { return m->damping_time; }

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
                 m->mesh->nnode * sizeof *m->dof + 2 * m->ndof * sizeof *m->mass;
  for (int k = 0; k < m->nload; k++)
    bytes += sizeof *m->load + (m->ndof + 2 * m->load[k].n) * sizeof(double);
  bytes += t->nblock * (sizeof *t->block + W * sizeof *t->number);
  if (t->rest_basis) bytes += t->nblock * sizeof *t->rest_basis;
  bytes += (2 * (size_t)p->nnode + 2 + p->nblock + p->nchunk + 1 + p->first[p->nnode]) *
               sizeof(int) +
           t->nblock * sizeof *p->place;
  return bytes;
}
