/* The pencil: S = a M + b D + c K, its factor, its books; and what happens without memory. */
#include "alloc.h"
#include "bar.h"
#include "solver.h"

#include <corot/solve.h>

typedef struct making {
  bar *bar;
  const char *what; /* a linear solver, or a method of integration */
} making;

static bar a_bar(void) {
  bar b = bar_create(&example2);
  uint64_t seed = 5;
  for (int i = 0; i < b.n; i++) b.u[i] = 1e-3 * noise(&seed), b.v[i] = noise(&seed);
  return b;
}

/* y = S x from the definition. */
static void product(const bar *b, corot_tangent tangent, const double abc[3], const double *x,
                    double *y) {
  int nblock = corot_model_nblock(b->model);
  double(*K)[9] = malloc(2 * nblock * sizeof *K), (*D)[9] = K + nblock;
  double *Dx = malloc(2 * b->n * sizeof *Dx), *Mx = Dx + b->n;
  assert_ok(corot_jacobian(b->model, b->state, 0, b->u, b->v, tangent, K, D));
  corot_block_multiply(b->model, (const double(*)[9])K, x, y);
  corot_block_multiply(b->model, (const double(*)[9])D, x, Dx);
  corot_mass_multiply(b->model, x, Mx);
  for (int i = 0; i < b->n; i++) y[i] = abc[0] * Mx[i] + abc[1] * Dx[i] + abc[2] * y[i];
  free(K), free(Dx);
}

static void it_solves_the_system_it_names(void **state) {
  (void)state;
  const double abc[] = {2, 0.03, 0.004};
  bar b = a_bar();
  double *x = malloc(3 * b.n * sizeof *x), *y = x + b.n, *z = y + b.n;
  uint64_t seed = 9;
  for (int i = 0; i < b.n; i++) x[i] = noise(&seed);
  for (int tangent = COROT_TANGENT_HELD; tangent <= COROT_TANGENT_EXACT; tangent++) {
    corot_pencil *p;
    assert_ok(corot_pencil_create(b.model, b.state, SOLVER("klu"), &p));
    assert_int_equal(strncmp(corot_pencil_solver(p), "klu, ", 5), 0);
    corot_pencil_use(p, tangent);
    assert_ok(corot_pencil_assemble(p, 0, b.u, b.v));
    corot_pencil_combine(p, abc[0], abc[1], abc[2]);
    assert_ok(corot_pencil_factor(p));
    product(&b, tangent, abc, x, y);
    assert_ok(corot_pencil_solve(p, y, z));
    assert_below(difference_of(b.n, z, x), 1e-12);
    assert_ok(corot_pencil_solve(p, y, y)); /* in place */
    assert_int_equal(memcmp(y, z, b.n * sizeof *y), 0);
    corot_pencil_destroy(p);
  }
  free(x);
  bar_destroy(&b);
}

static void it_keeps_books(void **state) {
  (void)state;
  bar b = a_bar();
  double *x = calloc(b.n, sizeof *x);
  corot_pencil *p;
  assert_ok(corot_pencil_create(b.model, b.state, SOLVER("klu"), &p));
  assert_fails(corot_pencil_solve(p, x, x), COROT_EINVAL, "there is no factor");
  assert_ok(corot_pencil_assemble(p, 0, b.u, b.v));
  for (int k = 0; k < 3; k++) {
    corot_pencil_combine(p, 1, 0.01, 0.01);
    assert_ok(corot_pencil_factor(p));
    assert_ok(corot_pencil_solve(p, x, x));
  }
  corot_pencil_combine(p, 0, 0, 0);
  assert_fails(corot_pencil_factor(p), COROT_ESINGULAR, "degree of freedom");
  corot_pencil_counts c = corot_pencil_statistics(p);
  assert_int_equal(c.nassembly, 1);
  assert_int_equal(c.ncombine, 4);
  assert_int_equal(c.nfactor, 4);
  assert_int_equal(c.nsolve, 4);
  assert_int_equal(c.nfresh, 2);
  assert_int_equal(c.nindefinite, 0);
  assert_true(c.assembly_s > 0 && c.combine_s > 0 && c.factor_s > 0 && c.solve_s > 0);
  corot_pencil_destroy(p);

  corot_pencil_destroy(NULL);
  free(x);
  bar_destroy(&b);
}

/* A Green bar squeezed to half its length along its axis, well past the point where its material
   softens: K is indefinite. */
static bar a_squeezed_bar(void) {
  bar_def def = example2;
  def.strain = "green", def.cells[0] = def.cells[1] = 2;
  bar b = bar_create(&def);
  const corot_mesh *mesh = corot_model_mesh(b.model);
  const int(*dof)[3] = corot_model_dof(b.model);
  for (int i = 0; i < mesh->nnode; i++)
    if (dof[i][2] >= 0) b.u[dof[i][2]] = -0.5 * mesh->x[i][2];
  return b;
}

