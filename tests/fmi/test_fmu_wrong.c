/* An FMU that is asked for what it has not answers with fmi3Error and a message through the logger;
   nothing is lost by it: what follows is what would have followed without. */
#include <stdio.h>

#include "check.h"
#include "importer.h"

static const double h = 0.0078125;

typedef struct asked {
  fmu *f;
  fmu_log log;
  fmi3Instance instance;
} asked;

static void begin(asked *a, const char *name) {
  memset(a, 0, sizeof *a);
  a->f = fmu_load(fmu_path(name));
  a->instance = fmu_simulation(a->f, &a->log);
}

static void start(asked *a) {
  assert_int_equal(a->f->EnterInitializationMode(a->instance, false, 0, 0, true, 0.125), fmi3OK);
  assert_int_equal(a->f->ExitInitializationMode(a->instance), fmi3OK);
}

static void end(asked *a) {
  a->f->FreeInstance(a->instance);
  fmu_unload(a->f);
}

/* The call was refused, with one message that has these words. */
#define assert_refused(a, call, words)                                    \
  do {                                                                    \
    int count_ = (a)->log.count;                                          \
    assert_int_equal((call), fmi3Error);                                  \
    assert_int_equal((a)->log.count, count_ + 1);                         \
    assert_int_equal((a)->log.status, fmi3Error);                         \
    assert_string_equal((a)->log.category, "logStatusError");             \
    if (!strstr((a)->log.message, (words)))                               \
      fail_msg("the message '%s' lacks '%s'", (a)->log.message, (words)); \
  } while (0)

/* --- Instantiation --- */

static void refuse_to_begin(asked *a, const char *token, const char *resources, const char *words) {
  int count = a->log.count;
  assert_null(a->f->InstantiateCoSimulation("x", token, resources, false, false, false, false, NULL,
                                            0, &a->log, fmu_take_message, NULL));
  assert_int_equal(a->log.count, count + 1);
  assert_int_equal(a->log.status, fmi3Error);
  if (!strstr(a->log.message, words)) fail_msg("'%s' lacks '%s'", a->log.message, words);
}

static void what_does_not_fit_is_not_instantiated(void **state) {
  (void)state;
  asked a;
  begin(&a, "driven");
  fmu *f = a.f;
  refuse_to_begin(&a, "0123", f->resources, "the instantiation token is not that of these");
  refuse_to_begin(&a, f->token, "/nowhere", "/nowhere/scenario.json");
  refuse_to_begin(&a, f->token, fmu_path("free/resources"), "token");
  refuse_to_begin(&a, NULL, f->resources, "instantiationToken is NULL");
  refuse_to_begin(&a, f->token, NULL, "resourcePath is NULL");
  fmi3ValueReference reference = 9999;
  assert_null(f->InstantiateCoSimulation("x", f->token, f->resources, false, false, true, false,
                                         NULL, 0, &a.log, fmu_take_message, NULL));
  assert_non_null(strstr(a.log.message, "hasEventMode"));
  assert_null(f->InstantiateCoSimulation("x", f->token, f->resources, false, false, false, false,
                                         &reference, 1, &a.log, fmu_take_message, NULL));
  assert_non_null(strstr(a.log.message, "9999"));
  assert_null(f->InstantiateScheduledExecution("x", f->token, f->resources, false, false, &a.log,
                                               fmu_take_message, NULL, NULL, NULL));
  assert_non_null(strstr(a.log.message, "no Scheduled Execution"));
  /* and without a logger */
  assert_null(f->InstantiateModelExchange("x", "0", f->resources, false, false, NULL, NULL));
  end(&a);
}

static void held_frames_are_not_for_model_exchange(void **state) {
  (void)state;
  asked a;
  begin(&a, "held");
  assert_null(a.f->InstantiateModelExchange("x", a.f->token, a.f->resources, false, false, &a.log,
                                            fmu_take_message));
  assert_non_null(strstr(a.log.message, "frames that are held"));
  end(&a);
}

