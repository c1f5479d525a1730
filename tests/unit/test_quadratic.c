/* What elements have exactly: fields of their order, products of them, tractions and volumes. All
   of it on meshes without two tets alike, of the order that is asked for. */
#include "core/element/face.h"
#include "solid.h"

static body make(corot_mesh *mesh, int measure, int nload, const corot_load *load) {
  corot_model_def def = corot_model_defaults();
  def.strain = measures[measure], def.nmaterial = 1, def.material = &soft;
  def.nload = nload, def.load = load, def.mass = COROT_MASS_CONSISTENT;
  return make_body(mesh, def);
}

/* u = A x + x' H_c x for each component c; linear elements have no second part. */
static void field(const double A[9], const double H[3][9], const double x[3], double u[3]) {
  apply(A, x, u);
  for (int c = 0; c < 3 && order_of_test() > 1; c++) {
    double Hx[3];
    apply(H[c], x, Hx);
    u[c] += inner(3, x, Hx);
  }
}

static void random_field(uint64_t *seed, double A[9], double H[3][9]) {
  for (int k = 0; k < 9; k++) A[k] = 0.1 * noise(seed);
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j <= i; j++) H[c][3 * i + j] = H[c][3 * j + i] = 0.1 * noise(seed);
}

/* The patch test of a quadratic displacement in Cauchy strain: its stress P is linear, div P is
   constant, and the residual of a node that is on no side is the consistent force of div P, as
   gravity along it would put there: residual = -int P grad N = int div P N. */
static void quadratic_displacements_pass_the_patch_test(void **state) {
  (void)state;
  double A[9], H[3][9], f[3], lambda = soft.lambda, mu = soft.mu;
  uint64_t seed = 3;
  random_field(&seed, A, H);
  for (int c = 0; c < 3; c++) { /* (lambda + mu) grad div u + mu laplace u; gravity is per mass */
    double of_div = 0, laplace = 0;
    for (int k = 0; k < 3; k++) of_div += 2 * H[k][3 * k + c], laplace += 2 * H[c][4 * k];
    f[c] = (order_of_test() > 1) * ((lambda + mu) * of_div + mu * laplace);
  }
  corot_load gravity = {COROT_GRAVITY, NULL, {0}, {0}};
  for (int c = 0; c < 3; c++) gravity.value[c] = -f[c] / soft.density;
  corot_mesh *mesh = straight_box(3, 3, 3);
  body b = make(mesh, CAUCHY, 1, &gravity);
  double *u = calloc(3 * b.n, sizeof *u), *v = u + b.n, *r = v + b.n;
  for (int n = 0; n < mesh->nnode; n++) field(A, (const double(*)[9])H, mesh->x[n], u + 3 * n);
  assert_ok(corot_residual(b.model, b.state, 0, u, v, r));
  double size = norm_max(b.n, r); /* of the sides: the traction times a part of a face */
  for (int g = 0; g < mesh->ngroup; g++)
    for (int k = 0; k < mesh->group[g].nnode; k++)
      for (int c = 0; c < 3; c++) r[3 * mesh->group[g].node[k] + c] = 0;
  assert_below(norm_max(b.n, r), 1e-12 * size);
  assert_above(size, 1);
  free(u), drop_body(&b);
}

/* Gauss elimination with complete pivoting: the number of pivots above `least` of the largest. */
static int rank_of(int n, double *A, double least) {
  double first = 0;
  for (int k = 0; k < n; k++) {
    int row = k, column = k;
    for (int i = k; i < n; i++)
      for (int j = k; j < n; j++)
        if (fabs(A[n * i + j]) > fabs(A[n * row + column])) row = i, column = j;
    double pivot = A[n * row + column];
    if (k == 0) first = fabs(pivot);
    if (!(fabs(pivot) > least * first)) return k;
    for (int j = 0; j < n; j++) {
      double keep = A[n * k + j];
      A[n * k + j] = A[n * row + j], A[n * row + j] = keep;
    }
    for (int i = 0; i < n; i++) {
      double keep = A[n * i + k];
      A[n * i + k] = A[n * i + column], A[n * i + column] = keep;
    }
    for (int i = k + 1; i < n; i++) {
      double factor = A[n * i + k] / pivot;
      for (int j = k; j < n; j++) A[n * i + j] -= factor * A[n * k + j];
    }
  }
  return n;
}

/* K of one tet at rest has the six rigid motions in its null space, and nothing else. */
static void one_element_has_no_mode_without_energy(void **state) {
  (void)state;
  const double x[4][3] = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 0.9, 0.1}, {0.1, 0, 1.2}};
  const int tet[1][4] = {{0, 1, 2, 3}};
  for (int m = 0; m < NMEASURE; m++)
    for (int bent = 0; bent < order_of_test(); bent++) {
      corot_mesh *mesh;
      assert_ok(corot_mesh_create(4, x, 1, tet, &mesh));
      mesh = of_order(mesh);
      if (bent) bend_edges(mesh, 0.05);
      body b = make(mesh, m, 0, NULL);
      double *unit = calloc(2 * b.n, sizeof *unit), *zero = unit + b.n;
      double *K = malloc((size_t)b.n * b.n * sizeof *K);
      for (int i = 0; i < b.n; i++) {
        unit[i] = 1;
        assert_ok(corot_jvp(b.model, b.state, 0, zero, zero, COROT_TANGENT_EXACT, unit, zero,
                            K + (size_t)i * b.n));
        unit[i] = 0;
      }
      assert_int_equal(rank_of(b.n, K, 1e-9), b.n - 6); /* the softest mode is at some 1e-3 */
      free(unit), free(K), drop_body(&b);
    }
}

