/* Where a point is in a mesh. A tet maps volume coordinates l, which sum to one, to

     X(l) = sum_a l_a x_a,   of order 2   sum_a l_a (2 l_a - 1) x_a + sum_ab 4 l_a l_b x_ab,

   which Newton's method inverts, at once where edges are straight. */
#include <math.h>
#include <string.h>

#include "mesh.h"

/* What rounding may take from a coordinate of a point on a face. */
#define NEAR 1e-9

enum { MOST_ITERATIONS = 50, HALVINGS = 40 };

/* A point on its way to its tet. */
typedef struct quest {
  const corot_mesh *mesh;
  double point[3];
  double near; /* what counts as no distance [m] */
} quest;

static double square_of(const double a[3]) { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; }

/* --- Shape functions --- */

/* x = X(l); slope[a] = dX / dl_a, of positions relative to corner 0. */
static void place(const corot_mesh *mesh, int e, const double l[4], double x[3],
                  double slope[4][3]) {
  const double(*at)[3] = (const double(*)[3])mesh->x;
  corot_location here = {.tet = e};
  memcpy(here.at, l, sizeof here.at);
  corot_location_weigh(mesh, &here);
  memcpy(x, here.x, sizeof here.x);
  if (mesh->mid) {
    corot_curved_slopes(at, mesh->tet[e], mesh->mid[e], l, slope);
    return;
  }
  for (int a = 0; a < 4; a++)
    for (int i = 0; i < 3; i++) slope[a][i] = at[mesh->tet[e][a]][i] - at[mesh->tet[e][0]][i];
}

/* Nodes, weights and position of the volume coordinates in the tet. */
void corot_location_weigh(const corot_mesh *mesh, corot_location *here) {
  const int *v = mesh->tet[here->tet];
  const double *l = here->at;
  here->nnode = mesh->mid ? 10 : 4;
  for (int a = 0; a < 4; a++) {
    here->node[a] = v[a];
    here->weight[a] = mesh->mid ? l[a] * (2 * l[a] - 1) : l[a];
  }
  for (int k = 4; k < here->nnode; k++) {
    const int *end = corot_tet_edge[k - 4];
    here->node[k] = mesh->mid[here->tet][k - 4];
    here->weight[k] = 4 * l[end[0]] * l[end[1]];
  }
  for (int i = 0; i < 3; i++) {
    double first = mesh->x[here->node[0]][i];
    here->x[i] = first;
    for (int k = 1; k < here->nnode; k++)
      here->x[i] += here->weight[k] * (mesh->x[here->node[k]][i] - first);
  }
}

/* step = what to add to l_1, l_2, l_3 so that X moves by r, to first order; whether it can. */
static bool invert(const double slope[4][3], const double r[3], double step[3]) {
  double a[3][3], minor[3][3];
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3; i++) a[k][i] = slope[k + 1][i] - slope[0][i];
  for (int k = 0; k < 3; k++) {
    const double *b = a[(k + 1) % 3], *c = a[(k + 2) % 3];
    minor[k][0] = b[1] * c[2] - b[2] * c[1];
    minor[k][1] = b[2] * c[0] - b[0] * c[2];
    minor[k][2] = b[0] * c[1] - b[1] * c[0];
  }
  double det = a[0][0] * minor[0][0] + a[0][1] * minor[0][1] + a[0][2] * minor[0][2];
  for (int k = 0; k < 3; k++)
    step[k] = (minor[k][0] * r[0] + minor[k][1] * r[1] + minor[k][2] * r[2]) / det;
  return isfinite(step[0] + step[1] + step[2]);
}

/* --- Inside --- */

/* l from a start to where X(l) is the point; false: it does not get there. */
static bool descend(const quest *q, int e, double l[4]) {
  double before = INFINITY;
  for (int k = 0; k < MOST_ITERATIONS; k++) {
    double x[3], slope[4][3], step[3], size = 0;
    place(q->mesh, e, l, x, slope);
    const double r[3] = {q->point[0] - x[0], q->point[1] - x[1], q->point[2] - x[2]};
    if (!invert((const double(*)[3])slope, r, step)) return false;
    for (int i = 0; i < 3; i++) size = fmax(size, fabs(step[i]));
    if (size < NEAR && !(size < 0.5 * before)) return true; /* rounding is all that is left */
    double part = size > 1 ? 1 / size : 1;
    for (int i = 0; i < 3; i++) l[i + 1] += part * step[i], l[0] -= part * step[i];
    before = size;
  }
  return false;
}

static double least_of(const double l[4]) { return fmin(fmin(l[0], l[1]), fmin(l[2], l[3])); }

