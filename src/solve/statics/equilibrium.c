/* KINSOL's Newton iteration on F = -r, whose Jacobian is K = S(0, 0, 1) of the pencil.

   Full steps come first: a slender body that bends must be allowed to stretch on its way, which a
   line search for a smaller residual forbids, so that it creeps: a cantilever bent by a right angle
   takes 13 full steps and 1000 searched ones. The search is for where full steps lead nowhere. */
#include "equilibrium.h"

#include <float.h>
#include <kinsol/kinsol.h>
#include <kinsol/kinsol_ls.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/trial.h"
#include "solve/host/host.h"
#include "solve/pencil/wall_clock.h"

/* A residual this many times the estimate of its rounding may be all that is left of it. */
static const double STALLED = 100;

static double largest(int n, const double *x) {
  double most = 0;
  for (int i = 0; i < n; i++)
    if (!(fabs(x[i]) <= most)) most = fabs(x[i]);
  return most;
}

static double *values(N_Vector x) { return N_VGetArrayPointer(x); }

/* --- KINSOL's callbacks --- */

/* Keeps the reason of a refusal for the message, and the status of what cannot be mended. */
static corot_status note(equilibrium *e, corot_status status) {
  e->refusal[0] = 0;
  if (status) snprintf(e->refusal, sizeof e->refusal, "%s", corot_error());
  if (sun_is_fatal(status)) e->fatal = status;
  return status;
}

static int answer(equilibrium *e, corot_status status) {
  return sun_callback_code(note(e, status));
}

static corot_status residual(equilibrium *e, const double *u, double *r) {
  double start = clock_wall();
  corot_status status = corot_residual_trial(e->model, e->state, e->factor * e->t, u, e->zero, r);
  e->force_s += clock_wall() - start;
  return note(e, status);
}

static int system_function(N_Vector u, N_Vector F, void *user_data) {
  equilibrium *e = user_data;
  double *f = values(F);
  corot_status status = residual(e, values(u), f);
  for (int i = 0; !status && i < e->n; i++) f[i] = -f[i];
  return sun_callback_code(status);
}

static void record(equilibrium *e, double r) {
  if (e->nhistory == e->capacity) e->nhistory--; /* the last is what counts */
  e->history[e->nhistory++] = r;
}

/* The largest force on a node where the residual at u is r, and the tolerance that it means. */
static corot_status weigh(equilibrium *e, const double *u, const double *r) {
  double start = clock_wall(), most;
  corot_status status =
      corot_largest_force(e->model, e->state, e->factor * e->t, u, r, e->f, &most);
  e->force_s += clock_wall() - start;
  COROT_TRY(status);
  e->force = most;
  e->floor = e->rounding * (e->edge + largest(e->n, u));
  e->tolerance = fmax(e->def->tolerance * most, e->floor);
  return COROT_OK;
}

/* How much of r an iterative solver may leave: as much as the step will leave in any case, by the
   fall of r in the last one (Eisenstat and Walker 1996, their second choice), and no less than the
   tolerance asks for. The first steps want 1e-5, which saves nearly as much as 1e-3: less, and a
   beam of nu = 0.499 takes 14 steps instead of 8, since what stretches hides what bends. Where the
   body buckles, what a solver leaves of r pushes it to a side, and 54 steps become 270. */
static void take_aim(equilibrium *e) {
  static const double most = 1e-5, least = 0.1;
  double now = largest(e->n, e->r), fall = e->before > 0 ? now / e->before : 1;
  double enough = fmax(0.5 * fall * fall, least * e->tolerance / now);
  bool buckles = corot_pencil_statistics(e->pencil).nindefinite > 0;
  e->aim = buckles ? 0 : fmax(fmin(most, enough), e->def->linear.tolerance);
  e->before = now;
}

/* The tolerance keeps up with the forces, which may be far larger than where KINSOL started. */
static corot_status begin_iteration(equilibrium *e, const double *u) {
  if (e->recording) record(e, largest(e->n, e->r));
  e->iterations++;
  if (e->def->stop && e->def->stop(e->def->stop_data))
    return corot_fail(COROT_EINTEGRATE, "stopped on the way to load factor %.6g", e->factor);
  COROT_TRY(weigh(e, u, e->r));
  take_aim(e);
  if (KINSetFuncNormTol(e->memory, e->tolerance / e->unit))
    return corot_fail(COROT_EINTEGRATE, "kinsol: no tolerance of %g N", e->tolerance);
  return corot_pencil_assemble(e->pencil, e->factor * e->t, u, e->zero);
}

