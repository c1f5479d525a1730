/* Processes begun, as copies of a template or by fork and exec, and waited for, with signals handed
   on. */
#include "pool.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/select.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "app/run/run_clock.h"
#include "app/run/stop.h"
#include "template.h"

/* The handler of signals has no other way to know of them. */
static struct {
  int size, count;
  long started;                 /* processes so far */
  volatile pid_t pid[POOL_MAX]; /* 0: free */
  int job[POOL_MAX];
  volatile sig_atomic_t stop;
  struct sigaction before[STOP_SIGNALS], child_before;
} pool;

/* That a process has ended need not be heeded, but ends a wait. */
static void notice(int number) { (void)number; }

/* A limit of our own is none of theirs. */
static void hand_on(int number) {
  int saved = errno;
  pool.stop = number;
  for (int i = 0; i < pool.size; i++)
    if (pool.pid[i] > 0)
      kill(pool.pid[i], number == SIGXCPU || number == SIGALRM ? SIGTERM : number);
  errno = saved;
}

/* As nohup has it. SIGINT is ignored by shells for what runs in the background. */
static bool is_ignored(int i) {
  return pool.before[i].sa_handler == SIG_IGN && stop_signals[i] != SIGINT;
}

corot_status pool_open(int size) {
  if (size < 1 || size > POOL_MAX)
    return corot_fail(COROT_EINVAL, "%d processes at once; 1 to %d are possible", size, POOL_MAX);
  pool.size = size;
  pool.count = 0;
  pool.started = 0;
  pool.stop = 0;
  for (int i = 0; i < size; i++) pool.pid[i] = 0;
  struct sigaction action = {.sa_handler = hand_on, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  sigaction(SIGCHLD, &(struct sigaction){.sa_handler = notice, .sa_flags = SA_RESTART},
            &pool.child_before);
  for (int i = 0; i < STOP_SIGNALS; i++) {
    sigaction(stop_signals[i], &action, &pool.before[i]);
    if (is_ignored(i)) sigaction(stop_signals[i], &pool.before[i], NULL);
  }
  return COROT_OK;
}

void pool_close(void) {
  int job, ended;
  while (!pool_is_empty() && pool_wait(&job, &ended) == COROT_OK) continue;
  template_stop();
  for (int i = 0; i < STOP_SIGNALS; i++) sigaction(stop_signals[i], &pool.before[i], NULL);
  sigaction(SIGCHLD, &pool.child_before, NULL);
}

bool pool_is_full(void) { return pool.count == pool.size; }
bool pool_is_empty(void) { return pool.count == 0; }
int pool_signal(void) { return pool.stop; }

/* In a new process. */
static void heed_signals(void) {
  for (int i = 0; i < STOP_SIGNALS; i++)
    if (!is_ignored(i)) signal(stop_signals[i], SIG_DFL);
}

/* The first process begins as the program does: it may be the only one. */
static pid_t begin(const char *const *argv, const char *messages, const sigset_t *mask,
                   double timeout) {
  if (pool.started++ > 0 && template_start(heed_signals, mask)) {
    pid_t copy = template_copy(argv, messages, timeout);
    if (copy > 0) return copy;
  }
  pid_t parent = getpid(), child = fork();
  if (child != 0) return child;
  heed_signals();
  template_become(parent, messages, timeout);
  sigprocmask(SIG_SETMASK, mask, NULL);
  execv("/proc/self/exe", (char *const *)argv);
  _exit(127);
}

corot_status pool_start(int job, const char *const *argv, const char *messages, double timeout) {
  int slot = 0;
  while (slot < pool.size && pool.pid[slot] != 0) slot++;
  if (slot == pool.size) return corot_fail(COROT_EINVAL, "%d processes run already", pool.size);

  /* no signal between the birth of a process and its entry in the list */
  sigset_t all, before;
  sigemptyset(&all);
  for (int i = 0; i < STOP_SIGNALS; i++) sigaddset(&all, stop_signals[i]);
  sigprocmask(SIG_BLOCK, &all, &before);
  pid_t child = begin(argv, messages, &before, timeout);
  int why = errno;
  if (child > 0) {
    pool.pid[slot] = child;
    pool.job[slot] = job;
    pool.count++;
  }
  sigprocmask(SIG_SETMASK, &before, NULL);
  if (child < 0) return corot_fail(COROT_EIO, "cannot start a process: %s", strerror(why));
  return COROT_OK;
}

corot_status pool_wait(int *job, int *ended) {
  siginfo_t info;
  while (waitid(P_ALL, 0, &info, WEXITED | WNOWAIT) != 0)
    if (errno != EINTR) return corot_fail(COROT_EIO, "cannot wait: %s", strerror(errno));
  int slot = 0, status;
  while (slot < pool.size && pool.pid[slot] != info.si_pid) slot++;
  if (slot < pool.size) pool.pid[slot] = 0; /* before its number can be another's */
  waitpid(info.si_pid, &status, 0);
  if (slot == pool.size) return pool_wait(job, ended); /* none of ours */
  pool.count--;
  *job = pool.job[slot];
  *ended = WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  return COROT_OK;
}

/* Whether one has ended, within that time. SIGCHLD is let in nowhere but in the wait: none is
   missed. */
static bool has_ended(double seconds) {
  double until = wall_clock() + seconds;
  sigset_t child, before;
  siginfo_t info = {0};
  sigemptyset(&child);
  sigaddset(&child, SIGCHLD);
  sigprocmask(SIG_BLOCK, &child, &before);
  while (waitid(P_ALL, 0, &info, WEXITED | WNOWAIT | WNOHANG) == 0 && info.si_pid == 0) {
    double left = until - wall_clock();
    if (!(left > 0)) break;
    struct timespec rest = {.tv_sec = (time_t)left};
    rest.tv_nsec = (long)(1e9 * (left - (double)rest.tv_sec));
    pselect(0, NULL, NULL, NULL, &rest, &before);
  }
  sigprocmask(SIG_SETMASK, &before, NULL);
  return info.si_pid != 0;
}

corot_status pool_wait_for(double seconds, int *job, int *ended) {
  *job = -1;
  return has_ended(seconds) ? pool_wait(job, ended) : COROT_OK;
}
