/* Requests go through a pair of sockets: a head, then the texts. The answer is the number of the
   process. */
#define _GNU_SOURCE /* CLONE_PARENT */
#include "template.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/run/stop.h"
#ifdef __linux__
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif

static const char marker[] = "--template"; /* the first argument of a template */

static struct {
  bool possible; /* main() serves templates */
  pid_t pid;     /* 0: there is none */
  int socket;
} own;

typedef struct request {
  size_t size; /* of the texts: messages, then the arguments, each with its end */
  int argc;
  double timeout;
} request;

/* --- A new process --- */

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

static void die_with(pid_t parent) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127); /* it died before */
#else
  (void)parent;
#endif
}

/* They share the machine: each takes one thread, of ours and of BLAS, unless it is told to take
   more. */
static void keep_to_one_thread(void) {
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  setenv("OMP_NUM_THREADS", "1", 0);
}

void template_become(pid_t parent, const char *messages, double timeout) {
  die_with(parent);
  limit_time(timeout);
  int nothing = open("/dev/null", O_RDONLY);
  int file = open_messages(messages);
  if (nothing < 0 || file < 0) _exit(5);
  dup2(nothing, 0);
  dup2(file, 1);
  dup2(file, 2);
  if (nothing > 2) close(nothing);
  if (file > 2) close(file);
  keep_to_one_thread();
}

/* --- Texts through a socket --- */

static bool put(int fd, const void *data, size_t size) {
  for (const char *rest = data; size > 0;) {
    ssize_t sent = send(fd, rest, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    rest += sent;
    size -= (size_t)sent;
  }
  return true;
}

static bool get(int fd, void *data, size_t size) {
  for (char *rest = data; size > 0;) {
    ssize_t got = read(fd, rest, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    rest += got;
    size -= (size_t)got;
  }
  return true;
}

/* --- In the template --- */

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { IS_WATCHED = 1 }; /* by a library that must see each process begin */
#else
enum { IS_WATCHED = 0 };
#endif

#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
/* A child of this process' own parent; for which there is no function. */
static pid_t copy_self(void) {
  return (pid_t)syscall(SYS_clone, (unsigned long)(CLONE_PARENT | SIGCHLD), 0L, 0L, 0L, 0L);
}

/* A copy has but the thread that made it. */
static bool is_alone(void) {
  DIR *d = opendir("/proc/self/task");
  int count = 0;
  for (struct dirent *entry; d && (entry = readdir(d));) count += entry->d_name[0] != '.';
  if (d) closedir(d);
  return count == 1 && !IS_WATCHED;
}
#else
static pid_t copy_self(void) { return -1; }
static bool is_alone(void) { return false; }
#endif

/* The texts of the next request, in memory that a copy keeps. */
static bool receive(int fd, request *r, char **text, char ***argv) {
  if (!get(fd, r, sizeof *r)) return false;
  *text = malloc(r->size);
  *argv = calloc((size_t)r->argc + 1, sizeof **argv);
  if (!*text || !*argv || !get(fd, *text, r->size)) return false;
  char *next = *text + strlen(*text) + 1;
  for (int i = 0; i < r->argc; i++, next += strlen(next) + 1) (*argv)[i] = next;
  return true;
}

/* A copy shows its own arguments to ps, as far as those of the template leave room. */
static void show_arguments(int had, char **old, const request *r, char **arguments) {
  char *to = old[0], *end = old[had - 1] + strlen(old[had - 1]); /* which stays a zero */
  memset(to, 0, (size_t)(end - to));
  for (int i = 0; i < r->argc && to < end; i++, to++)
    for (const char *from = arguments[i]; *from && to < end;) *to++ = *from++;
}

/* What asks for an end asks the copies, and none of them may miss it: this process ends when nobody
   can ask it any more. */
static void serve(int fd, int *argc, char ***argv) {
  pid_t parent = getppid();
  sigset_t all, mask;
  request r;
  char *text, **arguments;
  sigemptyset(&all);
  for (int i = 0; i < STOP_SIGNALS; i++) sigaddset(&all, stop_signals[i]);
  sigprocmask(SIG_BLOCK, &all, &mask);
  while (receive(fd, &r, &text, &arguments)) {
    pid_t child = copy_self();
    if (child == 0) {
      close(fd);
      template_become(parent, text, r.timeout);
      show_arguments(*argc, *argv, &r, arguments);
      sigprocmask(SIG_SETMASK, &mask, NULL);
      *argc = r.argc;
      *argv = arguments;
      return;
    }
    free(text);
    free(arguments);
    if (!put(fd, &child, sizeof child)) break;
  }
  _exit(0);
}

void template_serve(int *argc, char ***argv) {
  struct stat info;
  own.possible = true;
  if (*argc != 4 || strcmp((*argv)[1], marker) != 0) return;
  int fd = atoi((*argv)[2]);
  if (fstat(fd, &info) != 0 || !S_ISSOCK(info.st_mode)) return;
  if (!is_alone()) _exit(0);
  serve(fd, argc, argv);
}

/* --- In the process that asks --- */

static void become_template(pid_t parent, int fd) {
  char number[16], room[1024] = ""; /* for the arguments of copies */
  snprintf(number, sizeof number, "%d", fd);
  memset(room, ' ', sizeof room - 1);
  const char *const argv[] = {"corot", marker, number, room, NULL};
  fcntl(fd, F_SETFD, 0); /* it is for the program that comes */
  die_with(parent);
  keep_to_one_thread();
  execv("/proc/self/exe", (char *const *)argv);
  _exit(127);
}

bool template_start(void (*heed)(void), const sigset_t *mask) {
  int pair[2];
  if (own.pid != 0) return true;
  if (!own.possible || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0) return false;
  pid_t parent = getpid(), child = fork();
  if (child == 0) {
    heed();
    sigprocmask(SIG_SETMASK, mask, NULL);
    become_template(parent, pair[1]);
  }
  close(pair[1]);
  if (child < 0) {
    close(pair[0]);
    return false;
  }
  own.pid = child;
  own.socket = pair[0];
  return true;
}

/* Asks for a copy; false: no answer. */
static bool ask(const char *const *argv, const char *messages, double timeout, pid_t *child) {
  request r = {.size = strlen(messages) + 1, .timeout = timeout};
  for (; argv[r.argc]; r.argc++) r.size += strlen(argv[r.argc]) + 1;
  if (!put(own.socket, &r, sizeof r) || !put(own.socket, messages, strlen(messages) + 1))
    return false;
  for (int i = 0; i < r.argc; i++)
    if (!put(own.socket, argv[i], strlen(argv[i]) + 1)) return false;
  return get(own.socket, child, sizeof *child);
}

pid_t template_copy(const char *const *argv, const char *messages, double timeout) {
  pid_t child = -1;
  if (own.pid != 0 && ask(argv, messages, timeout, &child) && child > 0) return child;
  template_stop();
  own.possible = false; /* it would not do better another time */
  return -1;
}

void template_stop(void) {
  if (own.pid == 0) return;
  close(own.socket);
  while (waitpid(own.pid, NULL, 0) < 0 && errno == EINTR) continue;
  own.pid = 0;
}
