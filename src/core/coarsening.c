#include "core/coarsening.h"

#include <string.h>

#include "core/mesh.h"

/* --- Making it ------------------------------------------------------------------------------- */

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
   inside. */
static void find_weights(int n, double *weight) {
  static const int triangles[] = {6, 3, 1};
  for (int j = 0; j <= n; j++)
    for (int i = 0; i + j <= n; i++)
      weight[place_of(n, i, j)] = triangles[(i == 0) + (j == 0) + (i + j == n)] / (3.0 * n * n);
}

/* The faces, and of which tets they are. */
static int number_faces(int nside, const corot_face *side, int (*face)[4], int (*corner)[3]) {
  int n = 0;
  for (int k = 0; k < nside; k++) {
    if (k == 0 || corot_face_compare(&side[k - 1], &side[k]) != 0)
      memcpy(corner[n++], side[k].v, sizeof *corner);
    face[side[k].side / 4][side[k].side % 4] = n - 1;
  }
  return n;
}

static corot_status fill(const corot_refinement *r, int level, const corot_face *side, int n,
                         coarsening *c) {
  int(*corner)[3];
  COROT_TRY(COROT_ALLOC(c->face, c->ntet));
  COROT_TRY(COROT_ALLOC(c->weight, c->npoint));
  COROT_TRY(COROT_ALLOC(corner, 4 * (size_t)c->ntet));
  c->nface = number_faces(4 * c->ntet, side, c->face, corner);
  corot_status status = COROT_ALLOC(c->point, (size_t)c->nface * c->npoint);
  for (int f = 0; !status && f < c->nface; f++) {
    int *point = c->point + (size_t)f * c->npoint;
    point[place_of(n, 0, 0)] = corner[f][0];
    point[place_of(n, n, 0)] = corner[f][1];
    point[place_of(n, 0, n)] = corner[f][2];
    status = list_points(r, level, n, point);
  }
  free(corner);
  find_weights(n, c->weight);
  return status;
}

void corot_coarsening_by_values(int nnode, coarsening *c) { *c = (coarsening){.nnode = nnode}; }

corot_status corot_coarsening_by_means(const corot_refinement *r, int level, const int (*tet)[4],
                                       coarsening *out) {
  int n = 1 << (r->nlevel - level), ntet = r->ntet[level];
  coarsening c = {.nnode = 4 * ntet, .ntet = ntet, .npoint = (n + 1) * (n + 2) / 2};
  corot_face *side;
  COROT_TRY(corot_faces_sort(r->nnode[level], ntet, tet, &side));
  corot_status status = fill(r, level, side, n, &c);
  free(side);
  if (status) {
    corot_coarsening_clear(&c);
    return status;
  }
  *out = c;
  return COROT_OK;
}

void corot_coarsening_clear(coarsening *c) {
  free(c->face);
  free(c->point);
  free(c->weight);
  *c = (coarsening){0};
}

size_t corot_coarsening_bytes(const coarsening *c) {
  return c->ntet * sizeof *c->face + (size_t)c->nface * c->npoint * sizeof *c->point +
         c->npoint * sizeof *c->weight;
}

/* --- Using it -------------------------------------------------------------------------------- */

static void coarsen_by_means(const coarsening *c, const double (*u)[4], double (*mean)[4],
                             double *w) {
  const int *point = c->point;
  for (int f = 0; f < c->nface; f++, point += c->npoint) {
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < c->npoint; k++)
      for (int i = 0; i < 3; i++) sum[i] += c->weight[k] * u[point[k]][i];
    for (int i = 0; i < 3; i++) mean[f][i] = sum[i];
  }
  for (int e = 0; e < c->ntet; e++, w += 12) {
    const int *f = c->face[e];
    for (int i = 0; i < 3; i++) {
      double sum = mean[f[0]][i] + mean[f[1]][i] + mean[f[2]][i] + mean[f[3]][i];
      for (int j = 0; j < 4; j++) w[3 * j + i] = sum - 3 * mean[f[j]][i];
    }
  }
}

void corot_coarsen(const coarsening *c, const double (*u)[4], double (*mean)[4], double *w) {
  if (c->ntet) {
    coarsen_by_means(c, u, mean, w);
    return;
  }
  for (int n = 0; n < c->nnode; n++)
    for (int i = 0; i < 3; i++) w[3 * n + i] = u[n][i];
}

static void transposed_by_means(const coarsening *c, const double *g, double (*mean)[4],
                                double (*f)[4]) {
  memset(mean, 0, c->nface * sizeof *mean);
  for (int e = 0; e < c->ntet; e++, g += 12)
    for (int i = 0; i < 3; i++) {
      double sum = g[i] + g[3 + i] + g[6 + i] + g[9 + i];
      for (int j = 0; j < 4; j++) mean[c->face[e][j]][i] += sum - 3 * g[3 * j + i];
    }
  const int *point = c->point;
  for (int k = 0; k < c->nface; k++, point += c->npoint)
    for (int p = 0; p < c->npoint; p++)
      for (int i = 0; i < 3; i++) f[point[p]][i] += c->weight[p] * mean[k][i];
}

void corot_coarsen_transposed(const coarsening *c, const double *g, double (*mean)[4],
                              double (*f)[4]) {
  if (c->ntet) {
    transposed_by_means(c, g, mean, f);
    return;
  }
  for (int n = 0; n < c->nnode; n++)
    for (int i = 0; i < 3; i++) f[n][i] += g[3 * n + i];
}
