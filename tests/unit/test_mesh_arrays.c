/* Meshes, groups and materials as a host has them: in arrays. */
#include "alloc.h"
#include "live.h"

static corot_mesh *make_box(int order) {
  const corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 2, 3}, .split = COROT_BOX_SYMMETRIC};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  return order == 2 ? given_order(mesh, 2) : mesh;
}

/* Its nodes and tets by themselves, from arrays that are gone by then. */
static corot_mesh *bare_copy(const corot_mesh *m) {
  corot_mesh *copy;
  double(*x)[3] = malloc(m->nnode * sizeof *x);
  memcpy(x, m->x, m->nnode * sizeof *x);
  if (m->mid) {
    int(*tet)[10] = malloc(m->ntet * sizeof *tet);
    for (int e = 0; e < m->ntet; e++) {
      memcpy(tet[e], m->tet[e], sizeof *m->tet);
      memcpy(tet[e] + 4, m->mid[e], sizeof *m->mid);
    }
    assert_ok(corot_mesh_create_order_2(m->nnode, (const double(*)[3])x, m->ntet,
                                        (const int(*)[10])tet, &copy));
    memset(tet, 0xff, m->ntet * sizeof *tet);
    free(tet);
  } else {
    assert_ok(corot_mesh_create(m->nnode, (const double(*)[3])x, m->ntet, (const int(*)[4])m->tet,
                                &copy));
  }
  memset(x, 0xff, m->nnode * sizeof *x);
  free(x);
  return copy;
}

static void assert_same_ints(int n, const int *a, int m, const int *b) {
  assert_int_equal(n, m);
  assert_memory_equal(a, b, n * sizeof *a);
}

/* --- Groups ----------------------------------------------------------------------------------- */

static void triangles_make_the_group_of_a_side(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    corot_mesh *box = make_box(order), *m = bare_copy(box);
    const corot_group *side = corot_mesh_find_group(box, "xmax");
    int n = side->ntri, (*tri)[3] = malloc(2 * n * sizeof *tri);
    for (int i = 0; i < 2 * n; i++) { /* each twice, wound in either way */
      const int *of = side->tri[i % n];
      memcpy(tri[i], i % 3 ? of : (int[]){of[1], of[0], of[2]}, sizeof *tri);
    }
    assert_ok(corot_mesh_group_triangles(m, "side", 2 * n, (const int(*)[3])tri));
    const corot_group *g = corot_mesh_find_group(m, "side");
    assert_same_ints(g->nnode, g->node, side->nnode, side->node);
    assert_int_equal(g->ntri, n);
    assert_int_equal(g->ntet, 0);
    for (int i = 0; i < n; i++) { /* outward, as the box has them */
      int from = 0;
      while (from < 3 && g->tri[i][from] != side->tri[i][0]) from++;
      for (int k = 0; k < 3; k++) assert_int_equal(g->tri[i][(from + k) % 3], side->tri[i][k]);
    }
    free(tri);
    corot_mesh_destroy(m), corot_mesh_destroy(box);
  }
}

static void triangles_inside_keep_their_winding(void **state) {
  (void)state;
  corot_mesh *m = make_box(1);
  int inner[2][3], ninner = 0, nboundary, (*boundary)[3];
  assert_ok(corot_mesh_boundary(m, &nboundary, &boundary));
  for (int k = 0; k < 4 && !ninner; k++) { /* a face of tet 0 that is not of the boundary */
    int v[3], *to = inner[0];
    for (int i = 0, n = 0; i < 4; i++)
      if (i != k) v[n++] = m->tet[0][i];
    bool outside = false;
    for (int t = 0; t < nboundary; t++) {
      int same = 0;
      for (int i = 0; i < 9; i++) same += v[i / 3] == boundary[t][i % 3];
      outside |= same == 3;
    }
    if (!outside) memcpy(to, v, sizeof v), ninner = 1;
  }
  assert_int_equal(ninner, 1);
  memcpy(inner[1], (int[]){inner[0][1], inner[0][0], inner[0][2]}, sizeof *inner);
  const char *names[] = {"one way", "the other"};
  for (int k = 0; k < 2; k++) {
    assert_ok(corot_mesh_group_triangles(m, names[k], 1, (const int(*)[3])inner + k));
    assert_memory_equal(corot_mesh_find_group(m, names[k])->tri[0], inner[k], sizeof *inner);
  }
  free(boundary);
  corot_mesh_destroy(m);
}

