#include "run_common.h"

#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "cli.h"
#include "say.h"

static volatile sig_atomic_t stop_signal;

/* Programs that run others may send a signal twice, to the process and to its group: the second is
   one only if it comes some time after the first. */
void run_interrupt(int signal_number) {
  static struct timespec first;
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (!stop_signal) {
    stop_signal = signal_number;
    first = now;
  } else if (now.tv_sec - first.tv_sec > 1) {
    signal(signal_number, SIG_DFL);
    raise(signal_number);
  }
}
int run_stop_signal(void) { return stop_signal; }
void run_forget_signal(void) { stop_signal = 0; }

int run_interrupted(size_t size, char *reason) {
  snprintf(reason, size, "interrupted by signal %d", (int)stop_signal);
  return EXIT_SIGNAL + stop_signal;
}

int run_exit_code(corot_status status) {
  if (status == COROT_OK) return EXIT_OK;
  if (status == COROT_EINVAL || status == COROT_EFORMAT) return EXIT_SCENARIO;
  if (status == COROT_ENOMEM || status == COROT_EIO) return EXIT_SYSTEM;
  return EXIT_INTEGRATOR;
}

corot_status run_write_result(const scenario *s, const outputs *o, const run_summary *summary,
                              const run_options *options) {
  json_t *result = NULL;
  COROT_TRY(result_make(s, o, summary, &result));
  char *text = NULL;
  corot_status status = result_text(result, &text);
  json_decref(result);
  COROT_TRY(status);
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
