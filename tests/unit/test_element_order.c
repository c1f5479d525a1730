/* The order of the elements in the loop: every tet once, materials and those that stay together in
   one piece, and the tets of a node near one another however the mesh numbers its nodes. */
#include "core/element/element_order.h"

#include <stdlib.h>

#include "alloc.h"
#include "solid.h"

/* How far apart the tets of a corner are on average, as a part of the loop. */
static double reach_of(const corot_mesh *mesh, const int *order) {
  int *first = malloc(mesh->nnode * sizeof *first), *last = calloc(mesh->nnode, sizeof *last);
  double sum = 0;
  int n = 0;
  for (int i = 0; i < mesh->nnode; i++) first[i] = -1;
  for (int k = 0; k < mesh->ntet; k++)
    for (int c = 0; c < 4; c++) {
      int i = mesh->tet[order[k]][c];
      if (first[i] < 0) first[i] = k;
      last[i] = k;
    }
  for (int i = 0; i < mesh->nnode; i++)
    if (first[i] >= 0) sum += last[i] - first[i], n++;
  free(first), free(last);
  return sum / n / mesh->ntet;
}

static void assert_each_once(int n, const int *order) {
  char *seen = calloc(n, 1);
  for (int k = 0; k < n; k++) {
    assert_in_range(order[k], 0, n - 1);
    assert_int_equal(seen[order[k]]++, 0);
  }
  free(seen);
}

/* Every third tet of the first half is of another material: of any is none in the second half. */
static int *two_materials(const corot_mesh *mesh, int together) {
  int *material = calloc(mesh->ntet, sizeof *material);
  for (int e = 0; e < mesh->ntet / 2; e++) material[e] = e / together % 3 == 0;
  return material;
}

static void assert_sound(const corot_mesh *mesh, int together, double most) {
  int *material = two_materials(mesh, together), *order = malloc(mesh->ntet * sizeof *order);
  int *alone = calloc(mesh->ntet, sizeof *alone);
  assert_ok(corot_element_order(mesh, 2, material, together, order));
  assert_each_once(mesh->ntet, order);
  for (int k = 1; k < mesh->ntet; k++) {
    assert_true(material[order[k]] >= material[order[k - 1]]);
    if (order[k] % together > 0) assert_int_equal(order[k], order[k - 1] + 1);
  }
  assert_ok(corot_element_order(mesh, 1, alone, together, order));
  assert_each_once(mesh->ntet, order);
  assert_below(reach_of(mesh, order), most);
  free(material), free(alone), free(order);
}

/* Numbers that follow the body are left as they are; a refined mesh, whose new nodes come last, and
   one that is numbered as if at random, have their tets near one another, too. In two pieces, which
   a search finds one by one. */
static void the_tets_of_a_node_are_near(void **state) {
  (void)state;
  corot_mesh *box = linear_box(4, 4, 50), *coarse = linear_box(2, 2, 20), *fine, *ten;
  int *order = malloc(box->ntet * sizeof *order), *zero = calloc(box->ntet, sizeof *zero), low = 0;
  corot_refinement *r;
  assert_true(box->ntet > 4096);
  assert_sound(box, 1, 0.05);
  assert_ok(corot_element_order(box, 1, zero, 1, order));
  for (int k = 0; k < box->ntet; k++) { /* lowest numbers ascend */
    const int *n = box->tet[order[k]];
    int least = n[0];
    for (int c = 1; c < 4; c++) least = n[c] < least ? n[c] : least;
    assert_true(least >= low);
    low = least;
  }

  assert_ok(corot_mesh_refine(coarse, 2, COROT_DIAGONAL_CONSISTENT, &fine, &r));
  assert_sound(fine, 1, 0.05);
  assert_sound(fine, 8, 0.1);
  assert_sound(fine, 64, 0.2);
  assert_ok(corot_mesh_change_order(fine, 2, &ten));
  assert_sound(ten, 1, 0.05);

  /* numbers as if at random, and two bodies in one mesh */
  int n = box->nnode, step = 7;
  while (n % step == 0) step += 2;
  double(*x)[3] = malloc(2 * (size_t)n * sizeof *x);
  int(*tet)[4] = malloc(2 * (size_t)box->ntet * sizeof *tet);
  for (int i = 0; i < 2 * n; i++) {
    int to = (int)((long)i * step % n) * 2 + (i >= n);
    for (int c = 0; c < 3; c++) x[to][c] = box->x[i % n][c] + 5 * (i >= n);
  }
  for (int e = 0; e < 2 * box->ntet; e++)
    for (int c = 0; c < 4; c++)
      tet[e][c] = (int)((long)box->tet[e % box->ntet][c] * step % n) * 2 + (e >= box->ntet);
  corot_mesh *two;
  assert_ok(
      corot_mesh_create(2 * n, (const double(*)[3])x, 2 * box->ntet, (const int(*)[4])tet, &two));
  assert_sound(two, 1, 0.05);
  free(x), free(tet), free(order), free(zero);
  corot_mesh_destroy(two), corot_mesh_destroy(ten), corot_mesh_destroy(fine);
  corot_mesh_destroy(coarse), corot_mesh_destroy(box);
  corot_refinement_destroy(r);
}

typedef struct ordering {
  const corot_mesh *mesh;
  int *material, *order;
} ordering;

static corot_status order_it(void *of) {
  ordering *o = of;
  return corot_element_order(o->mesh, 1, o->material, 1, o->order);
}

static void memory_may_run_out(void **state) {
  (void)state;
  corot_mesh *coarse = linear_box(2, 2, 20), *fine;
  assert_ok(corot_mesh_refine(coarse, 2, COROT_DIAGONAL_CONSISTENT, &fine, NULL));
  ordering o = {fine, calloc(fine->ntet, sizeof *o.material), calloc(fine->ntet, sizeof *o.order)};
  assert_true(assert_survives_failed_allocations(order_it, &o) == 8);
  free(o.material), free(o.order);
  corot_mesh_destroy(fine), corot_mesh_destroy(coarse);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_tets_of_a_node_are_near),
      cmocka_unit_test(memory_may_run_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