static void without_an_instance_every_call_is_an_error(void **state) {
  (void)state;
  asked a;
  begin(&a, "driven");
  fmi3Boolean flag;
  double x;
  assert_int_equal(a.f->DoStep(NULL, 0, h, true, &flag, &flag, &flag, &x), fmi3Error);
  assert_int_equal(a.f->GetFloat64(NULL, NULL, 0, NULL, 0), fmi3Error);
  assert_int_equal(a.f->Terminate(NULL), fmi3Error);
  a.f->FreeInstance(NULL);
  end(&a);
}

/* --- Values --- */

static fmi3Status set_one(const asked *a, const char *name, double value) {
  fmi3ValueReference reference = fmu_reference(a->f, name);
  return a->f->SetFloat64(a->instance, &reference, 1, &value, 1);
}

static void wrong_references_and_counts_are_refused(void **state) {
  (void)state;
  asked a;
  begin(&a, "driven");
  start(&a);
  fmi3ValueReference reference = 4000, good = fmu_reference(a.f, "corner.ux");
  double value[4] = {0};
  fmi3Float32 narrow = 0;
  fmi3String text = "x";
  assert_refused(&a, a.f->GetFloat64(a.instance, &reference, 1, value, 1), "4000");
  assert_refused(&a, a.f->SetFloat64(a.instance, &reference, 1, value, 1), "4000");
  assert_refused(&a, a.f->GetFloat64(a.instance, &good, 1, value, 2), "have 1 values");
  assert_refused(&a, a.f->GetFloat64(a.instance, NULL, 1, value, 1), "valueReferences is NULL");
  assert_refused(&a, a.f->GetFloat64(a.instance, &good, 1, NULL, 1), "values is NULL");
  assert_refused(&a, a.f->GetFloat32(a.instance, &good, 1, &narrow, 1), "Float32");
  assert_refused(&a, a.f->SetString(a.instance, &good, 1, &text, 1), "String");
  assert_refused(&a, a.f->GetClock(a.instance, &good, 1, NULL), "no clocks");
  end(&a);
}

static void what_cannot_be_set_is_refused(void **state) {
  (void)state;
  asked a;
  begin(&a, "driven");
  assert_refused(&a, set_one(&a, "corner.ux", 1), "neither a parameter nor an input");
  assert_refused(&a, set_one(&a, "time", 1), "neither a parameter nor an input");
  assert_refused(&a, set_one(&a, "push", NAN), "not a finite number");
  assert_refused(&a, set_one(&a, "flesh", 0), "above 0");
  start(&a);
  assert_refused(&a, set_one(&a, "material.mu", 2e4), "fixed");
  assert_refused(&a, set_one(&a, "push", INFINITY), "not a finite number");
  /* of several, none is set if one is refused */
  fmi3ValueReference both[2] = {fmu_reference(a.f, "push"), fmu_reference(a.f, "material.mu")};
  const double value[2] = {7, 7};
  assert_refused(&a, a.f->SetFloat64(a.instance, both, 2, value, 2), "fixed");
  assert_true(fmu_get(a.f, a.instance, "push") == 0.5);
  end(&a);
}

/* The model says what is wrong when it is built, and another value makes it right. */
static void materials_that_make_no_sense_are_refused(void **state) {
  (void)state;
  asked a;
  begin(&a, "driven");
  fmu_set(a.f, a.instance, "material.mu", -5.0);
  assert_int_equal(a.f->EnterInitializationMode(a.instance, false, 0, 0, true, 0.125), fmi3OK);
  assert_refused(&a, a.f->ExitInitializationMode(a.instance), "mu");
  fmu_set(a.f, a.instance, "material.mu", 1.0e4);
  assert_int_equal(a.f->ExitInitializationMode(a.instance), fmi3OK);
  end(&a);
}

