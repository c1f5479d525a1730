/* The program: the table of its commands. */
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
#include "limited.h"

static const char help[] =
    "corot: deformable solids as ordinary differential equations, integrated with error control\n"
    "\n"
    "usage: corot COMMAND ...\n"
    "\n"
    "  run MODEL.yaml       integrate a scenario and write its tables and fields\n"
    "  static MODEL.yaml    find its equilibrium under the full loads instead\n"
    "  modes MODEL.yaml     find its eigenfrequencies and modes\n"
    "  check MODEL.yaml     say what is wrong with a scenario, or what it amounts to\n"
    "  study STUDY.yaml     run a scenario many times along axes, and compare: errors and costs\n"
    "  budget MODEL.yaml    how wrong a run is, and because of what\n"
    "  solve MODEL.yaml     find a number of it with an error that is asked for\n"
    "  find-limit MODEL.yaml\n"
    "                       where it stops being stable as one of its numbers grows\n"
    "  export-fmu MODEL.yaml\n"
    "                       pack it for programs that couple models (FMI 3.0)\n"
    "  schema [KEY]         every key of a scenario: type, unit, default, meaning\n"
    "  tune                 measure which linear solvers are fast on this machine\n"
    "  mesh box             generate the mesh of a box\n"
    "  mesh info FILE       size, shape and groups of a mesh\n"
    "  mesh refine FILE     cut every tet into eight\n"
    "  plot DIR             draw the work-precision diagram of a study\n"
    "  report DIR           show a run or a study as one HTML page\n"
    "\n"
    "  corot COMMAND --help, corot --version\n"
    "\n"
    "Data goes to stdout, messages to stderr. Exit codes:\n"
    "\n"
    "  0  ok                              4  the integrator gave up, or found no equilibrium\n"
    "  1  finished, but a check failed,   5  the system refused memory, reading or writing, or\n"
    "     or some runs did                   there are no results in a folder, or files of\n"
    "  2  the command line makes no sense    others that only --force replaces\n"
    "  3  a scenario, study or mesh is bad or missing\n"
    "  128 + N  interrupted by signal N, after writing what there was (130: Ctrl-C, 143: kill);\n"
    "           or ended by a fault (139, 134), which is said, with what was written by then\n"
    "\n"
    "example: corot run models/bar/bar.yaml -o out/bar --set integrator.rtol=1e-6\n";

static int print_version(int argc, char **argv) {
  (void)argc, (void)argv;
  printf("corot %s\n", corot_version());
  return EXIT_OK;
}

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

int main(int argc, char **argv) {
  static const command table[] = {
      {"run", command_run},         {"static", command_static},
      {"modes", command_modes},     {"check", command_check},
      {"study", command_study},     {"budget", command_budget},
      {"solve", command_solve},     {"find-limit", command_find_limit},
      {"plot", command_study_plot}, {"report", command_report},
      {"schema", command_schema},   {"tune", command_tune},
      {"mesh", command_mesh},       {"export-fmu", command_export_fmu},
      {"--version", print_version}, {0},
  };
  libraries_are_loaded();
  first_signals_restore();
  hold_standard_streams();
  prepare_blas(argc, argv);
  crash_watch();
  signal(SIGPIPE, SIG_IGN); /* a reader that leaves is a write error, seen below */
  signal(SIGXFSZ, SIG_IGN); /* so is a file that may not grow further */
  template_serve(&argc, &argv);
  int code = dispatch("corot", help, table, argc, argv);
  if (fflush(stdout) != 0 || ferror(stdout)) {
    fprintf(stderr, "corot: standard output: %s\n", strerror(errno));
    if (code == EXIT_OK) code = EXIT_SYSTEM;
  }
  if (ferror(stderr) && code == EXIT_OK) code = EXIT_SYSTEM; /* with nobody to tell */
  leave_at_once_if_limited(code);
  return code;
}
