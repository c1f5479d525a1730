/* A library to preload (LD_PRELOAD) that lets one call of a whole process fail: its libraries and
   its children included. Of two kinds: "alloc" (malloc and its kin, anonymous mmap) and "io"
   (files, folders, locks, streams, processes). For Linux with glibc.

   FAULTS_STATE names a file of the size of `struct state`, which the driver makes: all processes of
   a trial count in it. What happens before main (loader, constructors of other libraries) is not
   counted, nor is what goes to stderr, where the message of the failure must be able to appear.

   A trial need not start the program anew. In the mode SERVE the program runs once, without a
   failure, in the folder "main" beside FAULTS_STATE, and forks before each call that is wanted: the
   call fails in the fork, which runs on in a copy of the folder named "trial"; its open files and
   locks are those of the copy. The program itself waits until that is over, reports it to the
   driver and goes on to the next call.

   So that results can be compared byte by byte, the clocks stand still, and paths are those of
   FAULTS_HOME whatever the folder. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <limits.h>
#include <link.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { ALLOC = 1, IO = 2 };
enum { OFF, RECORD, FAIL, SERVE };
enum { MOST_CALLS = 1 << 17, MOST_FRAMES = 40, SITE_FRAMES = 8, MOST_FILES = 256 };
enum { TO_DRIVER = 900, FROM_DRIVER = 901 }; /* descriptors of a server */
enum { WHERE = 8192 };

/* As driver.py has it. */
struct state {
  int64_t mode;
  int64_t kind; /* which calls count */
  int64_t at;   /* FAIL: the call that fails, from 1 */
  _Atomic int64_t count;
  _Atomic int64_t fired;         /* the process in which it failed */
  int64_t root;                  /* the first process */
  _Atomic int64_t trial;         /* SERVE: the fork in which a call fails; 0: none */
  char where[WHERE];             /* what failed, and its back-trace, one frame a line */
  char crash[WHERE];             /* the same of the first signal that ended a process */
  uint64_t site[MOST_CALLS];     /* [count] RECORD: a hash of the innermost frames of each call */
  int32_t process[MOST_CALLS];   /* [count] RECORD: where it was made */
  uint8_t is_wanted[MOST_CALLS]; /* [count] SERVE: whether it is to fail in a fork */
};

static struct state *state; /* NULL: this process is left alone */
static bool counting, is_trial;
static char root[2048], home[2048]; /* folders: of FAULTS_STATE; FAULTS_HOME */
static _Thread_local int inside __attribute__((tls_model("initial-exec")));

/* --- Modules, so that back-traces do not depend on where they were loaded --- */

static struct module {
  uintptr_t begin, end;
  const char *name;
} module[128];
static int nmodule;

static int add_module(struct dl_phdr_info *info, size_t size, void *context) {
  (void)size, (void)context;
  if (nmodule == sizeof module / sizeof *module) return 1;
  struct module m = {.begin = UINTPTR_MAX};
  for (int i = 0; i < info->dlpi_phnum; i++) {
    if (info->dlpi_phdr[i].p_type != PT_LOAD) continue;
    uintptr_t begin = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr;
    uintptr_t end = begin + info->dlpi_phdr[i].p_memsz;
    if (begin < m.begin) m.begin = begin;
    if (end > m.end) m.end = end;
  }
  const char *slash = strrchr(info->dlpi_name, '/');
  m.name = slash ? slash + 1 : *info->dlpi_name ? info->dlpi_name : "corot";
  module[nmodule++] = m;
  return 0;
}

static const struct module *find_module(uintptr_t address) {
  for (int i = 0; i < nmodule; i++)
    if (address >= module[i].begin && address < module[i].end) return &module[i];
  return NULL;
}

static uint64_t mix(uint64_t hash, uint64_t x) {
  hash = (hash ^ x) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 29);
}

