/* corot-bench frames: what frames cost, as ratios of things run side by side. */
#include <corot/integrate.h>
#include <stdlib.h>

#include "app/run/run_clock.h"
#include "bench.h"
#include "report.h"

static const char help[] =
    "usage: corot-bench frames [--json]\n"
    "\n"
    "Three ratios of CPU times, each of things run in turn, five times over; the median counts.\n"
    "  polar/warp     40 s of the bar (see corot-bench run --help), frames exact, rtol 1e-4:\n"
    "                 what the polar decomposition costs over a whole run\n"
    "  update/force   frames of 18432 tets found anew, over one evaluation of their forces\n"
    "  newton/linear  40 s of the bar in steps of 20 ms by backward Euler: green strain by "
    "Newton's\n"
    "                 method, over polar frames held for 200 ms by one linear solve a step\n"
    "\n"
    "      --json   one JSON object a line\n"
    "\n"
    "example: corot-bench frames\n";

enum { NRUN = 5 };

/* A model and what it is integrated with. */
typedef struct job {
  corot_model *model;
  corot_state *state;
  double *zero; /* [n] */
  corot_integrator_def def;
  corot_frame_policy policy;
} job;

static corot_status job_create(const char *strain, int cells, job *out) {
  bar_source bar = bar_source_default(strain);
  bar.box.cells[0] = bar.box.cells[1] = cells;
  job j = {.def = corot_integrator_defaults(), .policy = corot_frame_policy_defaults()};
  COROT_TRY(bar_model(&bar, &j.model));
  corot_status status = corot_state_create(j.model, &j.state);
  j.zero = calloc(corot_model_ndof(j.model), sizeof *j.zero);
  if (!status && !j.zero) status = corot_fail(COROT_ENOMEM, "out of memory");
  *out = j;
  return status;
}

static void job_destroy(job *j) {
  free(j->zero);
  corot_state_destroy(j->state);
  corot_model_destroy(j->model);
}

/* 40 s of the bar, the load's kink at 10 s being a stop. */
static corot_status integrate(corot_integrator *integrator, corot_frame_clock *clock) {
  corot_step step = {0};
  corot_frame_event event;
  while (step.t < 40 * (1 - 1e-12)) {
    double stop = step.t < 10 ? 10 : 40, frames = corot_frame_clock_stop(clock);
    COROT_TRY(corot_integrator_step(integrator, frames < stop ? frames : stop, &step));
    COROT_TRY(corot_frame_clock_tick(clock, step.t, &event));
  }
  return COROT_OK;
}

static corot_status whole_run(void *data, double *seconds) {
  job *j = data;
  corot_integrator *integrator = NULL;
  corot_frame_clock *clock = NULL;
  double start = cpu_clock();
  corot_status status =
      corot_integrator_create(&j->def, j->model, j->state, 0, j->zero, j->zero, &integrator);
  if (!status)
    status = corot_frame_clock_create(&j->policy, j->model, j->state, integrator, 0, j->zero,
                                      j->zero, &clock);
  if (!status) status = integrate(integrator, clock);
  *seconds = cpu_clock() - start;
  corot_frame_clock_destroy(clock);
  corot_integrator_destroy(integrator);
  return status;
}

static corot_status update(void *data) {
  job *j = data;
  return corot_frames_update(j->model, j->state, 0, j->zero, NULL);
}

static corot_status force(void *data) {
  job *j = data;
  static double r[3 * 17 * 17 * 13];
  return corot_residual(j->model, j->state, 0, j->zero, j->zero, r);
}

typedef corot_status measure(void *data, double *seconds);

static corot_status one_update(void *data, double *seconds) {
  timing t;
  COROT_TRY(timing_of(update, data, &t));
  *seconds = t.median;
  return COROT_OK;
}

static corot_status one_force(void *data, double *seconds) {
  timing t;
  COROT_TRY(timing_of(force, data, &t));
  *seconds = t.median;
  return COROT_OK;
}

/* The median of the ratios a/b of pairs measured one after the other. */
static corot_status compare(bool json, const char *name, measure *of_a, job *a, measure *of_b,
                            job *b) {
  double ratio[NRUN], ta[NRUN], tb[NRUN];
  for (int k = 0; k < NRUN; k++) {
    COROT_TRY(of_a(a, &ta[k]));
    COROT_TRY(of_b(b, &tb[k]));
    ratio[k] = ta[k] / tb[k];
  }
  timing r = timing_summary(NRUN, ratio), x = timing_summary(NRUN, ta),
         y = timing_summary(NRUN, tb);
  if (json)
    report_object(json_pack("{s:s, s:f, s:f, s:f, s:f}", "bench", name, "ratio", r.median, "spread",
                            r.spread, "numerator_s", x.median, "denominator_s", y.median));
  else
    printf("%-14s %6.3f  (quartiles %.3f apart; %.3g s over %.3g s)\n", name, r.median, r.spread,
           x.median, y.median);
  return COROT_OK;
}

static corot_status measure_all(bool json) {
  enum { WARPED, POLAR, NEWTON, LINEAR, LARGE, NJOB };
  static const struct {
    const char *strain;
    int cells;
  } of[NJOB] = {{"warp", 2}, {"polar", 2}, {"green", 2}, {"polar", 2}, {"polar", 16}};
  job j[NJOB] = {{0}};
  corot_status status = COROT_OK;
  for (int k = 0; k < NJOB && !status; k++) status = job_create(of[k].strain, of[k].cells, &j[k]);
  j[NEWTON].def.method = j[LINEAR].def.method = "backward-euler";
  j[NEWTON].def.step = j[LINEAR].def.step = 0.02;
  j[LINEAR].def.solution = COROT_SOLUTION_LINEAR;
  j[LINEAR].policy.frames = COROT_FRAMES_HELD;
  j[LINEAR].policy.interval = 0.2;
  if (!status) status = compare(json, "polar/warp", whole_run, &j[POLAR], whole_run, &j[WARPED]);
  if (!status) status = compare(json, "update/force", one_update, &j[LARGE], one_force, &j[LARGE]);
  if (!status)
    status = compare(json, "newton/linear", whole_run, &j[NEWTON], whole_run, &j[LINEAR]);
  for (int k = 0; k < NJOB; k++) job_destroy(&j[k]);
  return status;
}

int command_frames(int argc, char **argv) {
  bool json;
  int code = only_json("corot-bench frames", help, argc, argv, &json);
  if (code >= 0) return code;
  corot_status status = measure_all(json);
  return status ? failure(status) : EXIT_OK;
}
