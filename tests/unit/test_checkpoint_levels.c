/* States of hierarchies that are taken away: frames handed down, preconditioners by levels. */
#include <corot/checkpoint.h>

#include "hierarchical.h"

typedef struct run {
  solid s;
  corot_integrator *integrator;
  corot_frame_clock *clock;
} run;

static run begin(const choice *c, corot_coupling coupling, const char *preconditioner,
                 corot_frames frames) {
  run r = {.s = make_solid(c, coupling, &soft, true)};
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-5;
  def.linear.refinement = r.s.refinement;
  if (preconditioner) def.linear.solver = "pcg", def.linear.preconditioner = preconditioner;
  double *u = calloc(2 * r.s.n, sizeof *u);
  uint64_t seed = 3;
  for (int i = 0; i < r.s.n; i++) u[r.s.n + i] = 0.1 * noise(&seed);
  assert_ok(corot_integrator_create(&def, r.s.model, r.s.state, 0, u, u + r.s.n, &r.integrator));
  corot_frame_policy policy = corot_frame_policy_defaults();
  policy.frames = frames, policy.max_angle = 1e-3;
  assert_ok(corot_frame_clock_create(&policy, r.s.model, r.s.state, r.integrator, 0, u, u + r.s.n,
                                     &r.clock));
  free(u);
  return r;
}

static void end(run *r) {
  corot_frame_clock_destroy(r->clock);
  corot_integrator_destroy(r->integrator);
  corot_state_destroy(r->s.state);
  corot_model_destroy(r->s.model);
  corot_refinement_destroy(r->s.refinement);
  corot_mesh_destroy(r->s.mesh);
  corot_mesh_destroy(r->s.coarse);
}

/* Fifteen steps; u, v and t [2 n + 1] there. */
static void go(const run *r, double *out) {
  corot_step step;
  corot_frame_event event;
  int n = r->s.n;
  for (int k = 0; k < 15; k++) {
    assert_ok(corot_integrator_step(r->integrator, 1, &step));
    assert_ok(corot_frame_clock_tick(r->clock, step.t, &event));
  }
  assert_ok(corot_integrator_at(r->integrator, step.t, out, out + n));
  out[2 * n] = step.t;
}

static void check(const choice *c, corot_coupling coupling, const char *preconditioner,
                  corot_frames frames) {
  run first = begin(c, coupling, preconditioner, frames);
  run other = begin(c, coupling, preconditioner, frames);
  size_t size = 2 * (size_t)first.s.n + 1, bytes;
  double *went_on = calloc(3 * size, sizeof *went_on);
  double *elsewhere = went_on + size, *again = elsewhere + size;
  void *blob;
  go(&first, went_on);
  assert_ok(corot_integrator_save(first.integrator, &blob, &bytes));
  go(&first, went_on);
  assert_ok(corot_integrator_restore(other.integrator, blob, bytes));
  go(&other, elsewhere);
  assert_ok(corot_integrator_restore(first.integrator, blob, bytes));
  go(&first, again);
  assert_memory_equal(went_on, elsewhere, size * sizeof *went_on);
  assert_memory_equal(went_on, again, size * sizeof *went_on);
  corot_blob_free(blob);
  free(went_on);
  end(&first);
  end(&other);
}

static const choice choices[] = {{"green", "polar", 1, 0, false, false},
                                 {"polar", "polar", 2, 1, true, false},
                                 {"green", "polar", 1, 0, false, true}};

static void frames_that_are_handed_down_come_with_it(void **state) {
  static const corot_frames kinds[] = {COROT_FRAMES_EXACT, COROT_FRAMES_HELD,
                                       COROT_FRAMES_EXTRAPOLATED};
  for (size_t c = 0; c < sizeof choices / sizeof *choices; c++)
    for (int f = 0; f < 3; f++)
      if (f == 0 || !choices[c].conservative)
        check(&choices[c], coupling_of(state), NULL, kinds[f]);
}

static void preconditioners_by_levels_begin_anew(void **state) {
  (void)state;
  check(&choices[0], COROT_COUPLING_MEAN, "hierarchical", COROT_FRAMES_EXACT);
  check(&choices[0], COROT_COUPLING_MEAN, "multigrid", COROT_FRAMES_HELD);
  check(&choices[0], COROT_COUPLING_MEAN, "amg", COROT_FRAMES_HELD);
}

/* Measures, couplings, the level of the frames, and whether these are conservative. */
static void a_hierarchy_is_known_by_each_of_its_choices(void **state) {
  (void)state;
  static const choice some = {"green", "polar", 2, 0, false, false};
  static const struct {
    choice c;
    corot_coupling coupling;
  } others[] = {{{"green", "polar", 2, 0, true, false}, COROT_COUPLING_MEAN},
                {{"green", "polar", 2, 1, false, false}, COROT_COUPLING_MEAN},
                {{"hybrid", "polar", 2, 0, false, false}, COROT_COUPLING_MEAN},
                {{"green", "polar", 2, 0, false, false}, COROT_COUPLING_NODES},
                {{"green", "polar", 2, 0, false, false}, COROT_COUPLING_ONE_WAY}};
  run r = begin(&some, COROT_COUPLING_MEAN, NULL, COROT_FRAMES_EXACT);
  void *blob;
  size_t bytes;
  assert_ok(corot_integrator_save(r.integrator, &blob, &bytes));
  for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
    run other = begin(&others[k].c, others[k].coupling, NULL, COROT_FRAMES_EXACT);
    assert_fails(corot_integrator_restore(other.integrator, blob, bytes), COROT_EINVAL,
                 "another model");
    end(&other);
  }
  corot_blob_free(blob);
  end(&r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      each_coupling_unit_test(frames_that_are_handed_down_come_with_it),
      cmocka_unit_test(preconditioners_by_levels_begin_anew),
      cmocka_unit_test(a_hierarchy_is_known_by_each_of_its_choices),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
