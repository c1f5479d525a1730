/* Polar factor, Gram-Schmidt basis and their derivatives.

   The polar factor R of F is the one rotation for which R'F is symmetric and positive definite;
   that is the check, next to factors that F was built from. To first order a change dF turns R by
   |dF| / (s2 + s3) at most, where s1 >= s2 >= s3 are the singular values: since F itself is
   rounded, R is defined to eps s1 / (s2 + s3) only. */
#include <float.h>

#include "core/element/strain.h"
#include "solid.h"

static const double eps = DBL_EPSILON;

/* F = A diag(s) B with random rotations A and B; its polar factor is A B. */
static void build(uint64_t *seed, const double s[3], double F[9], double R[9]) {
  double A[9], B[9], T[9], D[9] = {s[0], 0, 0, 0, s[1], 0, 0, 0, s[2]};
  random_rotation(seed, A);
  random_rotation(seed, B);
  multiply(A, D, T);
  multiply(T, B, F);
  multiply(A, B, R);
}

static double largest_entry(const double F[9]) {
  double size = 0;
  for (int k = 0; k < 9; k++) size = fmax(size, fabs(F[k]));
  return size;
}

static void assert_rotation(const double R[9]) {
  double G[9];
  multiply_transposed(R, R, G);
  assert_below(distance(G, identity), 6 * eps);
  assert_close(determinant(R), 1, 0, 8 * eps);
}

/* R'F is symmetric and positive semidefinite to `tolerance` |F|. */
static void assert_stretch(const double F[9], const double R[9], double tolerance) {
  double S[9], scaled[9], size = largest_entry(F);
  for (int k = 0; k < 9; k++) scaled[k] = F[k] / size;
  multiply_transposed(R, scaled, S);
  assert_close(S[1], S[3], 0, tolerance);
  assert_close(S[2], S[6], 0, tolerance);
  assert_close(S[5], S[7], 0, tolerance);
  assert_above(S[0], -tolerance);
  assert_above(S[0] * S[4] - S[1] * S[3], -4 * tolerance);
  assert_above(determinant(S), -6 * tolerance);
}

static void finds_the_factor_a_gradient_was_built_from(void **state) {
  (void)state;
  static const double s[][3] = {
      {1, 1, 1},       {1.001, 1, 0.999}, {1.2, 1, 0.8},     {2, 2, 2},          {0.1, 0.1, 0.1},
      {10, 1, 0.1},    {1000, 1, 0.001},  {1000, 1000, 1},   {1000, 1, 1},       {1, 1, 0.001},
      {1, 1, 1e-6},    {1, 1, 1e-10},     {1, 0.001, 0.001}, {1, 1e-3, 1e-6},    {1, 1e-5, 1e-5},
      {1, 1e-6, 1e-6}, {1e4, 100, 1},     {1e5, 1, 1},       {1e-9, 2e-9, 1e-9}, {3e9, 1e9, 1e9},
  };
  uint64_t seed = 3;
  for (size_t k = 0; k < sizeof s / sizeof *s; k++)
    for (int repeat = 0; repeat < 100; repeat++) {
      double F[9], exact[9], R[9];
      double largest = fmax(s[k][0], fmax(s[k][1], s[k][2]));
      double turn = largest / (s[k][0] + s[k][1] + s[k][2] - largest);
      build(&seed, s[k], F, exact);
      assert_ok(corot_polar(F, R));
      assert_rotation(R);
      assert_below(distance(R, exact), 8 * eps * (1 + turn));
      assert_stretch(F, R, 8 * eps * (1 + turn));
    }
}

static void a_rotation_is_its_own_factor(void **state) {
  (void)state;
  uint64_t seed = 5;
  double R[9];
  assert_ok(corot_polar(identity, R));
  assert_memory_equal(R, identity, sizeof R); /* to the bit: rest is free of stress */
  for (int repeat = 0; repeat < 1000; repeat++) {
    double Q[9];
    random_rotation(&seed, Q);
    assert_ok(corot_polar(Q, R));
    assert_below(distance(R, Q), 4 * eps);
  }
}

/* Gradients of every shape: those with a positive determinant have a factor, the others none. */
static void random_gradients_have_a_factor_or_are_refused(void **state) {
  (void)state;
  uint64_t seed = 7;
  int refused = 0;
  for (int repeat = 0; repeat < 20000; repeat++) {
    double F[9], R[9];
    for (int k = 0; k < 9; k++) F[k] = noise(&seed);
    double det = determinant(F);
    if (fabs(det) < 1e-6) continue; /* there R may be ill-defined */
    if (det < 0) {
      assert_fails(corot_polar(F, R), COROT_RETRY, "det F");
      refused++;
      continue;
    }
    assert_ok(corot_polar(F, R));
    assert_rotation(R);
    assert_stretch(F, R, 1e-9); /* s1^2 / (s2 s3) reaches 1e6 here */
  }
  assert_true(refused > 5000);
}

