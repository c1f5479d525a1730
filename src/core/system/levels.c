/* Making the parts of a hierarchical model. */
#include "levels.h"

#include <corot/hierarchy.h>
#include <stdio.h>
#include <stdlib.h>

/* The nodes of the levels must lie where the refinement says: then a field that is linear on the
   tets of level 0 has the same gradient in all their descendants. */
static corot_status check_middles(const corot_refinement *r, const corot_mesh *mesh) {
  for (int n = r->nnode[0]; n < mesh->nnode; n++) {
    int p = r->parent[n - r->nnode[0]][0], q = r->parent[n - r->nnode[0]][1];
    if (p < 0 || q < 0 || p >= n || q >= n)
      return corot_fail(COROT_EINVAL, "hierarchy: node %d has the parents %d and %d", n, p, q);
    double off = 0, edge = 0;
    for (int c = 0; c < 3; c++) {
      edge = fmax(edge, fabs(mesh->x[p][c] - mesh->x[q][c]));
      off = fmax(off, fabs(mesh->x[n][c] - 0.5 * (mesh->x[p][c] + mesh->x[q][c])));
    }
    if (!(off <= 1e-9 * edge))
      return corot_fail(COROT_EINVAL,
                        "hierarchy: node %d is %g off the middle of its parents %d and %d", n, off,
                        p, q);
  }
  return COROT_OK;
}

corot_status corot_levels_check(const corot_hierarchy_def *def, const corot_mesh *mesh) {
  const corot_refinement *r = def->refinement;
  if (!r) return corot_fail(COROT_EINVAL, "the hierarchy has no refinement");
  if (r->nnode[r->nlevel] != mesh->nnode || r->ntet[r->nlevel] != mesh->ntet)
    return corot_fail(COROT_EINVAL,
                      "hierarchy: the refinement is of %d nodes and %d tets, the mesh has %d and "
                      "%d",
                      r->nnode[r->nlevel], r->ntet[r->nlevel], mesh->nnode, mesh->ntet);
  if (def->frame_level < 0 || def->frame_level > r->nlevel)
    return corot_fail(COROT_EINVAL, "hierarchy: frame level %d, where the levels are 0 to %d",
                      def->frame_level, r->nlevel);
  return check_middles(r, mesh);
}

/* Of a part's tets the material is that of their first descendants. */
static corot_status part_tets(const corot_model *m, const coarsening *c, const int *of_tet,
                              corot_model *p) {
  int ntet = p->mesh->ntet, below = m->mesh->ntet / ntet, *of = malloc(ntet * sizeof *of);
  if (!of) return corot_fail(COROT_ENOMEM, "no memory for %d tets", ntet);
  for (int e = 0; e < ntet; e++) of[e] = of_tet[(size_t)e * below];
  corot_status status = corot_tets_create(p->mesh, m->nmaterial, of, 1,
                                          strain_measures[p->strain].frame == FRAME_WARP, &p->tets);
  free(of);
  for (int b = 0; !status && b < p->tets.nblock; b++) p->tets.block[b].volume *= c->volume;
  return status;
}

static corot_status fill_part(const corot_model *m, const corot_mesh *mesh, const coarsening *c,
                              const int *of_tet, corot_model *p) {
  COROT_TRY(corot_mesh_copy(mesh, &p->mesh));
  int nnode = mesh->nnode;
  p->damped = m->damped;
  p->nmaterial = m->nmaterial;
  p->material = malloc(m->nmaterial * sizeof *p->material);
  p->dof = malloc(nnode * sizeof *p->dof);
  if (!p->material || !p->dof)
    return corot_fail(COROT_ENOMEM, "no memory for the %d nodes of a level", nnode);
  memcpy(p->material, m->material, m->nmaterial * sizeof *p->material);
  for (int n = 0; n < nnode; n++)
    for (int i = 0; i < 3; i++) p->dof[n][i] = p->ndof++;
  COROT_TRY(part_tets(m, c, of_tet, p));
  return corot_pattern_create(nnode, &p->tets, &p->dilatation, NULL, &p->pattern);
}

