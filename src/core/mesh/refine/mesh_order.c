/* Four-node tets made ten-node ones, and the other way. */
#include <limits.h>
#include <string.h>

#include "mesh_refine.h"

int corot_mesh_order(const corot_mesh *mesh) { return mesh->mid ? 2 : 1; }

/* Room for nodes and tets of order 2, the tets those of `mesh`, and the positions of its nodes. */
static corot_status begin_raised(const corot_mesh *mesh, const corot_edges *edges, corot_mesh *to) {
  if (edges->n > INT_MAX / 3 - mesh->nnode)
    return corot_fail(COROT_EINVAL, "%d nodes on the edges of a mesh of %d are too many", edges->n,
                      mesh->nnode);
  COROT_TRY(COROT_ALLOC(to->x, mesh->nnode + edges->n));
  COROT_TRY(COROT_ALLOC(to->tet, mesh->ntet));
  COROT_TRY(COROT_ALLOC(to->mid, mesh->ntet));
  to->nnode = mesh->nnode + edges->n;
  to->ntet = mesh->ntet;
  memcpy(to->x, mesh->x, (size_t)mesh->nnode * sizeof *to->x);
  memcpy(to->tet, mesh->tet, (size_t)mesh->ntet * sizeof *to->tet);
  return COROT_OK;
}

corot_status corot_raise(const corot_mesh *mesh, const corot_edges *edges, corot_mesh *to) {
  COROT_TRY(begin_raised(mesh, edges, to));
  corot_edges_place(mesh, edges, to->x + mesh->nnode);
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 6; k++) to->mid[e][k] = mesh->nnode + edges->tet[e][corot_edge_of_mid[k]];
  return COROT_OK;
}

/* Fills a zeroed mesh. */
static corot_status raise_all(const corot_mesh *mesh, corot_mesh *to) {
  corot_edges edges = {0};
  int nskin, (*skin)[3] = NULL;
  if (mesh->ntet > INT_MAX / 10)
    return corot_fail(COROT_EINVAL, "%d ten-node tets are too many: at most %d", mesh->ntet,
                      INT_MAX / 10);
  corot_status status = corot_edges_list(mesh, &edges);
  if (!status) status = corot_raise(mesh, &edges, to);
  if (!status) status = corot_mesh_check_volumes(to);
  if (!status) status = corot_mesh_boundary(mesh, &nskin, &skin);
  if (!status) status = corot_raise_groups(mesh, &edges, nskin, (const int(*)[3])skin, to);
  free(skin);
  corot_edges_clear(&edges);
  return status;
}

/* place[i] = the number of corner i among the corners, -1 for other nodes; the value is how many.
 */
static int number_corners(const corot_mesh *mesh, int *place) {
  int n = 0;
  for (int i = 0; i < mesh->nnode; i++) place[i] = -1;
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 4; k++) place[mesh->tet[e][k]] = 0;
  for (int i = 0; i < mesh->nnode; i++)
    if (place[i] == 0) place[i] = n++;
  return n;
}

static corot_status lower_group(const corot_group *from, const int *place, corot_group *to) {
  COROT_TRY(COROT_ALLOC(to->name, strlen(from->name) + 1));
  strcpy(to->name, from->name);
  COROT_TRY(COROT_ALLOC(to->node, from->nnode));
  COROT_TRY(COROT_ALLOC(to->tri, from->ntri));
  COROT_TRY(COROT_ALLOC(to->tet, from->ntet));
  for (int i = 0; i < from->nnode; i++)
    if (place[from->node[i]] >= 0) to->node[to->nnode++] = place[from->node[i]];
  to->ntri = from->ntri;
  for (int t = 0; t < to->ntri; t++)
    for (int k = 0; k < 3; k++) to->tri[t][k] = place[from->tri[t][k]];
  to->ntet = from->ntet;
  for (int i = 0; i < to->ntet; i++) to->tet[i] = from->tet[i];
  return COROT_OK;
}

