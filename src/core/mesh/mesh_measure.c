/* Size and shape. */
#include "mesh.h"

#include <math.h>

static const double degree = 0.017453292519943295;

static void sub(const double a[3], const double b[3], double c[3]) {
  for (int i = 0; i < 3; i++) c[i] = a[i] - b[i];
}

static void cross(const double a[3], const double b[3], double c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double norm(const double a[3]) { return sqrt(dot(a, a)); }

void corot_mesh_bounds(const corot_mesh *mesh, double min[3], double max[3]) {
  for (int k = 0; k < 3; k++) min[k] = max[k] = mesh->x[0][k];
  for (int i = 1; i < mesh->nnode; i++)
    for (int k = 0; k < 3; k++) {
      min[k] = fmin(min[k], mesh->x[i][k]);
      max[k] = fmax(max[k], mesh->x[i][k]);
    }
}

int corot_mesh_nearest(const corot_mesh *mesh, const double point[3]) {
  int nearest = 0;
  double least = INFINITY;
  for (int i = 0; i < mesh->nnode; i++) {
    double d[3];
    sub(mesh->x[i], point, d);
    if (norm(d) < least) {
      least = norm(d);
      nearest = i;
    }
  }
  return nearest;
}

static void measure_edges(const double *const x[4], corot_mesh_quality *q) {
  for (int k = 1; k < 4; k++)
    for (int j = 0; j < k; j++) {
      double d[3];
      sub(x[k], x[j], d);
      q->edge_min = fmin(q->edge_min, norm(d));
      q->edge_max = fmax(q->edge_max, norm(d));
    }
}

/* The angle between two faces is pi minus that between their outward normals. */
static void measure_dihedrals(const double normal[4][3], corot_mesh_quality *q) {
  for (int k = 1; k < 4; k++)
    for (int j = 0; j < k; j++) {
      double c[3];
      cross(normal[j], normal[k], c);
      double angle = atan2(norm(c), -dot(normal[j], normal[k])) / degree;
      q->dihedral_min = fmin(q->dihedral_min, angle);
      q->dihedral_max = fmax(q->dihedral_max, angle);
    }
}

/* 3 r / R with inradius r = 3 V / A and circumradius
   R = |a^2 (b x c) + b^2 (c x a) + c^2 (a x b)| / (12 V), a, b, c the edges from one corner. */
static double shape(const double *const x[4], const double normal[4][3], double volume) {
  double a[3], b[3], c[3], bc[3], ca[3], ab[3], s[3], area = 0;
  for (int k = 0; k < 4; k++) area += norm(normal[k]) / 2;
  sub(x[1], x[0], a);
  sub(x[2], x[0], b);
  sub(x[3], x[0], c);
  cross(b, c, bc);
  cross(c, a, ca);
  cross(a, b, ab);
  for (int i = 0; i < 3; i++) s[i] = dot(a, a) * bc[i] + dot(b, b) * ca[i] + dot(c, c) * ab[i];
  return 3 * (3 * volume / area) / (norm(s) / (12 * volume));
}

/* The outward normals of a tet, of length twice the area. */
static void face_normals(const double *const x[4], double normal[4][3]) {
  for (int k = 0; k < 4; k++) {
    const int *f = corot_tet_face[k];
    double a[3], b[3];
    sub(x[f[1]], x[f[0]], a);
    sub(x[f[2]], x[f[0]], b);
    cross(a, b, normal[k]);
  }
}

static void measure_tet(const corot_mesh *mesh, int e, corot_mesh_quality *q) {
  const int *v = mesh->tet[e];
  const double *const x[4] = {mesh->x[v[0]], mesh->x[v[1]], mesh->x[v[2]], mesh->x[v[3]]};
  double flat = corot_tet_volume((const double(*)[3])mesh->x, v), normal[4][3];
  double volume = corot_mesh_volume_of(mesh, e);
  face_normals(x, normal);
  q->volume += volume;
  q->volume_min = fmin(q->volume_min, volume);
  q->volume_max = fmax(q->volume_max, volume);
  measure_edges(x, q);
  measure_dihedrals((const double(*)[3])normal, q);
  double s = shape(x, (const double(*)[3])normal, flat);
  q->shape_mean += s / mesh->ntet;
  if (s < q->shape_min) {
    q->shape_min = s;
    q->shape_worst = e;
  }
}

double corot_mesh_shape(const corot_mesh *mesh, int e) {
  const int *v = mesh->tet[e];
  const double *const x[4] = {mesh->x[v[0]], mesh->x[v[1]], mesh->x[v[2]], mesh->x[v[3]]};
  double normal[4][3];
  face_normals(x, normal);
  return shape(x, (const double(*)[3])normal, corot_tet_volume((const double(*)[3])mesh->x, v));
}

corot_mesh_quality corot_mesh_measure(const corot_mesh *mesh) {
  corot_mesh_quality q = {.volume_min = INFINITY,
                          .edge_min = INFINITY,
                          .dihedral_min = INFINITY,
                          .shape_min = INFINITY};
  corot_mesh_bounds(mesh, q.min, q.max);
  for (int e = 0; e < mesh->ntet; e++) measure_tet(mesh, e, &q);
  return q;
}
