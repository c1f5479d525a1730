/* `corot tune`: measures what linear solvers cost here, for runs to choose by. */
#include <stdio.h>
#include <stdlib.h>

#include "app/scenario/costs_file.h"
#include "app/text/say.h"
#include "cli.h"

static const char help[] =
    "usage: corot tune [--show]\n"
    "\n"
    "Measures what factors, solutions and iterations of linear systems cost on this machine, in "
    "some\n"
    "ten seconds in which it should have nothing else to do, and writes that to corot/costs.json "
    "in\n"
    "the folder of your configuration ($XDG_CONFIG_HOME, or ~/.config). All commands that are "
    "left\n"
    "to choose a linear solver (linear_solver.name: auto) choose by it from then on, and say in\n"
    "result.json which one they took. Without the file they go by a machine of ours.\n"
    "\n"
    "A solver changes the last digits of a result, so that a run repeats to the last digit only "
    "with\n"
    "the same costs, or with a solver named in the scenario.\n"
    "\n"
    "      --show           prints what the choice goes by now, and measures nothing\n"
    "\n"
    "example: corot tune\n";

static const struct option options[] = {
    {"show", no_argument, NULL, 's'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

static void print(const corot_linear_costs *now, const corot_linear_costs *usual) {
  const struct {
    const char *words;
    double now, usual;
  } row[] = {
      {"a multiplication in a factorisation", now->operation, usual->operation},
      {"an entry of the factor, made", now->made, usual->made},
      {"the same, in a solution", now->solved, usual->solved},
      {"an entry of the matrix, in an incomplete factor", now->incomplete, usual->incomplete},
      {"the same, in an iteration with it", now->iterated, usual->iterated},
      {"the same, in the set-up of multigrid", now->aggregated, usual->aggregated},
      {"the same, in an iteration with that", now->cycled, usual->cycled},
  };
  printf("%-50s %9s %9s\n", "cost [ns]", "here", "usual");
  for (size_t k = 0; k < sizeof row / sizeof *row; k++)
    printf("%-50s %9.3g %9.3g\n", row[k].words, row[k].now, row[k].usual);
}

static corot_status show_costs(void) {
  corot_linear_costs usual = corot_linear_costs_usual(), now = usual;
  bool found;
  COROT_TRY(costs_file_read(&now, &found));
  print(&now, &usual);
  if (!found) puts("(the usual ones: nothing has been measured)");
  return COROT_OK;
}

static corot_status tune(const char *path) {
  corot_linear_costs usual = corot_linear_costs_usual(), now;
  COROT_TRY(corot_linear_costs_measure(&now));
  COROT_TRY(costs_file_write(path, &now));
  print(&now, &usual);
  say("written to %s\n", path);
  return COROT_OK;
}

static corot_status measure_and_store(void) {
  char *path;
  COROT_TRY(costs_file_path(&path));
  corot_status status =
      path ? tune(path)
           : corot_fail(COROT_EIO, "nowhere to write: HOME and XDG_CONFIG_HOME name no folder");
  free(path);
  return status;
}

int command_tune(int argc, char **argv) {
  bool only = false;
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", options, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    if (answer != 's') return option_error("corot tune", answer, argv, options);
    only = true;
  }
  if (optind < argc) return usage_error("corot tune", "unexpected: %s", argv[optind]);
  corot_status status = only ? show_costs() : measure_and_store();
  return status ? failure(status) : EXIT_OK;
}