static corot_status lower_groups(const corot_mesh *mesh, const int *place, corot_mesh *to) {
  COROT_TRY(COROT_ALLOC(to->group, mesh->ngroup));
  for (int g = 0; g < mesh->ngroup; g++) {
    corot_group *group = &to->group[to->ngroup++];
    COROT_TRY(lower_group(&mesh->group[g], place, group));
    if (group->nnode == 0) {
      corot_group_clear(group);
      to->ngroup--;
    }
  }
  return COROT_OK;
}

/* Fills a zeroed mesh; `place` [nnode] is scratch. */
static corot_status lower(const corot_mesh *mesh, int *place, corot_mesh *to) {
  int n = number_corners(mesh, place);
  COROT_TRY(COROT_ALLOC(to->x, n));
  COROT_TRY(COROT_ALLOC(to->tet, mesh->ntet));
  to->nnode = n;
  to->ntet = mesh->ntet;
  for (int i = 0; i < mesh->nnode; i++)
    if (place[i] >= 0) memcpy(to->x[place[i]], mesh->x[i], sizeof *to->x);
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 4; k++) to->tet[e][k] = place[mesh->tet[e][k]];
  return lower_groups(mesh, place, to);
}

static corot_status lower_all(const corot_mesh *mesh, corot_mesh *to) {
  int *place;
  COROT_TRY(COROT_ALLOC(place, mesh->nnode));
  corot_status status = lower(mesh, place, to);
  free(place);
  return status;
}

/* Grows the arrays of a refinement by a level of n nodes, which are to be filled in. */
static corot_status grow(corot_refinement *r, int n) {
  int levels = r->nlevel + 2;
  size_t count = (size_t)(r->nnode[r->nlevel] - r->nnode[0]) + (size_t)n;
  int *nnode = realloc(r->nnode, (size_t)levels * sizeof *nnode);
  if (nnode) r->nnode = nnode;
  int *ntet = realloc(r->ntet, (size_t)levels * sizeof *ntet);
  if (ntet) r->ntet = ntet;
  int(*parent)[2] = realloc(r->parent, count * sizeof *parent);
  if (parent) r->parent = parent;
  if (nnode && ntet && parent) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "out of memory: %zu times %zu bytes", count, sizeof *parent);
}

/* Whether the nodes on edges are those that corot_mesh_change_order appends to nnode others. */
static bool is_raised(const corot_mesh *mesh, const corot_edges *edges, int nnode) {
  if (nnode + edges->n != mesh->nnode) return false;
  for (int i = 0; i < edges->n; i++)
    if (edges->middle[i] != nnode + i) return false;
  return true;
}

corot_status corot_refinement_raise(corot_refinement *r, const corot_mesh *raised) {
  corot_edges edges = {0};
  int l = r->nlevel;
  if (!raised->mid || raised->ntet != r->ntet[l])
    return corot_fail(COROT_EINVAL, "refinement: %d tets of order %d are not its %d ones raised",
                      raised->ntet, corot_mesh_order(raised), r->ntet[l]);
  corot_status status = corot_edges_list(raised, &edges);
  if (!status && !is_raised(raised, &edges, r->nnode[l]))
    status = corot_fail(COROT_EINVAL, "refinement: the nodes on edges do not follow its %d nodes",
                        r->nnode[l]);
  if (!status) status = grow(r, edges.n);
  if (!status) {
    memcpy(r->parent + (r->nnode[l] - r->nnode[0]), edges.end, (size_t)edges.n * sizeof *r->parent);
    r->nnode[l + 1] = raised->nnode;
    r->ntet[l + 1] = raised->ntet;
    r->nlevel++;
  }
  corot_edges_clear(&edges);
  return status;
}

/* --- A level below --- */

/* node [r's nodes]: corners ascending, the nodes on edges in the order of these, all others. place
   [mesh->nnode] becomes where its nodes stand there. The value is the number of corners. */
