/* Ten-node tets for tests: meshes that are raised and bent, and whether two meshes are the same. */
#ifndef ORDER_2_H
#define ORDER_2_H

#include <corot/mesh.h>

#include "check.h"

static inline corot_mesh *with_order(const corot_mesh *m, int order) {
  corot_mesh *out = NULL;
  assert_ok(corot_mesh_change_order(m, order, &out));
  return out;
}

/* x + c x^2 in each coordinate, which ten-node tets with straight edges follow exactly. */
static inline void bend(corot_mesh *m, const double c[3]) {
  for (int i = 0; i < m->nnode; i++)
    for (int k = 0; k < 3; k++) m->x[i][k] += c[k] * m->x[i][k] * m->x[i][k];
}

static inline void assert_same_ints(int n, const void *a, const void *b) {
  if (n > 0) assert_memory_equal(a, b, (size_t)n * sizeof(int));
}

static inline void assert_same_groups(const corot_mesh *a, const corot_mesh *b) {
  assert_int_equal(a->ngroup, b->ngroup);
  for (int g = 0; g < a->ngroup; g++) {
    const corot_group *p = &a->group[g], *q = &b->group[g];
    assert_string_equal(p->name, q->name);
    assert_int_equal(p->nnode, q->nnode);
    assert_int_equal(p->ntri, q->ntri);
    assert_int_equal(p->ntet, q->ntet);
    assert_same_ints(p->nnode, p->node, q->node);
    assert_same_ints(3 * p->ntri, p->tri, q->tri);
    assert_same_ints(p->ntet, p->tet, q->tet);
  }
}

/* To the last bit. */
static inline void assert_same(const corot_mesh *a, const corot_mesh *b) {
  assert_int_equal(a->nnode, b->nnode);
  assert_int_equal(a->ntet, b->ntet);
  assert_int_equal(corot_mesh_order(a), corot_mesh_order(b));
  assert_memory_equal(a->x, b->x, (size_t)a->nnode * sizeof *a->x);
  assert_same_ints(4 * a->ntet, a->tet, b->tet);
  if (a->mid) assert_same_ints(6 * a->ntet, a->mid, b->mid);
  assert_same_groups(a, b);
}

#endif
