/* Groups by shape, by what is around, and made of others: each held against the definition, applied
   to all nodes or faces. */
#include <corot/mesh.h>
#include <stdbool.h>

#include "alloc.h"
#include "check.h"

static corot_mesh *make_box(int order) {
  const corot_box box = {.size = {1, 1, 1}, .cells = {4, 4, 4}, .split = COROT_BOX_SYMMETRIC};
  corot_mesh *mesh, *raised;
  assert_ok(corot_mesh_box(&box, &mesh));
  if (order == 1) return mesh;
  assert_ok(corot_mesh_change_order(mesh, 2, &raised));
  corot_mesh_destroy(mesh);
  return raised;
}

static const corot_group *find(const corot_mesh *m, const char *name) {
  const corot_group *g = corot_mesh_find_group(m, name);
  assert_non_null(g);
  return g;
}

/* --- Shapes --- */

static double distance(const double a[3], const double b[3]) {
  return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

static const double center[3] = {0.1, 0.2, 0.3};

static bool in_sphere(const double x[3]) { return distance(x, center) <= 0.46; }

static bool in_half_space(const double x[3]) {
  return (x[0] - 0.1) + 2 * (x[1] - 0.2) - (x[2] - 0.3) >= 0;
}

/* About the axis from (0.5, 0.5, 0.2) to (0.5, 0.5, 0.8). */
static bool in_cylinder(const double x[3]) {
  return hypot(x[0] - 0.5, x[1] - 0.5) <= 0.3 && x[2] >= 0.2 && x[2] <= 0.8;
}

/* The corners are those in the shape, faces and tets those that have only such. */
static void assert_selects(const corot_mesh *m, const char *name, bool (*in)(const double x[3])) {
  const corot_group *g = find(m, name);
  char *corner = calloc((size_t)m->nnode, 1), *mine = calloc((size_t)m->nnode, 1);
  int n = 0, ntet = 0, ntri, (*tri)[3], nface = 0;
  for (int e = 0; e < m->ntet; e++) {
    int inside = 0;
    for (int k = 0; k < 4; k++) corner[m->tet[e][k]] = 1, inside += in(m->x[m->tet[e][k]]);
    ntet += inside == 4;
  }
  for (int i = 0; i < g->nnode; i++) mine[g->node[i]] = 1;
  for (int i = 0; i < m->nnode; i++)
    if (corner[i]) assert_int_equal(mine[i], in(m->x[i])), n += mine[i];
  assert_true(n > 3 && n < m->nnode);
  assert_ok(corot_mesh_boundary(m, &ntri, &tri));
  for (int i = 0; i < ntri; i++)
    nface += in(m->x[tri[i][0]]) && in(m->x[tri[i][1]]) && in(m->x[tri[i][2]]);
  assert_int_equal(g->ntri, nface);
  assert_int_equal(g->ntet, ntet);
  free(tri), free(corner), free(mine);
}

static void shapes_select_what_is_in_them(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    corot_mesh *m = make_box(order);
    assert_ok(corot_mesh_group_sphere(m, "ball", center, 0.46, 0));
    assert_ok(corot_mesh_group_half_space(m, "half", center, (double[]){0.5, 1, -0.5}, 0));
    assert_ok(corot_mesh_group_cylinder(m, "bore", (double[]){0.5, 0.5, 0.2},
                                        (double[]){0.5, 0.5, 0.8}, 0.3, 0));
    assert_ok(corot_mesh_group_cylinder(m, "back", (double[]){0.5, 0.5, 0.8},
                                        (double[]){0.5, 0.5, 0.2}, 0.3, 0));
    assert_selects(m, "ball", in_sphere);
    assert_selects(m, "half", in_half_space);
    assert_selects(m, "bore", in_cylinder);
    assert_selects(m, "back", in_cylinder);
    if (order == 2) assert_true(find(m, "ball")->nnode > 40); /* nodes on edges, too */
    corot_mesh_destroy(m);
  }
}

