/* The pencil as SUNDIALS sees it, against SUNDIALS' own KLU on the full 2n x 2n system. */
#include <corot/solve.h>
#include <cvodes/cvodes.h>
#include <idas/idas.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>

#include "full_system.h"
#include "solve/sundials/sun_ark.h"
#include "solve/sundials/vector.h"
#include "solver.h"

static SUNContext context(void) {
  SUNContext ctx;
  assert_int_equal(sun_context_create(&ctx), 0);
  return ctx;
}

/* The full system, which the pencil is held against, has M^-1 as factors of its rows. */
static bar_def lumped_bar(void) {
  bar_def def = example2;
  def.lumped = true;
  return def;
}

static bar a_bar(double damping) {
  bar_def def = lumped_bar();
  def.damping = damping;
  bar b = bar_create(&def);
  uint64_t seed = 5;
  for (int i = 0; i < b.n; i++) b.u[i] = 1e-3 * noise(&seed), b.v[i] = noise(&seed);
  return b;
}

/* Solves both for the same right-hand side, in which r_u is not zero. The two eliminate in another
   order, so they differ by rounding times the condition of S: 1e4 at most, at the largest gamma. */
static void the_reduced_solve_equals_the_full_one(void **state) {
  (void)state;
  const double gamma[] = {1e-6, 1e-4, 1e-2, 0.3, 5};
  SUNContext ctx = context();
  bar b = a_bar(100);
  int n = b.n;
  N_Vector y = N_VMake_Serial(2 * n, b.u, ctx), r = N_VClone(y), x = N_VClone(y),
           expected = N_VClone(y);
  corot_pencil *pencil;
  assert_ok(corot_pencil_create(b.model, b.state, SOLVER("klu"), &pencil));
  SUNMatrix A = corot_sun_matrix(pencil, ctx);
  SUNLinearSolver LS = corot_sun_linsol(pencil, ctx);
  full_system full = full_create(&b);
  SUNMatrix F = SUNSparseMatrix(2 * n, 2 * n, full_nnz(&full), CSC_MAT, ctx);

  for (int k = 0; k < 5; k++) {
    uint64_t seed = 17 + k;
    for (int i = 0; i < n; i++) {
      N_VGetArrayPointer(r)[i] = noise(&seed);
      N_VGetArrayPointer(r)[n + i] = 100 * noise(&seed);
    }
    sunbooleantype current = SUNFALSE;
    assert_int_equal(
        corot_sun_linsys(0, y, NULL, A, k > 0, &current, gamma[k], NULL, NULL, NULL, NULL), 0);
    assert_int_equal(current, k == 0);
    assert_int_equal(SUNLinSolSetup(LS, A), 0);
    assert_int_equal(SUNLinSolSolve(LS, A, x, r, 0), 0);

    assert_ok(full_fill(&full, 0, b.u, 1, gamma[k], F));
    SUNLinearSolver klu = SUNLinSol_KLU(expected, F, ctx);
    assert_int_equal(SUNLinSolSetup(klu, F), 0);
    assert_int_equal(SUNLinSolSolve(klu, F, expected, r, 0), 0);
    SUNLinSolFree(klu);

    const double *du = N_VGetArrayPointer(x), *full_du = N_VGetArrayPointer(expected);
    assert_below(difference_of(n, du, full_du) / norm_max(n, full_du), 1e-11);
    assert_below(difference_of(n, du + n, full_du + n) / norm_max(n, full_du + n), 1e-11);
  }
  SUNMatDestroy(F);
  full_destroy(&full);
  SUNLinSolFree(LS);
  SUNMatDestroy(A);
  corot_pencil_destroy(pencil);
  N_VDestroy(y), N_VDestroy(r), N_VDestroy(x), N_VDestroy(expected);
  bar_destroy(&b);
  SUNContext_Free(&ctx);
}

