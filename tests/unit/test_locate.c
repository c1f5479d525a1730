/* Where points are in a mesh: in each tet, on nodes, edges and faces, and outside. */
#include <corot/mesh.h>

#include "check.h"
#include "core/mesh/mesh.h"
#include "order_2.h"
#include "solid.h"

static corot_mesh *box(int order) {
  corot_box b = {.size = {1, 0.8, 1.5}, .cells = {2, 2, 3}, .origin = {-0.3, 0.2, 4}};
  corot_mesh *mesh;
  b.split = COROT_BOX_SYMMETRIC;
  assert_ok(corot_mesh_box(&b, &mesh));
  return order == 1 ? mesh : given_order(mesh, order);
}

/* Curved tets: the nodes on edges are off by up to a tenth of a cell, as far as tets stay sound. */
static corot_mesh *curved(void) {
  corot_mesh *mesh = box(2);
  uint64_t seed = 5;
  char *seen = calloc((size_t)mesh->nnode, 1);
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 6; k++)
      if (!seen[mesh->mid[e][k]]++)
        for (int c = 0; c < 3; c++) mesh->x[mesh->mid[e][k]][c] += 0.03 * noise(&seed);
  free(seen);
  return mesh;
}

static void random_inside(uint64_t *seed, double l[4]) {
  double sum = 0;
  for (int a = 0; a < 4; a++) l[a] = 1.05 + noise(seed), sum += l[a];
  for (int a = 0; a < 4; a++) l[a] /= sum;
}

static void assert_sound(const corot_mesh *mesh, const corot_location *at) {
  double sum = 0, x[3] = {0};
  for (int k = 0; k < at->nnode; k++) {
    sum += at->weight[k];
    for (int c = 0; c < 3; c++) x[c] += at->weight[k] * mesh->x[at->node[k]][c];
  }
  assert_close(sum, 1, 1e-14, 0);
  /* rounding of coordinates of up to 6 */
  for (int c = 0; c < 3; c++) assert_close(x[c], at->x[c], 0, 1e-14);
}

/* The tet and the volume coordinates a point was made from are found again, and with them the value
   of any field of the nodes. Tolerance: rounding of positions of up to 6, over heights of tets of a
   fifth. */
static void each_tet_finds_its_points(void **state) {
  (void)state;
  for (int kind = 0; kind < 3; kind++) {
    corot_mesh *mesh = kind < 2 ? box(kind + 1) : curved();
    uint64_t seed = 7;
    for (int e = 0; e < mesh->ntet; e++) {
      corot_location made = {.tet = e}, found;
      random_inside(&seed, made.at);
      corot_location_weigh(mesh, &made);
      assert_ok(corot_mesh_locate(mesh, made.x, &found));
      assert_int_equal(found.tet, e);
      assert_int_equal(found.nnode, kind == 0 ? 4 : 10);
      assert_close(found.distance, 0, 0, 0);
      for (int a = 0; a < 4; a++) assert_close(found.at[a], made.at[a], 0, 1e-13);
      for (int k = 0; k < found.nnode; k++) {
        assert_int_equal(found.node[k], made.node[k]);
        assert_close(found.weight[k], made.weight[k], 0, 1e-12);
      }
      assert_sound(mesh, &found);
    }
    corot_mesh_destroy(mesh);
  }
}

/* A linear field from the nodes of linear tets, a quadratic one from those of straight ten-node
   tets, is what it is at any point; and a linear one in curved tets, too. */
static void fields_that_tets_hold_are_exact(void **state) {
  (void)state;
  for (int kind = 0; kind < 3; kind++) {
    corot_mesh *mesh = kind < 2 ? box(kind + 1) : curved();
    uint64_t seed = 11;
    for (int i = 0; i < 200; i++) {
      const double p[3] = {0.2 + 0.45 * noise(&seed), 0.6 + 0.35 * noise(&seed),
                           4.75 + 0.7 * noise(&seed)};
      corot_location at;
      double sum = 0;
      assert_ok(corot_mesh_locate(mesh, p, &at));
      assert_close(at.distance, 0, 0, 0);
      for (int k = 0; k < at.nnode; k++) {
        const double *x = mesh->x[at.node[k]];
        double curved_part = kind == 1 ? x[0] * x[1] - 3 * x[2] * x[2] : 0;
        sum += at.weight[k] * (2 + x[0] - 4 * x[1] + x[2] + curved_part);
      }
      double curved_part = kind == 1 ? p[0] * p[1] - 3 * p[2] * p[2] : 0;
      assert_close(sum, 2 + p[0] - 4 * p[1] + p[2] + curved_part, 1e-13, 1e-13);
    }
    corot_mesh_destroy(mesh);
  }
}

