/* How many tets lie through the thickness of a body, and how tets are shaped, one by one. */
#include "alloc.h"
#include "check.h"
#include "core/mesh/mesh.h"
#include "mesh_text.h"

/* From each side of a box of cells the way is as long as the box, and passes as many tets as cells,
   however these are cut. The sums have some twenty terms: 1e-12 is far above their rounding. */
static void cells_in_a_row_are_counted(void **state) {
  (void)state;
  static const double size[3] = {0.3, 2, 1};
  static const int cells[3] = {3, 2, 5};
  for (int split = 0; split < 2; split++) {
    corot_box box = corot_box_defaults();
    corot_mesh *m = NULL;
    corot_crossing *c = NULL;
    int ntri, (*tri)[3];
    for (int k = 0; k < 3; k++) box.size[k] = size[k], box.cells[k] = cells[k];
    box.split = split ? COROT_BOX_ALTERNATING : COROT_BOX_KUHN;
    assert_ok(corot_mesh_box(&box, &m));
    assert_ok(corot_mesh_boundary(m, &ntri, &tri));
    assert_ok(corot_mesh_cross(m, &c));
    for (int i = 0; i < ntri; i++) {
      int axis = 0;
      for (int k = 0; k < 3; k++)
        if (m->x[tri[i][0]][k] == m->x[tri[i][1]][k] && m->x[tri[i][0]][k] == m->x[tri[i][2]][k])
          axis = k;
      assert_close(c[i].length, size[axis], 1e-12, 0);
      assert_close(c[i].ntet, cells[axis], 1e-12, 0);
      bool at_tri = false;
      for (int k = 0; k < 4; k++) at_tri |= m->tet[c[i].tet][k] == tri[i][0];
      assert_true(at_tri);
    }
    free(c);
    free(tri);
    corot_mesh_destroy(m);
  }
}

/* Of one tet each way passes a part of its extent only. */
static void one_tet_is_less_than_one(void **state) {
  (void)state;
  static const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static const int tet[1][4] = {{0, 1, 2, 3}};
  corot_mesh *m = NULL;
  corot_crossing *c = NULL;
  assert_ok(corot_mesh_create(4, x, 1, tet, &m));
  assert_ok(corot_mesh_cross(m, &c));
  for (int i = 0; i < 4; i++) {
    assert_true(c[i].length > 0 && c[i].ntet > 0.2 && c[i].ntet < 1);
    assert_int_equal(c[i].tet, 0);
  }
  free(c);
  corot_mesh_destroy(m);
}

static void shapes_are_those_of_the_measure(void **state) {
  (void)state;
  static const double x[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  static const int tet[1][4] = {{0, 1, 3, 2}};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_create(4, x, 1, tet, &m));
  assert_close(corot_mesh_shape(m, 0), 1, 1e-14, 0);
  corot_mesh_destroy(m);
  m = read_mesh(DATA "two.msh22.msh");
  corot_mesh_quality q = corot_mesh_measure(m);
  double sum = 0;
  for (int e = 0; e < m->ntet; e++) sum += corot_mesh_shape(m, e);
  assert_close(sum / m->ntet, q.shape_mean, 1e-14, 0);
  assert_close(corot_mesh_shape(m, q.shape_worst), q.shape_min, 0, 0);
  corot_mesh_destroy(m);
}

static corot_status try_cross(void *mesh) {
  corot_crossing *c = NULL;
  corot_status status = corot_mesh_cross(mesh, &c);
  assert_true(!status == !!c);
  free(c);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  corot_mesh *m = read_mesh(DATA "two.msh22.msh");
  assert_true(assert_survives_failed_allocations(try_cross, m) >= 5);
  corot_mesh_destroy(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cells_in_a_row_are_counted),
      cmocka_unit_test(one_tet_is_less_than_one),
      cmocka_unit_test(shapes_are_those_of_the_measure),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
