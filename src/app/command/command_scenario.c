/* The options of `corot run` and `corot static`, taken from the command line. */
#include "command_scenario.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/run/run_common.h"
#include "app/run/stop.h"
#include "cli.h"

static const struct option options[] = {
    {"output", required_argument, NULL, 'o'}, {"set", required_argument, NULL, 's'},
    {"quiet", no_argument, NULL, 'q'},        {"json", no_argument, NULL, 'j'},
    {"force", no_argument, NULL, 'f'},        {"lean", no_argument, NULL, 'l'},
    {"help", no_argument, NULL, 'h'},         {0},
};

static int read_and_go(scenario_action *go, const char *path, const char *suffix, int noverride,
                       char **override, run_options *o) {
  char *folder = o->dir ? NULL : folder_default(path, suffix);
  if (folder) o->dir = folder;
  if (!o->dir) return failure(COROT_ENOMEM);
  scenario *s = NULL;
  corot_status status = scenario_read(path, noverride, override, &s);
  status = read_failure(status, path);
  int code;
  if (status == COROT_OK) {
    stop_heed();
    code = go(s, o);
  } else {
    code = failure(status);
    run_end_unread(path, o, status, code);
  }
  free(folder);
  scenario_destroy(s);
  return code;
}

int command_scenario(const char *program, const char *suffix, const char *help, scenario_action *go,
                     int argc, char **argv) {
  run_options o = {.progress = true};
  char **override = calloc((size_t)argc, sizeof *override);
  if (!override) return failure(corot_fail(COROT_ENOMEM, "out of memory"));
  int noverride = 0, code = -1;
  opterr = 0;
  for (int answer; code < 0 && (answer = getopt_long(argc, argv, ":o:qh", options, NULL)) != -1;) {
    if (answer == 'o')
      o.dir = optarg;
    else if (answer == 's')
      override[noverride++] = optarg;
    else if (answer == 'q')
      o.quiet = true, o.progress = false;
    else if (answer == 'j')
      o.json = true;
    else if (answer == 'f')
      o.force = true;
    else if (answer == 'l')
      o.lean = true;
    else if (answer == 'h')
      fputs(help, stdout), code = EXIT_OK;
    else
      code = option_error(program, answer, argv, options);
  }
  /* no code so far: there is a scenario to carry out */
  if (code < 0 && argc - optind != 1)
    code = usage_error(program, "expected one scenario, found %d", argc - optind);
  if (code < 0 && o.dir && !*o.dir) code = usage_error(program, "--output: the name is empty");
  if (code < 0) code = read_and_go(go, argv[optind], suffix, noverride, override, &o);
  free(override);
  return code;
}
