/* Builds the maps as sparse rows, and applies them and their transposes. */
#include "coarsening.h"

#include <string.h>

#include "core/mesh/mesh.h"

/* --- Making it ------------------------------------------------------------------------------- */

/* The tets of a level: node k of tet e is node k of its child 8 e + k, and so on down; where tets
   have only been given more nodes, of tet e itself. */
static corot_status level_tets(const corot_mesh *fine, const corot_refinement *r, int level,
                               int (**out)[4]) {
  int ntet = r->ntet[level], (*tet)[4];
  COROT_TRY(COROT_ALLOC(tet, ntet));
  for (int e = 0; e < ntet; e++)
    for (int k = 0; k < 4; k++) {
      int child = e;
      for (int l = level; l < r->nlevel; l++)
        if (r->ntet[l + 1] > r->ntet[l]) child = 8 * child + k;
      tet[e][k] = fine->tet[child][k];
    }
  *out = tet;
  return COROT_OK;
}

corot_status corot_coarsening_by_values(const corot_mesh *fine, const corot_refinement *r,
                                        int level, coarsening *c, corot_mesh **mesh) {
  int(*tet)[4] = NULL;
  corot_status status = COROT_OK;
  if (level == r->nlevel) {
    COROT_TRY(corot_mesh_copy(fine, mesh));
    *c = (coarsening){.nnode = fine->nnode, .volume = 1};
    return COROT_OK;
  }
  COROT_TRY(level_tets(fine, r, level, &tet));
  status = corot_mesh_create(r->nnode[level], (const double(*)[3])fine->x, r->ntet[level],
                             (const int(*)[4])tet, mesh);
  free(tet);
  COROT_TRY(status);
  *c = (coarsening){.nnode = r->nnode[level], .volume = 1};
  return COROT_OK;
}

/* The middle, on the level after `level`, of the edge between two nodes; -1: there is none. */
static int middle_of(const corot_refinement *r, int level, int a, int b) {
  int p = a < b ? a : b, q = a < b ? b : a, low = r->nnode[level], end = r->nnode[level + 1];
  for (int high = end; low < high;) {
    int mid = low + (high - low) / 2;
    const int *parent = r->parent[mid - r->nnode[0]];
    if (parent[0] < p || (parent[0] == p && parent[1] < q))
      low = mid + 1;
    else
      high = mid;
  }
  if (low == end) return -1;
  const int *parent = r->parent[low - r->nnode[0]];
  return parent[0] == p && parent[1] == q ? low : -1;
}

/* Where point (i, j), i + j <= n, stands in the list of the points of a face, whose corners are
   (0, 0), (n, 0) and (0, n). */
static int place_of(int n, int i, int j) { return j * (n + 1) - j * (j - 1) / 2 + i; }

/* From the corners, already in place, to ever shorter edges along i, j and across. */
static corot_status list_points(const corot_refinement *r, int level, int n, int *point) {
  for (int s = n / 2; s > 0; s /= 2, level++)
    for (int j = 0; j <= n; j += s)
      for (int i = 0; i + j <= n; i += s) {
        int along_i = i / s % 2, along_j = j / s % 2;
        if (!along_i && !along_j) continue; /* of an earlier level */
        int di = s * along_i, dj = s * along_j * (along_i ? -1 : 1);
        int a = point[place_of(n, i - di, j - dj)], b = point[place_of(n, i + di, j + dj)];
        int middle = middle_of(r, level, a, b);
        if (middle < 0)
          return corot_fail(COROT_EINVAL,
                            "hierarchy: level %d has no node in the middle of nodes %d and %d",
                            level + 1, a < b ? a : b, a < b ? b : a);
        point[place_of(n, i, j)] = middle;
      }
  return COROT_OK;
}

/* A point is a corner of one of the n^2 triangles if it is one of the face, of 3 on its edges, of 6
   inside. At order 2 the triangles are as wide as two points, and the mean over each is that of the
   middles of its edges (Strang 1973): a middle belongs to one if it is on an edge of the face, else
   to two. */
static void find_weights(int n, int order, double *weight) {
  static const int triangles[3][3] = {{0}, {6, 3, 1}, {2, 1, 0}};
  int wide = n / order;
  for (int j = 0; j <= n; j++)
    for (int i = 0; i + j <= n; i++) {
      int edges = (i == 0) + (j == 0) + (i + j == n);
      bool corner = order == 2 && i % 2 == 0 && j % 2 == 0;
      weight[place_of(n, i, j)] = corner ? 0 : triangles[order][edges] / (3.0 * wide * wide);
    }
}

/* The faces as nodes, each once: opposite[e][k] is the face of tet e opposite to its node k. */
static int number_faces(int nside, const corot_face *side, int (*corner)[3], int (*opposite)[4]) {
  int n = 0;
  for (int k = 0; k < nside; k++) {
    if (k == 0 || corot_face_compare(&side[k - 1], &side[k]) != 0)
      memcpy(corner[n++], side[k].v, sizeof *corner);
    opposite[side[k].side / 4][side[k].side % 4] = n - 1;
  }
  return n;
}

