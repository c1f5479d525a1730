/* Local refinement: faces that match, volumes, groups, shapes after many passes, curved edges. */
#include <corot/mesh.h>
#include <stdio.h>

#include "alloc.h"
#include "check.h"
#include "core/mesh/mesh.h"
#include "order_2.h"
#include "solid.h"

static corot_mesh *refined(const corot_mesh *m, int nmark, const int *mark, int **parent) {
  corot_mesh *fine = NULL;
  assert_ok(corot_mesh_refine_marked(m, nmark, mark, &fine, parent));
  return fine;
}

static corot_mesh *read_model(const char *name) {
  char path[256];
  corot_mesh *m = NULL;
  snprintf(path, sizeof path, SOURCE_DIR "/models/%s.msh", name);
  assert_ok(corot_mesh_read(path, &m));
  return m;
}

/* From (-1, 0, 5) to (0, 2, 8), cells four times as long as wide, with groups of tets, faces,
 * nodes. */
static corot_mesh *make_box(corot_box_split split) {
  const corot_box box = {{1, 2, 3}, {2, 1, 2}, {-1, 0, 5}, split};
  const double min[3] = {-1, 0, 5}, max[3] = {-0.5, 2, 6.5};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  assert_ok(corot_mesh_group_box(m, "cells", min, max, 0));
  assert_ok(corot_mesh_group_plane(m, "section", 2, 6.5, 0));
  assert_ok(corot_mesh_group_nodes(m, "some", 4, (int[]){0, 1, 4, 9}));
  return m;
}

static corot_mesh *make_cubes(void) {
  const corot_box box = {{2, 2, 2}, {2, 2, 2}, {0}, COROT_BOX_KUHN};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  return m;
}

/* A mesh each for small numbers; NULL: no more. */
static corot_mesh *mesh_of(int kind) {
  static const char *const file[] = {"bar/bar", "liver/liver", "benchmarks/bracket",
                                     "benchmarks/tube"};
  if (kind < 3) return make_box((corot_box_split)kind);
  if (kind == 3) return make_cubes();
  if (kind < 8) return read_model(file[kind - 4]);
  if (kind > 8) return NULL;
  corot_mesh *box = make_box(COROT_BOX_SYMMETRIC), *m = with_order(box, 2);
  corot_mesh_destroy(box);
  return m;
}

/* --- What to mark --- */

/* mark [m->ntet]; the value is how many. */
static int mark_some(const corot_mesh *m, double share, uint64_t *seed, int *mark) {
  int n = 0;
  for (int e = 0; e < m->ntet; e++)
    if (noise(seed) < 2 * share - 1) mark[n++] = e; /* noise is in -1 to 1 */
  return n;
}

static int mark_around(const corot_mesh *m, int node, int *mark) {
  int n = 0;
  for (int e = 0; e < m->ntet; e++)
    for (int k = 0; k < 4; k++)
      if (m->tet[e][k] == node) mark[n++] = e;
  return n;
}

/* The tets with a node on the line through the corner `from` along z. */
static int mark_along(const corot_mesh *m, const double from[3], int *mark) {
  int n = 0;
  for (int e = 0; e < m->ntet; e++) {
    bool touches = false;
    for (int k = 0; k < 4; k++) {
      const double *x = m->x[m->tet[e][k]];
      touches |= fabs(x[0] - from[0]) + fabs(x[1] - from[1]) < 1e-12;
    }
    if (touches) mark[n++] = e;
  }
  return n;
}

static int *room_for_marks(const corot_mesh *m) {
  int *mark = malloc((size_t)m->ntet * sizeof *mark);
  assert_non_null(mark);
  return mark;
}

/* --- What has to hold --- */

static double area_of(const corot_mesh *m, int ntri, const int (*tri)[3]) {
  double sum = 0;
  for (int t = 0; t < ntri; t++) {
    const double *o = m->x[tri[t][0]], *p = m->x[tri[t][1]], *q = m->x[tri[t][2]];
    double c[3];
    for (int k = 0; k < 3; k++) {
      int i = (k + 1) % 3, j = (k + 2) % 3;
      c[k] = (p[i] - o[i]) * (q[j] - o[j]) - (p[j] - o[j]) * (q[i] - o[i]);
    }
    sum += sqrt(inner(3, c, c)) / 2;
  }
  return sum;
}

