/* The program: the table of its commands, from which come the help, man pages and completion. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/command/cli.h"
#include "fmi/command/command_fmu.h"
#include "report/command/commands.h"
#include "solve/linsol/blas_core.h"
#include "study/command/command_study.h"
#include "study/execute/template.h"

#include "crash.h"
#include "first_signals.h"
#include "help.h"
#include "limited.h"

/* A standard stream that is closed would lend its number to the next file opened. */
static void hold_standard_streams(void) {
  for (int fd = 0; fd <= 2; fd++)
    if (fcntl(fd, F_GETFD) == -1 && errno == EBADF && open("/dev/null", O_RDONLY) != fd) _exit(5);
}

_Noreturn static void cannot_begin(const char *what) {
  fprintf(stderr, "corot: cannot begin: %s: %s\n", what, strerror(errno));
  _exit(EXIT_SYSTEM); /* with no handler of a library that has not been told */
}

static void tell(const char *name, const char *value) {
  if (setenv(name, value, 0) != 0) cannot_begin(name);
}

/* The commands that factor: a run has the same last digits by itself as in a study. */
static bool is_factoring(const char *name) {
  static const char *const factoring[] = {"run",    "static", "modes",      "study",
                                          "budget", "solve",  "find-limit", "tune"};
  for (size_t i = 0; i < sizeof factoring / sizeof *factoring; i++)
    if (strcmp(name, factoring[i]) == 0) return true;
  return false;
}

static bool ask_for_better_kernels(void) {
  const char *core = corot_blas_better_core();
  if (core) tell("OPENBLAS_CORETYPE", core);
  return core;
}

/* OpenBLAS chooses its kernels as it is loaded: what it is told here it sees only when the program
   begins once more. Where there is no /proc it goes on as it is. */
static void prepare_blas(int argc, char **argv) {
  if (argc < 2 || !is_factoring(argv[1])) return;
  if (ask_for_better_kernels()) {
    execv("/proc/self/exe", argv);
    if (errno != ENOENT) cannot_begin("exec");
  }
  corot_blas_keep_to_one_thread();
}

/* OpenBLAS may wait for ever in its exit handler for threads that had no room to start. */
static void leave_at_once_if_limited(int code) {
  if (!is_limited()) return;
  fflush(NULL);
  _exit(code);
}

static int command_help(int argc, char **argv);

static const listed_command table[] = {
    {"new", command_new, "to begin", "KIND",
     "write a scenario to begin with: bar, bracket or free"},
    {"schema", command_schema, NULL, "[KEY]",
     "every key of a scenario: type, unit, default, meaning"},
    {"check", command_check, NULL, "MODEL.yaml",
     "say what is wrong with a scenario, or what it amounts to"},
    {"mesh", command_mesh, NULL, "box|info|...",
     "generate, look at, refine, repair or convert a mesh"},
    {"run", command_run, "to compute", "MODEL.yaml",
     "integrate a scenario and write its tables and fields"},
    {"static", command_static, NULL, "MODEL.yaml",
     "find its equilibrium under the full loads instead"},
    {"modes", command_modes, NULL, "MODEL.yaml", "find its eigenfrequencies and modes"},
    {"solve", command_solve, NULL, "MODEL.yaml",
     "find a number of it with an error that is asked for"},
    {"tune", command_tune, NULL, "", "measure which linear solvers are fast on this machine"},
    {"budget", command_budget, "to compare", "MODEL.yaml",
     "how wrong a run is, and because of what"},
    {"study", command_study, NULL, "STUDY.yaml",
     "run a scenario many times along axes, and compare: errors and costs"},
    {"find-limit", command_find_limit, NULL, "MODEL.yaml",
     "where it stops being stable as one of its numbers grows"},
    {"report", command_report, "to show and to pass on", "DIR",
     "show a run or a study as one HTML page"},
    {"plot", command_study_plot, NULL, "DIR", "draw the work-precision diagram of a study"},
    {"export-fmu", command_export_fmu, NULL, "MODEL.yaml",
     "pack it for programs that couple models (FMI 3.0)"},
    {"help", command_help, "to look up", "[COMMAND]", "what a command does, and its options"},
    {"--version", print_version, NULL, "(-v)", "of corot, and of the libraries that it has found"},
    {"-v", print_version, NULL, NULL, NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static int answer(int argc, char **argv) {
  bool asked = argc > 1 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0);
  command plain[sizeof table / sizeof *table];
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    plain[i] = (command){table[i].name, table[i].run};
  if (argc > 1 && !asked) return dispatch("corot", "", plain, argc, argv);
  print_help(table, asked ? stdout : stderr);
  return asked ? EXIT_OK : EXIT_USAGE;
}

/* `corot help study export` is `corot study export --help`. */
static int command_help(int argc, char **argv) {
  enum { MOST = 3 };
  static char asked[] = "--help";
  char *line[MOST + 2] = {argv[0]};
  bool whole = argc < 2 || argv[1][0] == '-' || strcmp(argv[1], "help") == 0;
  if (argc > MOST) return usage_error("corot help", "expected one command");
  int n = 1;
  for (int i = 1; i < argc && !whole; i++) line[n++] = argv[i];
  line[n++] = asked;
  return answer(n, line);
}

int main(int argc, char **argv) {
  libraries_are_loaded();
  first_signals_restore();
  hold_standard_streams();
  prepare_blas(argc, argv);
  crash_watch();
  signal(SIGPIPE, SIG_IGN); /* a reader that leaves is a write error, seen below */
  signal(SIGXFSZ, SIG_IGN); /* so is a file that may not grow further */
  template_serve(&argc, &argv);
  int code = answer(argc, argv);
  if (fflush(stdout) != 0 || ferror(stdout)) {
    fprintf(stderr, "corot: standard output: %s\n", strerror(errno));
    if (code == EXIT_OK) code = EXIT_SYSTEM;
  }
  if (ferror(stderr) && code == EXIT_OK) code = EXIT_SYSTEM; /* with nobody to tell */
  leave_at_once_if_limited(code);
  return code;
}
