/* The five strain measures: closed forms, and the stress as the gradient of the energy. */
#include <float.h>

#include "core/element/strain.h"
#include "solid.h"

static const double lambda = 1.5, mu = 1;

/* Stress, energy density and viscous stress of one gradient, from one lane of the kernels. */
static void stress_of(int measure, const double F[9], const double R[9], double P[9]) {
  mat3_store(
      stress(&strain_measures[measure], vd_all(lambda), vd_all(mu), mat3_load(F), mat3_load(R)), 0,
      P);
}

static double energy_of(int measure, const double F[9], const double R[9]) {
  return strain_energy(&strain_measures[measure], vd_all(lambda), vd_all(mu), mat3_load(F),
                       mat3_load(R), NULL)[0];
}

static void viscous_of(int measure, double damping_lambda, double damping_mu, const double F[9],
                       const double R[9], const double V[9], double P[9]) {
  mat3_store(stress_viscous(&strain_measures[measure], vd_all(damping_lambda), vd_all(damping_mu),
                            mat3_load(F), mat3_load(R), mat3_load(V)),
             0, P);
}

/* The measure's own frame; warp's edges are the axes. */
static void frame(int measure, const double F[9], double R[9]) {
  vi inverted;
  mat3 Q0 = mat3_identity();
  mat3_store(frame_of(strain_measures[measure].frame, mat3_load(F), &Q0, &inverted), 0, R);
  assert_false(inverted[0]);
}

static double dot(const double A[9], const double B[9]) {
  double sum = 0;
  for (int k = 0; k < 9; k++) sum += A[k] * B[k];
  return sum;
}

static double trace(const double A[9]) { return A[0] + A[4] + A[8]; }

/* sym(A' B) */
static void symmetric(const double A[9], const double B[9], double C[9]) {
  double T[9];
  multiply_transposed(A, B, T);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) C[3 * i + j] = 0.5 * (T[3 * i + j] + T[3 * j + i]);
}

/* A gradient far from rest, its determinant positive: a rotation times a moderate stretch. */
static void random_deformation(uint64_t *seed, double F[9]) {
  double Q[9], T[9];
  random_rotation(seed, Q);
  random_gradient(seed, 0.3, T);
  multiply(Q, T, F);
}

static void simple_shear_of_polar_strain(void **state) {
  (void)state;
  static const double gammas[] = {-2, -0.3, 1e-8, 0.1, 1, 3};
  for (size_t k = 0; k < sizeof gammas / sizeof *gammas; k++) {
    double g = gammas[k], F[9] = {1, g, 0, 0, 1, 0, 0, 0, 1}, R[9], P[9];
    double root = sqrt(4 + g * g), c = 2 / root, s = g / root, t = g * g / (root + 2);
    double rotated[9] = {c, s, 0, -s, c, 0, 0, 0, 1};
    double expected[9] = {2 * mu * (1 - c) + lambda * t * c,
                          2 * mu * (g - s) + lambda * t * s,
                          0,
                          2 * mu * s - lambda * t * s,
                          2 * mu * (1 - c) + lambda * t * c,
                          0,
                          0,
                          0,
                          lambda * t};
    frame(POLAR, F, R);
    assert_below(distance(R, rotated), 1e-15);
    assert_close(atan2(R[1], R[0]), atan(g / 2), 0, 1e-15);
    stress_of(POLAR, F, R, P);
    assert_below(distance(P, expected), 1e-14);
    if (g == 1) { /* the same, in digits */
      assert_close(P[1], 1.263932, 0, 5e-7);
      assert_close(P[3], 0.736068, 0, 5e-7);
      assert_close(P[0], 0.527864, 0, 5e-7);
      assert_close(P[4], 0.527864, 0, 5e-7);
      assert_close(P[8], 0.354102, 0, 5e-7);
    }
  }
}

/* The warping frame of simple shear along the first axis turns by nothing or by atan(gamma),
   depending on which edge is the first; the polar factor turns by atan(gamma / 2). */
static void simple_shear_turns_the_warp_frame_by_choice_of_edge(void **state) {
  (void)state;
  static const double edges[2][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 1, 1, 0, 0, 0, 1, 0}};
  for (int first = 0; first < 2; first++) {
    double g = 0.7, F[9] = {1, g, 0, 0, 1, 0, 0, 0, 1}, R[9], angle = first ? atan(g) : 0;
    vi inverted;
    mat3 Q0 = mat3_load(edges[first]);
    mat3_store(frame_of(FRAME_WARP, mat3_load(F), &Q0, &inverted), 0, R);
    double expected[9] = {cos(angle), sin(angle), 0, -sin(angle), cos(angle), 0, 0, 0, 1};
    assert_below(distance(R, expected), 1e-15);
  }
}

