/* What a run and a search for an equilibrium share, from the first message to the exit code. */
#ifndef COROT_APP_RUN_RUN_COMMON_H
#define COROT_APP_RUN_RUN_COMMON_H

#include "app/folder/folder_lock.h"
#include "exit_code.h"
#include "outputs.h"
#include "result.h"
#include "run_options.h"

int run_exit_code(corot_status status);

/* The exit code of a run that ended with `code` and could not write the rest of its files as `late`
   says: what the system refused may pass, and whatever else there was is found again then. */
int run_late_code(int code, corot_status late);

/* The exit code of a run that ended with `code`: EXIT_CHECK where all is well but that a quantity
   has no value. Its status is ok. Call this once the outputs are closed. */
int run_answered_code(int code, const outputs *o);

/* Adds the message of the last failure to the reason that there is. */
void run_add_reason(size_t size, char *reason);

/* Why a run that ended with this status and exit code is not ok. */
run_failure run_failure_of(corot_status status, int code);

/* Looks whether the folder may be written to, which takes no time; and prepares for an end without
   notice (stop.h). COROT_EIO: it may not. */
corot_status run_begin(const scenario *s, const run_options *options);

/* The second of these alone. */
corot_status run_prepare_stop(const scenario *s, const run_options *options);

/* Says, unless the options ask for quiet, that `what` makes no checkpoints where the scenario asks
   for some. */
void run_without_checkpoints(const scenario *s, const run_options *options, const char *what);

/* The status of a preparation, in which all is the fault of scenario or mesh but lack of memory,
   and that there is no equilibrium to start from. */
corot_status run_preparing(corot_status status);

/* Takes the folder for this run, and says so if a process that was killed has left it locked.
   `path` of the scenario is for that message. COROT_EIO: another process writes there, or it is not
   a run's (folder_owner.h). */
corot_status run_enter(const char *path, const run_options *options, folder_lock *lock);

/* The end of a run that failed before its first output: says why, and leaves a result.json unless
   another process writes there, or the folder is not a run's, or has a checkpoint to go on from.
   Where it is the scenario's fault, that is left only in place of another run's. `warned` is what
   was warned of before. Returns the exit code. */
int run_end_early(const scenario *s, const run_options *options, folder_lock *lock,
                  const warnings *warned, corot_status status);

/* The same of a scenario that could not be read, of which all is said: a folder that is there, and
   is a run's, does not go on to say that this run was well. */
void run_end_unread(const char *path, const run_options *options, corot_status status, int code);

/* The words and the exit code of a run that heeds a request to stop. */
int run_interrupted(size_t size, char *reason);

/* A run in the end, after the last moment was written. */
typedef struct run_end {
  const scenario *scenario;
  const corot_model *model;
  corot_state *state;
  const outputs *outputs;
  const run_options *options;
  bool statics;
  int code; /* the exit code, as far as it is known */
  run_work work;
} run_end;

/* Of these parts; how it ended is for the caller to say. */
static inline run_end run_end_of(const scenario *s, const corot_model *model, corot_state *state,
                                 const outputs *o, const run_options *options) {
  return (run_end){.scenario = s, .model = model, .state = state, .outputs = o, .options = options};
}

/* The warnings of what there is before the first step, told on stderr unless the options ask for
   quiet. */
corot_status run_warn_before(const scenario *s, const corot_model *model, bool statics,
                             const run_options *options, warnings *w);

/* The same of what came of it, and the space error; `seen` is what was looked at, and refers to the
   outputs. */
corot_status run_warn_after(const run_end *end, warnings *w, observed *seen);

/* A document as result.json, with the list of the folder's files added. It is taken over. */
corot_status run_write_document(json_t *result, bool hasty, const run_options *options);

/* result.json, to the folder and, if the options say so, to stdout. */
corot_status run_write_result(const scenario *s, const outputs *o, const run_summary *summary,
                              const run_options *options);

/* Numbers are printed with a point for decimals, whatever the locale of the program. */
int run_in_c_locale(int (*action)(const scenario *, const run_options *), const scenario *s,
                    const run_options *options);

#endif