static int jacobian(N_Vector u, N_Vector F, SUNMatrix A, void *user_data, N_Vector tmp1,
                    N_Vector tmp2) {
  (void)A, (void)tmp1, (void)tmp2;
  equilibrium *e = user_data;
  for (int i = 0; i < e->n; i++) e->r[i] = -values(F)[i];
  return answer(e, begin_iteration(e, values(u)));
}

static corot_tangent tangent(const equilibrium *e) {
  return e->def->frames == COROT_FRAMES_HELD ? COROT_TANGENT_HELD : COROT_TANGENT_EXACT;
}

/* K at e->u with this tangent, its factor, and whether K is positive definite: COROT_RETRY says
   that it is not, *known whether that is so for certain. */
static corot_status factor_proved(equilibrium *e, corot_tangent which, bool *known) {
  corot_pencil_use(e->pencil, which);
  corot_status status = corot_pencil_assemble(e->pencil, e->factor * e->t, values(e->u), e->zero);
  corot_pencil_use(e->pencil, tangent(e));
  corot_pencil_combine(e->pencil, 0, 0, 1);
  *known = false;
  if (status) return status;
  return e->def->follow_unstable ? corot_pencil_factor(e->pencil)
                                 : corot_pencil_factor_proved(e->pencil, known);
}

static int solver_setup(SUNLinearSolver LS, SUNMatrix A) {
  (void)A;
  equilibrium *e = LS->content;
  corot_pencil_combine(e->pencil, 0, 0, 1);
  return answer(e, e->def->follow_unstable ? corot_pencil_factor(e->pencil)
                                           : corot_pencil_factor_downhill(e->pencil));
}

static int solver_solve(SUNLinearSolver LS, SUNMatrix A, N_Vector x, N_Vector b, sunrealtype tol) {
  (void)A, (void)tol;
  equilibrium *e = LS->content;
  corot_pencil_aim(e->pencil, e->aim);
  corot_status status = e->def->follow_unstable
                            ? corot_pencil_solve(e->pencil, values(b), values(x))
                            : corot_pencil_solve_downhill(e->pencil, values(b), values(x));
  return sun_solve_code(note(e, status));
}

/* The pencil's, but for what it does. */
static SUNLinearSolver make_solver(equilibrium *e) {
  SUNLinearSolver LS = corot_sun_linsol(e->pencil, e->ctx);
  if (!LS) return NULL;
  LS->content = e;
  LS->ops->setup = solver_setup;
  LS->ops->solve = solver_solve;
  return LS;
}

/* --- Set-up --- */

static corot_status measure_stiffness(equilibrium *e) {
  bool known;
  corot_status status = factor_proved(e, tangent(e), &known);
  if (status == COROT_RETRY || status == COROT_ESINGULAR)
    return corot_fail(COROT_ESINGULAR,
                      "statics: the stiffness at rest is singular; parts that share a node or an "
                      "edge only can turn about it (%s)",
                      corot_error());
  COROT_TRY(status);
  e->rounding = corot_rounding_of_forces(e->pencil);
  e->edge = corot_longest_edge(corot_model_mesh(e->model));
  return COROT_OK;
}

static corot_status refuse_setup(const equilibrium *e) {
  if (!e->reason[0] || sun_says_no_memory(e->reason))
    return corot_fail(COROT_ENOMEM, "kinsol: set-up: out of memory");
  return corot_fail(COROT_EINTEGRATE, "kinsol: set-up: %s", e->reason);
}

static corot_status open_kinsol(equilibrium *e) {
  e->u_scale = N_VClone(e->u);
  e->f_scale = N_VClone(e->u);
  e->A = corot_sun_matrix(e->pencil, e->ctx);
  e->LS = make_solver(e);
  e->memory = KINCreate(e->ctx);
  if (!e->u_scale || !e->f_scale || !e->A || !e->LS || !e->memory)
    return corot_fail(COROT_ENOMEM, "no memory for kinsol on %d unknowns", e->n);
  N_VConst(1 / corot_model_length(e->model), e->u_scale);
  void *m = e->memory;
  /* No Newton step longer than the body, in the root mean square; none too short but rounding. */
  if (SUN_CATCH_ERRORS(KINSetErrHandlerFn, m, e->ctx, corot_driver_on_error, e->reason) ||
      KINInit(m, system_function, e->u) || KINSetUserData(m, e) ||
      KINSetLinearSolver(m, e->LS, e->A) || KINSetJacFn(m, jacobian) || KINSetMaxSetupCalls(m, 1) ||
      KINSetNoResMon(m, 1) || KINSetNumMaxIters(m, e->def->max_iterations) ||
      KINSetMaxNewtonStep(m, fmax(1, sqrt(e->n))) || KINSetScaledStepTol(m, 4 * DBL_EPSILON))
    return refuse_setup(e);
  return COROT_OK;
}

