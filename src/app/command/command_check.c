/* `corot check`: what a scenario amounts to, and what is doubtful about it, without a run. */
#include <stdio.h>
#include <stdlib.h>

#include "app/run/quantities.h"
#include "app/scenario/facts.h"
#include "app/text/json_text.h"
#include "app/text/say.h"
#include "cli.h"

static const char help[] =
    "usage: corot check MODEL.yaml [--set KEY=VALUE]... [--resolved | --json]\n"
    "\n"
    "Reads a scenario and its mesh, builds the model and starts the integrator, as a run would;\n"
    "says what is wrong (exit code 3), or what it amounts to: sizes, masses, groups, choices.\n"
    "\n"
    "      --set KEY=VALUE  overrides a key of the scenario; any number of times\n"
    "      --resolved       the whole scenario with all defaults and overrides, as JSON, which is\n"
    "                       YAML as well; paths remain relative to the scenario's folder\n"
    "      --json           the facts as JSON\n"
    "      --warnings       the codes of warnings, and when each is given; no scenario is read\n"
    "\n"
    "example: corot check bar.yaml --set strain=green\n";

static const struct option options[] = {
    {"set", required_argument, NULL, 's'}, {"resolved", no_argument, NULL, 'r'},
    {"json", no_argument, NULL, 'j'},      {"warnings", no_argument, NULL, 'w'},
    {"help", no_argument, NULL, 'h'},      {0},
};

typedef enum report { REPORT_TEXT, REPORT_RESOLVED, REPORT_JSON } report;

typedef struct found {
  const scenario *scenario;
  const facts *facts;
} found;

static corot_status write_facts(const void *what, FILE *out) {
  const found *f = what;
  facts_print(f->scenario, f->facts, out);
  return COROT_OK;
}

static int print_report(const scenario *s, const facts *f, report kind) {
  corot_status status;
  if (kind == REPORT_TEXT) {
    status = show_all(write_facts, &(found){s, f});
  } else {
    json_t *value = kind == REPORT_JSON ? facts_json(s, f) : json_incref(s->resolved);
    status = json_text_show(value);
    json_decref(value);
  }
  return status == COROT_OK ? EXIT_OK : failure(status);
}

static int check(const char *path, int noverride, char **override, report kind) {
  scenario *s = NULL;
  facts f = {0};
  corot_status status = scenario_read(path, noverride, override, &s);
  status = read_failure(status, path);
  if (status == COROT_OK) status = facts_find(s, &f);
  if (status == COROT_OK) status = quantities_check(s, f.model, false);
  int code = status == COROT_OK ? print_report(s, &f, kind) : failure(status);
  facts_free(&f);
  scenario_destroy(s);
  return code;
}

static void print_codes(void) {
  for (int i = 0; i < WARNING_CODES; i++)
    printf("%-22s %s\n", warning_kinds[i].word, warning_kinds[i].about);
}

int command_check(int argc, char **argv) {
  char **override = calloc((size_t)argc, sizeof *override);
  if (!override) return failure(corot_fail(COROT_ENOMEM, "out of memory"));
  int noverride = 0, code = -1;
  report kind = REPORT_TEXT;
  opterr = 0;
  for (int answer; code < 0 && (answer = getopt_long(argc, argv, ":h", options, NULL)) != -1;) {
    if (answer == 's')
      override[noverride++] = optarg;
    else if (answer == 'r')
      kind = REPORT_RESOLVED;
    else if (answer == 'j')
      kind = REPORT_JSON;
    else if (answer == 'w')
      print_codes(), code = EXIT_OK;
    else if (answer == 'h')
      fputs(help, stdout), code = EXIT_OK;
    else
      code = option_error("corot check", answer, argv, options);
  }
  /* no code so far: there is a scenario to look at */
  if (code < 0 && argc - optind != 1)
    code = usage_error("corot check", "expected one scenario, found %d", argc - optind);
  if (code < 0) code = check(argv[optind], noverride, override, kind);
  free(override);
  return code;
}
