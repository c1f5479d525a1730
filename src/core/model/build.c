/* From a definition to a model: each part checked, then made. */
#include <stdlib.h>

#include <corot/hierarchy.h>

#include "core/base/fault.h"
#include "core/base/sized.h"
#include "core/solid/measures.h"
#include "definition.h"
#include "model.h"

void corot_model_set_defaults(corot_model_def *def, size_t bytes) {
  const corot_model_def ours = {.viscosity = COROT_VISCOSITY_AUTO,
                                .strain = "polar",
                                .mass = COROT_MASS_AUTO,
                                .dilatation_local = 1};
  corot_sized_fill(def, bytes, &ours, sizeof ours);
}

void corot_hierarchy_set_defaults(corot_hierarchy_def *def, size_t bytes) {
  const corot_hierarchy_def ours = {.coarse_strain = "green", .conservative = true};
  corot_sized_fill(def, bytes, &ours, sizeof ours);
}

corot_status corot_model_restrict(const corot_model_def *def, int nnode, double (*nodal)[3]) {
  const corot_hierarchy_def *h = def->hierarchy;
  if (!h || h->coupling != COROT_COUPLING_ONE_WAY) return COROT_OK;
  double(*all)[3] = malloc(nnode * sizeof *all);
  if (!all) return corot_fail(COROT_ENOMEM, "no memory for the loads of %d nodes", nnode);
  memcpy(all, nodal, nnode * sizeof *all);
  corot_hierarchy_apply_transposed(h->refinement, all);
  memcpy(nodal, all, h->refinement->nnode[0] * sizeof *all);
  free(all);
  return COROT_OK;
}

