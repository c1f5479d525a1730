/* Model Exchange: an importer's own integrator (the classical method of Runge and Kutta) leads to
   what Co-Simulation finds, and derivatives are those of differences. */
#include "check.h"
#include "importer.h"

/* A simulation from outside. */
typedef struct outside {
  fmu *f;
  fmu_log log;
  fmi3Instance instance;
  size_t n;
  double t, next; /* reached; of the next event */
  double *x, *y, *slope, *sum;
} outside;

static void update(outside *o) {
  fmi3Boolean flag[4] = {true, true, true, true}, defined;
  assert_int_equal(o->f->UpdateDiscreteStates(o->instance, &flag[0], &flag[1], &flag[2], &flag[3],
                                              &defined, &o->next),
                   fmi3OK);
  assert_false(flag[0] || flag[1] || flag[2] || flag[3]);
  if (!defined) o->next = INFINITY;
}

static void begin(outside *o, const char *name) {
  memset(o, 0, sizeof *o);
  o->f = fmu_load(fmu_path(name));
  o->instance = fmu_exchange(o->f, &o->log);
  assert_int_equal(o->f->EnterInitializationMode(o->instance, false, 0, 0, false, 0), fmi3OK);
  assert_int_equal(o->f->ExitInitializationMode(o->instance), fmi3OK);
  assert_int_equal(o->f->GetNumberOfContinuousStates(o->instance, &o->n), fmi3OK);
  assert_int_equal(o->n, fmu_size(o->f, "body.u") + fmu_size(o->f, "body.v"));
  o->x = calloc(4 * o->n, sizeof *o->x);
  assert_non_null(o->x);
  o->y = o->x + o->n, o->slope = o->y + o->n, o->sum = o->slope + o->n;
  assert_int_equal(o->f->GetContinuousStates(o->instance, o->x, o->n), fmi3OK);
  update(o);
  assert_int_equal(o->f->EnterContinuousTimeMode(o->instance), fmi3OK);
}

static void end(outside *o) {
  assert_int_equal(o->f->Terminate(o->instance), fmi3OK);
  o->f->FreeInstance(o->instance);
  assert_string_equal(o->log.message, "");
  free(o->x);
  fmu_unload(o->f);
}

static void set_state(outside *o, double t, const double *x) {
  assert_int_equal(o->f->SetTime(o->instance, t), fmi3OK);
  assert_int_equal(o->f->SetContinuousStates(o->instance, x, o->n), fmi3OK);
}

static void find_slope(outside *o, double t, const double *x, double *slope) {
  set_state(o, t, x);
  assert_int_equal(o->f->GetContinuousStateDerivatives(o->instance, slope, o->n), fmi3OK);
}

static void take_step(outside *o, double h) {
  static const double part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
  memset(o->sum, 0, o->n * sizeof *o->sum);
  for (int stage = 0; stage < 4; stage++) {
    for (size_t i = 0; i < o->n; i++) o->y[i] = o->x[i] + part[stage] * h * o->slope[i];
    find_slope(o, o->t + part[stage] * h, stage ? o->y : o->x, o->slope);
    for (size_t i = 0; i < o->n; i++) o->sum[i] += weight[stage] / 6 * o->slope[i];
  }
  for (size_t i = 0; i < o->n; i++) o->x[i] += h * o->sum[i];
  o->t += h;
  fmi3Boolean event = true, terminate = true;
  set_state(o, o->t, o->x);
  assert_int_equal(o->f->CompletedIntegratorStep(o->instance, true, &event, &terminate), fmi3OK);
  assert_false(event || terminate);
}

/* To t, stopping at events, which it counts. */
static int go_to(outside *o, double t) {
  const double most = 0.0078125 / 64;
  int events = 0;
  while (o->t < t) {
    double to = fmin(t, fmin(o->next, o->t + most));
    bool event = to == o->next;
    take_step(o, to - o->t);
    o->t = to;
    if (!event) continue;
    events++;
    assert_int_equal(o->f->SetTime(o->instance, to), fmi3OK);
    assert_int_equal(o->f->EnterEventMode(o->instance), fmi3OK);
    update(o);
    assert_true(o->next > to);
    assert_int_equal(o->f->EnterContinuousTimeMode(o->instance), fmi3OK);
  }
  return events;
}