/* A host's own CVODE, on the pencil or on the full system. */
typedef struct host {
  corot_sun_data data; /* first: user_data of corot_sun_rhs */
  full_system full;
  double rtol, atol_u, atol_v;
} host;

static int full_jacobian(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user_data,
                         N_Vector tmp1, N_Vector tmp2, N_Vector tmp3) {
  (void)fy, (void)tmp1, (void)tmp2, (void)tmp3;
  const host *h = user_data;
  return full_fill(&h->full, t, N_VGetArrayPointer(y), 0, -1, J);
}

static double longest(const corot_model *model, const double *x) {
  const int(*dof)[3] = corot_model_dof(model);
  double square = 0;
  for (int n = 0; n < corot_model_mesh(model)->nnode; n++) {
    double sum = 0;
    for (int c = 0; c < 3; c++)
      if (dof[n][c] >= 0) sum += x[dof[n][c]] * x[dof[n][c]];
    square = fmax(square, sum);
  }
  return sqrt(square);
}

static int weights(N_Vector y, N_Vector w, void *user_data) {
  const host *h = user_data;
  int n = corot_model_ndof(h->data.model);
  const double *u = N_VGetArrayPointer(y);
  double wu = 1 / (h->rtol * longest(h->data.model, u) + h->atol_u);
  double wv = 1 / (h->rtol * longest(h->data.model, u + n) + h->atol_v);
  for (int i = 0; i < 2 * n; i++) N_VGetArrayPointer(w)[i] = i < n ? wu : wv;
  return 0;
}

typedef struct outcome {
  long nst, nfe, nsetups, nni, netf;
} outcome;

/* From rest to t_end with the tolerances of `chosen`; the last state goes to y [2n]. */
static outcome run_host(const bar *b, bool full, double rtol, corot_integrator_choice chosen,
                        double t_end, double *y_end) {
  SUNContext ctx = context();
  N_Vector y = N_VNew_Serial(2 * b->n, ctx);
  corot_vector_quicken(y); /* as ours are, so that every bit agrees */
  N_VConst(0, y);
  host h = {{b->model, b->state, NULL},
            full_create(b),
            rtol,
            chosen.atol_displacement,
            chosen.atol_velocity};
  corot_pencil *pencil;
  assert_ok(corot_pencil_create(b->model, b->state, SOLVER("klu"), &pencil));
  SUNMatrix A = full ? SUNSparseMatrix(2 * b->n, 2 * b->n, full_nnz(&h.full), CSC_MAT, ctx)
                     : corot_sun_matrix(pencil, ctx);
  SUNLinearSolver LS = full ? SUNLinSol_KLU(y, A, ctx) : corot_sun_linsol(pencil, ctx);
  void *cvode = CVodeCreate(CV_BDF, ctx);
  int bad =
      CVodeInit(cvode, corot_sun_rhs, 0, y) || CVodeSetUserData(cvode, &h) ||
      CVodeWFtolerances(cvode, weights) || CVodeSetMaxOrd(cvode, chosen.max_order) ||
      CVodeSetStabLimDet(cvode, chosen.max_order > 2) || CVodeSetMaxNumSteps(cvode, -1) ||
      CVodeSetLinearSolver(cvode, LS, A) ||
      CVodeSetLSetupFrequency(cvode, chosen.refactorisation) ||
      CVodeSetNonlinConvCoef(cvode, chosen.convergence) ||
      (full ? CVodeSetJacFn(cvode, full_jacobian) : CVodeSetLinSysFn(cvode, corot_sun_linsys)) ||
      CVodeSetJacEvalFrequency(cvode, chosen.reassembly) || CVodeSetStopTime(cvode, t_end);
  assert_int_equal(bad, 0);
  for (double t = 0; t < t_end;) assert_true(CVode(cvode, 2 * t_end, y, &t, CV_ONE_STEP) >= 0);
  outcome o;
  long nje;
  CVodeGetNumSteps(cvode, &o.nst), CVodeGetNumRhsEvals(cvode, &o.nfe);
  CVodeGetNumLinSolvSetups(cvode, &o.nsetups), CVodeGetNumNonlinSolvIters(cvode, &o.nni);
  CVodeGetNumErrTestFails(cvode, &o.netf), CVodeGetNumJacEvals(cvode, &nje);
  if (!full) assert_int_equal(corot_pencil_statistics(pencil).nassembly, nje);
  if (!full) assert_int_equal(corot_pencil_statistics(pencil).nfactor, o.nsetups);
  memcpy(y_end, N_VGetArrayPointer(y), 2 * b->n * sizeof *y_end);
  CVodeFree(&cvode);
  SUNLinSolFree(LS);
  SUNMatDestroy(A);
  corot_pencil_destroy(pencil);
  full_destroy(&h.full);
  N_VDestroy(y);
  SUNContext_Free(&ctx);
  return o;
}

