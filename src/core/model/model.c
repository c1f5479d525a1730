/* From a definition to a model: each part checked, then made. */
#include <stdlib.h>

#include "core/base/names.h"
#include "core/system/levels.h"

corot_model_def corot_model_defaults(void) {
  return (corot_model_def){
      .viscosity = COROT_VISCOSITY_AUTO, .strain = "polar", .dilatation_local = 1};
}

corot_hierarchy_def corot_hierarchy_defaults(void) {
  return (corot_hierarchy_def){.coarse_strain = "green", .conservative = true};
}

#define TRAITS(index, word, pressure_basis, shear_basis, frame_rule)                    \
  [index] = {.name = word,                                                              \
             .frames = frame_rule != FRAME_IDENTITY,                                    \
             .polar = frame_rule == FRAME_POLAR,                                        \
             .linear_in_frames = pressure_basis == BY_FRAME && shear_basis == BY_FRAME, \
             .linear = pressure_basis == BY_FRAME && shear_basis == BY_FRAME &&         \
                       frame_rule == FRAME_IDENTITY,                                    \
             .exact = pressure_basis == BY_GRADIENT && shear_basis == BY_GRADIENT},
static const corot_strain_kind strain_kinds[] = {STRAIN_MEASURES(TRAITS)};

const corot_strain_kind *corot_strain_traits(int i) {
  return i >= 0 && i < NSTRAIN ? &strain_kinds[i] : NULL;
}

const corot_strain_kind *corot_strain_find(const char *name) {
  for (int k = 0; name && k < NSTRAIN; k++)
    if (strcmp(name, strain_kinds[k].name) == 0) return &strain_kinds[k];
  return NULL;
}

static const char *name_of(int i) { return i < NSTRAIN ? strain_kinds[i].name : NULL; }

corot_status corot_model_find_strain(const char *name, int *strain) {
  const corot_strain_kind *found = corot_strain_find(name);
  char all[NAMES_SIZE];
  if (!found)
    return corot_fail(COROT_EINVAL, "no strain measure '%s': %s", name ? name : "",
                      names_list(name_of, all));
  *strain = (int)(found - strain_kinds);
  return COROT_OK;
}

