/* `corot solve`: a quantity and an error, and the number with its interval. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/command/cli.h"
#include "app/text/json_text.h"
#include "app/text/say.h"
#include "command_study.h"
#include "study/goal/goal.h"
#include "study/goal/goal_text.h"
#include "study/tables/report_page.h"
#include "variants_command.h"

static const char help[] =
    "usage: corot solve MODEL.yaml --goal QUANTITY --within ERROR [--within-abs] [--static] [-o "
    "DIR]\n"
    "                   [--cpu-limit S] [--exact-model] [--set KEY=VALUE]... [-j N] [--json]\n"
    "\n"
    "A number, and an interval that the truth is in. Runs the scenario on ever finer meshes of\n"
    "ten-node tets, refined where it pays, by a method and a tolerance that are chosen for it, "
    "until\n"
    "the errors of space, time and algebra together are less than what was asked for. The truth "
    "is\n"
    "that of the scenario's own strain measure; how far that is from green is measured, too, and\n"
    "counts with --exact-model. Frames are found in every evaluation, without a hierarchy.\n"
    "\n"
    "The answer goes to stdout; solve.json, report.html, which shows why, and a folder for each "
    "run\n"
    "to DIR. Runs that are there already are not repeated: to ask for less error goes on from "
    "there.\n"
    "Exit code 1: the goal was not met; the best interval is shown, and what stands in the way.\n"
    "\n"
    "      --goal QUANTITY  such as max(corner.ux), corner.ux@end, mean(wall.fx, 1, 2): a number "
    "out\n"
    "                       of the columns of probes and energies; see the README for all of them\n"
    "      --within ERROR   relative, 0.01 for one per cent; above 0 and below 1\n"
    "      --within-abs     ERROR is in the quantity's own unit\n"
    "      --static         of the equilibrium, as corot static finds it\n"
    "      --exact-model    the truth is that of green: the strain measure counts\n"
    "      --cpu-limit S    ends where the next run would take more than S seconds of CPU in all;\n"
    "                       default: 3600\n"
    "  -o, --output DIR     the folder, made if need be; default: out/MODEL-solve in this folder,\n"
    "                       with --static out/MODEL-static-solve\n"
    "      --set KEY=VALUE  overrides a key of the scenario; any number of times\n"
    "  -j, --jobs N         so many runs at once; default: the number of processors\n"
    "      --timeout S      ends a run that takes longer than S seconds\n"
    "      --force          takes a folder that holds files of others by the names of corot's\n"
    "  -q, --quiet          nothing on stderr but errors\n"
    "      --json           solve.json on stdout in place of the text\n"
    "\n"
    "example: corot solve models/bar/bar.yaml --goal 'max(corner.ux)' --within 0.01\n";

typedef struct arguments {
  goal_request request;
  variants_command command;
  quantity_option goal;
  bool asked, bounded;
  quantity quantity;
} arguments;

enum { GOAL = 'G', WITHIN = 'W', ABSOLUTE = 'A', STATIC = 'S', EXACT = 'E', LIMIT = 'L' };

static const struct option own[] = {{"goal", required_argument, NULL, GOAL},
                                    {"within", required_argument, NULL, WITHIN},
                                    {"within-abs", no_argument, NULL, ABSOLUTE},
                                    {"static", no_argument, NULL, STATIC},
                                    {"exact-model", no_argument, NULL, EXACT},
                                    {"cpu-limit", required_argument, NULL, LIMIT},
                                    {0}};

static int take(void *context, int option, const char *value) {
  arguments *a = context;
  switch (option) {
    case GOAL:
      a->asked = true;
      return variants_take_option("corot solve", "--goal", value, &a->goal);
    case WITHIN:
      a->bounded = parse_positive(value, &a->request.within);
      if (a->bounded) return -1;
      return usage_error("corot solve", "--within %s: expected a number > 0, 0.01 for 1 %%", value);
    case ABSOLUTE:
      a->request.absolute = true;
      return -1;
    case STATIC:
      a->request.still = true;
      a->command.suffix = "-static-solve";
      return -1;
    case EXACT:
      a->request.exact_model = true;
      return -1;
    default:
      if (parse_positive(value, &a->request.cpu_limit)) return -1;
      return usage_error("corot solve", "--cpu-limit %s: expected seconds > 0", value);
  }
}

static int ready(void *context, variants_arguments *v) {
  arguments *a = context;
  if (!a->asked)
    return usage_error("corot solve", "--goal is missing, such as --goal 'max(corner.ux)'");
  if (!a->bounded)
    return usage_error("corot solve", "--within is missing, such as --within 0.01 for 1 %%");
  if (!a->request.absolute && a->request.within >= 1)
    return usage_error("corot solve",
                       "--within %g: expected a fraction below 1 of the value, 0.01 for 1 %%; with "
                       "--within-abs it is in the quantity's unit",
                       a->request.within);
  v->set[v->nset++] = a->goal.setting;
  v->nasked = 1;
  v->asked_by = "--goal";
  return -1;
}

static corot_status write_answer(const void *solved, FILE *out) {
  goal_print(solved, out);
  return COROT_OK;
}

/* What the exit code says of an answer. */
static int code_of(const goal_result *r) {
  if (r->met) return EXIT_OK;
  if (r->exit_code) return r->exit_code;
  return r->senseless ? EXIT_SCENARIO : EXIT_CHECK;
}

static int solve(void *context, const scenario *s, const variants_arguments *v) {
  arguments *a = context;
  size_t at;
  if (quantity_parse(a->goal.text, &a->quantity, &at) != COROT_OK) return failure(COROT_EFORMAT);
  a->request.quantity = &a->quantity;
  a->request.text = a->goal.text;
  a->request.name = a->goal.name;
  goal_result result;
  json_t *solved = NULL;
  int signal_number = 0;
  corot_status status =
      goal_solve(&a->request, s, v->nset, v->set, &v->options, &result, &solved, &signal_number);
  if (status != COROT_OK) return failure(status);
  if (signal_number) return variants_interrupted(signal_number);
  if (v->json)
    status = json_text_show(solved);
  else if (!result.senseless)
    status = show_all(write_answer, solved);
  if (result.senseless) say("corot solve: %s\n", result.obstacle);
  json_decref(solved);
  if (status == COROT_OK) status = study_page(v->options.dir, v->options.quiet || result.senseless);
  return status == COROT_OK ? code_of(&result) : failure(status);
}

int command_solve(int argc, char **argv) {
  arguments a = {.request = {.cpu_limit = 3600},
                 .command = {.program = "corot solve",
                             .help = help,
                             .suffix = "-solve",
                             .more = own,
                             .take = take,
                             .ready = ready,
                             .go = solve}};
  a.command.context = &a;
  return variants_command_run(&a.command, argc, argv);
}