static uint64_t hash_of(const char *what, int n, void *const *frame) {
  uint64_t hash = 0;
  for (const char *c = what; *c; c++) hash = mix(hash, (unsigned char)*c);
  for (int i = 0; i < n && i < SITE_FRAMES; i++) {
    const struct module *m = find_module((uintptr_t)frame[i]);
    hash = mix(hash, m ? (uint64_t)(m - module) : 999);
    hash = mix(hash, (uintptr_t)frame[i] - (m ? m->begin : 0));
  }
  return hash;
}

static void describe(char text[WHERE], const char *what, int n, void *const *frame) {
  size_t used = (size_t)snprintf(text, WHERE, "%s\n", what);
  for (int i = 0; i < n && used + 256 < WHERE; i++) {
    uintptr_t address = (uintptr_t)frame[i];
    const struct module *m = find_module(address);
    Dl_info info = {0};
    if (m && strcmp(m->name, "corot") != 0) dladdr(frame[i], &info);
    used += (size_t)snprintf(text + used, 256, "%.60s+0x%lx %.120s\n", m ? m->name : "?",
                             (unsigned long)(address - (m ? m->begin : 0)),
                             info.dli_sname ? info.dli_sname : "");
  }
}

/* --- Copies of a folder --- */

static void give_up(const char *what) {
  dprintf(2, "faults: %s: %s\n", what, strerror(errno));
  _exit(99);
}