/* That S x = b holds for S of the definition. */
static void check_solution(const bar *b, corot_pencil *p, corot_tangent tangent,
                           const double abc[3]) {
  double *x = malloc(3 * b->n * sizeof *x), *y = x + b->n, *z = y + b->n;
  uint64_t seed = 9;
  for (int i = 0; i < b->n; i++) x[i] = noise(&seed);
  product(b, tangent, abc, x, y);
  assert_ok(corot_pencil_solve(p, y, z));
  assert_below(difference_of(b->n, z, x), 1e-8);
  free(x);
}

static const char *const definite[] = {"cholmod", "pcg"}; /* what S has to be */

static bool squeezed_pencil(const bar *b, const corot_linear_def *def, corot_pencil **p) {
  if (corot_pencil_create(b->model, b->state, def, p) != COROT_OK) return false;
  corot_pencil_use(*p, COROT_TANGENT_EXACT);
  assert_ok(corot_pencil_assemble(*p, 0, b->u, b->v));
  return true;
}

static void clamping_makes_it_definite(void **state) {
  (void)state;
  bar b = a_squeezed_bar();
  const double abc[] = {1, 0.1, 0.01}, early[] = {1, 1e-4, 1e-8};
  for (int k = 0; k < 2; k++) {
    corot_pencil *p;
    if (!squeezed_pencil(&b, SOLVER_TO(definite[k], 1e-12), &p)) continue;
    corot_pencil_combine(p, early[0], early[1], early[2]); /* the mass outweighs it */
    assert_ok(corot_pencil_factor(p));
    check_solution(&b, p, COROT_TANGENT_EXACT, early);
    assert_int_equal(corot_pencil_statistics(p).nindefinite, 0);

    corot_pencil_combine(p, abc[0], abc[1], abc[2]);
    assert_ok(corot_pencil_factor(p));
    corot_pencil_counts c = corot_pencil_statistics(p);
    assert_int_equal(c.nindefinite, 1);
    assert_int_equal(c.nclamped, 1);
    assert_int_equal(c.nfallback, 0);
    assert_int_equal(c.nassembly, 2);
    assert_int_equal(c.nfactor, 3);
    check_solution(&b, p, COROT_TANGENT_CLAMPED, abc);

    corot_pencil_combine(p, 2, 0.1, 0.01); /* K stays clamped */
    assert_ok(corot_pencil_factor(p));
    assert_int_equal(corot_pencil_statistics(p).nindefinite, 1);
    assert_ok(corot_pencil_assemble(p, 0, b.u, b.v)); /* until now */
    corot_pencil_combine(p, abc[0], abc[1], abc[2]);
    assert_ok(corot_pencil_factor(p));
    assert_int_equal(corot_pencil_statistics(p).nclamped, 2);
    corot_pencil_destroy(p);
  }
  bar_destroy(&b);
}

/* Negative mass, which no clamping of K makes up for. */
static void klu_solves_what_stays_indefinite(void **state) {
  (void)state;
  bar b = a_squeezed_bar();
  const double abc[] = {-1e5, 0, 1}, positive[] = {1, 1e-4, 1e-8};
  for (int k = 0; k < 2; k++)
    for (int tangent = COROT_TANGENT_HELD; tangent <= COROT_TANGENT_CLAMPED; tangent++) {
      corot_pencil *p;
      if (!squeezed_pencil(&b, SOLVER_TO(definite[k], 1e-12), &p)) continue;
      bool clamped = tangent == COROT_TANGENT_CLAMPED;
      corot_pencil_use(p, tangent);
      assert_ok(corot_pencil_assemble(p, 0, b.u, b.v));
      for (int again = 1; again <= 2; again++) {
        corot_pencil_combine(p, abc[0], abc[1], abc[2]);
        assert_ok(corot_pencil_factor(p));
        corot_pencil_counts c = corot_pencil_statistics(p);
        assert_int_equal(c.nindefinite, again);
        assert_int_equal(c.nclamped, 0);
        assert_int_equal(c.nfallback, again);
        assert_int_equal(c.nassembly, clamped ? 2 : 2 + 2 * again);
        check_solution(&b, p, tangent, abc);
      }
      corot_pencil_combine(p, positive[0], positive[1], positive[2]);
      assert_ok(corot_pencil_factor(p));
      assert_int_equal(corot_pencil_statistics(p).nfallback, 2);
      check_solution(&b, p, tangent, positive);
      corot_pencil_destroy(p);
    }
  bar_destroy(&b);
}

static void statics_sees_what_is_indefinite(void **state) {
  (void)state;
  bar b = a_squeezed_bar();
  for (int k = 0; k < 2; k++) {
    corot_linear_def def = *SOLVER(definite[k]);
    def.role = COROT_ROLE_STATIC;
    corot_pencil *p;
    if (!squeezed_pencil(&b, &def, &p)) continue;
    corot_pencil_combine(p, 0, 0, 1);
    assert_fails(corot_pencil_factor(p), COROT_RETRY, "not positive definite");
    corot_pencil_counts c = corot_pencil_statistics(p);
    assert_int_equal(c.nindefinite, 1);
    assert_int_equal(c.nclamped + c.nfallback, 0);
    assert_int_equal(c.nassembly, 1);
    corot_pencil_destroy(p);
  }
  bar_destroy(&b);
}

