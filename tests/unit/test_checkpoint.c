/* States that are taken away: what goes on after a save, what is restored elsewhere, and what goes
   back, give the same bits, by every method, with all kinds of frames, solvers and inputs. */
#include <corot/checkpoint.h>
#include <corot/inputs.h>

#include "alloc.h"
#include "live.h"
#include "solve/integrate/integrator.h"

/* --- A run with everything in it ----------------------------------------------------------------
 */

enum { STEPS = 24 }; /* in a leg of it */

typedef struct plan {
  int method;
  const char *measure, *solver;
  corot_frames frames;
  bool live; /* inputs that change */
  int order;
  double rival; /* iterations that a factor is worth, of conjugate gradients that were not asked
                   for; 0: they were */
} plan;

typedef struct run {
  const plan *plan;
  body b;
  corot_inputs *in; /* NULL: none */
  corot_integrator *integrator;
  corot_frame_clock *clock;
} run;

static run begin(const plan *p) {
  run r = {.plan = p, .b = make_bar(p->measure, p->order ? p->order : 1, NLOAD, loads)};
  if (p->live) r.in = give_inputs(&r.b);
  corot_integrator_def def = corot_integrator_defaults();
  def.method = corot_method_at(p->method)->name, def.rtol = 1e-5, def.step = 1e-3;
  if (p->solver) def.linear.solver = p->solver;
  if (p->rival > 0) def.linear.preconditioner = "block-jacobi"; /* takes more iterations */
  double *rest = calloc(r.b.n, sizeof *rest);
  corot_state_enter(r.b.state, 0);
  assert_ok(corot_integrator_create(&def, r.b.model, r.b.state, 0, rest, rest, &r.integrator));
  if (p->rival > 0) {
    r.integrator->pencil->tentative = true;
    r.integrator->pencil->chosen.rival.factor = p->rival;
  }
  corot_frame_policy policy = corot_frame_policy_defaults();
  policy.frames = p->frames, policy.max_angle = 0.02;
  if (p->frames == COROT_FRAMES_HELD) policy.interval = 4e-3;
  if (p->frames == COROT_FRAMES_EXTRAPOLATED) policy.max_angle = 1e-3; /* the cap, too */
  assert_ok(corot_frame_clock_create(&policy, r.b.model, r.b.state, r.integrator, 0, rest, rest,
                                     &r.clock));
  free(rest);
  return r;
}

static void end(run *r) {
  corot_frame_clock_destroy(r->clock);
  corot_integrator_destroy(r->integrator);
  drop_with(&r->b, r->in);
}

/* All that a run says, step by step and in the end. */
typedef struct trace {
  corot_step step[STEPS];
  corot_statistics statistics;
  double work[2], *u; /* [2 n] */
} trace;

static void drop_times(corot_statistics *s) {
  s->force_s = s->assembly_s = s->combine_s = s->factor_s = s->solve_s = s->work_s = 0;
  s->integrator_s = 0;
}

/* Everything that comes in while it goes on; the k-th change. */
static void change_inputs(const run *r, int k, double t) {
  const corot_material_factors stiffer = {1.2, 1 + 0.1 * k, 1, 1};
  double(*force)[3] = calloc(r->b.mesh->nnode + 1, sizeof *force);
  force[r->b.mesh->nnode - 1][0] = 0.01 * k;
  double x[1][3] = {{1e-3 * k, 0, 0}};
  corot_path path = {.group = "zmin", .t = t + 5e-3, .n = 1, .x = (const double(*)[3])x};
  const double(*push)[3] = (const double(*)[3])force;
  if (k == 1) assert_ok(corot_inputs_set_force(r->in, r->b.mesh->nnode, push));
  if (k > 1)
    assert_ok(corot_inputs_ramp_force(r->in, r->b.mesh->nnode, t, push, t + 1e-2, push + 1));
  assert_ok(corot_inputs_ramp_load(r->in, 1, t, 1, t + 1, 1 + k));
  assert_ok(corot_inputs_set_load(r->in, 2, 0.5 * k));
  if (k < 3) assert_ok(corot_inputs_set_material(r->in, 0, &stiffer));
  if (k < 3) assert_ok(corot_inputs_reach(r->in, t, &path));
  assert_ok(corot_integrator_changed(r->integrator, COROT_HISTORY_AUTO));
  free(force);
}