/* --- Order --- */

static void calls_out_of_order_are_refused(void **state) {
  (void)state;
  asked a;
  fmi3Boolean flag[4];
  double x;
  fmi3ValueReference output;
  begin(&a, "driven");
  output = fmu_reference(a.f, "corner.ux");
  assert_refused(&a, a.f->DoStep(a.instance, 0, h, true, flag, flag + 1, flag + 2, &x),
                 "before fmi3EnterInitializationMode");
  assert_refused(&a, a.f->GetFloat64(a.instance, &output, 1, &x, 1), "no value before");
  assert_refused(&a, a.f->ExitInitializationMode(a.instance), "before fmi3Enter");
  assert_refused(&a, a.f->EnterInitializationMode(a.instance, false, 0, 1.5, false, 0),
                 "begin at t = 0");
  assert_refused(&a, a.f->EnterInitializationMode(a.instance, true, 2.0, 0, false, 0), "tolerance");
  assert_refused(&a, a.f->EnterInitializationMode(a.instance, false, 0, 0, true, -1), "stopTime");
  start(&a);
  assert_refused(&a, a.f->EnterInitializationMode(a.instance, false, 0, 0, false, 0),
                 "in Step Mode");
  assert_refused(&a, a.f->SetTime(a.instance, 1), "in Step Mode");
  assert_refused(&a, a.f->EnterEventMode(a.instance), "in Step Mode");
  assert_refused(&a, a.f->EnterStepMode(a.instance), "no Event Mode");
  assert_refused(&a, a.f->GetContinuousStates(a.instance, &x, 1), "in Step Mode");
  assert_refused(&a, a.f->GetAdjointDerivative(a.instance, NULL, 0, NULL, 0, NULL, 0, NULL, 0),
                 "no adjoint derivatives");
  assert_refused(&a, a.f->EnterConfigurationMode(a.instance), "structural");
  assert_int_equal(a.f->Terminate(a.instance), fmi3OK);
  assert_refused(&a, a.f->DoStep(a.instance, 0, h, true, flag, flag + 1, flag + 2, &x),
                 "after fmi3Terminate");
  assert_int_equal(a.f->GetFloat64(a.instance, &output, 1, &x, 1), fmi3OK);
  end(&a);
}

static fmi3Status step(const asked *a, double t, double by) {
  fmi3Boolean event, terminate, early;
  double last;
  return a->f->DoStep(a->instance, t, by, true, &event, &terminate, &early, &last);
}

static void steps_that_lead_nowhere_are_refused(void **state) {
  (void)state;
  asked a;
  begin(&a, "driven");
  start(&a);
  assert_refused(&a, step(&a, 0, 0), "not positive");
  assert_refused(&a, step(&a, 0, -h), "not positive");
  assert_refused(&a, step(&a, 0, NAN), "not positive");
  assert_refused(&a, step(&a, h, h), "the last step led to 0 s");
  assert_refused(&a, step(&a, 0, 1), "after stopTime");
  assert_refused(&a, a.f->DoStep(a.instance, 0, h, true, NULL, NULL, NULL, NULL), "is NULL");
  assert_int_equal(step(&a, 0, h), fmi3OK);
  end(&a);
}

static void constant_steps_keep_to_their_grid(void **state) {
  (void)state;
  asked a;
  begin(&a, "stepped");
  assert_refused(&a, a.f->EnterInitializationMode(a.instance, false, 0, 0, true, 0.12),
                 "not at the end of a step");
  start(&a);
  assert_refused(&a, step(&a, 0, 0.003), "not at the end of a step");
  assert_int_equal(step(&a, 0, h), fmi3OK);
  end(&a);
}

/* --- States --- */

