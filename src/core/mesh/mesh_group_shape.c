/* Named groups of the nodes in a shape: a box, a plane, a sphere, a cylinder, a half-space. */
#include <float.h>
#include <math.h>

#include "mesh.h"

/* What the nodes are to be in. */
typedef struct shape {
  double (*outside)(const struct shape *s, const double x[3]); /* how far x is outside [m]; inside:
                                                                  0 or less */
  double low[3], high[3];                                      /* of a box */
  double point[3], axis[3]; /* of the others; the axis is of length one */
  double length, radius;    /* [m] */
} shape;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double length_of(const double a[3]) { return hypot(hypot(a[0], a[1]), a[2]); }

/* --- Shapes --- */

/* Along the axis of which it is the most. */
static double outside_box(const shape *s, const double x[3]) {
  double most = -INFINITY;
  for (int k = 0; k < 3; k++) most = fmax(most, fmax(s->low[k] - x[k], x[k] - s->high[k]));
  return most;
}

static double outside_sphere(const shape *s, const double x[3]) {
  double d[3] = {x[0] - s->point[0], x[1] - s->point[1], x[2] - s->point[2]};
  return length_of(d) - s->radius;
}

static double outside_cylinder(const shape *s, const double x[3]) {
  double d[3] = {x[0] - s->point[0], x[1] - s->point[1], x[2] - s->point[2]};
  double along = dot(d, s->axis);
  for (int k = 0; k < 3; k++) d[k] -= along * s->axis[k];
  double side = length_of(d) - s->radius, end = fmax(-along, along - s->length);
  return side > 0 && end > 0 ? hypot(side, end) : fmax(side, end);
}

static double outside_half_space(const shape *s, const double x[3]) {
  double d[3] = {x[0] - s->point[0], x[1] - s->point[1], x[2] - s->point[2]};
  return -dot(d, s->axis);
}

/* --- Selection --- */

/* Marks the corners that are at most `tol` outside; *nearest of those that are not. */
static int mark_shape(const corot_mesh *mesh, const shape *s, double tol, char *mark, int *nearest,
                      double *distance) {
  int n = 0;
  *distance = INFINITY;
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 4; k++) mark[mesh->tet[e][k]] = 1;
  for (int i = 0; i < mesh->nnode; i++) {
    if (!mark[i]) continue;
    double d = s->outside(s, mesh->x[i]);
    mark[i] = d <= tol;
    n += mark[i];
    if (!mark[i] && d < *distance) *distance = d, *nearest = i;
  }
  return n;
}

static corot_status no_nodes(const corot_mesh *mesh, const char *name, double tol, int nearest,
                             double distance) {
  double lo[3], hi[3];
  const double *x = mesh->x[nearest];
  corot_mesh_bounds(mesh, lo, hi);
  return corot_fail(COROT_EINVAL,
                    "group '%s': no %s is there (tolerance %g): the nearest is node %d at (%g, %g, "
                    "%g), %g outside; the mesh fills [%g, %g] x [%g, %g] x [%g, %g]",
                    name, mesh->mid ? "corner of a tet" : "node", tol, nearest, x[0], x[1], x[2],
                    distance, lo[0], hi[0], lo[1], hi[1], lo[2], hi[2]);
}

double corot_mesh_near(const corot_mesh *mesh) {
  double lo[3], hi[3];
  corot_mesh_bounds(mesh, lo, hi);
  return 1e-6 * sqrt(pow(hi[0] - lo[0], 2) + pow(hi[1] - lo[1], 2) + pow(hi[2] - lo[2], 2));
}

static corot_status add_shape(corot_mesh *mesh, const char *name, const shape *s, double tol) {
  char *mark;
  int nearest = 0;
  double distance;
  if (!(tol >= 0))
    return corot_fail(COROT_EINVAL, "group '%s': the tolerance is %g, not >= 0", name, tol);
  if (tol == 0) tol = corot_mesh_near(mesh);
  COROT_TRY(COROT_ALLOC(mark, mesh->nnode));
  corot_status status = mark_shape(mesh, s, tol, mark, &nearest, &distance)
                            ? corot_mesh_add_marked(mesh, name, mark)
                            : no_nodes(mesh, name, tol, nearest, distance);
  free(mark);
  return status;
}

