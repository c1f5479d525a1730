/* Making the terms of a system: of a plain model one, of a hierarchy up to four. */
#include "system.h"

#include <corot/hierarchy.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/mesh/mesh.h"
#include "core/solid/measures.h"

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

corot_status corot_system_check(const corot_hierarchy_def *def, const corot_mesh *mesh) {
  const corot_refinement *r = def->refinement;
  if (!r) return corot_fail(COROT_EINVAL, "the hierarchy has no refinement");
  if (r->node)
    return corot_fail(
        COROT_EINVAL,
        "hierarchy: level 0 is of the corners of ten-node tets, not of a mesh that was "
        "refined or raised");
  if (r->nnode[r->nlevel] != mesh->nnode || r->ntet[r->nlevel] != mesh->ntet)
    return corot_fail(COROT_EINVAL,
                      "hierarchy: the refinement is of %d nodes and %d tets, the mesh has %d and "
                      "%d",
                      r->nnode[r->nlevel], r->ntet[r->nlevel], mesh->nnode, mesh->ntet);
  return check_middles(r, mesh);
}

/* So many tets of the finest level descend from each of a level. */
static int count_below(const corot_refinement *r, int level) {
  return r->ntet[r->nlevel] / r->ntet[level];
}

/* Whether all descendants of a tet of level 0 are made of the same. */
static corot_status check_materials(const corot_refinement *r, const int *of_tet) {
  int below = count_below(r, 0);
  for (int e = 0; e < r->ntet[r->nlevel]; e++) {
    int first = e - e % below;
    if (of_tet[e] != of_tet[first])
      return corot_fail(COROT_EINVAL,
                        "hierarchy: tets %d and %d descend from tet %d of level 0, but are made of "
                        "materials %d and %d",
                        first, e, e / below, of_tet[first], of_tet[e]);
  }
  return COROT_OK;
}

/* --- Terms ------------------------------------------------------------------------------------ */

static bool is_one_way(const corot_hierarchy_def *h) {
  return h->coupling == COROT_COUPLING_ONE_WAY;
}

/* A level's mesh as its terms have it; the finest level has its own. */
static corot_status add_map(const system_def *def, int level, solid_system *y) {
  const corot_hierarchy_def *h = def->hierarchy;
  const corot_refinement *r = h->refinement;
  level_map *to = &y->map[y->nmap++];
  if (h->coupling == COROT_COUPLING_MEAN && level < r->nlevel)
    return corot_coarsening_by_means(def->mesh, r, level, &to->map, &to->mesh);
  return corot_coarsening_by_values(def->mesh, r, level, &to->map, &to->mesh);
}

/* A term on the nodes of the last map. Of its tets the material is that of their first descendants;
   where they are those of the finest level, they stand in the same order. */
static corot_status add_coarse(const system_def *def, int strain, int sign, int level,
                               solid_system *y) {
  term *t = &y->term[y->nterm++];
  const level_map *on = &y->map[y->nmap - 1];
  int ntet = on->mesh->ntet, below = count_below(def->hierarchy->refinement, level), *of_tet;
  *t = (term){.sign = sign, .map = y->nmap - 1, .level = level, .below = below, .frames_from = -1};
  t->body = (solid){.mesh = on->mesh,
                    .order_of = below == 1 ? def->mesh : NULL,
                    .material = def->material,
                    .strain = strain,
                    .damped = def->damped};
  COROT_TRY(COROT_ALLOC(of_tet, ntet));
  for (int e = 0; e < ntet; e++) of_tet[e] = def->of_tet[(size_t)e * below];
  corot_status status = corot_solid_fill(&t->body, def->nmaterial, of_tet, 1, on->map.volume, NULL);
  free(of_tet);
  return status;
}

/* The terms beside the first: coarse less linear, and the leader. */
static corot_status add_coarse_terms(const system_def *def, int coarse, solid_system *y) {
  const corot_hierarchy_def *h = def->hierarchy;
  bool one_way = is_one_way(h), cancel = coarse == def->strain && !one_way;
  bool leads = h->frame_level == 0; /* the linear term, or one in its place */
  if (!cancel || leads) COROT_TRY(add_map(def, 0, y));
  if (!cancel) COROT_TRY(add_coarse(def, coarse, 1, 0, y));
  if (leads || !(cancel || one_way))
    COROT_TRY(add_coarse(def, def->strain, cancel || one_way ? 0 : -1, 0, y));
  if (!leads) COROT_TRY(add_map(def, h->frame_level, y));
  if (!leads) COROT_TRY(add_coarse(def, def->strain, 0, h->frame_level, y));
  y->leader = y->nterm - 1;
  return COROT_OK;
}

/* The leader's tet over each block of the first term; a tet that is cut has at least 8 descendants.
 */
