/* Whether a mesh is sound, and if not, what exactly is wrong with it: all of it. */
#include "mesh_check.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define COORDINATE_MAX 1e100 /* so that the cube of an edge is finite */

void corot_check_found(const check *c, corot_mesh_place place, int index, const char *format, ...) {
  char text[500];
  va_list args;
  if (corot_faults_tell(c->faults)) {
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (c->names->locate)
      c->names->locate(c->names->file, place, index, text);
    else
      corot_fail(COROT_EINVAL, "%s", text);
  }
  corot_faults_add(c->faults);
}

corot_status corot_mesh_check_counts(int nnode, int ntet) {
  if (nnode < 0 || ntet < 0)
    return corot_fail(COROT_EINVAL, "a mesh cannot have %d nodes and %d tets", nnode, ntet);
  if (ntet == 0) return corot_fail(COROT_EINVAL, "the mesh has no tets");
  if (nnode > INT_MAX / 3 || ntet > INT_MAX / 4)
    return corot_fail(COROT_EINVAL, "%d nodes and %d tets are too many: at most %d and %d", nnode,
                      ntet, INT_MAX / 3, INT_MAX / 4);
  return COROT_OK;
}

/* One fault a node. */
static void check_coordinates(const check *c, int i) {
  for (int k = 0; k < 3 && !c->bad_node[i]; k++) {
    double x = c->mesh->x[i][k];
    if (fabs(x) <= COORDINATE_MAX) continue;
    corot_check_found(c, PLACE_NODE, i, "node %lld: %c is %g", node_name(c, i), "xyz"[k], x);
    c->bad_node[i] = 1;
  }
}

