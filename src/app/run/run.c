/* The loop of a run: next event, advance, handle; then the books are closed. */
#include "run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/field_frames.h"
#include "app/scenario/scenario_threads.h"
#include "app/text/say.h"
#include "quantities.h"
#include "run_clock.h"
#include "run_common.h"
#include "run_inside.h"
#include "static.h"
#include "stop.h"

/* Before the first step: nothing is written yet. */

static corot_status make_schedule(run *r) {
  const scenario *s = r->scenario;
  int n = live_times(r->live, s->t_end, 0, NULL);
  double *change = malloc(((size_t)n + 1) * sizeof *change);
  if (!change) return corot_fail(COROT_ENOMEM, "the times of the inputs: out of memory");
  live_times(r->live, s->t_end, n, change);
  corot_status status =
      schedule_create(r->model, s->t_end, s->output_step, n, change, &r->schedule);
  free(change);
  return status;
}

/* Where a run begins; what goes on has it in its checkpoint. */
static corot_status find_start(run *r) {
  const scenario *s = r->scenario;
  if (r->resume.found == RESUME_CHECKPOINT) return COROT_OK;
  if (s->start_at_equilibrium) COROT_TRY(static_start(s, r->refinement, r->model, r->u));
  scenario_start(s, r->model, r->u, r->v);
  return COROT_OK;
}

static corot_status start_integrator(run *r) {
  const scenario *s = r->scenario;
  size_t n = (size_t)corot_model_ndof(r->model);
  r->u = calloc(n + 1, sizeof *r->u);
  r->v = calloc(n + 1, sizeof *r->v);
  if (!r->u || !r->v) return corot_fail(COROT_ENOMEM, "%zu degrees of freedom: out of memory", n);

  COROT_TRY(corot_state_create(r->model, &r->state));
  COROT_TRY(scenario_share(s, r->model, r->state));
  COROT_TRY(find_start(r));
  corot_state_enter(r->state, 0);
  COROT_TRY(live_create(s, r->model, 0, &r->live));
  COROT_TRY(corot_state_use_inputs(r->state, live_inputs(r->live)));
  COROT_TRY(make_schedule(r));
  corot_integrator_def def = s->integrator;
  def.linear.refinement = r->refinement;
  COROT_TRY(corot_integrator_create(&def, r->model, r->state, 0, r->u, r->v, &r->integrator));
  return corot_frame_clock_create(&s->frames, r->model, r->state, r->integrator, 0, r->u, r->v,
                                  &r->clock);
}

static corot_status build(run *r) {
  COROT_TRY(scenario_build_warned(r->scenario, &r->mesh, &r->refinement, &r->model, &r->warnings));
  COROT_TRY(quantities_check(r->scenario, r->model, false));
  return run_warn_before(r->scenario, r->model, false, r->options, &r->warnings);
}

/* Takes the folder if there is a checkpoint, before anything that takes long and is in it. */
static corot_status look_for_checkpoint(run *r) {
  const scenario *s = r->scenario;
  const run_options *o = r->options;
  if (s->checkpoint_steps == 0 && !o->resume) return COROT_OK;
  COROT_TRY(hashes_of(s->resolved, r->mesh, &r->hashes));
  COROT_TRY(checkpoint_create(s, r->hashes.answer, o, &r->checkpoint));
  if (!o->resume) return COROT_OK;
  COROT_TRY(resume_find(s, r->hashes.run, o, &r->resume));
  if (r->resume.found == RESUME_FINISHED) return COROT_OK;
  if (resume_is_over(o->dir)) COROT_TRY(run_prepare_stop(s, o));
  if (r->resume.found == RESUME_NOTHING) return COROT_OK;
  COROT_TRY(run_enter(s->path, o, &r->lock));
  return resume_read(s, r->hashes.answer, o, &r->resume);
}

static corot_status prepare(run *r) {
  COROT_TRY(run_preparing(build(r)));
  COROT_TRY(look_for_checkpoint(r));
  if (r->resume.found == RESUME_FINISHED) return COROT_OK;
  COROT_TRY(run_preparing(start_integrator(r)));
  r->setup_s = wall_clock() - r->wall_at_start;
  return COROT_OK;
}

