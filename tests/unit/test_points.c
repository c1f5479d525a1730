/* Fields at points between nodes: as at the points of integration, and exact where the elements
   hold the displacement exactly. */
#include "order_2.h"
#include "solid.h"

static body block(const char *strain, corot_dilatation dilatation) {
  corot_box box = {.size = {0.2, 0.1, 0.3}, .cells = {2, 1, 2}, .split = COROT_BOX_SYMMETRIC};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_material material[2] = {soft, soft};
  material[1].group = "low", material[1].lambda = 4e4, material[1].mu = 3e4;
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.dilatation = dilatation;
  def.nmaterial = 2, def.material = material;
  assert_ok(corot_mesh_group_box(mesh, "low", (double[]){-1, -1, -1}, (double[]){1, 1, 0.15}, 0));
  return make_body(of_order(mesh), def);
}

/* Volume coordinates of point k of integration, next to corner k. */
static void point_of_rule(int order, int k, double l[4]) {
  for (int a = 0; a < 4; a++)
    l[a] = order == 1 ? 0.25 : a == k ? 0.58541019662496845446 : 0.13819660112501051518;
}

static void assert_tensors(int n, const double *a, const double *b, double size) {
  for (int i = 0; i < n; i++) assert_close(a[i], b[i], 0, 1e-11 * size);
}

/* At the points of integration of all tets, the fields that corot_elements gives there. */
static void check_rule(const body *b, double t, const double *u) {
  int ntet = b->mesh->ntet, n = 4 * ntet, order = corot_mesh_order(b->mesh);
  int *tet = malloc(n * sizeof *tet);
  double(*at)[4] = malloc(n * sizeof *at);
  corot_element_fields e = {.frame_at = calloc(ntet, sizeof *e.frame_at),
                            .strain_at = calloc(ntet, sizeof *e.strain_at),
                            .von_mises_at = calloc(ntet, sizeof *e.von_mises_at),
                            .det_at = calloc(ntet, sizeof *e.det_at),
                            .stress_at = calloc(ntet, sizeof *e.stress_at),
                            .principal_at = calloc(ntet, sizeof *e.principal_at)};
  corot_point_fields f = {.frame = calloc(n, sizeof *f.frame),
                          .strain = calloc(n, sizeof *f.strain),
                          .stress = calloc(n, sizeof *f.stress),
                          .principal = calloc(n, sizeof *f.principal),
                          .von_mises = calloc(n, sizeof *f.von_mises),
                          .det = calloc(n, sizeof *f.det)};
  corot_points *points;
  for (int i = 0; i < n; i++) tet[i] = i / 4, point_of_rule(order, i % 4, at[i]);
  assert_ok(corot_points_create(b->model, n, tet, (const double(*)[4])at, &points));
  assert_ok(corot_points_evaluate(points, b->state, t, u, &f));
  assert_ok(corot_elements(b->model, b->state, t, u, &e));
  double size = norm_max(6 * n, f.stress[0]);
  assert_true(size > 100);
  assert_tensors(9 * n, f.frame[0], e.frame_at[0][0], 1);
  assert_tensors(6 * n, f.strain[0], e.strain_at[0][0], 1);
  assert_tensors(6 * n, f.stress[0], e.stress_at[0][0], size);
  assert_tensors(3 * n, f.principal[0], e.principal_at[0][0], size);
  assert_tensors(n, f.von_mises, e.von_mises_at[0], size);
  assert_tensors(n, f.det, e.det_at[0], 1);
  for (int i = 0; i < n; i++) { /* the invariants of one tensor */
    const double *p = f.principal[i], *s = f.stress[i];
    assert_true(p[0] >= p[1] && p[1] >= p[2]);
    assert_close(p[0] + p[1] + p[2], s[0] + s[1] + s[2], 0, 1e-12 * size);
    double differences = pow(p[0] - p[1], 2) + pow(p[1] - p[2], 2) + pow(p[2] - p[0], 2);
    assert_close(sqrt(differences / 2), f.von_mises[i], 0, 1e-11 * size);
  }
  free(tet), free(at), free(e.frame_at), free(e.strain_at), free(e.von_mises_at), free(e.det_at);
  free(e.stress_at), free(e.principal_at), free(f.frame), free(f.strain), free(f.stress);
  free(f.principal), free(f.von_mises), free(f.det), corot_points_destroy(points);
}

static void points_of_the_rule_agree(void **state) {
  (void)state;
  for (int k = 0; k < NMEASURE; k++)
    for (int d = COROT_DILATATION_LOCAL; d <= COROT_DILATATION_ELEMENT; d++) {
      body b = block(measures[k], (corot_dilatation)d);
      double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n;
      uint64_t seed = 5;
      for (int i = 0; i < b.n; i++) u[i] = 0.003 * noise(&seed), v[i] = 0.1 * noise(&seed);
      check_rule(&b, 0, u);
      assert_ok(corot_frames_update(b.model, b.state, 0, u, NULL));
      assert_ok(corot_frames_spin(b.model, b.state, 0, u, v, NULL));
      for (int i = 0; i < b.n; i++) u[i] += 0.001 * noise(&seed);
      for (int frames = COROT_FRAMES_HELD; frames <= COROT_FRAMES_EXTRAPOLATED; frames++) {
        corot_state_use(b.state, (corot_frames)frames);
        check_rule(&b, 0.02, u);
      }
      free(u), drop_body(&b);
    }
}

