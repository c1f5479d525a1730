/* Where address space is limited, each thread takes a large part of it: OpenBLAS waits for ever for
   those it cannot start, and OpenMP, of which CHOLMOD asks for four, ends the program with exit
   code 1. They read their environment before main; so it is set before any library begins, as
   functions in .preinit_array run, by beginning once more. And OpenBLAS of some versions (0.3.29)
   asks for its buffers as it is loaded, again for ever where there is no room: a clock ends that.
 */
#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include "limited.h"

#include <signal.h>
#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include "app/run/exit_code.h"

#include "sanitized.h"

bool is_limited(void) {
  struct rlimit limit;
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

#if defined(__GLIBC__) && !defined(IS_SANITIZED)
static char one_thread[][32] = {"OPENBLAS_NUM_THREADS=1", "OMP_THREAD_LIMIT=1"};
enum { NVARIABLE = sizeof one_thread / sizeof *one_thread };

static bool is_set(const char *variable, char **environment) {
  size_t name = (size_t)(strchr(variable, '=') - variable) + 1;
  for (; *environment; environment++)
    if (strncmp(*environment, variable, name) == 0) return true;
  return false;
}

/* Seconds of CPU; a tenth is what they take. */
static void give_libraries(int seconds) {
  setitimer(ITIMER_PROF, &(struct itimerval){.it_value.tv_sec = seconds}, NULL);
}

static void no_room(int number) {
  static const char why[] =
      "corot: cannot begin: its libraries find no room in the address space that is allowed "
      "(ulimit -v)\n";
  (void)number;
  ssize_t told = write(STDERR_FILENO, why, sizeof why - 1);
  (void)told; /* there is nobody else to tell */
  _exit(EXIT_SYSTEM);
}

/* Where that fails, the program goes on as it is. Nothing of the C library may allocate yet. */
static void keep_to_one_thread(int argc, char **argv, char **environment) {
  (void)argc;
  size_t n = 0, added = 0;
  bool missing[NVARIABLE];
  for (int k = 0; k < NVARIABLE; k++) added += missing[k] = !is_set(one_thread[k], environment);
  if (!is_limited()) return;
  sigaction(SIGPROF, &(struct sigaction){.sa_handler = no_room}, NULL);
  give_libraries(2);
  if (added == 0) return;
  while (environment[n]) n++;
  char **more = mmap(NULL, (n + added + 1) * sizeof *more, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (more == MAP_FAILED) return;
  memcpy(more, environment, n * sizeof *more);
  for (int k = 0; k < NVARIABLE; k++)
    if (missing[k]) more[n++] = one_thread[k];
  more[n] = NULL;
  execve("/proc/self/exe", argv, more);
}

typedef void beginner(int argc, char **argv, char **environment);
__attribute__((section(".preinit_array"), used)) static beginner *const begin = keep_to_one_thread;

void libraries_are_loaded(void) {
  if (!is_limited()) return;
  give_libraries(0);
  signal(SIGPROF, SIG_DFL);
}
#else
void libraries_are_loaded(void) {}
#endif