/* --- Arguments --- */

static corot_status check_point(const char *name, const char *what, const double x[3]) {
  for (int k = 0; k < 3; k++)
    if (!isfinite(x[k]))
      return corot_fail(COROT_EINVAL, "group '%s': component %d of the %s is not finite", name, k,
                        what);
  return COROT_OK;
}

static corot_status check_radius(const char *name, double radius) {
  if (radius > 0 && isfinite(radius)) return COROT_OK;
  return corot_fail(COROT_EINVAL, "group '%s': the radius is %g, not > 0 and finite", name, radius);
}

corot_status corot_mesh_unit(const char *name, const char *what, const double along[3],
                             double unit[3]) {
  COROT_TRY(check_point(name, what, along));
  double size = length_of(along);
  if (!(size > DBL_MIN && isfinite(size)))
    return corot_fail(COROT_EINVAL, "group '%s': the %s has the length %g, and no direction", name,
                      what, size);
  for (int k = 0; k < 3; k++) unit[k] = along[k] / size;
  return COROT_OK;
}

/* --- Groups --- */

corot_status corot_mesh_group_box(corot_mesh *mesh, const char *name, const double min[3],
                                  const double max[3], double tol) {
  shape s = {.outside = outside_box};
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(min));
  COROT_TRY(COROT_GIVEN(max));
  if (!(tol >= 0))
    return corot_fail(COROT_EINVAL, "group '%s': the tolerance is %g, not >= 0", name, tol);
  for (int k = 0; k < 3; k++) {
    if (!(min[k] <= max[k]))
      return corot_fail(COROT_EINVAL, "group '%s': min is %g and max is %g along %c", name, min[k],
                        max[k], "xyz"[k]);
    s.low[k] = min[k], s.high[k] = max[k];
  }
  return add_shape(mesh, name, &s, tol);
}

corot_status corot_mesh_group_plane(corot_mesh *mesh, const char *name, int axis, double at,
                                    double tol) {
  double min[3] = {-INFINITY, -INFINITY, -INFINITY}, max[3] = {INFINITY, INFINITY, INFINITY};
  if (axis < 0 || axis > 2)
    return corot_fail(COROT_EINVAL, "group '%s': axis is %d, not 0, 1 or 2", name, axis);
  min[axis] = max[axis] = at;
  return corot_mesh_group_box(mesh, name, min, max, tol);
}

corot_status corot_mesh_group_sphere(corot_mesh *mesh, const char *name, const double center[3],
                                     double radius, double tol) {
  shape s = {.outside = outside_sphere, .radius = radius};
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(center));
  COROT_TRY(check_point(name, "center", center));
  COROT_TRY(check_radius(name, radius));
  for (int k = 0; k < 3; k++) s.point[k] = center[k];
  return add_shape(mesh, name, &s, tol);
}

corot_status corot_mesh_group_cylinder(corot_mesh *mesh, const char *name, const double from[3],
                                       const double to[3], double radius, double tol) {
  shape s = {.outside = outside_cylinder, .radius = radius};
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(from));
  COROT_TRY(COROT_GIVEN(to));
  COROT_TRY(check_point(name, "axis's first end", from));
  COROT_TRY(check_point(name, "axis's last end", to));
  COROT_TRY(check_radius(name, radius));
  double along[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  COROT_TRY(corot_mesh_unit(name, "axis", along, s.axis));
  for (int k = 0; k < 3; k++) s.point[k] = from[k];
  s.length = length_of(along);
  return add_shape(mesh, name, &s, tol);
}

corot_status corot_mesh_group_half_space(corot_mesh *mesh, const char *name, const double point[3],
                                         const double normal[3], double tol) {
  shape s = {.outside = outside_half_space};
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(point));
  COROT_TRY(COROT_GIVEN(normal));
  COROT_TRY(check_point(name, "point", point));
  COROT_TRY(corot_mesh_unit(name, "normal", normal, s.axis));
  for (int k = 0; k < 3; k++) s.point[k] = point[k];
  return add_shape(mesh, name, &s, tol);
}
