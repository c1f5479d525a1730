/* Load step by load step to the full loads; then the books are closed. */
#include "static.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/scenario_threads.h"
#include "app/text/json_text.h"
#include "app/text/say.h"
#include "live.h"
#include "quantities.h"
#include "run_clock.h"
#include "run_common.h"
#include "stop.h"

typedef struct equilibrium_run {
  const scenario *scenario;
  const run_options *options;
  corot_mesh *mesh;
  corot_refinement *refinement; /* or NULL */
  corot_model *model;
  corot_state *state; /* for outputs; it stands still */
  live *live;         /* as they are at the end */
  corot_statics *statics;
  outputs *outputs;
  double *u, *v;                         /* [n] v is zero */
  double (*nodal)[3];                    /* [5 nnode] room for the following */
  double (*x)[3], (*f)[3];               /* [nnode] displacement and internal force now */
  double (*x_before)[3], (*f_before)[3]; /* at the last equilibrium */
  double (*velocity)[3];                 /* [nnode] not looked at */
  double factor, work;                   /* reached; by loads and supports [J] */
  json_t *steps;
  json_t *reactions_at_end;
  run_failure failure;
  folder_lock lock;
  warnings warnings;
  observed seen;                                         /* in the end */
  double wall_at_start, cpu_at_start, setup_s, output_s; /* [s] */
} equilibrium_run;

/* --- Before the first step --- */

static corot_status allocate(equilibrium_run *r) {
  size_t n = (size_t)corot_model_ndof(r->model), nnode = (size_t)r->mesh->nnode;
  r->u = calloc(2 * n, sizeof *r->u);
  r->nodal = calloc(5 * nnode, sizeof *r->nodal);
  r->steps = json_array();
  if (!r->u || !r->nodal || !r->steps)
    return corot_fail(COROT_ENOMEM, "%zu degrees of freedom: out of memory", n);
  r->v = r->u + n;
  r->x = r->nodal, r->f = r->nodal + nnode;
  r->x_before = r->nodal + 2 * nnode, r->f_before = r->nodal + 3 * nnode;
  r->velocity = r->nodal + 4 * nnode;
  COROT_TRY(corot_state_create(r->model, &r->state));
  COROT_TRY(live_create(r->scenario, r->model, r->scenario->t_end, &r->live));
  return corot_state_use_inputs(r->state, live_inputs(r->live));
}

static bool is_stopped(void *data) {
  (void)data;
  return stop_signal() != 0;
}

static corot_status prepare(equilibrium_run *r) {
  const scenario *s = r->scenario;
  corot_statics_def def = s->statics;
  def.stop = is_stopped;
  COROT_TRY(scenario_build_warned(s, &r->mesh, &r->refinement, &r->model, &r->warnings));
  COROT_TRY(quantities_check(s, r->model, true));
  COROT_TRY(run_warn_before(s, r->model, true, r->options, &r->warnings));
  def.linear.refinement = r->refinement;
  COROT_TRY(allocate(r));
  def.inputs = live_inputs(r->live);
  def.threads = scenario_threads(s, r->model);
  corot_status status = corot_statics_create(&def, r->model, s->t_end, NULL, &r->statics);
  if (status) return corot_fail(status, "%s: %s", s->path, corot_error());
  corot_statics_counts n = corot_statics_statistics(r->statics); /* of K at rest */
  r->setup_s = wall_clock() - r->wall_at_start - n.assembly_s - n.combine_s - n.factor_s;
  return COROT_OK;
}

static corot_status open_outputs(equilibrium_run *r) {
  const scenario *s = r->scenario;
  COROT_TRY(run_enter(s->path, r->options, &r->lock));
  COROT_TRY(outputs_open(s, r->model, r->options->dir, &r->outputs));
  return outputs_open_statics(r->outputs, r->options->dir);
}

static void release(equilibrium_run *r) {
  space_clear(&r->seen.space);
  outputs_destroy(r->outputs);
  corot_statics_destroy(r->statics);
  corot_state_destroy(r->state);
  live_destroy(r->live);
  corot_model_destroy(r->model);
  corot_refinement_destroy(r->refinement);
  corot_mesh_destroy(r->mesh);
  json_decref(r->steps);
  json_decref(r->reactions_at_end);
  warnings_free(&r->warnings);
  free(r->u);
  free(r->nodal);
}

/* --- Step by step --- */

/* Internal forces act on free nodes as the loads do, and on held ones as the supports do. */
static corot_status add_work(equilibrium_run *r, double t) {
  COROT_TRY(corot_elastic_force(r->model, r->state, t, r->u, r->f));
  corot_nodal(r->model, t, r->u, r->v, r->x, r->velocity);
  for (int n = 0; n < r->mesh->nnode; n++)
    for (int c = 0; c < 3; c++)
      r->work += 0.5 * (r->f[n][c] + r->f_before[n][c]) * (r->x[n][c] - r->x_before[n][c]);
  double(*x)[3] = r->x_before, (*f)[3] = r->f_before;
  r->x_before = r->x, r->f_before = r->f;
  r->x = x, r->f = f;
  return COROT_OK;
}

