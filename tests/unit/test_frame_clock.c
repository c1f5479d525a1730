/* When held and extrapolated frames are found anew, and what is made of it. */
#include "alloc.h"
#include "bar.h"
#include "follow.h"

static bar quick_bar(void) {
  bar_def def = example2;
  def.ramp = 0.2, def.traction[0] = 1000;
  return bar_create(&def);
}

static corot_frame_policy held(void) {
  corot_frame_policy policy = corot_frame_policy_defaults();
  policy.frames = COROT_FRAMES_HELD;
  return policy;
}

/* A bar, an integrator at t = 0 and a clock on both. */
typedef struct run {
  bar bar;
  corot_integrator *integrator;
  corot_frame_clock *clock;
} run;

static run begin_with(const corot_frame_policy *policy, const corot_integrator_def *def) {
  run r = {.bar = quick_bar()};
  r.integrator = start(&r.bar, def);
  assert_ok(corot_frame_clock_create(policy, r.bar.model, r.bar.state, r.integrator, 0, r.bar.u,
                                     r.bar.v, &r.clock));
  return r;
}

static run begin(const corot_frame_policy *policy) {
  corot_integrator_def def = corot_integrator_defaults();
  return begin_with(policy, &def);
}

static void end(run *r) {
  corot_frame_clock_destroy(r->clock);
  corot_integrator_destroy(r->integrator);
  bar_destroy(&r->bar);
}

static bool never(void *data, double t, const double *u, const double *v,
                  const corot_frames_change *drift) {
  (void)data, (void)t, (void)u, (void)v, (void)drift;
  return false;
}