/* Nodes on the surface are in, whatever rounding does: at distances of 3/4 and sqrt(3)/4. */
static void surfaces_belong_to_their_shapes(void **state) {
  (void)state;
  corot_mesh *m = make_box(1);
  assert_ok(corot_mesh_group_sphere(m, "ball", (double[]){0, 0, 0}, sqrt(3) / 4, 0));
  assert_int_equal(find(m, "ball")->nnode, 1 + 3 + 3 + 1);
  assert_ok(corot_mesh_group_half_space(m, "edge", (double[]){1, 1, 0.3}, (double[]){3, 3, 0}, 0));
  assert_int_equal(find(m, "edge")->nnode, 5);
  assert_ok(
      corot_mesh_group_cylinder(m, "axis", (double[]){0, 0, 0}, (double[]){1, 1, 1}, 1e-9, 0));
  assert_int_equal(find(m, "axis")->nnode, 5);
  /* a tolerance reaches further: past the round side, past an end, and not past their rim */
  const double from[] = {0, 0, 0}, to[] = {0, 0, 0.5};
  assert_ok(corot_mesh_group_cylinder(m, "wide", from, to, 0.05, 0.21));
  assert_int_equal(find(m, "wide")->nnode, 3 + 2 * 3);
  assert_ok(corot_mesh_group_cylinder(m, "wider", from, to, 0.05, 0.26));
  assert_int_equal(find(m, "wider")->nnode, 4 + 2 * 3);
  corot_mesh_destroy(m);
}

/* --- Normals --- */

static void normals_find_sides(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    corot_mesh *m = make_box(order);
    assert_ok(corot_mesh_group_normal(m, "top", (double[]){0, 0, 7}, 0));
    const corot_group *top = find(m, "top"), *side = find(m, "zmax");
    assert_int_equal(top->ntri, side->ntri);
    assert_int_equal(top->ntet, 0);
    assert_int_equal(top->nnode, side->nnode);
    assert_memory_equal(top->node, side->node, (size_t)side->nnode * sizeof *side->node);
    int n = side->ntri;
    /* the diagonal of space is acos(1/sqrt 3) = 0.9553 away from three of the sides */
    assert_ok(corot_mesh_group_normal(m, "three", (double[]){1, 1, 1}, 0.956));
    assert_int_equal(find(m, "three")->ntri, 3 * n);
    assert_ok(corot_mesh_group_normal(m, "all", (double[]){1, 1, 1}, acos(-1)));
    assert_int_equal(find(m, "all")->ntri, 6 * n);
    assert_fails(corot_mesh_group_normal(m, "none", (double[]){1, 1, 1}, 0.955), COROT_EINVAL,
                 "group 'none': no face of the boundary has its normal within 0.955 rad of "
                 "(0.57735, 0.57735, 0.57735); the nearest is 0.955317 rad away");
    corot_mesh_destroy(m);
  }
}

/* --- Nearness --- */

/* Of a side all nodes within a distance are those between two planes; of a node those of a sphere.
 */
static void near_is_a_distance_to_nodes_and_faces(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    corot_mesh *m = make_box(order);
    assert_ok(corot_mesh_group_near(m, "layer", "zmax", 0.25));
    assert_ok(corot_mesh_group_box(m, "box", (double[]){0, 0, 0.75}, (double[]){1, 1, 1}, 0));
    assert_int_equal(find(m, "layer")->nnode, find(m, "box")->nnode);
    assert_int_equal(find(m, "layer")->ntri, find(m, "box")->ntri);
    assert_int_equal(find(m, "layer")->ntet, find(m, "box")->ntet);
    assert_ok(corot_mesh_group_nodes(m, "corner", 1, (int[]){0}));
    assert_ok(corot_mesh_group_near(m, "around", "corner", sqrt(3) / 4));
    assert_ok(corot_mesh_group_sphere(m, "ball", m->x[0], sqrt(3) / 4, 0));
    assert_int_equal(find(m, "around")->nnode, find(m, "ball")->nnode);
    corot_mesh_destroy(m);
  }
}