static void copy_file(const char *from, const char *to) {
  int in = open(from, O_RDONLY | O_CLOEXEC), out = open(to, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (in < 0 || out < 0) give_up(from);
  static char block[1 << 16];
  for (ssize_t n; (n = read(in, block, sizeof block)) > 0;)
    if (write(out, block, (size_t)n) != n) give_up(to);
  close(in);
  close(out);
}

/* It may lead nowhere. */
static void copy_link(const char *from, const char *to) {
  char target[4096];
  ssize_t n = readlink(from, target, sizeof target - 1);
  target[n > 0 ? n : 0] = '\0';
  if (n < 0 || symlink(target, to) != 0) give_up(from);
}

static void copy_folder(const char *from, const char *to) {
  if (mkdir(to, 0777) != 0) give_up(to);
  DIR *folder = opendir(from);
  if (!folder) give_up(from);
  for (struct dirent *e; (e = readdir(folder));) {
    if (strcmp(e->d_name, ".") == 0 || strcmp(e->d_name, "..") == 0) continue;
    char a[4096], b[4096];
    snprintf(a, sizeof a, "%s/%s", from, e->d_name);
    snprintf(b, sizeof b, "%s/%s", to, e->d_name);
    struct stat s;
    if (lstat(a, &s) != 0) continue;
    if (S_ISDIR(s.st_mode))
      copy_folder(a, b);
    else
      S_ISLNK(s.st_mode) ? copy_link(a, b) : copy_file(a, b);
  }
  closedir(folder);
}

/* The rest of a path below the folder `name` beside FAULTS_STATE; NULL: it is not there. */
static const char *below(const char *path, const char *name) {
  size_t length = strlen(root), more = strlen(name);
  if (strncmp(path, root, length) != 0 || path[length] != '/') return NULL;
  if (strncmp(path + length + 1, name, more) != 0) return NULL;
  const char *rest = path + length + 1 + more;
  return *rest == '/' || *rest == '\0' ? rest : NULL;
}

static bool holds_lock(int fd) {
  char path[64], text[2048];
  snprintf(path, sizeof path, "/proc/self/fdinfo/%d", fd);
  int info = open(path, O_RDONLY | O_CLOEXEC);
  ssize_t n = read(info, text, sizeof text - 1);
  close(info);
  text[n > 0 ? n : 0] = '\0';
  return strstr(text, "FLOCK") != NULL;
}

/* An open file becomes that of the copy, at the same place and with the same lock. */
static void move_file(int fd, const char *copy) {
  int flags = fcntl(fd, F_GETFL), inherited = fcntl(fd, F_GETFD);
  int keep = O_ACCMODE | O_APPEND | O_NONBLOCK | O_DIRECTORY;
  int new = open(copy, (flags & keep) | O_CLOEXEC);
  if (new < 0) give_up(copy);
  off_t at = lseek(fd, 0, SEEK_CUR);
  if (at > 0) lseek(new, at, SEEK_SET);
  if (holds_lock(fd)) flock(new, LOCK_EX | LOCK_NB);
  dup3(new, fd, inherited & FD_CLOEXEC ? O_CLOEXEC : 0);
  close(new);
}

/* What a trial opens instead of a file that is open: its copy, or, of a file from elsewhere, the
   file itself, so that no place in it is shared. False: it is left alone. */
static bool find_copy(const char *link, const char *path, char copy[8192], bool *is_gone) {
  struct stat s;
  const char *rest = below(path, "main");
  bool is_file = stat(link, &s) == 0 && S_ISREG(s.st_mode);
  *is_gone = is_file && rest && s.st_nlink == 0;
  if (*is_gone) {
    snprintf(copy, 8192, "%s/gone", root);
    copy_file(link, copy);
  } else if (rest) {
    snprintf(copy, 8192, "%s/trial%s", root, rest);
  } else {
    snprintf(copy, 8192, "%s", link);
  }
  return rest || is_file;
}

static void move_into_copy(void) {
  char link[64], path[4096], copy[8192];
  for (int fd = -1; fd < MOST_FILES; fd++) { /* -1: the working folder */
    snprintf(link, sizeof link, fd < 0 ? "/proc/self/cwd" : "/proc/self/fd/%d", fd);
    ssize_t n = readlink(link, path, sizeof path - 1);
    if (n < 0) continue;
    path[n] = '\0';
    bool is_gone;
    if (!find_copy(link, path, copy, &is_gone)) continue;
    if (fd >= 0)
      move_file(fd, copy);
    else if (chdir(copy) != 0)
      give_up(copy);
    if (is_gone) unlink(copy);
  }
}

/* A path as a trial is to understand it: what began before may have kept that of a file in "main".
 */
static const char *here(const char *path) {
  static _Thread_local char copy[8192] __attribute__((tls_model("initial-exec")));
  const char *rest = is_trial && path ? below(path, "main") : NULL;
  if (!rest) return path;
  snprintf(copy, sizeof copy, "%s/trial%s", root, rest);
  return copy;
}

/* --- Counting --- */

/* Whether this process is the fork in which the call fails. */
static bool serve(int64_t k) {
  char from[4096], to[4096];
  snprintf(from, sizeof from, "%s/main", root);
  snprintf(to, sizeof to, "%s/trial", root);
  copy_folder(from, to);
  state->crash[0] = '\0';
  state->trial = 0;
  pid_t parent = getpid(), child = fork();
  if (child < 0) give_up("fork");
  if (child == 0) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(98);
    state->trial = getpid();
    counting = false;
    is_trial = true;
    *strstr(getenv("FAULTS_OFF"), "no") = 'y'; /* not by setenv, whose lock may be held */
    close(TO_DRIVER);
    close(FROM_DRIVER);
    move_into_copy();
    return true;
  }
  int ended = 0;
  while (waitpid(child, &ended, 0) != child) continue;
  state->trial = 0;
  kill(-child, SIGKILL); /* what it left behind */
  int64_t report[3] = {k, ended, getpid() != state->root}, answer;
  if (write(TO_DRIVER, report, sizeof report) != sizeof report ||
      read(FROM_DRIVER, &answer, sizeof answer) != sizeof answer)
    _exit(97);
  return false;
}

