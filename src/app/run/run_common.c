/* Exit codes, early ends, warnings and the result, as runs and equilibria share them. */
#include "run_common.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/folder/folder.h"
#include "app/folder/folder_files.h"
#include "app/folder/folder_owner.h"
#include "app/text/say.h"
#include "result_brief.h"
#include "resume.h"
#include "stop.h"

int run_interrupted(size_t size, char *reason) {
  snprintf(reason, size, "interrupted by signal %d", stop_signal());
  return EXIT_SIGNAL + stop_signal();
}

int run_exit_code(corot_status status) {
  if (status == COROT_OK) return EXIT_OK;
  if (status == COROT_EINVAL || status == COROT_EFORMAT) return EXIT_SCENARIO;
  if (status == COROT_ENOMEM || status == COROT_EIO) return EXIT_SYSTEM;
  return EXIT_INTEGRATOR;
}

int run_late_code(int code, corot_status late) {
  int refused = run_exit_code(late);
  if (code == EXIT_OK || (code == EXIT_CHECK && refused)) return refused;
  return refused == EXIT_SYSTEM && code < EXIT_SIGNAL ? EXIT_SYSTEM : code;
}

void run_add_reason(size_t size, char *reason) {
  size_t length = strlen(reason);
  snprintf(reason + length, size - length, "%s%s", length > 0 ? "; " : "", corot_error());
}

run_failure run_failure_of(corot_status status, int code) {
  if (code <= EXIT_CHECK) return (run_failure){NULL, false};
  if (code > EXIT_SIGNAL) return (run_failure){"interrupted", true};
  if (status == COROT_ENOMEM) return (run_failure){"memory", true};
  if (status == COROT_EIO) return (run_failure){"io", true};
  if (code == EXIT_SCENARIO) return (run_failure){"scenario", false};
  return (run_failure){"integrator", false};
}

corot_status run_begin(const scenario *s, const run_options *options) {
  bool locked = false;
  if (!options->force) {
    COROT_TRY(folder_lock_stands(options->dir, &locked));
    COROT_TRY(folder_permit(options->dir, locked));
    if (!options->resume) COROT_TRY(folder_permit_anew(options->dir));
  }
  /* what a run has ended well with is not replaced before it is known to be another run's */
  return options->resume && resume_is_over(options->dir) ? COROT_OK : run_prepare_stop(s, options);
}

corot_status run_prepare_stop(const scenario *s, const run_options *options) {
  char *text = NULL;
  COROT_TRY(result_for_stop(s, &text));
  corot_status status = stop_prepare(options->dir, text);
  free(text);
  return status;
}

void run_without_checkpoints(const scenario *s, const run_options *options, const char *what) {
  if (s->checkpoint_steps > 0 && !options->quiet)
    say("%s: %s makes no checkpoints, which are of corot run alone\n", s->path, what);
}

static corot_status leave_brief(const scenario *s, const brief_result *what, const char *dir) {
  char *text = NULL;
  COROT_TRY(result_brief(s, what, &text));
  corot_status status = folder_make(dir);
  if (status == COROT_OK) status = folder_clean(dir);
  if (status == COROT_OK) status = result_write(dir, text);
  free(text);
  return status;
}

corot_status run_preparing(corot_status status) {
  bool other = status == COROT_OK || status == COROT_ENOMEM || status == COROT_EINTEGRATE;
  return other ? status : COROT_EFORMAT;
}

corot_status run_enter(const char *path, const run_options *options, folder_lock *lock) {
  COROT_TRY(folder_enter(options->dir, lock));
  corot_status status = options->force ? COROT_OK : folder_permit(options->dir, lock->taken);
  if (status == COROT_OK && !options->force && !options->resume)
    status = folder_permit_anew(options->dir);
  if (status != COROT_OK) {
    folder_leave(lock);
    return status;
  }
  lock->keeps = true;
  stop_hold();
  if (lock->taken && !options->quiet && !options->resume)
    say("%s: %s was writing to %s and has left no result; its files are replaced\n", path,
        lock->taken, options->dir);
  return COROT_OK;
}

/* A scenario that is bad makes no folder, and replaces what another run has left of it only where
   that is known to be a run's. */
static bool may_enter(const run_options *options, int code) {
  bool ours = false;
  return code != EXIT_SCENARIO || (folder_is_ours(options->dir, &ours) == COROT_OK && ours);
}

/* Whether there is a checkpoint, whose run may go on whatever has become of this one. */
static bool is_cut(const run_options *options) {
  bool cut = false;
  return folder_is_cut(options->dir, &cut) != COROT_OK || cut;
}

