/* `corot modes`: options, then the search for eigenmodes. */
#include <string.h>

#include "app/run/modal.h"
#include "cli.h"
#include "command_scenario.h"

static const char help[] =
    "usage: corot modes MODEL.yaml [-n N] [--about WHAT] [-o DIR] [--set KEY=VALUE]... [--force]\n"
    "                   [--quiet] [--json]\n"
    "\n"
    "Finds the lowest eigenfrequencies of a body and its modes, the shapes of its small "
    "vibrations\n"
    "without damping, about rest or about an equilibrium, where stress and pressure are a part of\n"
    "the stiffness: a column sounds lower the nearer its load is to the one that buckles it. It\n"
    "writes modes.csv with a row for each (mode, frequency [Hz], and more), the shapes for "
    "ParaView\n"
    "(fields.pvd; the number of the mode in place of the time), and result.json.\n"
    "\n"
    "Rigid motions that no support hinders have frequency 0, as has all that is rounding of the\n"
    "highest frequency (zero_below in result.json). Of an unstable equilibrium the modes that "
    "grow\n"
    "come first, with their rate in the column growth.\n"
    "\n"
    "  -n, --number N       how many; default: 10\n"
    "      --about WHAT     rest: the undeformed body, without loads;\n"
    "                       equilibrium: the one of corot static, under the loads of time.end;\n"
    "                       start (default): where a run begins: with start: equilibrium the one\n"
    "                       under the loads of t = 0, else rest. Velocities do not count\n"
    "  -o, --output DIR     the folder, made if need be; default: out/MODEL-modes here\n"
    "      --set KEY=VALUE  overrides a key of the scenario; any number of times\n"
    "      --force          replaces files that corot has not written, too; see corot run --help\n"
    "  -q, --quiet          nothing on stderr but errors\n"
    "      --json           result.json on stdout as well\n"
    "\n"
    "example: corot modes bar.yaml -n 4 --set mesh.order=2\n";

enum { MOST_MODES = 10000 };

static int take_number(const char *program, const char *value, run_options *o) {
  if (parse_count(value, MOST_MODES, &o->nmode)) return -1;
  return usage_error(program, "--number: %s is not a whole number from 1 to %d", value, MOST_MODES);
}

static int take_about(const char *program, const char *value, run_options *o) {
  static const char *const word[] = {"start", "rest", "equilibrium"};
  for (int k = 0; k < 3; k++)
    if (strcmp(value, word[k]) == 0) {
      o->about = (modes_about)k;
      return -1;
    }
  return usage_error(program, "--about: %s is neither rest, equilibrium nor start", value);
}

static int take(const char *program, int answer, const char *value, run_options *o) {
  return answer == 'n' ? take_number(program, value, o) : take_about(program, value, o);
}

int command_modes(int argc, char **argv) {
  static const struct option more[] = {{"number", required_argument, NULL, 'n'},
                                       {"about", required_argument, NULL, 'a'}};
  static const scenario_command modes = {
      .program = "corot modes",
      .suffix = "-modes",
      .help = help,
      .go = modal_scenario,
      .letters = ":o:qhn:",
      .nmore = 2,
      .more = more,
      .take = take,
  };
  return command_scenario_with(&modes, (run_options){.nmode = 10}, argc, argv);
}