/* Ours, from rest. */
static outcome run_ours(bar *b, const corot_integrator_def *def, double t_end,
                        corot_integrator_choice *chosen, double *y_end) {
  corot_integrator *integrator = start(b, def);
  *chosen = corot_integrator_chosen(integrator);
  run_to(integrator, t_end);
  assert_ok(corot_integrator_at(integrator, t_end, y_end, y_end + b->n));
  corot_statistics s = corot_integrator_statistics(integrator);
  corot_integrator_destroy(integrator);
  return (outcome){s.nst, s.nfe, s.nsetups, s.nni, s.netf};
}

/* A host with the pencil repeats our integrator bit by bit. With the full system the linear
   solutions differ by rounding, which a few hundred steps neither amplify nor let decide whether a
   step is accepted: every count agrees, at a loose tolerance and at a tight one. (Of ten-node tets,
   whose K is conditioned worse, it may decide that.) */
static void a_host_with_the_full_system_computes_the_same(void **state) {
  (void)state;
  const double rtol[] = {1e-4, 1e-8}, t_end[] = {4, 0.5};
  for (int k = 0; k < 2; k++) {
    bar_def of = lumped_bar();
    bar b = bar_create(&of);
    corot_integrator_def def = corot_integrator_defaults();
    def.rtol = rtol[k];
    def.linear.solver = "klu";
    double *ours = malloc(3 * 2 * b.n * sizeof *ours), *reduced = ours + 2 * b.n,
           *full = reduced + 2 * b.n;
    corot_integrator_choice chosen;
    outcome o = run_ours(&b, &def, t_end[k], &chosen, ours);
    outcome r = run_host(&b, false, rtol[k], chosen, t_end[k], reduced);
    outcome f = run_host(&b, true, rtol[k], chosen, t_end[k], full);
    assert_int_equal(memcmp(&r, &o, sizeof o), 0);
    assert_int_equal(memcmp(reduced, ours, 2 * b.n * sizeof *ours), 0);
    if (order_of_test() == 1) assert_int_equal(memcmp(&f, &o, sizeof o), 0);
    double most = order_of_test() == 1 ? 1e-10 : 10 * rtol[k];
    assert_below(difference_of(b.n, full, ours) / norm_max(b.n, ours), most);
    free(ours);
    bar_destroy(&b);
  }
}