static void it_leads_where_co_simulation_does(void **state) {
  (void)state;
  outside o;
  begin(&o, "bent");
  fmu_table run = fmu_read_table(fmu_path("bent.run/probes.csv"));
  int events = 0;
  for (int k = 1; k < run.nrow; k++) {
    events += go_to(&o, run.value[k * run.ncolumn]);
    /* what cvode leaves with rtol 1e-6, in some thousand steps: of 0.1 m, and of 2 m/s */
    for (int c = 1; c < run.ncolumn; c++)
      assert_close(fmu_get(o.f, o.instance, run.name[c]), run.value[k * run.ncolumn + c], 1e-3,
                   c < 4 ? 1e-5 : 1e-3);
  }
  assert_int_equal(events, 5); /* 0.02, 0.03, 0.05, 0.06, 0.07 */
  assert_true(o.next == INFINITY);
  fmu_free_table(&run);
  end(&o);
}

/* --- Derivatives --- */

/* Somewhere on the way, where nothing is zero. */
static void go_astray(outside *o) {
  go_to(o, 0.01);
  fmu_set(o->f, o->instance, "push", 1.3);
  set_state(o, o->t, o->x);
}

/* Sensitivities of `unknown` by the seed of `known`. */
static void differentiate(outside *o, const char *unknown, const char *known, const double *seed,
                          double *sensitivity) {
  fmi3ValueReference of = fmu_reference(o->f, unknown), by = fmu_reference(o->f, known);
  assert_int_equal(
      o->f->GetDirectionalDerivative(o->instance, &of, 1, &by, 1, seed, fmu_size(o->f, known),
                                     sensitivity, fmu_size(o->f, unknown)),
      fmi3OK);
}

static void check_slopes(const double *found, const double *plus, const double *minus, double h,
                         size_t n, double rtol) {
  double most = 0;
  for (size_t i = 0; i < n; i++) most = fmax(most, fabs(found[i]));
  assert_above(most, 0);
  for (size_t i = 0; i < n; i++)
    assert_close(found[i], (plus[i] - minus[i]) / (2 * h), 0, rtol * most);
}

static void derivatives_by_states_are_those_of_differences(void **state) {
  (void)state;
  outside o;
  begin(&o, "driven");
  go_astray(&o);
  size_t half = o.n / 2;
  double *seed = calloc(3 * o.n, sizeof *seed), *plus = seed + o.n, *minus = plus + o.n;
  double *found = calloc(half, sizeof *found);
  for (int which = 0; which < 2; which++) {
    /* a step of which the square is as small as rounding over it */
    double size = which == 0 ? 1e-3 : 1e-1, h = 1e-4;
    for (size_t i = 0; i < half; i++) seed[i] = size * sin((double)(7 * i + 1));
    differentiate(&o, "der(body.v)", which == 0 ? "body.u" : "body.v", seed, found);
    for (int sign = -1; sign <= 1; sign += 2) {
      memcpy(o.y, o.x, o.n * sizeof *o.y);
      for (size_t i = 0; i < half; i++) o.y[which * half + i] += sign * h * seed[i];
      find_slope(&o, o.t, o.y, sign < 0 ? minus : plus);
    }
    check_slopes(found, plus + half, minus + half, h, half, 1e-6);
    set_state(&o, o.t, o.x);
    differentiate(&o, "der(body.u)", which == 0 ? "body.u" : "body.v", seed, found);
    for (size_t i = 0; i < half; i++) assert_true(found[i] == (which == 0 ? 0 : seed[i]));
  }
  free(found);
  free(seed);
  end(&o);
}

static void derivatives_by_loads_are_those_of_differences(void **state) {
  (void)state;
  outside o;
  begin(&o, "driven");
  go_astray(&o);
  size_t half = o.n / 2;
  double *plus = calloc(2 * o.n + half, sizeof *plus), *minus = plus + o.n, *found = minus + o.n;
  const double seed = 2.0, h = 0.25; /* r is linear in the factor */
  differentiate(&o, "der(body.v)", "push", &seed, found);
  fmu_set(o.f, o.instance, "push", 1.3 + h * seed);
  find_slope(&o, o.t, o.x, plus);
  fmu_set(o.f, o.instance, "push", 1.3 - h * seed);
  find_slope(&o, o.t, o.x, minus);
  check_slopes(found, plus + half, minus + half, h, half, 1e-10);
  free(plus);
  end(&o);
}

