/* Finds the command of a line, and takes apart what its arguments share. */
#include "cli.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/text/say.h"
#include "app/text/suggest.h"

enum { MOST_NAMES = 32 }; /* that a mistyped one is held against */

int usage_error(const char *program, const char *format, ...) {
  va_list args;
  va_start(args, format);
  say_head(program);
  say_to(stderr, format, args);
  say("\nTry '%s --help'.\n", program);
  va_end(args);
  return EXIT_USAGE;
}

int option_error(const char *program, int answer, char **argv, const struct option *known) {
  const char *given = argv[optind - 1];
  if (answer == ':') return usage_error(program, "%s needs a value", given);
  if (strncmp(given, "--", 2) != 0) return usage_error(program, "unknown option -%c", optopt);

  const char *name[MOST_NAMES];
  int nname = 0;
  for (; known->name && nname < MOST_NAMES; known++) name[nname++] = known->name;
  char typed[64];
  snprintf(typed, sizeof typed, "%.*s", (int)strcspn(given + 2, "="), given + 2);
  const char *near = suggest(typed, nname, name);
  if (optopt) return usage_error(program, "--%s takes no value", typed);
  if (near) return usage_error(program, "unknown option --%s; did you mean --%s?", typed, near);
  return usage_error(program, "unknown option --%s", typed);
}

int dispatch(const char *program, const char *help, const command *table, int argc, char **argv) {
  if (argc < 2) {
    fputs(help, stderr);
    return EXIT_USAGE;
  }
  if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
    fputs(help, stdout);
    return EXIT_OK;
  }
  const char *name[MOST_NAMES];
  int nname = 0;
  for (const command *c = table; c->name && nname < MOST_NAMES; c++) {
    if (strcmp(argv[1], c->name) == 0) return c->run(argc - 1, argv + 1);
    name[nname++] = c->name;
  }
  const char *near = suggest(argv[1], nname, name);
  if (near) return usage_error(program, "unknown command %s; did you mean %s?", argv[1], near);
  return usage_error(program, "unknown command %s", argv[1]);
}

int failure(corot_status status) {
  say_error();
  switch (status) {
    case COROT_EINVAL:
    case COROT_EFORMAT:
      return EXIT_SCENARIO;
    case COROT_ENOMEM:
    case COROT_EIO:
      return EXIT_SYSTEM;
    default:
      return EXIT_INTEGRATOR;
  }
}

corot_status read_failure(corot_status status, const char *path) {
  if (status != COROT_EIO) return status;
  struct stat info;
  bool readable = stat(path, &info) == 0 && !S_ISDIR(info.st_mode);
  return readable ? COROT_EIO : COROT_EFORMAT;
}

bool parse_three(const char *text, double number[3]) {
  double x[3];
  for (int i = 0; i < 3; i++) {
    char *end;
    x[i] = strtod(text, &end);
    if (end == text || !(x[i] - x[i] == 0) || *end != (i < 2 ? ',' : '\0')) return false;
    text = end + 1;
  }
  memcpy(number, x, sizeof x);
  return true;
}

bool parse_positive(const char *text, double *number) {
  char *end;
  double x = strtod(text, &end);
  if (end == text || *end || !(x > 0 && x < 1e9)) return false;
  *number = x;
  return true;
}

bool parse_count(const char *text, int most, int *number) {
  char *end;
  long n = strtol(text, &end, 10);
  if (end == text || *end || n < 1 || n > most || text[0] == ' ' || text[0] == '+') return false;
  *number = (int)n;
  return true;
}
