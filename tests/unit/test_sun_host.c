/* What corot/host.h offers a host's integrator: error weights, stops, whether a change is felt,
   products, preconditioners and equilibria, each against what it stands for. */
#include <kinsol/kinsol.h>

#include <corot/host.h>
#include <corot/statics.h>
#include <corot/sun_kinsol.h>
#include <nvector/nvector_serial.h>

#include "bar.h"
#include "solve/sundials/sun_compat.h"
#include "solver.h"

static SUNContext context(void) {
  SUNContext ctx;
  assert_int_equal(sun_context_create(&ctx), 0);
  return ctx;
}

static double *values(N_Vector x) { return N_VGetArrayPointer(x); }

static N_Vector random_vector(int n, double size, uint64_t seed, SUNContext ctx) {
  N_Vector x = N_VNew_Serial(n, ctx);
  for (int i = 0; i < n; i++) values(x)[i] = size * noise(&seed);
  return x;
}

/* --- Weights and advice ----------------------------------------------------------------------- */

/* By the longest vector of a node, which a rotation of everything leaves as it is. */
static void weights_do_not_change_when_everything_is_turned(void **state) {
  (void)state;
  SUNContext ctx = context();
  double first[2] = {0};
  for (int turned = 0; turned < 2; turned++) {
    bar_def def = example2;
    if (turned) rotation((double[]){1, 2, 3}, 0.8, def.Q);
    bar b = bar_create(&def);
    const int(*dof)[3] = corot_model_dof(b.model);
    N_Vector y = N_VNew_Serial(2 * b.n, ctx), w = N_VClone(y);
    for (int node = 0; node < corot_model_mesh(b.model)->nnode; node++) {
      const double k = node + 1, u[] = {1e-3 * k, -2e-3, 0}, v[] = {0, 0.1, -0.2 * k};
      double Qu[3], Qv[3];
      apply(def.Q, u, Qu), apply(def.Q, v, Qv);
      for (int c = 0; c < 3 && dof[node][0] >= 0; c++) {
        values(y)[dof[node][c]] = Qu[c];
        values(y)[b.n + dof[node][c]] = Qv[c];
      }
    }
    corot_sun_data d = {.model = b.model,
                        .state = b.state,
                        .rtol = 1e-3,
                        .atol_displacement = 1e-9,
                        .atol_velocity = 1e-8};
    assert_int_equal(corot_sun_weights(y, w, &d), 0);
    for (int i = 0; i < b.n; i++) {
      assert_true(values(w)[i] == values(w)[0] && values(w)[b.n + i] == values(w)[b.n]);
    }
    for (int k = 0; k < 2; k++)
      if (turned) assert_close(values(w)[k * b.n], first[k], 1e-14, 0);
    first[0] = values(w)[0], first[1] = values(w)[b.n];
    N_VConst(INFINITY, y);
    assert_true(corot_sun_weights(y, w, &d) < 0); /* no step is short enough */
    N_VDestroy(y), N_VDestroy(w);
    bar_destroy(&b);
  }
  SUNContext_Free(&ctx);
}

static void advice_is_what_our_own_integrators_choose(void **state) {
  (void)state;
  static const char *const names[] = {"cvode", "ida", "arkode"};
  const double rtol[] = {1e-3, 1e-4, 1e-6, 1e-8}, damping[] = {0, 1, 300};
  for (int k = 0; k < 36; k++) {
    bar_def of = example2;
    of.damping = damping[k / 12];
    bar b = bar_create(&of);
    corot_integrator_def def = corot_integrator_defaults();
    def.method = names[k % 3], def.rtol = rtol[k / 3 % 4];
    corot_integrator *integrator = start(&b, &def);
    corot_integrator_choice c = corot_integrator_chosen(integrator);
    corot_sun_advice a;
    assert_ok(corot_sun_advise(b.model, (corot_sun_method)(k % 3), def.rtol, &a));
    assert_true(a.atol_displacement == c.atol_displacement && a.atol_velocity == c.atol_velocity);
    assert_int_equal(a.max_order, c.max_order);
    assert_int_equal(a.tangent, c.tangent);
    assert_int_equal(a.reassembly, c.reassembly);
    assert_int_equal(a.refactorisation, c.refactorisation);
    assert_true(a.gamma_change == c.gamma_change && a.convergence == c.convergence);
    if (a.table) assert_string_equal(a.table, c.table);
    if (a.table) assert_int_equal(a.predictor, c.predictor);
    corot_integrator_destroy(integrator);
    bar_destroy(&b);
  }
}