static double area_of_boundary(const corot_mesh *m) {
  int ntri, (*tri)[3];
  assert_ok(corot_mesh_boundary(m, &ntri, &tri));
  double area = area_of(m, ntri, (const int(*)[3])tri);
  free(tri);
  return area;
}

/* What corot_mesh_create checks. */
static void assert_sound(const corot_mesh *m) {
  corot_mesh *again = NULL;
  const double(*x)[3] = (const double(*)[3])m->x;
  int(*node)[10] = malloc((size_t)m->ntet * sizeof *node);
  assert_non_null(node);
  for (int e = 0; m->mid && e < m->ntet; e++) {
    memcpy(node[e], m->tet[e], sizeof *m->tet);
    memcpy(node[e] + 4, m->mid[e], sizeof *m->mid);
  }
  if (m->mid)
    assert_ok(corot_mesh_create_order_2(m->nnode, x, m->ntet, (const int(*)[10])node, &again));
  else
    assert_ok(corot_mesh_create(m->nnode, x, m->ntet, (const int(*)[4])m->tet, &again));
  free(node);
  corot_mesh_destroy(again);
}

/* The parts of a tet stand together, fill it, and are eight or more of a marked one; a tet that is
   not cut is unchanged. Sums of up to some hundred volumes are rounded. */
static void assert_parts(const corot_mesh *m, const corot_mesh *fine, int nmark, const int *mark,
                         const int *parent) {
  char *marked = calloc((size_t)m->ntet, 1);
  assert_non_null(marked);
  for (int i = 0; i < nmark; i++) marked[mark[i]] = 1;
  for (int e = 0, c = 0; e < m->ntet; e++) {
    double volume = 0, whole = corot_mesh_volume_of(m, e), most = 0;
    int first = c;
    for (; c < fine->ntet && parent[c] == e; c++) {
      volume += corot_mesh_volume_of(fine, c);
      most = fmax(most, corot_mesh_volume_of(fine, c));
    }
    assert_true(c > first);
    assert_close(volume, whole, 1e-11, 0);
    if (c == first + 1) assert_memory_equal(fine->tet[first], m->tet[e], sizeof *m->tet);
    if (marked[e]) assert_true(c - first >= 8);
    if (marked[e] && !m->mid) assert_below(most, whole / 8 * (1 + 1e-11));
    if (e == m->ntet - 1) assert_int_equal(c, fine->ntet);
  }
  free(marked);
}

/* Where order 2 has curved triangles, those of the corners change their area. */
static void assert_same_extent(const corot_mesh *m, const corot_mesh *fine, bool curved) {
  assert_int_equal(fine->ngroup, m->ngroup);
  for (int g = 0; g < m->ngroup; g++) {
    const corot_group *p = &m->group[g], *q = &fine->group[g];
    double before = 0, after = 0;
    assert_string_equal(p->name, q->name);
    for (int i = 0; i < p->ntet; i++) before += corot_mesh_volume_of(m, p->tet[i]);
    for (int i = 0; i < q->ntet; i++) after += corot_mesh_volume_of(fine, q->tet[i]);
    assert_close(after, before, 1e-12, 0);
    if (!curved)
      assert_close(area_of(fine, q->ntri, (const int(*)[3])q->tri),
                   area_of(m, p->ntri, (const int(*)[3])p->tri), 1e-12, 0);
    for (int i = 1; i < q->nnode; i++) assert_true(q->node[i - 1] < q->node[i]);
    for (int i = 1; i < q->ntet; i++) assert_true(q->tet[i - 1] < q->tet[i]);
    assert_memory_equal(q->node, p->node, (size_t)p->nnode * sizeof *p->node);
  }
}