corot_status corot_equilibrium_open(equilibrium *e, const corot_statics_def *def,
                                    const corot_model *model, double t) {
  corot_linear_def linear = def->linear;
  linear.role = COROT_ROLE_STATIC;
  size_t nnode = corot_model_mesh(model)->nnode;
  e->model = model, e->def = def, e->t = t;
  e->n = corot_model_ndof(model);
  e->capacity = 2 * def->max_iterations + 4;
  /* room */
  e->zero = calloc(e->n, sizeof *e->zero);
  e->r = malloc(e->n * sizeof *e->r);
  e->f = malloc(nnode * sizeof *e->f);
  e->history = malloc(e->capacity * sizeof *e->history);
  if (!e->zero || !e->r || !e->f || !e->history)
    return corot_fail(COROT_ENOMEM, "no memory for statics of %d unknowns", e->n);
  if (sun_context_create(&e->ctx) || !(e->u = N_VNew_Serial(e->n, e->ctx)))
    return corot_fail(COROT_ENOMEM, "no memory for SUNDIALS on %d unknowns", e->n);
  N_VConst(0, e->u);
  /* the parts: evaluation, matrix, and Newton's iteration */
  COROT_TRY(corot_state_create(model, &e->state));
  COROT_TRY(corot_state_use_inputs(e->state, def->inputs));
  if (def->threads) COROT_TRY(corot_state_threads(e->state, def->threads));
  COROT_TRY(corot_pencil_create(model, e->state, &linear, &e->pencil));
  corot_state_use(e->state, def->frames);
  corot_state_stand_still(e->state, t, 0);
  COROT_TRY(measure_stiffness(e));
  return open_kinsol(e);
}

void corot_equilibrium_close(equilibrium *e) {
  if (e->memory) KINFree(&e->memory);
  if (e->LS) SUNLinSolFree(e->LS);
  if (e->A) SUNMatDestroy(e->A);
  if (e->f_scale) N_VDestroy(e->f_scale);
  if (e->u_scale) N_VDestroy(e->u_scale);
  if (e->u) N_VDestroy(e->u);
  if (e->ctx) SUNContext_Free(&e->ctx);
  corot_pencil_destroy(e->pencil);
  corot_state_destroy(e->state);
  free(e->zero);
  free(e->r);
  free(e->f);
  free(e->history);
}

/* --- One equilibrium --- */

/* e->r at e->u, and the tolerance there. */
static corot_status measure(equilibrium *e) {
  e->counts.nfe++;
  COROT_TRY(residual(e, values(e->u), e->r));
  return note(e, weigh(e, values(e->u), e->r));
}

/* Runs KINSOL from e->u, with the present force as the unit. */
static int solve(equilibrium *e, int strategy) {
  long nni = 0, nfe = 0, nbcfails = 0, nbacktrack = 0;
  e->unit = e->force > 0 ? e->force : e->tolerance;
  N_VConst(1 / e->unit, e->f_scale);
  e->reason[0] = 0;
  e->before = 0;
  if (KINSetFuncNormTol(e->memory, e->tolerance / e->unit)) return KIN_ILL_INPUT;
  int flag = KINSol(e->memory, e->u, strategy, e->u_scale, e->f_scale);
  if (KINGetNumNonlinSolvIters(e->memory, &nni) || KINGetNumFuncEvals(e->memory, &nfe) ||
      KINGetNumBetaCondFails(e->memory, &nbcfails) || KINGetNumBacktrackOps(e->memory, &nbacktrack))
    note(e, corot_fail(COROT_EINTEGRATE, "kinsol: statistics: %s", e->reason));
  e->counts.nni += nni, e->counts.nfe += nfe;
  e->counts.nbcfails += nbcfails, e->counts.nbacktrack += nbacktrack;
  return flag;
}