/* A leg from where the run is; the inputs change after its 3rd, 9th, 15th step, from the `first`
   time on. */
static void go(const run *r, int first, trace *out) {
  double t = 0;
  int n = r->b.n, change = first;
  memset(out, 0, sizeof *out);
  out->u = calloc(2 * n, sizeof *out->u);
  for (int k = 0; k < STEPS; k++) {
    corot_frame_event event;
    double stop = fmin(0.5, corot_frame_clock_stop(r->clock));
    assert_ok(corot_integrator_step(r->integrator, stop, &out->step[k]));
    t = out->step[k].t;
    assert_ok(corot_frame_clock_tick(r->clock, t, &event));
    if (r->in && k % 6 == 3) change_inputs(r, change++, t);
  }
  assert_ok(corot_integrator_at(r->integrator, t, out->u, out->u + n));
  assert_ok(corot_integrator_work(r->integrator, t, &out->work[0], &out->work[1]));
  out->statistics = corot_integrator_statistics(r->integrator);
  drop_times(&out->statistics);
}

static void assert_equal(int n, const trace *a, const trace *b) {
  for (int k = 0; k < STEPS; k++)
    if (memcmp(&a->step[k].t, &b->step[k].t, sizeof(double)) != 0)
      fail_msg("step %d ends at %.17g, not at %.17g", k, b->step[k].t, a->step[k].t);
  assert_memory_equal(a->u, b->u, 2 * n * sizeof *a->u);
  assert_memory_equal(a->work, b->work, sizeof a->work);
  for (int k = 0; k < STEPS; k++) {
    assert_int_equal(a->step[k].order, b->step[k].order);
    assert_int_equal(a->step[k].newton, b->step[k].newton);
    assert_true(a->step[k].error == b->step[k].error);
  }
  assert_memory_equal(&a->statistics, &b->statistics, sizeof a->statistics);
}

/* Saved, and gone on; restored elsewhere; gone back. Twice, so that what is restored is saved. */
static void check(const plan *p) {
  run first = begin(p), other = begin(p);
  trace warm, went_on, elsewhere, again;
  void *blob;
  size_t bytes;
  int n = first.b.n;
  go(&first, 1, &warm);
  for (int leg = 0; leg < 2; leg++) {
    assert_ok(corot_integrator_save(first.integrator, &blob, &bytes));
    double stop = corot_frame_clock_stop(first.clock);
    double t = corot_integrator_time(first.integrator);
    go(&first, 2, &went_on);
    assert_ok(corot_integrator_restore(other.integrator, blob, bytes));
    assert_true(corot_frame_clock_stop(other.clock) == stop);
    assert_true(corot_integrator_time(other.integrator) == t);
    go(&other, 2, &elsewhere);
    assert_equal(n, &went_on, &elsewhere);
    assert_ok(corot_integrator_restore(first.integrator, blob, bytes));
    go(&first, 2, &again);
    assert_equal(n, &went_on, &again);
    corot_blob_free(blob);
    free(went_on.u), free(elsewhere.u), free(again.u);
  }
  free(warm.u);
  end(&other);
  end(&first);
}

static const corot_frames kinds[] = {COROT_FRAMES_EXACT, COROT_FRAMES_HELD,
                                     COROT_FRAMES_EXTRAPOLATED};

static void every_method_goes_on_from_a_state_bit_for_bit(void **state) {
  (void)state;
  for (int i = 0; corot_method_at(i); i++)
    for (int live = 0; live < 2; live++) {
      plan p = {i, "polar", NULL, COROT_FRAMES_EXACT, live, 1, 0};
      check(&p);
    }
}

static void held_and_extrapolated_frames_come_with_it(void **state) {
  (void)state;
  for (int i = 0; corot_method_at(i); i++)
    for (int f = 1; f < 3; f++) {
      plan p = {i, "polar", NULL, kinds[f], true, 1, 0};
      check(&p);
    }
}

static void every_measure_and_solver_does(void **state) {
  (void)state;
  static const char *const solvers[] = {"klu", "pcg", NULL};
  for (int k = 0; k < NMEASURE; k++)
    for (int s = 0; s < 3; s++) {
      plan p = {s, measures[k], solvers[s], COROT_FRAMES_EXACT, s == 0, s == 0 ? 2 : 1, 0};
      check(&p);
    }
}

