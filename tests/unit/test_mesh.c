/* Meshes made by hand and generated: soundness, boundary, groups, measures, writing. */
#include <corot/mesh.h>
#include <limits.h>
#include <signal.h>
#include <sys/resource.h>

#include "alloc.h"
#include "check.h"
#include "temporary.h"

/* Two tets on either side of the face 1 2 3. */
static const double two_x[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
static const int two_tet[2][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}};

static corot_mesh *make_box(int nx, int ny, int nz) {
  const corot_box box = {{1, 2, 3}, {nx, ny, nz}, {-1, 0, 5}, COROT_BOX_KUHN};
  corot_mesh *mesh = NULL;
  assert_ok(corot_mesh_box(&box, &mesh));
  return mesh;
}

static void create_copies(void **state) {
  (void)state;
  corot_mesh *m;
  assert_ok(corot_mesh_create(5, two_x, 2, two_tet, &m));
  assert_int_equal(m->nnode, 5);
  assert_int_equal(m->ntet, 2);
  assert_int_equal(m->ngroup, 0);
  assert_memory_equal(m->x, two_x, sizeof two_x);
  assert_memory_equal(m->tet, two_tet, sizeof two_tet);
  corot_mesh_destroy(m);
  corot_mesh_destroy(NULL);
}

/* The message for two_x and two_tet with one coordinate or one node changed. */
static void assert_unsound(int node, double x, int tet, int k, int v, const char *message) {
  double xs[5][3];
  int tets[2][4];
  corot_mesh *m = NULL;
  memcpy(xs, two_x, sizeof xs);
  memcpy(tets, two_tet, sizeof tets);
  if (node >= 0) xs[node][2] = x;
  if (tet >= 0) tets[tet][k] = v;
  assert_fails(corot_mesh_create(5, (const double(*)[3])xs, 2, (const int(*)[4])tets, &m),
               COROT_EINVAL, message);
  assert_null(m);
}

static void unsound_meshes_are_refused_by_name(void **state) {
  (void)state;
  assert_unsound(2, NAN, -1, 0, 0, "node 2: z is nan");
  assert_unsound(2, -INFINITY, -1, 0, 0, "node 2: z is -inf");
  assert_unsound(2, 1e200, -1, 0, 0, "node 2: z is 1e+200");
  assert_unsound(-1, 0, 1, 3, 5, "tet 1: node 5 does not exist, the last is 4");
  assert_unsound(-1, 0, 1, 3, -1, "tet 1: node -1 does not exist");
  assert_unsound(-1, 0, 1, 3, 2, "tet 1 has node 2 twice");
  assert_unsound(3, -1, -1, 0, 0, "tet 0 is inverted: its volume is -0.16");
  assert_unsound(3, 0, -1, 0, 0, "tet 0 is flat: its volume is 0");
  assert_unsound(3, 1e-13, -1, 0, 0, "tet 0 is flat: its volume is 1.66667e-14");
  assert_unsound(-1, 0, 1, 3, 0, "tet 1 is inverted");
}

static void bad_counts_are_refused(void **state) {
  (void)state;
  corot_mesh *m;
  assert_fails(corot_mesh_create(0, two_x, 1, two_tet, &m), COROT_EINVAL,
               "tet 0: node 0 does not exist");
  assert_fails(corot_mesh_create(5, two_x, -1, two_tet, &m), COROT_EINVAL, "5 nodes and -1 tets");
  assert_fails(corot_mesh_create(5, two_x, INT_MAX / 4 + 1, two_tet, &m), COROT_EINVAL,
               "too many: at most");
  assert_fails(corot_mesh_create(INT_MAX / 3 + 1, two_x, 1, two_tet, &m), COROT_EINVAL,
               "too many: at most");
}

static void faults_of_connection_are_refused(void **state) {
  (void)state;
  const double x[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {2, 2, 2}};
  const double y[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, -1, -1}};
  const int repeated[3][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}, {2, 0, 1, 3}};
  const int three[3][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}, {1, 2, 3, 5}};
  const int overlap[2][4] = {{0, 1, 2, 3}, {4, 1, 2, 3}};
  corot_mesh *m;
  assert_fails(corot_mesh_create(6, x, 2, two_tet, &m), COROT_EINVAL, "node 5 is in no tet");
  assert_fails(corot_mesh_create(5, x, 3, repeated, &m), COROT_EINVAL,
               "tets 0 and 2 have the same nodes");
  assert_fails(corot_mesh_create(6, x, 3, three, &m), COROT_EINVAL,
               "tets 0, 1 and 2 share the face 1 2 3");
  assert_fails(corot_mesh_create(5, y, 2, overlap, &m), COROT_EINVAL,
               "tets 0 and 1 overlap: they are on the same side of the face 1 2 3");
}

