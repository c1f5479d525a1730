/* `corot run`: options, then run_scenario(). */
#include "cli.h"
#include "command_scenario.h"

static const char help[] =
    "usage: corot run MODEL.yaml [-o DIR] [--set KEY=VALUE]... [--resume] [--force] [--quiet]\n"
    "                 [--json] [--lean]\n"
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
    "      --resume         goes on from the checkpoint in the folder, to the last bit as if "
    "nothing\n"
    "                       had ended the run; begins where there is none; does nothing where the "
    "run\n"
    "                       is done: a batch script may always say it\n"
    "      --force          replaces files of others, too, and a checkpoint that --resume cannot "
    "use\n"
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
    "A scenario with the key checkpoint (corot schema checkpoint) leaves checkpoint.bin in the "
    "folder\n"
    "while it runs, and when it is ended from outside. A folder with one is refused to a run "
    "without\n"
    "--resume or --force; a checkpoint that is damaged, or of another scenario, mesh or program, "
    "with\n"
    "exit code 3, and nothing is changed.\n"
    "\n"
    "example: corot run bar.yaml -o out/fine --set integrator.rtol=1e-6 --set time.end=10\n"
    "         corot run bar.yaml -o out/long --set checkpoint='10 min' --resume\n";

static int take(const char *program, int option, const char *value, run_options *o) {
  (void)program, (void)value;
  if (option == 'l') o->lean = true;
  if (option == 'r') o->resume = true;
  return -1;
}

int command_run(int argc, char **argv) {
  static const struct option more[] = {{"lean", no_argument, NULL, 'l'},
                                       {"resume", no_argument, NULL, 'r'}};
  static const scenario_command run = {"corot run", "", help, run_scenario, ":o:qh", 2, more, take};
  return command_scenario_with(&run, (run_options){.progress = true}, argc, argv);
}