/* --- Stops ------------------------------------------------------------------------------------ */

static void stops_are_at_kinks_and_where_amplitudes_set_out(void **state) {
  (void)state;
  bar b = bar_create(&example2); /* a kink at 10 s */
  corot_sun_stop s = corot_sun_next_stop(b.model, 0, 0.1, 20);
  assert_true(s.t == 10 && s.kink && !s.sets_out);
  s = corot_sun_next_stop(b.model, 0, 0.1, 9);
  assert_true(s.t == 9 && !s.kink);
  s = corot_sun_next_stop(b.model, 0, 0.1, 10); /* a stop of the host's at a kink is both */
  assert_true(s.t == 10 && s.kink);
  s = corot_sun_next_stop(b.model, 10, 0.1, 20); /* behind us, exactly or but for rounding */
  assert_true(s.t == 20 && !s.kink);
  s = corot_sun_next_stop(b.model, 10 * (1 - 1e-15), 0.1, 20);
  assert_true(s.t == 20 && !s.kink);
  s = corot_sun_next_stop(NULL, 0, 0, 3);
  assert_true(s.t == 3 && !s.kink);
  bar_destroy(&b);
}

/* Of a body at rest under a load: a jump that the next step turns into less than half of the
   tolerance is not felt, one of more is, and then the first step makes half of it. */
static void a_change_is_felt_by_what_the_next_step_makes_of_it(void **state) {
  (void)state;
  SUNContext ctx = context();
  bar b = bar_create(&example2);
  corot_pencil *pencil;
  assert_ok(corot_pencil_create(b.model, b.state, NULL, &pencil));
  assert_ok(corot_pencil_assemble(pencil, 0, b.u, b.v));
  corot_pencil_combine(pencil, 1, 1e-3, 1e-6);
  assert_ok(corot_pencil_factor(pencil));
  N_Vector jump = N_VNew_Serial(2 * b.n, ctx), w = N_VClone(jump);
  bool felt;
  double h;
  N_VConst(1, w);
  for (int strong = 0; strong < 2; strong++) {
    N_VConst(0, jump);
    for (int i = b.n; i < 2 * b.n; i++) values(jump)[i] = strong ? 1e3 : 1;
    double size = N_VWrmsNorm(jump, w);
    assert_ok(corot_sun_felt(pencil, jump, w, 0, 0.2, 0.1, &felt, &h));
    assert_int_equal(felt, strong);
    assert_close(h, strong ? 0.5 / size : 0.2, 1e-14, 0);
  }
  corot_pencil_destroy(pencil);
  N_VDestroy(jump), N_VDestroy(w);
  SUNContext_Free(&ctx);
  bar_destroy(&b);
}

/* --- Newton's system and Krylov methods ------------------------------------------------------- */

static const corot_mass masses[] = {COROT_MASS_LUMPED, COROT_MASS_CONSISTENT};

typedef struct rig {
  bar b;
  corot_mass_solver *mass;
  corot_pencil *pencil;
  SUNContext ctx;
  N_Vector y, x, z, r;
  corot_sun_data d;
} rig;

