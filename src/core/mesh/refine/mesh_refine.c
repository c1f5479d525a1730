/* Octasection (Bey, Tetrahedral grid refinement, Computing 55, 1995). */
#include "mesh_refine.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/* A tet's diagonal goes from the middle of one edge to that of the opposite one: from 0 k to the
   other two, for k = 1, 2 or 3. That splits the corners into pairs, and k also names the split: the
   partner of corner i is i ^ k. Bey's rule in these terms: the pairs of a tet are inherited by its
   corner children, and each child around the diagonal has the diagonal's ends as a pair. No more of
   the order of the nodes matters, so a child may have its nodes in any order that puts the pairs
   where `bey` expects them. */

bool corot_tet_is_odd(const int v[4]) {
  int inversions = 0;
  for (int k = 1; k < 4; k++)
    for (int j = 0; j < k; j++) inversions += v[j] > v[k];
  return inversions % 2;
}

/* Bey's tets alternate in handedness, ours do not: corners 1 and 2 of every second one are swapped.
   Which ones shows in the numbers, whose permutation no right-handed order of a tet can change from
   even to odd. */
static int bey(const int v[4]) { return corot_tet_is_odd(v) ? 1 : 2; }

/* Turns three corners about the fourth, `fixed`, until the pairs named k are where bey expects
   them. */
static void place_pairs(const int from[4], int k, int fixed, int to[4]) {
  int expected = bey(from);
  to[fixed] = from[fixed];
  for (int i = 1; i < 4; i++) to[fixed ^ ((i - k + expected + 2) % 3 + 1)] = from[fixed ^ i];
}

#define SHORTER (1 - 1e-9) /* of squared lengths: not by rounding alone */

/* middle[i][j]: the middle of the edge between corners i and j; middle[i][i]: corner i. */
static int shortest(const double (*x)[3], const int v[4], const int middle[4][4]) {
  double least = INFINITY;
  int k = 0;
  for (int turn = 0; turn < 3; turn++) {
    int candidate = (bey(v) + turn - 1) % 3 + 1, i = candidate % 3 + 1;
    const double *a = x[middle[0][candidate]], *b = x[middle[i][i ^ candidate]];
    double length = 0;
    for (int c = 0; c < 3; c++) length += (a[c] - b[c]) * (a[c] - b[c]);
    if (length < SHORTER * least) {
      least = length;
      k = candidate;
    }
  }
  return k;
}

/* The middles of edges that are the corners of the tets around the diagonal for k = 2. */
static const int around[4][4][2] = {{{0, 1}, {0, 2}, {0, 3}, {1, 3}},
                                    {{1, 2}, {0, 2}, {0, 1}, {1, 3}},
                                    {{0, 2}, {0, 3}, {1, 3}, {2, 3}},
                                    {{1, 3}, {1, 2}, {0, 2}, {2, 3}}};

static void cut_tet(const int middle[4][4], int k, int (*child)[4]) {
  for (int i = 0; i < 4; i++) place_pairs(middle[i], k, i, child[i]);
  const int turned[4] = {0, (k + 1) % 3 + 1, k, k % 3 + 1}; /* k in the place of 2 */
  for (int t = 0; t < 4; t++) {
    int v[4];
    for (int i = 0; i < 4; i++) v[i] = middle[turned[around[t][i][0]]][turned[around[t][i][1]]];
    place_pairs(v, 2, 0, child[4 + t]);
  }
}

static void cut_tets(const corot_mesh *mesh, const corot_edges *edges, corot_diagonal diagonal,
                     corot_mesh *fine) {
  static const int edge[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};
  for (int e = 0; e < mesh->ntet; e++) {
    const int *v = mesh->tet[e];
    int middle[4][4], k = bey(v);
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++)
        middle[i][j] = i == j ? v[i] : corot_edge_middle(edges, edges->tet[e][edge[i][j]]);
    if (diagonal == COROT_DIAGONAL_SHORTEST)
      k = shortest((const double(*)[3])fine->x, v, (const int(*)[4])middle);
    cut_tet((const int(*)[4])middle, k, &fine->tet[8 * e]);
  }
}

