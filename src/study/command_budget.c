#include <stdio.h>
#include <string.h>

#include <app/cli.h>
#include <app/json_text.h>

#include "budget.h"
#include "command_study.h"
#include "page.h"
#include "variants_command.h"

static const char help[] =
    "usage: corot budget MODEL.yaml [-o DIR] [--set KEY=VALUE]... [-j N] [--quiet] [--json]\n"
    "\n"
    "How wrong is this run, and because of what? Takes away one approximation of a scenario after\n"
    "the other, and measures what each did to the displacement: the algebraic solver, the steps "
    "in\n"
    "time, the age and the rule of the frames, the hierarchy, the strain measure (against green),\n"
    "and the mesh (against the next octasection). Says which part is the largest, and what to\n"
    "change first.\n"
    "\n"
    "Errors are relative to the largest displacement, in the norm of the mass; `alone` is that "
    "part\n"
    "with nothing else taken away, `cost` the CPU time without that approximation over that of "
    "the\n"
    "run as given. The table goes to stdout; budget.json, report.html and a folder for each run "
    "to\n"
    "DIR. Runs that are there already are not repeated. Exit code 1: some of the runs failed.\n"
    "\n"
    "  -o, --output DIR     the folder, made if need be; default: out/MODEL-budget in this folder\n"
    "      --set KEY=VALUE  overrides a key of the scenario; any number of times\n"
    "      --skip PART      leaves a part out, by its name in the table: space, of a large mesh\n"
    "  -j, --jobs N         so many runs at once; default: the number of processors\n"
    "      --timeout S      ends a run that takes longer than S seconds\n"
    "  -q, --quiet          nothing on stderr but errors\n"
    "      --json           budget.json on stdout in place of the table\n"
    "\n"
    "example: corot budget bar.yaml --set time.end=10 --set integrator.rtol=1e-3\n";

static int complete(const json_t *budget) {
  const json_t *runs = json_object_get(budget, "runs"), *run;
  size_t i;
  int code = EXIT_OK;
  json_array_foreach(runs, i, run) {
    if (strcmp(json_string_value(json_object_get(run, "status")), "done") != 0) code = EXIT_CHECK;
  }
  return code;
}

static const struct option own[] = {{"skip", required_argument, NULL, 'K'}, {0}};

static int take(void *context, int option, const char *value) {
  (void)option;
  bool *skip = context;
  for (int k = 0; k < BUDGET_KINDS; k++)
    if (strcmp(value, budget_names[k]) == 0) {
      skip[k] = true;
      return -1;
    }
  return usage_error("corot budget", "--skip %s: expected a part, such as space", value);
}

static int make_budget(void *context, const scenario *s, const variants_arguments *a) {
  const bool *skip = context;
  json_t *budget = NULL;
  int signal_number = 0;
  corot_status status = budget_make(s, a->nset, a->set, skip, &a->options, &budget, &signal_number);
  if (status != COROT_OK) return failure(status);
  if (signal_number) return variants_interrupted(signal_number);
  int code = complete(budget);
  if (a->json)
    status = json_text_show(budget);
  else
    budget_print(budget, stdout);
  json_decref(budget);
  if (status == COROT_OK) status = study_page(a->options.dir, a->options.quiet);
  return status == COROT_OK ? code : failure(status);
}

int command_budget(int argc, char **argv) {
  bool skip[BUDGET_KINDS] = {false};
  const variants_command c = {.program = "corot budget",
                              .help = help,
                              .suffix = "-budget",
                              .more = own,
                              .take = take,
                              .go = make_budget,
                              .context = skip};
  return variants_command_run(&c, argc, argv);
}
