/* Where conjugate gradients do not converge, and what is taken for convergence. */
#include "alloc.h"
#include "bar.h"
#include "solve/pencil/pencil.h"
#include "solver.h"

/* A square plate of this thickness, held at one edge. */
static body make_plate(double thickness) {
  corot_box box = {.size = {1, 1, thickness}, .cells = {4, 4, 1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_material steel = {.lambda = 1.15e11, .mu = 7.7e10, .density = 7800};
  corot_fix edge = {"xmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &steel, def.nfix = 1, def.fix = &edge;
  return make_body(mesh, def);
}

/* The matrix of a time step of h at rest. */
static corot_pencil *pencil_of(const body *b, const corot_linear_def *def, double h) {
  corot_pencil *p;
  double *rest = calloc(b->n, sizeof *rest);
  assert_ok(corot_pencil_create(b->model, b->state, def, &p));
  assert_ok(corot_pencil_assemble(p, 0, rest, rest));
  corot_pencil_combine(p, 1, h, h * h);
  assert_ok(corot_pencil_factor(p));
  free(rest);
  return p;
}

static const char *const preconditioners[] = {"block-jacobi", "incomplete-cholesky"};

/* Its weight bends a plate of 1e-4 of its size; the stiffness is 1e11 times as large in the plane.
   What rounding leaves of the residual is above the tolerance, yet no solver leaves less: the
   solution is as right as a direct solver's. */
static void a_residual_of_mere_rounding_is_convergence(void **state) {
  (void)state;
  body b = make_plate(1e-4);
  double *f = malloc(3 * b.n * sizeof *f), *x = f + b.n, *y = x + b.n;
  for (int i = 0; i < b.n; i++) f[i] = i % 3 == 2 ? -9.81 * corot_model_mass(b.model)[i] : 0;
  corot_pencil *klu = pencil_of(&b, SOLVER("klu"), 0.5);
  assert_ok(corot_pencil_solve(klu, f, x));
  for (int k = 0; k < 2; k++) {
    corot_linear_def def = *SOLVER("pcg");
    def.preconditioner = preconditioners[k];
    corot_pencil *pcg = pencil_of(&b, &def, 0.5);
    assert_ok(corot_pencil_solve(pcg, f, y));
    /* both are off by up to eps times the condition number of bending against bending */
    assert_below(difference_of(b.n, x, y), 1e-6 * norm_max(b.n, x));
    assert_int_equal(corot_pencil_statistics(pcg).nlsfail, 0);
    corot_pencil_destroy(pcg);
  }
  free(f), corot_pencil_destroy(klu), drop_body(&b);
}

/* Squares of such numbers are zero, or infinite. */
static void tiny_and_huge_right_hand_sides_are_solved_for(void **state) {
  (void)state;
  body b = make_plate(0.1);
  corot_pencil *pcg = pencil_of(&b, SOLVER("pcg"), 1e-4);
  double *f = malloc(3 * b.n * sizeof *f), *x = f + b.n, *y = x + b.n;
  for (int i = 0; i < b.n; i++) f[i] = cos(3.1 * i);
  assert_ok(corot_pencil_solve(pcg, f, x));
  static const int powers[] = {-900, -600, 600, 900}; /* of two, so that every bit agrees */
  for (int k = 0; k < 4; k++) {
    for (int i = 0; i < b.n; i++) y[i] = ldexp(f[i], powers[k]);
    assert_ok(corot_pencil_solve(pcg, y, y));
    for (int i = 0; i < b.n; i++) y[i] = ldexp(y[i], -powers[k]);
    assert_below(difference_of(b.n, x, y), 1e-8 * norm_max(b.n, x));
  }
  free(f), corot_pencil_destroy(pcg), drop_body(&b);
}

/* A solver of its own with a limit of iterations. */
static corot_status solve_within(const body *b, long most, corot_role role, double *x) {
  corot_csc *lower;
  corot_linear_def def = *SOLVER("pcg");
  linsol_plan plan;
  void *solver;
  bool fresh;
  def.role = role;
  assert_ok(corot_csc_create(b->model, COROT_LOWER, &lower));
  corot_pencil *p = pencil_of(b, SOLVER("pcg"), 1e-2);
  assert_ok(corot_linsol_choose(&def, lower, &plan));
  assert_int_equal(plan.most_iterations, 0); /* it was named */
  plan.most_iterations = most;
  assert_ok(plan.ops->create(lower, &plan, &solver));
  assert_ok(plan.ops->factor(solver, p->S, &fresh));
  corot_status status = plan.ops->solve(solver, x);
  plan.ops->destroy(solver);
  corot_linsol_plan_clear(&plan);
  corot_pencil_destroy(p);
  corot_csc_destroy(lower);
  return status;
}

static void a_failure_says_how_far_it_came_and_what_to_use(void **state) {
  (void)state;
  body b = make_plate(0.01);
  double *x = malloc(b.n * sizeof *x);
  for (int role = COROT_ROLE_DYNAMIC; role <= COROT_ROLE_STATIC; role++) {
    for (int i = 0; i < b.n; i++) x[i] = 1;
    assert_fails(solve_within(&b, 7, role, x), COROT_RETRY, "did not converge in 7 iterations");
    assert_fails(COROT_OK, COROT_OK, "of the right-hand side, tolerance 1.0e-10");
    assert_fails(COROT_OK, COROT_OK, "; use a direct linear_solver: ");
    for (int i = 0; i < b.n; i++) assert_true(x[i] == 1); /* left alone */
  }
  free(x), drop_body(&b);
}

/* --- Conjugate gradients that were not asked for --------------------------------------------- */

static corot_status never_converges(void *solver, double *x) {
  (void)solver, (void)x;
  return corot_fail(COROT_RETRY, "pcg: did not converge");
}

/* A pencil that has chosen conjugate gradients, and finds that they do not converge. */
static corot_pencil *make_tentative(const body *b) {
  static linsol_ops hopeless;
  corot_pencil *p = pencil_of(b, SOLVER("pcg"), 1e-2);
  hopeless = *p->chosen.ops;
  hopeless.solve = never_converges;
  p->tentative = true;
  p->chosen.ops = &hopeless;
  return p;
}

static void a_direct_solver_takes_the_place_of_one_chosen_in_vain(void **state) {
  (void)state;
  body b = make_plate(0.01);
  corot_pencil *p = make_tentative(&b), *klu = pencil_of(&b, SOLVER("klu"), 1e-2);
  double *f = malloc(3 * b.n * sizeof *f), *x = f + b.n, *y = x + b.n;
  for (int i = 0; i < b.n; i++) f[i] = y[i] = cos(i);
  assert_ok(corot_pencil_solve(klu, f, x));
  for (int k = 0; k < 2; k++) {
    memcpy(y, f, b.n * sizeof *f);
    assert_ok(corot_pencil_solve(p, k == 0 ? f : y, y));
    assert_below(difference_of(b.n, x, y), 1e-9 * norm_max(b.n, x));
  }
  assert_int_equal(
      strncmp(corot_pencil_solver(p), corot_linsol_direct, strlen(corot_linsol_direct)), 0);
  corot_pencil_counts counts = corot_pencil_statistics(p);
  assert_int_equal(counts.nlsfail, 1);
  assert_int_equal(counts.nsolve, 3);

  /* and is there for what follows */
  corot_pencil_combine(p, 1, 0, 0);
  assert_ok(corot_pencil_factor(p));
  assert_ok(corot_pencil_solve(p, f, y));
  for (int i = 0; i < b.n; i++)
    assert_close(y[i] * corot_model_mass(b.model)[i], f[i], 1e-12, 1e-12);
  free(f), corot_pencil_destroy(p), corot_pencil_destroy(klu), drop_body(&b);
}

/* One that was named is not replaced. */
static void a_solver_that_was_named_stays(void **state) {
  (void)state;
  body b = make_plate(0.01);
  corot_pencil *p = make_tentative(&b);
  double *f = calloc(b.n, sizeof *f);
  f[0] = 1;
  p->tentative = false;
  assert_fails(corot_pencil_solve(p, f, f), COROT_RETRY, "did not converge");
  assert_int_equal(strncmp(corot_pencil_solver(p), "pcg", 3), 0);
  assert_int_equal(corot_pencil_statistics(p).nlsfail, 1);
  free(f), corot_pencil_destroy(p), drop_body(&b);
}

static void without_memory_for_another_the_first_stays(void **state) {
  (void)state;
  body b = make_plate(0.01);
  corot_pencil *p = make_tentative(&b);
  double *f = malloc(b.n * sizeof *f);
  corot_status status = COROT_ENOMEM;
  long k = 0;
  while (status == COROT_ENOMEM) {
    for (int i = 0; i < b.n; i++) f[i] = 1;
    alloc_fail_at(++k);
    status = corot_pencil_solve(p, f, f);
    alloc_fail_at(0);
    bool replaced = strncmp(corot_pencil_solver(p), "pcg", 3) != 0;
    if (replaced != (status == COROT_OK)) fail_msg("allocation %ld: status %d", k, (int)status);
  }
  assert_ok(status);
  assert_true(k > 10);
  assert_int_equal(corot_pencil_statistics(p).nlsfail, k);
  free(f), corot_pencil_destroy(p), drop_body(&b);
}

/* Iterations that cost more than twice what a direct solver would have: the next factor is its,
   if there is memory for it. */
static void a_direct_solver_takes_the_place_of_a_dear_one(void **state) {
  (void)state;
  body b = make_plate(1e-4);
  double *f = malloc(2 * b.n * sizeof *f), *x = f + b.n;
  for (int i = 0; i < b.n; i++) f[i] = cos(i);
  for (int broke = 0; broke < 2; broke++) {
    corot_pencil *p = pencil_of(&b, SOLVER("pcg"), 0.5);
    p->tentative = true;
    assert_ok(corot_pencil_solve(p, f, x));
    long iterations = corot_pencil_statistics(p).niteration;
    assert_true(iterations > 120);
    p->chosen.rival = (linsol_rival){iterations, 0}; /* the factor that there was is worth it */
    assert_ok(corot_pencil_factor(p));
    assert_int_equal(strncmp(corot_pencil_solver(p), "pcg", 3), 0);
    p->chosen.rival = (linsol_rival){1, 1};
    alloc_fail_at(broke);
    assert_ok(corot_pencil_factor(p));
    alloc_fail_at(0);
    assert_int_equal(strncmp(corot_pencil_solver(p), "pcg", 3) == 0, broke);
    assert_ok(corot_pencil_solve(p, f, x));
    corot_pencil_counts counts = corot_pencil_statistics(p);
    assert_int_equal(counts.niteration, (1 + broke) * iterations);
    assert_int_equal(counts.nlsfail, 0);
    corot_pencil_destroy(p);
  }
  free(f), drop_body(&b);
}

/* What "auto" takes conjugate gradients for has a limit of iterations, from where on it would have
   been faster without. */
static void a_choice_has_a_limit(void **state) {
  (void)state;
  corot_box box = {.size = {1, 1, 1}, .cells = {14, 14, 14}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  body b = make_body(mesh, def);
  corot_csc *lower;
  linsol_plan plan;
  corot_linear_def linear = corot_linear_defaults();
  assert_ok(corot_csc_create(b.model, COROT_LOWER, &lower));
  assert_ok(corot_linsol_choose(&linear, lower, &plan));
  bool iterates = plan.ops->iterations != NULL;
  assert_int_equal(iterates, strcmp(corot_linsol_direct, "klu") == 0); /* where that is the rival */
  assert_true(iterates ? plan.most_iterations > 1000 : plan.most_iterations == 0);
  assert_true((plan.rival.factor > 1000) == iterates);
  corot_linsol_plan_clear(&plan);
  corot_csc_destroy(lower), drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_residual_of_mere_rounding_is_convergence),
      cmocka_unit_test(tiny_and_huge_right_hand_sides_are_solved_for),
      cmocka_unit_test(a_failure_says_how_far_it_came_and_what_to_use),
      cmocka_unit_test(a_direct_solver_takes_the_place_of_one_chosen_in_vain),
      cmocka_unit_test(a_solver_that_was_named_stays),
      cmocka_unit_test(without_memory_for_another_the_first_stays),
      cmocka_unit_test(a_direct_solver_takes_the_place_of_a_dear_one),
      cmocka_unit_test(a_choice_has_a_limit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
