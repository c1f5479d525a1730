/* The clamped tangent: positive semidefinite, no less than the exact one, and the same where there
   is nothing to clamp. */
#include "core/lanes/eigen.h"
#include "solid.h"

/* --- dense symmetric matrices [n][n] -----------------------------------------------------------
 */

/* The smallest eigenvalue over the largest in size, by Jacobi's rotations. A is overwritten. */
static double smallest_eigenvalue(int n, double *A) {
  for (int sweep = 0; sweep < 30; sweep++) {
    double off = 0, on = 0;
    for (int p = 0; p < n; p++)
      for (int q = 0; q < p; q++) {
        double a = A[p * n + q], d = A[q * n + q] - A[p * n + p];
        off += a * a;
        if (a == 0) continue;
        double t = 2 * a / (d + copysign(hypot(d, 2 * a), d)), c = 1 / hypot(1, t), s = t * c;
        for (int i = 0; i < n; i++) {
          double x = A[i * n + p], y = A[i * n + q];
          A[i * n + p] = c * x - s * y, A[i * n + q] = s * x + c * y;
        }
        for (int i = 0; i < n; i++) {
          double x = A[p * n + i], y = A[q * n + i];
          A[p * n + i] = c * x - s * y, A[q * n + i] = s * x + c * y;
        }
      }
    for (int p = 0; p < n; p++) on += A[p * n + p] * A[p * n + p];
    if (off <= 1e-28 * on) break;
    assert_true(sweep < 29);
  }
  double least = INFINITY, size = 0;
  for (int p = 0; p < n; p++) {
    least = fmin(least, A[p * n + p]);
    size = fmax(size, fabs(A[p * n + p]));
  }
  return least / size;
}

/* Rounding of sums over the tets of a node and of the rotations above. */
static const double rounding = 1e-13;

/* A = K at u, dense. */
static void dense_tangent(const body *b, const double *u, corot_tangent tangent, double *A) {
  double(*K)[9] = malloc(corot_model_nblock(b->model) * sizeof *K);
  double *unit = calloc(b->n, sizeof *unit);
  assert_ok(corot_jacobian(b->model, b->state, 0, u, unit, tangent, K, NULL));
  for (int i = 0; i < b->n; i++) {
    unit[i] = 1;
    corot_block_multiply(b->model, (const double(*)[9])K, unit, A + (size_t)i * b->n);
    unit[i] = 0;
  }
  free(K), free(unit);
}

/* --- bodies and states -------------------------------------------------------------------------
 */

static body make(corot_mesh *mesh, const char *strain, double lambda) {
  corot_material material = {.lambda = lambda, .mu = 1e4, .density = 1000};
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &material;
  return make_body(mesh, def);
}

/* With as many nodes in either order. */
static corot_mesh *box(void) {
  return order_of_test() == 1 ? crooked_box(2, 2, 2) : crooked_box(1, 1, 1);
}

static corot_mesh *one_tet(void) {
  const double x[4][3] = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 0.9, 0.1}, {0.1, 0, 1.2}};
  const int tet[1][4] = {{0, 1, 2, 3}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_create(4, x, 1, tet, &mesh));
  return mesh;
}

/* Stretches between `low` and `high` along random axes, a random rotation, and noise of `size`. */
static void deform(const body *b, uint64_t *seed, double low, double high, double size, double *u) {
  double Q[9], R[9], S[9], F[9], SQ[9];
  random_rotation(seed, Q), random_rotation(seed, R);
  for (int i = 0; i < 3; i++) {
    double s = low + (high - low) * 0.5 * (1 + noise(seed));
    for (int j = 0; j < 3; j++) SQ[3 * i + j] = s * Q[3 * i + j];
  }
  multiply_transposed(Q, SQ, S);
  multiply(R, S, F);
  const int(*dof)[3] = corot_model_dof(b->model);
  for (int n = 0; n < b->mesh->nnode; n++) {
    double x[3];
    apply(F, b->mesh->x[n], x);
    for (int c = 0; c < 3; c++) u[dof[n][c]] = x[c] - b->mesh->x[n][c] + size * noise(seed);
  }
}

typedef struct verdict {
  double exact, clamped, difference; /* smallest eigenvalue of K, clamped K, clamped less exact */
  bool same;                         /* clamped and exact agree but for rounding */
} verdict;

static verdict judge(const body *b, const double *u) {
  int n = b->n;
  double *exact = malloc(3 * (size_t)n * n * sizeof *exact), *clamped = exact + (size_t)n * n,
         *more = clamped + (size_t)n * n;
  dense_tangent(b, u, COROT_TANGENT_EXACT, exact);
  dense_tangent(b, u, COROT_TANGENT_CLAMPED, clamped);
  double size = norm_max(n * n, exact);
  for (int k = 0; k < n * n; k++) more[k] = clamped[k] - exact[k];
  double largest = norm_max(n * n, more);
  verdict v = {.same = largest <= 1e-14 * size}; /* sums are contracted as it suits each loop */
  v.difference = largest > 0 ? smallest_eigenvalue(n, more) * largest / size : 0;
  v.exact = smallest_eigenvalue(n, exact);
  v.clamped = smallest_eigenvalue(n, clamped);
  free(exact);
  return v;
}

/* --- tests -------------------------------------------------------------------------------------
 */

static mat3 random_symmetric(uint64_t *seed, int kind) {
  mat3 A;
  for (int l = 0; l < W; l++)
    for (int i = 0; i < 3; i++)
      for (int j = i; j < 3; j++) {
        double a = noise(seed);
        if (kind == 1) a *= pow(10, -16 * fabs(noise(seed))); /* graded */
        if (kind == 2) a = (i == j) + 1e-9 * a;               /* nearly a multiple of I */
        if (kind == 3) a *= i == j ? 0 : 1e-200;              /* squares underflow */
        if (kind == 4) a *= 1e150;                            /* squares overflow */
        if (kind == 5) a = (i == j) * (double)(l % 3 - 1);    /* diagonal, zero too */
        if (kind == 6) a = 1;                                 /* of rank one */
        A.m[i][j][l] = A.m[j][i][l] = a;
      }
  return A;
}