/* Whether this call is to fail. */
static bool fails(int kind, const char *what) {
  if (!counting || state->kind != kind || inside) return false;
  inside = 1;
  int64_t k = atomic_fetch_add(&state->count, 1) + 1;
  bool now = state->mode == FAIL && k == state->at;
  bool served = state->mode == SERVE && k <= MOST_CALLS && state->is_wanted[k - 1];
  bool recorded = state->mode == RECORD && k <= MOST_CALLS;
  if (now || served || recorded) {
    int saved = errno;
    void *frame[MOST_FRAMES];
    int n = backtrace(frame, recorded ? SITE_FRAMES + 2 : MOST_FRAMES) - 2;
    if (n < 0) n = 0;
    if (recorded) {
      state->site[k - 1] = hash_of(what, n, frame + 2);
      state->process[k - 1] = getpid();
    } else {
      describe(state->where, what, n, frame + 2);
    }
    if (served) {
      state->at = k;
      now = serve(k);
    }
    if (now) state->fired = getpid();
    errno = saved;
  }
  inside = 0;
  return now;
}

static bool refuse(int number) {
  errno = number;
  return true;
}

/* The same, with one of the reasons there are for it: which one goes by the number of the call. */
static bool refused(const char *what, const int *reason) {
  if (!fails(IO, what)) return false;
  int n = 0;
  while (reason[n]) n++;
  return refuse(reason[state->at % n]);
}
#define REFUSED(what, ...) refused(what, (const int[]){__VA_ARGS__, 0})

/* --- Crashes --- */

/* Says where it happened; the signal comes again, and ends the process. */
static void on_crash(int number) {
  inside = 1;
  void *frame[MOST_FRAMES];
  int n = backtrace(frame, MOST_FRAMES);
  if (!state->crash[0]) describe(state->crash, strsignal(number), n, frame);
}

