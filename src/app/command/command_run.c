/* `corot run`: options, then run_scenario(). */
#include "cli.h"
#include "command_scenario.h"

static const char help[] =
    "usage: corot run MODEL.yaml [-o DIR] [--set KEY=VALUE]... [--force] [--quiet] [--json]\n"
    "                 [--lean]\n"
    "\n"
    "Integrates a scenario (YAML, or JSON) and writes probes.csv and energy.csv (output times),\n"
    "history.csv (both at every step), steps.csv, compare.csv and states.bin (if the scenario "
    "asks\n"
    "for them), fields for ParaView (fields.pvd) and result.json to a folder. What whoever uses "
    "the\n"
    "answer should know it says in warnings, on stderr and in result.json.\n"
    "\n"
    "  -o, --output DIR     the folder, made if need be; default: out/MODEL in this folder\n"
    "      --set KEY=VALUE  overrides a key of the scenario; any number of times\n"
    "      --force          replaces files of others, too\n"
    "  -q, --quiet          nothing on stderr but errors\n"
    "      --lean           takes no time for what is not asked for: output.space_error: auto is "
    "false\n"
    "      --json           result.json on stdout as well\n"
    "\n"
    "Files of an earlier run in the folder are replaced; of a run that fails, too: its result.json "
    "says\n"
    "so. If no run has left the folder (by its result.json, or the lock of one that was killed), a "
    "file\n"
    "there with a name of the above, or report.html, is somebody else's: the run is refused with "
    "exit\n"
    "code 5, unless --force is given. Files of other names stay. Exit code 1: all is well, but one "
    "of\n"
    "the scenario's quantities has no value, as the period of what does not oscillate.\n"
    "\n"
    "example: corot run bar.yaml -o out/fine --set integrator.rtol=1e-6 --set time.end=10\n";

int command_run(int argc, char **argv) {
  return command_scenario("corot run", "", help, run_scenario, argc, argv);
}
