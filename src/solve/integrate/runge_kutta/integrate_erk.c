/* Explicit Runge-Kutta methods, through ARKODE's ERKStep.

   SUNDIALS before 6.6.1 has a defect: it takes each table whose last stage stands at the end of the
   step for one whose last stage is the first of the next step, and so loses the order of those
   where it is not (LLNL/sundials#311). Here every table is made one where it is. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "runge_kutta.h"
#include "solve/sundials/sun_ark.h"

/* The first of each order is what the order stands for. */
const rk_table corot_rk_explicit[] = {
    {"ARKODE_HEUN_EULER_2_1_2", 2},
    {"ARKODE_BOGACKI_SHAMPINE_4_2_3", 3},
    {"ARKODE_ARK324L2SA_ERK_4_2_3", 3},
    {"ARKODE_ZONNEVELD_5_3_4", 4},
    {"ARKODE_ARK436L2SA_ERK_6_3_4", 4},
    {"ARKODE_ARK437L2SA_ERK_7_3_4", 4},
    {"ARKODE_SAYFY_ABURUB_6_3_4", 4},
    {"ARKODE_DORMAND_PRINCE_7_4_5", 5},
    {"ARKODE_FEHLBERG_6_4_5", 5},
    {"ARKODE_CASH_KARP_6_4_5", 5},
    {"ARKODE_ARK548L2SA_ERK_8_4_5", 5},
    {"ARKODE_ARK548L2SAb_ERK_8_4_5", 5},
    {"ARKODE_VERNER_8_5_6", 6},
    {"ARKODE_FEHLBERG_13_7_8", 8},
    {NULL, 0},
};

enum { MOST_STAGES = 15 };

static const rk_api api = {.advance = SUN_ERK(Evolve),
                           .reset = SUN_ERK(Reset),
                           .release = SUN_ERK(Free),
                           .set_stop_time = SUN_ERK(SetStopTime),
                           .set_first_step = SUN_ERK(SetInitStep),
                           .interpolate = SUN_ERK(GetDky),
                           .next_step = SUN_ERK(GetCurrentStep),
                           .local_errors = SUN_ERK(GetEstLocalErrors),
                           .error_weights = SUN_ERK(GetErrWeights),
                           .nfe = sun_erk_nfe,
                           .netf = SUN_ERK(GetNumErrTestFails)};

/* Stability, not accuracy, decides the step unless much is asked for; of the methods that then cost
   about the same, that of order 4 has the least error. */
static void choose(corot_integrator *self) {
  corot_integrator_def *d = &self->def;
  if (d->order == 0)
    d->order = d->table          ? corot_rk_order(d->table, corot_rk_explicit)
               : d->rtol > 1e-6  ? 4
               : d->rtol > 1e-10 ? 5
                                 : 8;
  d->predictor = 0;
  d->tangent = COROT_TANGENT_HELD;
}

/* The same method with a last stage that is the solution at the end of the step. NULL: no memory.
 */
static ARKodeButcherTable closed(const char *name) {
  ARKodeButcherTable B = ARKodeButcherTable_LoadERKByName(name);
  if (!B || B->stages > MOST_STAGES) return NULL;
  int s = B->stages;
  size_t row = s * sizeof **B->A;
  if (memcmp(B->A[s - 1], B->b, row) == 0) return B;
  sunrealtype A[(MOST_STAGES + 1) * (MOST_STAGES + 1)] = {0}, b[MOST_STAGES + 1] = {0};
  sunrealtype c[MOST_STAGES + 1] = {0}, d[MOST_STAGES + 1] = {0};
  for (int i = 0; i < s; i++) memcpy(A + i * (s + 1), B->A[i], row);
  memcpy(A + s * (s + 1), B->b, row);
  memcpy(b, B->b, row);
  memcpy(c, B->c, row);
  memcpy(d, B->d, row);
  c[s] = 1;
  ARKodeButcherTable longer = ARKodeButcherTable_Create(s + 1, B->q, B->p, c, A, b, d);
  ARKodeButcherTable_Free(B);
  return longer;
}

