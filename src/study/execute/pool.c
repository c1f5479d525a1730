/* fork, exec and wait, with signals handed on. */
#include "pool.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/run/stop.h"
#ifdef __linux__
#include <sys/prctl.h>
#endif

/* The handler of signals has no other way to know of them. */
static struct {
  int size, count;
  volatile pid_t pid[POOL_MAX]; /* 0: free */
  int job[POOL_MAX];
  volatile sig_atomic_t stop;
  struct sigaction before[STOP_SIGNALS];
} pool;

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
  pool.stop = 0;
  for (int i = 0; i < size; i++) pool.pid[i] = 0;
  struct sigaction action = {.sa_handler = hand_on, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  for (int i = 0; i < STOP_SIGNALS; i++) {
    sigaction(stop_signals[i], &action, &pool.before[i]);
    if (is_ignored(i)) sigaction(stop_signals[i], &pool.before[i], NULL);
  }
  return COROT_OK;
}

void pool_close(void) {
  int job, ended;
  while (!pool_is_empty() && pool_wait(&job, &ended) == COROT_OK) continue;
  for (int i = 0; i < STOP_SIGNALS; i++) sigaction(stop_signals[i], &pool.before[i], NULL);
}

bool pool_is_full(void) { return pool.count == pool.size; }
bool pool_is_empty(void) { return pool.count == 0; }
int pool_signal(void) { return pool.stop; }

/* A timer outlives execv. It comes again, as the first signal is but a request. */
static void limit_time(double timeout) {
  if (!(timeout > 0)) return;
  struct itimerval limit = {.it_interval.tv_sec = 5};
  limit.it_value.tv_sec = (time_t)timeout;
  limit.it_value.tv_usec = (suseconds_t)(1e6 * (timeout - floor(timeout)));
  if (limit.it_value.tv_sec == 0 && limit.it_value.tv_usec == 0) limit.it_value.tv_usec = 1;
  setitimer(ITIMER_REAL, &limit, NULL);
}

/* A pipe would keep it waiting for a reader. */
static int open_messages(const char *path) {
  struct stat info;
  int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (file >= 0 && fstat(file, &info) == 0 && S_ISREG(info.st_mode)) return file;
  if (file >= 0 || errno == ENXIO || errno == ELOOP)
    dprintf(STDERR_FILENO, "%s: is not a regular file, and stays as it is\n", path);
  return -1;
}

/* In the new process: never returns. */
static void become(const char *const *argv, const char *messages, pid_t parent,
                   const sigset_t *mask, double timeout) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127); /* it died before */
#else
  (void)parent;
#endif
  for (int i = 0; i < STOP_SIGNALS; i++)
    if (!is_ignored(i)) signal(stop_signals[i], SIG_DFL);
  limit_time(timeout);
  sigprocmask(SIG_SETMASK, mask, NULL);
  int nothing = open("/dev/null", O_RDONLY);
  int file = open_messages(messages);
  if (nothing < 0 || file < 0) _exit(5);
  dup2(nothing, 0);
  dup2(file, 1);
  dup2(file, 2);
  if (nothing > 2) close(nothing);
  if (file > 2) close(file);
  /* one thread each: they share the machine, and sums do not depend on how many run */
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  setenv("OMP_NUM_THREADS", "1", 0);
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
  pid_t parent = getpid(), child = fork();
  if (child == 0) become(argv, messages, parent, &before, timeout);
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