static double area_vector(const corot_mesh *m, int ntri, int (*tri)[3], double sum[3]) {
  double area = 0;
  for (int k = 0; k < 3; k++) sum[k] = 0;
  for (int t = 0; t < ntri; t++) {
    double a[3], b[3], n[3];
    for (int k = 0; k < 3; k++) {
      a[k] = m->x[tri[t][1]][k] - m->x[tri[t][0]][k];
      b[k] = m->x[tri[t][2]][k] - m->x[tri[t][0]][k];
    }
    for (int k = 0; k < 3; k++)
      n[k] = (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]) / 2;
    for (int k = 0; k < 3; k++) sum[k] += n[k];
    area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  }
  return area;
}

static void boundary_is_closed_and_winds_outward(void **state) {
  (void)state;
  corot_mesh *m = make_box(2, 3, 4);
  int ntri, (*tri)[3];
  assert_ok(corot_mesh_boundary(m, &ntri, &tri));
  assert_int_equal(ntri, 2 * 2 * (2 * 3 + 3 * 4 + 4 * 2));
  double sum[3], volume = 0;
  assert_close(area_vector(m, ntri, tri, sum), 2 * (2 + 6 + 3), 1e-14, 0);
  for (int k = 0; k < 3; k++) assert_close(sum[k], 0, 0, 1e-14);
  for (int t = 0; t < ntri; t++) { /* the divergence theorem: 6 V = sum x0 . (x1 x x2) */
    const double *a = m->x[tri[t][0]], *b = m->x[tri[t][1]], *c = m->x[tri[t][2]];
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0])) /
              6;
  }
  assert_close(volume, 6, 1e-13, 0);
  free(tri);
  corot_mesh_destroy(m);
}

static void box_is_as_documented(void **state) {
  (void)state;
  corot_mesh *m = make_box(2, 3, 4);
  assert_int_equal(m->nnode, 3 * 4 * 5);
  assert_int_equal(m->ntet, 6 * 24);
  int i = 1, j = 2, k = 3, node = i + 3 * (j + 4 * k);
  assert_close(m->x[node][0], -1 + 1 * i / 2.0, 0, 1e-15);
  assert_close(m->x[node][1], 2 * j / 3.0, 0, 1e-15);
  assert_close(m->x[node][2], 5 + 3 * k / 4.0, 0, 1e-15);
  corot_mesh_quality q = corot_mesh_measure(m);
  assert_close(q.volume, 6, 1e-14, 0);
  assert_close(q.volume_min, 6.0 / 144, 1e-13, 0);
  assert_close(q.volume_max, 6.0 / 144, 1e-13, 0);
  corot_mesh_destroy(m);
}