/* R(z) = 1 + sum z^k b' A^(k-1) 1, k = 1 to the number of stages. */
static void stability_polynomial(ARKodeButcherTable B, double *R) {
  double x[MOST_STAGES + 1], Ax[MOST_STAGES + 1];
  int s = B->stages;
  for (int i = 0; i < s; i++) x[i] = 1;
  R[0] = 1;
  for (int k = 1; k <= s; k++) {
    R[k] = 0;
    for (int i = 0; i < s; i++) R[k] += B->b[i] * x[i];
    for (int i = 0; i < s; i++) {
      Ax[i] = 0;
      for (int j = 0; j < i; j++) Ax[i] += B->A[i][j] * x[j];
    }
    memcpy(x, Ax, s * sizeof *x);
  }
}

/* An ARKExpStabFn. */
static int stable_step(N_Vector y, sunrealtype t, sunrealtype *h, void *limit) {
  (void)y, (void)t;
  *h = corot_explicit_limit(limit);
  return 0;
}

static int configure(runge_kutta *m, ARKodeButcherTable table) {
  const corot_integrator_def *d = &m->driver.self->def;
  void *e = m->memory;
  /* a step of 0 leaves it to SUNDIALS */
  return SUN_ERK(SetUserData)(e, m) || SUN_ERK(WFtolerances)(e, corot_driver_weights) ||
         SUN_ERK(SetMaxNumSteps)(e, -1) || SUN_ERK(SetMaxErrTestFails)(e, DRIVER_MOST_FAILURES) ||
         ERKStepSetTable(e, table) || SUN_ERK(SetInterpolantDegree)(e, 3) ||
         SUN_ERK(SetStabilityFn)(e, stable_step, m->limit) || SUN_ERK(SetCFLFraction)(e, 0.95) ||
         SUN_ERK(SetInitStep)(e, d->first_step) || SUN_ERK(SetMinStep)(e, d->min_step) ||
         SUN_ERK(SetMaxStep)(e, d->max_step);
}

static corot_status start(runge_kutta *m, ARKodeButcherTable table) {
  driver *d = &m->driver;
  corot_integrator *self = d->self;
  double stability[MOST_STAGES + 2];
  stability_polynomial(table, stability);
  COROT_TRY(corot_explicit_limit_create(self->model, self->state, self->mass, table->stages,
                                        stability, &m->limit));
  m->memory = ERKStepCreate(corot_driver_rhs, self->t, d->y, d->ctx);
  if (!m->memory) return corot_fail(COROT_ENOMEM, "no memory for erk");
  if (SUN_CATCH_ERRORS(ERKStepSetErrHandlerFn, m->memory, d->ctx, corot_driver_on_error,
                       d->message) ||
      configure(m, table))
    return corot_driver_refuse(d, "set-up");
  return COROT_OK;
}

static corot_status create(corot_integrator *self, const double *u, const double *v) {
  const rk_table *table = corot_rk_find(&self->def, corot_rk_explicit);
  if (!table)
    return corot_rk_refuse(self, corot_rk_explicit, corot_rk_implicit, "implicit, of arkode");
  runge_kutta *m = self->method = calloc(1, sizeof *m);
  if (!m) return corot_fail(COROT_ENOMEM, "no memory for erk");
  COROT_TRY(corot_rk_open(m, self, &api, table->order, u, v));
  ARKodeButcherTable B = closed(table->name);
  if (!B) return corot_fail(COROT_ENOMEM, "no memory for %s", table->name);
  corot_status status = start(m, B);
  ARKodeButcherTable_Free(B);
  self->table = table->name;
  self->def.order = table->order;
  return status;
}

const integrator_ops corot_integrator_erk = {
    .kind = {.name = "erk",
             .controls_error = true,
             .stages = true,
             .explicit_steps = true,
             .order_min = 2,
             .order_max = 8},
    .choose = choose,
    .create = create,
    .destroy = corot_rk_close,
    .step = corot_rk_step,
    .at = corot_rk_at,
    .work = corot_rk_work,
    .changed = corot_rk_changed,
    .loaded = corot_rk_loaded,
    .statistics = corot_rk_statistics,
    .settle = corot_rk_settle,
    .exchange = corot_rk_exchange,
};
