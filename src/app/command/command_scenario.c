/* The options of `corot run`, `corot static` and `corot modes`, taken from the command line. */
#include "command_scenario.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/run/run_common.h"
#include "app/run/stop.h"
#include "cli.h"

static const struct option common[] = {
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

enum { NCOMMON = sizeof common / sizeof *common }; /* its end included */

/* One option; -1, or the code to end with. */
static int take_option(const scenario_command *c, int answer, char **argv, const struct option *all,
                       run_options *o, int *noverride, char **override) {
  switch (answer) {
    case 'o':
      o->dir = optarg;
      return -1;
    case 's':
      override[(*noverride)++] = optarg;
      return -1;
    case 'q':
      o->quiet = true, o->progress = false;
      return -1;
    case 'j':
      o->json = true;
      return -1;
    case 'f':
      o->force = true;
      return -1;
    case 'l':
      o->lean = true;
      return -1;
    case 'h':
      fputs(c->help, stdout);
      return EXIT_OK;
  }
  for (int k = 0; k < c->nmore; k++)
    if (answer == c->more[k].val) return c->take(c->program, answer, optarg, o);
  return option_error(c->program, answer, argv, all);
}

int command_scenario(const char *program, const char *suffix, const char *help, scenario_action *go,
                     int argc, char **argv) {
  const scenario_command plain = {program, suffix, help, go, ":o:qh", 0, NULL, NULL};
  return command_scenario_with(&plain, (run_options){.progress = true}, argc, argv);
}

int command_scenario_with(const scenario_command *c, run_options o, int argc, char **argv) {
  struct option options[MOST_MORE + NCOMMON];
  if (c->nmore) memcpy(options, c->more, (size_t)c->nmore * sizeof *options);
  memcpy(options + c->nmore, common, sizeof common);
  char **override = calloc((size_t)argc, sizeof *override);
  if (!override) return failure(corot_fail(COROT_ENOMEM, "out of memory"));
  int noverride = 0, code = -1;
  opterr = 0;
  for (int answer; code < 0 && (answer = getopt_long(argc, argv, c->letters, options, NULL)) != -1;)
    code = take_option(c, answer, argv, options, &o, &noverride, override);
  /* no code so far: there is a scenario to carry out */
  if (code < 0 && argc - optind != 1)
    code = usage_error(c->program, "expected one scenario, found %d", argc - optind);
  if (code < 0 && o.dir && !*o.dir) code = usage_error(c->program, "--output: the name is empty");
  if (code < 0) code = read_and_go(c->go, argv[optind], c->suffix, noverride, override, &o);
  free(override);
  return code;
}
