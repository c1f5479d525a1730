/* Where SUNDIALS was built with MPI (Debian 13), UCX comes with it, which catches SIGHUP and faults
   as it is loaded: what nohup ignores would end a run, and a fault would leave no core. So what
   signals are to do is read before any library begins, as functions in .preinit_array run. */
#include "first_signals.h"

#include <signal.h>
#include <stddef.h>

#include "sanitized.h"

static const int number[] = {SIGHUP, SIGSEGV, SIGBUS, SIGFPE, SIGILL};
enum { SIGNALS = sizeof number / sizeof *number };

static struct {
  int known;
  struct sigaction action;
} first[SIGNALS];

#if defined(__GLIBC__) && !defined(IS_SANITIZED)
static void read_first(void) {
  for (int i = 0; i < SIGNALS; i++)
    first[i].known = sigaction(number[i], NULL, &first[i].action) == 0;
}

typedef void reader(void);
__attribute__((section(".preinit_array"), used)) static reader *const before_all = read_first;
#endif

void first_signals_restore(void) {
  for (int i = 0; i < SIGNALS; i++)
    if (first[i].known) sigaction(number[i], &first[i].action, NULL);
}
