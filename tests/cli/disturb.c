/* A library to preload (LD_PRELOAD) that disturbs one process at a chosen call; its children are
   left alone. For Linux with glibc.

   DISTURB_KILL=SIGNAL:N   the process gets the signal before its N-th call that changes a file or a
                           folder; DISTURB_COUNT=FILE gets the number of such calls at its end
   DISTURB_FAULT=KIND:N    before the N-th such call it has a fault: "null", an address of nothing;
                           "stack", a recursion without end; "abort"
   DISTURB_CLOCK=N         from the N-th look at it on, the clock of the day and the one that never
                           goes back are an hour late
   DISTURB_VANISH=N        the folder DISTURB_FOLDER is removed, all that is in it included, before
                           the N-th such call */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static _Atomic long changes, looks;
static long kill_at, clock_at, vanish_at, fault_at;
static char fault[8];
static int number, inside;
static char *folder, *count_file;

__attribute__((constructor)) static void begin(void) {
  /* the program itself, should it begin once more, too; its children are left alone */
  char self[24];
  const char *who = getenv("DISTURB_PROCESS");
  snprintf(self, sizeof self, "%ld", (long)getpid());
  if (who && strcmp(who, self) != 0) return;
  setenv("DISTURB_PROCESS", self, 1);

  const char *kill_text = getenv("DISTURB_KILL"), *clock_text = getenv("DISTURB_CLOCK");
  const char *vanish_text = getenv("DISTURB_VANISH"), *file = getenv("DISTURB_COUNT");
  if (kill_text) sscanf(kill_text, "%d:%ld", &number, &kill_at);
  const char *fault_text = getenv("DISTURB_FAULT");
  if (fault_text) sscanf(fault_text, "%7[a-z]:%ld", fault, &fault_at);
  if (clock_text) clock_at = atol(clock_text);
  if (vanish_text) vanish_at = atol(vanish_text);
  if (file) count_file = strdup(file);
  if (getenv("DISTURB_FOLDER")) folder = strdup(getenv("DISTURB_FOLDER"));
  changes = looks = 0; /* without those of libraries that are loaded with the program */
}

__attribute__((destructor)) static void end(void) {
  if (!count_file) return;
  inside = 1;
  FILE *f = fopen(count_file, "w");
  if (f) fprintf(f, "%ld\n", (long)changes), fclose(f);
}

static int remove_one(const char *path, const struct stat *info, int flag, struct FTW *where) {
  (void)info, (void)flag, (void)where;
  return remove(path);
}

/* Until the stack is full; compilers need not know that there is no other end. */
static void recur(volatile char *above) {
  volatile char here[1024] = {*above};
  if (*above) recur(here);
  here[1] = 0; /* so that it is no loop */
}

static void crash(void) {
  if (strcmp(fault, "abort") == 0) abort();
  if (strcmp(fault, "stack") == 0)
    recur(fault);
  else
    *(volatile int *)NULL = 0;
}

static void change(void) {
  if (inside) return;
  long n = ++changes;
  if (n == fault_at) crash();
  if (n == kill_at) raise(number);
  if (n != vanish_at) return;
  inside = 1;
  nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS);
  inside = 0;
}

static void *next(const char *name) { return dlsym(RTLD_NEXT, name); }

/* A function that changes something: it counts, and goes on to the real one. */
#define CHANGES(result, name, parameters, arguments) \
  CHANGES_IF(true, result, name, parameters, arguments)
#define CHANGES_IF(condition, result, name, parameters, arguments) \
  result name parameters {                                         \
    static result(*real) parameters;                               \
    if (!real) *(void **)&real = next(#name);                      \
    if (condition) change();                                       \
    return real arguments;                                         \
  }
CHANGES(ssize_t, write, (int fd, const void *data, size_t size), (fd, data, size))
CHANGES(ssize_t, pwrite, (int fd, const void *data, size_t size, off_t at), (fd, data, size, at))
CHANGES(ssize_t, pwrite64, (int fd, const void *data, size_t size, off64_t at),
        (fd, data, size, at))
CHANGES(int, fsync, (int fd), (fd))
CHANGES(int, fdatasync, (int fd), (fd))
CHANGES(int, rename, (const char *from, const char *to), (from, to))
CHANGES(int, unlink, (const char *path), (path))
CHANGES(int, mkdir, (const char *path, mode_t mode), (path, mode))
CHANGES(int, ftruncate, (int fd, off_t size), (fd, size))
CHANGES(int, ftruncate64, (int fd, off64_t size), (fd, size))

/* Streams of files, not those in memory, nor the messages. */
static bool is_file(FILE *f) { return f && f != stderr && fileno(f) >= 0; }
CHANGES_IF(*mode != 'r', FILE *, fopen, (const char *path, const char *mode), (path, mode))
CHANGES_IF(*mode != 'r', FILE *, fopen64, (const char *path, const char *mode), (path, mode))
CHANGES_IF(is_file(f), int, fflush, (FILE * f), (f))
CHANGES_IF(is_file(f), int, fclose, (FILE * f), (f))

#define OPENS(name)                                                         \
  int name(const char *path, int flags, ...) {                              \
    static int (*real)(const char *, int, ...);                             \
    if (!real) *(void **)&real = next(#name);                               \
    va_list list;                                                           \
    va_start(list, flags);                                                  \
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(list, mode_t) : 0; \
    va_end(list);                                                           \
    if ((flags & O_ACCMODE) != O_RDONLY) change();                          \
    return real(path, flags, mode);                                         \
  }
OPENS(open)
OPENS(open64)

int fprintf(FILE *f, const char *format, ...) {
  va_list list;
  va_start(list, format);
  if (is_file(f)) change();
  int n = vfprintf(f, format, list);
  va_end(list);
  return n;
}

int clock_gettime(clockid_t clock, struct timespec *t) {
  static int (*real)(clockid_t, struct timespec *);
  if (!real) *(void **)&real = next("clock_gettime");
  int code = real(clock, t);
  if (clock != CLOCK_REALTIME && clock != CLOCK_MONOTONIC) return code;
  if (clock_at > 0 && ++looks >= clock_at) t->tv_sec -= 3600;
  return code;
}