/* Corners and tets of the refined mesh: those of a mesh of order 2 are all its nodes. */
static corot_status cut(const corot_mesh *mesh, const corot_edges *edges, corot_diagonal diagonal,
                        corot_mesh *fine) {
  int nnew = mesh->mid ? 0 : edges->n;
  COROT_TRY(COROT_ALLOC(fine->x, mesh->nnode + nnew));
  COROT_TRY(COROT_ALLOC(fine->tet, 8 * mesh->ntet));
  fine->nnode = mesh->nnode + nnew;
  fine->ntet = 8 * mesh->ntet;
  memcpy(fine->x, mesh->x, (size_t)mesh->nnode * sizeof *fine->x);
  if (nnew) corot_edges_place(mesh, edges, fine->x + mesh->nnode);
  cut_tets(mesh, edges, diagonal, fine);
  return corot_mesh_check_volumes(fine);
}

/* A mesh in the course of its refinement. */
typedef struct refiner {
  corot_diagonal diagonal;
  int level; /* of the mesh */
  corot_mesh *mesh;
  int nskin;
  int (*skin)[3]; /* [nskin] the boundary */
  corot_refinement *history;
} refiner;

static corot_status append_level(refiner *r, const corot_mesh *fine, const corot_edges *edges) {
  corot_refinement *h = r->history;
  size_t had = (size_t)(r->mesh->nnode - h->nnode[0]), n = (size_t)edges->n;
  int(*more)[2] = realloc(h->parent, (had + n) * sizeof *more);
  if (!more)
    return corot_fail(COROT_ENOMEM, "out of memory: %zu times %zu bytes", had + n, sizeof *more);
  h->parent = more;
  memcpy(more + had, edges->end, n * sizeof *more);
  h->nnode[r->level + 1] = fine->nnode;
  h->ntet[r->level + 1] = fine->ntet;
  return COROT_OK;
}

static corot_status at_level(const refiner *r, corot_status status) {
  if (status != COROT_EINVAL) return status;
  return corot_fail(status, "at refinement %d, %s", r->level + 1, corot_error());
}

/* Makes `corners`, which have all but the nodes on edges, a mesh of order 2. `skin` [nskin] is
   their boundary. */
static corot_status add_middles(refiner *r, const corot_mesh *corners, int nskin,
                                const int (*skin)[3], corot_mesh *fine) {
  corot_edges fine_edges = {0};
  corot_status status = corot_edges_list(corners, &fine_edges);
  if (!status) status = corot_raise(corners, &fine_edges, fine);
  if (!status) status = corot_edges_bend(r->mesh, corners, &fine_edges, fine->x);
  if (!status) status = at_level(r, corot_mesh_check_volumes(fine));
  if (!status) status = corot_raise_groups(corners, &fine_edges, nskin, skin, fine);
  if (!status) status = append_level(r, fine, &fine_edges);
  corot_edges_clear(&fine_edges);
  return status;
}

/* Fills `fine` and `skin`, both of which the caller frees. */
static corot_status make_level(refiner *r, const corot_edges *edges, corot_mesh *fine,
                               int (**skin)[3]) {
  const int(*old)[3] = (const int(*)[3])r->skin;
  COROT_TRY(at_level(r, cut(r->mesh, edges, r->diagonal, fine)));
  COROT_TRY(corot_refine_groups(r->mesh, edges, r->nskin, old, fine));
  COROT_TRY(corot_refine_triangles(edges, r->nskin, old, skin));
  return r->mesh->mid ? COROT_OK : append_level(r, fine, edges);
}