static corot_status write_equilibrium(equilibrium_run *r, bool last) {
  double started = wall_clock(), t = r->factor * r->scenario->t_end;
  corot_state_stand_still(r->state, r->scenario->t_end, r->factor);
  corot_status status = add_work(r, t);
  instant now = {.t = t, .u = r->u, .v = r->v, .external_work = r->work, .still = true};
  if (status == COROT_OK) status = outputs_write(r->outputs, r->state, &now, last);
  r->output_s += wall_clock() - started;
  return status;
}

static corot_status write_step(equilibrium_run *r, const corot_load_step *step) {
  double end = r->scenario->t_end, residual = step->residual[step->nresidual - 1];
  step_row row = {
      .t = step->factor * end,
      .h = step->length * end,
      .error = step->force > 0 ? residual / (r->scenario->statics.tolerance * step->force) : 0,
      .newton = step->iterations,
      .events = step->rejected ? EVENT_REJECTED : 0,
  };
  return outputs_step(r->outputs, &row);
}

static corot_status remember(equilibrium_run *r, const corot_load_step *step) {
  static const char *const stability[] = {"unknown", "stable", "unstable"};
  json_t *residual = json_array();
  for (int k = 0; k < step->nresidual; k++)
    residual = json_text_push(residual, json_real(step->residual[k]));
  json_t *entry = json_pack("{s:f, s:f, s:i, s:i, s:f, s:b, s:s, s:o}", "factor", step->factor,
                            "length", step->length, "iterations", step->iterations, "rejected",
                            step->rejected, "force", step->force, "rounding", step->rounding,
                            "stability", stability[step->stability], "residual", residual);
  if (json_array_append_new(r->steps, entry) == 0) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "load steps: out of memory");
}

/* Relative to the largest force: each Newton iteration squares it. */
static void tell_step(const equilibrium_run *r, const corot_load_step *step) {
  if (r->options->quiet) return;
  double unit = step->force > 0 ? step->force : 1;
  fprintf(stderr, "load factor %.6g: residual", step->factor);
  for (int k = 0; k < step->nresidual; k++) fprintf(stderr, " %.1e", step->residual[k] / unit);
  if (step->rounding) fputs(" (rounding)", stderr);
  if (step->rejected) fprintf(stderr, "; %d longer steps refused", step->rejected);
  if (step->stability == COROT_STABILITY_UNKNOWN) fputs("; stability not known", stderr);
  fputc('\n', stderr);
}

static corot_status find_equilibrium(equilibrium_run *r) {
  COROT_TRY(write_equilibrium(r, false));
  while (r->factor < 1 && !stop_signal()) {
    corot_load_step step;
    COROT_TRY(corot_statics_step(r->statics, &step));
    r->factor = corot_statics_at(r->statics, r->u);
    stop_reached(r->factor * r->scenario->t_end);
    tell_step(r, &step);
    COROT_TRY(remember(r, &step));
    COROT_TRY(write_equilibrium(r, r->factor == 1));
    COROT_TRY(write_step(r, &step));
  }
  return COROT_OK;
}

/* --- After the last --- */

/* All that result.json says of the search itself; `summary` refers to `statics`. */
static corot_status summarize(const equilibrium_run *r, const char *reason, int code,
                              statics_summary *statics, run_summary *summary) {
  corot_statics_counts n = corot_statics_statistics(r->statics);
  /* what a run does not have */
  *statics = (statics_summary){
      .counts = n,
      .linear_solver = corot_statics_solver(r->statics),
      .factor = r->factor,
      .steps = r->steps,
      .reactions = r->reactions_at_end,
  };
  corot_statics_critical(r->statics, &statics->stable, &statics->unstable);

  /* and what it has */
  *summary = (run_summary){
      .status = code <= EXIT_CHECK   ? "ok"
                : code > EXIT_SIGNAL ? "interrupted"
                                     : "failed",
      .reason = code <= EXIT_CHECK ? NULL : reason,
      .exit_code = code,
      .failure = r->failure,
      .t_reached = r->factor * r->scenario->t_end,
      .model = r->model,
      .state_bytes = corot_state_bytes(r->state) + corot_statics_bytes(r->statics),
      .threads = scenario_threads(r->scenario, r->model),
      .statics = statics,
      .statistics = {.force_s = n.force_s,
                     .assembly_s = n.assembly_s,
                     .combine_s = n.combine_s,
                     .factor_s = n.factor_s,
                     .solve_s = n.solve_s},
      .setup_s = r->setup_s,
      .output_s = r->output_s,
      .wall_s = wall_clock() - r->wall_at_start,
      .cpu_s = cpu_clock() - r->cpu_at_start,
      .warnings = &r->warnings,
      .seen = &r->seen,
  };
  if (!statics->reactions) return corot_fail(COROT_ENOMEM, "reactions: out of memory");
  COROT_TRY(hashes_of(r->scenario->resolved, r->mesh, &summary->hashes));
  hashes_static(&summary->hashes);
  return COROT_OK;
}