static void release(run *r) {
  space_clear(&r->seen.space);
  outputs_destroy(r->outputs);
  checkpoint_destroy(r->checkpoint);
  checkpoint_file_free(&r->resume.file);
  corot_frame_clock_destroy(r->clock);
  corot_integrator_destroy(r->integrator);
  schedule_destroy(r->schedule);
  corot_state_destroy(r->state);
  live_destroy(r->live);
  corot_model_destroy(r->model);
  corot_refinement_destroy(r->refinement);
  corot_mesh_destroy(r->mesh);
  warnings_free(&r->warnings);
  free(r->u);
  free(r->v);
}

/* Checkpoints. */

static corot_status make_checkpoint(run *r) {
  double started = wall_clock();
  corot_status status = run_pack(r, checkpoint_begin(r->checkpoint, r->t));
  if (status == COROT_OK) status = checkpoint_keep(r->checkpoint, r->outputs);
  r->output_s += wall_clock() - started;
  if (status == COROT_OK) return COROT_OK;
  return corot_fail(status, "checkpoint at t = %g s: %s", r->t, corot_error());
}

static corot_status go_on(run *r) {
  corot_status status = run_unpack(r, &r->resume.file.state);
  if (status != COROT_OK)
    return corot_fail(status == COROT_EINVAL ? COROT_EFORMAT : status, "%s/%s: %s", r->options->dir,
                      CHECKPOINT_NAME, corot_error());
  r->nresume++;
  checkpoint_goes_on(r->checkpoint, r->t);
  checkpoint_file_free(&r->resume.file);
  stop_reached(r->t);
  return COROT_OK;
}

/* Step by step. */

/* u and v at t by a step that ends there, from where the last one began: between the ends of a
   sound step the interpolant may pass a state that cannot be evaluated. */
static corot_status step_to(run *r, double t) {
  corot_integrator_def def = r->scenario->integrator;
  def.linear.refinement = r->refinement;
  def.first_step = t - r->before;
  if (def.step > 0) def.step = t - r->before;
  corot_integrator *other;
  COROT_TRY(corot_integrator_at(r->integrator, r->before, r->u, r->v));
  COROT_TRY(corot_integrator_create(&def, r->model, r->state, r->before, r->u, r->v, &other));
  corot_step step = {.t = r->before};
  corot_status status = COROT_OK;
  while (status == COROT_OK && step.t < t) status = corot_integrator_step(other, t, &step);
  if (status == COROT_OK) status = corot_integrator_at(other, t, r->u, r->v);
  corot_integrator_destroy(other);
  return status;
}

/* Writes the moment t, which is 0 or, but for rounding, within the last step. */
static corot_status write_moment(run *r, double t, bool last) {
  instant now = {.t = t, .u = r->u, .v = r->v, .frame_energy = r->frames.energy};
  double within = fmin(t, r->t);
  if (t > 0) {
    COROT_TRY(corot_integrator_at(r->integrator, within, r->u, r->v));
    COROT_TRY(corot_integrator_work(r->integrator, within, &now.dissipated, &now.external_work));
  }
  corot_status status = outputs_write(r->outputs, r->state, &now, last);
  if (status > 0 && within > r->before && within < r->t && step_to(r, within) == COROT_OK)
    status = outputs_write(r->outputs, r->state, &now, last);
  if (status > 0) return corot_fail(status, "output at t = %g s: %s", t, corot_error());
  if (status == COROT_OK) r->shown = t;
  return status;
}

/* Adds the end of the step to the history, with the frames as they were during it; a step that
   passes the end of the run, there. A state that cannot be evaluated there is left out: output
   times may tell more. */
