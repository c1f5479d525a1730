/* The hierarchical basis: T, its inverse, and their transposes. */
#include <corot/hierarchy.h>

#include "check.h"
#include "solid.h"

typedef struct family {
  corot_mesh *coarse, *fine;
  corot_refinement *r;
  int n;        /* nodes of the finest mesh */
  size_t bytes; /* of a field */
} family;

static family make_family(int nlevel) {
  family f = {.coarse = crooked_box(2, 1, 2)};
  assert_ok(corot_mesh_refine(f.coarse, nlevel, COROT_DIAGONAL_CONSISTENT, &f.fine, &f.r));
  f.n = f.fine->nnode;
  f.bytes = (size_t)f.n * sizeof *f.fine->x;
  return f;
}

static void drop_family(family *f) {
  corot_mesh_destroy(f->coarse);
  corot_mesh_destroy(f->fine);
  corot_refinement_destroy(f->r);
}

static double (*random_field(const family *f, uint64_t seed))[3] {
  double(*v)[3] = malloc(f->bytes);
  assert_non_null(v);
  for (int i = 0; i < f->n; i++)
    for (int k = 0; k < 3; k++) v[i][k] = noise(&seed);
  return v;
}

static double (*copy_field(const family *f, double (*v)[3]))[3] {
  double(*w)[3] = malloc(f->bytes);
  assert_non_null(w);
  return memcpy(w, v, f->bytes);
}

typedef void (*transform)(const corot_refinement *refinement, double (*v)[3]);

static void inverses(void **state) {
  (void)state;
  static const transform pair[][2] = {
      {corot_hierarchy_apply, corot_hierarchy_solve},
      {corot_hierarchy_solve, corot_hierarchy_apply},
      {corot_hierarchy_apply_transposed, corot_hierarchy_solve_transposed},
      {corot_hierarchy_solve_transposed, corot_hierarchy_apply_transposed}};
  for (int nlevel = 0; nlevel <= 3; nlevel++) {
    family f = make_family(nlevel);
    double(*v)[3] = random_field(&f, 5);
    for (int p = 0; p < 4; p++) {
      double(*w)[3] = copy_field(&f, v), largest = 1;
      pair[p][0](f.r, w);
      for (int i = 0; i < f.n; i++)
        for (int k = 0; k < 3; k++) largest = fmax(largest, fabs(w[i][k]));
      if (nlevel == 0) assert_memory_equal(w, v, f.bytes);
      if (nlevel > 0) assert_memory_not_equal(w, v, f.bytes);
      pair[p][1](f.r, w);
      for (int i = 0; i < f.n; i++)
        for (int k = 0; k < 3; k++) assert_close(w[i][k], v[i][k], 0, 4 * 2.3e-16 * largest);
      free(w);
    }
    free(v);
    drop_family(&f);
  }
}

/* (T y, r) = (y, T' r), and so for the inverses. The largest terms set the rounding. */
static void transposes(void **state) {
  (void)state;
  static const transform pair[][2] = {{corot_hierarchy_apply, corot_hierarchy_apply_transposed},
                                      {corot_hierarchy_solve, corot_hierarchy_solve_transposed}};
  family f = make_family(3);
  for (int p = 0; p < 2; p++) {
    double(*y)[3] = random_field(&f, 1), (*r)[3] = random_field(&f, 2);
    double(*Ty)[3] = copy_field(&f, y), (*Tr)[3] = copy_field(&f, r);
    pair[p][0](f.r, Ty);
    pair[p][1](f.r, Tr);
    double left = inner(3 * f.n, *Ty, *r), right = inner(3 * f.n, *y, *Tr), size = 0;
    for (int i = 0; i < f.n; i++)
      for (int k = 0; k < 3; k++) size += fabs(y[i][k] * Tr[i][k]);
    assert_close(left, right, 0, 1e-15 * size);
    assert_above(fabs(left), 1e-6 * size);
    free(y), free(r), free(Ty), free(Tr);
  }
  drop_family(&f);
}

static void affine_fields_have_no_differences(void **state) {
  (void)state;
  const double A[9] = {1, -2, 0.5, 0.25, 3, -1, 2, 1, -0.75}, b[3] = {4, -5, 6};
  family f = make_family(3);
  double(*v)[3] = malloc(f.bytes);
  assert_non_null(v);
  for (int i = 0; i < f.n; i++) {
    apply(A, f.fine->x[i], v[i]);
    for (int k = 0; k < 3; k++) v[i][k] += b[k];
  }
  double(*u)[3] = copy_field(&f, v);
  corot_hierarchy_solve(f.r, v);
  for (int i = 0; i < f.n; i++)
    for (int k = 0; k < 3; k++)
      assert_close(v[i][k], i < f.coarse->nnode ? u[i][k] : 0, 0, 1e-14); /* of numbers near 10 */
  free(v);
  free(u);
  drop_family(&f);
}

/* The hat function of a coarse node is 2^-l (2^l - j) at the j-th node of an edge that it ends. A
   force on the refined mesh is, in total, that on the coarse mesh. */
static void coarse_values_are_interpolated(void **state) {
  (void)state;
  family f = make_family(3);
  double(*v)[3] = calloc((size_t)f.n, sizeof *v);
  assert_non_null(v);
  v[0][1] = 1;
  corot_hierarchy_apply(f.r, v);
  const int *edge = f.r->parent[0]; /* the middle of 0 and another coarse node */
  assert_int_equal(edge[0], 0);
  const double *a = f.fine->x[0], *c = f.fine->x[edge[1]];
  int found = 0;
  for (int j = 0; j <= 8; j++)
    for (int i = 0; i < f.n; i++) {
      double off = 0;
      for (int k = 0; k < 3; k++) off += fabs(f.fine->x[i][k] - a[k] - j / 8.0 * (c[k] - a[k]));
      if (off > 1e-12) continue;
      found++;
      assert_true(v[i][1] == (8 - j) / 8.0 && v[i][0] == 0 && v[i][2] == 0);
    }
  assert_int_equal(found, 9);
  free(v);

  double(*g)[3] = random_field(&f, 9), fine = 0, coarse = 0;
  for (int i = 0; i < f.n; i++) fine += g[i][2];
  corot_hierarchy_apply_transposed(f.r, g);
  for (int i = 0; i < f.coarse->nnode; i++) coarse += g[i][2];
  assert_close(coarse, fine, 1e-12, 0);
  free(g);
  drop_family(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(inverses),
      cmocka_unit_test(transposes),
      cmocka_unit_test(affine_fields_have_no_differences),
      cmocka_unit_test(coarse_values_are_interpolated),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