static corot_status make_part(const corot_model *m, const corot_mesh *mesh, const coarsening *c,
                              int strain, const int *of_tet, corot_model **part) {
  corot_model *p = calloc(1, sizeof *p);
  if (!p) return corot_fail(COROT_ENOMEM, "no memory for a part of a hierarchy");
  p->strain = strain;
  corot_status status = fill_part(m, mesh, c, of_tet, p);
  if (status) {
    corot_model_destroy(p);
    return status;
  }
  *part = p;
  return COROT_OK;
}

/* A level's mesh as its parts have it; on the finest level a tet's mean is its own gradient. */
static corot_status make_coarsening(const corot_model *m, const corot_refinement *r, int level,
                                    coarsening *c, corot_mesh **mesh) {
  if (m->levels->coupling == COROT_COUPLING_MEAN && level < r->nlevel)
    return corot_coarsening_by_means(m->mesh, r, level, c, mesh);
  return corot_coarsening_by_values(m->mesh, r, level, c, mesh);
}

static corot_status make_coarse(const corot_refinement *r, int coarse, const int *of_tet,
                                corot_model *m) {
  levels *l = m->levels;
  corot_mesh *mesh;
  COROT_TRY(make_coarsening(m, r, 0, &l->to_coarse, &mesh));
  corot_status status = make_part(m, mesh, &l->to_coarse, coarse, of_tet, &l->coarse);
  if (!status) status = make_part(m, mesh, &l->to_coarse, m->strain, of_tet, &l->linear);
  corot_mesh_destroy(mesh);
  l->framer = l->linear;
  return status;
}

static corot_status make_framer(const corot_refinement *r, const int *of_tet, corot_model *m) {
  levels *l = m->levels;
  corot_mesh *mesh;
  l->framer = NULL;
  COROT_TRY(make_coarsening(m, r, l->frame_level, &l->to_framer, &mesh));
  corot_status status = make_part(m, mesh, &l->to_framer, m->strain, of_tet, &l->framer);
  corot_mesh_destroy(mesh);
  return status;
}

/* Whether all descendants of a tet of level 0 are made of the same. */
static corot_status check_materials(const corot_refinement *r, const int *of_tet) {
  int shift = 3 * r->nlevel;
  for (int e = 0; e < r->ntet[r->nlevel]; e++) {
    int first = e >> shift << shift;
    if (of_tet[e] != of_tet[first])
      return corot_fail(COROT_EINVAL,
                        "hierarchy: tets %d and %d descend from tet %d of level 0, but are made of "
                        "materials %d and %d",
                        first, e, e >> shift, of_tet[first], of_tet[e]);
  }
  return COROT_OK;
}

static corot_status check_choices(const corot_hierarchy_def *def, const corot_model *m) {
  const strain_measure *s = &strain_measures[m->strain];
  if (def->coupling < COROT_COUPLING_MEAN || def->coupling > COROT_COUPLING_ONE_WAY)
    return corot_fail(COROT_EINVAL, "hierarchy: no coupling has the number %d", (int)def->coupling);
  if (s->pressure != BY_FRAME || s->shear != BY_FRAME)
    return corot_fail(COROT_EINVAL,
                      "hierarchy: strain %s is not linear in a given frame; cauchy, warp and polar "
                      "are",
                      s->name);
  if (m->objective)
    return corot_fail(COROT_EINVAL, "hierarchy: the viscous law must be the corotated one");
  if (def->conservative && s->frame == FRAME_WARP)
    return corot_fail(COROT_EINVAL,
                      "hierarchy: strain warp has no conservative force: use polar, or set "
                      "conservative to false");
  if (def->frame_level > 0 && s->frame == FRAME_WARP)
    return corot_fail(
        COROT_EINVAL,
        "hierarchy: frame level %d, but warp frames depend on the edges of a tet, and "
        "those of level 0 alone fit the coarse motion: use polar, or frame level 0",
        def->frame_level);
  return COROT_OK;
}

int corot_levels_together(const corot_hierarchy_def *def) {
  return def ? 1 << 3 * (def->refinement->nlevel - def->frame_level) : 1;
}