static corot_status record_step(run *r) {
  double started = wall_clock(), t = fmin(r->t, r->scenario->t_end);
  instant now = {.t = t, .u = r->u, .v = r->v, .frame_energy = r->frames.energy};
  corot_energies e;
  COROT_TRY(corot_integrator_at(r->integrator, t, r->u, r->v));
  COROT_TRY(corot_integrator_work(r->integrator, t, &now.dissipated, &now.external_work));
  corot_status status = t == r->t ? corot_integrator_energy(r->integrator, r->u, r->v, &e)
                                  : corot_energy(r->model, r->state, t, r->u, r->v, &e);
  if (status == COROT_OK) status = outputs_history(r->outputs, r->state, &now, &e);
  r->output_s += wall_clock() - started;
  return status > 0 ? COROT_OK : status;
}

/* Writes the output times up to t, with the frames as they were during the step. A request to stop
   leaves those that remain: the answer ends at the last that was written, but not before the first.
 */
static corot_status write_outputs(run *r, double t) {
  double started = wall_clock(), due;
  corot_status status = COROT_OK;
  bool cut = false;
  while (status == COROT_OK && !cut && schedule_take_output(r->schedule, t, &due)) {
    cut = stop_signal() && r->shown >= 0;
    if (!cut) status = write_moment(r, due, due == r->scenario->t_end);
  }
  if (cut) r->t = r->shown;
  r->output_s += wall_clock() - started;
  return status;
}

static corot_status write_step(run *r, const step_row *row) {
  double started = wall_clock();
  corot_status status = outputs_step(r->outputs, row);
  r->output_s += wall_clock() - started;
  return status;
}

static bool is_constant_step(const run *r) { return r->scenario->integrator.step > 0; }

/* A constant step may cross a kink: in that one each motion follows its law at every time. */
static void prepare_step(run *r) {
  double h = r->scenario->integrator.step;
  if (is_constant_step(r) && schedule_kink_before(r->schedule, r->t + h))
    corot_state_enter(r->state, NAN);
}

/* The integrator has stopped at a kink, or where inputs change, and is told. At constant step it
   keeps its factor, in which no velocity stands. */
static corot_status pass_kinks(run *r, step_row *row) {
  long before = corot_integrator_statistics(r->integrator).nrestart;
  bool changed = false;
  for (double kink; schedule_take_kink(r->schedule, row->t, &kink);) {
    bool here;
    row->events |= EVENT_KINK;
    corot_state_enter(r->state, fmax(kink, row->t));
    COROT_TRY(live_enter(r->live, kink, &here));
    changed |= here;
  }
  if (changed)
    COROT_TRY(corot_integrator_changed(r->integrator, COROT_HISTORY_AUTO));
  else if (row->events & EVENT_KINK)
    COROT_TRY(corot_integrator_kink(r->integrator));
  if (corot_integrator_statistics(r->integrator).nrestart > before) row->events |= EVENT_RESTART;
  return COROT_OK;
}

static void add_update(frame_totals *total, const corot_frame_event *event) {
  total->count++;
  total->by[event->reason]++;
  total->angle_max = fmax(total->angle_max, event->change.angle_max);
  total->angle_mean += (event->change.angle_mean - total->angle_mean) / (double)total->count;
  total->energy += event->change.energy;
}

static corot_status update_frames(run *r, step_row *row) {
  corot_frame_event event;
  double started = wall_clock(), force_s = corot_integrator_statistics(r->integrator).force_s;
  corot_status status = corot_frame_clock_tick(r->clock, row->t, &event);
  r->frames_s += wall_clock() - started;
  r->frames_s -= corot_integrator_statistics(r->integrator).force_s - force_s;
  COROT_TRY(status);
  if (event.restarted) row->events |= EVENT_RESTART;
  if (!event.reason) return COROT_OK;
  row->events |= EVENT_FRAMES;
  row->update = event;
  add_update(&r->frames, &event);
  return COROT_OK;
}

/* At the end an update would have no effect. */
static corot_status handle_events(run *r, step_row *row) {
  corot_status status = pass_kinks(r, row);
  if (status == COROT_OK && !schedule_over(r->schedule, row->t)) status = update_frames(r, row);
  if (status == COROT_OK) return COROT_OK;
  row->events |= EVENT_FAILED;
  return corot_fail(status, "update of the frames at t = %g s: %s", row->t, corot_error());
}