static corot_status list_above(solid_system *y) {
  _Static_assert(W == 8, "the descendants of a tet fill whole blocks");
  term *fine = &y->term[0];
  const term *leader = &y->term[y->leader];
  const element_set *up = &leader->body.elements, *down = &fine->body.elements;
  int below = leader->below, ntet = leader->body.mesh->ntet;
  if (below == 1) return COROT_OK;
  int *at = malloc(ntet * sizeof *at);
  fine->above = malloc(down->nblock * sizeof *fine->above);
  if (!at || !fine->above) {
    free(at);
    return corot_fail(COROT_ENOMEM, "no memory for the frames of %d tets", fine->body.mesh->ntet);
  }
  for (int b = 0; b < up->nblock; b++)
    for (int k = 0; k < up->block[b].n; k++) at[up->number[b * W + k]] = b * W + k;
  for (int b = 0; b < down->nblock; b++) fine->above[b] = at[down->number[b * W] / below];
  free(at);
  return COROT_OK;
}

/* Where a term's blocks are in the matrices of the first. */
static corot_status list_places(const solid_system *y, term *t) {
  const pattern *p = &t->body.pattern;
  t->place = malloc(p->nblock * sizeof *t->place);
  if (!t->place) return corot_fail(COROT_ENOMEM, "no memory for %d blocks of level 0", p->nblock);
  for (int j = 0; j < p->nnode; j++)
    for (int k = p->colptr[j]; k < p->colptr[j + 1]; k++)
      t->place[k] = corot_pattern_find(&y->term[0].body.pattern, p->row[k], j);
  return COROT_OK;
}

/* The term whose matrices are added to those of the first, as are all of its pattern: by means,
   they would couple all nodes on the faces of a tet. NULL: there is none. */
static const term *added_to_matrices(const system_def *def, const solid_system *y) {
  bool means = def->hierarchy && def->hierarchy->coupling == COROT_COUPLING_MEAN;
  for (int k = 1; k < y->nterm && !means; k++)
    if (y->term[k].sign > 0) return &y->term[k];
  return NULL;
}

static corot_status fill_first(const system_def *def, int together, solid_system *y) {
  solid *body = &y->term[0].body;
  const term *added = added_to_matrices(def, y);
  *body = (solid){.mesh = def->mesh,
                  .material = def->material,
                  .strain = def->strain,
                  .damped = def->damped,
                  .objective = def->objective,
                  .by_element = def->by_element};
  COROT_TRY(corot_solid_fill(body, def->nmaterial, def->of_tet, together, 1,
                             added ? &added->body.pattern : NULL));
  for (int k = 1; k < y->nterm; k++)
    if (added && y->term[k].sign != 0) COROT_TRY(list_places(y, &y->term[k]));
  return COROT_OK;
}

static corot_status create_hierarchy(const system_def *def, solid_system *y) {
  const corot_hierarchy_def *h = def->hierarchy;
  const corot_refinement *r = h->refinement;
  bool polar = strain_measures[def->strain].frame == FRAME_POLAR;
  int coarse;
  COROT_TRY(corot_strain_index(h->coarse_strain, &coarse));
  COROT_TRY(check_materials(r, def->of_tet));
  snprintf(y->name, sizeof y->name, "%s+%s", strain_measures[coarse].name,
           strain_measures[def->strain].name);
  y->turning = h->conservative && polar && !is_one_way(h) &&
               h->frame_level < r->nlevel; /* a tet's or point's own frame feels no moment */
  COROT_TRY(add_coarse_terms(def, coarse, y));
  term *fine = &y->term[0];
  *fine = (term){.sign = 1, .map = -1, .level = r->nlevel, .below = 1, .frames_from = y->leader};
  if (is_one_way(h)) fine->from = r->nnode[0];
  COROT_TRY(fill_first(def, count_below(r, h->frame_level), y));
  return list_above(y);
}

corot_status corot_system_create(const system_def *def, solid_system *y) {
  *y = (solid_system){.nterm = 1, .leader = -1};
  y->term[0] = (term){.sign = 1, .map = -1, .below = 1, .frames_from = -1};
  if (def->hierarchy) return create_hierarchy(def, y);
  snprintf(y->name, sizeof y->name, "%s", strain_measures[def->strain].name);
  return fill_first(def, 1, y);
}

void corot_system_clear(solid_system *y) {
  for (int k = 0; k < y->nterm; k++) {
    corot_solid_clear(&y->term[k].body);
    free(y->term[k].above);
    free(y->term[k].place);
  }
  for (int k = 0; k < y->nmap; k++) {
    corot_coarsening_clear(&y->map[k].map);
    corot_mesh_destroy(y->map[k].mesh);
  }
}

size_t corot_system_bytes(const solid_system *y) {
  size_t bytes = 0;
  for (int k = 0; k < y->nterm; k++) {
    const term *t = &y->term[k];
    bytes += corot_solid_bytes(&t->body);
    if (t->above) bytes += t->body.elements.nblock * sizeof *t->above;
    if (t->place) bytes += t->body.pattern.nblock * sizeof *t->place;
  }
  for (int k = 0; k < y->nmap; k++)
    bytes += corot_coarsening_bytes(&y->map[k].map) + corot_mesh_bytes(y->map[k].mesh);
  return bytes;
}

bool corot_system_adds_matrices(const solid_system *y) {
  for (int k = 1; k < y->nterm; k++)
    if (y->term[k].place) return true;
  return false;
}

bool corot_system_is_linear(const solid_system *y) {
  for (int k = 0; k < y->nterm; k++)
    if (!strain_is_linear(&strain_measures[y->term[k].body.strain])) return false;
  return true;
}