static void tets_are_cut_and_match(void **state) {
  (void)state;
  uint64_t seed = 5;
  corot_mesh *m;
  for (int kind = 0; (m = mesh_of(kind)); kind++) {
    bool curved = kind == 7;
    for (int pass = 0; pass < 3; pass++) {
      int *mark = room_for_marks(m), n = mark_some(m, 0.1, &seed, mark), *parent = NULL;
      corot_mesh *fine = refined(m, n, mark, &parent);
      assert_sound(fine);
      assert_memory_equal(fine->x, m->x, (size_t)m->nnode * sizeof *m->x);
      assert_parts(m, fine, n, mark, parent);
      assert_same_extent(m, fine, curved);
      /* a face that does not match is none of two tets, and adds to the boundary */
      if (!curved) assert_close(area_of_boundary(fine), area_of_boundary(m), 1e-12, 0);
      free(mark), free(parent), corot_mesh_destroy(m);
      m = fine;
    }
    corot_mesh_destroy(m);
  }
}

static void order_of_the_marks_does_not_matter(void **state) {
  (void)state;
  const int mark[] = {3, 17, 40}, other[] = {40, 3, 17, 3, 40};
  for (int order = 1; order < 3; order++) {
    corot_mesh *box = make_box(COROT_BOX_SYMMETRIC), *m = with_order(box, order);
    corot_mesh *a = refined(m, 3, mark, NULL), *b = refined(m, 5, other, NULL);
    assert_same(a, b);
    corot_mesh_destroy(box), corot_mesh_destroy(m), corot_mesh_destroy(a), corot_mesh_destroy(b);
  }
}

static void nothing_marked_is_a_copy(void **state) {
  (void)state;
  corot_mesh *m;
  for (int kind = 0; (m = mesh_of(kind)); kind++) {
    int *parent = NULL;
    corot_mesh *fine = refined(m, 0, NULL, &parent);
    assert_same(m, fine);
    for (int e = 0; e < m->ntet; e++) assert_int_equal(parent[e], e);
    free(parent), corot_mesh_destroy(m), corot_mesh_destroy(fine);
  }
}

/* A file knows nothing of how its mesh came about. */
static void a_mesh_read_back_goes_on_alike(void **state) {
  (void)state;
  const int mark[] = {5, 20};
  corot_mesh *m = make_box(COROT_BOX_KUHN), *once = refined(m, 2, mark, NULL), *back = NULL;
  assert_ok(corot_mesh_write(once, BINARY_DIR "/refine_marked.msh"));
  assert_ok(corot_mesh_read(BINARY_DIR "/refine_marked.msh", &back));
  corot_mesh *a = refined(once, 2, mark, NULL), *b = refined(back, 2, mark, NULL);
  assert_same(a, b);
  corot_mesh_destroy(m), corot_mesh_destroy(once), corot_mesh_destroy(back);
  corot_mesh_destroy(a), corot_mesh_destroy(b);
}

/* By hand: round 1 cuts edge 02, the longest by sqrt 5; round 2 edge 01 of the one half and 23 of
   the other; round 3 edges 03, 13 and, of 14 and 24 that are equally long, 14, which two of the
   eight parts that were not to be cut again have, too. */
static void one_tet(void **state) {
  (void)state;
  const double x[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 0, 1}};
  const double more[6][3] = {{1, 0.5, 0},   {1, 0, 0},     {1.5, 0.5, 0.5},
                             {0.5, 0, 0.5}, {1.5, 0, 0.5}, {1.5, 0.25, 0}};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_create(4, x, 1, (const int[1][4]){{0, 1, 2, 3}}, &m));
  corot_mesh *fine = refined(m, 1, (int[]){0}, NULL);
  assert_int_equal(fine->nnode, 10);
  assert_int_equal(fine->ntet, 10);
  assert_memory_equal(fine->x, x, sizeof x);
  assert_memory_equal(fine->x + 4, more, sizeof more);
  corot_mesh_destroy(m), corot_mesh_destroy(fine);
}

/* --- Shapes --- */

/* Each pass is of as many tets as the one before it: a corner adds the same number each time, and
   shapes that have come about come again. */