static void a_node_is_itself(void **state) {
  (void)state;
  for (int kind = 0; kind < 3; kind++) {
    corot_mesh *mesh = kind < 2 ? box(kind + 1) : curved();
    for (int n = 0; n < mesh->nnode; n++) {
      corot_location at, other = {0};
      const double near[3] = {mesh->x[n][0] + 1e-12, mesh->x[n][1], mesh->x[n][2] - 1e-12};
      assert_ok(corot_mesh_locate(mesh, near, &at));
      assert_int_equal(at.nnode, 1);
      assert_int_equal(at.node[0], n);
      assert_close(at.weight[0], 1, 0, 0);
      assert_close(at.distance, 0, 0, 0);
      other.tet = at.tet;
      memcpy(other.at, at.at, sizeof other.at);
      corot_location_weigh(mesh, &other); /* its volume coordinates lead to it, too */
      for (int c = 0; c < 3; c++) assert_close(other.x[c], mesh->x[n][c], 0, 1e-14);
    }
    corot_mesh_destroy(mesh);
  }
}

/* On the face of two tets, or on an edge, rounding does not lose the point. */
static void points_between_tets_are_found(void **state) {
  (void)state;
  for (int kind = 0; kind < 3; kind++) {
    corot_mesh *mesh = kind < 2 ? box(kind + 1) : curved();
    for (int e = 0; e < mesh->ntet; e++)
      for (int side = 0; side < 10; side++) {
        corot_location made = {.tet = e}, found;
        for (int a = 0; a < 4; a++) made.at[a] = a == side ? 0 : 1.0 / 3;
        if (side >= 4)
          for (int a = 0; a < 4; a++)
            made.at[a] = a == corot_tet_edge[side - 4][0]   ? 0.3
                         : a == corot_tet_edge[side - 4][1] ? 0.7
                                                            : 0;
        corot_location_weigh(mesh, &made);
        assert_ok(corot_mesh_locate(mesh, made.x, &found));
        for (int c = 0; c < 3; c++) assert_close(found.x[c], made.x[c], 0, 1e-13);
        assert_sound(mesh, &found);
      }
    corot_mesh_destroy(mesh);
  }
}

/* Of a box the nearest point is known: each coordinate held to its range. The tolerance is that of
   a point on an edge. */
static void outside_it_is_the_nearest_point(void **state) {
  (void)state;
  const double min[3] = {-0.3, 0.2, 4}, max[3] = {0.7, 1.0, 5.5};
  for (int order = 1; order <= 2; order++) {
    corot_mesh *mesh = box(order);
    uint64_t seed = 3;
    for (int i = 0; i < 100; i++) {
      double p[3], square = 0;
      corot_location at;
      for (int c = 0; c < 3; c++) {
        p[c] = 0.5 * (min[c] + max[c]) + 1.5 * noise(&seed);
        double d = p[c] - fmin(fmax(p[c], min[c]), max[c]);
        square += d * d;
      }
      assert_ok(corot_mesh_locate(mesh, p, &at));
      assert_close(at.distance, sqrt(square), 1e-12, 0);
      for (int c = 0; c < 3; c++) assert_close(at.x[c], fmin(fmax(p[c], min[c]), max[c]), 0, 2e-8);
      assert_sound(mesh, &at);
    }
    corot_mesh_destroy(mesh);
  }
}

/* Of curved faces, as near as the nearest of many points of them. */
static void a_curved_surface_is_approached(void **state) {
  (void)state;
  corot_mesh *mesh = curved();
  corot_face *face;
  assert_ok(corot_faces_sort(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &face));
  uint64_t seed = 13;
  for (int i = 0; i < 5; i++) {
    const double p[3] = {0.9 + 0.3 * noise(&seed), 0.6 + noise(&seed), 4.7 + noise(&seed)};
    corot_location at;
    double nearest = INFINITY;
    assert_ok(corot_mesh_locate(mesh, p, &at));
    for (int f = 0; f < 4 * mesh->ntet; f++)
      for (int j = 0; j <= 20; j++)
        for (int k = 0; j + k <= 20; k++) {
          corot_location on = {.tet = face[f].side / 4};
          const int *corner = corot_tet_face[face[f].side % 4];
          on.at[corner[0]] = j / 20.0, on.at[corner[1]] = k / 20.0;
          on.at[corner[2]] = (20 - j - k) / 20.0;
          corot_location_weigh(mesh, &on);
          double d = sqrt(pow(on.x[0] - p[0], 2) + pow(on.x[1] - p[1], 2) + pow(on.x[2] - p[2], 2));
          nearest = fmin(nearest, d);
        }
    assert_true(at.distance > 0 && at.distance <= nearest);
    assert_true(nearest - at.distance < 0.01); /* half a spacing, squared, over the distance */
  }
  free(face);
  corot_mesh_destroy(mesh);
}

static void a_point_has_to_be_finite(void **state) {
  (void)state;
  corot_mesh *mesh = box(1);
  corot_location at;
  assert_fails(corot_mesh_locate(mesh, (double[]){0, NAN, 0}, &at), COROT_EINVAL,
               "the point (0, nan, 0) is not finite");
  corot_mesh_destroy(mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_tet_finds_its_points),
      cmocka_unit_test(fields_that_tets_hold_are_exact),
      cmocka_unit_test(a_node_is_itself),
      cmocka_unit_test(points_between_tets_are_found),
      cmocka_unit_test(outside_it_is_the_nearest_point),
      cmocka_unit_test(a_curved_surface_is_approached),
      cmocka_unit_test(a_point_has_to_be_finite),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