/* A = Q diag Q', Q'Q = I; the positive part has the positive eigenvalues and those alone. */
static void eigenvalues_of_symmetric_matrices(void **state) {
  (void)state;
  uint64_t seed = 5;
  for (int k = 0; k < 7000; k++) {
    mat3 A = random_symmetric(&seed, k % 7), B = positive_part(A), C = positive_part(B);
    eigen3 e = eigen_of(A);
    vd largest = largest_eigenvalue(A);
    for (int l = 0; l < W; l++) {
      double size = 0, least = INFINITY, most = -INFINITY;
      EACH_IJ size = fmax(size, fabs(A.m[i][j][l]));
      for (int m = 0; m < 3; m++) {
        least = fmin(least, e.value[m][l]);
        most = fmax(most, e.value[m][l]);
      }
      assert_close(largest[l], most, 0, 1e-15 * size);
      EACH_IJ {
        double a = 0, b = 0, unit = 0;
        for (int m = 0; m < 3; m++) {
          double qq = e.vector.m[i][m][l] * e.vector.m[j][m][l];
          unit += qq;
          a += e.value[m][l] * qq;
          b += fmax(0, e.value[m][l]) * qq;
        }
        assert_close(unit, i == j, 0, 4e-15);
        assert_close(a, A.m[i][j][l], 0, 8e-15 * size);
        assert_close(B.m[i][j][l], b, 0, 8e-15 * size);
        assert_close(C.m[i][j][l], b, 0, 2e-14 * size);
        if (least >= 0) assert_true(B.m[i][j][l] == A.m[i][j][l]);
      }
    }
  }
}

static void clamped_is_exact_where_nothing_is_negative(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    body b = make(box(), measures[m], 1e5);
    double *u = calloc(b.n, sizeof *u);
    uint64_t seed = 3;
    for (int k = 0; k < 5; k++) { /* at rest, then stretched */
      if (k > 0) deform(&b, &seed, 1.1, 1.6, 0.005, u);
      verdict v = judge(&b, u);
      assert_true(v.same);
      assert_above(v.exact, -rounding);
    }
    free(u), drop_body(&b);
  }
}

/* Compressed to between a tenth and all of the length, by which exact tangents of polar, hybrid and
   green strain become indefinite. */
static void clamped_is_semidefinite_and_no_less_than_exact(void **state) {
  (void)state;
  static const double lambdas[] = {1e5, 0, -6e3}; /* 3 lambda + 2 mu > 0 */
  for (int m = 0; m < NMEASURE; m++)
    for (int c = 0; c < 6; c++) {
      body b = make(c % 2 ? box() : one_tet(), measures[m], lambdas[c / 2]);
      double *u = malloc(b.n * sizeof *u);
      uint64_t seed = 17;
      int cut = 0, states = c % 2 ? 4 : 100;
      for (int k = 0; k < states; k++) {
        deform(&b, &seed, 0.1, k % 2 ? 1.0 : 2.5, c % 2 ? 0.003 : 0.02, u);
        verdict v = judge(&b, u);
        assert_above(v.clamped, -rounding);
        assert_above(v.difference, -rounding);
        cut += v.exact < -1e-3;
        if (v.exact < -1e-3) assert_false(v.same);
      }
      bool can_fail = conserves(m);
      assert_true(can_fail ? cut >= states / 4 : cut == 0);
      free(u), drop_body(&b);
    }
}

/* Held frames may be far from F's own. */
static void clamped_is_semidefinite_beside_old_frames(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    if (!corot_strain_traits(m)->frames) continue;
    body b = make(one_tet(), measures[m], 1e5);
    double *u = malloc(b.n * sizeof *u);
    uint64_t seed = 23;
    corot_state_use(b.state, COROT_FRAMES_HELD); /* those of u = 0 */
    for (int k = 0; k < 100; k++) {
      deform(&b, &seed, 0.1, 1.5, 0.01, u);
      double A[144];
      dense_tangent(&b, u, COROT_TANGENT_CLAMPED, A);
      assert_above(smallest_eigenvalue(12, A), -rounding);
    }
    free(u), drop_body(&b);
  }
}

/* A derivative is never clamped. */
static void jvp_takes_clamped_for_exact(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    body b = make(box(), measures[m], 1e5);
    double *u = calloc(5 * b.n, sizeof *u), *v = u + b.n, *du = v + b.n, *exact = du + b.n,
           *clamped = exact + b.n;
    uint64_t seed = 29;
    deform(&b, &seed, 0.3, 0.8, 0.003, u);
    for (int i = 0; i < b.n; i++) du[i] = noise(&seed);
    assert_ok(corot_jvp(b.model, b.state, 0, u, v, COROT_TANGENT_EXACT, du, v, exact));
    assert_ok(corot_jvp(b.model, b.state, 0, u, v, COROT_TANGENT_CLAMPED, du, v, clamped));
    assert_memory_equal(exact, clamped, b.n * sizeof *exact);
    free(u), drop_body(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(eigenvalues_of_symmetric_matrices),
      cmocka_unit_test(clamped_is_exact_where_nothing_is_negative),
      cmocka_unit_test(clamped_is_semidefinite_and_no_less_than_exact),
      cmocka_unit_test(clamped_is_semidefinite_beside_old_frames),
      cmocka_unit_test(jvp_takes_clamped_for_exact),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
