/* How coarser levels see a field: L against the means it stands for, and L' against L. */
#include <stdio.h>

#include "core/system/coarsening.h"
#include "hierarchical.h"

/* Two levels, and a map from the finest to `level`. */
typedef struct view {
  corot_mesh *mesh, *part; /* the finest, and that of `level` as L sees it */
  corot_refinement *refinement;
  coarsening c;
  double (*u)[4], (*w)[4]; /* of the finest, and of the part */
} view;

typedef corot_status make_coarsening(const corot_mesh *fine, const corot_refinement *r, int level,
                                     coarsening *c, corot_mesh **mesh);

static make_coarsening *maker(corot_coupling coupling) {
  return coupling == COROT_COUPLING_MEAN ? corot_coarsening_by_means : corot_coarsening_by_values;
}

/* `raised`: the second level is that of ten-node tets. */
static view make_view(int level, corot_coupling coupling, bool raised) {
  view v = {0};
  corot_mesh *box = crooked_box(2, 1, 1);
  refine_to(&(choice){.nlevel = raised ? 1 : 2, .raised = raised}, box, &v.mesh, &v.refinement);
  corot_mesh_destroy(box);
  assert_ok(maker(coupling)(v.mesh, v.refinement, level, &v.c, &v.part));
  assert_int_equal(v.c.nnode, v.part->nnode);
  v.u = calloc(v.mesh->nnode, sizeof *v.u);
  v.w = calloc(v.c.nnode, sizeof *v.w);
  return v;
}

static void coarsen(const view *v) { corot_coarsen(&v->c, (const double(*)[4])v->u, v->w); }

static void drop_view(view *v) {
  corot_coarsening_clear(&v->c);
  corot_refinement_destroy(v->refinement);
  corot_mesh_destroy(v->part);
  corot_mesh_destroy(v->mesh);
  free(v->u), free(v->w);
}

static void fill_nodal(const view *v, uint64_t seed) {
  for (int n = 0; n < v->mesh->nnode; n++)
    for (int c = 0; c < 3; c++) v->u[n][c] = noise(&seed);
}

/* G = sum of V grad over the tet with corners x and values w, in the order of faces and of their
   nodes: V grad is the sum over the faces of mean value times area vector. The mean is that of the
   corners, or of the middles of the edges for a field that is quadratic on the face. */
static const int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}; /* outward */
static const int edges_of[4][3] = {{1, 5, 4}, {3, 5, 2}, {0, 4, 3}, {2, 1, 0}};

static void add_gradient(const double *const x[4], const double *const w[4][3], double G[9]) {
  for (int f = 0; f < 4; f++) {
    const int *v = face[f];
    double a[3], b[3];
    for (int c = 0; c < 3; c++) a[c] = x[v[1]][c] - x[v[0]][c], b[c] = x[v[2]][c] - x[v[0]][c];
    double area[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                      a[0] * b[1] - a[1] * b[0]};
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        G[3 * i + j] += (w[f][0][i] + w[f][1][i] + w[f][2][i]) / 3 * area[j] / 2;
  }
}

/* Of tet e of a mesh with the values u. */
static void add_gradient_of(const corot_mesh *m, int e, const double (*u)[4], double G[9]) {
  const double *x[4], *w[4][3];
  for (int k = 0; k < 4; k++) x[k] = m->x[m->tet[e][k]];
  for (int f = 0; f < 4; f++)
    for (int a = 0; a < 3; a++)
      w[f][a] = u[m->mid ? m->mid[e][edges_of[f][a]] : m->tet[e][face[f][a]]];
  add_gradient(x, w, G);
}

static void assert_means(bool raised) {
  for (int level = 0; level < 2; level++) {
    view v = make_view(level, COROT_COUPLING_MEAN, raised);
    int below = v.mesh->ntet / v.part->ntet;
    fill_nodal(&v, 3);
    coarsen(&v);
    for (int e = 0; e < v.part->ntet; e++) {
      double found[9] = {0}, expected[9] = {0};
      add_gradient_of(v.part, e, (const double(*)[4])v.w, found);
      for (int k = 0; k < 9; k++) found[k] *= -v.c.volume; /* its volume is minus a 27th */
      for (int d = below * e; d < below * (e + 1); d++)
        add_gradient_of(v.mesh, d, (const double(*)[4])v.u, expected);
      assert_below(distance(found, expected), 1e-14); /* values and areas are of the order of one */
    }
    drop_view(&v);
  }
}

static void means_are_those_of_the_descendants(void **state) {
  (void)state;
  assert_means(false);
  assert_means(true);
}

/* An affine field has its own values at the part's nodes, whichever they are. */
static void affine_fields_are_seen_as_they_are(void **state) {
  for (int k = 0; k < 4; k++) {
    view v = make_view(k / 2, coupling_of(state), k % 2);
    uint64_t seed = 11;
    double A[9];
    random_gradient(&seed, 1, A);
    for (int n = 0; n < v.mesh->nnode; n++) apply(A, v.mesh->x[n], v.u[n]);
    coarsen(&v);
    for (int n = 0; n < v.part->nnode; n++) {
      double expected[3];
      apply(A, v.part->x[n], expected);
      for (int c = 0; c < 3; c++) assert_close(v.w[n][c], expected[c], 0, 1e-14);
    }
    drop_view(&v);
  }
}

/* g . L u = u . L' g */
static void forces_are_transposed(void **state) {
  for (int which = 0; which < 4; which++) {
    view v = make_view(which / 2, coupling_of(state), which % 2);
    int n = v.c.nnode;
    double(*g)[4] = calloc(n, sizeof *g), (*f)[4] = calloc(v.mesh->nnode, sizeof *f);
    double left = 0, right = 0;
    fill_nodal(&v, 5);
    fill_noise(4 * n, 17, 1, g[0]);
    coarsen(&v);
    corot_coarsen_transposed(&v.c, (const double(*)[4])g, f);
    for (int k = 0; k < n; k++) left += inner(3, g[k], v.w[k]);
    for (int k = 0; k < v.mesh->nnode; k++) right += inner(3, f[k], v.u[k]);
    assert_close(left, right, 1e-12, 0);
    free(g), free(f);
    drop_view(&v);
  }
}

static void a_missing_middle_is_named(void **state) {
  (void)state;
  view v = make_view(0, COROT_COUPLING_NODES, false);
  int *parent = v.refinement->parent[0], a = parent[0], b = parent[1];
  char words[64];
  coarsening c;
  corot_mesh *part;
  parent[1] = parent[0];
  snprintf(words, sizeof words, "level 1 has no node in the middle of nodes %d and %d", a, b);
  assert_fails(corot_coarsening_by_means(v.mesh, v.refinement, 0, &c, &part), COROT_EINVAL, words);
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