static void the_matrices_are_reassembled_when_told(void **state) {
  (void)state;
  SUNContext ctx = context();
  bar b = a_bar(1);
  N_Vector y = N_VMake_Serial(2 * b.n, b.u, ctx);
  corot_pencil *pencil;
  assert_ok(corot_pencil_create(b.model, b.state, SOLVER("klu"), &pencil));
  SUNMatrix A = corot_sun_matrix(pencil, ctx);
  const struct {
    bool ok, invalidate, invert, expected; /* expected: K and D are made anew */
  } call[] = {
      {true, false, false, true},  /* the first time, whatever the integrator thinks */
      {true, false, false, false}, /* only gamma is new */
      {false, false, false, true}, {true, true, false, true},
      {false, false, true, true}, /* fails */
      {true, false, false, true}, /* and so K and D are not to be relied on */
      {true, false, false, false},
  };
  long assembled = 0;
  for (size_t k = 0; k < sizeof call / sizeof *call; k++) {
    double tip = b.u[b.tip + 2];
    if (call[k].invalidate) corot_pencil_invalidate(pencil);
    if (call[k].invert) b.u[b.tip + 2] = -0.5;
    sunbooleantype current = SUNFALSE;
    int status =
        corot_sun_linsys(0, y, NULL, A, call[k].ok, &current, 0.01, NULL, NULL, NULL, NULL);
    assert_int_equal(status, call[k].invert ? COROT_RETRY : 0);
    assert_int_equal(current, call[k].expected);
    assembled += call[k].expected;
    assert_int_equal(corot_pencil_statistics(pencil).nassembly, assembled);
    b.u[b.tip + 2] = tip;
  }
  SUNMatDestroy(A);
  corot_pencil_destroy(pencil);
  N_VDestroy(y);
  bar_destroy(&b);
  SUNContext_Free(&ctx);
}

/* An integrator can go on from a matrix without a factor, with a shorter step. */
static void a_singular_matrix_is_recoverable(void **state) {
  (void)state;
  SUNContext ctx = context();
  bar b = a_bar(1);
  corot_pencil *pencil;
  assert_ok(corot_pencil_create(b.model, b.state, SOLVER("klu"), &pencil));
  SUNMatrix A = corot_sun_matrix(pencil, ctx);
  SUNLinearSolver LS = corot_sun_linsol(pencil, ctx);
  assert_int_equal(SUNMatGetID(A), SUNMATRIX_CUSTOM);
  assert_int_equal(SUNLinSolGetType(LS), SUNLINEARSOLVER_DIRECT);
  assert_ok(corot_pencil_assemble(pencil, 0, b.u, b.v));
  corot_pencil_combine(pencil, 0, 0, 0);
  assert_int_equal(SUNLinSolSetup(LS, A), COROT_RETRY);
  corot_pencil_combine(pencil, 1, 0, 0);
  assert_int_equal(SUNLinSolSetup(LS, A), 0);
  SUNLinSolFree(LS);
  SUNMatDestroy(A);
  corot_pencil_destroy(pencil);
  bar_destroy(&b);
  SUNContext_Free(&ctx);
}

static int host_weights(N_Vector y, N_Vector w, void *data) {
  (void)y, (void)data;
  N_VConst(1e9, w); /* 1e-9 m, 1e-9 m/s */
  return 0;
}

/* The bar at rest under no load yet, by the host's own IDA: the residual form, for either mass. */
static void ida_host(bar *b, double t_end, double *y_end) {
  SUNContext ctx = context();
  N_Vector y = N_VNew_Serial(2 * b->n, ctx), yp = N_VClone(y);
  N_VConst(0, y), N_VConst(0, yp);
  corot_pencil *pencil;
  assert_ok(corot_pencil_create(b->model, b->state, NULL, &pencil));
  corot_sun_data data = {b->model, b->state, NULL};
  SUNMatrix A = corot_sun_matrix(pencil, ctx);
  SUNLinearSolver LS = corot_sun_linsol_dae(pencil, ctx);
  void *ida = IDACreate(ctx);
  double t;
  assert_false(IDAInit(ida, corot_sun_residual, 0, y, yp) || IDASetUserData(ida, &data) ||
               IDAWFtolerances(ida, host_weights) || IDASetMaxNumSteps(ida, -1) ||
               IDASetLinearSolver(ida, LS, A) || IDASetJacFn(ida, corot_sun_jacobian_dae));
  assert_int_equal(IDASolve(ida, t_end, &t, y, yp, IDA_NORMAL), IDA_SUCCESS);
  memcpy(y_end, N_VGetArrayPointer(y), 2 * b->n * sizeof *y_end);
  IDAFree(&ida);
  SUNLinSolFree(LS), SUNMatDestroy(A), N_VDestroy(y), N_VDestroy(yp);
  corot_pencil_destroy(pencil);
  SUNContext_Free(&ctx);
}

