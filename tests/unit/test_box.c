/* Boxes by each way to cut their cells: sound, whole, and as symmetric as they claim to be. */
#include <corot/mesh.h>
#include <stdbool.h>

#include "check.h"

static const corot_box_split splits[] = {COROT_BOX_KUHN, COROT_BOX_ALTERNATING,
                                         COROT_BOX_SYMMETRIC};
static const int counts[][3] = {{1, 1, 1}, {2, 2, 2}, {1, 1, 8}, {1, 1, 7},
                                {3, 3, 4}, {2, 3, 5}, {1, 2, 9}, {4, 2, 6}};
enum { NSPLIT = sizeof splits / sizeof *splits, NCOUNT = sizeof counts / sizeof *counts };

static corot_box box_of(corot_box_split split, const int cells[3]) {
  corot_box box = {.size = {2, 3, 5}, .origin = {-1, 0.5, 7}, .split = split};
  memcpy(box.cells, cells, sizeof box.cells);
  return box;
}

static corot_mesh *make(const corot_box *box) {
  corot_mesh *mesh = NULL;
  assert_ok(corot_mesh_box(box, &mesh));
  return mesh;
}

/* Cells along an axis once the middle one is cut in halves. */
static int count_of(const corot_box *box, int axis) {
  bool halved = box->split == COROT_BOX_SYMMETRIC && box->cells[axis] % 2;
  return box->cells[axis] + halved;
}

/* --- Soundness --- */

/* Every face that is not on the boundary is shared by two tets, and the boundary is that of the
   grid: two triangles for each side of a cell. What else makes a mesh unsound, tets of no volume or
   on the same side of a face, is found where the same mesh is made anew. */
static void assert_sound(const corot_box *box, const corot_mesh *m) {
  int n[3], ntri, (*tri)[3];
  for (int k = 0; k < 3; k++) n[k] = count_of(box, k);
  assert_int_equal(m->nnode, (n[0] + 1) * (n[1] + 1) * (n[2] + 1));
  assert_int_equal(m->ntet, 6 * n[0] * n[1] * n[2]);
  assert_ok(corot_mesh_boundary(m, &ntri, &tri));
  assert_int_equal(ntri, 4 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]));
  free(tri);
  corot_mesh *again;
  assert_ok(corot_mesh_create(m->nnode, (const double(*)[3])m->x, m->ntet, (const int(*)[4])m->tet,
                              &again));
  corot_mesh_destroy(again);
}

/* All tets of an undivided cell have a sixth of its volume, those of the halves of one less. */
static void assert_volumes(const corot_box *box, const corot_mesh *m) {
  corot_mesh_quality q = corot_mesh_measure(m);
  double cell = 30.0 / (box->cells[0] * box->cells[1] * box->cells[2]), halves = 1;
  bool all = true;
  for (int k = 0; k < 3; k++) {
    if (count_of(box, k) > box->cells[k]) halves *= 2;
    all &= box->cells[k] == 1 || count_of(box, k) == box->cells[k];
  }
  assert_close(q.volume, 30, 1e-13, 0);
  assert_close(q.volume_min, cell / 6 / halves, 1e-12, 0);
  if (halves == 1) assert_close(q.volume_max, cell / 6, 1e-12, 0);
  if (!all) assert_above(q.volume_max, 1.5 * q.volume_min);
}