static bool by_pcg(const corot_integrator *integrator) {
  return strncmp(corot_integrator_chosen(integrator).linear_solver, "pcg", 3) == 0;
}

/* Conjugate gradients give way to a direct solver before the state is taken away, after it, or
   never; who restores it has the solver in use that was in use then. */
static void the_solver_in_use_comes_with_it(void **state) {
  (void)state;
  int count[2] = {0};
  for (double rival = 1; rival < 10; rival *= 1.5) {
    plan p = {0, "polar", "pcg", COROT_FRAMES_EXACT, false, 1, rival};
    check(&p);
    run r = begin(&p), fresh = begin(&p);
    trace leg[4];
    void *blob;
    size_t bytes;
    go(&r, 1, &leg[0]);
    go(&r, 1, &leg[1]);
    bool changed = !by_pcg(r.integrator);
    assert_ok(corot_integrator_save(r.integrator, &blob, &bytes));
    go(&r, 2, &leg[2]);
    assert_ok(corot_integrator_restore(fresh.integrator, blob, bytes));
    assert_int_equal(by_pcg(fresh.integrator), !changed);
    go(&fresh, 2, &leg[3]);
    assert_equal(r.b.n, &leg[2], &leg[3]);
    for (int k = 0; k < 4; k++) free(leg[k].u);
    corot_blob_free(blob);
    end(&fresh);
    end(&r);
    count[changed]++;
  }
  assert_true(count[0] > 0 && count[1] > 0);
}

static const double jump_time[] = {0, 0.01, 0.01}, jump_value[] = {0.2, 0.2, 3};

/* Twelve steps; how far they went, and where to. */
static void go_past(corot_integrator *integrator, int n, double end_of[2]) {
  corot_step step;
  for (int s = 0; s < 12; s++) assert_ok(corot_integrator_step(integrator, 0.2, &step));
  double *u = malloc(n * sizeof *u);
  assert_ok(corot_integrator_at(integrator, step.t, u, NULL));
  end_of[0] = step.t, end_of[1] = u[n - 3];
  free(u);
}

/* Steps to the jump, passes it, and is saved there before anything else happens: also for who is
   far from it. */
static void a_jump_that_was_just_passed_is_not_forgotten(void **state) {
  (void)state;
  const corot_load pulled = {COROT_TRACTION, "zmax", {300, 0, 0}, {3, jump_time, jump_value}};
  for (int i = 0; corot_method_at(i); i++) {
    double end_of[3][2];
    body b = make_bar("polar", 1, 1, &pulled), c = make_bar("polar", 1, 1, &pulled);
    corot_state_enter(b.state, 0), corot_state_enter(c.state, 0);
    corot_integrator *integrator = integrate_by(i, &b, 1e-4), *other = integrate_by(i, &c, 1e-4);
    void *blob;
    size_t bytes;
    go_to(integrator, 0.01);
    corot_state_enter(b.state, 0.01);
    assert_ok(corot_integrator_kink(integrator));
    assert_ok(corot_integrator_save(integrator, &blob, &bytes));
    go_past(integrator, b.n, end_of[0]);
    assert_ok(corot_integrator_restore(integrator, blob, bytes));
    go_past(integrator, b.n, end_of[1]);
    assert_ok(corot_integrator_restore(other, blob, bytes));
    go_past(other, b.n, end_of[2]);
    assert_memory_equal(end_of[0], end_of[1], sizeof end_of[0]);
    assert_memory_equal(end_of[0], end_of[2], sizeof end_of[0]);
    corot_blob_free(blob);
    corot_integrator_destroy(integrator), corot_integrator_destroy(other);
    drop_body(&b), drop_body(&c);
  }
}

/* --- What a beginning costs --------------------------------------------------------------------
 */

/* To the end of a swing, saved after every `often` steps (0: never): steps taken, and where a
   corner is. */