static void a_corner_costs_the_same_each_time(void **state) {
  (void)state;
  corot_mesh *m;
  for (int kind = 0; (m = mesh_of(kind)); kind++) {
    corot_mesh_quality first = corot_mesh_measure(m), sixth = first, last = first;
    int corner = corot_mesh_nearest(m, first.min), ntet[13] = {m->ntet};
    while (m->mid && corner != m->tet[0][0]) corner = m->tet[0][0]; /* a corner of a tet */
    for (int pass = 1; pass <= 12; pass++) {
      int *mark = room_for_marks(m), n = mark_around(m, corner, mark);
      corot_mesh *fine = refined(m, n, mark, NULL);
      free(mark), corot_mesh_destroy(m);
      m = fine;
      ntet[pass] = m->ntet;
      last = corot_mesh_measure(m);
      if (pass == 6) sixth = last;
    }
    for (int pass = 8; pass <= 12; pass++)
      assert_true(ntet[pass] - ntet[pass - 1] <= 1.1 * (ntet[pass - 1] - ntet[pass - 2]));
    assert_above(last.shape_min, 0.2 * first.shape_min); /* 0.24 of the stretched boxes */
    /* coordinates, up to 8, are rounded, edges of 1e-4 to 1e-12 of themselves */
    if (!m->mid) assert_close(last.shape_min, sixth.shape_min, 1e-8, 0);
    assert_sound(m);
    corot_mesh_destroy(m);
  }
}

static void an_edge_keeps_its_shapes(void **state) {
  (void)state;
  corot_mesh *m;
  for (int kind = 0; (m = mesh_of(kind)); kind++) {
    corot_mesh_quality first = corot_mesh_measure(m);
    double from[3];
    memcpy(from, m->x[m->tet[0][0]], sizeof from);
    for (int pass = 1; pass <= 4; pass++) {
      int *mark = room_for_marks(m), n = mark_along(m, from, mark);
      corot_mesh *fine = refined(m, n, mark, NULL);
      free(mark), corot_mesh_destroy(m);
      m = fine;
    }
    assert_above(corot_mesh_measure(m).shape_min, 0.2 * first.shape_min);
    corot_mesh_destroy(m);
  }
}

/* Kuhn's cube is cut across its diagonal, then that of a face, then an edge, and is halved. */
static void cubes_have_three_shapes(void **state) {
  (void)state;
  uint64_t seed = 2;
  corot_mesh *m = make_cubes();
  for (int pass = 0; pass < 4; pass++) {
    int *mark = room_for_marks(m), n = mark_some(m, 0.1, &seed, mark);
    corot_mesh *fine = refined(m, n, mark, NULL);
    free(mark), corot_mesh_destroy(m);
    m = fine;
  }
  double found[4] = {0};
  int n = 0;
  for (int e = 0; e < m->ntet; e++) {
    double edges = 0; /* an invariant of a shape: the sum of squared edges over V^(2/3) */
    for (int k = 0; k < 6; k++)
      for (int i = 0; i < 3; i++) {
        const int *v = m->tet[e], *end = corot_tet_edge[k];
        double d = m->x[v[end[0]]][i] - m->x[v[end[1]]][i];
        edges += d * d;
      }
    double shape = edges / pow(corot_mesh_volume_of(m, e), 2.0 / 3);
    int i = 0;
    while (i < n && fabs(found[i] - shape) > 1e-9 * shape) i++;
    assert_true(i < 3);
    if (i == n) found[n++] = shape;
  }
  assert_int_equal(n, 3);
  corot_mesh_destroy(m);
}

/* --- Groups --- */

/* A side of the box is the plane it is in, however its mesh is cut. */
static void sides_are_planes(void **state) {
  (void)state;
  static const char *const name[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  const double at[6] = {-1, 0, 0, 2, 5, 8};
  uint64_t seed = 8;
  for (int order = 1; order < 3; order++)
    for (int split = 0; split < 3; split++) {
      corot_mesh *box = make_box((corot_box_split)split), *m = with_order(box, order);
      int *mark = room_for_marks(m), n = mark_some(m, 0.2, &seed, mark);
      corot_mesh *fine = refined(m, n, mark, NULL);
      for (int s = 0; s < 6; s++) {
        char plane[] = "a0";
        plane[1] = (char)('0' + s);
        assert_ok(corot_mesh_group_plane(fine, plane, s / 2, at[s], 0));
        const corot_group *g = corot_mesh_find_group(fine, name[s]),
                          *h = corot_mesh_find_group(fine, plane);
        assert_int_equal(g->nnode, h->nnode);
        assert_same_ints(g->nnode, g->node, h->node);
        assert_int_equal(g->ntri, h->ntri);
      }
      free(mark), corot_mesh_destroy(box), corot_mesh_destroy(m), corot_mesh_destroy(fine);
    }
}

/* All nodes of a cell, whose diagonal goes through the inside and is cut: a part of the surface
   that is given by its nodes stays there. */
static void a_surface_of_nodes_stays_on_the_surface(void **state) {
  (void)state;
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0}, COROT_BOX_KUHN};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  assert_ok(corot_mesh_group_nodes(m, "skin", 8, (int[]){0, 1, 2, 3, 4, 5, 6, 7}));
  corot_group *g = (corot_group *)corot_mesh_find_group(m, "skin");
  g->ntri = g->ntet = 0;
  corot_mesh *fine = refined(m, 2, (int[]){0, 3}, NULL);
  const corot_group *skin = corot_mesh_find_group(fine, "skin");
  assert_true(skin->nnode > 8);
  for (int i = 0; i < skin->nnode; i++) {
    const double *x = fine->x[skin->node[i]];
    bool outside = false;
    for (int k = 0; k < 3; k++) outside |= x[k] == 0 || x[k] == 1;
    assert_true(outside);
  }
  corot_mesh_destroy(m), corot_mesh_destroy(fine);
}

