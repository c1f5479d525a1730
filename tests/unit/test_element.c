/* The rows of the kinds of elements, and what the elements of a mesh make of them. */
#include <stdlib.h>

#include "core/element/tets.h"
#include "core/mesh/mesh.h"
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

static element_set elements_of(const corot_mesh *mesh) {
  int *of_tet = calloc(mesh->ntet, sizeof *of_tet);
  element_set e;
  for (int t = 0; t < mesh->ntet; t++) of_tet[t] = t % 3;
  assert_ok(corot_tets_create(mesh, 3, of_tet, 1, false, &e));
  free(of_tet);
  return e;
}

/* The gradient of a nodal field [nnode][3] at a point, by the set's own gradients. */
static void gradient_at(const element_set *e, int b, int q, int l, const double (*field)[3],
                        double G[9]) {
  memset(G, 0, 9 * sizeof *G);
  for (int a = 1; a < e->kind->nnode; a++) {
    const double *y = field[nodes_at(e, b, a)[l]], *y0 = field[nodes_at(e, b, 0)[l]];
    int at = (b * e->kind->npoint + q) * (e->kind->nnode - 1) + a - 1;
    for (int k = 0; k < 9; k++) G[k] += (y[k / 3] - y0[k / 3]) * e->slope[at][k % 3][l];
  }
}

/* On meshes without two tets alike: the gradients at each point are those of any affine field,
   whether edges are curved or not. */
static void affine_fields_have_their_gradients(void **state) {
  (void)state;
  for (int bent = 0; bent < 2; bent++) {
    corot_mesh *mesh = bent ? crooked_box(3, 2, 2) : straight_box(3, 2, 2);
    element_set e = elements_of(mesh);
    double A[9], (*field)[3] = malloc(mesh->nnode * sizeof *field);
    uint64_t seed = 3;
    random_gradient(&seed, 1, A);
    for (int n = 0; n < mesh->nnode; n++) apply(A, mesh->x[n], field[n]);
    for (int b = 0; b < e.nblock; b++)
      for (int q = 0; q < e.kind->npoint; q++)
        for (int l = 0; l < W; l++) {
          double G[9];
          gradient_at(&e, b, q, l, (const double(*)[3])field, G);
          assert_below(distance(G, A), 1e-12);
        }
    free(field), corot_tets_clear(&e), corot_mesh_destroy(mesh);
  }
}

/* The sum of the weights less the volume, which a mesh integrates exactly. */
static double volume_error(const corot_mesh *mesh) {
  element_set e = elements_of(mesh);
  double sum = 0;
  for (int b = 0; b < e.nblock; b++)
    for (int l = 0; l < e.block[b].n; l++) sum += volume_at(&e, b, l);
  corot_tets_clear(&e);
  return sum - corot_mesh_measure(mesh).volume;
}

/* Where edges are straight, and where all offsets of an element are in one plane; of others the
   error is of third order in the offsets. */
static void weights_sum_to_the_volume(void **state) {
  (void)state;
  corot_mesh *straight = straight_box(3, 2, 2), *bent = straight_box(3, 2, 2);
  assert_close(volume_error(straight), 0, 0, 1e-13);
  double error[2];
  for (int k = 0; k < 2 && order_of_test() > 1; k++) {
    bend_edges(bent, 0.005); /* once, and as far again */
    error[k] = volume_error(bent);
  }
  if (order_of_test() > 1) assert_close(error[1] / error[0], 8, 1e-6, 0);
  for (int n = 0; n < bent->nnode; n++) bent->x[n][2] = straight->x[n][2];
  assert_close(volume_error(bent), 0, 0, 1e-13);
  corot_mesh_destroy(straight), corot_mesh_destroy(bent);
}

/* The four volume coordinates of the points that belong to a lane, of its corners ascending. */
static void coordinates_of(const element_kind *kind, int q, double L[4]) {
  for (int i = 0; i < 4; i++) L[i] = kind->order == 1 ? 0.25 : i == q ? TET10_A : TET10_B;
}

/* A field that is quadratic in the volume coordinates of a tet, at the nodes of one element: its
   gradient at each point is that of the polynomial, by the map from the reference element, where
   edges are curved too. Of linear elements the field is linear. */
static void fields_of_the_order_have_their_gradients(void **state) {
  (void)state;
  corot_mesh *mesh = crooked_box(2, 2, 2);
  element_set e = elements_of(mesh);
  double(*field)[3] = calloc(mesh->nnode, sizeof *field);
  double square = order_of_test() - 1;
  for (int b = 0; b < e.nblock; b++)
    for (int l = 0; l < e.block[b].n; l++) {
      int node[KIND_NODES];
      corot_tets_nodes(mesh, e.number[b * W + l], node);
      for (int a = 0; a < e.kind->nnode; a++) { /* f = L1 + 2 L2 - L3 + L1 L2 - 3 L3^2 + L0 L3 */
        double L[4] = {0};
        if (a < 4) L[a] = 1;
        if (a >= 4) L[corot_tet_edge[a - 4][0]] = L[corot_tet_edge[a - 4][1]] = 0.5;
        double quadratic = L[1] * L[2] - 3 * L[3] * L[3] + L[0] * L[3];
        field[node[a]][0] = L[1] + 2 * L[2] - L[3] + square * quadratic;
      }
      for (int q = 0; q < e.kind->npoint; q++) {
        double L[4], G[9], J[9];
        coordinates_of(e.kind, q, L);
        gradient_at(&e, b, q, l, (const double(*)[3])field, G);
        /* dx/dL by differences of the quadratic map, which central ones give exactly */
        for (int c = 0; c < 3; c++)
          for (int i = 0; i < 3; i++) {
            J[3 * c + i] = 0;
            for (int s = -1; s < 2; s += 2) {
              double M[4] = {L[0], L[1], L[2], L[3]}, x = 0;
              M[i + 1] += 0.5 * s, M[0] -= 0.5 * s;
              for (int a = 0; a < e.kind->nnode; a++) {
                int m = a < 4 ? a : corot_tet_edge[a - 4][0],
                    n = a < 4 ? a : corot_tet_edge[a - 4][1];
                double N = a >= 4 ? 4 * M[m] * M[n] : square ? M[a] * (2 * M[a] - 1) : M[a];
                x += N * mesh->x[node[a]][c];
              }
              J[3 * c + i] += s * x;
            }
          }
        double slope[3] = {1 + square * (L[2] - L[3]), 2 + square * (L[1] - L[3]),
                           -1 + square * (L[0] - 7 * L[3])};
        for (int i = 0; i < 3; i++) {
          double sum = 0;
          for (int c = 0; c < 3; c++) sum += G[c] * J[3 * c + i];
          assert_close(sum, slope[i], 0, 1e-12);
        }
      }
    }
  free(field), corot_tets_clear(&e), corot_mesh_destroy(mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shares_sum_to_one),
      cmocka_unit_test(pairs_are_complete),
      cmocka_unit_test(affine_fields_have_their_gradients),
      cmocka_unit_test(weights_sum_to_the_volume),
      cmocka_unit_test(fields_of_the_order_have_their_gradients),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
