/* Parts of a body that share no node, and what nothing holds of them. */
#include "solve/statics/rigid.h"

#include "alloc.h"
#include "order_2.h"
#include "solid.h"

/* `count` unit boxes in a row, a box apart, their nodes dealt out in turn: node k of box b is node
   count * k + b. */
static corot_mesh *boxes(int count) {
  corot_box box = {.size = {1, 1, 1}, .cells = {1, 1, 1}};
  corot_mesh *one, *all;
  assert_ok(corot_mesh_box(&box, &one));
  double(*x)[3] = malloc(count * one->nnode * sizeof *x);
  int(*tet)[4] = malloc(count * one->ntet * sizeof *tet);
  for (int b = 0; b < count; b++) {
    for (int n = 0; n < one->nnode; n++) {
      memcpy(x[count * n + b], one->x[n], sizeof *x);
      x[count * n + b][0] += 2 * b;
    }
    for (int e = 0; e < one->ntet; e++)
      for (int a = 0; a < 4; a++) tet[b * one->ntet + e][a] = count * one->tet[e][a] + b;
  }
  assert_ok(corot_mesh_create(count * one->nnode, (const double(*)[3])x, count * one->ntet,
                              (const int(*)[4])tet, &all));
  corot_mesh_destroy(one);
  free(x);
  free(tet);
  return all;
}

static void parts_have_their_nodes(void **state) {
  (void)state;
  for (int count = 1; count < 5; count++) {
    corot_mesh *mesh = boxes(count);
    corot_part *part;
    int npart;
    assert_ok(corot_mesh_parts(mesh, &npart, &part));
    assert_int_equal(npart, count);
    for (int k = 0; k < npart; k++) {
      assert_int_equal(part[k].first, k);
      assert_int_equal(part[k].nnode, 8);
      assert_int_equal(part[k].nfree, 0);
      assert_string_equal(part[k].can, "");
    }
    free(part);
    corot_mesh_destroy(mesh);
  }
}

/* Of order 2, too, where each cube has 8 corners and 19 edges. */
static void nodes_on_edges_belong_to_their_parts(void **state) {
  (void)state;
  corot_mesh *linear = boxes(3), *mesh = with_order(linear, 2);
  corot_part *part;
  int npart;
  assert_ok(corot_mesh_parts(mesh, &npart, &part));
  assert_int_equal(npart, 3);
  for (int k = 0; k < npart; k++) {
    assert_int_equal(part[k].first, k);
    assert_int_equal(part[k].nnode, 27);
  }
  free(part);
  corot_mesh_destroy(linear);
  corot_mesh_destroy(mesh);
}

/* Tets that share an edge or a node only are one part. */
static void a_node_joins(void **state) {
  (void)state;
  const double x[7][3] = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                          {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  const int tet[2][4] = {{0, 1, 2, 3}, {0, 4, 6, 5}};
  corot_mesh *mesh;
  corot_part *part;
  int npart;
  assert_ok(corot_mesh_create(7, x, 2, tet, &mesh));
  assert_ok(corot_mesh_parts(mesh, &npart, &part));
  assert_int_equal(npart, 1);
  assert_int_equal(part[0].nnode, 7);
  free(part);
  corot_mesh_destroy(mesh);
}

/* The second of three boxes is held by a face, the third by an edge, about which it can turn. */
static body three_boxes(void) {
  corot_mesh *mesh = boxes(3);
  double face[2][3] = {{2, 0, 0}, {2, 1, 1}}, edge[2][3] = {{4, 0, 0}, {4, 0, 1}};
  assert_ok(corot_mesh_group_box(mesh, "face", face[0], face[1], 0));
  assert_ok(corot_mesh_group_box(mesh, "edge", edge[0], edge[1], 0));
  corot_fix fix[] = {{"face", {true, true, true}}, {"edge", {true, true, true}}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  def.nfix = 2, def.fix = fix;
  return make_body(mesh, def);
}

static void supports_hold_their_part(void **state) {
  (void)state;
  static const struct {
    int nfree;
    const char *can;
  } expected[] = {
      {6, "move along x, y and z and turn about x, y and z"}, {0, ""}, {1, "turn about z"}};
  body b = three_boxes();
  corot_part *part;
  int npart;
  assert_ok(corot_model_parts(b.model, &npart, &part));
  assert_int_equal(npart, 3);
  for (int k = 0; k < 3; k++) {
    assert_int_equal(part[k].nfree, expected[k].nfree);
    assert_string_equal(part[k].can, expected[k].can);
  }
  free(part);
  assert_fails(corot_rigid_check(b.model), COROT_ESINGULAR,
               "the part of the body with node 0 (8 nodes) can move along x, y and z and turn");
  drop_body(&b);
}

static corot_status find(void *model) {
  int npart;
  corot_part *part;
  COROT_TRY(corot_model_parts(model, &npart, &part));
  free(part);
  return COROT_OK;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  body b = three_boxes();
  assert_survives_failed_allocations(find, b.model);
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parts_have_their_nodes),
      cmocka_unit_test(nodes_on_edges_belong_to_their_parts),
      cmocka_unit_test(a_node_joins),
      cmocka_unit_test(supports_hold_their_part),
      cmocka_unit_test(failed_allocations_are_survived),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