static void states_of_others_are_refused(void **state) {
  (void)state;
  asked a;
  int nothing = 0;
  size_t size;
  fmi3Byte byte[4] = {0};
  begin(&a, "driven");
  fmi3Instance other = fmu_simulation(a.f, &a.log);
  fmi3FMUState of_other = NULL, strange = &nothing;
  start(&a);
  assert_int_equal(a.f->GetFMUState(other, &of_other), fmi3OK);
  assert_refused(&a, a.f->SetFMUState(a.instance, of_other), "not a state of this instance");
  assert_refused(&a, a.f->SetFMUState(a.instance, NULL), "not a state of this instance");
  assert_refused(&a, a.f->SetFMUState(a.instance, strange), "not a state of this instance");
  assert_refused(&a, a.f->GetFMUState(a.instance, &strange), "not a state of this instance");
  assert_refused(&a, a.f->GetFMUState(a.instance, NULL), "is NULL");
  assert_refused(&a, a.f->FreeFMUState(a.instance, &of_other), "not a state of this instance");
  assert_refused(&a, a.f->SerializedFMUStateSize(a.instance, of_other, &size), "not a state");
  assert_refused(&a, a.f->SerializeFMUState(other, of_other, byte, 4), "there is room for 4");
  fmi3FMUState freed = of_other;
  assert_int_equal(a.f->FreeFMUState(other, &of_other), fmi3OK);
  assert_refused(&a, a.f->SetFMUState(other, freed), "freed already");
  a.f->FreeInstance(other);
  end(&a);
}

/* --- Derivatives, and Model Exchange --- */

static void wrong_questions_of_model_exchange_are_refused(void **state) {
  (void)state;
  asked a;
  fmi3Boolean flag[5];
  double next, x[3] = {0}, sensitivity;
  begin(&a, "driven");
  fmi3Instance simulation = a.instance;
  a.instance = fmu_exchange(a.f, &a.log);
  start(&a);
  assert_refused(&a, step(&a, 0, h), "in Event Mode");
  assert_refused(&a, a.f->UpdateDiscreteStates(a.instance, NULL, NULL, NULL, NULL, NULL, NULL),
                 "is NULL");
  a.f->UpdateDiscreteStates(a.instance, &flag[0], &flag[1], &flag[2], &flag[3], &flag[4], &next);
  assert_int_equal(a.f->EnterContinuousTimeMode(a.instance), fmi3OK);
  assert_refused(&a, a.f->SetContinuousStates(a.instance, x, 3), "continuous states");
  assert_refused(&a, a.f->GetContinuousStateDerivatives(a.instance, x, 3), "continuous states");
  assert_refused(&a, a.f->GetEventIndicators(a.instance, x, 1), "no event indicators");
  assert_refused(&a, a.f->SetTime(a.instance, -1), "begins at t = 0");
  assert_refused(&a, set_one(&a, "flesh", 2), "discrete");
  fmi3ValueReference flesh = fmu_reference(a.f, "flesh"), ux = fmu_reference(a.f, "corner.ux");
  fmi3ValueReference push = fmu_reference(a.f, "push");
  const double seed = 1;
#define DERIVATIVE(of, by, n) \
  a.f->GetDirectionalDerivative(a.instance, &(of), 1, &(by), 1, &seed, (n), &sensitivity, 1)
  assert_refused(&a, DERIVATIVE(ux, flesh, 1), "neither a state nor a continuous input");
  assert_refused(&a, DERIVATIVE(push, push, 1), "no derivative of push");
  assert_refused(&a, DERIVATIVE(ux, push, 2), "knowns");
  assert_int_equal(DERIVATIVE(ux, push, 1), fmi3OK);
  a.f->FreeInstance(a.instance);
  a.instance = simulation;
  end(&a);
}

/* --- Nothing is lost --- */

