/* `corot budget`: options, runs, text and page. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/command/cli.h"
#include "app/text/json_text.h"
#include "app/text/say.h"
#include "command_study.h"
#include "study/budget/budget.h"
#include "study/budget/budget_text.h"
#include "study/tables/report_page.h"
#include "variants_command.h"

static const char help[] =
    "usage: corot budget MODEL.yaml [--static] [-o DIR] [--set KEY=VALUE]... [-j N] [--quiet] "
    "[--json]\n"
    "\n"
    "How wrong is this run, and because of what? Takes away one approximation of a scenario after\n"
    "the other, and measures what each did to the displacement: the algebraic solver, the steps "
    "in\n"
    "time, the age and the rule of the frames, the hierarchy, the strain measure (against green),\n"
    "and the mesh: of four-node tets by order, against ten-node ones and these refined once, of\n"
    "ten-node tets by refinement, against what it and its next two octasections tend to. Says "
    "which\n"
    "part is the largest, and what to change first.\n"
    "\n"
    "Errors are relative to the largest displacement, in the norm of the mass; `alone` is that "
    "part\n"
    "with nothing else taken away, a bare difference; `cost` the CPU time without that\n"
    "approximation over that of the run as given. What is below ten times its reference's own "
    "error\n"
    "is shown as <most, what is known to be larger as >least, what is doubtful in parentheses, "
    "what\n"
    "is not known as ?. The table goes to stdout; budget.json, report.html and a folder for each "
    "run\n"
    "to DIR. Runs that are there already are not repeated. Exit code 1: some of the runs failed, "
    "so\n"
    "a part is missing.\n"
    "\n"
    "      --static         of the equilibrium, as corot static finds it: no part of time\n"
    "  -o, --output DIR     the folder, made if need be; default: out/MODEL-budget in this "
    "folder,\n"
    "                       with --static out/MODEL-static-budget\n"
    "      --set KEY=VALUE  overrides a key of the scenario; any number of times\n"
    "      --quantity Q     what each part does to a number of the run, too, such as "
    "max(corner.ux);\n"
    "                       any number of times, beside the scenario's own quantities\n"
    "      --skip PART      leaves a part out, by its name in the table: space, of a large mesh\n"
    "      --levels N       of the mesh: 2, the next one alone, which nothing checks, so the part\n"
    "                       is at least so large; 3, in any case; default: 3 where it takes "
    "minutes\n"
    "                       rather than hours\n"
    "  -j, --jobs N         so many runs at once; default: the number of processors\n"
    "      --timeout S      ends a run that takes longer than S seconds\n"
    "      --force          takes a folder that holds files of others by the names of corot's\n"
    "  -q, --quiet          nothing on stderr but errors\n"
    "      --json           budget.json on stdout in place of the table\n"
    "\n"
    "example: corot budget bar.yaml --set time.end=10 --set integrator.rtol=1e-3\n";

typedef struct arguments {
  budget_options options;
  variants_command command;
  int nquantity;
  quantity_option *quantity; /* [nquantity] with room for all arguments */
} arguments;

/* A run that failed leaves something open, but for one that was a mere try. */
static int complete(const json_t *budget) {
  const json_t *runs = json_object_get(budget, "runs"), *run;
  size_t i;
  int code = json_is_true(json_object_get(budget, "complete")) ? EXIT_OK : EXIT_CHECK;
  json_array_foreach(runs, i, run) {
    if (json_is_true(json_object_get(run, "spare"))) continue;
    if (strcmp(json_string_value(json_object_get(run, "status")), "done") != 0) code = EXIT_CHECK;
  }
  return code;
}

enum { SKIP = 'K', LEVELS = 'L', STATIC = 'S', QUANTITY = 'Q' };

static const struct option own[] = {{"skip", required_argument, NULL, SKIP},
                                    {"levels", required_argument, NULL, LEVELS},
                                    {"static", no_argument, NULL, STATIC},
                                    {"quantity", required_argument, NULL, QUANTITY},
                                    {0}};

static int take(void *context, int option, const char *value) {
  arguments *a = context;
  if (option == STATIC) {
    a->options.still = true;
    a->command.suffix = "-static-budget";
    return -1;
  }
  if (option == QUANTITY)
    return variants_take_quantity("corot budget", value, &a->quantity[a->nquantity++]);
  if (option == LEVELS) {
    if (parse_count(value, 3, &a->options.levels) && a->options.levels >= 2) return -1;
    return usage_error("corot budget", "--levels %s: expected 2 or 3", value);
  }
  for (int k = 0; k < BUDGET_KINDS; k++)
    if (strcmp(value, budget_names[k]) == 0) {
      a->options.skip[k] = true;
      return -1;
    }
  return usage_error("corot budget", "--skip %s: expected a part, such as space", value);
}

static corot_status write_budget(const void *budget, FILE *out) {
  budget_print(budget, out);
  return COROT_OK;
}

static int ask(void *context, variants_arguments *a) {
  const arguments *own_arguments = context;
  for (int i = 0; i < own_arguments->nquantity; i++)
    a->set[a->nset++] = own_arguments->quantity[i].setting;
  a->nasked = own_arguments->nquantity;
  return -1;
}

static int make_budget(void *context, const scenario *s, const variants_arguments *a) {
  const arguments *own_arguments = context;
  json_t *budget = NULL;
  int signal_number = 0;
  corot_status status = budget_make(s, a->nset, a->set, &own_arguments->options, &a->options,
                                    &budget, &signal_number);
  if (status != COROT_OK) return failure(variants_retell(a, status));
  if (signal_number) return variants_interrupted(signal_number);
  int code = complete(budget);
  if (a->json)
    status = json_text_show(budget);
  else
    status = show_all(write_budget, budget);
  json_decref(budget);
  if (status == COROT_OK) status = study_page(a->options.dir, a->options.quiet);
  return status == COROT_OK ? code : failure(status);
}

int command_budget(int argc, char **argv) {
  arguments a = {.command = {.program = "corot budget",
                             .help = help,
                             .suffix = "-budget",
                             .more = own,
                             .take = take,
                             .ready = ask,
                             .go = make_budget}};
  a.command.context = &a;
  a.quantity = calloc((size_t)argc, sizeof *a.quantity);
  if (!a.quantity) return failure(corot_fail(COROT_ENOMEM, "out of memory"));
  int code = variants_command_run(&a.command, argc, argv);
  free(a.quantity);
  return code;
}