static int order_nodes(const corot_mesh *mesh, const corot_edges *edges, int nnode, int *place,
                       int *node) {
  int n = number_corners(mesh, place);
  for (int i = 0; i < mesh->nnode; i++)
    if (place[i] >= 0) node[place[i]] = i;
  for (int k = 0; k < edges->n; k++) {
    node[n + k] = edges->middle[k];
    place[edges->middle[k]] = n + k;
  }
  for (int i = mesh->nnode; i < nnode; i++) node[i] = i;
  return n;
}

static int place_in(const corot_mesh *mesh, const int *place, int i) {
  return i < mesh->nnode ? place[i] : i;
}

static void set_parents(const int a, const int b, int parent[2]) {
  parent[0] = a < b ? a : b;
  parent[1] = a < b ? b : a;
}

/* A refinement with a level more, `to` being zeroed. */
static corot_status lower_to(const corot_refinement *r, const corot_mesh *mesh,
                             const corot_edges *edges, int *place, corot_refinement *to) {
  int nnode = r->nnode[r->nlevel];
  to->nlevel = r->nlevel + 1;
  COROT_TRY(COROT_ALLOC(to->nnode, to->nlevel + 1));
  COROT_TRY(COROT_ALLOC(to->ntet, to->nlevel + 1));
  COROT_TRY(COROT_ALLOC(to->node, nnode));
  to->nnode[0] = order_nodes(mesh, edges, nnode, place, to->node);
  to->ntet[0] = r->ntet[0];
  memcpy(to->nnode + 1, r->nnode, (size_t)to->nlevel * sizeof *to->nnode);
  memcpy(to->ntet + 1, r->ntet, (size_t)to->nlevel * sizeof *to->ntet);
  COROT_TRY(COROT_ALLOC(to->parent, nnode - to->nnode[0]));
  for (int k = 0; k < edges->n; k++)
    set_parents(place[edges->end[k][0]], place[edges->end[k][1]], to->parent[k]);
  for (int k = 0; k < nnode - mesh->nnode; k++)
    set_parents(place_in(mesh, place, r->parent[k][0]), place_in(mesh, place, r->parent[k][1]),
                to->parent[edges->n + k]);
  return COROT_OK;
}

corot_status corot_refinement_lower(corot_refinement *r, const corot_mesh *mesh) {
  corot_refinement *to;
  corot_edges edges = {0};
  int *place = NULL;
  if (!mesh->mid || r->node || mesh->nnode != r->nnode[0] || mesh->ntet != r->ntet[0])
    return corot_fail(COROT_EINVAL,
                      "refinement: %d nodes of a mesh of order %d are not its level 0 of order 2, "
                      "with %d nodes",
                      mesh->nnode, corot_mesh_order(mesh), r->nnode[0]);
  COROT_TRY(COROT_ALLOC(to, 1));
  corot_status status = COROT_ALLOC(place, mesh->nnode);
  if (!status) status = corot_edges_list(mesh, &edges);
  if (!status) status = lower_to(r, mesh, &edges, place, to);
  if (!status) {
    const corot_refinement before = *r;
    *r = *to, *to = before;
  }
  corot_refinement_destroy(to);
  corot_edges_clear(&edges);
  free(place);
  return status;
}

corot_status corot_mesh_change_order(const corot_mesh *mesh, int order, corot_mesh **out) {
  corot_mesh *m;
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(out));
  if (order != 1 && order != 2)
    return corot_fail(COROT_EINVAL, "a mesh of order %d: only 1 and 2 are there", order);
  if (order == corot_mesh_order(mesh)) return corot_mesh_copy(mesh, out);
  COROT_TRY(COROT_ALLOC(m, 1));
  corot_status status = order == 2 ? raise_all(mesh, m) : lower_all(mesh, m);
  if (status)
    corot_mesh_destroy(m);
  else
    *out = m;
  return status;
}