/* The tets between centroids of faces; turned inside out, which a model does not mind. */
static corot_status mesh_of_faces(const corot_mesh *fine, int ntet, const corot_face *side,
                                  int (*corner)[3], corot_mesh *mesh) {
  mesh->ntet = ntet;
  COROT_TRY(COROT_ALLOC(mesh->tet, ntet));
  mesh->nnode = number_faces(4 * ntet, side, corner, mesh->tet);
  COROT_TRY(COROT_ALLOC(mesh->x, mesh->nnode));
  for (int f = 0; f < mesh->nnode; f++)
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < 3; i++) mesh->x[f][i] += fine->x[corner[f][k]][i] / 3;
  return COROT_OK;
}

/* What is made on the way, for one place to free it. */
typedef struct draft {
  int (*tet)[4], (*corner)[3];
  corot_face *side;
  int *point;     /* all points of a face */
  double *weight; /* of these */
  corot_mesh *mesh;
  coarsening c;
} draft;

/* The weights that are not zero, of the `all` points of a face. */
static corot_status keep_weights(int all, draft *d) {
  for (int k = 0; k < all; k++) d->c.npoint += d->weight[k] > 0;
  COROT_TRY(COROT_ALLOC(d->c.weight, d->c.npoint));
  for (int k = 0, n = 0; k < all; k++)
    if (d->weight[k] > 0) d->c.weight[n++] = d->weight[k];
  return COROT_ALLOC(d->c.point, (size_t)d->c.nnode * d->c.npoint);
}

static corot_status points_of_faces(const corot_refinement *r, int level, int order, draft *d) {
  int n = 1 << (r->nlevel - level), all = (n + 1) * (n + 2) / 2, *point;
  COROT_TRY(COROT_ALLOC(d->point, all));
  COROT_TRY(COROT_ALLOC(d->weight, all));
  find_weights(n, order, d->weight);
  COROT_TRY(keep_weights(all, d));
  point = d->point;
  for (int f = 0, at = 0; f < d->c.nnode; f++) {
    point[place_of(n, 0, 0)] = d->corner[f][0];
    point[place_of(n, n, 0)] = d->corner[f][1];
    point[place_of(n, 0, n)] = d->corner[f][2];
    COROT_TRY(list_points(r, level, n, point));
    for (int k = 0; k < all; k++)
      if (d->weight[k] > 0) d->c.point[at++] = point[k];
  }
  return COROT_OK;
}

static corot_status fill(const corot_mesh *fine, const corot_refinement *r, int level, draft *d) {
  int ntet = r->ntet[level];
  COROT_TRY(level_tets(fine, r, level, &d->tet));
  COROT_TRY(corot_faces_sort(r->nnode[level], ntet, (const int(*)[4])d->tet, &d->side));
  COROT_TRY(COROT_ALLOC(d->corner, 4 * (size_t)ntet));
  COROT_TRY(COROT_ALLOC(d->mesh, 1));
  COROT_TRY(mesh_of_faces(fine, ntet, d->side, d->corner, d->mesh));
  d->c = (coarsening){.nnode = d->mesh->nnode, .volume = 27};
  return points_of_faces(r, level, corot_mesh_order(fine), d);
}

corot_status corot_coarsening_by_means(const corot_mesh *fine, const corot_refinement *r, int level,
                                       coarsening *c, corot_mesh **mesh) {
  draft d = {0};
  corot_status status = fill(fine, r, level, &d);
  free(d.tet);
  free(d.corner);
  free(d.side);
  free(d.point);
  free(d.weight);
  if (status) {
    corot_coarsening_clear(&d.c);
    corot_mesh_destroy(d.mesh);
    return status;
  }
  *c = d.c;
  *mesh = d.mesh;
  return COROT_OK;
}

void corot_coarsening_clear(coarsening *c) {
  free(c->point);
  free(c->weight);
  *c = (coarsening){0};
}

size_t corot_coarsening_bytes(const coarsening *c) {
  return (size_t)c->nnode * c->npoint * sizeof *c->point + c->npoint * sizeof *c->weight;
}

/* --- Using it -------------------------------------------------------------------------------- */

void corot_coarsen(const coarsening *c, const double (*u)[4], double (*w)[4]) {
  const int *point = c->point;
  for (int n = 0; n < c->nnode; n++) {
    double sum[3] = {0, 0, 0};
    if (!point) memcpy(sum, u[n], sizeof sum);
    for (int k = 0; k < c->npoint; k++)
      for (int i = 0; i < 3; i++) sum[i] += c->weight[k] * u[point[k]][i];
    for (int i = 0; i < 3; i++) w[n][i] = sum[i];
    if (point) point += c->npoint;
  }
}

void corot_coarsen_transposed(const coarsening *c, const double (*g)[4], double (*f)[4]) {
  const int *point = c->point;
  for (int n = 0; n < c->nnode; n++) {
    if (!point)
      for (int i = 0; i < 3; i++) f[n][i] += g[n][i];
    for (int k = 0; k < c->npoint; k++)
      for (int i = 0; i < 3; i++) f[point[k]][i] += c->weight[k] * g[n][i];
    if (point) point += c->npoint;
  }
}