corot_status corot_model_find_group(const corot_mesh *mesh, const char *name, const char *user,
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
  if (!(m->damping_mass >= 0) || !isfinite(m->damping_mass))
    return corot_fail(COROT_EINVAL, "material %d: damping_mass = %g is negative", k,
                      m->damping_mass);
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
    m->material[k] = (material){.lambda = from->lambda,
                                .mu = from->mu,
                                .damping_lambda = from->damping_lambda,
                                .damping_mu = from->damping_mu,
                                .damping_mass = from->damping_mass,
                                .density = from->density,
                                .lambda_local = from->lambda,
                                .own_share = 1};
    m->damped |= from->damping_lambda > 0 || from->damping_mu > 0;
    m->mass_damped |= from->damping_mass > 0;
    if (!from->group) {
      if (rest >= 0)
        return corot_fail(COROT_EINVAL, "materials %d and %d both have no group", rest, k);
      rest = k;
      continue;
    }
    const corot_group *group;
    COROT_TRY(corot_model_find_group(m->mesh, from->group, "material", &group));
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

static corot_status hold_fixed(const corot_model_def *def, const corot_model *m, char (*held)[3]) {
  for (int k = 0; k < def->nfix; k++) {
    const corot_group *group;
    COROT_TRY(corot_model_find_group(m->mesh, def->fix[k].group, "fix", &group));
    for (int i = 0; i < group->nnode; i++)
      for (int c = 0; c < 3; c++)
        if (def->fix[k].component[c]) held[group->node[i]][c] = 1;
  }
  return COROT_OK;
}

/* Supports, and numbers for the components that none of them holds. */
static corot_status number_dofs(const corot_model_def *def, corot_model *m) {
  int nnode = m->mesh->nnode;
  m->dof = malloc(nnode * sizeof *m->dof);
  char(*held)[3] = calloc(nnode, sizeof *held);
  corot_status status = COROT_OK;
  if (!m->dof || !held) status = corot_fail(COROT_ENOMEM, "no memory for %d nodes", nnode);
  if (!status) status = hold_fixed(def, m, held);
  if (!status) status = corot_motions_create(def, m, held);
  if (!status)
    for (int n = 0; n < nnode; n++)
      for (int c = 0; c < 3; c++) m->dof[n][c] = held[n][c] ? -1 : m->ndof++;
  free(held);
  COROT_TRY(status);
  if (m->ndof == 0) return corot_fail(COROT_EINVAL, "every node is fixed: nothing can move");
  m->body_nnode = m->levels ? corot_levels_body(m) : nnode;
  for (int n = 0; n < m->body_nnode; n++)
    for (int c = 0; c < 3; c++) m->body_ndof += m->dof[n][c] >= 0;
  return COROT_OK;
}

static int by_time(const void *a, const void *b) {
  double d = *(const double *)a - *(const double *)b;
  return (d > 0) - (d < 0);
}

static void add_kinks(corot_model *m, const amplitude *a) {
  const double *time = corot_amplitude_kinks(a);
  for (int i = 0; i < corot_amplitude_nkink(a); i++) m->kink[m->nkink++] = time[i];
}

static size_t count_kinks(const corot_model *m) {
  size_t n = 0;
  for (int k = 0; k < m->nload; k++) n += corot_amplitude_nkink(&m->load[k].amplitude);
  for (int k = 0; k < m->nmotion; k++) {
    n += 2 * (size_t)m->motion[k].nspan;
    for (int i = 0; i < m->motion[k].nlaw; i++)
      n += corot_amplitude_nkink(&m->motion[k].law[i].amplitude);
  }
  return n;
}

/* All times at which a load or a motion changes its law, ascending, each once. */
static corot_status list_kinks(corot_model *m) {
  size_t n = count_kinks(m);
  m->kink = malloc((n + 1) * sizeof *m->kink);
  if (!m->kink) return corot_fail(COROT_ENOMEM, "no memory for %zu kinks", n);
  for (int k = 0; k < m->nload; k++) add_kinks(m, &m->load[k].amplitude);
  for (int k = 0; k < m->nmotion; k++) {
    const motion *a = &m->motion[k];
    for (int i = 0; i < a->nspan; i++) {
      m->kink[m->nkink++] = a->span[i].from;
      if (isfinite(a->span[i].to)) m->kink[m->nkink++] = a->span[i].to;
    }
    for (int i = 0; i < a->nlaw; i++) add_kinks(m, &a->law[i].amplitude);
  }
  qsort(m->kink, m->nkink, sizeof *m->kink, by_time);
  int all = m->nkink;
  m->nkink = 0;
  for (int k = 0; k < all; k++)
    if (m->nkink == 0 || m->kink[k] > m->kink[m->nkink - 1]) m->kink[m->nkink++] = m->kink[k];
  return COROT_OK;
}

/* Twice the largest distance from the centroid: unlike the bounding box's diagonal, of which it is
   the value for a box, it does not change when the body is turned, and so neither do the steps. */
static double body_length(const corot_model *m) {
  const double(*x)[3] = (const double(*)[3])m->mesh->x;
  double moment[3] = {0, 0, 0}, volume = 0, square = 0;
  for (int b = 0; b < m->tets.nblock; b++) {
    const tet_block *block = &m->tets.block[b];
    for (int l = 0; l < block->ntet; l++) {
      volume += block->volume[l];
      for (int a = 0; a < 4; a++)
        for (int c = 0; c < 3; c++) moment[c] += block->volume[l] / 4 * x[block->node[a][l]][c];
    }
  }
  for (int n = 0; n < m->mesh->nnode; n++) {
    double d[3];
    for (int c = 0; c < 3; c++) d[c] = x[n][c] - moment[c] / volume;
    square = fmax(square, d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  }
  return 2 * sqrt(square);
}

static void find_scales(corot_model *m) {
  m->length = body_length(m);
  m->frequency = m->damping_time = INFINITY;
  for (int k = 0; k < m->nmaterial; k++) {
    const material *a = &m->material[k];
    m->frequency = fmin(m->frequency, sqrt(a->mu / a->density) / m->length);
    m->damping_time = fmin(m->damping_time, a->damping_mu / a->mu);
    if (a->lambda > 0) m->damping_time = fmin(m->damping_time, a->damping_lambda / a->lambda);
  }
}

/* Averages of the dilatation, if they are wanted and some material has more lambda than is left to
   the tets. */
static corot_status average_dilatation(const corot_model_def *def, corot_model *m) {
  if (def->dilatation == COROT_DILATATION_LOCAL) return COROT_OK;
  if (!(def->dilatation_local >= 0) || !isfinite(def->dilatation_local))
    return corot_fail(COROT_EINVAL, "dilatation_local = %g is not a number of shear moduli >= 0",
                      def->dilatation_local);
  double *averaged = calloc(m->nmaterial + 1, sizeof *averaged), most = 0;
  if (!averaged) return corot_fail(COROT_ENOMEM, "no memory for %d materials", m->nmaterial);
  for (int k = 0; k < m->nmaterial; k++) {
    material *a = &m->material[k];
    double local = def->dilatation_local * a->mu;
    if (!(a->lambda > local)) continue;
    a->lambda_local = local;
    a->own_share = local / a->lambda;
    averaged[k] = a->lambda - local;
    most = fmax(most, averaged[k]);
  }
  corot_status status = COROT_OK;
  if (most > 0)
    status = corot_dilatation_create(m->mesh->nnode, &m->tets, averaged, &m->dilatation);
  free(averaged);
  return status;
}

/* The measure of the mesh's own tets: of a hierarchy without finer levels the coarse one. */
static corot_status choose_strain(const corot_model_def *def, corot_model *m) {
  const corot_hierarchy_def *h = def->hierarchy;
  if (h) COROT_TRY(corot_levels_check(h, def->mesh));
  if (h && h->refinement->nlevel > 0 && def->dilatation != COROT_DILATATION_LOCAL)
    return corot_fail(COROT_EINVAL,
                      "hierarchy: dilatations averaged at nodes are not provided for");
  const char *name = h && h->refinement->nlevel == 0 ? h->coarse_strain : def->strain;
  COROT_TRY(corot_model_find_strain(name, &m->strain));
  bool polar = strain_measures[m->strain].frame == FRAME_POLAR;
  if ((unsigned)def->viscosity > COROT_VISCOSITY_AUTO)
    return corot_fail(COROT_EINVAL, "there is no viscous law %d", (int)def->viscosity);
  m->objective = def->viscosity == COROT_OBJECTIVE;
  if (def->viscosity == COROT_VISCOSITY_AUTO) m->objective = polar && !h;
  if (m->objective && !polar)
    return corot_fail(COROT_EINVAL, "the objective viscous law needs a polar frame, not strain %s",
                      name);
  return COROT_OK;
}

static corot_status build(const corot_model_def *def, corot_model *m) {
  if (!def->mesh) return corot_fail(COROT_EINVAL, "the model has no mesh");
  COROT_TRY(choose_strain(def, m));
  COROT_TRY(corot_mesh_copy(def->mesh, &m->mesh));

  int *of_tet = malloc(m->mesh->ntet * sizeof *of_tet);
  if (!of_tet) return corot_fail(COROT_ENOMEM, "no memory for %d tets", m->mesh->ntet);
  corot_status status = assign_materials(def, m, of_tet);
  if (!status)
    status = corot_tets_create(m->mesh, m->nmaterial, of_tet, corot_levels_together(def->hierarchy),
                               strain_measures[m->strain].frame == FRAME_WARP, &m->tets);
  if (!status && def->hierarchy && def->hierarchy->refinement->nlevel > 0)
    status = corot_levels_create(def->hierarchy, of_tet, m);
  free(of_tet);
  COROT_TRY(status);

  COROT_TRY(number_dofs(def, m));
  COROT_TRY(average_dilatation(def, m));
  const pattern *coarse = m->levels ? corot_levels_pattern(m) : NULL;
  COROT_TRY(corot_pattern_create(m->mesh->nnode, &m->tets, &m->dilatation, coarse, &m->pattern));
  if (coarse) COROT_TRY(corot_levels_place(m));
  COROT_TRY(corot_mass_create(def, m));
  COROT_TRY(corot_loads_create(def, m));
  COROT_TRY(list_kinks(m));
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
  return strain_kinds[m->strain].linear_in_frames && !parts_in_them && !rates_in_them;
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