/* The klu that has to help. */
static corot_status make_fallback(void *context) {
  const bar *b = ((const making *)context)->bar;
  corot_pencil *p;
  COROT_TRY(corot_pencil_create(b->model, b->state, SOLVER(((const making *)context)->what), &p));
  corot_status status = corot_pencil_assemble(p, 0, b->u, b->v);
  corot_pencil_combine(p, -1e5, 0, 1);
  if (!status) status = corot_pencil_factor(p);
  corot_pencil_destroy(p);
  return status;
}

static void a_fallback_survives_failed_allocations(void **state) {
  (void)state;
  bar b = a_squeezed_bar();
  for (int k = 0; k < 2; k++) {
    making fallback = {&b, definite[k]};
    if (make_fallback(&fallback) == COROT_OK)
      assert_true(assert_survives_failed_allocations(make_fallback, &fallback) > 15);
  }
  bar_destroy(&b);
}

static void an_inverted_element_has_no_matrix(void **state) {
  (void)state;
  bar b = a_bar();
  corot_pencil *p;
  assert_ok(corot_pencil_create(b.model, b.state, NULL, &p));
  b.u[b.tip + 2] = -0.5;
  assert_fails(corot_pencil_assemble(p, 0, b.u, b.v), COROT_RETRY, "is inverted");
  corot_pencil_destroy(p);
  bar_destroy(&b);
}

static void an_unknown_solver_is_refused(void **state) {
  (void)state;
  bar b = a_bar();
  corot_pencil *p = (corot_pencil *)&b;
  assert_fails(corot_pencil_create(b.model, b.state, SOLVER("gauss"), &p), COROT_EINVAL, "'gauss'");
  assert_ptr_equal(p, &b);
  bar_destroy(&b);
}

static corot_status make_pencil(void *context) {
  const making *m = context;
  corot_pencil *p;
  COROT_TRY(corot_pencil_create(m->bar->model, m->bar->state, SOLVER(m->what), &p));
  corot_pencil_destroy(p);
  return COROT_OK;
}

static corot_status make_integrator(void *context) {
  const making *m = context;
  corot_integrator_def def = corot_integrator_defaults();
  def.method = m->what;
  def.step = 0.1;
  corot_integrator *integrator;
  COROT_TRY(corot_integrator_create(&def, m->bar->model, m->bar->state, 0, m->bar->u, m->bar->v,
                                    &integrator));
  corot_integrator_destroy(integrator);
  return COROT_OK;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  static const char *const solvers[] = {"klu", "cholmod", "pcg"};
  static const char *const methods[] = {"cvode", "bdf2", "generalized-alpha"};
  bar b = a_bar();
  for (int k = 0; k < 3; k++) {
    making pencil = {&b, solvers[k]}, integrator = {&b, methods[k]};
    if (make_pencil(&pencil) == COROT_OK) /* cholmod may not be in this build */
      assert_true(assert_survives_failed_allocations(make_pencil, &pencil) > 5);
    assert_true(assert_survives_failed_allocations(make_integrator, &integrator) > 7);
  }
  corot_integrator_destroy(NULL);
  bar_destroy(&b);
}

/* Those of SUNDIALS and KLU are theirs; ours are all made before the first step. */
static void no_step_allocates(void **state) {
  (void)state;
  const char *const methods[] = {"cvode", "bdf3", "newmark"};
  for (int m = 0; m < 3; m++) {
    bar b = bar_create(&example2);
    corot_integrator_def def = corot_integrator_defaults();
    def.method = methods[m];
    def.step = 0.01;
    corot_integrator *integrator = start(&b, &def);
    corot_step step = {0};
    alloc_fail_at(0);
    for (int k = 0; k < 200; k++) {
      assert_ok(corot_integrator_step(integrator, 40, &step));
      assert_ok(corot_integrator_at(integrator, step.t - step.h / 2, b.u, b.v));
      double dissipated, external;
      assert_ok(corot_integrator_work(integrator, step.t, &dissipated, &external));
      if (k % 20 == 19) assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
    }
    assert_int_equal(alloc_count(), 0);
    corot_integrator_destroy(integrator);
    bar_destroy(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_solves_the_system_it_names),
      cmocka_unit_test(it_keeps_books),
      cmocka_unit_test(clamping_makes_it_definite),
      cmocka_unit_test(klu_solves_what_stays_indefinite),
      cmocka_unit_test(statics_sees_what_is_indefinite),
      cmocka_unit_test(a_fallback_survives_failed_allocations),
      cmocka_unit_test(an_inverted_element_has_no_matrix),
      cmocka_unit_test(an_unknown_solver_is_refused),
      cmocka_unit_test(failed_allocations_are_survived),
      cmocka_unit_test(no_step_allocates),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