static void the_scale_of_a_gradient_does_not_matter(void **state) {
  (void)state;
  static const double scale[] = {1e-300, 1e-150, 1e-30, 1e-8, 1e8, 1e30, 1e150, 1e300};
  uint64_t seed = 9;
  for (int repeat = 0; repeat < 50; repeat++) {
    double F[9], R[9], exact[9], stretch[3] = {1.5, 1.0, 0.5};
    build(&seed, stretch, F, exact);
    for (size_t k = 0; k < sizeof scale / sizeof *scale; k++) {
      double scaled[9];
      for (int i = 0; i < 9; i++) scaled[i] = scale[k] * F[i];
      assert_ok(corot_polar(scaled, R));
      assert_rotation(R);
      assert_below(distance(R, exact), 20 * eps);
    }
  }
}

static void what_has_no_factor_is_refused(void **state) {
  (void)state;
  double zero[9] = {0}, R[9] = {7};
  double rank1[9] = {1, 2, 3, 2, 4, 6, 3, 6, 9}, rank2[9] = {1, 0, 0, 0, 1, 0, 0, 0, 0};
  double mirror[9] = {1, 0, 0, 0, 1, 0, 0, 0, -1}, flat[9] = {1, 0, 0, 0, 1, 0, 0, 0, -1e-12};
  double point[9] = {-1, 0, 0, 0, -1, 0, 0, 0, -1};
  const double *none[] = {zero, rank1, rank2, mirror, flat, point};
  for (size_t k = 0; k < sizeof none / sizeof *none; k++)
    assert_fails(corot_polar(none[k], R), COROT_RETRY, "det F");

  static const double special[] = {NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 9; k++)
    for (int i = 0; i < 3; i++) {
      double F[9];
      memcpy(F, identity, sizeof F);
      F[k] = special[i];
      assert_fails(corot_polar(F, R), COROT_RETRY, "det F");
    }
  assert_true(R[0] == 7); /* the output is untouched */
}

/* det F is rounding: whatever the answer, it is a rotation or a refusal. */
static void a_nearly_singular_gradient_gives_a_rotation_or_nothing(void **state) {
  (void)state;
  static const double s[][3] = {{1, 1, 1e-16}, {1, 1, -1e-16}, {1, 1e-9, 1e-9}, {1, 1e-12, 0},
                                {1, 0, 0},     {1e6, 1, 1e-6}, {1, 1, 0},       {1, 1e-16, 1e-16}};
  uint64_t seed = 13;
  for (size_t k = 0; k < sizeof s / sizeof *s; k++)
    for (int repeat = 0; repeat < 200; repeat++) {
      double F[9], R[9], exact[9];
      build(&seed, s[k], F, exact);
      corot_status status = corot_polar(F, R);
      assert_true(status == COROT_OK || status == COROT_RETRY);
      if (!status) assert_rotation(R);
    }
}

enum { POOL = 40 };

/* Tame, wild, singular, inverted, and not a number. */
static void fill_pool(uint64_t *seed, double pool[POOL][9]) {
  static const double s[8][3] = {{1, 1, 1},    {1.1, 1, 0.9},   {100, 1, 0.01}, {1, 1, 1e-12},
                                 {50, 50, 50}, {1, 1e-4, 1e-4}, {1, 1, -1},     {1, 1, 0}};
  for (int k = 0; k < POOL; k++) {
    double R[9];
    build(seed, s[k % 8], pool[k], R);
  }
  memcpy(pool[0], identity, sizeof identity);
  memset(pool[1], 0, sizeof pool[1]);
  pool[2][4] = NAN;
  pool[3][0] = INFINITY;
}

/* R is a pure function of F: the same bits in any lane beside any neighbours. */
static void a_lane_does_not_feel_its_neighbours(void **state) {
  (void)state;
  uint64_t seed = 17;
  double pool[POOL][9], alone[POOL][9];
  int refused[POOL];
  fill_pool(&seed, pool);
  for (int k = 0; k < POOL; k++) {
    vi inverted;
    mat3 R = polar(mat3_load(pool[k]), &inverted);
    mat3_store(R, 0, alone[k]);
    refused[k] = inverted[0] != 0;
  }
  for (int repeat = 0; repeat < 5000; repeat++) {
    int pick[W];
    mat3 F;
    for (int l = 0; l < W; l++) {
      pick[l] = (int)((noise(&seed) + 1) / 2 * POOL);
      EACH_IJ F.m[i][j][l] = pool[pick[l]][3 * i + j];
    }
    vi inverted;
    mat3 R = polar(F, &inverted);
    for (int l = 0; l < W; l++) {
      double lane[9];
      mat3_store(R, l, lane);
      assert_memory_equal(lane, alone[pick[l]], sizeof lane);
      assert_int_equal(inverted[l] != 0, refused[pick[l]]);
    }
  }
}