static long swing(int i, const char *table, int often, double *x) {
  const corot_load pulled = {COROT_TRACTION, "zmax", {100, 0, 0}, {0}};
  body b = make_bar("polar", 1, 1, &pulled);
  corot_integrator_def def = corot_integrator_defaults();
  def.method = corot_method_at(i)->name, def.rtol = 1e-6, def.step = 1e-3, def.table = table;
  double *u = calloc(2 * b.n, sizeof *u);
  corot_integrator *integrator;
  assert_ok(corot_integrator_create(&def, b.model, b.state, 0, u, u + b.n, &integrator));
  for (corot_step step = {0}; step.t < 0.3 * (1 - 1e-9);) {
    void *blob;
    size_t bytes;
    assert_ok(corot_integrator_step(integrator, 0.3, &step));
    if (often == 0 || corot_integrator_statistics(integrator).nst % often) continue;
    assert_ok(corot_integrator_save(integrator, &blob, &bytes));
    corot_blob_free(blob);
  }
  if (table) assert_string_equal(corot_integrator_chosen(integrator).table, table);
  assert_ok(corot_integrator_at(integrator, 0.3, u, NULL));
  *x = u[b.n - 3];
  long nst = corot_integrator_statistics(integrator).nst;
  free(u);
  corot_integrator_destroy(integrator);
  drop_body(&b);
  return nst;
}

/* Methods of one step take as many steps as without, but for what error control remembers of the
   errors before; of constant step the same ones; those of several take some ten more for each
   beginning. All arrive at the same place, but for a multiple of the tolerance. */
static void a_beginning_costs_methods_of_one_step_nothing(void **state) {
  (void)state;
  for (int i = 0; corot_method_at(i); i++) {
    const corot_method_kind *kind = corot_method_at(i);
    const char *table = kind->stages && !kind->explicit_steps ? "ARKODE_KVAERNO_5_3_4" : NULL;
    int often = kind->multistep ? 100 : 20;
    double x, y;
    long plain = swing(i, table, 0, &x), saved = swing(i, table, often, &y);
    if (kind->multistep)
      assert_true(saved < plain + 20 * (plain / often));
    else if (kind->stages)
      assert_true(labs(saved - plain) <= plain / 10);
    else
      assert_int_equal(saved, plain);
    assert_close(y, x, kind->multistep ? 1e-4 : kind->stages ? 1e-5 : 1e-7, 0);
  }
}

/* --- What is refused ---------------------------------------------------------------------------
 */

static void any_damage_is_refused_and_nothing_is_lost(void **state) {
  (void)state;
  plan p = {0, "polar", NULL, COROT_FRAMES_HELD, true, 1, 0};
  run r = begin(&p);
  trace warm, went_on, again;
  void *blob;
  size_t bytes;
  go(&r, 1, &warm);
  assert_ok(corot_integrator_save(r.integrator, &blob, &bytes));
  unsigned char *copy = malloc(bytes + 1);

  /* one bit of each byte of the header, and of every 37th behind it; and cut there */
  for (size_t k = 0; k < bytes; k += k < 200 ? 1 : 37) {
    memcpy(copy, blob, bytes);
    copy[k] ^= (unsigned char)(1 << k % 8);
    assert_int_equal(corot_integrator_restore(r.integrator, copy, bytes), COROT_EINVAL);
    memcpy(copy, blob, bytes);
    assert_fails(corot_integrator_restore(r.integrator, copy, k), COROT_EINVAL, "cut short");
  }
  memcpy(copy, blob, bytes);
  assert_fails(corot_integrator_restore(r.integrator, copy, bytes + 1), COROT_EINVAL, "bytes");
  copy[16]++;
  assert_fails(corot_integrator_restore(r.integrator, copy, bytes), COROT_EINVAL, "format 2");
  for (int k = 0; k < 8; k++) copy[8 + k] = ((unsigned char *)blob)[15 - k];
  assert_fails(corot_integrator_restore(r.integrator, copy, bytes), COROT_EINVAL, "byte order");
  assert_fails(corot_integrator_restore(r.integrator, NULL, bytes), COROT_EINVAL, "NULL");
  assert_fails(corot_integrator_restore(NULL, blob, bytes), COROT_EINVAL, "NULL");
  assert_fails(corot_integrator_save(r.integrator, NULL, &bytes), COROT_EINVAL, "NULL");

  go(&r, 2, &went_on);
  assert_ok(corot_integrator_restore(r.integrator, blob, bytes));
  go(&r, 2, &again);
  assert_equal(r.b.n, &went_on, &again);
  free(warm.u), free(went_on.u), free(again.u), free(copy);
  corot_blob_free(blob);
  corot_blob_free(NULL);
  end(&r);
}