static void assert_sides(const corot_box *box, const corot_mesh *m) {
  static const char *const name[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  assert_int_equal(m->ngroup, 6);
  for (int s = 0; s < 6; s++) {
    const corot_group *g = corot_mesh_find_group(m, name[s]);
    int a = count_of(box, (s / 2 + 1) % 3), b = count_of(box, (s / 2 + 2) % 3);
    double at = box->origin[s / 2] + (s % 2) * box->size[s / 2];
    assert_non_null(g);
    assert_int_equal(g->nnode, (a + 1) * (b + 1));
    assert_int_equal(g->ntri, 2 * a * b);
    for (int i = 0; i < g->nnode; i++) assert_close(m->x[g->node[i]][s / 2], at, 1e-15, 0);
  }
}

static void every_split_is_sound(void **state) {
  (void)state;
  for (int s = 0; s < NSPLIT; s++)
    for (int c = 0; c < NCOUNT; c++) {
      corot_box box = box_of(splits[s], counts[c]);
      corot_mesh *m = make(&box);
      assert_sound(&box, m);
      assert_volumes(&box, m);
      assert_sides(&box, m);
      corot_mesh_destroy(m);
    }
}

/* The planes of nodes are where they were, and the middle of the box is one of them. */
static void halves_leave_the_other_planes(void **state) {
  (void)state;
  corot_box box = box_of(COROT_BOX_SYMMETRIC, (const int[3]){1, 2, 5});
  corot_mesh *m = make(&box);
  const double expected[7] = {7, 8, 9, 9.5, 10, 11, 12};
  for (int k = 0; k < 7; k++) assert_close(m->x[3 * 3 * k][2], expected[k], 1e-15, 0);
  for (int i = 0; i < 3; i++) assert_close(m->x[i][0], i - 1, 0, 1e-15);
  corot_mesh_destroy(m);
}

/* --- Symmetry --- */

static int by_nodes(const void *a, const void *b) { return memcmp(a, b, 4 * sizeof(int)); }

static void sort_four(int v[4]) {
  for (int i = 1; i < 4; i++)
    for (int j = i; j > 0 && v[j] < v[j - 1]; j--) {
      int swapped = v[j];
      v[j] = v[j - 1];
      v[j - 1] = swapped;
    }
}

/* How many tets are not the image of another under the map of nodes. */
static int strangers(const corot_mesh *m, const int *image) {
  int(*own)[4] = malloc((size_t)m->ntet * sizeof *own), count = 0;
  assert_non_null(own);
  memcpy(own, m->tet, (size_t)m->ntet * sizeof *own);
  for (int e = 0; e < m->ntet; e++) sort_four(own[e]);
  qsort(own, (size_t)m->ntet, sizeof *own, by_nodes);
  for (int e = 0; e < m->ntet; e++) {
    int v[4];
    for (int c = 0; c < 4; c++) v[c] = image[m->tet[e][c]];
    sort_four(v);
    count += !bsearch(v, own, (size_t)m->ntet, sizeof *own, by_nodes);
  }
  free(own);
  return count;
}

/* The same for a map of points, which must take nodes to nodes: the mirror in the middle of axis
   `a`, or, for a cube, the exchange of axes a and b. */
static int strangers_under(const corot_mesh *m, const corot_box *box, int a, int b) {
  int *image = malloc((size_t)m->nnode * sizeof *image);
  assert_non_null(image);
  for (int n = 0; n < m->nnode; n++) {
    double x[3];
    memcpy(x, m->x[n], sizeof x);
    if (a == b) {
      x[a] = 2 * box->origin[a] + box->size[a] - x[a];
    } else {
      x[a] = box->origin[a] + m->x[n][b] - box->origin[b];
      x[b] = box->origin[b] + m->x[n][a] - box->origin[a];
    }
    image[n] = corot_mesh_nearest(m, x);
    for (int k = 0; k < 3; k++) assert_close(m->x[image[n]][k], x[k], 0, 1e-13);
  }
  int count = strangers(m, image);
  free(image);
  return count;
}

/* The mesh is its own mirror image along the axes that the header names, refined or not, along
   whichever diagonal; and for the others the measure finds that it is not. */
static void mirrors(void **state) {
  (void)state;
  for (int s = 0; s < NSPLIT; s++)
    for (int c = 0; c < NCOUNT; c++)
      for (int refined = 0; refined < 3; refined++) {
        corot_box box = box_of(splits[s], counts[c]);
        corot_mesh *m = make(&box), *fine;
        if (refined > 0) {
          assert_ok(corot_mesh_refine(m, 1, (corot_diagonal)(refined - 1), &fine, NULL));
          corot_mesh_destroy(m);
          m = fine;
        }
        for (int axis = 0; axis < 3; axis++) {
          bool symmetric = splits[s] == COROT_BOX_SYMMETRIC ||
                           (splits[s] == COROT_BOX_ALTERNATING && counts[c][axis] % 2 == 0);
          int strange = strangers_under(m, &box, axis, axis);
          assert_true(symmetric ? strange == 0 : strange > 0);
        }
        corot_mesh_destroy(m);
      }
}

/* Of equal counts the axes are alike. */
static void a_cube_has_no_preferred_axis(void **state) {
  (void)state;
  for (int s = 0; s < NSPLIT; s++)
    for (int n = 1; n <= 4; n++) {
      corot_box box = {.size = {1, 1, 1}, .cells = {n, n, n}, .split = splits[s]};
      corot_mesh *m = make(&box);
      for (int a = 0; a < 3; a++) assert_int_equal(strangers_under(m, &box, a, (a + 1) % 3), 0);
      corot_mesh_destroy(m);
    }
}

/* Octasection along the consistent diagonal cuts the halves of a cell as the cell was cut: all tets
   remain of one shape. */
static void refined_cells_keep_their_shape(void **state) {
  (void)state;
  for (int s = 0; s < NSPLIT; s++) {
    corot_box box = {.size = {4, 4, 4}, .cells = {4, 4, 4}, .split = splits[s]};
    corot_mesh *m = make(&box), *fine;
    double shape = corot_mesh_measure(m).shape_min;
    assert_ok(corot_mesh_refine(m, 2, COROT_DIAGONAL_CONSISTENT, &fine, NULL));
    assert_close(corot_mesh_measure(fine).shape_min, shape, 1e-12, 0);
    assert_close(corot_mesh_measure(fine).shape_mean, shape, 1e-12, 0);
    corot_mesh_destroy(fine);
    corot_mesh_destroy(m);
  }
}

static void refusals(void **state) {
  (void)state;
  corot_mesh *m = NULL;
  corot_box box = corot_box_defaults();
  assert_int_equal(box.split, COROT_BOX_SYMMETRIC);
  assert_fails(corot_mesh_box(&box, &m), COROT_EINVAL, "size is 0 along x");
  box = box_of((corot_box_split)3, counts[0]);
  assert_fails(corot_mesh_box(&box, &m), COROT_EINVAL, "there is no split 3");
  box = box_of((corot_box_split)-1, counts[0]);
  assert_fails(corot_mesh_box(&box, &m), COROT_EINVAL, "there is no split -1");
  box = box_of(COROT_BOX_SYMMETRIC, (const int[3]){2147483647, 1, 1});
  assert_fails(corot_mesh_box(&box, &m), COROT_EINVAL, "are too many");
  assert_null(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_split_is_sound),
      cmocka_unit_test(halves_leave_the_other_planes),
      cmocka_unit_test(mirrors),
      cmocka_unit_test(a_cube_has_no_preferred_axis),
      cmocka_unit_test(refined_cells_keep_their_shape),
      cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