/* The framer's tet over each block; a tet has at least 8 descendants. */
static corot_status list_above(corot_model *m) {
  _Static_assert(W == 8, "the descendants of a tet fill whole blocks");
  levels *l = m->levels;
  const tets *up = &l->framer->tets;
  int shift = 3 * (l->nlevel - l->frame_level), ntet = l->framer->mesh->ntet;
  if (shift == 0) return COROT_OK;
  int *at = malloc(ntet * sizeof *at);
  l->above = malloc(m->tets.nblock * sizeof *l->above);
  if (!at || !l->above) {
    free(at);
    return corot_fail(COROT_ENOMEM, "no memory for the frames of %d tets", m->mesh->ntet);
  }
  for (int b = 0; b < up->nblock; b++)
    for (int k = 0; k < up->block[b].ntet; k++) at[up->number[b * W + k]] = b * W + k;
  for (int b = 0; b < m->tets.nblock; b++) l->above[b] = at[m->tets.number[b * W] >> shift];
  free(at);
  return COROT_OK;
}

corot_status corot_levels_create(const corot_hierarchy_def *def, const int *of_tet,
                                 corot_model *m) {
  const corot_refinement *r = def->refinement;
  int coarse;
  COROT_TRY(corot_model_find_strain(def->coarse_strain, &coarse));
  COROT_TRY(check_choices(def, m));
  COROT_TRY(check_materials(r, of_tet));
  levels *l = m->levels = calloc(1, sizeof *l);
  if (!l) return corot_fail(COROT_ENOMEM, "no memory for the levels of a hierarchy");
  l->nlevel = r->nlevel;
  l->frame_level = def->frame_level;
  l->coupling = def->coupling;
  bool one_way = def->coupling == COROT_COUPLING_ONE_WAY;
  l->same = coarse == m->strain && !one_way;
  l->turning = def->conservative && strain_measures[m->strain].frame == FRAME_POLAR && !one_way &&
               def->frame_level < r->nlevel; /* a tet's own frame feels no moment */
  snprintf(l->name, sizeof l->name, "%s+%s", strain_measures[coarse].name,
           strain_measures[m->strain].name);
  COROT_TRY(make_coarse(r, coarse, of_tet, m));
  if (l->frame_level > 0) COROT_TRY(make_framer(r, of_tet, m));
  return list_above(m);
}

corot_status corot_levels_own(const corot_model_def *def, int nnode, double (*nodal)[3]) {
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

int corot_levels_body(const corot_model *m) {
  bool one_way = m->levels->coupling == COROT_COUPLING_ONE_WAY;
  return one_way ? m->levels->coarse->mesh->nnode : m->mesh->nnode;
}

const pattern *corot_levels_pattern(const corot_model *m) {
  const levels *l = m->levels;
  return l->same || l->coupling == COROT_COUPLING_MEAN ? NULL : &l->coarse->pattern;
}

corot_status corot_levels_place(corot_model *m) {
  levels *l = m->levels;
  const pattern *p = &l->coarse->pattern;
  l->place = malloc(p->nblock * sizeof *l->place);
  if (!l->place) return corot_fail(COROT_ENOMEM, "no memory for %d blocks of level 0", p->nblock);
  for (int j = 0; j < p->nnode; j++)
    for (int k = p->colptr[j]; k < p->colptr[j + 1]; k++)
      l->place[k] = corot_pattern_find(&m->pattern, p->row[k], j);
  return COROT_OK;
}

void corot_levels_destroy(levels *l) {
  if (!l) return;
  if (l->framer != l->linear) corot_model_destroy(l->framer);
  corot_model_destroy(l->linear);
  corot_model_destroy(l->coarse);
  corot_coarsening_clear(&l->to_coarse);
  corot_coarsening_clear(&l->to_framer);
  free(l->above);
  free(l->place);
  free(l);
}

size_t corot_levels_bytes(const corot_model *m) {
  const levels *l = m->levels;
  size_t bytes = sizeof *l + corot_model_bytes(l->coarse) + corot_model_bytes(l->linear);
  if (l->framer != l->linear) bytes += corot_model_bytes(l->framer);
  bytes += corot_coarsening_bytes(&l->to_coarse) + corot_coarsening_bytes(&l->to_framer);
  if (l->place) bytes += l->coarse->pattern.nblock * sizeof *l->place;
  return bytes + (l->above ? m->tets.nblock * sizeof *l->above : 0);
}