/* Replaces the corners by the mesh of order 2. */
static corot_status finish_level_2(refiner *r, int (*skin)[3], corot_mesh **fine) {
  corot_mesh *raised;
  COROT_TRY(COROT_ALLOC(raised, 1));
  corot_status status = add_middles(r, *fine, 4 * r->nskin, (const int(*)[3])skin, raised);
  if (status) {
    corot_mesh_destroy(raised);
    return status;
  }
  corot_mesh_destroy(*fine);
  *fine = raised;
  return COROT_OK;
}

static corot_status refine_once(refiner *r) {
  corot_edges edges = {0};
  int(*skin)[3] = NULL;
  corot_mesh *fine;
  COROT_TRY(COROT_ALLOC(fine, 1));
  corot_status status = corot_edges_list(r->mesh, &edges);
  if (!status) status = make_level(r, &edges, fine, &skin);
  if (!status && r->mesh->mid) status = finish_level_2(r, skin, &fine);
  corot_edges_clear(&edges);
  if (status) {
    free(skin);
    corot_mesh_destroy(fine);
    return status;
  }
  corot_mesh_destroy(r->mesh);
  free(r->skin);
  r->mesh = fine;
  r->skin = skin;
  r->nskin *= 4;
  r->level++;
  return COROT_OK;
}

/* Nodes need no check at order 1: a tet of the refined mesh has at most 10 / 8 of them for itself.
 */
static corot_status check_levels(const corot_mesh *mesh, int nlevel, corot_diagonal diagonal) {
  if (nlevel < 0) return corot_fail(COROT_EINVAL, "a mesh cannot be refined %d times", nlevel);
  if (diagonal != COROT_DIAGONAL_CONSISTENT && diagonal != COROT_DIAGONAL_SHORTEST)
    return corot_fail(COROT_EINVAL, "there is no diagonal %d", (int)diagonal);
  int most = 0, limit = mesh->mid ? INT_MAX / 10 : INT_MAX / 4;
  for (int n = mesh->ntet; n <= limit / 8; n *= 8) most++;
  if (nlevel > most)
    return corot_fail(COROT_EINVAL,
                      "refining %d tets %d times makes %.3g, more than %d: at most %d", mesh->ntet,
                      nlevel, mesh->ntet * pow(8, nlevel), limit, most);
  return COROT_OK;
}

static corot_status begin(const corot_mesh *mesh, int nlevel, refiner *r) {
  COROT_TRY(corot_mesh_copy(mesh, &r->mesh));
  COROT_TRY(corot_mesh_boundary(mesh, &r->nskin, &r->skin));
  corot_refinement *h;
  COROT_TRY(COROT_ALLOC(h, 1));
  r->history = h;
  h->nlevel = nlevel;
  COROT_TRY(COROT_ALLOC(h->nnode, nlevel + 1));
  COROT_TRY(COROT_ALLOC(h->ntet, nlevel + 1));
  COROT_TRY(COROT_ALLOC(h->parent, 0));
  h->nnode[0] = mesh->nnode;
  h->ntet[0] = mesh->ntet;
  return COROT_OK;
}

corot_status corot_mesh_refine(const corot_mesh *mesh, int nlevel, corot_diagonal diagonal,
                               corot_mesh **fine, corot_refinement **refinement) {
  refiner r = {.diagonal = diagonal};
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(fine));
  COROT_TRY(check_levels(mesh, nlevel, diagonal));
  corot_status status = begin(mesh, nlevel, &r);
  while (!status && r.level < nlevel) status = refine_once(&r);
  if (!status) *fine = r.mesh;
  if (!status && refinement) *refinement = r.history;
  if (status) corot_mesh_destroy(r.mesh);
  if (status || !refinement) corot_refinement_destroy(r.history);
  free(r.skin);
  return status;
}

void corot_refinement_destroy(corot_refinement *refinement) {
  if (!refinement) return;
  free(refinement->nnode);
  free(refinement->ntet);
  free(refinement->parent);
  free(refinement->node);
  free(refinement);
}