/* One fault a tet. The value is whether all its corners are nodes. */
static bool check_corners(const check *c, int e) {
  const int *v = c->mesh->tet[e];
  for (int k = 0; k < 4; k++) {
    if (v[k] >= 0 && v[k] < c->mesh->nnode) continue;
    corot_check_found(c, PLACE_TET, e, "%s %lld: node %d does not exist, the last is %d",
                      c->names->tet, tet_name(c, e), v[k], c->mesh->nnode - 1);
    c->bad_tet[e] = 1;
    return false;
  }
  for (int k = 1; k < 4; k++)
    for (int j = 0; j < k && !c->bad_tet[e]; j++) {
      if (v[j] != v[k]) continue;
      corot_check_found(c, PLACE_TET, e, "%s %lld has node %lld twice", c->names->tet,
                        tet_name(c, e), node_name(c, v[k]));
      c->bad_tet[e] = 1;
    }
  return true;
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

bool corot_tet_is_flat(const double (*x)[3], const int v[4]) {
  double edge = longest_edge(x, v);
  return !(fabs(corot_tet_volume(x, v)) > FLAT * edge * edge * edge);
}

/* The value is whether the volume of the corners is positive. */
static bool check_volume(const check *c, int e) {
  const double(*x)[3] = (const double(*)[3])c->mesh->x;
  double volume = corot_tet_volume(x, c->mesh->tet[e]);
  double edge = longest_edge(x, c->mesh->tet[e]), least = FLAT * edge * edge * edge;
  if (volume < -least)
    corot_check_found(c, PLACE_TET, e, "%s %lld is inverted: its volume is %g", c->names->tet,
                      tet_name(c, e), volume);
  else if (!(volume > least))
    corot_check_found(c, PLACE_TET, e, "%s %lld is flat: its volume is %g, its longest edge %g",
                      c->names->tet, tet_name(c, e), volume, edge);
  else if (c->mesh->mid)
    corot_check_map(c, e, edge);
  return volume > least;
}

corot_status corot_mesh_check_volumes(const corot_mesh *mesh) {
  const corot_mesh_names names = {.tet = "tet"};
  corot_mesh_faults faults = {0};
  check c = {.mesh = mesh, .names = &names, .faults = &faults};
  for (int e = 0; e < mesh->ntet; e++) check_volume(&c, e);
  return corot_faults_fail(&faults, COROT_EINVAL);
}

/* Volumes of the tets of which all nodes have a place. */
static void check_volumes(const check *c) {
  for (int e = 0; e < c->mesh->ntet; e++) {
    bool bad = c->bad_tet[e];
    for (int k = 0; k < 4 && !bad; k++) bad = c->bad_node[c->mesh->tet[e][k]];
    for (int k = 0; k < 6 && !bad && c->mesh->mid; k++) bad = c->bad_node[c->mesh->mid[e][k]];
    if (!bad && !check_volume(c, e)) c->bad_tet[e] = 2;
  }
}

static corot_status check_use(const check *c) {
  char *used;
  const char *hint = c->names->unused_hint;
  COROT_TRY(COROT_ALLOC(used, c->mesh->nnode));
  if (c->names->known) memcpy(used, c->names->known, (size_t)c->mesh->nnode);
  for (int e = 0; e < c->mesh->ntet; e++)
    for (int k = 0; k < 4; k++) used[c->mesh->tet[e][k]] = 1;
  for (int e = 0; c->mesh->mid && e < c->mesh->ntet; e++)
    for (int k = 0; k < 6; k++) used[c->mesh->mid[e][k]] = 1;
  for (int i = 0; i < c->mesh->nnode; i++) {
    if (used[i]) continue;
    corot_check_found(c, PLACE_NODE, i, "node %lld is in no tet%s%s", node_name(c, i),
                      hint ? "; " : "", hint ? hint : "");
    hint = NULL;
  }
  free(used);
  return COROT_OK;
}

/* --- Faces --- */

/* Whether the tets at two sides are the same one; told at the face opposite to the highest node. */
static bool is_repeated(const check *c, const corot_face *a, const corot_face *b) {
  int(*tet)[4] = c->mesh->tet, ea = a->side / 4, eb = b->side / 4, top = tet[ea][a->side % 4];
  if (top != tet[eb][b->side % 4]) return false;
  if (top > a->v[2])
    corot_check_found(c, PLACE_TET, eb, "%ss %lld and %lld have the same nodes", c->names->tet,
                      tet_name(c, ea), tet_name(c, eb));
  return true;
}

/* Two tets must not lie on the same side of a face. */
static void check_sides(const check *c, const corot_face *a, const corot_face *b) {
  int ea = a->side / 4, eb = b->side / 4, ta[3], tb[3];
  corot_face_outward(a, (const int(*)[4])c->mesh->tet, ta);
  corot_face_outward(b, (const int(*)[4])c->mesh->tet, tb);
  if (!c->bad_tet[ea] && !c->bad_tet[eb] && corot_tri_ascends(ta) == corot_tri_ascends(tb))
    corot_check_found(
        c, PLACE_TET, eb,
        "%ss %lld and %lld overlap: they are on the same side of the face %lld %lld %lld",
        c->names->tet, tet_name(c, ea), tet_name(c, eb), node_name(c, a->v[0]),
        node_name(c, a->v[1]), node_name(c, a->v[2]));
}

/* The different tets among `n` sides of one face, up to three of them. */
static int find_different(const check *c, const corot_face *face, int n, const corot_face *tet[3]) {
  int m = 0;
  for (int i = 0; i < n; i++) {
    bool repeated = c->bad_tet[face[i].side / 4] == 1;
    for (int k = 0; k < m && !repeated; k++) repeated = is_repeated(c, tet[k], &face[i]);
    if (!repeated && m < 3) tet[m++] = &face[i];
  }
  return m;
}

static void check_face(const check *c, const corot_face *face, int n) {
  const corot_face *tet[3];
  int m = find_different(c, face, n, tet);
  if (m == 2) check_sides(c, tet[0], tet[1]);
  if (m == 3)
    corot_check_found(c, PLACE_TET, tet[2]->side / 4,
                      "%ss %lld, %lld and %lld share the face %lld %lld %lld", c->names->tet,
                      tet_name(c, tet[0]->side / 4), tet_name(c, tet[1]->side / 4),
                      tet_name(c, tet[2]->side / 4), node_name(c, face->v[0]),
                      node_name(c, face->v[1]), node_name(c, face->v[2]));
}

static void check_faces(const check *c, const corot_face *face) {
  int n = 4 * c->mesh->ntet;
  for (int i = 0, end; i < n; i = end) {
    for (end = i + 1; end < n && corot_face_compare(&face[i], &face[end]) == 0;) end++;
    if (end > i + 1) check_face(c, &face[i], end - i);
  }
}

/* --- All of it --- */

static corot_status check_all(const check *c, corot_face **face) {
  const corot_mesh *mesh = c->mesh;
  bool in_range = true, sound = true;
  for (int i = 0; i < mesh->nnode; i++) check_coordinates(c, i);
  for (int e = 0; e < mesh->ntet; e++)
    if (!check_corners(c, e)) in_range = false;
  if (!in_range) return COROT_OK;
  if (mesh->mid) COROT_TRY(corot_check_middles(c, &sound));
  if (!sound) return COROT_OK;
  check_volumes(c);
  COROT_TRY(check_use(c));
  COROT_TRY(corot_faces_sort(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, face));
  check_faces(c, *face);
  return COROT_OK;
}

corot_status corot_mesh_check(const corot_mesh *mesh, const corot_mesh_names *names,
                              corot_mesh_faults *faults, corot_face **face) {
  check c = {.mesh = mesh, .names = names, .faults = faults};
  *face = NULL;
  corot_status status = corot_mesh_check_counts(mesh->nnode, mesh->ntet);
  if (status) {
    if (names->locate) names->locate(names->file, PLACE_MESH, 0, corot_error());
    corot_faults_add(faults);
    return COROT_OK;
  }
  status = COROT_ALLOC(c.bad_node, mesh->nnode);
  if (!status) status = COROT_ALLOC(c.bad_tet, mesh->ntet);
  if (!status) status = check_all(&c, face);
  free(c.bad_node);
  free(c.bad_tet);
  if (status || faults->n > 0) {
    free(*face);
    *face = NULL;
  }
  return status;
}