static void tets_bring_their_nodes(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    corot_mesh *m = make_box(order);
    const int tet[] = {7, 3, 7, 20};
    assert_ok(corot_mesh_group_tets(m, "some", 4, tet));
    const corot_group *g = corot_mesh_find_group(m, "some");
    assert_same_ints(g->ntet, g->tet, 3, (const int[]){3, 7, 20});
    assert_int_equal(g->ntri, 0);
    for (int i = 0, n = 0; i < m->nnode; i++) {
      bool has = false;
      for (int k = 0; k < 3 * (order == 2 ? 10 : 4); k++) {
        int e = g->tet[k % 3], a = k / 3;
        has |= i == (a < 4 ? m->tet[e][a] : m->mid[e][a - 4]);
      }
      bool is_listed = n < g->nnode && g->node[n] == i;
      assert_int_equal(is_listed, has);
      n += is_listed;
    }
    corot_mesh_destroy(m);
  }
}

static void what_does_not_fit_is_refused(void **state) {
  (void)state;
  corot_mesh *m = make_box(2);
  int before = m->ngroup, corner = m->tet[0][0], far = m->tet[m->ntet - 1][3];
  const int none[1][3] = {{corner, m->tet[0][1], far}}, wild[1][3] = {{0, 1, 1 << 30}};
  const int same[1][3] = {{0, 0, 1}}, mid[1][3] = {{corner, m->tet[0][1], m->mid[0][0]}};
  const int good[] = {0}, high[] = {0, m->ntet}, low[] = {-1};
  assert_fails(corot_mesh_group_tets(m, "a", 2, high), COROT_EINVAL, "tet 96 does not exist");
  assert_fails(corot_mesh_group_tets(m, "a", 1, low), COROT_EINVAL, "tet -1");
  assert_fails(corot_mesh_group_tets(m, "a", 0, good), COROT_EINVAL, "no tets");
  assert_fails(corot_mesh_group_tets(m, "a", 1, NULL), COROT_EINVAL, "'tet' is NULL");
  assert_fails(corot_mesh_group_tets(m, "zmin", 1, good), COROT_EINVAL, "exists");
  assert_fails(corot_mesh_group_tets(m, "", 1, good), COROT_EINVAL, "needs a name");
  assert_fails(corot_mesh_group_tets(m, NULL, 1, good), COROT_EINVAL, "'name' is NULL");
  assert_fails(corot_mesh_group_tets(NULL, "a", 1, good), COROT_EINVAL, "'mesh' is NULL");
  assert_fails(corot_mesh_group_triangles(m, "a", 1, none), COROT_EINVAL, "no face of a tet");
  assert_fails(corot_mesh_group_triangles(m, "a", 1, wild), COROT_EINVAL, "no face of a tet");
  assert_fails(corot_mesh_group_triangles(m, "a", 1, same), COROT_EINVAL, "no face of a tet");
  assert_fails(corot_mesh_group_triangles(m, "a", 1, mid), COROT_EINVAL, "no face of a tet");
  assert_fails(corot_mesh_group_triangles(m, "a", 0, none), COROT_EINVAL, "no triangles");
  assert_fails(corot_mesh_group_triangles(m, "a", 1, NULL), COROT_EINVAL, "'tri' is NULL");
  assert_fails(corot_mesh_group_triangles(m, "xmin", 1, none), COROT_EINVAL, "exists");
  assert_fails(corot_mesh_group_nodes(m, "a", 1, NULL), COROT_EINVAL, "'node' is NULL");
  assert_int_equal(m->ngroup, before);
  corot_mesh_destroy(m);
}

/* --- Materials -------------------------------------------------------------------------------- */

/* Three materials by the number of the tet. */
static const double stiffer[] = {1, 3, 0.4};

static body make_layered(int order, bool listed) {
  corot_mesh *mesh = make_box(order);
  int n = mesh->ntet, *of_tet = malloc(n * sizeof *of_tet), *own = malloc(n * sizeof *own);
  const char *names[] = {NULL, "b", "c"};
  corot_material material[3];
  for (int e = 0; e < n; e++) of_tet[e] = e % 5 % 3;
  for (int k = 0; k < 3; k++) {
    material[k] = soft;
    material[k].mu *= stiffer[k], material[k].density *= 2 - stiffer[k] / 2;
    if (listed || !names[k]) continue;
    int count = 0;
    for (int e = 0; e < n; e++)
      if (of_tet[e] == k) own[count++] = e;
    assert_ok(corot_mesh_group_tets(mesh, names[k], count, own));
    material[k].group = names[k];
  }
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 3, def.material = material;
  def.tet_material = listed ? of_tet : NULL;
  def.nfix = 1, def.fix = &base;
  def.nload = NLOAD, def.load = loads;
  body b = make_body(mesh, def);
  free(of_tet), free(own);
  return b;
}

