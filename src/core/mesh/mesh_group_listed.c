/* Named groups of tets, or of triangles, that a host lists. */
#include <string.h>

#include "mesh.h"

/* Whether all of `list` [n] are in 0 .. count - 1; `what` they are. */
static corot_status check_list(const char *name, const char *what, int n, const int *list,
                               int count) {
  if (n <= 0) return corot_fail(COROT_EINVAL, "group '%s' has no %ss", name, what);
  for (int i = 0; i < n; i++)
    if (list[i] < 0 || list[i] >= count)
      return corot_fail(COROT_EINVAL, "group '%s': %s %d does not exist, the last is %d", name,
                        what, list[i], count - 1);
  return COROT_OK;
}

/* The nodes that are marked. `mark` [nnode] */
static corot_status take_marked(const corot_mesh *mesh, const char *mark, corot_group *g) {
  int n = 0;
  for (int i = 0; i < mesh->nnode; i++) n += mark[i];
  COROT_TRY(COROT_ALLOC(g->node, n));
  for (int i = 0; i < mesh->nnode; i++)
    if (mark[i]) g->node[g->nnode++] = i;
  return COROT_OK;
}

/* --- Tets --- */

/* Fills a zeroed group but for its name. */
static corot_status collect_tets(const corot_mesh *mesh, int ntet, const int *tet, corot_group *g) {
  char *mark;
  COROT_TRY(COROT_ALLOC(g->tri, 0));
  COROT_TRY(COROT_ALLOC(g->tet, ntet));
  memcpy(g->tet, tet, (size_t)ntet * sizeof *tet);
  g->ntet = ntet;
  corot_ints_unique(&g->ntet, g->tet);
  COROT_TRY(COROT_ALLOC(mark, mesh->nnode));
  for (int i = 0; i < g->ntet; i++) {
    int e = g->tet[i];
    for (int k = 0; k < 4; k++) mark[mesh->tet[e][k]] = 1;
    for (int k = 0; mesh->mid && k < 6; k++) mark[mesh->mid[e][k]] = 1;
  }
  corot_status status = take_marked(mesh, mark, g);
  free(mark);
  return status;
}

corot_status corot_mesh_group_tets(corot_mesh *mesh, const char *name, int ntet, const int *tet) {
  corot_group g = {0};
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(tet));
  COROT_TRY(check_list(name, "tet", ntet, tet, mesh->ntet));
  return corot_mesh_add_group(collect_tets(mesh, ntet, tet, &g), mesh, name, &g);
}

/* --- Triangles --- */

/* The triangles, each once, as faces of the mesh. `seen` [4 ntet] is zeroed. */
static corot_status take_faces(const corot_mesh *mesh, const char *name, int ntri,
                               const int (*tri)[3], const corot_face *face, char *seen,
                               corot_group *g) {
  for (int i = 0; i < ntri; i++) {
    int f = corot_face_find(4 * mesh->ntet, face, tri[i]);
    if (f < 0)
      return corot_fail(COROT_EINVAL, "group '%s': triangle %d (%d %d %d) is no face of a tet",
                        name, i, tri[i][0], tri[i][1], tri[i][2]);
    if (seen[f]) continue;
    seen[f] = 1;
    memcpy(g->tri[g->ntri], tri[i], sizeof *tri);
    corot_face_orient(mesh, face, f, false, g->tri[g->ntri++]);
  }
  return COROT_OK;
}

static corot_status take_nodes(const corot_mesh *mesh, corot_group *g) {
  int(*all)[6] = NULL;
  char *mark;
  if (mesh->mid) COROT_TRY(corot_mesh_face_nodes(mesh, g->ntri, (const int(*)[3])g->tri, &all));
  corot_status status = COROT_ALLOC(mark, mesh->nnode);
  for (int i = 0; !status && i < g->ntri; i++) {
    for (int k = 0; k < 3; k++) mark[g->tri[i][k]] = 1;
    for (int k = 3; all && k < 6; k++) mark[all[i][k]] = 1;
  }
  if (!status) status = take_marked(mesh, mark, g);
  free(mark);
  free(all);
  return status;
}

/* Fills a zeroed group but for its name. */
static corot_status collect_triangles(const corot_mesh *mesh, const char *name, int ntri,
                                      const int (*tri)[3], corot_group *g) {
  corot_face *face = NULL;
  char *seen = NULL;
  corot_status status =
      corot_faces_sort(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &face);
  if (!status) status = COROT_ALLOC(seen, 4 * (size_t)mesh->ntet);
  if (!status) status = COROT_ALLOC(g->tri, ntri);
  if (!status) status = COROT_ALLOC(g->tet, 0);
  if (!status) status = take_faces(mesh, name, ntri, tri, face, seen, g);
  if (!status) status = take_nodes(mesh, g);
  free(seen);
  free(face);
  return status;
}

corot_status corot_mesh_group_triangles(corot_mesh *mesh, const char *name, int ntri,
                                        const int (*tri)[3]) {
  corot_group g = {0};
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(tri));
  if (ntri <= 0) return corot_fail(COROT_EINVAL, "group '%s' has no triangles", name);
  return corot_mesh_add_group(collect_triangles(mesh, name, ntri, tri, &g), mesh, name, &g);
}