static void watch_for_crashes(void) {
  static char stack[1 << 16]; /* its own, as the usual one may be used up */
  sigaltstack(&(stack_t){.ss_sp = stack, .ss_size = sizeof stack}, NULL);
  const int numbers[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  struct sigaction action = {.sa_handler = on_crash, .sa_flags = SA_ONSTACK | (int)SA_RESETHAND};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    sigaction(numbers[i], &action, NULL);
}

/* --- Begin --- */

__attribute__((constructor)) static void begin(void) {
  const char *path = getenv("FAULTS_STATE"), *at_home = getenv("FAULTS_HOME");
  if (!path || !at_home) return;
  inside = 1;
  snprintf(home, sizeof home, "%s", at_home);
  snprintf(root, sizeof root, "%.*s", (int)(strrchr(path, '/') - path), path);
  dl_iterate_phdr(add_module, NULL);
  void *frame[4];
  backtrace(frame, 4); /* loads what it needs */
  int fd = open(path, O_RDWR | O_CLOEXEC);
  void *map = mmap(NULL, sizeof *state, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  close(fd);
  if (map == MAP_FAILED) abort();
  state = map;
  watch_for_crashes();
  if (state->root == 0) state->root = getpid();
  counting = state->mode != OFF && strcmp(getenv("FAULTS_OFF"), "no") == 0;
  inside = 0;
}

/* --- Memory --- */

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

#define NO_MEMORY(what) (fails(ALLOC, what) && refuse(ENOMEM))

void *malloc(size_t size) { return NO_MEMORY("malloc") ? NULL : __libc_malloc(size); }

void *calloc(size_t n, size_t size) { return NO_MEMORY("calloc") ? NULL : __libc_calloc(n, size); }

void *realloc(void *old, size_t size) {
  return NO_MEMORY("realloc") ? NULL : __libc_realloc(old, size);
}

void *reallocarray(void *old, size_t n, size_t size) {
  size_t all;
  if (__builtin_mul_overflow(n, size, &all)) return refuse(ENOMEM), NULL;
  return NO_MEMORY("reallocarray") ? NULL : __libc_realloc(old, all);
}

void *aligned_alloc(size_t alignment, size_t size) {
  return NO_MEMORY("aligned_alloc") ? NULL : __libc_memalign(alignment, size);
}

void *memalign(size_t alignment, size_t size);
void *memalign(size_t alignment, size_t size) {
  return NO_MEMORY("memalign") ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void **out, size_t alignment, size_t size) {
  void *memory = NO_MEMORY("posix_memalign") ? NULL : __libc_memalign(alignment, size);
  if (!memory) return ENOMEM;
  *out = memory;
  return 0;
}

/* --- What is called in the end --- */

/* A function that fails with `failure` and one of the reasons, before it has done anything. */
#define FAILS(result, name, parameters, arguments, failure, ...) \
  typedef result type_##name parameters;                         \
  static type_##name *real_##name(void) {                        \
    static type_##name *found;                                   \
    if (!found) *(void **)&found = dlsym(RTLD_NEXT, #name);      \
    return found;                                                \
  }                                                              \
  result name parameters;                                        \
  result name parameters { return REFUSED(#name, __VA_ARGS__) ? failure : real_##name() arguments; }

/* --- Files and folders --- */

typedef struct stat stat_type;
typedef struct stat64 stat64_type;
typedef struct dirent dirent_type;
typedef struct dirent64 dirent64_type;

FAILS(int, creat, (const char *p, mode_t m), (here(p), m), -1, EACCES, ENOSPC, EMFILE)
FAILS(int, creat64, (const char *p, mode_t m), (here(p), m), -1, EACCES, ENOSPC, EMFILE)
FAILS(ssize_t, read, (int fd, void *to, size_t n), (fd, to, n), -1, EIO)
FAILS(ssize_t, pread, (int fd, void *to, size_t n, off_t at), (fd, to, n, at), -1, EIO)
FAILS(ssize_t, pread64, (int fd, void *to, size_t n, off64_t at), (fd, to, n, at), -1, EIO)
FAILS(ssize_t, pwrite, (int fd, const void *d, size_t n, off_t at), (fd, d, n, at), -1, ENOSPC, EIO)
FAILS(ssize_t, pwrite64, (int fd, const void *d, size_t n, off64_t at), (fd, d, n, at), -1, ENOSPC,
      EIO)
FAILS(int, ftruncate, (int fd, off_t n), (fd, n), -1, EIO, ENOSPC)
FAILS(int, ftruncate64, (int fd, off64_t n), (fd, n), -1, EIO, ENOSPC)
FAILS(int, rename, (const char *a, const char *b), (a, b), -1, EACCES, ENOSPC, EIO)
FAILS(int, renameat, (int i, const char *a, int j, const char *b), (i, a, j, b), -1, EACCES, EIO)
FAILS(int, renameat2, (int i, const char *a, int j, const char *b, unsigned f), (i, a, j, b, f), -1,
      EACCES, EIO)
FAILS(int, link, (const char *a, const char *b), (a, b), -1, EACCES, ENOSPC, EIO)
FAILS(int, mkdir, (const char *p, mode_t m), (here(p), m), -1, EACCES, ENOSPC)
FAILS(int, mkdirat, (int fd, const char *p, mode_t m), (fd, p, m), -1, EACCES, ENOSPC)
FAILS(int, unlink, (const char *p), (here(p)), -1, EACCES, EIO)
FAILS(int, unlinkat, (int fd, const char *p, int f), (fd, p, f), -1, EACCES, EIO)
FAILS(int, remove, (const char *p), (here(p)), -1, EACCES, EIO)
FAILS(int, rmdir, (const char *p), (here(p)), -1, EACCES, EIO)
FAILS(int, chmod, (const char *p, mode_t m), (here(p), m), -1, EPERM)
FAILS(int, fchmod, (int fd, mode_t m), (fd, m), -1, EPERM)
FAILS(int, access, (const char *p, int m), (here(p), m), -1, EACCES, EIO)
FAILS(int, stat, (const char *p, stat_type *s), (here(p), s), -1, EACCES, EIO)
FAILS(int, lstat, (const char *p, stat_type *s), (here(p), s), -1, EACCES, EIO)
FAILS(int, fstat, (int fd, stat_type *s), (fd, s), -1, EIO)
FAILS(int, fstatat, (int fd, const char *p, stat_type *s, int f), (fd, p, s, f), -1, EACCES, EIO)
FAILS(int, stat64, (const char *p, stat64_type *s), (here(p), s), -1, EACCES, EIO)
FAILS(int, lstat64, (const char *p, stat64_type *s), (here(p), s), -1, EACCES, EIO)
FAILS(int, fstat64, (int fd, stat64_type *s), (fd, s), -1, EIO)
FAILS(DIR *, opendir, (const char *p), (here(p)), NULL, EACCES, EMFILE)
FAILS(DIR *, fdopendir, (int fd), (fd), NULL, EACCES, ENOMEM)
FAILS(dirent_type *, readdir, (DIR * d), (d), NULL, EIO)
FAILS(dirent64_type *, readdir64, (DIR * d), (d), NULL, EIO)
FAILS(int, flock, (int fd, int how), (fd, how), -1, ENOLCK)
FAILS(off_t, lseek, (int fd, off_t at, int from), (fd, at, from), -1, EIO)
FAILS(off64_t, lseek64, (int fd, off64_t at, int from), (fd, at, from), -1, EIO)
FAILS(int, dup2, (int a, int b), (a, b), -1, EMFILE)
FAILS(char *, getcwd, (char *to, size_t n), (to, n), NULL, EACCES)
FAILS(int, symlink, (const char *to, const char *p), (to, here(p)), -1, EACCES, ENOSPC)
FAILS(ssize_t, readlink, (const char *p, char *to, size_t n), (here(p), to, n), -1, EACCES, EIO)
FAILS(pid_t, fork, (void), (), -1, EAGAIN, ENOMEM)
FAILS(int, execv, (const char *p, char *const *argv), (here(p), argv), -1, EACCES, ENOMEM)
FAILS(int, timer_create, (clockid_t c, struct sigevent *e, timer_t *t), (c, e, t), -1, EAGAIN)

/* A study's runs begin one by one, as trials must: there is no template that begins beside them. */
int socketpair(int domain, int type, int protocol, int fd[2]) {
  (void)domain, (void)type, (void)protocol, (void)fd;
  errno = EOPNOTSUPP;
  return -1;
}

/* No power cut comes of it. */
int fsync(int fd) { return (void)fd, REFUSED("fsync", EIO, ENOSPC) ? -1 : 0; }
int fdatasync(int fd) { return (void)fd, REFUSED("fdatasync", EIO, ENOSPC) ? -1 : 0; }

/* A path as it would be at home, wherever the trial takes place. */
static void say_home(char *path, size_t size) {
  const char *rest = NULL;
  for (const char *const *name = (const char *const[]){"main", "trial", "again", NULL}; *name;
       name++)
    if (!rest) rest = below(path, *name);
  char copy[4096];
  if (!rest || (size_t)snprintf(copy, sizeof copy, "%s%s", home, rest) >= size) return;
  strcpy(path, copy);
}

typedef char *type_realpath(const char *path, char *to);
char *realpath(const char *restrict path, char *restrict to) {
  static type_realpath *real;
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "realpath");
  if (REFUSED("realpath", EACCES, EIO)) return NULL;
  char found[PATH_MAX];
  if (!real(here(path), found)) return NULL;
  say_home(found, sizeof found);
  return to ? strcpy(to, found) : strdup(found);
}

/* Standard error is left alone. */
typedef ssize_t type_write(int fd, const void *data, size_t n);
ssize_t write(int fd, const void *data, size_t n) {
  static type_write *real;
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "write");
  return fd != 2 && REFUSED("write", ENOSPC, EIO) ? -1 : real(fd, data, n);
}

/* The descriptor is given up all the same. */
typedef int type_close(int fd);
int close(int fd) {
  static type_close *real;
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "close");
  bool refuses = REFUSED("close", EIO, ENOSPC);
  int saved = errno, answer = real(fd);
  if (!refuses) return answer;
  errno = saved;
  return -1;
}

typedef int type_open(const char *path, int flags, ...);
#define OPENS(name)                                                                  \
  int name(const char *path, int flags, ...);                                        \
  int name(const char *path, int flags, ...) {                                       \
    static type_open *real;                                                          \
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, #name);                            \
    va_list list;                                                                    \
    va_start(list, flags);                                                           \
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(list, mode_t) : 0;          \
    va_end(list);                                                                    \
    if (inside) return real(here(path), flags, mode);                                \
    return REFUSED(#name, EACCES, EMFILE, EIO) ? -1 : real(here(path), flags, mode); \
  }
OPENS(open)
OPENS(open64)

typedef int type_openat(int fd, const char *path, int flags, ...);
#define OPENS_AT(name)                                                             \
  int name(int fd, const char *path, int flags, ...);                              \
  int name(int fd, const char *path, int flags, ...) {                             \
    static type_openat *real;                                                      \
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, #name);                          \
    va_list list;                                                                  \
    va_start(list, flags);                                                         \
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(list, mode_t) : 0;        \
    va_end(list);                                                                  \
    return REFUSED(#name, EACCES, EMFILE, EIO) ? -1 : real(fd, path, flags, mode); \
  }
OPENS_AT(openat)
OPENS_AT(openat64)

/* Locks only: the rest asks for what a descriptor is. */
static bool locks(int command) {
  return command == F_SETLK || command == F_SETLKW || command == F_OFD_SETLK ||
         command == F_OFD_SETLKW;
}

typedef int type_fcntl(int fd, int command, ...);
#define CONTROLS(name)                                                                  \
  int name(int fd, int command, ...);                                                   \
  int name(int fd, int command, ...) {                                                  \
    static type_fcntl *real;                                                            \
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, #name);                               \
    va_list list;                                                                       \
    va_start(list, command);                                                            \
    void *argument = va_arg(list, void *);                                              \
    va_end(list);                                                                       \
    return locks(command) && REFUSED(#name, ENOLCK) ? -1 : real(fd, command, argument); \
  }
CONTROLS(fcntl)
CONTROLS(fcntl64)

typedef void *type_mmap(void *at, size_t size, int protection, int flags, int fd, off_t offset);
#define MAPS(name)                                                                     \
  void *name(void *at, size_t size, int protection, int flags, int fd, off_t offset);  \
  void *name(void *at, size_t size, int protection, int flags, int fd, off_t offset) { \
    static type_mmap *real;                                                            \
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, #name);                              \
    bool refuses = flags & MAP_ANONYMOUS ? NO_MEMORY(#name) : REFUSED(#name, ENOMEM);  \
    return refuses ? MAP_FAILED : real(at, size, protection, flags, fd, offset);       \
  }
MAPS(mmap)
MAPS(mmap64)

/* --- Streams --- */

FAILS(FILE *, fopen, (const char *p, const char *m), (here(p), m), NULL, EACCES, EMFILE, EIO)
FAILS(FILE *, fopen64, (const char *p, const char *m), (here(p), m), NULL, EACCES, EMFILE, EIO)
FAILS(FILE *, fdopen, (int fd, const char *m), (fd, m), NULL, EMFILE)

/* Streams in memory fail as memory does. What a stream does fails for good: its mark of an error
   is set, as the C library does. */
static bool stream_fails(FILE *f, const char *what, const int *reason) {
  if (f == stderr || fileno(f) < 0 || !refused(what, reason)) return false;
  f->_flags |= _IO_ERR_SEEN;
  return true;
}
#define STREAM(result, name, parameters, arguments, stream, failure, ...)           \
  typedef result type_##name parameters;                                            \
  result name parameters;                                                           \
  result name parameters {                                                          \
    static type_##name *real;                                                       \
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, #name);                           \
    if (stream_fails(stream, #name, (const int[]){__VA_ARGS__, 0})) return failure; \
    return real arguments;                                                          \
  }

#undef putc
#undef getc
STREAM(size_t, fread, (void *to, size_t s, size_t n, FILE *f), (to, s, n, f), f, 0, EIO)
STREAM(char *, fgets, (char *to, int n, FILE *f), (to, n, f), f, NULL, EIO)
STREAM(int, fgetc, (FILE * f), (f), f, EOF, EIO)
STREAM(int, getc, (FILE * f), (f), f, EOF, EIO)
STREAM(ssize_t, getline, (char **to, size_t *n, FILE *f), (to, n, f), f, -1, EIO)
STREAM(size_t, fwrite, (const void *d, size_t s, size_t n, FILE *f), (d, s, n, f), f, 0, ENOSPC,
       EIO)
STREAM(int, fputs, (const char *s, FILE *f), (s, f), f, EOF, ENOSPC, EIO)
STREAM(int, fputc, (int c, FILE *f), (c, f), f, EOF, ENOSPC, EIO)
STREAM(int, putc, (int c, FILE *f), (c, f), f, EOF, ENOSPC, EIO)
STREAM(int, puts, (const char *s), (s), stdout, EOF, ENOSPC, EIO)
STREAM(int, putchar, (int c), (c), stdout, EOF, ENOSPC, EIO)
STREAM(int, fseek, (FILE * f, long at, int from), (f, at, from), f, -1, EIO)
STREAM(long, ftell, (FILE * f), (f), f, -1, EIO)
STREAM(int, vfprintf, (FILE * f, const char *s, va_list v), (f, s, v), f, -1, ENOSPC, EIO)

/* What was not yet written is lost. */
static void lose(FILE *f) {
  if (__fwriting(f)) __fpurge(f);
}

typedef int type_fflush(FILE *f);
int fflush(FILE *f) {
  static type_fflush *real;
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "fflush");
  if (!f || !stream_fails(f, "fflush", (const int[]){ENOSPC, EIO, 0})) return real(f);
  lose(f);
  return EOF;
}

typedef int type_fclose(FILE *f);
int fclose(FILE *f) {
  static type_fclose *real;
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "fclose");
  if (!stream_fails(f, "fclose", (const int[]){ENOSPC, EIO, 0})) return real(f);
  int saved = errno;
  lose(f);
  real(f);
  errno = saved;
  return EOF;
}

static int print(FILE *f, const char *what, const char *format, va_list list) {
  static type_vfprintf *real;
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "vfprintf");
  return stream_fails(f, what, (const int[]){ENOSPC, EIO, 0}) ? -1 : real(f, format, list);
}

#define PRINTS(name, before, stream)                  \
  int name(BEFORE_##before const char *format, ...);  \
  int name(BEFORE_##before const char *format, ...) { \
    va_list list;                                     \
    va_start(list, format);                           \
    int answer = print(stream, #name, format, list);  \
    va_end(list);                                     \
    return answer;                                    \
  }
#define BEFORE_NOTHING
#define BEFORE_STREAM FILE *f,
PRINTS(fprintf, STREAM, f)
PRINTS(printf, NOTHING, stdout)

/* --- Mutexes --- */

/* One that is recursive knows its holder by number, which another process does not have; a fork has
   but one thread. */
#define LOCKS(name)                                       \
  typedef int type_##name(pthread_mutex_t *mutex);        \
  int name(pthread_mutex_t *mutex) {                      \
    static type_##name *real;                             \
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, #name); \
    return is_trial ? 0 : real(mutex);                    \
  }
LOCKS(pthread_mutex_lock)
LOCKS(pthread_mutex_trylock)
LOCKS(pthread_mutex_unlock)

/* --- Clocks that stand still --- */

int clock_gettime(clockid_t clock, struct timespec *t) {
  (void)clock;
  *t = (struct timespec){.tv_sec = 1000000000};
  return 0;
}

int gettimeofday(struct timeval *restrict t, void *restrict zone) {
  (void)zone;
  *t = (struct timeval){.tv_sec = 1000000000};
  return 0;
}

time_t time(time_t *t) {
  if (t) *t = 1000000000;
  return 1000000000;
}

clock_t clock(void) { return 0; }

int getrusage(__rusage_who_t who, struct rusage *usage) {
  (void)who;
  memset(usage, 0, sizeof *usage);
  usage->ru_maxrss = 1000;
  return 0;
}