/* One large triangle: a node above its middle is nearer to it than to any of its corners; so of the
   inside of the faces of tets. */
static void near_sees_the_inside_of_faces(void **state) {
  (void)state;
  corot_mesh *m;
  /* a second tet, whose first node hangs 0.1 below the first tet's lower face */
  static const double y[][3] = {{0, 0, 0},    {3, 0, 0},  {0, 3, 0},  {0, 0, 3},
                                {1, 1, -0.1}, {1, 1, -9}, {2, 1, -9}, {1, 2, -9}};
  static const int two[][4] = {{0, 1, 2, 3}, {4, 6, 5, 7}};
  assert_ok(corot_mesh_create(8, y, 2, two, &m));
  assert_ok(corot_mesh_group_triangles(m, "face", 1, (const int[][3]){{0, 1, 2}}));
  assert_ok(corot_mesh_group_tets(m, "tet", 1, (int[]){0}));
  assert_ok(corot_mesh_group_near(m, "below", "face", 0.11));
  assert_int_equal(find(m, "below")->nnode, 4);
  assert_ok(corot_mesh_group_near(m, "outside", "tet", 0.11));
  assert_int_equal(find(m, "outside")->nnode, 5);
  assert_ok(corot_mesh_group_near(m, "not yet", "face", 0.09));
  assert_int_equal(find(m, "not yet")->nnode, 3);
  corot_mesh_destroy(m);
}

/* --- Sets --- */

static void combine(corot_mesh *m, const char *name, corot_set_operation operation, const char *a,
                    const char *b, const char *c) {
  assert_ok(corot_mesh_group_combine(m, name, operation, c ? 3 : 2, (const char *[]){a, b, c}));
}

static void assert_sizes(const corot_mesh *m, const char *name, int nnode, int ntri, int ntet) {
  const corot_group *g = find(m, name);
  assert_int_equal(g->nnode, nnode);
  assert_int_equal(g->ntri, ntri);
  assert_int_equal(g->ntet, ntet);
}

static void sets_of_nodes_faces_and_tets(void **state) {
  (void)state;
  corot_mesh *m = make_box(1);
  const double low[3] = {0, 0, 0}, half[3] = {1, 1, 0.5}, high[3] = {1, 1, 1};
  assert_ok(corot_mesh_group_box(m, "all", low, high, 0));
  assert_ok(corot_mesh_group_box(m, "lower", low, half, 0));
  assert_sizes(m, "all", 125, 6 * 32, 384);
  assert_sizes(m, "lower", 75, 32 + 4 * 16, 192);
  combine(m, "upper", COROT_DIFFERENCE, "all", "lower", NULL);
  assert_sizes(m, "upper", 50, 32 + 4 * 16, 192); /* the faces beside the cut stay */
  combine(m, "again", COROT_UNION, "upper", "lower", NULL);
  assert_sizes(m, "again", 125, 6 * 32, 384);
  combine(m, "both", COROT_INTERSECTION, "all", "lower", "zmin");
  assert_sizes(m, "both", 25, 32, 0);
  combine(m, "edge", COROT_INTERSECTION, "xmin", "zmin", NULL);
  assert_sizes(m, "edge", 5, 0, 0);
  combine(m, "corner", COROT_INTERSECTION, "xmin", "zmin", "ymax");
  assert_sizes(m, "corner", 1, 0, 0);
  combine(m, "ring", COROT_DIFFERENCE, "zmax", "xmin", "xmax");
  assert_sizes(m, "ring", 15, 32, 0);
  combine(m, "sides", COROT_UNION, "zmax", "xmin", "zmax");
  assert_sizes(m, "sides", 45, 64, 0);
  /* faces wind as in the first, and nodes ascend */
  const corot_group *g = find(m, "sides"), *top = find(m, "zmax");
  assert_memory_equal(g->tri, top->tri, 32 * sizeof *top->tri);
  for (int i = 1; i < g->nnode; i++) assert_true(g->node[i - 1] < g->node[i]);
  corot_mesh_destroy(m);
}