/* v and w of the elements' order: v' M w is the integral of their product, here over the box that
   straight edges fill, by Gauss's three points in each direction, which are exact for degree five;
   and the whole mass is the density times the volume where edges are curved, too. */
static void the_mass_integrates_products(void **state) {
  (void)state;
  static const double at[3] = {-0.774596669241483377, 0, 0.774596669241483377},
                      part[3] = {5. / 18, 8. / 18, 5. / 18};
  const corot_box box = {.size = {1, 0.7, 1.2}, .cells = {2, 1, 2}, .origin = {-0.2, 0.1, 0}};
  double A[2][9], H[2][3][9], expected = 0, f[2][3];
  uint64_t seed = 5;
  for (int k = 0; k < 2; k++) random_field(&seed, A[k], H[k]);
  body b = make(box_of_order(&box), POLAR, 0, NULL);
  double *v = calloc(3 * b.n, sizeof *v), *w = v + b.n, *Mw = w + b.n;
  for (int n = 0; n < b.mesh->nnode; n++) {
    field(A[0], (const double(*)[9])H[0], b.mesh->x[n], v + 3 * n);
    field(A[1], (const double(*)[9])H[1], b.mesh->x[n], w + 3 * n);
  }
  for (int p = 0; p < 27; p++) {
    int i[3] = {p % 3, p / 3 % 3, p / 9};
    double x[3], weight = soft.density;
    for (int c = 0; c < 3; c++) {
      x[c] = box.origin[c] + box.size[c] * (1 + at[i[c]]) / 2;
      weight *= part[i[c]] * box.size[c];
    }
    for (int k = 0; k < 2; k++) field(A[k], (const double(*)[9])H[k], x, f[k]);
    expected += weight * inner(3, f[0], f[1]);
  }
  corot_mass_multiply(b.model, w, Mw);
  assert_close(inner(b.n, v, Mw), expected, 1e-12, 0);
  free(v), drop_body(&b);

  b = make(crooked_box(2, 2, 2), POLAR, 0, NULL);
  double *one = calloc(2 * b.n, sizeof *one), *M1 = one + b.n;
  for (int i = 0; i < b.n; i += 3) one[i] = 1;
  corot_mass_multiply(b.model, one, M1);
  assert_close(inner(b.n, one, M1), soft.density * corot_mesh_measure(b.mesh).volume, 1e-13, 0);
  for (int i = 0; i < b.n; i++) assert_above(corot_model_mass(b.model)[i], 0); /* lumped */
  free(one), drop_body(&b);
}

/* A traction on a flat face of area A: A/3 at each corner of a triangle; with nodes on its edges,
   A/3 at each of these and nothing at the corners. */
static void tractions_have_their_shares(void **state) {
  (void)state;
  const double x[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0.1, 0, 1}};
  const int tet[1][4] = {{0, 1, 2, 3}}, foot[] = {0, 1, 2};
  corot_mesh *mesh;
  assert_ok(corot_mesh_create(4, x, 1, tet, &mesh));
  assert_ok(corot_mesh_group_nodes(mesh, "foot", 3, foot));
  corot_load load = {COROT_TRACTION, "foot", {5, 7, -2}, {0}};
  body b = make(of_order(mesh), CAUCHY, 1, &load);
  double *u = calloc(2 * b.n, sizeof *u), *r = u + b.n;
  assert_ok(corot_residual(b.model, b.state, 0, u, u, r));
  for (int n = 0; n < b.mesh->nnode; n++) {
    bool on_foot = b.mesh->x[n][2] == 0, corner = n < 4;
    double share = on_foot && (corner == (order_of_test() == 1)) ? 3.0 / 3 : 0;
    for (int c = 0; c < 3; c++) assert_close(r[3 * n + c], share * load.value[c], 0, 1e-14);
  }
  free(u), drop_body(&b);
}

/* Integrals of L1^i L2^j over a triangle of area 1/2 are i! j! / (i + j + 2)!. */
static void face_rules_are_of_their_degree(void **state) {
  (void)state;
  static const double factorial[] = {1, 1, 2, 6, 24, 120, 720};
  const face_kind *kind = face_kind_of(order_of_test());
  int degree = order_of_test() == 1 ? 1 : 4;
  for (int i = 0; i <= degree; i++)
    for (int j = 0; i + j <= degree; j++) {
      double sum = 0;
      for (int q = 0; q < kind->npoint; q++) {
        const double *N = kind->share[q]; /* L_k is N_k and half of those beside it */
        double L1 = N[1] + (degree > 1 ? (N[3] + N[4]) / 2 : 0);
        double L2 = N[2] + (degree > 1 ? (N[4] + N[5]) / 2 : 0);
        sum += kind->part[q] / 2 * pow(L1 / kind->over, i) * pow(L2 / kind->over, j);
      }
      assert_close(sum, factorial[i] * factorial[j] / factorial[i + j + 2], 1e-14, 0);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quadratic_displacements_pass_the_patch_test),
      cmocka_unit_test(one_element_has_no_mode_without_energy),
      cmocka_unit_test(the_mass_integrates_products),
      cmocka_unit_test(tractions_have_their_shares),
      cmocka_unit_test(face_rules_are_of_their_degree),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