static void rig_open(rig *g, corot_mass kind) {
  bar_def def = example2;
  def.damping = 50;
  *g = (rig){.b = bar_create(&def), .ctx = context()};
  /* the same with the mass asked for: at rest all bars are alike */
  corot_model *model;
  corot_model_def with = corot_model_defaults();
  corot_material material = soft;
  corot_fix base = {"zmin", {true, true, true}};
  with.mesh = corot_model_mesh(g->b.model), with.mass = kind;
  with.nmaterial = 1, with.material = &material, with.nfix = 1, with.fix = &base;
  assert_ok(corot_model_create(&with, &model));
  corot_state_destroy(g->b.state), corot_model_destroy(g->b.model);
  g->b.model = model;
  assert_ok(corot_state_create(model, &g->b.state));
  assert_ok(corot_mass_solver_create(model, &g->mass));
  assert_ok(corot_pencil_create(model, g->b.state, SOLVER("klu"), &g->pencil));
  corot_pencil_use(g->pencil, COROT_TANGENT_EXACT);
  int n = 2 * g->b.n;
  g->y = random_vector(n, 1e-3, 1, g->ctx);
  for (int i = g->b.n; i < n; i++) values(g->y)[i] = 0; /* K is that of v = 0 */
  g->x = random_vector(n, 1, 2, g->ctx);
  g->z = N_VClone(g->y), g->r = N_VClone(g->y);
  g->d =
      (corot_sun_data){.model = model, .state = g->b.state, .mass = g->mass, .pencil = g->pencil};
}

static void rig_close(rig *g) {
  N_VDestroy(g->y), N_VDestroy(g->x), N_VDestroy(g->z), N_VDestroy(g->r);
  corot_pencil_destroy(g->pencil);
  corot_mass_solver_destroy(g->mass);
  SUNContext_Free(&g->ctx);
  bar_destroy(&g->b);
}

/* Off by how much, of the larger: of u and of v. */
static void assert_same(rig *g, N_Vector a, N_Vector b, double rtol) {
  for (int k = 0; k < 2; k++) {
    const double *p = values(a) + k * g->b.n, *q = values(b) + k * g->b.n;
    assert_below(difference_of(g->b.n, p, q), rtol * norm_max(g->b.n, q));
  }
}

/* J x is the difference of f: central, of steps whose rounding and third derivative are below 1e-6.
 */
static void products_are_differences_of_the_right_hand_side(void **state) {
  (void)state;
  for (int m = 0; m < 2; m++) {
    rig g;
    rig_open(&g, masses[m]);
    double e = 1e-7;
    N_Vector plus = N_VClone(g.y), minus = N_VClone(g.y), f = N_VClone(g.y);
    N_VLinearSum(1, g.y, e, g.x, plus), N_VLinearSum(1, g.y, -e, g.x, minus);
    assert_int_equal(corot_sun_jtimes(g.x, g.z, 0, g.y, NULL, &g.d, NULL), 0);
    assert_int_equal(corot_sun_rhs(0, plus, g.r, &g.d), 0);
    assert_int_equal(corot_sun_rhs(0, minus, f, &g.d), 0);
    N_VLinearSum(0.5 / e, g.r, -0.5 / e, f, f);
    assert_same(&g, g.z, f, 1e-5);

    /* of the residual form along (x, cj x) */
    double cj = 30;
    N_Vector yp = N_VClone(g.y);
    assert_int_equal(corot_sun_jtimes_dae(0, g.y, NULL, NULL, g.x, g.z, cj, &g.d, NULL, NULL), 0);
    N_VScale(e * cj, g.x, yp);
    assert_int_equal(corot_sun_residual(0, plus, yp, g.r, &g.d), 0);
    N_VScale(-1, yp, yp);
    assert_int_equal(corot_sun_residual(0, minus, yp, f, &g.d), 0);
    N_VLinearSum(0.5 / e, g.r, -0.5 / e, f, f);
    assert_same(&g, g.z, f, 1e-5);
    N_VDestroy(plus), N_VDestroy(minus), N_VDestroy(f), N_VDestroy(yp);
    rig_close(&g);
  }
}

/* The preconditioner undoes I - gamma J, and dF/dy + cj dF/dy', but for what K and D leave out to
   be symmetric, which at v = 0 is nothing under dead loads: to rounding times the condition. */