static void what_is_of_another_model_or_definition_is_refused(void **state) {
  (void)state;
  plan p = {0, "polar", NULL, COROT_FRAMES_EXACT, false, 1, 0};
  run r = begin(&p);
  void *blob;
  size_t bytes;
  assert_ok(corot_integrator_save(r.integrator, &blob, &bytes));
  const struct {
    plan plan;
    const char *words;
  } others[] = {{{0, "green", NULL, COROT_FRAMES_EXACT, false, 1, 0}, "another model"},
                {{0, "polar", NULL, COROT_FRAMES_EXACT, false, 2, 0}, "another model"},
                {{1, "polar", NULL, COROT_FRAMES_EXACT, false, 1, 0}, "another definition"},
                {{0, "polar", "klu", COROT_FRAMES_EXACT, false, 1, 0}, "another definition"},
                {{0, "polar", NULL, COROT_FRAMES_EXACT, true, 1, 0}, "inputs"}};
  for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
    run other = begin(&others[k].plan);
    assert_fails(corot_integrator_restore(other.integrator, blob, bytes), COROT_EINVAL,
                 others[k].words);
    end(&other);
  }
  corot_blob_free(blob);
  end(&r);
}

/* The same loads with one number changed: each kind of number shows. */
static void a_model_is_known_by_each_of_its_numbers(void **state) {
  (void)state;
  corot_load changed[NLOAD];
  plan p = {0, "polar", NULL, COROT_FRAMES_EXACT, false, 1, 0};
  run r = begin(&p);
  void *blob;
  size_t bytes;
  assert_ok(corot_integrator_save(r.integrator, &blob, &bytes));
  static const double other_values[] = {0.5, 1.5000001};
  for (int k = 0; k < 2 * NLOAD; k++) {
    memcpy(changed, loads, sizeof changed);
    if (k < NLOAD)
      changed[k].value[0] *= 1 + 1e-15;
    else if (changed[k - NLOAD].amplitude.n)
      changed[k - NLOAD].amplitude.value = other_values;
    else
      changed[k - NLOAD].amplitude = (corot_amplitude){.n = 2, .time = times, .value = values};
    body b = make_bar("polar", 1, NLOAD, changed);
    corot_integrator_def def = corot_integrator_defaults();
    def.method = corot_method_at(0)->name, def.rtol = 1e-5, def.step = 1e-3;
    corot_integrator *integrator;
    double *rest = calloc(b.n, sizeof *rest);
    assert_ok(corot_integrator_create(&def, b.model, b.state, 0, rest, rest, &integrator));
    assert_fails(corot_integrator_restore(integrator, blob, bytes), COROT_EINVAL, "another model");
    free(rest);
    corot_integrator_destroy(integrator);
    drop_body(&b);
  }
  corot_blob_free(blob);
  end(&r);
}

static void a_change_that_was_not_told_is_refused(void **state) {
  (void)state;
  plan p = {0, "polar", NULL, COROT_FRAMES_EXACT, true, 1, 0};
  run r = begin(&p);
  void *blob;
  size_t bytes;
  assert_ok(corot_inputs_set_load(r.in, 0, 2));
  assert_fails(corot_integrator_save(r.integrator, &blob, &bytes), COROT_EINVAL, "was not told");
  assert_ok(corot_integrator_changed(r.integrator, COROT_HISTORY_AUTO));
  assert_ok(corot_integrator_save(r.integrator, &blob, &bytes));
  corot_blob_free(blob);
  end(&r);
}

/* A frame clock on the integrator of the run in the place of the one that it has. */
static void change_clock(run *r, const corot_frame_policy *policy) {
  double *rest = calloc(r->b.n, sizeof *rest);
  corot_frame_clock_destroy(r->clock);
  assert_ok(corot_frame_clock_create(policy, r->b.model, r->b.state, r->integrator, 0, rest, rest,
                                     &r->clock));
  free(rest);
}

static bool never(void *data, double t, const double *u, const double *v,
                  const corot_frames_change *drift) {
  (void)data, (void)t, (void)u, (void)v, (void)drift;
  return false;
}

