/* The rows of the kinds of elements, and what the elements of a mesh make of them. */
#include <stdlib.h>

#include "core/element/tets.h"
#include "solid.h"

static const element_kind *each_kind(int k) { return &element_kinds[k]; }

/* Parts of the volume, of the mass and of the lumped mass sum to one; the mass is symmetric, and a
   row of it sums to the lumped share; or else the shares are to each other as the diagonal is. */
static void shares_sum_to_one(void **state) {
  (void)state;
  for (int k = 0; k < NKIND; k++) {
    const element_kind *kind = each_kind(k);
    double part = 0;
    int mass = 0, lumped = 0;
    for (int q = 0; q < kind->npoint; q++) part += kind->part[q];
    for (int a = 0; a < kind->nnode; a++) {
      int row = 0;
      for (int b = 0; b < kind->nnode; b++) {
        row += kind->mass[a][b];
        assert_int_equal(kind->mass[a][b], kind->mass[b][a]);
      }
      if (kind->order == 1)
        assert_int_equal(row * kind->lumped_over, kind->lumped[a] * kind->mass_over);
      assert_int_equal(kind->lumped[a] * kind->mass[0][0], kind->lumped[0] * kind->mass[a][a]);
      mass += row;
      lumped += kind->lumped[a];
    }
    assert_close(part, 1, 1e-15, 0);
    assert_int_equal(mass, kind->mass_over);
    assert_int_equal(lumped, kind->lumped_over);
  }
}

/* Every two nodes are a pair once, the later one first. */
static void pairs_are_complete(void **state) {
  (void)state;
  for (int k = 0; k < NKIND; k++) {
    const element_kind *kind = each_kind(k);
    int seen[KIND_NODES][KIND_NODES] = {{0}};
    assert_int_equal(kind->npair, kind->nnode * (kind->nnode - 1) / 2);
    for (int i = 0; i < kind->npair; i++) seen[kind->pair[i][0]][kind->pair[i][1]]++;
    for (int a = 0; a < kind->nnode; a++)
      for (int b = 0; b < kind->nnode; b++) assert_int_equal(seen[a][b], b < a);
  }
}

/* On a mesh without two tets alike: the weights sum to its volume, and the gradients at each point
   are those of any affine field. */
static void affine_fields_have_their_gradients(void **state) {
  (void)state;
  corot_mesh *mesh = crooked_box(3, 2, 2);
  int *of_tet = calloc(mesh->ntet, sizeof *of_tet);
  double A[9], sum = 0;
  element_set e;
  uint64_t seed = 3;
  for (int t = 0; t < mesh->ntet; t++) of_tet[t] = t % 3;
  assert_ok(corot_tets_create(mesh, 3, of_tet, 1, false, &e));
  random_gradient(&seed, 1, A);
  for (int b = 0; b < e.nblock; b++)
    for (int q = 0; q < e.kind->npoint; q++)
      for (int l = 0; l < W; l++) {
        double G[9] = {0};
        for (int a = 1; a < e.kind->nnode; a++)
          for (int k = 0; k < 9; k++) {
            const double *x = mesh->x[nodes_at(&e, b, a)[l]], *x0 = mesh->x[nodes_at(&e, b, 0)[l]];
            double d[3] = {x[0] - x0[0], x[1] - x0[1], x[2] - x0[2]}, change[3];
            int at = (b * e.kind->npoint + q) * (e.kind->nnode - 1) + a - 1;
            apply(A, d, change);
            G[k] += change[k / 3] * e.slope[at][k % 3][l];
          }
        assert_below(distance(G, A), 1e-12);
        sum += e.weight[b * e.kind->npoint + q][l];
      }
  assert_close(sum, corot_mesh_measure(mesh).volume, 1e-13, 0);
  corot_tets_clear(&e);
  corot_mesh_destroy(mesh);
  free(of_tet);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shares_sum_to_one),
      cmocka_unit_test(pairs_are_complete),
      cmocka_unit_test(affine_fields_have_their_gradients),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