static void box_sides_are_groups(void **state) {
  (void)state;
  static const char *const names[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  static const double area[3] = {6, 3, 2};
  corot_mesh *m = make_box(2, 3, 4);
  assert_int_equal(m->ngroup, 6);
  for (int g = 0; g < 6; g++) {
    const corot_group *group = corot_mesh_find_group(m, names[g]);
    double sum[3];
    int n[3] = {2, 3, 4};
    n[g / 2] = 0;
    assert_non_null(group);
    assert_int_equal(group->nnode, (n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    assert_int_equal(group->ntet, 0);
    area_vector(m, group->ntri, group->tri, sum);
    for (int k = 0; k < 3; k++)
      assert_close(sum[k], k == g / 2 ? (g % 2 ? 1 : -1) * area[k] : 0, 1e-14, 1e-14);
  }
  corot_mesh_destroy(m);
}

static void bad_boxes_are_refused(void **state) {
  (void)state;
  const corot_box good = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, COROT_BOX_KUHN};
  corot_box b;
  corot_mesh *m;
  b = good, b.size[1] = 0;
  assert_fails(corot_mesh_box(&b, &m), COROT_EINVAL, "size is 0 along y");
  b = good, b.size[1] = NAN;
  assert_fails(corot_mesh_box(&b, &m), COROT_EINVAL, "size is nan along y");
  b = good, b.cells[2] = 0;
  assert_fails(corot_mesh_box(&b, &m), COROT_EINVAL, "0 cells along z");
  b = good, b.origin[0] = INFINITY;
  assert_fails(corot_mesh_box(&b, &m), COROT_EINVAL, "origin is inf along x");
  b = good, b.origin[0] = 1e20; /* the nodes fall together */
  assert_fails(corot_mesh_box(&b, &m), COROT_EINVAL, "tet 0 is flat");
  for (int k = 0; k < 3; k++) b.cells[k] = INT_MAX;
  assert_fails(corot_mesh_box(&b, &m), COROT_EINVAL, "cells are too many");
  b = good, b.cells[0] = INT_MAX / 24 + 1; /* the tets' nodes do not fit an int */
  assert_fails(corot_mesh_box(&b, &m), COROT_EINVAL, "cells are too many");
}

static void groups_select_by_nodes(void **state) {
  (void)state;
  corot_mesh *m = make_box(1, 1, 1);
  const int cell[4] = {7, 3, 1, 0}, again[5] = {2, 0, 2, 0, 2};
  assert_ok(corot_mesh_group_nodes(m, "first tet", 4, cell));
  const corot_group *g = corot_mesh_find_group(m, "first tet");
  const int sorted[4] = {0, 1, 3, 7};
  assert_int_equal(g->nnode, 4);
  assert_memory_equal(g->node, sorted, sizeof sorted);
  assert_int_equal(g->ntet, 1);
  assert_int_equal(g->tet[0], 0);
  assert_int_equal(g->ntri, 2); /* of its four faces two are inside the box */

  assert_ok(corot_mesh_group_nodes(m, "edge", 5, again));
  g = corot_mesh_find_group(m, "edge");
  assert_int_equal(g->nnode, 2);
  assert_int_equal(g->node[1], 2);
  assert_int_equal(g->ntri + g->ntet, 0);
  assert_null(corot_mesh_find_group(m, "Edge"));
  corot_mesh_destroy(m);
}

static void planes_and_boxes_select_with_a_tolerance(void **state) {
  (void)state;
  corot_mesh *m = make_box(2, 2, 2);
  assert_ok(corot_mesh_group_plane(m, "bottom", 2, 5 + 1e-7, 0));
  assert_int_equal(corot_mesh_find_group(m, "bottom")->nnode, 9);
  assert_int_equal(corot_mesh_find_group(m, "bottom")->ntri, 8);
  assert_ok(corot_mesh_group_plane(m, "near", 2, 5.4, 0.5));
  assert_int_equal(corot_mesh_find_group(m, "near")->nnode, 9);
  const double min[3] = {-1, 0, 5}, max[3] = {-0.5, 1, 6.5};
  assert_ok(corot_mesh_group_box(m, "corner", min, max, 0));
  assert_int_equal(corot_mesh_find_group(m, "corner")->nnode, 8);
  assert_int_equal(corot_mesh_find_group(m, "corner")->ntet, 6);
  assert_int_equal(corot_mesh_find_group(m, "corner")->ntri, 6);
  assert_fails(corot_mesh_group_plane(m, "none", 2, 5.1, 0), COROT_EINVAL,
               "group 'none': no node is there (tolerance 3.7");
  corot_mesh_destroy(m);
}

static void bad_groups_are_refused(void **state) {
  (void)state;
  corot_mesh *m = make_box(1, 1, 1);
  const int node[1] = {8};
  const double min[3] = {0, 0, 1}, max[3] = {0, 0, 0};
  char name[129];
  memset(name, 'n', 128);
  name[128] = 0;
  assert_fails(corot_mesh_group_nodes(m, "g", 1, node), COROT_EINVAL,
               "group 'g': node 8 does not exist, the last is 7");
  assert_fails(corot_mesh_group_nodes(m, "g", 0, node), COROT_EINVAL, "group 'g' has no nodes");
  assert_fails(corot_mesh_group_plane(m, "xmin", 0, -1, 0), COROT_EINVAL,
               "group 'xmin' exists already");
  assert_fails(corot_mesh_group_plane(m, "", 0, -1, 0), COROT_EINVAL, "a group needs a name");
  assert_fails(corot_mesh_group_plane(m, name, 0, -1, 0), COROT_EINVAL, "at most 127 bytes");
  assert_fails(corot_mesh_group_plane(m, "a\"b", 0, -1, 0), COROT_EINVAL, "byte 2 of the name");
  assert_fails(corot_mesh_group_plane(m, "a\nb", 0, -1, 0), COROT_EINVAL, "byte 2 of the name");
  assert_fails(corot_mesh_group_plane(m, "g", 3, 0, 0), COROT_EINVAL, "axis is 3");
  assert_fails(corot_mesh_group_plane(m, "g", 0, NAN, 0), COROT_EINVAL, "min is nan");
  assert_fails(corot_mesh_group_plane(m, "g", 0, 0, -1), COROT_EINVAL, "tolerance is -1");
  assert_fails(corot_mesh_group_plane(m, "g", 0, 0, NAN), COROT_EINVAL, "tolerance is nan");
  assert_fails(corot_mesh_group_box(m, "g", min, max, 0), COROT_EINVAL,
               "min is 1 and max is 0 along z");
  assert_int_equal(m->ngroup, 6);
  corot_mesh_destroy(m);
}

static void nearest_node(void **state) {
  (void)state;
  corot_mesh *m = make_box(2, 2, 2);
  assert_int_equal(corot_mesh_nearest(m, (double[3]){-9, -9, -9}), 0);
  assert_int_equal(corot_mesh_nearest(m, (double[3]){-0.4, 1.1, 6.6}), 13);
  assert_int_equal(corot_mesh_nearest(m, (double[3]){-0.75, 0, 5}), 0); /* halfway to 1 */
  corot_mesh_destroy(m);
}

static void measures_of_known_tets(void **state) {
  (void)state;
  /* a regular tet of edge sqrt 8, and one against it whose apex is the far corner of the cube */
  const double x[5][3] = {{1, 1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, -1, -1}};
  const int tet[2][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  corot_mesh *m;
  assert_ok(corot_mesh_create(4, x, 1, tet, &m));
  corot_mesh_quality q = corot_mesh_measure(m);
  assert_close(q.volume, 8.0 / 3, 1e-15, 0);
  assert_close(q.edge_min, sqrt(8), 1e-15, 0);
  assert_close(q.edge_max, sqrt(8), 1e-15, 0);
  assert_close(q.dihedral_min, acos(1.0 / 3) * 180 / 3.14159265358979, 1e-13, 0);
  assert_close(q.dihedral_max, q.dihedral_min, 1e-13, 0);
  assert_close(q.shape_min, 1, 1e-14, 0);
  assert_close(q.min[1], -1, 0, 0);
  assert_close(q.max[2], 1, 0, 0);
  corot_mesh_destroy(m);

  assert_ok(corot_mesh_create(5, x, 2, tet, &m));
  q = corot_mesh_measure(m);
  assert_close(q.volume_min, 4.0 / 3, 1e-15, 0);
  assert_close(q.edge_min, 2, 1e-15, 0);
  assert_close(q.dihedral_max, 90, 1e-14, 0);
  assert_close(q.dihedral_min, atan(sqrt(2)) * 180 / 3.14159265358979, 1e-13, 0);
  double shape = 3 * (2 / (3 + sqrt(3))) / sqrt(3); /* r = 3 V / A, R = half the cube's diagonal */
  assert_close(q.shape_min, shape, 1e-14, 0);
  assert_close(q.shape_mean, (1 + shape) / 2, 1e-14, 0);
  assert_int_equal(q.shape_worst, 1);
  corot_mesh_destroy(m);
}

static void assert_same_mesh(const corot_mesh *a, const corot_mesh *b) {
  assert_int_equal(a->nnode, b->nnode);
  assert_int_equal(a->ntet, b->ntet);
  assert_int_equal(a->ngroup, b->ngroup);
  assert_memory_equal(a->x, b->x, (size_t)a->nnode * sizeof *a->x);
  assert_memory_equal(a->tet, b->tet, (size_t)a->ntet * sizeof *a->tet);
  for (int g = 0; g < a->ngroup; g++) {
    const corot_group *p = &a->group[g], *q = &b->group[g];
    assert_string_equal(p->name, q->name);
    assert_int_equal(p->nnode, q->nnode);
    assert_int_equal(p->ntri, q->ntri);
    assert_int_equal(p->ntet, q->ntet);
    assert_memory_equal(p->node, q->node, (size_t)p->nnode * sizeof *p->node);
    if (p->ntri) assert_memory_equal(p->tri, q->tri, (size_t)p->ntri * sizeof *p->tri);
    if (p->ntet) assert_memory_equal(p->tet, q->tet, (size_t)p->ntet * sizeof *p->tet);
  }
}

static void writing_and_reading_give_the_same_mesh(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const corot_box box = {{0.1, 1 / 3.0, 1e-7}, {2, 2, 2}, {-1e-3, 1e-17, 3e-9}, COROT_BOX_KUHN};
  const double min[3] = {-1e-3, 0, 3e-9}, max[3] = {0.099, 1, 5.3e-8};
  corot_mesh *a, *b;
  assert_ok(corot_mesh_box(&box, &a));
  assert_ok(corot_mesh_group_box(a, "lower half", min, max, 1e-12));
  assert_ok(corot_mesh_group_box(a, "all", min, (double[3]){1, 1, 1}, 1));
  assert_ok(corot_mesh_group_nodes(a, "1", 1, (int[]){13}));
  assert_ok(corot_mesh_write(a, in(dir, "box.msh")));
  assert_ok(corot_mesh_read(in(dir, "box.msh"), &b));
  assert_same_mesh(a, b);
  corot_mesh_destroy(b);
  for (int g = 0; g < a->ngroup; g++) { /* without groups */
    corot_group *group = &a->group[g];
    free(group->name), free(group->node), free(group->tri), free(group->tet);
  }
  a->ngroup = 0;
  assert_ok(corot_mesh_write(a, in(dir, "box.msh"))); /* over the first */
  assert_ok(corot_mesh_read(in(dir, "box.msh"), &b));
  assert_same_mesh(a, b);
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
  remove_folder(dir);
}

static int count_entries(const char *dir) {
  int n = 0;
  DIR *d = opendir(dir);
  assert_non_null(d);
  while (readdir(d)) n++;
  closedir(d);
  return n - 2;
}

static void failed_write_leaves_nothing(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *m = make_box(4, 4, 4);
  struct rlimit limit, before;
  assert_fails(corot_mesh_write(m, in(dir, "no/box.msh")), COROT_EIO, "No such file or directory");
  signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &before);
  limit = before;
  limit.rlim_cur = 5000;
  setrlimit(RLIMIT_FSIZE, &limit);
  corot_status status = corot_mesh_write(m, in(dir, "box.msh"));
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, SIG_DFL);
  assert_int_equal(status, COROT_EIO);
  assert_non_null(strstr(corot_error(), "box.msh: File too large"));
  assert_int_equal(count_entries(dir), 0);
  corot_mesh_destroy(m);
  remove_folder(dir);
}

static corot_status try_create(void *context) {
  (void)context;
  corot_mesh *m = NULL;
  corot_status status = corot_mesh_create(5, two_x, 2, two_tet, &m);
  corot_mesh_destroy(m);
  return status;
}

static corot_status try_box(void *context) {
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, COROT_BOX_KUHN};
  (void)context;
  corot_mesh *m = NULL;
  corot_status status = corot_mesh_box(&box, &m);
  corot_mesh_destroy(m);
  return status;
}