static void tell(const equilibrium_run *r, const char *reason, const run_summary *summary) {
  const corot_statics_counts *n = &summary->statics->counts;
  const char *path = r->scenario->path;
  if (*reason) say("%s: stopped at load factor %.6g: %s\n", path, r->factor, reason);
  if (r->options->quiet) return;
  char space[64];
  space_words(&r->seen.space, sizeof space, space);
  say("%s: load factor %.6g in %ld load step%s, %ld Newton iterations, %ld factorisations, "
      "%.3g s%s; %s\n",
      path, r->factor, n->nstep, n->nstep == 1 ? "" : "s", n->nni, n->nfactor, summary->wall_s,
      space, r->options->dir);
  outputs_tell(r->outputs);
}

static corot_status warn(equilibrium_run *r, int code) {
  corot_statics_counts n = corot_statics_statistics(r->statics);
  run_end end = run_end_of(r->scenario, r->model, r->state, r->outputs, r->options);
  end.statics = true;
  end.code = code;
  end.work = (run_work){n.nfe, n.nje, n.nfactor, n.nsolve, n.nli};
  return run_warn_after(&end, &r->warnings, &r->seen);
}

/* Closes the books; returns the exit code. */
static int conclude(equilibrium_run *r, corot_status status) {
  char reason[1024] = "";
  int code = run_exit_code(status);
  /* why it ended */
  if (stop_signal() && r->factor < 1)
    code = run_interrupted(sizeof reason, reason);
  else if (code != 0)
    snprintf(reason, sizeof reason, "%s", corot_error());
  if (code > EXIT_SIGNAL) stop_heeded();

  /* the files; if nothing else went wrong, what goes wrong here is the reason */
  r->reactions_at_end = outputs_reactions(r->outputs);
  corot_status late = outputs_close(r->outputs);
  if (run_late_code(code, late) != code) {
    code = run_late_code(code, late);
    status = late;
    run_add_reason(sizeof reason, reason);
  }

  /* warnings and result.json */
  code = run_answered_code(code, r->outputs);
  run_summary summary;
  statics_summary statics;
  r->failure = run_failure_of(status, code);
  late = warn(r, code);
  corot_status summed = summarize(r, reason, code, &statics, &summary);
  if (late == COROT_OK) late = summed;
  if (late == COROT_OK) late = run_write_result(r->scenario, r->outputs, &summary, r->options);
  if (late != COROT_OK) say_error();
  stop_forget();
  stop_release();
  tell(r, reason, &summary);
  return run_late_code(code, late);
}

static int search(const scenario *s, const run_options *options) {
  equilibrium_run r = {.scenario = s, .options = options};
  r.wall_at_start = wall_clock();
  r.cpu_at_start = cpu_clock();

  run_without_checkpoints(s, options, "corot static");
  corot_status status = run_begin(s, options);
  if (status == COROT_OK) status = run_preparing(prepare(&r));
  if (status == COROT_OK) status = open_outputs(&r);
  int code = status == COROT_OK ? conclude(&r, find_equilibrium(&r))
                                : run_end_early(s, options, &r.lock, &r.warnings, status);
  folder_leave(&r.lock); /* its files are closed, even if a library crashes below */
  release(&r);
  return code;
}

int static_scenario(const scenario *s, const run_options *options) {
  return run_in_c_locale(search, s, options);
}

/* *lost: there is no stable one, and where the path loses its stability is known. */
static corot_status solve_at(const scenario *s, const corot_refinement *refinement,
                             const corot_model *model, double t, bool follow, double *u,
                             bool *lost) {
  corot_statics *statics = NULL;
  corot_statics_def def = s->statics;
  double stable = NAN, unstable = NAN;
  def.stop = is_stopped;
  def.linear.refinement = refinement;
  def.follow_unstable = follow;
  live *l = NULL;
  corot_status status = live_create(s, model, t, &l);
  if (status == COROT_OK) {
    def.inputs = live_inputs(l);
    def.threads = scenario_threads(s, model);
    status = corot_statics_create(&def, model, t, NULL, &statics);
  }
  if (status == COROT_OK) {
    status = corot_statics_solve(statics);
    corot_statics_critical(statics, &stable, &unstable);
  }
  if (status == COROT_OK) corot_statics_at(statics, u);
  corot_statics_destroy(statics);
  live_destroy(l);
  *lost = !isnan(unstable);
  return status;
}

corot_status static_find(const scenario *s, const corot_refinement *refinement,
                         const corot_model *model, double t, double *u) {
  bool lost;
  corot_status status = solve_at(s, refinement, model, t, false, u, &lost);
  if (status == COROT_OK || !lost) return status;
  char reason[512];
  snprintf(reason, sizeof reason, "%s", corot_error());
  corot_status followed = solve_at(s, refinement, model, t, true, u, &lost);
  return followed == COROT_OK ? COROT_OK : corot_fail(status, "%s", reason);
}

corot_status static_start(const scenario *s, const corot_refinement *refinement,
                          const corot_model *model, double *u) {
  bool lost;
  corot_status status = solve_at(s, refinement, model, 0, false, u, &lost);
  if (status == COROT_OK) return COROT_OK;
  return corot_fail(status, "%s: start: equilibrium: %s", s->path, corot_error());
}
