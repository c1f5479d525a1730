/* `corot new`: a scenario to begin with. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "app/text/say.h"
#include "app/text/suggest.h"
#include "cli.h"
#include "starters.h"

static const char help[] =
    "usage: corot new bar | bracket | free [-o FILE.yaml] [--force]\n"
    "\n"
    "Writes a scenario to begin with, which runs as it is and says in comments what to change; to\n"
    "stdout, where no file is named.\n"
    "\n"
    "  bar                  a soft bar that is pulled aside, in motion: corot run\n"
    "  bracket              a steel bracket under a load, in equilibrium: corot static\n"
    "  free                 a body that nothing holds, tumbling: corot run\n"
    "\n"
    "  -o, --output FILE    the file to write; one that is there is left alone\n"
    "      --force          replaces one that is there\n"
    "\n"
    "example: corot new bar -o bar.yaml\n";

static const struct option options[] = {
    {"output", required_argument, NULL, 'o'},
    {"force", no_argument, NULL, 'f'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

static const starter *find(const char *kind) {
  const char *name[8];
  int n = 0;
  for (; n < nstarter && n < 8; n++) {
    name[n] = starters[n].name;
    if (strcmp(name[n], kind) == 0) return &starters[n];
  }
  const char *near = suggest(kind, n, name);
  if (near)
    usage_error("corot new", "there is no %s; did you mean %s?", kind, near);
  else
    usage_error("corot new", "there is no %s; there are bar, bracket and free", kind);
  return NULL;
}

static int write_file(const starter *s, const char *path, bool force) {
  FILE *out = fopen(path, force ? "w" : "wx");
  if (!out && errno == EEXIST)
    return failure(corot_fail(COROT_EIO, "%s: there is a file already; --force replaces it", path));
  if (!out) return failure(corot_fail(COROT_EIO, "%s: %s", path, strerror(errno)));
  bool written = fputs(s->text, out) >= 0 && fflush(out) == 0;
  int why = errno;
  if (fclose(out) != 0 && written) written = false, why = errno;
  if (!written) {
    if (!force) remove(path); /* which was made here: half of a scenario is none */
    return failure(corot_fail(COROT_EIO, "%s: %s", path, strerror(why)));
  }
  say("%s: %s\n", path, s->about);
  return EXIT_OK;
}

int command_new(int argc, char **argv) {
  const char *path = NULL;
  bool force = false;
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":o:h", options, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    if (answer != 'o' && answer != 'f') return option_error("corot new", answer, argv, options);
    if (answer == 'o') path = optarg;
    force = force || answer == 'f';
  }
  if (argc - optind != 1)
    return usage_error("corot new", "expected one of bar, bracket and free, found %d",
                       argc - optind);
  if (path && !*path) return usage_error("corot new", "--output: the name is empty");
  const starter *s = find(argv[optind]);
  if (!s) return EXIT_USAGE;
  if (path) return write_file(s, path, force);
  fputs(s->text, stdout);
  return EXIT_OK;
}