static corot_status try_group(void *context) {
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, COROT_BOX_KUHN};
  (void)context;
  corot_mesh *m = NULL;
  COROT_TRY(corot_mesh_box(&box, &m));
  corot_status status = corot_mesh_group_plane(m, "plane", 0, 0, 0);
  assert_int_equal(m->ngroup, status ? 6 : 7);
  if (!status) status = corot_mesh_group_nodes(m, "nodes", 2, (int[]){0, 1});
  corot_mesh_destroy(m);
  return status;
}

static corot_status try_write(void *dir) {
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, COROT_BOX_KUHN};
  corot_mesh *m = NULL;
  COROT_TRY(corot_mesh_box(&box, &m));
  corot_status status = corot_mesh_write(m, in(dir, "box.msh"));
  corot_mesh_destroy(m);
  assert_int_equal(count_entries(dir), status ? 0 : 1);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  char *dir = temporary_folder();
  assert_true(assert_survives_failed_allocations(try_create, NULL) >= 6);
  assert_true(assert_survives_failed_allocations(try_box, NULL) >= 6);
  assert_true(assert_survives_failed_allocations(try_group, NULL) >= 12);
  assert_true(assert_survives_failed_allocations(try_write, dir) >= 8);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(create_copies),
      cmocka_unit_test(unsound_meshes_are_refused_by_name),
      cmocka_unit_test(bad_counts_are_refused),
      cmocka_unit_test(faults_of_connection_are_refused),
      cmocka_unit_test(boundary_is_closed_and_winds_outward),
      cmocka_unit_test(box_is_as_documented),
      cmocka_unit_test(box_sides_are_groups),
      cmocka_unit_test(bad_boxes_are_refused),
      cmocka_unit_test(groups_select_by_nodes),
      cmocka_unit_test(planes_and_boxes_select_with_a_tolerance),
      cmocka_unit_test(bad_groups_are_refused),
      cmocka_unit_test(nearest_node),
      cmocka_unit_test(measures_of_known_tets),
      cmocka_unit_test(writing_and_reading_give_the_same_mesh),
      cmocka_unit_test(failed_write_leaves_nothing),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