static void preconditioners_undo_the_products(void **state) {
  (void)state;
  for (int m = 0; m < 2; m++) {
    rig g;
    rig_open(&g, masses[m]);
    sunbooleantype made = 0;
    double gamma = 0.02;
    assert_int_equal(corot_sun_psetup(0, g.y, NULL, 0, &made, gamma, &g.d), 0);
    assert_true(made);
    assert_int_equal(corot_sun_psetup(0, g.y, NULL, 1, &made, gamma, &g.d), 0);
    assert_true(!made);
    assert_int_equal(corot_sun_jtimes(g.x, g.z, 0, g.y, NULL, &g.d, NULL), 0);
    N_VLinearSum(1, g.x, -gamma, g.z, g.r);
    assert_int_equal(corot_sun_psolve(0, g.y, NULL, g.r, g.z, gamma, 0, 1, &g.d), 0);
    assert_same(&g, g.z, g.x, 1e-9);

    assert_int_equal(corot_sun_psetup_dae(0, g.y, NULL, NULL, 1 / gamma, &g.d), 0);
    assert_int_equal(
        corot_sun_jtimes_dae(0, g.y, NULL, NULL, g.x, g.r, 1 / gamma, &g.d, NULL, NULL), 0);
    assert_int_equal(corot_sun_psolve_dae(0, g.y, NULL, NULL, g.r, g.z, 1 / gamma, 0, &g.d), 0);
    assert_same(&g, g.z, g.x, 1e-9);

    /* Newton's system is that of a step, and of no other combination */
    corot_pencil_combine(g.pencil, 0, 0, 1);
    assert_fails(corot_pencil_newton(g.pencil, values(g.r), values(g.z)), COROT_EINVAL,
                 "not M + g D + g^2 K");
    rig_close(&g);
  }
}

/* S from the parts, multiplied by hand, is a M + b D + c K. */
static void the_parts_of_a_pencil_are_what_it_combines(void **state) {
  (void)state;
  rig g;
  rig_open(&g, COROT_MASS_LUMPED);
  int n = g.b.n;
  double *x = values(g.x), *y = values(g.z), *k = values(g.r), *d = k + n;
  assert_ok(corot_pencil_assemble(g.pencil, 0, values(g.y), values(g.y) + n));
  corot_pencil_combine(g.pencil, 2, 3, 5);
  corot_pencil_parts p = corot_pencil_view(g.pencil);
  corot_block_multiply(g.b.model, p.K, x, k);
  corot_block_multiply(g.b.model, p.D, x, d);
  corot_mass_multiply(g.b.model, x, y);
  for (int i = 0; i < n; i++) y[n + i] = 2 * y[i] + 3 * d[i] + 5 * k[i], y[i] = 0;
  for (int j = 0; j < n; j++) /* klu's pattern has both triangles */
    for (int e = p.csc->colptr[j]; e < p.csc->colptr[j + 1]; e++) y[p.csc->row[e]] += p.S[e] * x[j];
  assert_below(difference_of(n, y, y + n), 1e-13 * norm_max(n, y));
  rig_close(&g);
}

/* --- Equilibria ------------------------------------------------------------------------------- */

static void derivatives_of_an_equilibrium_are_differences_of_its_force(void **state) {
  (void)state;
  SUNContext ctx = context();
  bar b = bar_create(&example2);
  corot_pencil *pencil;
  corot_linear_def linear = corot_linear_defaults();
  linear.role = COROT_ROLE_STATIC;
  assert_ok(corot_pencil_create(b.model, b.state, &linear, &pencil));
  corot_pencil_use(pencil, COROT_TANGENT_EXACT);
  corot_sun_data d = {.model = b.model, .state = b.state, .pencil = pencil};
  N_Vector u = random_vector(b.n, 1e-3, 3, ctx), x = random_vector(b.n, 1, 4, ctx);
  N_Vector F = N_VClone(u), G = N_VClone(u), at = N_VClone(u);
  assert_int_equal(corot_sun_force(u, F, &d), COROT_EINVAL); /* it does not stand still */
  assert_non_null(strstr(corot_error(), "corot_state_stand_still"));
  corot_state_stand_still(b.state, 20, 1);

  double e = 1e-7;
  N_VLinearSum(1, u, e, x, at);
  assert_int_equal(corot_sun_force(at, F, &d), 0);
  N_VLinearSum(1, u, -e, x, at);
  assert_int_equal(corot_sun_force(at, G, &d), 0);
  N_VLinearSum(0.5 / e, F, -0.5 / e, G, F);
  assert_int_equal(corot_sun_jtimes_static(x, G, u, NULL, &d), 0);
  assert_below(difference_of(b.n, values(F), values(G)), 1e-5 * norm_max(b.n, values(G)));
  assert_int_equal(corot_sun_psetup_static(u, NULL, NULL, NULL, &d), 0);
  assert_int_equal(corot_sun_psolve_static(u, NULL, NULL, NULL, G, &d), 0);
  assert_below(difference_of(b.n, values(x), values(G)), 1e-8 * norm_max(b.n, values(x)));

  N_VDestroy(u), N_VDestroy(x), N_VDestroy(F), N_VDestroy(G), N_VDestroy(at);
  corot_pencil_destroy(pencil);
  SUNContext_Free(&ctx);
  bar_destroy(&b);
}

