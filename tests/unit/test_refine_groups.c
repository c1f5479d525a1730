/* Who inherits a group when the mesh is refined. */
#include <corot/mesh.h>

#include "check.h"
#include "core/mesh/mesh.h"

/* From (-1, 0, 5) to (0, 2, 8). */
static corot_mesh *make_box(int nx, int ny, int nz) {
  const corot_box box = {{1, 2, 3}, {nx, ny, nz}, {-1, 0, 5}, COROT_BOX_KUHN};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  return m;
}

static corot_mesh *refined(const corot_mesh *m, int nlevel) {
  corot_mesh *fine = NULL;
  assert_ok(corot_mesh_refine(m, nlevel, COROT_DIAGONAL_CONSISTENT, &fine, NULL));
  return fine;
}

static corot_group *group_of(corot_mesh *m, const char *name) {
  corot_group *g = (corot_group *)corot_mesh_find_group(m, name);
  assert_non_null(g);
  for (int i = 1; i < g->nnode; i++) assert_true(g->node[i - 1] < g->node[i]);
  for (int i = 1; i < g->ntet; i++) assert_true(g->tet[i - 1] < g->tet[i]);
  return g;
}

static void assert_same_nodes(corot_mesh *a, corot_mesh *b, const char *name) {
  const corot_group *g = group_of(a, name), *h = group_of(b, name);
  assert_int_equal(g->nnode, h->nnode);
  assert_memory_equal(g->node, h->node, (size_t)g->nnode * sizeof *g->node);
}

static void area_vector(const corot_mesh *m, const corot_group *g, double sum[3]) {
  for (int k = 0; k < 3; k++) sum[k] = 0;
  for (int t = 0; t < g->ntri; t++) {
    const double *o = m->x[g->tri[t][0]], *p = m->x[g->tri[t][1]], *q = m->x[g->tri[t][2]];
    for (int k = 0; k < 3; k++) {
      int i = (k + 1) % 3, j = (k + 2) % 3;
      sum[k] += ((p[i] - o[i]) * (q[j] - o[j]) - (p[j] - o[j]) * (q[i] - o[i])) / 2;
    }
  }
}