/* --- Order 2 --- */

/* Straight edges keep their nodes in the middle to the last bit. */
static void straight_stays_straight(void **state) {
  (void)state;
  uint64_t seed = 4;
  corot_mesh *m = mesh_of(8);
  for (int pass = 0; pass < 3; pass++) {
    int *mark = room_for_marks(m), n = mark_some(m, 0.2, &seed, mark);
    corot_mesh *fine = refined(m, n, mark, NULL);
    free(mark), corot_mesh_destroy(m);
    m = fine;
  }
  for (int e = 0; e < m->ntet; e++)
    for (int k = 0; k < 6; k++)
      for (int i = 0; i < 3; i++) {
        const int *v = m->tet[e], *end = corot_tet_edge[k];
        assert_true(m->x[m->mid[e][k]][i] == (m->x[v[end[0]]][i] + m->x[v[end[1]]][i]) / 2);
      }
  corot_mesh_destroy(m);
}

/* What x + c x^2 has made x. */
static double straightened(double x, double c) { return (sqrt(1 + 4 * c * x) - 1) / (2 * c); }

/* A straight mesh that x + c x^2 has bent is that map of it, tet by tet; and so is what it is cut
   into, if the node on each edge comes from the middle of where the ends come from. */
static void curved_stays_curved(void **state) {
  (void)state;
  const double c[3] = {0.2, 0.1, 0.05};
  uint64_t seed = 6;
  for (int split = 0; split < 3; split++) {
    corot_mesh *box = make_box((corot_box_split)split), *m = with_order(box, 2);
    corot_mesh_destroy(box);
    bend(m, c);
    double volume = corot_mesh_measure(m).volume;
    for (int pass = 0; pass < 3; pass++) {
      int *mark = room_for_marks(m), n = mark_some(m, 0.1, &seed, mark), *parent = NULL;
      corot_mesh *fine = refined(m, n, mark, &parent);
      assert_parts(m, fine, n, mark, parent);
      free(mark), free(parent), corot_mesh_destroy(m);
      m = fine;
    }
    assert_sound(m);
    assert_close(corot_mesh_measure(m).volume, volume, 1e-13, 0);
    for (int e = 0; e < m->ntet; e++)
      for (int k = 0; k < 6; k++)
        for (int i = 0; i < 3; i++) {
          const double *a = m->x[m->tet[e][corot_tet_edge[k][0]]],
                       *b = m->x[m->tet[e][corot_tet_edge[k][1]]], *x = m->x[m->mid[e][k]];
          double middle = (straightened(a[i], c[i]) + straightened(b[i], c[i])) / 2;
          /* roundings of the root, divided by 2 c */
          assert_close(straightened(x[i], c[i]), middle, 1e-13, 1e-13);
        }
    corot_mesh_destroy(m);
  }
}

/* --- Forces --- */

/* A uniform gradient leaves no force inside. Frames of `warp` depend on the edges of a tet unless
   the gradient is a rotation with a factor. */