/* Linear elasticity of a displacement that elements hold: e = sym grad u at any point, linear in
   ten-node tets, straight or, for a constant gradient, curved. */
static void strains_are_exact(void **state) {
  (void)state;
  body b = block("cauchy", COROT_DILATATION_LOCAL);
  int order = corot_mesh_order(b.mesh), tet[40];
  double at[40][4], e[40][6], *u = calloc(b.n, sizeof *u),
                              (*x)[3] = calloc(b.mesh->nnode, sizeof *x);
  double c = order == 2 ? 0.1 : 0;
  for (int n = 0; n < b.mesh->nnode; n++) {
    const double *X = b.mesh->x[n];
    x[n][0] = 0.01 * X[0] + 0.02 * X[1] + c * X[0] * X[2];
    x[n][1] = -0.03 * X[2] + c * X[1] * X[1];
    x[n][2] = 0.005 * X[2] - c * X[0] * X[1];
  }
  to_dofs(&b, (const double(*)[3])x, u);
  uint64_t seed = 9;
  for (int i = 0; i < 40; i++) {
    double sum = 0;
    for (int a = 0; a < 4; a++) at[i][a] = 1.1 + noise(&seed), sum += at[i][a];
    for (int a = 0; a < 4; a++) at[i][a] /= sum;
    tet[i] = (7 * i) % b.mesh->ntet;
  }
  corot_points *points;
  assert_ok(corot_points_create(b.model, 40, tet, (const double(*)[4])at, &points));
  assert_ok(corot_points_evaluate(points, b.state, 0, u, &(corot_point_fields){.strain = e}));
  for (int i = 0; i < 40; i++) {
    double X[3] = {0};
    for (int a = 0; a < 4; a++)
      for (int k = 0; k < 3; k++) X[k] += at[i][a] * b.mesh->x[b.mesh->tet[tet[i]][a]][k];
    const double expected[6] = {0.01 + c * X[2],   2 * c * X[1],           0.005,
                                0.01 - 0.0 * X[0], (-0.03 - c * X[0]) / 2, c * (X[0] - X[1]) / 2};
    assert_tensors(6, e[i], expected, 1e-2); /* rounding of u over lengths of tets */
  }
  corot_points_destroy(points), free(u), free(x), drop_body(&b);
}

/* The tets' energies sum to the body's, and det F and volume to the deformed volume. */
static void energies_and_volumes_add_up(void **state) {
  (void)state;
  for (int k = 0; k < NMEASURE; k++)
    for (int d = COROT_DILATATION_LOCAL; d <= COROT_DILATATION_ELEMENT; d++) {
      body b = block(measures[k], (corot_dilatation)d);
      double *u = calloc(2 * b.n, sizeof *u), energy = 0, volume = 0;
      uint64_t seed = 5;
      for (int i = 0; i < b.n; i++) u[i] = 0.003 * noise(&seed);
      corot_energies whole;
      corot_element_fields e = {.energy = calloc(b.mesh->ntet, sizeof *e.energy),
                                .volume = calloc(b.mesh->ntet, sizeof *e.volume)};
      assert_ok(corot_energy(b.model, b.state, 0, u, u + b.n, &whole));
      assert_ok(corot_elements(b.model, b.state, 0, u, &e));
      for (int t = 0; t < b.mesh->ntet; t++) energy += e.energy[t], volume += e.volume[t];
      assert_close(energy, whole.elastic, 1e-12, 0);
      assert_close(volume, 0.2 * 0.1 * 0.3, 1e-12, 0);
      free(e.energy), free(e.volume), free(u), drop_body(&b);
    }
}

static void an_inverted_tet_is_named(void **state) {
  (void)state;
  body b = block("polar", COROT_DILATATION_LOCAL);
  double *u = calloc(b.n, sizeof *u), (*x)[3] = calloc(b.mesh->nnode, sizeof *x), det;
  const double middle[1][4] = {{0.25, 0.25, 0.25, 0.25}};
  corot_points *points;
  for (int n = 0; n < b.mesh->nnode; n++) x[n][0] = -2 * b.mesh->x[n][0]; /* mirrored */
  to_dofs(&b, (const double(*)[3])x, u);
  assert_ok(corot_points_create(b.model, 1, (int[]){3}, middle, &points));
  assert_fails(corot_points_evaluate(points, b.state, 0, u, &(corot_point_fields){.det = &det}),
               COROT_RETRY, "tet 3 is inverted");
  assert_close(det, -1, 1e-12, 0);
  corot_points_destroy(points);
  assert_fails(corot_points_create(b.model, 1, (int[]){9999}, middle, &points), COROT_EINVAL,
               "point 0: tet 9999; there are");
  free(u), free(x), drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_of_the_rule_agree),
      cmocka_unit_test(strains_are_exact),
      cmocka_unit_test(energies_and_volumes_add_up),
      cmocka_unit_test(an_inverted_tet_is_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
