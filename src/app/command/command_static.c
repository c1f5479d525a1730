/* `corot static`: options, then the search for an equilibrium. */
#include "app/run/static.h"
#include "cli.h"
#include "command_scenario.h"

static const char help[] =
    "usage: corot static MODEL.yaml [-o DIR] [--set KEY=VALUE]... [--force] [--quiet]\n"
    "                    [--json] [--lean]\n"
    "\n"
    "Finds the equilibrium of a scenario under its full loads, those of time.end, by load steps,\n"
    "and writes the folder that a run would leave: a row of probes.csv, energy.csv and steps.csv\n"
    "for each load step, the last one the equilibrium, reactions.csv with the forces of the\n"
    "supports, fields for ParaView, and result.json. The column t is the load factor times\n"
    "time.end; supports stand where they are at that time.\n"
    "\n"
    "Each load step is told on stderr with the residual of each Newton iteration, relative to the\n"
    "largest force on a node. Exit code 4: there is no equilibrium within reach, or it becomes\n"
    "unstable (the body buckles) at the load factor that is named.\n"
    "\n"
    "  -o, --output DIR     the folder, made if need be; default: out/MODEL-static here\n"
    "      --set KEY=VALUE  overrides a key of the scenario; any number of times\n"
    "      --force          replaces files that corot has not written, too; see corot run --help\n"
    "  -q, --quiet          nothing on stderr but errors\n"
    "      --lean           takes no time for what is not asked for; see corot run --help\n"
    "      --json           result.json on stdout as well\n"
    "\n"
    "example: corot static bar.yaml -o out/hanging --set statics.max_step=0.1\n";

int command_static(int argc, char **argv) {
  return command_scenario("corot static", "-static", help, static_scenario, argc, argv);
}