static void uniform_gradients_pass_the_patch_test(void **state) {
  (void)state;
  for (int measure = 0; measure < NMEASURE; measure++)
    for (int order = 1; order < 3; order++) {
      uint64_t seed = 7;
      double Q[9], A[9];
      corot_mesh *box = linear_box(2, 2, 2), *m;
      corot_mesh *cut = refined(box, 3, (int[]){0, 11, 30}, NULL);
      m = with_order(cut, order);
      corot_mesh_destroy(box), corot_mesh_destroy(cut);
      random_gradient(&seed, 0.1, A);
      random_rotation(&seed, Q);
      for (int k = 0; k < 9 && measure == WARP; k++) A[k] = 1.1 * Q[k];
      for (int k = 0; k < 9; k++) A[k] -= identity[k];
      corot_model_def def = corot_model_defaults();
      def.strain = measures[measure], def.nmaterial = 1, def.material = &soft;
      body b = make_body(m, def);
      double *u = calloc(3 * (size_t)b.n, sizeof *u), *v = u + b.n, *r = v + b.n;
      for (int n = 0; n < m->nnode; n++) apply(A, m->x[n], u + 3 * n);
      assert_ok(corot_residual(b.model, b.state, 0, u, v, r));
      double size = norm_max(b.n, r);
      int ntri, (*tri)[3], (*node)[6] = NULL;
      assert_ok(corot_mesh_boundary(m, &ntri, &tri));
      if (order == 2) assert_ok(corot_mesh_face_nodes(m, ntri, (const int(*)[3])tri, &node));
      for (int t = 0; t < ntri; t++)
        for (int k = 0; k < 3 * order; k++)
          for (int i = 0; i < 3; i++) r[3 * (node ? node[t][k] : tri[t][k]) + i] = 0;
      /* forces of some twenty tets are summed at a node, of a mesh that is crooked */
      assert_below(norm_max(b.n, r), 1e-12 * size);
      assert_above(size, 1);
      free(tri), free(node), free(u), drop_body(&b);
    }
}

/* --- What is refused --- */

static void refusals(void **state) {
  (void)state;
  corot_mesh *m = make_box(COROT_BOX_KUHN), *fine = NULL;
  assert_fails(corot_mesh_refine_marked(m, 2, (int[]){0, 24}, &fine, NULL), COROT_EINVAL,
               "marked tet 24 does not exist, the last is 23");
  assert_fails(corot_mesh_refine_marked(m, 1, (int[]){-1}, &fine, NULL), COROT_EINVAL,
               "marked tet -1 does not exist, the last is 23");
  assert_null(fine);
  corot_mesh_destroy(m);
}

static corot_status try_refine(void *order) {
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0}, COROT_BOX_KUHN};
  corot_mesh *m = NULL, *raised = NULL, *fine = NULL;
  int *parent = NULL;
  COROT_TRY(corot_mesh_box(&box, &m));
  corot_status status = corot_mesh_change_order(m, *(int *)order, &raised);
  if (!status) status = corot_mesh_group_plane(raised, "plane", 0, 0, 0);
  if (!status) status = corot_mesh_refine_marked(raised, 2, (int[]){0, 4}, &fine, &parent);
  assert_true(!status == !!fine && !fine == !parent);
  free(parent), corot_mesh_destroy(m), corot_mesh_destroy(raised), corot_mesh_destroy(fine);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  for (int order = 1; order < 3; order++)
    assert_true(assert_survives_failed_allocations(try_refine, &order) >= 100);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tets_are_cut_and_match),
      cmocka_unit_test(order_of_the_marks_does_not_matter),
      cmocka_unit_test(nothing_marked_is_a_copy),
      cmocka_unit_test(a_mesh_read_back_goes_on_alike),
      cmocka_unit_test(one_tet),
      cmocka_unit_test(a_corner_costs_the_same_each_time),
      cmocka_unit_test(an_edge_keeps_its_shapes),
      cmocka_unit_test(cubes_have_three_shapes),
      cmocka_unit_test(sides_are_planes),
      cmocka_unit_test(a_surface_of_nodes_stays_on_the_surface),
      cmocka_unit_test(straight_stays_straight),
      cmocka_unit_test(curved_stays_curved),
      cmocka_unit_test(uniform_gradients_pass_the_patch_test),
      cmocka_unit_test(refusals),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
