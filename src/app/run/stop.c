/* Handlers may come at any instant: what they read is either of a type that is read whole, or
   stands still while `prepared` is set. */
#include "stop.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "app/folder/checkpoint_file.h"
#include "app/folder/folder.h"
#include "app/folder/folder_lock.h"
#include "app/text/no_memory.h"

const int stop_signals[STOP_SIGNALS] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU, SIGALRM};

enum {
  TIMER = SIGVTALRM, /* which nothing else here uses */
  PATIENCE_MS = 600, /* until the process is ended */
  TWICE_MS = 200,    /* within which a second request is the first again */
  PARTS = 4,
};

static struct {
  volatile sig_atomic_t signal, heeded, prepared, held;
  struct timespec first; /* when it came */
  timer_t timer;
  bool has_timer;
  char *dir, *path, *temporary, *lock, *text;
  const char *part[PARTS]; /* of the text, around the numbers */
  size_t length[PARTS];
  char reached[2][32];
  volatile sig_atomic_t latest; /* of the two */
  struct {
    const char *data;
    size_t size;
  } checkpoint[2];
  volatile sig_atomic_t keeps; /* the number of one of them, from 1; 0: none */
  char *checkpoint_path, *checkpoint_temporary;
} stop;

/* --- In handlers --- */

static void put(int fd, const char *text, size_t size) {
  while (size > 0) {
    ssize_t written = write(fd, text, size);
    if (written <= 0 && errno != EINTR) return;
    if (written > 0) text += written, size -= (size_t)written;
  }
}

static void put_number(int fd, int number) {
  char digits[12];
  size_t at = sizeof digits;
  do digits[--at] = (char)('0' + number % 10);
  while (number /= 10);
  put(fd, digits + at, sizeof digits - at);
}

static void make_folder(char *dir) {
  for (char *c = dir + 1; *c; c++) {
    if (*c != '/') continue;
    *c = '\0';
    mkdir(dir, 0777);
    *c = '/';
  }
}

/* Complete, or not at all: what stands there otherwise stays. */
static bool put_prepared(void) {
  int fd = open(stop.temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (fd < 0) return false;
  const char *reached = stop.reached[stop.latest];
  put(fd, stop.part[0], stop.length[0]);
  put_number(fd, stop.signal);
  put(fd, stop.part[1], stop.length[1]);
  put_number(fd, 128 + stop.signal);
  put(fd, stop.part[2], stop.length[2]);
  put(fd, reached, strlen(reached));
  put(fd, stop.part[3], stop.length[3]);
  off_t size = lseek(fd, 0, SEEK_CUR), least = 0;
  for (int i = 0; i < PARTS; i++) least += (off_t)stop.length[i];
  bool whole = size > least && fsync(fd) == 0;
  whole = close(fd) == 0 && whole && rename(stop.temporary, stop.path) == 0;
  if (!whole) unlink(stop.temporary);
  return whole;
}

static void put_checkpoint(void) {
  const char *data = stop.checkpoint[stop.keeps - 1].data;
  size_t size = stop.checkpoint[stop.keeps - 1].size;
  unlink(stop.checkpoint_temporary);
  int fd = open(stop.checkpoint_temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) return;
  put(fd, data, size);
  bool whole = lseek(fd, 0, SEEK_CUR) == (off_t)size && fsync(fd) == 0;
  whole = close(fd) == 0 && whole && rename(stop.checkpoint_temporary, stop.checkpoint_path) == 0;
  if (!whole) unlink(stop.checkpoint_temporary);
}

/* Where another process writes, what it says is not to be replaced. */
static void write_prepared(void) {
  make_folder(stop.dir);
  if (!stop.held && folder_lock_try(stop.lock) < 0) return;
  if (stop.held && stop.keeps) put_checkpoint();
  if (put_prepared()) unlink(stop.lock);
}

static void end_now(void) {
  if (stop.prepared) write_prepared();
  _exit(128 + stop.signal);
}

static void on_timer(int number) {
  (void)number;
  if (stop.signal && stop.prepared && !stop.heeded) end_now();
}

static void start_timer(void) {
  struct itimerspec once = {.it_value = {.tv_nsec = PATIENCE_MS * 1000000L}};
  if (stop.has_timer) timer_settime(stop.timer, 0, &once, NULL);
}

void stop_request(int signal_number) {
  int saved = errno;
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (!stop.signal) {
    stop.signal = signal_number;
    stop.first = now;
    start_timer();
  } else {
    long since = (long)(now.tv_sec - stop.first.tv_sec) * 1000 +
                 (now.tv_nsec - stop.first.tv_nsec) / 1000000;
    if (since > TWICE_MS) end_now();
  }
  errno = saved;
}

/* --- Elsewhere --- */

void stop_heed(void) {
  struct sigaction action = {.sa_flags = SA_RESTART}, before;
  sigemptyset(&action.sa_mask);
  for (int i = 0; i < STOP_SIGNALS; i++) sigaddset(&action.sa_mask, stop_signals[i]);
  sigaddset(&action.sa_mask, TIMER);

  struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = TIMER};
  if (!stop.has_timer) stop.has_timer = timer_create(CLOCK_MONOTONIC, &event, &stop.timer) == 0;
  action.sa_handler = on_timer;
  sigaction(TIMER, &action, NULL);
  action.sa_handler = stop_request;
  for (int i = 0; i < STOP_SIGNALS; i++) {
    bool ignored = sigaction(stop_signals[i], NULL, &before) == 0 && before.sa_handler == SIG_IGN;
    if (!ignored || stop_signals[i] == SIGINT) sigaction(stop_signals[i], &action, NULL);
  }
}