/* The equilibrium of corot_statics, to what a relative residual of 1e-10 leaves of a bar that bends
   far more easily than it stretches. A load that is too much at once is a matter of the step. */
static void a_hosts_kinsol_finds_the_equilibrium(void **state) {
  (void)state;
  SUNContext ctx = context();
  bar_def def = example2;
  def.cells[2] = 3;
  bar b = bar_create(&def);
  corot_pencil *pencil, *moving;
  corot_linear_def linear = corot_linear_defaults();
  linear.role = COROT_ROLE_STATIC;
  assert_ok(corot_pencil_create(b.model, b.state, &linear, &pencil));
  assert_ok(corot_pencil_create(b.model, b.state, NULL, &moving));
  N_Vector u = N_VNew_Serial(b.n, ctx);
  N_VConst(0, u);
  void *kinsol = KINCreate(ctx);
  assert_int_equal(KINInit(kinsol, corot_sun_force, u), 0);
  corot_sun_rest rest = {0};
  corot_sun_data d = {.model = b.model, .state = b.state};
  assert_fails(corot_sun_kinsol_open(&rest, kinsol, moving, &d, u), COROT_EINVAL, "not static");
  assert_ok(corot_sun_kinsol_open(&rest, kinsol, pencil, &d, u));
  for (double factor = 0.125; factor <= 1; factor += 0.125)
    assert_ok(corot_sun_kinsol_solve(&rest, 20, factor, 1e-10, u));

  corot_statics *statics;
  corot_statics_def how = corot_statics_defaults();
  double *right = malloc(b.n * sizeof *right);
  assert_ok(corot_statics_create(&how, b.model, 20, NULL, &statics));
  assert_ok(corot_statics_solve(statics));
  corot_statics_at(statics, right);
  assert_below(difference_of(b.n, values(u), right), 1e-7 * norm_max(b.n, right));

  /* what lies beyond rounding is not asked for, and nothing is where an element inverts */
  assert_ok(corot_sun_kinsol_solve(&rest, 20, 1, 1e-30, u));
  N_VConst(0, u);
  assert_true(corot_sun_kinsol_solve(&rest, 20, 1e9, 1e-10, u) != COROT_OK);
  N_VConst(0, u);
  assert_ok(corot_sun_kinsol_solve(&rest, 20, 0.125, 1e-10, u));
  corot_statics_destroy(statics);
  free(right);
  KINFree(&kinsol);
  corot_sun_rest_close(&rest);
  corot_sun_rest_close(&rest);
  corot_pencil_destroy(pencil), corot_pencil_destroy(moving);
  N_VDestroy(u);
  SUNContext_Free(&ctx);
  bar_destroy(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(weights_do_not_change_when_everything_is_turned),
      cmocka_unit_test(advice_is_what_our_own_integrators_choose),
      cmocka_unit_test(stops_are_at_kinks_and_where_amplitudes_set_out),
      cmocka_unit_test(a_change_is_felt_by_what_the_next_step_makes_of_it),
      cmocka_unit_test(products_are_differences_of_the_right_hand_side),
      cmocka_unit_test(preconditioners_undo_the_products),
      cmocka_unit_test(the_parts_of_a_pencil_are_what_it_combines),
      cmocka_unit_test(derivatives_of_an_equilibrium_are_differences_of_its_force),
      cmocka_unit_test(a_hosts_kinsol_finds_the_equilibrium),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
