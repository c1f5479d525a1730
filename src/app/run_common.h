/* What a run and a search for an equilibrium share, from the first message to the exit code. */
#ifndef COROT_APP_RUN_COMMON_H
#define COROT_APP_RUN_COMMON_H

#include "outputs.h"
#include "result.h"
#include "run.h"

enum { EXIT_SIGNAL = 128 }; /* and the number of the signal that ended the run */

int run_exit_code(corot_status status);

/* The signal that asked for an end; 0: none did. */
int run_stop_signal(void);
void run_forget_signal(void);

/* The words and the exit code of a run that heeded it. */
int run_interrupted(size_t size, char *reason);

/* The warnings of what there is before the first step, told on stderr unless the options ask for
   quiet. */
corot_status run_warn_before(const scenario *s, const corot_model *model,
                             bool statics, const run_options *options, warnings *w);

/* The same of what came of it, after the last moment was written; `seen` is what was looked at. */
corot_status run_warn_after(const scenario *s, const corot_model *model, corot_state *state,
                            const outputs *o, bool statics, const run_options *options, warnings *w,
                            observed *seen);

/* result.json, to the folder and, if the options say so, to stdout. */
corot_status run_write_result(const scenario *s, const outputs *o, const run_summary *summary,
                              const run_options *options);

/* Numbers are printed with a point for decimals, whatever the locale of the program. */
int run_in_c_locale(int (*action)(const scenario *, const run_options *), const scenario *s,
                    const run_options *options);

#endif
