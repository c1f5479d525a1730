#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <app/cli.h>
#include <report/commands.h>
#include <study/command_study.h>

static const char help[] =
    "corot: deformable solids as ordinary differential equations, integrated with error control\n"
    "\n"
    "usage: corot COMMAND ...\n"
    "\n"
    "  run MODEL.yaml       integrate a scenario and write its tables and fields\n"
    "  static MODEL.yaml    find its equilibrium under the full loads instead\n"
    "  check MODEL.yaml     say what is wrong with a scenario, or what it amounts to\n"
    "  study STUDY.yaml     run a scenario many times along axes, and compare: errors and costs\n"
    "  budget MODEL.yaml    how wrong a run is, and because of what\n"
    "  find-limit MODEL.yaml\n"
    "                       where it stops being stable as one of its numbers grows\n"
    "  schema [KEY]         every key of a scenario: type, unit, default, meaning\n"
    "  mesh box             generate the mesh of a box\n"
    "  mesh info FILE       size, shape and groups of a mesh\n"
    "  mesh refine FILE     cut every tet into eight\n"
    "  plot DIR             draw the work-precision diagram of a study\n"
    "  report DIR           show a run or a study as one HTML page\n"
    "\n"
    "  corot COMMAND --help, corot --version\n"
    "\n"
    "Data goes to stdout, messages to stderr. Exit codes: 0 ok, 1 a check failed, 2 usage,\n"
    "3 bad scenario or mesh, 4 the integrator gave up, 5 input or output, 130 and 143 "
    "interrupted.\n"
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

int main(int argc, char **argv) {
  static const command table[] = {
      {"run", command_run},     {"static", command_static},   {"check", command_check},
      {"study", command_study}, {"budget", command_budget},   {"find-limit", command_find_limit},
      {"plot", command_plot},   {"report", command_report},   {"schema", command_schema},
      {"mesh", command_mesh},   {"--version", print_version}, {0},
  };
  hold_standard_streams();
  signal(SIGPIPE, SIG_IGN); /* a reader that leaves is a write error, seen below */
  int code = dispatch("corot", help, table, argc, argv);
  if (fflush(stdout) != 0 || ferror(stdout)) {
    fprintf(stderr, "corot: standard output: %s\n", strerror(errno));
    if (code == EXIT_OK) code = EXIT_SYSTEM;
  }
  return code;
}