/* All sorts of wrong calls between the steps of one of two instances. */
static void what_follows_is_as_without_the_wrong_calls(void **state) {
  (void)state;
  asked a;
  begin(&a, "driven");
  fmi3Instance well = fmu_simulation(a.f, &a.log);
  start(&a);
  a.f->EnterInitializationMode(well, false, 0, 0, true, 0.125);
  a.f->ExitInitializationMode(well);
  fmi3ValueReference none = 4000;
  double x = 3;
  for (int k = 0; k < 8; k++) {
    fmu_step(a.f, well, k * h, h);
    step(&a, k * h, -1);
    a.f->SetFMUState(a.instance, &x);
    fmu_step(a.f, a.instance, k * h, h);
    step(&a, 7, h);
    set_one(&a, "material.mu", 3);
    set_one(&a, "flesh", -2);
    a.f->GetFloat64(a.instance, &none, 1, &x, 1);
    a.f->EnterEventMode(a.instance);
    assert_true(fmu_get(a.f, a.instance, "corner.ux") == fmu_get(a.f, well, "corner.ux"));
    assert_true(fmu_get(a.f, a.instance, "push.ax") == fmu_get(a.f, well, "push.ax"));
  }
  assert_int_equal(a.log.count, 8 * 7);
  a.f->FreeInstance(well);
  end(&a);
}

/* A motion that the integrator cannot follow ends, with what was reached; going back leads on. */
static void an_integration_that_fails_can_be_taken_back(void **state) {
  (void)state;
  asked a;
  begin(&a, "driven");
  start(&a);
  fmi3FMUState kept = NULL;
  assert_int_equal(step(&a, 0, h), fmi3OK);
  double u = fmu_get(a.f, a.instance, "corner.ux");
  assert_int_equal(a.f->GetFMUState(a.instance, &kept), fmi3OK);
  assert_int_equal(set_one(&a, "push", 1e12), fmi3OK);
  assert_refused(&a, step(&a, h, 8 * h), "cvode");
  assert_refused(&a, step(&a, h, h), "after the integration has failed");
  assert_true(fmu_get(a.f, a.instance, "time") >= h);
  assert_true(isfinite(fmu_get(a.f, a.instance, "corner.ux")));
  assert_int_equal(a.f->SetFMUState(a.instance, kept), fmi3OK);
  assert_true(fmu_get(a.f, a.instance, "corner.ux") == u);
  assert_true(fmu_get(a.f, a.instance, "push") == 0.5);
  assert_int_equal(step(&a, h, h), fmi3OK);
  end(&a);
}

static void categories_of_the_log_are_known(void **state) {
  (void)state;
  asked a;
  begin(&a, "driven");
  const fmi3String good[] = {"logStatusError", "logStatusDiscard"}, bad[] = {"logEverything"};
  assert_int_equal(a.f->SetDebugLogging(a.instance, true, 2, good), fmi3OK);
  assert_int_equal(a.f->SetDebugLogging(a.instance, false, 0, NULL), fmi3OK);
  assert_refused(&a, a.f->SetDebugLogging(a.instance, true, 1, bad), "logEverything");
  assert_string_equal(a.f->GetVersion(), "3.0");
  end(&a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_does_not_fit_is_not_instantiated),
      cmocka_unit_test(held_frames_are_not_for_model_exchange),
      cmocka_unit_test(without_an_instance_every_call_is_an_error),
      cmocka_unit_test(wrong_references_and_counts_are_refused),
      cmocka_unit_test(what_cannot_be_set_is_refused),
      cmocka_unit_test(materials_that_make_no_sense_are_refused),
      cmocka_unit_test(calls_out_of_order_are_refused),
      cmocka_unit_test(steps_that_lead_nowhere_are_refused),
      cmocka_unit_test(constant_steps_keep_to_their_grid),
      cmocka_unit_test(states_of_others_are_refused),
      cmocka_unit_test(wrong_questions_of_model_exchange_are_refused),
      cmocka_unit_test(what_follows_is_as_without_the_wrong_calls),
      cmocka_unit_test(an_integration_that_fails_can_be_taken_back),
      cmocka_unit_test(categories_of_the_log_are_known),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
