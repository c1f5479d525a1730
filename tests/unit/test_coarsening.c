/* How coarser levels see a field: L against the means it stands for, and L' against L. */
#include <stdio.h>

#include "core/coarsening.h"
#include "hierarchical.h"

/* Two levels, and a map from the finest to `level`. */
typedef struct view {
  corot_mesh *coarse, *mesh; /* of `level`, and the finest */
  corot_refinement *refinement;
  coarsening c;
  double (*u)[4], (*mean)[4];
  double *w; /* [c.nnode][3] */
} view;

static view make_view(int level, corot_coupling coupling) {
  view v = {0};
  corot_mesh *box = crooked_box(2, 1, 1);
  assert_ok(corot_mesh_refine(box, level, COROT_DIAGONAL_CONSISTENT, &v.coarse, NULL));
  assert_ok(corot_mesh_refine(box, 2, COROT_DIAGONAL_CONSISTENT, &v.mesh, &v.refinement));
  corot_mesh_destroy(box);
  if (coupling == COROT_COUPLING_MEAN)
    assert_ok(corot_coarsening_by_means(v.refinement, level, (const int(*)[4])v.coarse->tet, &v.c));
  else
    corot_coarsening_by_values(v.coarse->nnode, &v.c);
  v.u = calloc(v.mesh->nnode, sizeof *v.u);
  v.mean = calloc(v.c.nface + 1, sizeof *v.mean);
  v.w = calloc(3 * v.c.nnode, sizeof *v.w);
  return v;
}

static void drop_view(view *v) {
  corot_coarsening_clear(&v->c);
  corot_refinement_destroy(v->refinement);
  corot_mesh_destroy(v->coarse);
  corot_mesh_destroy(v->mesh);
  free(v->u), free(v->mean), free(v->w);
}

static void fill_nodal(const view *v, uint64_t seed) {
  for (int n = 0; n < v->mesh->nnode; n++)
    for (int c = 0; c < 3; c++) v->u[n][c] = noise(&seed);
}

/* G = sum of V grad over the tet with corners x and values w: V grad is the sum over the faces of
   mean value times area vector. */
static void add_gradient(const double *const x[4], const double *const w[4], double G[9]) {
  static const int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}; /* outward */
  for (int f = 0; f < 4; f++) {
    const int *v = face[f];
    double a[3], b[3];
    for (int c = 0; c < 3; c++) a[c] = x[v[1]][c] - x[v[0]][c], b[c] = x[v[2]][c] - x[v[0]][c];
    double area[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                      a[0] * b[1] - a[1] * b[0]};
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        G[3 * i + j] += (w[v[0]][i] + w[v[1]][i] + w[v[2]][i]) / 3 * area[j] / 2;
  }
}

static void means_are_those_of_the_descendants(void **state) {
  (void)state;
  for (int level = 0; level < 2; level++) {
    view v = make_view(level, COROT_COUPLING_MEAN);
    int below = v.mesh->ntet / v.coarse->ntet;
    fill_nodal(&v, 3);
    corot_coarsen(&v.c, (const double(*)[4])v.u, v.mean, v.w);
    for (int e = 0; e < v.coarse->ntet; e++) {
      double found[9] = {0}, expected[9] = {0};
      const double *x[4], *w[4];
      for (int k = 0; k < 4; k++)
        x[k] = v.coarse->x[v.coarse->tet[e][k]], w[k] = &v.w[3 * (4 * e + k)];
      add_gradient(x, w, found);
      for (int d = below * e; d < below * (e + 1); d++) {
        for (int k = 0; k < 4; k++)
          x[k] = v.mesh->x[v.mesh->tet[d][k]], w[k] = v.u[v.mesh->tet[d][k]];
        add_gradient(x, w, expected);
      }
      assert_below(distance(found, expected), 1e-14); /* values and areas are of the order of one */
    }
    drop_view(&v);
  }
}

static void affine_fields_are_seen_as_they_are(void **state) {
  for (int level = 0; level < 2; level++) {
    view v = make_view(level, coupling_of(state));
    uint64_t seed = 11;
    double A[9];
    random_gradient(&seed, 1, A);
    for (int n = 0; n < v.mesh->nnode; n++) apply(A, v.mesh->x[n], v.u[n]);
    corot_coarsen(&v.c, (const double(*)[4])v.u, v.mean, v.w);
    for (int e = 0; e < v.coarse->ntet; e++)
      for (int k = 0; k < 4; k++) {
        int n = v.coarse->tet[e][k];
        const double *w = &v.w[3 * (v.c.ntet ? 4 * e + k : n)];
        for (int c = 0; c < 3; c++) assert_close(w[c], v.u[n][c], 0, 1e-13);
      }
    drop_view(&v);
  }
}

/* g . L u = u . L' g */
static void forces_are_transposed(void **state) {
  for (int level = 0; level < 2; level++) {
    view v = make_view(level, coupling_of(state));
    int n = 3 * v.c.nnode;
    double *g = calloc(n, sizeof *g), (*f)[4] = calloc(v.mesh->nnode, sizeof *f), right = 0;
    fill_nodal(&v, 5);
    fill_noise(n, 17, 1, g);
    corot_coarsen(&v.c, (const double(*)[4])v.u, v.mean, v.w);
    corot_coarsen_transposed(&v.c, g, v.mean, f);
    for (int k = 0; k < v.mesh->nnode; k++) right += inner(3, f[k], v.u[k]);
    assert_close(inner(n, g, v.w), right, 1e-12, 0);
    free(g), free(f);
    drop_view(&v);
  }
}

static void a_missing_middle_is_named(void **state) {
  (void)state;
  view v = make_view(0, COROT_COUPLING_NODES);
  int *parent = v.refinement->parent[0], a = parent[0], b = parent[1];
  char words[64];
  parent[1] = parent[0];
  snprintf(words, sizeof words, "level 1 has no node in the middle of nodes %d and %d", a, b);
  coarsening c;
  assert_fails(corot_coarsening_by_means(v.refinement, 0, (const int(*)[4])v.coarse->tet, &c),
               COROT_EINVAL, words);
  drop_view(&v);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(means_are_those_of_the_descendants),
      coupled_unit_test(affine_fields_are_seen_as_they_are),
      coupled_unit_test(forces_are_transposed),
      cmocka_unit_test(a_missing_middle_is_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