/* If it cannot, all is said. */
static void leave_failure(const char *path, const scenario *s, const run_options *options,
                          folder_lock *lock, const brief_result *what) {
  if (is_cut(options)) return;
  if (!lock->path &&
      (!may_enter(options, what->exit_code) || run_enter(path, options, lock) != COROT_OK))
    return;
  leave_brief(s, what, options->dir);
}

void run_end_unread(const char *path, const run_options *options, corot_status status, int code) {
  folder_lock lock = {.fd = -1};
  char reason[1024];
  snprintf(reason, sizeof reason, "%s", corot_error());
  struct stat info;
  if (stat(options->dir, &info) != 0) return;
  brief_result what = {.status = "failed",
                       .reason = reason,
                       .exit_code = code,
                       .failure = run_failure_of(status, code)};
  leave_failure(path, NULL, options, &lock, &what);
  folder_leave(&lock);
}

int run_end_early(const scenario *s, const run_options *options, folder_lock *lock,
                  const warnings *warned, corot_status status) {
  char reason[1024];
  int code = run_exit_code(status);
  snprintf(reason, sizeof reason, "%s", corot_error());
  say("%s\n", reason);
  if (stop_signal() && code == EXIT_INTEGRATOR) {
    stop_heeded();
    code = run_interrupted(sizeof reason, reason);
    say("%s: %s\n", s->path, reason);
  }
  stop_forget();
  stop_release();
  brief_result what = {.status = code > EXIT_SIGNAL ? "interrupted" : "failed",
                       .reason = reason,
                       .exit_code = code,
                       .failure = run_failure_of(status, code),
                       .warnings = warned};
  leave_failure(s->path, s, options, lock, &what);
  return code;
}

int run_answered_code(int code, const outputs *o) {
  return code == EXIT_OK && outputs_unanswered(o) > 0 ? EXIT_CHECK : code;
}

static const char head[] = "warning: ";

corot_status run_warn_before(const scenario *s, const corot_model *model, bool statics,
                             const run_options *options, warnings *w) {
  corot_status status = warnings_before(s, model, statics, w);
  if (!options->quiet) warnings_print(w, 0, head, stderr);
  return status;
}

static corot_status ask_space(const run_end *end, observed *seen) {
  const space_question question = {
      .scenario = end->scenario,
      .model = end->model,
      .options = end->options,
      .statics = end->statics,
      .ended_well = end->code == EXIT_OK && seen->history.count > 0,
      .work = end->work,
      .t = seen->history.t_elastic,
      .u = seen->history.u,
      .v = seen->history.v,
      .probes = outputs_recorded(end->outputs),
  };
  return space_ask(&question, &seen->space);
}

corot_status run_warn_after(const run_end *end, warnings *w, observed *seen) {
  int before = w->n;
  COROT_TRY(outputs_observed(end->outputs, end->state, seen));
  corot_status status = ask_space(end, seen);
  if (status == COROT_OK && seen->history.count > 0)
    status = warnings_after(end->scenario, end->model, seen, end->statics, w);
  if (status == COROT_OK) status = outputs_warn(end->outputs, w);
  if (!end->options->quiet) warnings_print(w, before, head, stderr);
  return status;
}

corot_status run_write_result(const scenario *s, const outputs *o, const run_summary *summary,
                              const run_options *options) {
  json_t *result = NULL;
  COROT_TRY(result_make(s, o, summary, &result));
  bool hasty = summary->exit_code > EXIT_SIGNAL; /* who interrupts a run waits for its end */
  return run_write_document(result, hasty, options);
}

corot_status run_write_document(json_t *result, bool hasty, const run_options *options) {
  json_t *files = NULL;
  char *text = NULL;
  corot_status status = folder_files(options->dir, hasty, &files);
  if (status == COROT_OK && json_object_set_new(result, "files", files))
    status = corot_fail(COROT_ENOMEM, "result.json: out of memory");
  if (status == COROT_OK) status = result_text(result, &text);
  json_decref(result);
  COROT_TRY(status);
  stop_heeded(); /* this result is not to meet the one that was prepared */
  status = result_write(options->dir, text);
  if (options->json && (fputs(text, stdout) == EOF || fflush(stdout) == EOF))
    status = corot_fail(COROT_EIO, "stdout: cannot write");
  free(text);
  return status;
}

int run_in_c_locale(int (*action)(const scenario *, const run_options *), const scenario *s,
                    const run_options *options) {
  locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
  if (!plain) {
    say("out of memory\n");
    return EXIT_SYSTEM;
  }
  locale_t before = uselocale(plain);
  int code = action(s, options);
  uselocale(before);
  freelocale(plain);
  return code;
}
