/* What the program says of itself: its commands, its exit codes, its version. */
#include "help.h"

#include <jansson.h>

#include "app/command/cli.h"
#include "app/folder/provenance.h"
#include "app/text/say.h"

static const char head[] =
    "corot: deformable solids as ordinary differential equations, integrated with error control\n"
    "\n"
    "usage: corot COMMAND ...\n"
    "\n";

static const char tail[] =
    "\n"
    "corot COMMAND --help, or corot help COMMAND, says more of one.\n"
    "\n"
    "Data goes to stdout, messages to stderr. Exit codes:\n"
    "\n"
    "  0  ok                              4  the integrator gave up, or found no equilibrium\n"
    "  1  finished, but a check failed,   5  the system refused memory, reading or writing, or\n"
    "     or some runs did                   there are no results in a folder, or files of\n"
    "  2  the command line makes no sense    others that only --force replaces\n"
    "  3  a scenario, study or mesh is bad or missing\n"
    "  128 + N  interrupted by signal N, after writing what there was (130: Ctrl-C, 143: kill);\n"
    "           or ended by a fault (139, 134), which is said, with what was written by then\n"
    "\n"
    "Messages have colours on a terminal, unless NO_COLOR is set or TERM is dumb.\n"
    "\n"
    "example: corot run models/bar/bar.yaml -o out/bar --set integrator.rtol=1e-6\n";

/* The commands by use, one or two lines each. */
static void list_commands(const listed_command *table, FILE *out) {
  enum { WIDTH = 21 };
  for (const listed_command *c = table; c->name; c++) {
    if (!c->about) continue;
    if (c->group) fprintf(out, "%s%s:\n", c == table ? "" : "\n", c->group);
    int width = fprintf(out, "  %s %s", c->name, c->arguments) - 2;
    if (width >= WIDTH) width = fprintf(out, "\n  ") - 3;
    fprintf(out, "%*s%s\n", WIDTH - width, "", c->about);
  }
}

void print_help(const listed_command *table, FILE *out) {
  fputs(head, out);
  list_commands(table, out);
  fputs(tail, out);
}

/* What the libraries are is found out as for a result. */
int print_version(int argc, char **argv) {
  (void)argc, (void)argv;
  json_t *made = NULL;
  corot_status status = provenance_make(&made);
  if (status != COROT_OK) return failure(status);
  printf("corot %s\n", corot_version());
  for (int i = 0; i < PROVENANCE_FIELDS; i++) {
    char words[128];
    provenance_words(made, i, sizeof words, words);
    if (i != PROVENANCE_COROT && i != PROVENANCE_KERNELS) show("%s\n", words);
  }
  json_decref(made);
  return EXIT_OK;
}