/* A face is the same whichever way it winds and wherever it begins. */
static void faces_are_the_same_in_any_order_of_nodes(void **state) {
  (void)state;
  corot_mesh *m = make_box(1);
  const int *t = m->tet[100];
  assert_ok(corot_mesh_group_triangles(m, "one", 1, (const int[][3]){{t[0], t[1], t[2]}}));
  assert_ok(corot_mesh_group_triangles(m, "other", 1, (const int[][3]){{t[2], t[1], t[0]}}));
  combine(m, "both", COROT_INTERSECTION, "one", "other", NULL);
  combine(m, "either", COROT_UNION, "one", "other", NULL);
  assert_sizes(m, "both", 3, 1, 0);
  assert_sizes(m, "either", 3, 1, 0);
  corot_mesh_destroy(m);
}

/* --- Refusals --- */

static void what_is_empty_is_refused_with_what_is_near(void **state) {
  (void)state;
  corot_mesh *m = make_box(1);
  int before = m->ngroup;
  assert_fails(
      corot_mesh_group_sphere(m, "a", (double[]){1, 1, 3}, 0.5, 0), COROT_EINVAL,
      "group 'a': no node is there (tolerance 1.73205e-06): the nearest is node 124 at (1, "
      "1, 1), 1.5 outside; the mesh fills [0, 1] x [0, 1] x [0, 1]");
  assert_fails(
      corot_mesh_group_cylinder(m, "a", (double[]){0, 0, 4}, (double[]){0, 0, 3}, 0.1, 0.5),
      COROT_EINVAL, "the nearest is node 100 at (0, 0, 1), 2 outside");
  assert_fails(corot_mesh_group_half_space(m, "a", (double[]){0, 0, 2}, (double[]){0, 0, 1e-3}, 0),
               COROT_EINVAL, "at (0, 0, 1), 1 outside");
  assert_fails(corot_mesh_group_plane(m, "a", 0, 0.55, 0), COROT_EINVAL, "0.05 outside");
  assert_fails(
      corot_mesh_group_combine(m, "a", COROT_INTERSECTION, 2, (const char *[]){"xmin", "xmax"}),
      COROT_EINVAL, "group 'a' has no nodes: none of the 25 of group 'xmin' is in group 'xmax'");
  assert_fails(
      corot_mesh_group_combine(m, "a", COROT_DIFFERENCE, 2, (const char *[]){"xmin", "xmin"}),
      COROT_EINVAL, "each of the 25 of group 'xmin' is in group 'xmin'");
  assert_fails(corot_mesh_group_combine(m, "a", COROT_DIFFERENCE, 3,
                                        (const char *[]){"xmin", "zmin", "xmin"}),
               COROT_EINVAL, "each of the 25 of group 'xmin' is in one of the others");
  assert_int_equal(m->ngroup, before);
  corot_mesh_destroy(m);
}