int stop_signal(void) { return stop.signal; }

void stop_forget(void) {
  struct itimerspec never = {0};
  if (stop.has_timer) timer_settime(stop.timer, 0, &never, NULL);
  stop.signal = 0;
  stop.heeded = 0;
}

void stop_heeded(void) { stop.heeded = 1; }

void stop_reached(double t) {
  int next = !stop.latest;
  snprintf(stop.reached[next], sizeof stop.reached[next], "%.17g", t);
  stop.latest = next;
}

static corot_status split(void) {
  static const int number[PARTS - 1] = {STOP_NUMBER, STOP_CODE, STOP_REACHED};
  char *from = stop.text;
  for (int i = 0; i < PARTS - 1; i++) {
    char word[12];
    snprintf(word, sizeof word, "%d", number[i]);
    char *found = strstr(from, word);
    if (!found) return corot_fail(COROT_EINVAL, "result.json: no place for a number");
    stop.part[i] = from;
    stop.length[i] = (size_t)(found - from);
    from = found + strlen(word);
  }
  stop.part[PARTS - 1] = from;
  stop.length[PARTS - 1] = strlen(from);
  return COROT_OK;
}

corot_status stop_prepare(const char *dir, const char *text) {
  stop_release();
  stop.heeded = 0;
  stop_reached(0);
  stop.dir = folder_path(dir, "");
  stop.path = folder_path(dir, "result.json");
  stop.temporary = folder_path(dir, "result.json.tmp");
  stop.lock = folder_path(dir, FOLDER_LOCK_NAME);
  stop.checkpoint_path = folder_path(dir, CHECKPOINT_NAME);
  stop.checkpoint_temporary = folder_path(dir, CHECKPOINT_NAME ".tmp");
  stop.text = malloc(strlen(text) + 1);
  if (!stop.checkpoint_path || !stop.checkpoint_temporary || !stop.dir || !stop.path ||
      !stop.temporary || !stop.lock || !stop.text) {
    stop_release();
    return no_memory();
  }
  strcpy(stop.text, text);
  corot_status status = split();
  if (status == COROT_OK)
    stop.prepared = 1;
  else
    stop_release();
  return status;
}

void stop_keep(const void *data, size_t size) {
  int next = data ? (stop.keeps == 1 ? 2 : 1) : 0;
  if (next) {
    stop.checkpoint[next - 1].data = data;
    stop.checkpoint[next - 1].size = size;
  }
  stop.keeps = next;
}

void stop_hold(void) { stop.held = 1; }

void stop_release(void) {
  stop.prepared = stop.held = stop.keeps = 0;
  free(stop.dir);
  free(stop.path);
  free(stop.temporary);
  free(stop.lock);
  free(stop.text);
  free(stop.checkpoint_path);
  free(stop.checkpoint_temporary);
  stop.dir = stop.path = stop.temporary = stop.lock = stop.text = NULL;
  stop.checkpoint_path = stop.checkpoint_temporary = NULL;
}