/* The box that holds a tet: of order 2 that of its Bezier points. */
static bool may_hold(const quest *q, int e) {
  const corot_mesh *mesh = q->mesh;
  for (int i = 0; i < 3; i++) {
    double least = INFINITY, most = -INFINITY;
    for (int a = 0; a < 4; a++) {
      double x = mesh->x[mesh->tet[e][a]][i];
      least = fmin(least, x), most = fmax(most, x);
    }
    for (int k = 0; mesh->mid && k < 6; k++) {
      const int *end = corot_tet_edge[k];
      double x = 2 * mesh->x[mesh->mid[e][k]][i] -
                 0.5 * (mesh->x[mesh->tet[e][end[0]]][i] + mesh->x[mesh->tet[e][end[1]]][i]);
      least = fmin(least, x), most = fmax(most, x);
    }
    if (!(q->point[i] >= least - q->near && q->point[i] <= most + q->near)) return false;
  }
  return true;
}

/* l of the point in a tet, and whether it is there. A curved tet is tried from its corners, too. */
static bool find_in(const quest *q, int e, double l[4]) {
  for (int start = 0; start < (q->mesh->mid ? 5 : 1); start++) {
    for (int a = 0; a < 4; a++) l[a] = start == 0 ? 0.25 : a == start - 1 ? 0.7 : 0.1;
    if (descend(q, e, l) && least_of(l) >= -NEAR) return true;
  }
  return false;
}

/* The tet in which the point is deepest, of those that share it the first; -1: none. */
static int find_tet(const quest *q, double l[4]) {
  int found = -1;
  double deepest = -INFINITY;
  for (int e = 0; e < q->mesh->ntet && !(deepest > NEAR); e++) {
    double at[4];
    if (!may_hold(q, e) || !find_in(q, e, at) || !(least_of(at) > deepest)) continue;
    found = e;
    deepest = least_of(at);
    memcpy(l, at, sizeof at);
  }
  return found;
}

/* --- Outside --- */

/* A point on the face opposite to corner `side`: `on` are the volume coordinates of the others. */
static void put_on_face(int side, const double on[3], double l[4]) {
  double sum = 0, cut[3];
  for (int k = 0; k < 3; k++) cut[k] = fmax(on[k], 0), sum += cut[k];
  for (int k = 0; k < 3; k++) l[corot_tet_face[side][k]] = cut[k] / sum;
  l[side] = 0;
}

static double distance_of(const quest *q, int e, const double l[4]) {
  double x[3], slope[4][3];
  place(q->mesh, e, l, x, slope);
  const double r[3] = {x[0] - q->point[0], x[1] - q->point[1], x[2] - q->point[2]};
  return sqrt(square_of(r));
}

/* A step along a face to where the distance is perpendicular to it, if that is nearer. */
static void finish_on_face(const quest *q, int e, int side, double l[4], double *distance) {
  double x[3], slope[4][3], a[2][3], gram[3] = {0}, right[2] = {0}, on[3], other[4];
  const int *corner = corot_tet_face[side];
  place(q->mesh, e, l, x, slope);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 3; i++) a[k][i] = slope[corner[k + 1]][i] - slope[corner[0]][i];
  for (int i = 0; i < 3; i++) {
    double r = q->point[i] - x[i];
    gram[0] += a[0][i] * a[0][i], gram[1] += a[0][i] * a[1][i], gram[2] += a[1][i] * a[1][i];
    right[0] += a[0][i] * r, right[1] += a[1][i] * r;
  }
  double det = gram[0] * gram[2] - gram[1] * gram[1];
  on[1] = l[corner[1]] + (gram[2] * right[0] - gram[1] * right[1]) / det;
  on[2] = l[corner[2]] + (gram[0] * right[1] - gram[1] * right[0]) / det;
  on[0] = 1 - on[1] - on[2];
  if (!(on[0] >= 0 && on[1] >= 0 && on[2] >= 0)) return;
  put_on_face(side, on, other);
  double there = distance_of(q, e, other);
  if (!(there <= *distance)) return;
  memcpy(l, other, sizeof other);
  *distance = there;
}