/* By steps alone, so that it is the same in every process; the last step needs none. A request to
   stop may have left outputs of the step out. */
static bool is_checkpoint_due(const run *r, const step_row *row) {
  return checkpoint_is_due(r->checkpoint, r->nstep) && !schedule_over(r->schedule, row->t) &&
         r->t == row->t;
}

static corot_status integrate(run *r) {
  COROT_TRY(write_outputs(r, 0));
  while (!schedule_over(r->schedule, r->t) && !stop_signal()) {
    corot_step step;
    double stop = schedule_stop(r->schedule, corot_frame_clock_stop(r->clock));
    /* on to the next event, or less */
    prepare_step(r);
    COROT_TRY(corot_integrator_step(r->integrator, stop, &step));
    r->before = r->t;
    r->t = step.t;
    r->nstep++;
    COROT_TRY(record_step(r));
    COROT_TRY(write_outputs(r, step.t));
    stop_reached(r->t);

    /* whatever is due here; the step is written in any case */
    step_row row = {
        .t = step.t, .h = step.h, .order = step.order, .error = step.error, .newton = step.newton};
    corot_status handled = handle_events(r, &row);
    bool due = handled == COROT_OK && is_checkpoint_due(r, &row);
    if (due) row.events |= EVENT_CHECKPOINT;
    COROT_TRY(write_step(r, &row));
    COROT_TRY(handled);
    if (due) COROT_TRY(make_checkpoint(r));
    progress_show(&r->progress, &step);
  }
  return COROT_OK;
}

/* After the last step. */

/* How far the answer goes. */
static double reached(const run *r) { return fmin(r->t, r->scenario->t_end); }

/* A run with checkpoints needed them at the start. */
static bool has_hashes(const run *r) { return r->hashes.run[0] != 0; }

/* All that result.json says of the run itself. */
static corot_status summarize(const run *r, const char *reason, int code, run_summary *summary) {
  bool interrupted = code > EXIT_SIGNAL;
  *summary = (run_summary){
      .status = code <= EXIT_CHECK ? "ok"
                : interrupted      ? "interrupted"
                                   : "failed",
      .reason = code <= EXIT_CHECK ? NULL : reason,
      .exit_code = code,
      .failure = r->failure,
      .t_reached = reached(r),
      .model = r->model,
      .state_bytes = corot_state_bytes(r->state),
      .threads = corot_state_thread_count(r->state),
      .statistics = corot_integrator_statistics(r->integrator),
      .chosen = corot_integrator_chosen(r->integrator),
      .frames = r->frames,
      .setup_s = r->setup_s,
      .frames_s = r->frames_s,
      .output_s = r->output_s,
      .wall_s = wall_clock() - r->wall_at_start,
      .cpu_s = cpu_clock() - r->cpu_at_start,
      .warnings = &r->warnings,
      .seen = &r->seen,
      .nresume = r->checkpoint ? r->nresume : -1,
  };
  summary->hashes = r->hashes;
  return has_hashes(r) ? COROT_OK : hashes_of(r->scenario->resolved, r->mesh, &summary->hashes);
}

/* That not every output time has a frame, where nobody has asked for so few. */
static void tell_fields(const run *r) {
  const field_frames frames = field_frames_of(r->scenario, r->mesh);
  char text[160];
  field_frames_words(&frames, sizeof text, text);
  if (frames.thinned) say("fields %s\n", text);
}

static void tell(const run *r, const run_summary *summary) {
  const char *path = r->scenario->path, *dir = r->options->dir;
  if (summary->reason)
    say("%s: stopped at t = %.6g s of %g s: %s\n", path, summary->t_reached, r->scenario->t_end,
        summary->reason);
  double kept = checkpoint_written(r->checkpoint);
  if (summary->reason && kept == kept && !r->options->quiet)
    say("%s: corot run --resume goes on from t = %.6g s\n", path, kept);
  if (r->options->quiet) return;
  char space[64];
  space_words(&r->seen.space, sizeof space, space);
  say("%s: %.6g s in %ld steps, %ld factorisations, %.3g s (%.3g x real time)%s; %s\n", path,
      summary->t_reached, summary->statistics.nst, summary->statistics.nfactor, summary->wall_s,
      summary->t_reached / summary->wall_s, space, dir);
  tell_fields(r);
  outputs_tell(r->outputs);
}