/* The same by its own ARKODE, with M^-1 in the right-hand side. */
static void arkode_host(bar *b, double t_end, double *y_end) {
  SUNContext ctx = context();
  N_Vector y = N_VNew_Serial(2 * b->n, ctx);
  N_VConst(0, y);
  corot_pencil *pencil;
  corot_mass_solver *mass;
  assert_ok(corot_pencil_create(b->model, b->state, NULL, &pencil));
  assert_ok(corot_mass_solver_create(b->model, &mass));
  corot_sun_data data = {b->model, b->state, mass};
  SUNMatrix A = corot_sun_matrix(pencil, ctx);
  SUNLinearSolver LS = corot_sun_linsol(pencil, ctx);
  void *ark = ARKStepCreate(NULL, corot_sun_rhs, 0, y, ctx);
  double t;
  assert_false(SUN_ARK(SetUserData)(ark, &data) || SUN_ARK(WFtolerances)(ark, host_weights) ||
               SUN_ARK(SetMaxNumSteps)(ark, -1) || SUN_ARK(SetLinearSolver)(ark, LS, A) ||
               SUN_ARK(SetLinSysFn)(ark, corot_sun_linsys_ark) || SUN_ARK(SetStopTime)(ark, t_end));
  assert_true(SUN_ARK(Evolve)(ark, 2 * t_end, y, &t, ARK_NORMAL) == ARK_TSTOP_RETURN);
  memcpy(y_end, N_VGetArrayPointer(y), 2 * b->n * sizeof *y_end);
  SUN_ARK(Free)(&ark);
  SUNLinSolFree(LS), SUNMatDestroy(A), N_VDestroy(y);
  corot_mass_solver_destroy(mass);
  corot_pencil_destroy(pencil);
  SUNContext_Free(&ctx);
}

/* Local errors of 1e-9 m add up to less than 1e-6 m over a displacement of millimetres. */
static void hosts_with_ida_and_arkode_find_our_solution(void **state) {
  (void)state;
  bar_def of = lumped_bar();
  bar b = bar_create(&of);
  double *ours = malloc(3 * 2 * b.n * sizeof *ours), *ida = ours + 2 * b.n, *ark = ida + 2 * b.n;
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator_choice chosen;
  def.rtol = 1e-9;
  run_ours(&b, &def, 1, &chosen, ours);
  ida_host(&b, 1, ida);
  arkode_host(&b, 1, ark);
  assert_above(norm_max(b.n, ours), 1e-3);
  assert_below(difference_of(b.n, ida, ours), 1e-6);
  assert_below(difference_of(b.n, ark, ours), 1e-6);
  free(ours);
  bar_destroy(&b);
}

static void there_is_nothing_without_a_context(void **state) {
  (void)state;
  bar b = a_bar(1);
  corot_pencil *pencil;
  assert_ok(corot_pencil_create(b.model, b.state, NULL, &pencil));
  assert_null(corot_sun_matrix(pencil, NULL));
  assert_null(corot_sun_linsol(pencil, NULL));
  corot_pencil_destroy(pencil);
  bar_destroy(&b);
}

static void the_version_is_that_of_the_header(void **state) {
  (void)state;
  assert_string_equal(corot_sundials_version(), SUNDIALS_VERSION);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_reduced_solve_equals_the_full_one),
      cmocka_unit_test(a_host_with_the_full_system_computes_the_same),
      cmocka_unit_test(the_matrices_are_reassembled_when_told),
      cmocka_unit_test(a_singular_matrix_is_recoverable),
      cmocka_unit_test(hosts_with_ida_and_arkode_find_our_solution),
      cmocka_unit_test(there_is_nothing_without_a_context),
      cmocka_unit_test(the_version_is_that_of_the_header),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