/* The nearest point of a face: the best of a grid, about which the next is half as wide. */
static double approach_face(const quest *q, int e, int side, double l[4]) {
  double best[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
  put_on_face(side, best, l);
  double least = distance_of(q, e, l), width = 0.5;
  for (int k = 0; k < HALVINGS; k++, width *= 0.5) {
    const double middle[3] = {best[0], best[1], best[2]};
    for (int at = 0; at < 25; at++) {
      double s = width * (at % 5 - 2), t = width * (at / 5 - 2), other[4];
      const double on[3] = {middle[0] - s - t, middle[1] + s, middle[2] + t};
      if (!(fmax(on[0], 0) + fmax(on[1], 0) + fmax(on[2], 0) > 0)) continue;
      put_on_face(side, on, other);
      double there = distance_of(q, e, other);
      if (!(there < least)) continue;
      least = there;
      memcpy(l, other, sizeof other);
      for (int c = 0; c < 3; c++) best[c] = other[corot_tet_face[side][c]];
    }
  }
  finish_on_face(q, e, side, l, &least);
  return least;
}

/* Less than the distance from anything on a face: from the box of its nodes, grown by what edges
   may bulge. */
static double least_distance(const quest *q, int e, int side) {
  const corot_mesh *mesh = q->mesh;
  double off[3], bulge = 0;
  for (int i = 0; i < 3; i++) {
    double least = INFINITY, most = -INFINITY;
    for (int k = 0; k < 3; k++) {
      double x = mesh->x[mesh->tet[e][corot_tet_face[side][k]]][i];
      least = fmin(least, x), most = fmax(most, x);
    }
    for (int k = 0; mesh->mid && k < 6; k++) {
      const int *end = corot_tet_edge[k];
      double a = mesh->x[mesh->tet[e][end[0]]][i], b = mesh->x[mesh->tet[e][end[1]]][i];
      bulge = fmax(bulge, fabs(2 * mesh->x[mesh->mid[e][k]][i] - a - b));
    }
    off[i] = fmax(0, fmax(least - q->point[i], q->point[i] - most));
  }
  return sqrt(square_of(off)) - 2 * bulge;
}

/* The point of the surface that is nearest. */
static corot_status find_face(const quest *q, corot_location *here) {
  const corot_mesh *mesh = q->mesh;
  corot_face *face;
  COROT_TRY(corot_faces_sort(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &face));
  here->distance = INFINITY;
  for (int i = 0, n = 4 * mesh->ntet; i < n; i++) {
    bool shared = (i > 0 && corot_face_compare(&face[i - 1], &face[i]) == 0) ||
                  (i + 1 < n && corot_face_compare(&face[i], &face[i + 1]) == 0);
    int e = face[i].side / 4, side = face[i].side % 4;
    double l[4];
    if (shared || !(least_distance(q, e, side) < here->distance)) continue;
    double distance = approach_face(q, e, side, l);
    if (!(distance < here->distance)) continue;
    here->tet = e;
    here->distance = distance;
    memcpy(here->at, l, sizeof l);
  }
  free(face);
  corot_location_weigh(mesh, here);
  return COROT_OK;
}

/* --- All of it --- */

corot_location corot_mesh_locate_node(const corot_mesh *mesh, int node) {
  corot_location here = {.nnode = 1, .node = {node}, .weight = {1}};
  memcpy(here.x, mesh->x[node], sizeof here.x);
  for (int e = 0; e < mesh->ntet; e++) {
    here.tet = e;
    for (int a = 0; a < 4; a++)
      if (mesh->tet[e][a] == node) {
        here.at[a] = 1;
        return here;
      }
    for (int k = 0; mesh->mid && k < 6; k++)
      if (mesh->mid[e][k] == node) {
        here.at[corot_tet_edge[k][0]] = here.at[corot_tet_edge[k][1]] = 0.5;
        return here;
      }
  }
  return here; /* a sound mesh has no such node */
}

corot_status corot_mesh_locate(const corot_mesh *mesh, const double point[3],
                               corot_location *location) {
  double min[3], max[3], d[3];
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(point));
  COROT_TRY(COROT_GIVEN(location));
  if (!isfinite(point[0] + point[1] + point[2]))
    return corot_fail(COROT_EINVAL, "the point (%g, %g, %g) is not finite", point[0], point[1],
                      point[2]);
  quest q = {.mesh = mesh, .point = {point[0], point[1], point[2]}};
  corot_mesh_bounds(mesh, min, max);
  for (int i = 0; i < 3; i++) d[i] = max[i] - min[i];
  q.near = NEAR * sqrt(square_of(d));

  /* a node, but for rounding */
  int node = corot_mesh_nearest(mesh, point);
  for (int i = 0; i < 3; i++) d[i] = mesh->x[node][i] - point[i];
  if (sqrt(square_of(d)) <= q.near) {
    *location = corot_mesh_locate_node(mesh, node);
    return COROT_OK;
  }

  /* in a tet, or outside */
  corot_location here = {0};
  here.tet = find_tet(&q, here.at);
  if (here.tet < 0)
    COROT_TRY(find_face(&q, &here));
  else
    corot_location_weigh(mesh, &here);
  *location = here;
  return COROT_OK;
}