static void unusable_policies_are_refused(void **state) {
  (void)state;
  const struct {
    double interval, max_angle;
    const char *words;
  } bad[] = {{-0.1, 0, "interval = -0.1"},    {NAN, 0, "interval = "},
             {INFINITY, 0, "interval = inf"}, {0, -0.02, "max_angle = -"},
             {0, NAN, "max_angle = "},        {0.1, INFINITY, "max_angle = inf"},
             {0, 0, "neither an interval"}};
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator = start(&b, &def);
  corot_frame_clock *clock = NULL;
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
    for (corot_frames f = COROT_FRAMES_HELD; f <= COROT_FRAMES_EXTRAPOLATED; f++) {
      corot_frame_policy policy = corot_frame_policy_defaults();
      policy.frames = f, policy.interval = bad[k].interval, policy.max_angle = bad[k].max_angle;
      assert_fails(
          corot_frame_clock_create(&policy, b.model, b.state, integrator, 0, b.u, b.v, &clock),
          COROT_EINVAL, bad[k].words);
      assert_null(clock);
      assert_int_equal(corot_state_frames(b.state), COROT_FRAMES_EXACT);
    }
  corot_frame_policy hook_alone = held();
  hook_alone.hook = never;
  assert_ok(
      corot_frame_clock_create(&hook_alone, b.model, b.state, integrator, 0, b.u, b.v, &clock));
  assert_true(isinf(corot_frame_clock_stop(clock)));
  corot_frame_clock_destroy(clock);
  corot_frame_clock_destroy(NULL);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* A start that cannot be evaluated leaves the state on the frames it had. */
static void an_inverted_start_is_refused(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator = start(&b, &def);
  corot_frame_policy policy = held();
  corot_frame_clock *clock = NULL;
  policy.interval = 0.1;
  b.u[b.tip] = -1; /* across the bar and out again */
  assert_fails(corot_frame_clock_create(&policy, b.model, b.state, integrator, 0, b.u, b.v, &clock),
               COROT_RETRY, "inverted");
  assert_null(clock);
  assert_int_equal(corot_state_frames(b.state), COROT_FRAMES_EXACT);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

static void exact_frames_need_no_clock(void **state) {
  (void)state;
  corot_frame_policy policy = corot_frame_policy_defaults();
  policy.interval = 0.01, policy.every_step = true; /* do not matter */
  run r = begin(&policy);
  assert_true(isinf(corot_frame_clock_stop(r.clock)));
  frame_log log = follow(r.integrator, r.clock, 0, 0.1);
  assert_int_equal(updates_in(&log), 0);
  assert_int_equal(corot_state_frames(r.bar.state), COROT_FRAMES_EXACT);
  end(&r);
}

/* Exactly, to the last bit: a result must not depend on where the tolerance puts the steps. */
static void updates_are_at_the_multiples_of_the_interval(void **state) {
  (void)state;
  corot_frame_policy policy = held();
  policy.interval = 0.03;
  run r = begin(&policy);
  assert_int_equal(corot_state_frames(r.bar.state), COROT_FRAMES_HELD);
  for (int k = 1; k <= 20; k++) {
    assert_true(corot_frame_clock_stop(r.clock) == k * policy.interval);
    frame_log log = follow(r.integrator, r.clock, (k - 1) * policy.interval, k * policy.interval);
    assert_int_equal(updates_in(&log), 1);
    assert_int_equal(log.updates[COROT_FRAMES_BY_INTERVAL], 1);
    assert_true(log.last == k * policy.interval);
  }
  end(&r);
}

/* A clock may start anywhere: the multiples count from t = 0. */
static void a_clock_may_start_at_any_time(void **state) {
  (void)state;
  const struct {
    double t, next;
  } at[] = {{0.07, 1 * 0.1}, {0.3, 4 * 0.1},   {0.7, 8 * 0.1},    {1e4, 100001 * 0.1},
            {-0.25, -0.2},   {-0.3, -2 * 0.1}, {-1e-17, 1 * 0.1}, {3 * 0.1, 4 * 0.1}};
  for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
    bar b = quick_bar();
    corot_integrator *integrator;
    corot_frame_clock *clock;
    corot_integrator_def def = corot_integrator_defaults();
    corot_frame_policy policy = held();
    policy.interval = 0.1;
    assert_ok(corot_integrator_create(&def, b.model, b.state, at[k].t, b.u, b.v, &integrator));
    assert_ok(
        corot_frame_clock_create(&policy, b.model, b.state, integrator, at[k].t, b.u, b.v, &clock));
    assert_close(corot_frame_clock_stop(clock), at[k].next, 1e-15, 0);
    double stop = corot_frame_clock_stop(clock);
    frame_log log = follow(integrator, clock, at[k].t, stop);
    assert_int_equal(updates_in(&log), 1);
    assert_true(log.last == stop);
    corot_frame_clock_destroy(clock);
    corot_integrator_destroy(integrator);
    bar_destroy(&b);
  }
}

/* The first frames are those of the state it starts from. */
static void a_clock_may_start_from_a_deformed_body(void **state) {
  (void)state;
  run first = begin(&(corot_frame_policy){.frames = COROT_FRAMES_EXACT});
  bar *b = &first.bar;
  run_to(first.integrator, 0.2);
  assert_ok(corot_integrator_at(first.integrator, 0.2, b->u, b->v));
  double *exact = malloc(2 * b->n * sizeof *exact), *now = exact + b->n;
  assert_ok(corot_residual(b->model, b->state, 0.2, b->u, b->v, exact));
  assert_above(norm_max(b->n, b->u), 0.05);
  corot_integrator_def def = corot_integrator_defaults();
  for (corot_frames f = COROT_FRAMES_HELD; f <= COROT_FRAMES_EXTRAPOLATED; f++) {
    corot_frame_policy policy = held();
    corot_integrator *integrator;
    corot_frame_clock *clock;
    corot_frames_change drift;
    policy.frames = f, policy.interval = 0.1;
    assert_ok(corot_integrator_create(&def, b->model, b->state, 0.2, b->u, b->v, &integrator));
    assert_ok(
        corot_frame_clock_create(&policy, b->model, b->state, integrator, 0.2, b->u, b->v, &clock));
    assert_ok(corot_frames_drift(b->model, b->state, 0.2, b->u, &drift));
    assert_true(drift.angle_max == 0 && drift.energy == 0);
    assert_ok(corot_residual(b->model, b->state, 0.2, b->u, b->v, now));
    assert_below(difference_of(b->n, now, exact), 1e-13 * soft.lambda * 0.01); /* on 0.1 x 0.1 m */
    corot_frame_clock_destroy(clock);
    corot_integrator_destroy(integrator);
  }
  free(exact), end(&first);
}

static void every_step_is_every_step(void **state) {
  (void)state;
  corot_frame_policy policy = held();
  policy.every_step = true, policy.history = COROT_HISTORY_KEEP;
  run r = begin(&policy);
  frame_log log = follow(r.integrator, r.clock, 0, 0.3);
  assert_true(log.steps > 20 && log.updates[COROT_FRAMES_BY_STEP] == log.steps);
  assert_int_equal(corot_integrator_statistics(r.integrator).nrestart, 0);
  end(&r);
}

/* The drift passes the angle in the step before an update, and in no other. */
static void an_angle_triggers_the_update_after_it_is_passed(void **state) {
  (void)state;
  corot_frame_policy policy = held();
  policy.max_angle = 0.02;
  run r = begin(&policy);
  corot_step step = {0};
  long updates = 0;
  while (step.t < 0.4) {
    corot_frame_event event;
    corot_frames_change drift;
    assert_ok(corot_integrator_step(r.integrator, 0.4, &step));
    assert_ok(corot_integrator_at(r.integrator, step.t, r.bar.u, NULL));
    assert_ok(corot_frames_drift(r.bar.model, r.bar.state, step.t, r.bar.u, &drift));
    assert_ok(corot_frame_clock_tick(r.clock, step.t, &event));
    assert_int_equal(event.reason, drift.angle_max > policy.max_angle ? COROT_FRAMES_BY_ANGLE
                                                                      : COROT_FRAMES_KEPT);
    if (!event.reason) continue;
    assert_true(event.change.angle_max == drift.angle_max);
    assert_true(event.change.energy == drift.energy);
    updates++;
  }
  assert_true(updates > 10); /* the bar bends by half a radian */
  end(&r);
}

/* A free box that spins at 5 rad/s: extrapolated frames may turn by 0.1 rad, so for 20 ms. */
static void the_cap_forces_updates_of_extrapolated_frames(void **state) {
  (void)state;
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  body b = make_body(crooked_box(1, 1, 1), def);
  double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n, rate = 5;
  for (int n = 0; n < b.mesh->nnode; n++) { /* free: dof 3n + c */
    v[3 * n] = -rate * b.mesh->x[n][1];
    v[3 * n + 1] = rate * b.mesh->x[n][0];
  }
  corot_integrator_def method = corot_integrator_defaults();
  corot_frame_policy policy = corot_frame_policy_defaults();
  policy.frames = COROT_FRAMES_EXTRAPOLATED, policy.interval = 0.0501;
  corot_integrator *integrator;
  corot_frame_clock *clock;
  assert_ok(corot_integrator_create(&method, b.model, b.state, 0, u, v, &integrator));
  assert_ok(corot_frame_clock_create(&policy, b.model, b.state, integrator, 0, u, v, &clock));
  assert_close(corot_frame_clock_stop(clock), COROT_EXTRAPOLATION_CAP / rate, 1e-12, 0);
  frame_log log = follow(integrator, clock, 0, 0.2);
  /* 0.02 0.04 .0501 .0701 .0901 .1002 ... : two in each interval but the last, which is cut short
   */
  assert_int_equal(log.updates[COROT_FRAMES_BY_INTERVAL], 3);
  assert_int_equal(log.updates[COROT_FRAMES_BY_CAP], 8);
  assert_int_equal(updates_in(&log), 11);
  assert_below(log.angle_max, 0.02); /* what the box's stretching takes from a steady turn */

  policy.frames = COROT_FRAMES_HELD; /* are never forced */
  corot_frame_clock_destroy(clock);
  corot_integrator_destroy(integrator);
  assert_ok(corot_integrator_create(&method, b.model, b.state, 0, u, v, &integrator));
  assert_ok(corot_frame_clock_create(&policy, b.model, b.state, integrator, 0, u, v, &clock));
  log = follow(integrator, clock, 0, 0.2);
  assert_int_equal(log.updates[COROT_FRAMES_BY_CAP], 0);
  assert_above(log.angle_max, COROT_EXTRAPOLATION_CAP);
  corot_frame_clock_destroy(clock);
  corot_integrator_destroy(integrator);
  free(u), drop_body(&b);
}

/* What a hook was told, and what it does: says yes at each third call. */
typedef struct witness {
  const bar *bar;
  long calls, yes;
  double t, angle;
  bool same; /* u and v were the integrator's */
  corot_integrator *integrator;
} witness;

static bool at_each_third_call(void *data, double t, const double *u, const double *v,
                               const corot_frames_change *drift) {
  witness *w = data;
  int n = w->bar->n;
  double *y = malloc(2 * n * sizeof *y);
  assert_ok(corot_integrator_at(w->integrator, t, y, y + n));
  w->same = w->same && memcmp(u, y, n * sizeof *u) == 0 && memcmp(v, y + n, n * sizeof *v) == 0;
  free(y);
  w->t = t, w->angle = drift->angle_max;
  bool yes = ++w->calls % 3 == 0;
  w->yes += yes;
  return yes;
}

static void the_hook_is_asked_after_each_step(void **state) {
  (void)state;
  witness w = {.same = true};
  corot_frame_policy policy = held();
  policy.hook = at_each_third_call, policy.hook_data = &w;
  run r = begin(&policy);
  w.bar = &r.bar, w.integrator = r.integrator;
  corot_step step = {0};
  long steps = 0, updates = 0;
  while (step.t < 0.3) {
    corot_frame_event event;
    corot_frames_change drift;
    assert_ok(corot_integrator_step(r.integrator, 0.3, &step));
    assert_int_equal(w.calls, steps++); /* not within a step */
    assert_ok(corot_integrator_at(r.integrator, step.t, r.bar.u, NULL));
    assert_ok(corot_frames_drift(r.bar.model, r.bar.state, step.t, r.bar.u, &drift));
    assert_ok(corot_frame_clock_tick(r.clock, step.t, &event));
    assert_true(w.t == step.t && w.angle == drift.angle_max && w.same);
    assert_int_equal(event.reason, w.calls % 3 ? COROT_FRAMES_KEPT : COROT_FRAMES_BY_HOOK);
    updates += event.reason != COROT_FRAMES_KEPT;
  }
  assert_true(updates > 5 && updates == w.yes);
  end(&r);
}

/* Where another condition has decided already there is nothing to ask. */
static void the_hook_is_not_asked_what_is_decided(void **state) {
  (void)state;
  witness w = {.same = true};
  corot_frame_policy policy = held();
  policy.hook = at_each_third_call, policy.hook_data = &w, policy.interval = 0.02;
  run r = begin(&policy);
  w.bar = &r.bar, w.integrator = r.integrator;
  frame_log log = follow(r.integrator, r.clock, 0, 0.2);
  assert_int_equal(log.updates[COROT_FRAMES_BY_INTERVAL], 10);
  assert_int_equal(w.calls, log.steps - 10);
  assert_int_equal(log.updates[COROT_FRAMES_BY_HOOK], w.yes);
  end(&r);
}

static void history_is_treated_as_told(void **state) {
  (void)state;
  corot_frame_policy policy = held();
  policy.interval = 0.02;
  for (corot_history h = COROT_HISTORY_AUTO; h <= COROT_HISTORY_RESTART; h++) {
    policy.history = h;
    run r = begin(&policy);
    frame_log log = follow(r.integrator, r.clock, 0, 0.4);
    corot_statistics s = corot_integrator_statistics(r.integrator);
    assert_int_equal(updates_in(&log), 20);
    assert_int_equal(s.nrestart, log.restarts);
    assert_int_equal(s.nst, log.steps);
    if (h == COROT_HISTORY_KEEP) assert_int_equal(s.nrestart, 0);
    if (h == COROT_HISTORY_RESTART) assert_int_equal(s.nrestart, 20);
    end(&r);
  }
}

/* A method of constant step keeps to its grid: the update is at the first point not before it, and
   several multiples within one step make one update. */
static void constant_steps_update_where_they_can(void **state) {
  (void)state;
  const struct {
    double step, interval;
    long updates;
    double last;
  } kase[] = {{0.01, 0.025, 12, 0.3}, {0.01, 0.01, 30, 0.3}, {0.03, 0.01, 10, 0.3}};
  for (size_t k = 0; k < sizeof kase / sizeof *kase; k++) {
    corot_integrator_def def = corot_integrator_defaults();
    def.method = "backward-euler", def.step = kase[k].step;
    corot_frame_policy policy = held();
    policy.interval = kase[k].interval;
    run r = begin_with(&policy, &def);
    frame_log log = follow(r.integrator, r.clock, 0, 0.2999);
    assert_int_equal(log.updates[COROT_FRAMES_BY_INTERVAL], kase[k].updates);
    assert_close(log.last, kase[k].last, 1e-12, 0);
    end(&r);
  }
}

static corot_status make_clock(void *context) {
  run *r = context;
  corot_frame_policy policy = held();
  policy.interval = 0.1;
  corot_frame_clock *clock;
  COROT_TRY(corot_frame_clock_create(&policy, r->bar.model, r->bar.state, r->integrator, 0,
                                     r->bar.u, r->bar.v, &clock));
  corot_frame_clock_destroy(clock);
  return COROT_OK;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  run r = begin(&(corot_frame_policy){.frames = COROT_FRAMES_EXACT});
  assert_int_equal(assert_survives_failed_allocations(make_clock, &r), 3);
  end(&r);
}

/* Nothing is allocated between the start and the end of a run. */
static void a_tick_allocates_nothing(void **state) {
  (void)state;
  corot_frame_policy policy = held();
  policy.frames = COROT_FRAMES_EXTRAPOLATED, policy.interval = 0.02, policy.max_angle = 0.01;
  run r = begin(&policy);
  alloc_fail_at(0);
  frame_log log = follow(r.integrator, r.clock, 0, 0.2);
  assert_true(updates_in(&log) > 9);
  assert_int_equal(alloc_count(), 0);
  end(&r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unusable_policies_are_refused),
      cmocka_unit_test(an_inverted_start_is_refused),
      cmocka_unit_test(exact_frames_need_no_clock),
      cmocka_unit_test(updates_are_at_the_multiples_of_the_interval),
      cmocka_unit_test(a_clock_may_start_at_any_time),
      cmocka_unit_test(a_clock_may_start_from_a_deformed_body),
      cmocka_unit_test(every_step_is_every_step),
      cmocka_unit_test(an_angle_triggers_the_update_after_it_is_passed),
      cmocka_unit_test(the_cap_forces_updates_of_extrapolated_frames),
      cmocka_unit_test(the_hook_is_asked_after_each_step),
      cmocka_unit_test(the_hook_is_not_asked_what_is_decided),
      cmocka_unit_test(history_is_treated_as_told),
      cmocka_unit_test(constant_steps_update_where_they_can),
      cmocka_unit_test(failed_allocations_are_survived),
      cmocka_unit_test(a_tick_allocates_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