/* One by one, and of several knowns and unknowns at once, in their order. */
static void derivatives_of_outputs_are_those_of_differences(void **state) {
  static const char *const name[] = {"corner.ux", "speed.vz", "push.ax", "hold.fz", "worst.value"};
  (void)state;
  outside o;
  begin(&o, "driven");
  go_astray(&o);
  size_t half = o.n / 2;
  double *seed = calloc(o.n + 1, sizeof *seed), h = 1e-4;
  fmi3ValueReference known[3] = {fmu_reference(o.f, "push"), fmu_reference(o.f, "body.u"),
                                 fmu_reference(o.f, "body.v")};
  fmi3ValueReference unknown[5];
  for (size_t i = 0; i < o.n; i++) seed[i + 1] = (i < half ? 1e-3 : 1e-1) * cos((double)(3 * i));
  seed[0] = 0.5;
  double found[5], at[2][5];
  for (int k = 0; k < 5; k++) unknown[k] = fmu_reference(o.f, name[k]);
  assert_int_equal(
      o.f->GetDirectionalDerivative(o.instance, unknown, 5, known, 3, seed, o.n + 1, found, 5),
      fmi3OK);
  for (int side = 0; side < 2; side++) {
    double part = side ? h : -h;
    for (size_t i = 0; i < o.n; i++) o.y[i] = o.x[i] + part * seed[i + 1];
    set_state(&o, o.t, o.y);
    fmu_set(o.f, o.instance, "push", 1.3 + part * seed[0]);
    for (int k = 0; k < 5; k++) at[side][k] = fmu_get(o.f, o.instance, name[k]);
  }
  for (int k = 0; k < 5; k++) assert_close(found[k], (at[1][k] - at[0][k]) / (2 * h), 1e-5, 1e-9);
  free(seed);
  end(&o);
}

/* --- What else an importer asks --- */

static void states_and_slopes_are_variables_too(void **state) {
  (void)state;
  outside o;
  begin(&o, "driven");
  go_astray(&o);
  size_t half = o.n / 2;
  double *value = calloc(2 * o.n, sizeof *value);
  const fmi3ValueReference all[4] = {fmu_reference(o.f, "body.u"), fmu_reference(o.f, "body.v"),
                                     fmu_reference(o.f, "der(body.u)"),
                                     fmu_reference(o.f, "der(body.v)")};
  assert_int_equal(o.f->GetFloat64(o.instance, all, 4, value, 4 * half), fmi3OK);
  assert_memory_equal(value, o.x, o.n * sizeof *value);
  find_slope(&o, o.t, o.x, o.slope);
  assert_memory_equal(value + o.n, o.slope, o.n * sizeof *value);
  assert_true(fmu_get(o.f, o.instance, "time") == o.t);
  free(value);
  end(&o);
}

static void nominals_are_of_the_size_of_the_model(void **state) {
  (void)state;
  outside o;
  begin(&o, "driven");
  assert_int_equal(o.f->GetNominalsOfContinuousStates(o.instance, o.y, o.n), fmi3OK);
  for (size_t i = 0; i < o.n; i++) assert_true(o.y[i] > 0.1 && o.y[i] < 10);
  size_t indicators = 7;
  assert_int_equal(o.f->GetNumberOfEventIndicators(o.instance, &indicators), fmi3OK);
  assert_int_equal(indicators, 0);
  assert_int_equal(o.f->GetEventIndicators(o.instance, NULL, 0), fmi3OK);
  end(&o);
}

/* An element turned inside out has no force: nearer to the last state there is one. */
static void a_state_that_cannot_be_evaluated_is_discarded(void **state) {
  (void)state;
  outside o;
  begin(&o, "driven");
  for (size_t i = 0; i < o.n; i++) o.y[i] = i < o.n / 2 ? sin((double)(5 * i)) : 0;
  set_state(&o, 0, o.y);
  assert_int_equal(o.f->GetContinuousStateDerivatives(o.instance, o.slope, o.n), fmi3Discard);
  assert_string_equal(o.log.category, "logStatusDiscard");
  assert_non_null(strstr(o.log.message, "inverted"));
  find_slope(&o, 0, o.x, o.slope);
  o.log.message[0] = '\0';
  end(&o);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_leads_where_co_simulation_does),
      cmocka_unit_test(derivatives_by_states_are_those_of_differences),
      cmocka_unit_test(derivatives_by_loads_are_those_of_differences),
      cmocka_unit_test(derivatives_of_outputs_are_those_of_differences),
      cmocka_unit_test(states_and_slopes_are_variables_too),
      cmocka_unit_test(nominals_are_of_the_size_of_the_model),
      cmocka_unit_test(a_state_that_cannot_be_evaluated_is_discarded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
