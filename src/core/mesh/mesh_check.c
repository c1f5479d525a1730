/* Whether a mesh is sound, and if not, what exactly is wrong with it. */
#include "mesh_check.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#define COORDINATE_MAX 1e100 /* so that the cube of an edge is finite */

corot_status corot_mesh_check_counts(int nnode, int ntet) {
  if (nnode < 0 || ntet < 0)
    return corot_fail(COROT_EINVAL, "a mesh cannot have %d nodes and %d tets", nnode, ntet);
  if (ntet == 0) return corot_fail(COROT_EINVAL, "the mesh has no tets");
  if (nnode > INT_MAX / 3 || ntet > INT_MAX / 4)
    return corot_fail(COROT_EINVAL, "%d nodes and %d tets are too many: at most %d and %d", nnode,
                      ntet, INT_MAX / 3, INT_MAX / 4);
  return COROT_OK;
}

static corot_status check_coordinates(const check *c) {
  for (int i = 0; i < c->mesh->nnode; i++)
    for (int k = 0; k < 3; k++) {
      double x = c->mesh->x[i][k];
      if (!(fabs(x) <= COORDINATE_MAX))
        return corot_fail(COROT_EINVAL, "%s %lld: %c is %g", at_node(c, i), node_name(c, i),
                          "xyz"[k], x);
    }
  return COROT_OK;
}

static corot_status check_corners(const check *c, int e) {
  const int *v = c->mesh->tet[e];
  for (int k = 0; k < 4; k++)
    if (v[k] < 0 || v[k] >= c->mesh->nnode)
      return corot_fail(COROT_EINVAL, "%s %lld: node %d does not exist, the last is %d",
                        at_tet(c, e), tet_name(c, e), v[k], c->mesh->nnode - 1);
  for (int k = 1; k < 4; k++)
    for (int j = 0; j < k; j++)
      if (v[j] == v[k])
        return corot_fail(COROT_EINVAL, "%s %lld has node %lld twice", at_tet(c, e), tet_name(c, e),
                          node_name(c, v[k]));
  return COROT_OK;
}

static double longest_edge(const double (*x)[3], const int v[4]) {
  double longest = 0;
  for (int k = 1; k < 4; k++)
    for (int j = 0; j < k; j++) {
      const double *a = x[v[j]], *b = x[v[k]];
      longest = fmax(longest, hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]));
    }
  return longest;
}

static corot_status check_volume(const check *c, int e) {
  const double(*x)[3] = (const double(*)[3])c->mesh->x;
  double volume = corot_tet_volume(x, c->mesh->tet[e]);
  double edge = longest_edge(x, c->mesh->tet[e]), least = FLAT * edge * edge * edge;
  if (volume < -least)
    return corot_fail(COROT_EINVAL, "%s %lld is inverted: its volume is %g", at_tet(c, e),
                      tet_name(c, e), volume);
  if (!(volume > least))
    return corot_fail(COROT_EINVAL, "%s %lld is flat: its volume is %g, its longest edge %g",
                      at_tet(c, e), tet_name(c, e), volume, edge);
  return c->mesh->mid ? corot_check_map(c, e, edge) : COROT_OK;
}

corot_status corot_mesh_check_volumes(const corot_mesh *mesh) {
  const corot_mesh_names names = {.tet = "tet"};
  corot_mesh_place place;
  check c = {mesh, &names, &place};
  for (int e = 0; e < mesh->ntet; e++) COROT_TRY(check_volume(&c, e));
  return COROT_OK;
}

static corot_status check_use(const check *c) {
  char *used;
  COROT_TRY(COROT_ALLOC(used, c->mesh->nnode));
  for (int e = 0; e < c->mesh->ntet; e++)
    for (int k = 0; k < 4; k++) used[c->mesh->tet[e][k]] = 1;
  for (int e = 0; c->mesh->mid && e < c->mesh->ntet; e++)
    for (int k = 0; k < 6; k++) used[c->mesh->mid[e][k]] = 1;
  const char *unused = memchr(used, 0, (size_t)c->mesh->nnode);
  int i = unused ? (int)(unused - used) : -1;
  free(used);
  if (i < 0) return COROT_OK;
  const char *hint = c->names->unused_hint;
  return corot_fail(COROT_EINVAL, "%s %lld is in no tet%s%s", at_node(c, i), node_name(c, i),
                    hint ? "; " : "", hint ? hint : "");
}

