/* Named groups by what is around: faces that look in a direction, nodes near to another group. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "mesh.h"

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract(const double a[3], const double b[3], double d[3]) {
  for (int k = 0; k < 3; k++) d[k] = a[k] - b[k];
}

static double length_of(const double a[3]) { return hypot(hypot(a[0], a[1]), a[2]); }

/* --- Normals --- */

/* The angle between a triangle's normal and a direction of length one [rad]: by sine and cosine,
   so that small ones are exact. */
static double angle_to(const corot_mesh *mesh, const int tri[3], const double direction[3]) {
  double a[3], b[3];
  subtract(mesh->x[tri[1]], mesh->x[tri[0]], a);
  subtract(mesh->x[tri[2]], mesh->x[tri[0]], b);
  double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  double size = length_of(n);
  for (int k = 0; k < 3; k++) n[k] /= size;
  double across[3] = {n[1] * direction[2] - n[2] * direction[1],
                      n[2] * direction[0] - n[0] * direction[2],
                      n[0] * direction[1] - n[1] * direction[0]};
  return atan2(length_of(across), dot(n, direction));
}

/* The triangles whose angle is at most that, moved to the front; *least: the smallest angle. */
static int select_normals(const corot_mesh *mesh, const double direction[3], double angle, int ntri,
                          int (*tri)[3], double *least) {
  int n = 0;
  *least = INFINITY;
  for (int i = 0; i < ntri; i++) {
    double found = angle_to(mesh, tri[i], direction);
    *least = fmin(*least, found);
    if (!(found <= angle + 1e-6)) continue;
    if (n != i) memcpy(tri[n], tri[i], sizeof *tri);
    n++;
  }
  return n;
}

corot_status corot_mesh_group_normal(corot_mesh *mesh, const char *name, const double direction[3],
                                     double angle) {
  double unit[3], least;
  int ntri, (*tri)[3];
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(direction));
  COROT_TRY(corot_mesh_unit(name, "direction", direction, unit));
  if (!(angle >= 0 && angle < 4))
    return corot_fail(COROT_EINVAL, "group '%s': the angle is %g rad, not between 0 and pi", name,
                      angle);
  COROT_TRY(corot_mesh_boundary(mesh, &ntri, &tri));
  int n = select_normals(mesh, unit, angle, ntri, tri, &least);
  corot_status status =
      n ? corot_mesh_group_triangles(mesh, name, n, (const int(*)[3])tri)
        : corot_fail(COROT_EINVAL,
                     "group '%s': no face of the boundary has its normal within %g rad of (%g, %g, "
                     "%g); the nearest is %g rad away",
                     name, angle, unit[0], unit[1], unit[2], least);
  free(tri);
  return status;
}

/* --- A tree of boxes around triangles --- */

enum { FEW = 8 }; /* triangles of a leaf, at most */

/* A box around some of the triangles, in halves unless they are few. */
typedef struct branch {
  double low[3], high[3];
  int first, n; /* triangles */
  int right;    /* the second half; the first is the next branch. 0: a leaf */
} branch;

/* The nodes of single ones are triangles of no extent. */
typedef struct tree {
  const corot_mesh *mesh;
  int ntri;
  int (*tri)[3]; /* [ntri] */
  int nbranch;
  branch *branch; /* [2 ntri] */
} tree;

static double middle_of(const tree *t, int i, int axis) {
  const double(*x)[3] = (const double(*)[3])t->mesh->x;
  return x[t->tri[i][0]][axis] / 3 + x[t->tri[i][1]][axis] / 3 + x[t->tri[i][2]][axis] / 3;
}

static void bound(const tree *t, branch *b) {
  for (int k = 0; k < 3; k++) b->low[k] = INFINITY, b->high[k] = -INFINITY;
  for (int i = 3 * b->first; i < 3 * (b->first + b->n); i++)
    for (int k = 0; k < 3; k++) {
      double x = t->mesh->x[t->tri[i / 3][i % 3]][k];
      b->low[k] = fmin(b->low[k], x), b->high[k] = fmax(b->high[k], x);
    }
}

/* Moves the triangles on the lower side of the box's middle along its longest axis to the front;
   how many: at least one, not all. */
static int halve(tree *t, const branch *b) {
  int axis = 0, n = 0;
  for (int k = 1; k < 3; k++)
    if (b->high[k] - b->low[k] > b->high[axis] - b->low[axis]) axis = k;
  double middle = 0.5 * b->low[axis] + 0.5 * b->high[axis];
  for (int i = 0; i < b->n; i++) {
    if (!(middle_of(t, b->first + i, axis) < middle)) continue;
    int *p = t->tri[b->first + n++], *q = t->tri[b->first + i], swap[3];
    memcpy(swap, p, sizeof swap);
    memmove(p, q, sizeof swap);
    memcpy(q, swap, sizeof swap);
  }
  return n > 0 && n < b->n ? n : b->n / 2;
}

static void grow(tree *t, int first, int n) {
  int at = t->nbranch++;
  branch *b = &t->branch[at];
  *b = (branch){.first = first, .n = n};
  bound(t, b);
  if (n <= FEW) return;
  int half = halve(t, b);
  grow(t, first, half);
  t->branch[at].right = t->nbranch;
  grow(t, first + half, n - half);
}

