/* Options, and the message of an interruption. */
#include "variants_command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/command/cli.h"
#include "app/folder/folder.h"
#include "study/execute/pool.h"

enum { FORCE = 300 }; /* commands have letters of their own */

static const struct option common[] = {
    {"output", required_argument, NULL, 'o'}, {"set", required_argument, NULL, 's'},
    {"jobs", required_argument, NULL, 'j'},   {"quiet", no_argument, NULL, 'q'},
    {"json", no_argument, NULL, 'J'},         {"timeout", required_argument, NULL, 'T'},
    {"force", no_argument, NULL, FORCE},      {"help", no_argument, NULL, 'h'},
};

enum { NCOMMON = sizeof common / sizeof *common, NOPTION = 32 };

/* --- Arguments --- */

/* -1, or an exit code. */
static int take_option(const variants_command *c, int answer, char **argv,
                       const struct option *known, variants_arguments *a) {
  switch (answer) {
    case 'o':
      a->options.dir = optarg;
      return *optarg ? -1 : usage_error(c->program, "--output: the name is empty");
    case 's':
      a->set[a->nset++] = optarg;
      return -1;
    case 'j':
      if (parse_count(optarg, POOL_MAX, &a->options.njob)) return -1;
      return usage_error(c->program, "--jobs %s: expected 1 to %d", optarg, POOL_MAX);
    case 'T':
      if (parse_positive(optarg, &a->options.timeout)) return -1;
      return usage_error(c->program, "--timeout %s: expected seconds > 0", optarg);
    case FORCE:
      a->options.force = true;
      return -1;
    case 'q':
      a->options.quiet = true;
      return -1;
    case 'J':
      a->json = true;
      return -1;
    case 'h':
      fputs(c->help, stdout);
      return EXIT_OK;
    case '?':
    case ':':
      return option_error(c->program, answer, argv, known);
    default:
      return c->take(c->context, answer, optarg);
  }
}

static int go(const variants_command *c, const char *path, variants_arguments *a) {
  scenario *s = NULL;
  corot_status status = scenario_read(path, a->nset, (char *const *)a->set, &s);
  status = read_failure(status, path);
  if (status != COROT_OK) return failure(variants_retell(a, status));
  char *folder = a->options.dir ? NULL : folder_default(path, c->suffix);
  if (folder) a->options.dir = folder;
  int code = a->options.dir ? c->go(c->context, s, a) : failure(COROT_ENOMEM);
  free(folder);
  scenario_destroy(s);
  return code;
}

int variants_command_run(const variants_command *c, int argc, char **argv) {
  variants_arguments a = {.options = execute_defaults()};
  a.set = calloc((size_t)argc + 1, sizeof *a.set);
  if (!a.set) return failure(corot_fail(COROT_ENOMEM, "out of memory"));

  struct option all[NOPTION] = {0};
  memcpy(all, common, sizeof common);
  for (int i = 0; c->more && c->more[i].name && NCOMMON + i < NOPTION - 1; i++)
    all[NCOMMON + i] = c->more[i];
  int code = -1;
  opterr = 0;
  for (int answer; code < 0 && (answer = getopt_long(argc, argv, ":o:j:qh", all, NULL)) != -1;)
    code = take_option(c, answer, argv, all, &a);
  if (code < 0 && argc - optind != 1)
    code = usage_error(c->program, "expected one scenario, found %d", argc - optind);
  if (code < 0 && c->ready) code = c->ready(c->context, &a);
  if (code < 0) code = go(c, argv[optind], &a);
  free(a.set);
  return code;
}

int variants_take_quantity(const char *program, const char *text, quantity_option *out) {
  return variants_take_option(program, "--quantity", text, out);
}

int variants_take_option(const char *program, const char *option, const char *text,
                         quantity_option *out) {
  quantity q;
  size_t at;
  if (quantity_parse(text, &q, &at) != COROT_OK) {
    quantity_point(option, text, at);
    return usage_error(program, "%s", corot_error());
  }
  quantity_print(&q, out->text);
  quantity_name(&q, out->name);
  snprintf(out->setting, sizeof out->setting, "quantities.%s=%s", out->name, out->text);
  return -1;
}

corot_status variants_retell(const variants_arguments *a, corot_status status) {
  static const char head[] = "--set ";
  const char *said = corot_error() + strlen(head);
  if (status == COROT_OK || strncmp(corot_error(), head, strlen(head)) != 0) return status;
  for (int i = a->nset - a->nasked; i < a->nset; i++) {
    size_t length = strcspn(a->set[i], "=") + 1;
    if (strncmp(said, a->set[i], length) == 0)
      return corot_fail(status, "%s %s", a->asked_by ? a->asked_by : "--quantity", said + length);
  }
  return status;
}

int variants_interrupted(int signal_number) {
  fputs("interrupted; the same command goes on from here\n", stderr);
  return 128 + signal_number;
}
