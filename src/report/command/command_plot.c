/* `corot plot`: the diagram of a study, and scripts that draw it. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/command/cli.h"
#include "app/text/say.h"
#include "app/text/suggest.h"
#include "commands.h"
#include "report/chart/precision.h"

static const char help[] =
    "usage: corot plot DIR [--cost COST] [--error NAME] [-o FILE.svg] [--force]\n"
    "\n"
    "Draws the work-precision diagram of a study from DIR/table.json: error against cost, a line\n"
    "for each series, and the floor below which the references say nothing. Beside the SVG stand\n"
    "a CSV of all its cells, and scripts for gnuplot (.gp) and matplotlib (.py) that draw the "
    "same\n"
    "from it. The files' names go to stdout; cells that have no point, and why, to stderr.\n"
    "\n"
    "      --cost COST      cpu, wall, steps, rhs, factorisations or solves\n"
    "      --error NAME     one of the table's measures of error, as velocity or displacement_end\n"
    "  -o, --output FILE    default: DIR/precision-COST-NAME.svg\n"
    "      --force          replaces files that corot has not written, too\n"
    "\n"
    "Without --cost and --error: those that the study compares by. A study that was cut off "
    "before\n"
    "it had a table, or still runs, gets one of the runs there are now.\n"
    "\n"
    "example: corot plot out/integrators --cost rhs\n";

static const struct option options[] = {
    {"cost", required_argument, NULL, 'c'},   {"error", required_argument, NULL, 'e'},
    {"output", required_argument, NULL, 'o'}, {"force", no_argument, NULL, 'f'},
    {"help", no_argument, NULL, 'h'},         {0},
};

typedef struct wish {
  const char *cost, *error, *output; /* NULL: the default */
  bool force;
} wish;

/* The index of `typed` among names; -1, and the message, where it is none of them. */
static int choose(const char *option, const char *typed, int n, const char *const *name) {
  for (int i = 0; i < n; i++)
    if (strcmp(name[i], typed) == 0) return i;
  const char *near = suggest(typed, n, name);
  if (near)
    usage_error("corot plot", "%s: there is no %s; did you mean %s?", option, typed, near);
  else
    usage_error("corot plot", "%s: there is no %s; the first of %d is %s", option, typed, n,
                n > 0 ? name[0] : "missing");
  return -1;
}

/* The output's name without ".svg"; the caller's to free. */
static char *base_of(const char *dir, const wish *w, const precision *p) {
  const char *error = p->table->error_name[p->error], *cost = study_cost_word[p->cost];
  size_t size = strlen(w->output ? w->output : dir) + strlen(cost) + strlen(error) + 32;
  char *base = malloc(size);
  if (!base) return NULL;
  if (w->output) {
    snprintf(base, size, "%s", w->output);
    size_t length = strlen(base);
    if (length > 4 && strcmp(base + length - 4, ".svg") == 0) base[length - 4] = '\0';
    return base;
  }
  int name_at = snprintf(base, size, "%s/precision-", dir);
  snprintf(base + name_at, size - (size_t)name_at, "%s-%s", cost, error);
  for (char *c = base + name_at; *c; c++)
    if (!isalnum((unsigned char)*c) && !strchr("-_.", *c)) *c = '_';
  return base;
}

static void tell(const study_table *t, int error) {
  static const char *const word[] = {"below the floor", "failed", "missing"};
  for (int i = 0; i < t->ncell; i++) {
    const study_cell *c = &t->cell[i];
    if (study_cell_rated(c, error)) continue;
    say("no point: %s, tolerance %g: %s%s%s\n", t->series[c->series], c->tolerance, word[c->status],
        *c->reason ? ": " : "", c->reason);
  }
}

static int plot(const char *dir, const wish *w, const study_table *t) {
  if (t->nerror == 0)
    return failure(corot_fail(COROT_EFORMAT, "%s/table.json: no cell has an error yet", dir));
  precision p = {.table = t};
  int cost = w->cost ? choose("--cost", w->cost, STUDY_COSTS, study_cost_word) : (int)t->cost;
  int error = w->error ? choose("--error", w->error, t->nerror, t->error_name) : t->measure;
  if (cost < 0 || error < 0) return EXIT_USAGE;
  p.cost = (study_cost)cost;
  p.error = error;
  char *base = base_of(dir, w, &p);
  if (!base) return failure(corot_fail(COROT_ENOMEM, "out of memory"));
  corot_status status = w->force ? COROT_OK : precision_permit(base);
  if (status == COROT_OK) status = precision_write(&p, base);
  if (status == COROT_OK) {
    tell(t, error);
    show("%s.svg\n%s.csv\n%s.gp\n%s.py\n", base, base, base, base);
  }
  free(base);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

int command_plot(int argc, char **argv) {
  wish w = {0};
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":o:h", options, NULL)) != -1;) {
    if (answer == 'c')
      w.cost = optarg;
    else if (answer == 'e')
      w.error = optarg;
    else if (answer == 'o')
      w.output = optarg;
    else if (answer == 'f')
      w.force = true;
    else if (answer == 'h')
      return fputs(help, stdout), EXIT_OK;
    else
      return option_error("corot plot", answer, argv, options);
  }
  if (argc - optind != 1)
    return usage_error("corot plot", "expected one folder, found %d", argc - optind);
  if (w.output && !*w.output) return usage_error("corot plot", "--output: the name is empty");
  study_table t;
  corot_status status = study_table_read(argv[optind], &t);
  if (status != COROT_OK) return failure(status);
  int code = plot(argv[optind], &w, &t);
  study_table_free(&t);
  return code;
}
