/* How many tets lie through the thickness of a body: straight ways from its surface to the other
   side, from tet to tet by their faces. */
#include <math.h>

#include "mesh.h"

/* The ways begin a little off the middle of a triangle, so that they meet no edge of regular
 * meshes. */
static const double start[3] = {0.31, 0.34, 0.35};

/* A way that gets no further in so many tets goes round an edge. */
enum { STILL_MAX = 50 };

typedef struct way {
  double from[3], along[3]; /* of length 1 */
  double s;                 /* how far it has come */
} way;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Twice the area of a triangle, along its normal. */
static void normal_of(const corot_mesh *mesh, const int tri[3], double n[3]) {
  const double *x = mesh->x[tri[0]], *y = mesh->x[tri[1]], *z = mesh->x[tri[2]];
  double a[3], b[3];
  for (int k = 0; k < 3; k++) a[k] = y[k] - x[k], b[k] = z[k] - x[k];
  for (int k = 0; k < 3; k++) {
    int p = (k + 1) % 3, q = (k + 2) % 3;
    n[k] = a[p] * b[q] - a[q] * b[p];
  }
}

/* Nodes of face k of a tet, winding outward. */
static void face_of(const corot_mesh *mesh, int e, int k, int tri[3]) {
  for (int i = 0; i < 3; i++) tri[i] = mesh->tet[e][corot_tet_face[k][i]];
}

static way begin(const corot_mesh *mesh, int side) {
  way w = {.s = 0};
  int tri[3];
  double n[3];
  face_of(mesh, side / 4, side % 4, tri);
  normal_of(mesh, tri, n);
  double length = sqrt(dot(n, n));
  for (int k = 0; k < 3; k++) {
    w.along[k] = -n[k] / length;
    for (int i = 0; i < 3; i++) w.from[k] += start[i] * mesh->x[tri[i]][k];
  }
  return w;
}

/* The face by which the way leaves tet e, and *s where: of those it goes out through, the nearest.
 */
static int leave(const corot_mesh *mesh, const way *w, int e, double *s) {
  int face = -1;
  *s = INFINITY;
  for (int k = 0; k < 4; k++) {
    int tri[3];
    double n[3], to[3];
    face_of(mesh, e, k, tri);
    normal_of(mesh, tri, n);
    double out = dot(n, w->along);
    if (!(out > 1e-12 * sqrt(dot(n, n)))) continue;
    for (int i = 0; i < 3; i++) to[i] = mesh->x[tri[0]][i] - w->from[i];
    double at = dot(n, to) / out;
    if (at >= *s) continue;
    *s = at;
    face = k;
  }
  return face;
}

/* The extent of tet e along the way. */
static double extent(const corot_mesh *mesh, const way *w, int e) {
  double low = INFINITY, high = -INFINITY;
  for (int k = 0; k < 4; k++) {
    double at = dot(mesh->x[mesh->tet[e][k]], w->along);
    low = fmin(low, at);
    high = fmax(high, at);
  }
  return high - low;
}

/* The way from a side of the surface; across [4 * ntet]: the side that shares its face, or -1. */
static corot_crossing cross(const corot_mesh *mesh, const int *across, int side) {
  corot_crossing c = {.tet = side / 4};
  way w = begin(mesh, side);
  double ntet = 0, s;
  int e = side / 4, still = 0;
  while (still < STILL_MAX) {
    int face = leave(mesh, &w, e, &s);
    if (face < 0) return c;
    still = s > w.s ? 0 : still + 1;
    if (s > w.s) {
      ntet += (s - w.s) / extent(mesh, &w, e);
      w.s = s;
    }
    int next = across[4 * e + face];
    if (next < 0) return (corot_crossing){.tet = side / 4, .length = w.s, .ntet = ntet};
    e = next / 4;
  }
  return c;
}

corot_status corot_mesh_cross(const corot_mesh *mesh, corot_crossing **crossing) {
  int n = 4 * mesh->ntet, ntri = 0, *across = NULL;
  corot_face *face = NULL;
  corot_crossing *c = NULL;
  corot_status status =
      corot_faces_sort(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &face);
  if (!status) status = COROT_ALLOC(across, n);
  for (int i = 0; i < n && !status; i++) across[i] = -1;
  for (int i = 1; i < n && !status; i++)
    if (corot_face_compare(&face[i - 1], &face[i]) == 0) {
      across[face[i - 1].side] = face[i].side;
      across[face[i].side] = face[i - 1].side;
    }
  for (int i = 0; i < n && !status; i++) ntri += across[i] < 0;
  if (!status) status = COROT_ALLOC(c, ntri);
  ntri = 0;
  for (int i = 0; i < n && !status; i++)
    if (across[face[i].side] < 0) c[ntri++] = cross(mesh, across, face[i].side);
  free(face);
  free(across);
  if (!status) *crossing = c;
  return status;
}
