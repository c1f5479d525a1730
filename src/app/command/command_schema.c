/* `corot schema`: the table of keys as text, JSON Schema or an example. */
#include <stdio.h>

#include "app/scenario/scenario_keys.h"
#include "app/text/json_text.h"
#include "app/text/suggest.h"
#include "cli.h"

static const char help[] =
    "usage: corot schema [KEY] [--json]\n"
    "\n"
    "Every key a scenario may have, or those under KEY: type and range, unit, default, meaning.\n"
    "NAME stands for a name of your own, [] for each entry of a list; \"one of\": exactly one of\n"
    "the keys so marked is given; words after \"not yet\" are known, but not supported yet.\n"
    "\n"
    "A file has at most 16 MiB, 1000000 values (maps and lists are values, too), 10000 keys in "
    "one\n"
    "map (so that many probes, or groups) and 32 levels of nesting; a table of an amplitude 256 "
    "MiB;\n"
    "the name of a group 127 bytes.\n"
    "\n"
    "A number of a key with a unit may have another unit of the kind behind it: 20 ms, 2 MPa, 5 "
    "mm,\n"
    "1 g/cm^3, 9.81 m/s^2, 30 deg, 2 Pa*s. Units are m, s, g, N, Pa, bar, J, W, Hz and rad, with "
    "n,\n"
    "u, m, c, d, k, M, G and T before them, and deg, rev, rpm, min, h, t, l, P, cP, in, ft, lb, "
    "lbf\n"
    "and psi. Hz is no rad/s. Results are in SI.\n"
    "\n"
    "      --json           all of it as a JSON Schema, such as editors use\n"
    "\n"
    "example: corot schema integrator\n";

static const struct option options[] = {
    {"json", no_argument, NULL, 'j'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

static int print_json(void) {
  json_t *text = schema_json();
  corot_status status = json_text_show(text);
  json_decref(text);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

static int no_such_key(const char *typed) {
  const char *path[256];
  int n = 0;
  for (; n < scenario_schema.nkey && n < 256; n++) path[n] = scenario_schema.key[n].path;
  const char *near = suggest(typed, n, path);
  if (near) return usage_error("corot schema", "no key %s; did you mean %s?", typed, near);
  return usage_error("corot schema", "no key %s", typed);
}

int command_schema(int argc, char **argv) {
  bool json = false;
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", options, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    if (answer != 'j') return option_error("corot schema", answer, argv, options);
    json = true;
  }
  if (argc - optind > 1) return usage_error("corot schema", "expected at most one key");
  if (json && optind < argc) return usage_error("corot schema", "--json prints all keys");
  if (json) return print_json();
  const char *prefix = optind < argc ? argv[optind] : "";
  return schema_print(&scenario_schema, prefix, stdout) ? EXIT_OK : no_such_key(prefix);
}