/* What a run of KINSOL that ended with `flag` means; *reached: an equilibrium. If it was not the
   last run, it may go on from what it has. */
static corot_status conclude(equilibrium *e, int flag, bool last, bool *reached) {
  bool stalled = flag == KIN_LINESEARCH_NONCONV || flag == KIN_STEP_LT_STPTOL;
  if (flag == KIN_MEM_FAIL) return corot_fail(COROT_ENOMEM, "kinsol: out of memory");
  if (e->fatal) return e->fatal;
  if (flag < 0 && !stalled) return COROT_RETRY;
  COROT_TRY(measure(e));
  double r = largest(e->n, e->r);
  *reached = r <= e->tolerance || ((stalled || last) && r <= STALLED * e->floor);
  if (*reached || !(stalled || last)) return COROT_OK;
  if (!e->reason[0]) snprintf(e->reason, sizeof e->reason, "the residual stays at %.3g N", r);
  return COROT_RETRY;
}

/* Newton's iteration by one strategy. Its tolerance is that of the last iteration but one: if it
   ends where the forces are smaller, it goes on. */
static corot_status newton(equilibrium *e, int strategy) {
  enum { LAST = 3 };
  bool reached = false;
  e->nhistory = e->iterations = 0;
  COROT_TRY(measure(e));
  for (int pass = 0; !reached; pass++)
    COROT_TRY(conclude(e, solve(e, strategy), pass == LAST, &reached));
  record(e, largest(e->n, e->r));
  return COROT_OK;
}

/* Frames held, found anew at the solution, held again. The residual of the new frames is that of
   exact ones. */
static corot_status held_frames(equilibrium *e, int strategy) {
  e->nhistory = e->iterations = 0;
  for (int k = 0; k <= e->def->max_iterations; k++) {
    bool solved;
    COROT_TRY(
        note(e, corot_frames_update(e->model, e->state, e->factor * e->t, values(e->u), NULL)));
    e->counts.nframes++;
    COROT_TRY(measure(e));
    record(e, largest(e->n, e->r));
    if (largest(e->n, e->r) <= e->tolerance) return COROT_OK;
    COROT_TRY(conclude(e, solve(e, strategy), true, &solved));
  }
  snprintf(e->reason, sizeof e->reason, "the frames still change after %d updates",
           e->def->max_iterations);
  return COROT_RETRY;
}

/* Puts the model's own reason, if a state could not be evaluated, before KINSOL's. */
static void explain(equilibrium *e) {
  char why[248];
  if (!e->refusal[0]) return;
  snprintf(why, sizeof why, "%.247s", e->reason);
  snprintf(e->reason, sizeof e->reason, "%s%s%s%s", e->refusal, why[0] ? " (" : "", why,
           why[0] ? ")" : "");
}

static corot_status find(equilibrium *e, double factor, int strategy) {
  e->factor = factor;
  e->fatal = COROT_OK;
  e->reason[0] = e->refusal[0] = 0;
  corot_state_stand_still(e->state, e->t, factor);
  e->recording = e->def->frames == COROT_FRAMES_EXACT;
  corot_status status = e->recording ? newton(e, strategy) : held_frames(e, strategy);
  if (status == COROT_RETRY) explain(e);
  return status;
}

corot_status corot_equilibrium_find(equilibrium *e, double factor) {
  return find(e, factor, KIN_NONE);
}

corot_status corot_equilibrium_search(equilibrium *e, double factor) {
  return find(e, factor, KIN_LINESEARCH);
}

/* --- Stability --- */

corot_status corot_equilibrium_judge(equilibrium *e, corot_stability *stability) {
  if (corot_model_approximate_stiffness(e->model) || e->def->follow_unstable) {
    *stability = COROT_STABILITY_UNKNOWN;
    return COROT_OK;
  }
  bool known;
  corot_state_use(e->state, COROT_FRAMES_EXACT);
  corot_status status = factor_proved(e, COROT_TANGENT_EXACT, &known);
  corot_state_use(e->state, e->def->frames);
  if (status < 0 && status != COROT_ESINGULAR) return status;
  *stability = status ? COROT_UNSTABLE : known ? COROT_STABLE : COROT_STABILITY_UNKNOWN;
  return COROT_OK;
}
