/* corot-bench: how long the parts of corot take, and how long they would have to take. */
#include <stdlib.h>
#include <string.h>

#include "bench.h"

static const char help[] =
    "usage: corot-bench kernels [--json] [--tets N]... [--large]\n"
    "       corot-bench solvers [--json] [--most N] [--role ROLE]\n"
    "       corot-bench run [--json] [OPTIONS]\n"
    "       corot-bench frames [--json]\n"
    "       corot-bench memory [--json] [--tets N]\n"
    "       corot-bench phases [--json] [--tets N]... [--order N] [OPTIONS]\n"
    "       corot-bench threads [--json] [--threads N] [--tets N]... [--order N]\n"
    "       corot-bench hierarchy [--json] [--levels N]\n"
    "       corot-bench jitter [--json] [OPTIONS]\n"
    "       corot-bench local [--fraction F] [--within E]\n"
    "       corot-bench total [--json] [OPTIONS]\n"
    "       corot-bench peers [OPTIONS]\n"
    "\n"
    "kernels   forces, Jacobians and the rest, per tet, beside the floor set by memory and\n"
    "          arithmetic of this machine\n"
    "solvers   every linear solver at several sizes, and whether auto takes the best\n"
    "run       CPU time of a whole simulation and of its phases\n"
    "frames    what frames cost: polar over warp, update over force, Newton over linear\n"
    "memory    bytes per tet\n"
    "phases    wall time and memory of the phases of a run, by the number of tets\n"
    "threads   what threads gain, beside what the machine has to give\n"
    "hierarchy solvers that use the levels of a refined mesh, and the hierarchical basis\n"
    "jitter    how even the steps of an animation are in wall time\n"
    "local     unknowns for an accuracy, by local refinement and by uniform\n"
    "total     error of space and time together against CPU time, beside CalculiX\n"
    "peers     twelve problems by corot and by other programs: error against CPU time\n"
    "\n"
    "'corot-bench COMMAND --help' says more.\n"
    "\n"
    "example: corot-bench kernels\n";

int only_json(const char *program, const char *text, int argc, char **argv, bool *json) {
  static const struct option known[] = {
      {"json", no_argument, NULL, 'j'}, {"help", no_argument, NULL, 'h'}, {0}};
  *json = false;
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", known, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(text, stdout);
      return EXIT_OK;
    }
    if (answer != 'j') return option_error(program, answer, argv, known);
    *json = true;
  }
  if (optind < argc) return usage_error(program, "unexpected: %s", argv[optind]);
  return -1;
}

int main(int argc, char **argv) {
  static const command table[] = {{"kernels", command_kernels},
                                  {"solvers", command_solvers},
                                  {"run", command_example},
                                  {"frames", command_frames},
                                  {"memory", command_memory},
                                  {"phases", command_phases},
                                  {"threads", command_threads},
                                  {"hierarchy", command_hierarchy},
                                  {"jitter", command_jitter},
                                  {"local", command_local},
                                  {"total", command_total},
                                  {"peers", command_peers},
                                  {0}};
  return dispatch("corot-bench", help, table, argc, argv);
}