static void a_list_of_materials_is_the_same_as_groups(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    body by_list = make_layered(order, true), by_groups = make_layered(order, false);
    double *u = some_motion(by_list.n, 1e-3);
    assert_same(&by_list, &by_groups, 0.3, u);
    assert_memory_equal(corot_model_mass(by_list.model), corot_model_mass(by_groups.model),
                        by_list.n * sizeof(double));
    free(u);
    drop_body(&by_list), drop_body(&by_groups);
  }
}

/* Each tet has its own modulus: the energy is the sum of those of the tets, each alone being soft.
 */
static void each_tet_may_have_its_own(void **state) {
  (void)state;
  corot_mesh *mesh = make_box(1), *copy;
  int n = mesh->ntet, *of_tet = malloc(n * sizeof *of_tet);
  corot_material *material = malloc(n * sizeof *material);
  for (int e = 0; e < n; e++) {
    double stiff = 1 + 0.1 * e;
    material[e] = soft, of_tet[e] = e;
    material[e].lambda *= stiff, material[e].mu *= stiff;
  }
  assert_ok(corot_mesh_copy(mesh, &copy));
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  body plain = make_body(mesh, def);
  def.nmaterial = n, def.material = material, def.tet_material = of_tet;
  body graded = make_body(copy, def);
  double *u = some_motion(plain.n, 1e-3), *energy = malloc(n * sizeof *energy), sum = 0;
  corot_element_fields fields = {.energy = energy};
  corot_energies e;
  assert_ok(corot_elements(plain.model, plain.state, 0, u, &fields));
  for (int k = 0; k < n; k++) sum += (1 + 0.1 * k) * energy[k];
  assert_ok(corot_energy(graded.model, graded.state, 0, u, u + plain.n, &e));
  assert_close(e.elastic, sum, 1e-12, 0);
  free(u), free(energy), free(of_tet), free(material);
  drop_body(&plain), drop_body(&graded);
}

static void a_list_that_does_not_fit_is_refused(void **state) {
  (void)state;
  corot_mesh *mesh = make_box(1);
  int *of_tet = calloc(mesh->ntet, sizeof *of_tet);
  corot_material material[2] = {soft, soft};
  corot_model *model;
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.nmaterial = 2, def.material = material, def.tet_material = of_tet;
  of_tet[4] = 2;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "tet 4 is of material 2");
  of_tet[4] = -1;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "tet 4 is of material -1");
  of_tet[4] = 0, material[1].group = "zmin";
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "material 1: group 'zmin' is named");
  material[1].group = NULL;
  assert_ok(corot_model_create(&def, &model));
  corot_model_destroy(model), corot_mesh_destroy(mesh);
  free(of_tet);
}

/* --- Memory ----------------------------------------------------------------------------------- */

static corot_status try_groups(void *context) {
  corot_mesh *m;
  COROT_TRY(corot_mesh_copy(context, &m));
  const int tet[] = {0, 1};
  int tri[3] = {m->tet[0][0], m->tet[0][1], m->tet[0][2]};
  corot_status status = corot_mesh_group_tets(m, "tets", 2, tet);
  if (!status) status = corot_mesh_group_triangles(m, "triangles", 1, (const int(*)[3])tri);
  corot_mesh_destroy(m);
  return status;
}

static void failed_allocations_leave_nothing(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    corot_mesh *m = make_box(order);
    assert_true(assert_survives_failed_allocations(try_groups, m) >= 15);
    corot_mesh_destroy(m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(triangles_make_the_group_of_a_side),
      cmocka_unit_test(triangles_inside_keep_their_winding),
      cmocka_unit_test(tets_bring_their_nodes),
      cmocka_unit_test(what_does_not_fit_is_refused),
      cmocka_unit_test(a_list_of_materials_is_the_same_as_groups),
      cmocka_unit_test(each_tet_may_have_its_own),
      cmocka_unit_test(a_list_that_does_not_fit_is_refused),
      cmocka_unit_test(failed_allocations_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