static corot_status warn(run *r, int code) {
  corot_statistics n = corot_integrator_statistics(r->integrator);
  run_end end = run_end_of(r->scenario, r->model, r->state, r->outputs, r->options);
  end.code = code;
  end.work = (run_work){n.nfe + n.nfeQ, n.nje, n.nfactor, n.nsolve, n.nli};
  return run_warn_after(&end, &r->warnings, &r->seen);
}

/* Closes the books after a run that ended with `status`; returns the exit code. */
static int conclude(run *r, corot_status status) {
  char reason[1024] = "";
  int code = run_exit_code(status);
  if (code != 0) {
    snprintf(reason, sizeof reason, "%s", corot_error());
  } else if (stop_signal() && !schedule_over(r->schedule, r->t)) {
    code = run_interrupted(sizeof reason, reason);
  }
  if (code > EXIT_SIGNAL) stop_heeded();
  progress_clear(&r->progress);
  if (run_failure_of(status, code).retry) checkpoint_write(r->checkpoint, r->outputs);

  /* What could be written before can be written now. */
  corot_status late = COROT_OK;
  if (r->shown < reached(r) && code != EXIT_SYSTEM) late = write_moment(r, reached(r), true);
  corot_status closed = outputs_close(r->outputs);
  if (late == COROT_OK) late = closed;
  if (run_late_code(code, late) != code) {
    code = run_late_code(code, late);
    status = late;
    run_add_reason(sizeof reason, reason);
  }

  /* warnings and result.json */
  code = run_answered_code(code, r->outputs);
  run_summary summary;
  r->failure = run_failure_of(status, code);
  late = warn(r, code);
  corot_status summed = summarize(r, reason, code, &summary);
  if (late == COROT_OK) late = summed;
  if (late == COROT_OK) late = run_write_result(r->scenario, r->outputs, &summary, r->options);
  if (late != COROT_OK) say_error();
  if (late == COROT_OK && !r->failure.retry) checkpoint_remove(r->checkpoint);
  stop_forget();
  stop_release();
  tell(r, &summary);
  return run_late_code(code, late);
}

static corot_status open_outputs(run *r) {
  if (r->resume.found == RESUME_CHECKPOINT) return go_on(r);
  if (!r->lock.path) COROT_TRY(run_enter(r->scenario->path, r->options, &r->lock));
  COROT_TRY(outputs_open(r->scenario, r->model, r->options->dir, &r->outputs));
  return outputs_open_run(r->outputs, r->options->dir);
}

static int integrate_scenario(const scenario *s, const run_options *options) {
  run r = {.scenario = s, .options = options, .shown = -1};
  r.wall_at_start = wall_clock();
  r.cpu_at_start = cpu_clock();

  int code;
  corot_status status = run_begin(s, options);
  if (status == COROT_OK) status = prepare(&r);
  bool finished = status == COROT_OK && r.resume.found == RESUME_FINISHED;
  if (status == COROT_OK && !finished) status = open_outputs(&r);
  if (status != COROT_OK) {
    code = run_end_early(s, options, &r.lock, &r.warnings, status);
  } else if (finished) {
    code = r.resume.exit_code;
    stop_forget();
    stop_release();
  } else {
    r.progress = progress_start(options->progress && !options->quiet, s->t_end);
    r.progress.from = r.t;
    code = conclude(&r, integrate(&r));
  }
  folder_leave(&r.lock); /* its files are closed, even if a library crashes below */
  release(&r);
  return code;
}

void run_interrupt(int signal_number) { stop_request(signal_number); }

int run_scenario(const scenario *s, const run_options *options) {
  return run_in_c_locale(integrate_scenario, s, options);
}