/* Two tets that share a face must not be the same tet. */
static corot_status check_different(const check *c, const corot_face *a, const corot_face *b) {
  int(*tet)[4] = c->mesh->tet, ea = a->side / 4, eb = b->side / 4;
  if (tet[ea][a->side % 4] != tet[eb][b->side % 4]) return COROT_OK;
  return corot_fail(COROT_EINVAL, "%ss %lld and %lld have the same nodes", at_tet(c, eb),
                    tet_name(c, ea), tet_name(c, eb));
}

/* Nor lie on the same side of it. */
static corot_status check_sides(const check *c, const corot_face *a, const corot_face *b) {
  int ea = a->side / 4, eb = b->side / 4, ta[3], tb[3];
  corot_face_outward(a, (const int(*)[4])c->mesh->tet, ta);
  corot_face_outward(b, (const int(*)[4])c->mesh->tet, tb);
  if (corot_tri_ascends(ta) != corot_tri_ascends(tb)) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "%ss %lld and %lld overlap: they are on the same side of the face %lld %lld "
                    "%lld",
                    at_tet(c, eb), tet_name(c, ea), tet_name(c, eb), node_name(c, a->v[0]),
                    node_name(c, a->v[1]), node_name(c, a->v[2]));
}

/* f[0], f[1], f[2] are the same face. */
static corot_status check_three(const check *c, const corot_face *f) {
  COROT_TRY(check_different(c, &f[0], &f[2]));
  COROT_TRY(check_different(c, &f[1], &f[2]));
  return corot_fail(COROT_EINVAL, "%ss %lld, %lld and %lld share the face %lld %lld %lld",
                    at_tet(c, f[2].side / 4), tet_name(c, f[0].side / 4),
                    tet_name(c, f[1].side / 4), tet_name(c, f[2].side / 4), node_name(c, f->v[0]),
                    node_name(c, f->v[1]), node_name(c, f->v[2]));
}

static corot_status check_faces(const check *c, const corot_face *face) {
  int n = 4 * c->mesh->ntet;
  for (int i = 0; i + 1 < n; i++) {
    const corot_face *f = &face[i];
    if (corot_face_compare(&f[0], &f[1]) != 0) continue;
    COROT_TRY(check_different(c, &f[0], &f[1]));
    if (i + 2 < n && corot_face_compare(&f[0], &f[2]) == 0) return check_three(c, f);
    COROT_TRY(check_sides(c, &f[0], &f[1]));
  }
  return COROT_OK;
}

corot_status corot_mesh_check(const corot_mesh *mesh, const corot_mesh_names *names,
                              corot_mesh_place *place, corot_face **face) {
  check c = {mesh, names, place};
  corot_face *f;
  *place = (corot_mesh_place){PLACE_MESH, 0};
  COROT_TRY(corot_mesh_check_counts(mesh->nnode, mesh->ntet));
  COROT_TRY(check_coordinates(&c));
  if (mesh->mid) {
    for (int e = 0; e < mesh->ntet; e++) COROT_TRY(check_corners(&c, e));
    COROT_TRY(corot_check_middles(&c));
    for (int e = 0; e < mesh->ntet; e++) COROT_TRY(check_volume(&c, e));
  } else {
    for (int e = 0; e < mesh->ntet; e++) {
      COROT_TRY(check_corners(&c, e));
      COROT_TRY(check_volume(&c, e));
    }
  }
  COROT_TRY(check_use(&c));
  COROT_TRY(corot_faces_sort(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &f));
  corot_status status = check_faces(&c, f);
  if (status)
    free(f);
  else
    *face = f;
  return status;
}