static corot_status hold_fixed(const corot_model_def *def, const corot_model *m, char (*held)[3]) {
  for (int k = 0; k < def->nfix; k++) {
    const corot_group *group;
    COROT_TRY(corot_definition_nodes(m->mesh, "fix", k, def->fix[k].group, &group));
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
  if (m->ndof == 0)
    return corot_fail_at("model", 0, "fix",
                         "all components of all %d nodes are held: nothing can move", nnode);
  int level_0 = m->system.term[0].from; /* one way, a body of its own */
  m->body_nnode = level_0 > 0 ? level_0 : nnode;
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

/* Where a spline begins and ends its second derivative jumps, and with it the drag. */
static void add_ends(corot_model *m, const amplitude *a) {
  if (!a->slope) return;
  m->kink[m->nkink++] = a->time[0];
  m->kink[m->nkink++] = a->time[a->n - 1];
}

static size_t count_kinks(const corot_model *m) {
  size_t n = 0;
  for (int k = 0; k < m->nload; k++) n += corot_amplitude_nkink(&m->load[k].amplitude);
  for (int k = 0; k < m->nmotion; k++) {
    n += 2 * (size_t)m->motion[k].nspan;
    n += 2 * (size_t)m->motion[k].nlaw;
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
    for (int i = 0; i < a->nlaw && a->ndrag > 0; i++) add_ends(m, &a->law[i].amplitude);
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
  const element_set *t = &solid_of(m)->elements;
  for (int b = 0; b < t->nblock; b++) {
    for (int l = 0; l < t->block[b].n; l++) {
      double whole = volume_at(t, b, l);
      volume += whole;
      for (int a = 0; a < t->kind->nnode; a++) {
        double part = whole * t->kind->lumped[role_at(t, b, a, l)] / t->kind->lumped_over;
        for (int c = 0; c < 3; c++) moment[c] += part * x[nodes_at(t, b, a)[l]][c];
      }
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

/* What of lambda is left to the points, where dilatations are averaged: at nodes no more than so
   many shear moduli; over an element nothing, unless it has one point only. */
static corot_status share_lambda(const corot_model_def *def, corot_model *m) {
  bool by_element = def->dilatation == COROT_DILATATION_ELEMENT;
  m->local_moduli = INFINITY;
  if (def->dilatation == COROT_DILATATION_LOCAL || (by_element && !m->mesh->mid)) return COROT_OK;
  m->local_moduli = by_element ? 0 : def->dilatation_local;
  for (int k = 0; k < m->nmaterial; k++) corot_material_share(m, &m->material[k]);
  return COROT_OK;
}

/* The hierarchy's definition, if it has finer levels. */
static const corot_hierarchy_def *refined(const corot_model_def *def) {
  const corot_hierarchy_def *h = def->hierarchy;
  return h && h->refinement && h->refinement->nlevel > 0 ? h : NULL;
}

/* The measure of the mesh's own tets, of a hierarchy without finer levels the coarse one; and
   whether the viscous law is the objective one. */
static corot_status choose_strain(const corot_model_def *def, system_def *of) {
  const corot_hierarchy_def *h = def->hierarchy;
  if (h) COROT_TRY(corot_system_check(h, def->mesh));
  COROT_TRY(corot_definition_check(def, h ? h->refinement->nlevel : 0));
  const char *name = h && !refined(def) ? h->coarse_strain : def->strain;
  COROT_TRY(corot_strain_index(name, &of->strain));
  bool polar = corot_strain_traits(of->strain)->polar;
  of->objective = def->viscosity == COROT_OBJECTIVE;
  if (def->viscosity == COROT_VISCOSITY_AUTO) of->objective = polar && !h;
  return COROT_OK;
}

/* What deforms: measure, materials and the tets. */
static corot_status make_system(const corot_model_def *def, corot_model *m) {
  system_def of = {.mesh = m->mesh,
                   .hierarchy = refined(def),
                   .by_element = def->dilatation == COROT_DILATATION_ELEMENT};
  COROT_TRY(choose_strain(def, &of));
  int *of_tet = malloc(m->mesh->ntet * sizeof *of_tet);
  if (!of_tet) return corot_fail(COROT_ENOMEM, "no memory for %d tets", m->mesh->ntet);
  corot_status status = corot_materials_create(def, m, of_tet, &of.damped);
  if (!status) status = share_lambda(def, m);
  of.nmaterial = m->nmaterial;
  of.material = m->material;
  of.of_tet = of_tet;
  if (!status) status = corot_system_create(&of, &m->system);
  free(of_tet);
  return status;
}

static corot_status build(const corot_model_def *def, corot_model *m) {
  if (!def->mesh) return corot_fail(COROT_EINVAL, "the model has no mesh");
  COROT_TRY(corot_mesh_copy(def->mesh, &m->mesh));
  COROT_TRY(make_system(def, m));
  COROT_TRY(number_dofs(def, m));
  COROT_TRY(corot_mass_create(def, m));
  COROT_TRY(corot_drags_create(m));
  COROT_TRY(corot_loads_create(def, m));
  COROT_TRY(list_kinks(m));
  find_scales(m);
  return COROT_OK;
}

/* That what is there to read is there, and of our size. */
static corot_status check_arguments(const corot_model_def *def) {
  COROT_TRY(COROT_DEFINED(def, corot_model_def));
  if (def->hierarchy) COROT_TRY(COROT_DEFINED(def->hierarchy, corot_hierarchy_def));
  const struct {
    const char *name;
    int n;
    const void *list;
  } lists[] = {{"material", def->nmaterial, def->material},
               {"fix", def->nfix, def->fix},
               {"motion", def->nmotion, def->motion},
               {"load", def->nload, def->load}};
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
    if (lists[i].n < 0 || (lists[i].n > 0 && !lists[i].list))
      return corot_fail(COROT_EINVAL, "the model has n%s = %d, and %s", lists[i].name, lists[i].n,
                        lists[i].list ? "a list" : "no list");
  return COROT_OK;
}

corot_status corot_model_create(const corot_model_def *def, corot_model **model) {
  COROT_TRY(check_arguments(def));
  COROT_TRY(COROT_GIVEN(model));
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