static void what_makes_no_sense_is_refused(void **state) {
  (void)state;
  corot_mesh *m = make_box(1);
  const double o[3] = {0, 0, 0}, e[3] = {0, 0, 1}, far[3] = {0, INFINITY, 0};
  const char *const none[] = {"xmin", "wing"}, *const null[] = {"xmin", NULL};
  assert_fails(corot_mesh_group_sphere(m, "a", o, 0, 0), COROT_EINVAL, "the radius is 0");
  assert_fails(corot_mesh_group_sphere(m, "a", o, NAN, 0), COROT_EINVAL, "the radius is nan");
  assert_fails(corot_mesh_group_sphere(m, "a", o, INFINITY, 0), COROT_EINVAL, "the radius is inf");
  assert_fails(corot_mesh_group_sphere(m, "a", far, 1, 0), COROT_EINVAL,
               "component 1 of the center");
  assert_fails(corot_mesh_group_sphere(m, "a", o, 1, -1), COROT_EINVAL, "the tolerance is -1");
  assert_fails(corot_mesh_group_sphere(m, "zmin", o, 1, 0), COROT_EINVAL, "exists already");
  assert_fails(corot_mesh_group_cylinder(m, "a", o, o, 1, 0), COROT_EINVAL,
               "axis has the length 0");
  assert_fails(corot_mesh_group_cylinder(m, "a", far, o, 1, 0), COROT_EINVAL, "axis's first end");
  assert_fails(corot_mesh_group_cylinder(m, "a", o, far, 1, 0), COROT_EINVAL, "axis's last end");
  assert_fails(corot_mesh_group_half_space(m, "a", o, o, 0), COROT_EINVAL,
               "normal has the length 0");
  assert_fails(corot_mesh_group_half_space(m, "a", far, e, 0), COROT_EINVAL, "1 of the point");
  assert_fails(corot_mesh_group_normal(m, "a", far, 1), COROT_EINVAL, "1 of the direction");
  assert_fails(corot_mesh_group_normal(m, "a", e, -1), COROT_EINVAL, "the angle is -1 rad");
  assert_fails(corot_mesh_group_normal(m, "a", e, NAN), COROT_EINVAL, "the angle is nan");
  assert_fails(corot_mesh_group_near(m, "a", "zmin", -1), COROT_EINVAL, "the distance is -1");
  assert_fails(corot_mesh_group_near(m, "a", "wing", 1), COROT_EINVAL, "no group 'wing'");
  assert_fails(corot_mesh_group_combine(m, "a", COROT_UNION, 2, none), COROT_EINVAL,
               "no group 'wing'");
  assert_fails(corot_mesh_group_combine(m, "a", COROT_UNION, 2, null), COROT_EINVAL,
               "name 1 is NULL");
  assert_fails(corot_mesh_group_combine(m, "a", COROT_INTERSECTION, 1, none), COROT_EINVAL,
               "an intersection takes two groups or more, not 1");
  assert_fails(corot_mesh_group_combine(m, "a", (corot_set_operation)3, 2, none), COROT_EINVAL,
               "no operation 3");
  assert_int_equal(m->ngroup, 6);
  corot_mesh_destroy(m);
}

static corot_status try_all(void *context) {
  corot_mesh *m;
  COROT_TRY(corot_mesh_copy(context, &m));
  corot_status status = corot_mesh_group_sphere(m, "ball", center, 0.46, 0);
  if (!status) status = corot_mesh_group_normal(m, "top", (double[]){0, 0, 1}, 0.1);
  if (!status) status = corot_mesh_group_near(m, "near", "top", 0.3);
  for (int k = 0; !status && k < 3; k++)
    status = corot_mesh_group_combine(m, (const char *[]){"u", "i", "d"}[k], (corot_set_operation)k,
                                      2, (const char *[]){"near", "top"});
  corot_mesh_destroy(m);
  return status;
}

static void failed_allocations_leave_nothing(void **state) {
  (void)state;
  corot_mesh *m = make_box(2);
  assert_true(assert_survives_failed_allocations(try_all, m) >= 50);
  corot_mesh_destroy(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_select_what_is_in_them),
      cmocka_unit_test(surfaces_belong_to_their_shapes),
      cmocka_unit_test(normals_find_sides),
      cmocka_unit_test(near_is_a_distance_to_nodes_and_faces),
      cmocka_unit_test(near_sees_the_inside_of_faces),
      cmocka_unit_test(sets_of_nodes_faces_and_tets),
      cmocka_unit_test(faces_are_the_same_in_any_order_of_nodes),
      cmocka_unit_test(what_is_empty_is_refused_with_what_is_near),
      cmocka_unit_test(what_makes_no_sense_is_refused),
      cmocka_unit_test(failed_allocations_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
