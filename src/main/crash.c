/* SUNDIALS 6.4, libfyaml and others use memory that they were refused: such a crash cannot be met,
   but it can be told. All that a handler needs is prepared, as it may neither allocate nor lock. */
#define _GNU_SOURCE /* dl_iterate_phdr, REG_RIP */
#include "crash.h"

#include <link.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <ucontext.h>
#include <unistd.h>

#include "sanitized.h"

/* Where each library is in memory; the first one is the program itself. */
static struct {
  uintptr_t begin, end;
  const char *name;
} object[128];
static int nobject;

static const struct {
  int number;
  const char *name;
} fault[] = {{SIGSEGV, "SIGSEGV"},
             {SIGBUS, "SIGBUS"},
             {SIGFPE, "SIGFPE"},
             {SIGILL, "SIGILL"},
             {SIGABRT, "SIGABRT"}};
enum { FAULTS = sizeof fault / sizeof *fault };
static struct sigaction before[FAULTS];

static char stack[1 << 16]; /* as the usual one may be used up */

/* --- In the handler --- */

static char *append(char *to, const char *text) {
  size_t length = strlen(text);
  memcpy(to, text, length);
  return to + length;
}

/* The instruction that failed; 0: not known. */
static uintptr_t find_place(const void *context) {
#if defined(__x86_64__)
  return (uintptr_t)((const ucontext_t *)context)->uc_mcontext.gregs[REG_RIP];
#elif defined(__aarch64__)
  return (uintptr_t)((const ucontext_t *)context)->uc_mcontext.pc;
#else
  (void)context;
  return 0;
#endif
}

static const char *find_object(uintptr_t place) {
  for (int i = 0; i < nobject; i++)
    if (place >= object[i].begin && place < object[i].end) return object[i].name;
  return NULL;
}

/* Of what was sent it does not matter where the program was. */
static void tell(int i, const siginfo_t *info, const void *context) {
  static char text[1024]; /* ample: the name of a file has 255 bytes at most */
  bool is_fault = info->si_code > 0, is_ours = is_fault || info->si_pid == getpid();
  const char *where = is_fault ? find_object(find_place(context)) : NULL;
  char *end = append(text, isatty(STDERR_FILENO) ? "\r\033[Kcorot: ended by " : "corot: ended by ");
  end = append(end, is_fault  ? "a fault inside the program ("
                    : is_ours ? "an internal error ("
                              : "another process (");
  end = append(end, fault[i].name);
  if (where) end = append(append(end, " in "), where);
  end = append(end, is_ours ? "); memory that has run out is a frequent cause; " : "); ");
  end = append(end,
               "what is written stays, and a folder is complete only where its result.json "
               "says \"ok\"\n");
  ssize_t written = write(STDERR_FILENO, text, (size_t)(end - text));
  (void)written; /* there is nobody else to tell */
}

/* A fault comes again when this returns, at the same place; what was sent is sent again. */
static void on_fault(int number, siginfo_t *info, void *context) {
  int i = 0;
  while (fault[i].number != number) i++;
  sigaction(number, &before[i], NULL);
  tell(i, info, context);
  if (info->si_code <= 0) raise(number);
}

/* --- Before --- */

static int add_object(struct dl_phdr_info *info, size_t size, void *context) {
  (void)size, (void)context;
  if (nobject == sizeof object / sizeof *object) return 1;
  uintptr_t begin = UINTPTR_MAX, end = 0;
  for (int i = 0; i < info->dlpi_phnum; i++) {
    if (info->dlpi_phdr[i].p_type != PT_LOAD) continue;
    uintptr_t from = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr;
    uintptr_t to = from + info->dlpi_phdr[i].p_memsz;
    if (from < begin) begin = from;
    if (to > end) end = to;
  }
  const char *slash = strrchr(info->dlpi_name, '/');
  object[nobject].begin = begin;
  object[nobject].end = end;
  object[nobject++].name = slash ? slash + 1 : *info->dlpi_name ? info->dlpi_name : "corot";
  return 0;
}

void crash_watch(void) {
#ifdef IS_SANITIZED
  return;
#endif
  dl_iterate_phdr(add_object, NULL);
  struct sigaction action = {.sa_sigaction = on_fault, .sa_flags = SA_SIGINFO | SA_ONSTACK};
  sigemptyset(&action.sa_mask);
  sigaltstack(&(stack_t){.ss_sp = stack, .ss_size = sizeof stack}, NULL);
  for (int i = 0; i < FAULTS; i++) {
    sigaction(fault[i].number, NULL, &before[i]);
    if (before[i].sa_handler != SIG_IGN) sigaction(fault[i].number, &action, NULL);
  }
}