static void sides_of_a_box(void **state) {
  (void)state;
  static const char *const name[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  corot_mesh *m = make_box(2, 3, 1), *fine = refined(m, 2);
  assert_int_equal(fine->ngroup, 6);
  for (int s = 0; s < 6; s++) {
    double at[6] = {-1, 0, 0, 2, 5, 8}, before[3], after[3];
    assert_string_equal(fine->group[s].name, name[s]);
    assert_int_equal(fine->group[s].ntri, 16 * m->group[s].ntri);
    area_vector(m, &m->group[s], before);
    area_vector(fine, &fine->group[s], after);
    for (int k = 0; k < 3; k++) assert_close(after[k], before[k], 1e-14, 1e-14);

    corot_group *g = &fine->group[s];
    free(g->name);
    assert_ok(COROT_ALLOC(g->name, 2)); /* a name that is not taken */
    g->name[0] = 'a';
    assert_ok(corot_mesh_group_plane(fine, name[s], s / 2, at[s], 0));
    g = &fine->group[s];
    const corot_group *h = group_of(fine, name[s]);
    assert_int_equal(g->nnode, h->nnode);
    assert_memory_equal(g->node, h->node, (size_t)g->nnode * sizeof *g->node);
    assert_int_equal(g->ntri, h->ntri);
  }
  corot_mesh_destroy(fine);
  corot_mesh_destroy(m);
}

static void tets_and_all_that_is_in_them(void **state) {
  (void)state;
  const double min[3] = {-1, 0, 5}, max[3] = {-0.5, 1, 6.5};
  corot_mesh *m = make_box(2, 2, 2), *expected = refined(m, 1);
  assert_ok(corot_mesh_group_box(m, "cell", min, max, 0));
  assert_ok(corot_mesh_group_box(expected, "cell", min, max, 0));
  corot_mesh *fine = refined(m, 1);
  const corot_group *g = group_of(fine, "cell"), *h = group_of(expected, "cell");
  assert_same_nodes(fine, expected, "cell");
  assert_int_equal(g->ntet, 48);
  assert_int_equal(g->ntet, h->ntet);
  assert_memory_equal(g->tet, h->tet, 48 * sizeof *g->tet);
  assert_int_equal(g->ntri, 24);
  assert_int_equal(g->ntri, h->ntri);
  corot_mesh_destroy(fine);
  corot_mesh_destroy(expected);
  corot_mesh_destroy(m);
}

/* Drops the triangles and tets of a group. */
static void keep_nodes(corot_group *g) { g->ntri = g->ntet = 0; }

static void faces_inside_keep_their_winding(void **state) {
  (void)state;
  corot_mesh *m = make_box(1, 1, 1);
  const int node[3] = {0, 3, 7}; /* between two tets */
  assert_ok(corot_mesh_group_nodes(m, "face", 3, node));
  corot_group *g = group_of(m, "face");
  for (int turned = 0; turned < 2; turned++) {
    free(g->tri);
    assert_ok(COROT_ALLOC(g->tri, 1));
    const int tri[3] = {0, turned ? 7 : 3, turned ? 3 : 7};
    memcpy(g->tri[0], tri, sizeof tri);
    g->ntri = 1;
    double before[3], after[3];
    corot_mesh *fine = refined(m, 1);
    const corot_group *f = group_of(fine, "face");
    assert_int_equal(f->ntri, 4);
    assert_int_equal(f->nnode, 6);
    area_vector(m, g, before);
    area_vector(fine, f, after);
    for (int k = 0; k < 3; k++) assert_close(after[k], before[k], 1e-14, 1e-14);
    corot_mesh_destroy(fine);
  }
  corot_mesh_destroy(m);
}

static void points_and_lines(void **state) {
  (void)state;
  const int line[3] = {0, 2, 4}, two[2] = {1, 5};
  corot_mesh *m = make_box(1, 2, 1); /* nodes 0 2 4 from (-1, 0, 5) to (-1, 2, 5) */
  assert_ok(corot_mesh_group_nodes(m, "line", 3, line));
  assert_ok(corot_mesh_group_nodes(m, "point", 1, line));
  assert_ok(corot_mesh_group_nodes(m, "two", 2, two)); /* without an edge between them */
  corot_mesh *fine = refined(m, 2);
  assert_int_equal(group_of(fine, "point")->nnode, 1);
  assert_int_equal(group_of(fine, "two")->nnode, 2);
  const corot_group *g = group_of(fine, "line");
  assert_int_equal(g->nnode, 9);
  for (int i = 0; i < 9; i++)
    assert_true(fine->x[g->node[i]][0] == -1 && fine->x[g->node[i]][2] == 5);
  corot_mesh_destroy(fine);
  corot_mesh_destroy(m);
}

/* All nodes of one cell, whose space diagonal goes through the inside. */
static void a_surface_of_nodes_stays_on_the_surface(void **state) {
  (void)state;
  const int all[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  corot_mesh *m = make_box(1, 1, 1);
  assert_ok(corot_mesh_group_nodes(m, "skin", 8, all));
  keep_nodes(group_of(m, "skin"));
  corot_mesh *fine = refined(m, 2);
  const corot_group *g = group_of(fine, "skin");
  assert_int_equal(g->nnode, 5 * 5 * 5 - 3 * 3 * 3);
  for (int i = 0; i < g->nnode; i++) {
    const double *x = fine->x[g->node[i]];
    assert_true(x[0] == -1 || x[0] == 0 || x[1] == 0 || x[1] == 2 || x[2] == 5 || x[2] == 8);
  }
  corot_mesh_destroy(fine);
  corot_mesh_destroy(m);
}

/* Edges from one side to the other cut the corner between them. */
static void sides_with_faces_stay_on_the_surface(void **state) {
  (void)state;
  corot_mesh *m = make_box(2, 2, 2);
  int n = 0, node[27];
  for (int i = 0; i < m->nnode; i++)
    if (m->x[i][0] == -1 || m->x[i][1] == 2) node[n++] = i;
  assert_ok(corot_mesh_group_nodes(m, "sides", n, node));
  corot_group *g = group_of(m, "sides");
  assert_int_equal(g->nnode, 15);
  assert_true(g->ntri > 16); /* some of zmin and zmax */
  int ntri = 0;
  for (int t = 0; t < g->ntri; t++) {
    int on_x = 0, on_y = 0;
    for (int k = 0; k < 3; k++) {
      on_x += m->x[g->tri[t][k]][0] == -1;
      on_y += m->x[g->tri[t][k]][1] == 2;
    }
    if (on_x == 3 || on_y == 3) memmove(g->tri[ntri++], g->tri[t], sizeof *g->tri);
  }
  assert_int_equal(ntri, 16);
  g->ntri = ntri;
  g->ntet = 0;
  corot_mesh *fine = refined(m, 2);
  const corot_group *f = group_of(fine, "sides");
  assert_int_equal(f->nnode, 9 * (9 + 8));
  for (int i = 0; i < f->nnode; i++)
    assert_true(fine->x[f->node[i]][0] == -1 || fine->x[f->node[i]][1] == 2);
  corot_mesh_destroy(fine);
  corot_mesh_destroy(m);
}

static void a_section_is_filled(void **state) {
  (void)state;
  corot_mesh *m = make_box(2, 2, 2), *expected = refined(m, 2);
  assert_ok(corot_mesh_group_plane(m, "section", 0, -0.5, 0));
  assert_ok(corot_mesh_group_plane(expected, "section", 0, -0.5, 0));
  corot_mesh *fine = refined(m, 2);
  assert_int_equal(group_of(fine, "section")->nnode, 81);
  assert_same_nodes(fine, expected, "section");
  corot_mesh_destroy(fine);
  corot_mesh_destroy(expected);
  corot_mesh_destroy(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sides_of_a_box),
      cmocka_unit_test(tets_and_all_that_is_in_them),
      cmocka_unit_test(faces_inside_keep_their_winding),
      cmocka_unit_test(points_and_lines),
      cmocka_unit_test(a_surface_of_nodes_stays_on_the_surface),
      cmocka_unit_test(sides_with_faces_stay_on_the_surface),
      cmocka_unit_test(a_section_is_filled),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