/* Its count of intervals would mean other times. */
static void a_clock_of_another_policy_is_refused(void **state) {
  (void)state;
  plan p = {0, "polar", NULL, COROT_FRAMES_HELD, false, 1, 0};
  run r = begin(&p), other = begin(&p);
  corot_frame_policy policy = corot_frame_policy_defaults();
  policy.frames = COROT_FRAMES_HELD, policy.interval = 4e-3, policy.max_angle = 0.02;
  void *blob;
  size_t bytes;
  assert_ok(corot_integrator_save(r.integrator, &blob, &bytes));
  for (int k = 0; k < 6; k++) {
    corot_frame_policy changed = policy;
    if (k == 0) changed.interval = 5e-3;
    if (k == 1) changed.max_angle = 0.03;
    if (k == 2) changed.every_step = true;
    if (k == 3) changed.history = COROT_HISTORY_KEEP;
    if (k == 4) changed.hook = never;
    if (k == 5) changed.frames = COROT_FRAMES_EXTRAPOLATED;
    change_clock(&other, &changed);
    assert_fails(corot_integrator_restore(other.integrator, blob, bytes), COROT_EINVAL, "policy");
  }
  change_clock(&other, &policy);
  assert_ok(corot_integrator_restore(other.integrator, blob, bytes));
  corot_blob_free(blob);
  end(&other);
  end(&r);
}

/* A clock may go before its integrator or after it. */
static void a_clock_may_outlive_its_integrator(void **state) {
  (void)state;
  plan p = {0, "polar", NULL, COROT_FRAMES_HELD, false, 1, 0};
  run r = begin(&p);
  corot_integrator_destroy(r.integrator);
  r.integrator = NULL;
  end(&r);
}

/* --- Want of memory ----------------------------------------------------------------------------
 */

typedef struct tight {
  run *r;
  const void *blob;
  size_t bytes;
} tight;

static corot_status save_once(void *context) {
  tight *c = context;
  void *blob;
  size_t bytes;
  COROT_TRY(corot_integrator_save(c->r->integrator, &blob, &bytes));
  corot_blob_free(blob);
  return COROT_OK;
}

static corot_status restore_once(void *context) {
  tight *c = context;
  return corot_integrator_restore(c->r->integrator, c->blob, c->bytes);
}

/* Whichever allocation fails, the run goes on as it would have. */
static void want_of_memory_loses_nothing(void **state) {
  (void)state;
  for (int i = 0; corot_method_at(i); i++)
    for (int restoring = 0; restoring < 2; restoring++) {
      plan p = {i, "polar", NULL, COROT_FRAMES_HELD, true, 1, 0};
      run r = begin(&p), other = begin(&p);
      trace warm, warm_too, went_on, again;
      void *blob = NULL;
      size_t bytes = 0;
      go(&r, 1, &warm);
      go(&other, 1, &warm_too);
      if (restoring) assert_ok(corot_integrator_save(r.integrator, &blob, &bytes));
      tight c = {&other, blob, bytes};
      corot_status status = COROT_ENOMEM;
      for (long k = 1; status; k++) {
        alloc_fail_at(k);
        status = restoring ? restore_once(&c) : save_once(&c);
        alloc_fail_at(0);
        if (status) assert_int_equal(status, COROT_ENOMEM);
      }
      if (!restoring) assert_ok(save_once(&(tight){&r, NULL, 0}));
      go(&r, 2, &went_on);
      go(&other, 2, &again);
      assert_equal(r.b.n, &went_on, &again);
      free(warm.u), free(warm_too.u), free(went_on.u), free(again.u);
      corot_blob_free(blob);
      end(&other);
      end(&r);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_method_goes_on_from_a_state_bit_for_bit),
      cmocka_unit_test(held_and_extrapolated_frames_come_with_it),
      cmocka_unit_test(every_measure_and_solver_does),
      cmocka_unit_test(the_solver_in_use_comes_with_it),
      cmocka_unit_test(a_jump_that_was_just_passed_is_not_forgotten),
      cmocka_unit_test(a_beginning_costs_methods_of_one_step_nothing),
      cmocka_unit_test(any_damage_is_refused_and_nothing_is_lost),
      cmocka_unit_test(what_is_of_another_model_or_definition_is_refused),
      cmocka_unit_test(a_model_is_known_by_each_of_its_numbers),
      cmocka_unit_test(a_change_that_was_not_told_is_refused),
      cmocka_unit_test(a_clock_of_another_policy_is_refused),
      cmocka_unit_test(a_clock_may_outlive_its_integrator),
      cmocka_unit_test(want_of_memory_loses_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