/* Nodes, faces, and the faces of tets. */
static corot_status plant(const corot_mesh *mesh, const corot_group *g, tree *t) {
  size_t n = (size_t)g->nnode + (size_t)g->ntri + 4 * (size_t)g->ntet;
  *t = (tree){.mesh = mesh};
  COROT_TRY(COROT_ALLOC(t->tri, n));
  COROT_TRY(COROT_ALLOC(t->branch, 2 * n));
  for (int i = 0; i < g->nnode; i++)
    for (int k = 0; k < 3; k++) t->tri[i][k] = g->node[i];
  t->ntri = g->nnode;
  for (int i = 0; i < g->ntri; i++) memcpy(t->tri[t->ntri++], g->tri[i], sizeof *g->tri);
  for (int i = 0; i < 4 * g->ntet; i++, t->ntri++)
    for (int k = 0; k < 3; k++)
      t->tri[t->ntri][k] = mesh->tet[g->tet[i / 4]][corot_tet_face[i % 4][k]];
  grow(t, 0, t->ntri);
  return COROT_OK;
}

/* --- Distances --- */

static double to_segment(const double x[3], const double a[3], const double b[3]) {
  double d[3], along[3];
  subtract(x, a, d);
  subtract(b, a, along);
  double square = dot(along, along);
  double s = square > 0 ? fmax(0, fmin(1, dot(d, along) / square)) : 0;
  for (int k = 0; k < 3; k++) d[k] -= s * along[k];
  return length_of(d);
}

/* Above the inside of a triangle the height; elsewhere the distance to the nearest edge. */
static double to_triangle(const tree *t, const double x[3], const int tri[3]) {
  const double *a = t->mesh->x[tri[0]], *b = t->mesh->x[tri[1]], *c = t->mesh->x[tri[2]];
  double p[3], q[3], d[3];
  subtract(b, a, p);
  subtract(c, a, q);
  subtract(x, a, d);
  double n[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  double nn = dot(n, n);
  double dq[3] = {d[1] * q[2] - d[2] * q[1], d[2] * q[0] - d[0] * q[2], d[0] * q[1] - d[1] * q[0]};
  double pd[3] = {p[1] * d[2] - p[2] * d[1], p[2] * d[0] - p[0] * d[2], p[0] * d[1] - p[1] * d[0]};
  double along_p = dot(dq, n), along_q = dot(pd, n);
  if (nn > 0 && along_p >= 0 && along_q >= 0 && along_p + along_q <= nn)
    return fabs(dot(d, n)) / sqrt(nn);
  return fmin(to_segment(x, a, b), fmin(to_segment(x, b, c), to_segment(x, c, a)));
}

static double to_box(const branch *b, const double x[3]) {
  double d[3];
  for (int k = 0; k < 3; k++) d[k] = fmax(0, fmax(b->low[k] - x[k], x[k] - b->high[k]));
  return length_of(d);
}

/* The distance to the nearest triangle of a branch, or `best` if that is less. */
static double find_nearest(const tree *t, int at, const double x[3], double best) {
  const branch *b = &t->branch[at];
  if (!(to_box(b, x) < best)) return best;
  if (!b->right) {
    for (int i = 0; i < b->n; i++) best = fmin(best, to_triangle(t, x, t->tri[b->first + i]));
    return best;
  }
  bool left_first = to_box(b + 1, x) < to_box(&t->branch[b->right], x);
  best = find_nearest(t, left_first ? at + 1 : b->right, x, best);
  return find_nearest(t, left_first ? b->right : at + 1, x, best);
}

/* --- Groups --- */

/* Marks the corners that are near; how many. */
static int mark_near(const tree *t, double distance, char *mark, double *least) {
  const corot_mesh *mesh = t->mesh;
  int n = 0;
  *least = INFINITY;
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 4; k++) mark[mesh->tet[e][k]] = 1;
  for (int i = 0; i < mesh->nnode; i++) {
    if (!mark[i]) continue;
    double d = find_nearest(t, 0, mesh->x[i], INFINITY);
    *least = fmin(*least, d);
    n += mark[i] = d <= distance;
  }
  return n;
}

static corot_status add_near(corot_mesh *mesh, const char *name, const tree *t, const char *other,
                             double distance) {
  char *mark;
  double least;
  COROT_TRY(COROT_ALLOC(mark, mesh->nnode));
  corot_status status =
      mark_near(t, distance + corot_mesh_near(mesh), mark, &least)
          ? corot_mesh_add_marked(mesh, name, mark)
          : corot_fail(COROT_EINVAL,
                       "group '%s': no corner of a tet is within %g of group '%s'; the nearest is "
                       "%g away",
                       name, distance, other, least);
  free(mark);
  return status;
}

corot_status corot_mesh_group_near(corot_mesh *mesh, const char *name, const char *other,
                                   double distance) {
  tree t;
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(other));
  if (!(distance >= 0 && isfinite(distance)))
    return corot_fail(COROT_EINVAL, "group '%s': the distance is %g, not >= 0 and finite", name,
                      distance);
  const corot_group *g = corot_mesh_find_group(mesh, other);
  if (!g) return corot_fail(COROT_EINVAL, "group '%s': there is no group '%s'", name, other);
  corot_status status = plant(mesh, g, &t);
  if (!status) status = add_near(mesh, name, &t, other, distance);
  free(t.tri);
  free(t.branch);
  return status;
}