/* The same through a model, where the mesh's order of a tet's nodes makes the choice. */
static void the_mesh_chooses_the_warp_edges(void **state) {
  (void)state;
  static const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static const struct {
    int tet[4];
    double turns; /* in units of atan(gamma) */
  } order[] = {{{0, 1, 2, 3}, 0}, {{0, 2, 3, 1}, 1}, {{0, 3, 1, 2}, 0}};
  for (size_t k = 0; k < 3; k++) {
    double g = 0.7, u[12] = {0}, R[1][9], angle = order[k].turns * atan(g);
    corot_mesh *mesh;
    assert_ok(corot_mesh_create(4, x, 1, &order[k].tet, &mesh));
    corot_model_def def = corot_model_defaults();
    def.mesh = mesh, def.strain = "warp", def.nmaterial = 1, def.material = &soft;
    corot_model *model;
    corot_state *s;
    assert_ok(corot_model_create(&def, &model));
    assert_ok(corot_state_create(model, &s));
    u[corot_model_dof(model)[2][0]] = g; /* the node at height one moves along x */
    assert_ok(corot_elements(model, s, 0, u, &(corot_element_fields){.frame = R}));
    double expected[9] = {cos(angle), sin(angle), 0, -sin(angle), cos(angle), 0, 0, 0, 1};
    assert_below(distance(R[0], expected), 1e-15);
    corot_state_destroy(s), corot_model_destroy(model), corot_mesh_destroy(mesh);
  }
}

/* Stress and energy of every measure from its formula, at a random gradient and frame. */
static void stress_and_energy_are_the_formulas(void **state) {
  (void)state;
  uint64_t seed = 31;
  for (int repeat = 0; repeat < 200; repeat++) {
    double F[9], R[9], S[9], E[9], green[9];
    random_deformation(&seed, F);
    random_rotation(&seed, R);
    symmetric(R, F, S);
    multiply_transposed(F, F, green);
    for (int k = 0; k < 9; k++) E[k] = S[k] - identity[k], green[k] = (green[k] - identity[k]) / 2;
    double by_frame[9], by_gradient[9], expected[9], P[9];
    multiply(R, E, by_frame);
    multiply(F, green, by_gradient);
    for (int m = 0; m < NSTRAIN; m++) {
      double p = lambda * trace(m == HYBRID || m == GREEN ? green : E);
      const double *Bp = m == HYBRID || m == GREEN ? F : R, *e = m == GREEN ? green : E;
      for (int k = 0; k < 9; k++)
        expected[k] = p * Bp[k] + 2 * mu * (m == GREEN ? by_gradient[k] : by_frame[k]);
      stress_of(m, F, R, P);
      assert_below(distance(P, expected), 1e-13); /* strains of order ten: 100 eps or so */
      assert_close(energy_of(m, F, R), p * p / (2 * lambda) + mu * dot(e, e), 1e-13, 0);
    }
  }
}

/* P : dF against a central difference of the energy, fourth order in h; frames follow F if `exact`,
   and are any rotation if not. Returns the error relative to the stress. */
static double gradient_error(int measure, bool exact, uint64_t *seed) {
  static const double at[4] = {-2, -1, 1, 2}, weight[4] = {1. / 12, -2. / 3, 2. / 3, -1. / 12};
  double F[9], R[9], dF[9], P[9], h = 1e-3, slope = 0;
  random_deformation(seed, F);
  random_rotation(seed, R);
  for (int k = 0; k < 9; k++) dF[k] = noise(seed);
  if (exact) frame(measure, F, R);
  stress_of(measure, F, R, P);
  for (int p = 0; p < 4; p++) {
    double moved[9], there[9];
    for (int k = 0; k < 9; k++) moved[k] = F[k] + at[p] * h * dF[k];
    memcpy(there, R, sizeof there);
    if (exact) frame(measure, moved, there);
    slope += weight[p] * energy_of(measure, moved, there) / h;
  }
  return fabs(slope - dot(P, dF)) / sqrt(dot(P, P) * dot(dF, dF));
}

static void stress_is_the_gradient_of_the_energy(void **state) {
  (void)state;
  uint64_t seed = 37;
  for (int repeat = 0; repeat < 200; repeat++)
    for (int m = 0; m < NSTRAIN; m++) {
      assert_below(gradient_error(m, false, &seed), 1e-10);
      if (m != WARP) assert_below(gradient_error(m, true, &seed), 1e-9);
    }
  /* the force of exact warping frames has no energy; the difference is that of the frames */
  double worst = 0;
  for (int repeat = 0; repeat < 200; repeat++)
    worst = fmax(worst, gradient_error(WARP, true, &seed));
  assert_above(worst, 1e-2);
}

/* An isotropic material does not feel a rotation before the deformation, P(F Q) = P(F) Q; the
   stress turns with a rotation after it, P(Q F) = Q P(F). Warp's edges break the first, cauchy's
   fixed frame both. */