static void gram_schmidt_makes_an_upper_triangle(void **state) {
  (void)state;
  uint64_t seed = 19;
  for (int repeat = 0; repeat < 1000; repeat++) {
    double A[9], Q[9], T[9], G[9];
    random_gradient(&seed, 0.6, A);
    mat3_store(gram_schmidt(mat3_load(A)), repeat % W, Q);
    multiply_transposed(Q, A, T);
    multiply_transposed(Q, Q, G);
    /* both lose digits with the sine of the angle between the first two columns */
    double size = largest_entry(A), tolerance = 8 * eps * fmax(1, size / T[4]);
    assert_below(distance(G, identity), tolerance);
    assert_close(determinant(Q), 1, 0, tolerance);
    assert_below(fmax(fabs(T[3]), fmax(fabs(T[6]), fabs(T[7]))), size * tolerance);
    assert_above(T[0], 0);
    assert_above(T[4], 0);
    assert_true((T[8] > 0) == (determinant(A) > 0));
  }
}

/* Fourth-order central difference of a frame rule along dF: truncation h^4, rounding eps / h. */
static void difference(frame_rule rule, const double F[9], const double dF[9], const mat3 *Q0,
                       double out[9]) {
  static const double at[4] = {-2, -1, 1, 2}, weight[4] = {1. / 12, -2. / 3, 2. / 3, -1. / 12};
  double h = 1e-3;
  memset(out, 0, 9 * sizeof *out);
  for (int p = 0; p < 4; p++) {
    double moved[9], R[9];
    for (int k = 0; k < 9; k++) moved[k] = F[k] + at[p] * h * dF[k];
    vi inverted;
    mat3_store(frame_of(rule, mat3_load(moved), Q0, &inverted), 0, R);
    assert_false(inverted[0]);
    for (int k = 0; k < 9; k++) out[k] += weight[p] * R[k] / h;
  }
}

static void frame_derivatives_are_those_of_the_frames(void **state) {
  (void)state;
  static const frame_rule rules[] = {FRAME_POLAR, FRAME_WARP, FRAME_IDENTITY};
  uint64_t seed = 23;
  for (int repeat = 0; repeat < 300; repeat++) {
    double F[9], dF[9], T[9], Q[9], rest[9], fd[9], dR[9], R[9];
    random_gradient(&seed, 0.25, T);
    random_rotation(&seed, Q);
    random_rotation(&seed, rest);
    multiply(Q, T, F);
    for (int k = 0; k < 9; k++) dF[k] = noise(&seed);
    mat3 Q0 = mat3_load(rest);
    for (int k = 0; k < 3; k++) {
      vi inverted;
      mat3 frame = frame_of(rules[k], mat3_load(F), &Q0, &inverted);
      mat3 change = frame_derivative(rules[k], mat3_load(F), &Q0, frame, mat3_load(dF));
      mat3_store(frame, 0, R);
      mat3_store(change, 0, dR);
      difference(rules[k], F, dF, &Q0, fd);
      assert_below(distance(dR, fd), 1e-9); /* (h / s)^4 with s the smallest stretch, 0.2 */

      double skew[9];
      multiply_transposed(R, dR, skew);
      for (int i = 0; i < 9; i++) assert_close(skew[i], -skew[3 * (i % 3) + i / 3], 0, 1e-14);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(finds_the_factor_a_gradient_was_built_from),
      cmocka_unit_test(a_rotation_is_its_own_factor),
      cmocka_unit_test(random_gradients_have_a_factor_or_are_refused),
      cmocka_unit_test(the_scale_of_a_gradient_does_not_matter),
      cmocka_unit_test(what_has_no_factor_is_refused),
      cmocka_unit_test(a_nearly_singular_gradient_gives_a_rotation_or_nothing),
      cmocka_unit_test(a_lane_does_not_feel_its_neighbours),
      cmocka_unit_test(gram_schmidt_makes_an_upper_triangle),
      cmocka_unit_test(frame_derivatives_are_those_of_the_frames),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