static void stress_is_isotropic_and_objective(void **state) {
  (void)state;
  uint64_t seed = 41;
  double broken[NSTRAIN][2] = {{0}};
  for (int repeat = 0; repeat < 100; repeat++)
    for (int m = 0; m < NSTRAIN; m++) {
      double F[9], Q[9], R[9], P[9], FQ[9], QF[9], expected[9], actual[9];
      random_deformation(&seed, F);
      random_rotation(&seed, Q);
      frame(m, F, R), stress_of(m, F, R, P);
      multiply(F, Q, FQ), multiply(P, Q, expected);
      frame(m, FQ, R), stress_of(m, FQ, R, actual);
      broken[m][0] = fmax(broken[m][0], distance(actual, expected));
      multiply(Q, F, QF), multiply(Q, P, expected);
      frame(m, QF, R), stress_of(m, QF, R, actual);
      broken[m][1] = fmax(broken[m][1], distance(actual, expected));
    }
  for (int m = 0; m < NSTRAIN; m++) {
    bool isotropic = m != CAUCHY && m != WARP, objective = m != CAUCHY;
    if (isotropic)
      assert_below(broken[m][0], 1e-13);
    else
      assert_above(broken[m][0], 0.1);
    if (objective)
      assert_below(broken[m][1], 1e-13);
    else
      assert_above(broken[m][1], 0.1);
  }
}

/* The power P : V of the viscous stress is damping_lambda (Bp : V)^2 + 2 damping_mu |sym(Bs' V)|^2,
   never negative, and the stress is linear in the rate. */
static void viscous_stress_dissipates(void **state) {
  (void)state;
  uint64_t seed = 43;
  for (int repeat = 0; repeat < 200; repeat++)
    for (int m = 0; m < NSTRAIN; m++) {
      double F[9], R[9], V[9], U[9], rate[9], P[9], Q[9], both[9];
      double dl = 1 + noise(&seed), dm = 1 + noise(&seed);
      random_deformation(&seed, F);
      random_rotation(&seed, R);
      for (int k = 0; k < 9; k++) V[k] = noise(&seed), U[k] = noise(&seed);
      const double *Bp = m == HYBRID || m == GREEN ? F : R, *Bs = m == GREEN ? F : R;
      symmetric(Bs, V, rate);
      viscous_of(m, dl, dm, F, R, V, P);
      double power = dot(P, V);
      assert_true(power >= 0);
      assert_close(power, dl * dot(Bp, V) * dot(Bp, V) + 2 * dm * dot(rate, rate), 1e-13, 0);
      viscous_of(m, dl, dm, F, R, U, Q);
      for (int k = 0; k < 9; k++) U[k] = 2 * V[k] - 3 * U[k], Q[k] = 2 * P[k] - 3 * Q[k];
      viscous_of(m, dl, dm, F, R, U, both);
      assert_below(distance(both, Q), 1e-12);
    }
}

/* What the table says of a measure is what its stress does. */
static void traits_are_true(void **state) {
  (void)state;
  uint64_t seed = 53;
  for (int m = 0; m < NSTRAIN; m++) {
    const corot_strain_kind *kind = corot_strain_traits(m);
    double F[9], G[9], sum[9], R[9], P[9], Q[9], both[9], moved[9];
    random_deformation(&seed, F), random_deformation(&seed, G);
    for (int k = 0; k < 9; k++) sum[k] = F[k] + G[k] - identity[k];

    frame(m, F, R);
    assert_true(kind->frames == (distance(R, identity) > 1e-3));
    stress_of(m, F, R, P), stress_of(m, G, R, Q), stress_of(m, sum, R, both);
    stress_of(m, identity, R, moved);
    for (int k = 0; k < 9; k++) moved[k] = P[k] + Q[k] - moved[k];
    assert_true(kind->linear_in_frames == (distance(moved, both) < 1e-12));
    assert_true(kind->linear == (kind->linear_in_frames && !kind->frames));
    assert_false(kind->polar && !kind->frames);
    assert_false(kind->exact && kind->frames);

    assert_ptr_equal(corot_strain_find(kind->name), kind);
  }
  assert_null(corot_strain_traits(NSTRAIN));
  assert_null(corot_strain_traits(-1));
  assert_null(corot_strain_find("almansi"));
  assert_null(corot_strain_find(NULL));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(simple_shear_of_polar_strain),
      cmocka_unit_test(simple_shear_turns_the_warp_frame_by_choice_of_edge),
      cmocka_unit_test(the_mesh_chooses_the_warp_edges),
      cmocka_unit_test(stress_and_energy_are_the_formulas),
      cmocka_unit_test(stress_is_the_gradient_of_the_energy),
      cmocka_unit_test(stress_is_isotropic_and_objective),
      cmocka_unit_test(viscous_stress_dissipates),
      cmocka_unit_test(traits_are_true),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
