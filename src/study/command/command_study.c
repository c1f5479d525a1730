/* `corot study`: options, then plan, runs, tables and page. */
#include "command_study.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/command/cli.h"
#include "app/folder/folder.h"
#include "app/text/escape.h"
#include "app/text/say.h"
#include "command_folder.h"
#include "reference_methods.h"
#include "study/execute/execute.h"
#include "study/execute/pool.h"
#include "study/execute/store.h"
#include "study/plan/plan.h"
#include "study/tables/report_page.h"
#include "study/tables/write_tables.h"

static const char help[] =
    "usage: corot study STUDY.yaml [-o DIR] [-j N] [--shard I/N] [--dry-run] ...\n"
    "       corot study status | collect | table | csv DIR\n"
    "       corot study export STUDY.yaml --format commands | slurm | snakemake [-o DIR]\n"
    "       corot study schema [KEY]\n"
    "\n"
    "Runs a scenario many times, as a study file (YAML, or JSON) says: with some of its keys "
    "varied\n"
    "along axes, and against references. Each run is a process with a folder of its own. A study\n"
    "that was stopped or killed goes on where it was; runs that are done are not repeated. What\n"
    "they say together is in table.json, table.csv and report.html, a page to look at; the tables\n"
    "are there, of what is done, while a study goes on. DIR/names has a link to each run by what\n"
    "it sets. Cells run first, the cheapest alone, which tells how long it will all take;\n"
    "references follow. Where stderr is no terminal a line every half minute says how far it is.\n"
    "\n"
    "  -o, --output DIR    the study's folder, made if need be; default: out/STUDY in this folder\n"
    "  -j, --jobs N        so many runs at once; default: one a processor\n"
    "      --shard I/N     only the I-th of N parts of the runs, for N machines with one folder;\n"
    "                      all must have the same N\n"
    "      --dry-run       lists the runs and what has become of them; runs nothing\n"
    "      --retry-failed  those that failed before, again\n"
    "      --timeout S     ends a run that takes longer than S seconds; it counts as failed\n"
    "      --force         takes a folder that holds files of others by the names of a study's:\n"
    "                      study.json, table.json, table.csv, index.sqlite, report.html\n"
    "  -q, --quiet         nothing on stderr but errors\n"
    "\n"
    "  status DIR          how far a study and each run that is going on is, by the sizes of "
    "files\n"
    "  collect DIR         table.json, table.csv and index.sqlite anew, from the folders of the "
    "runs;\n"
    "                      exit code 1: files of runs are not as the runs have left them\n"
    "  table DIR           the table in columns; errors below ten times the floor in parentheses\n"
    "  csv DIR             the table as CSV\n"
    "  export STUDY.yaml   the runs for other engines to carry out\n"
    "  schema [KEY]        every key of a study file: type, unit, default, meaning\n"
    "\n"
    "A study file (at most 64 different keys varied, 1000 values of a log, 100000 combinations; "
    "else\n"
    "as large as a scenario, see corot schema --help):\n"
    "\n"
    "  study: Which integrator, and how tight?\n"
    "  base: bar.yaml\n"
    "  set: {time.end: 5}\n"
    "  axes:\n"
    "    - {key: integrator.method, values: [cvode, ida]}\n"
    "    - {key: integrator.rtol, log: {from: 1e-2, to: 1e-6, per_decade: 1}}\n"
    "  repeat: 3\n"
    "\n"
    "A run that lacked memory or disk is tried again at the end, alone, twice at the most.\n"
    "\n"
    "Exit codes: 0 ok, 1 some runs failed, 2 usage, 3 bad study, scenario or mesh, 5 no memory, "
    "or\n"
    "reading or writing failed, or the folder holds files of others, 128 + N interrupted by signal "
    "N (130: Ctrl-C, 143: kill).\n"
    "\n"
    "example: corot study models/studies/integrators.yaml -o out/integrators -j 8\n";

static const struct option options[] = {
    {"output", required_argument, NULL, 'o'}, {"jobs", required_argument, NULL, 'j'},
    {"shard", required_argument, NULL, 's'},  {"dry-run", no_argument, NULL, 'd'},
    {"retry-failed", no_argument, NULL, 'r'}, {"force", no_argument, NULL, 'f'},
    {"quiet", no_argument, NULL, 'q'},        {"timeout", required_argument, NULL, 't'},
    {"help", no_argument, NULL, 'h'},         {0},
};

/* --- What the arguments say --- */

typedef struct arguments {
  execute_options o;
  bool dry;
} arguments;

static bool parse_shard(const char *text, int *shard, int *nshard) {
  char first[16];
  size_t length = strcspn(text, "/");
  if (length >= sizeof first || text[length] != '/') return false;
  memcpy(first, text, length);
  first[length] = '\0';
  return parse_count(text + length + 1, 1000000, nshard) && parse_count(first, *nshard, shard);
}

/* -1, or an exit code. */
static int take_option(int answer, char **argv, arguments *a) {
  switch (answer) {
    case 'o':
      a->o.dir = optarg;
      if (!*optarg) return usage_error("corot study", "--output: the name is empty");
      return -1;
    case 'j':
      if (parse_count(optarg, POOL_MAX, &a->o.njob)) return -1;
      return usage_error("corot study", "--jobs %s: expected 1 to %d", optarg, POOL_MAX);
    case 's':
      if (parse_shard(optarg, &a->o.shard, &a->o.nshard)) return -1;
      return usage_error("corot study", "--shard %s: expected I/N, such as 1/4", optarg);
    case 't':
      if (parse_positive(optarg, &a->o.timeout)) return -1;
      return usage_error("corot study", "--timeout %s: expected seconds > 0", optarg);
    case 'd':
      a->dry = true;
      return -1;
    case 'r':
      a->o.retry_failed = true;
      return -1;
    case 'f':
      a->o.force = true;
      return -1;
    case 'q':
      a->o.quiet = true;
      return -1;
    case 'h':
      fputs(help, stdout);
      return EXIT_OK;
    default:
      return option_error("corot study", answer, argv, options);
  }
}

/* --- Running --- */

enum { TITLE = 200 }; /* bytes of it that a message shows */

static void announce(const manifest *m, const execute_options *o) {
  int nown = 0; /* runs are numbered as cells first need them */
  for (int i = 0; i < m->ncell; i++) nown += m->cell[i].run == nown;
  char title[TITLE];
  say("%s: %d cells, %d runs; %s\n", escape_line_cut(m->title, sizeof title, title), m->ncell,
      m->nrun, o->dir);
  if (nown < m->ncell)
    fprintf(stderr, "%d cells are the same run as another; each run is made once\n",
            m->ncell - nown);
}

static int conclude(const execute_options *o, const execute_totals *t, int signal_number) {
  if (!o->quiet || t->nfailed + t->nlost > 0)
    say("%s: %d of %d runs done (%d now), %d failed\n", o->dir, t->ndone, t->nrun, t->nnew,
        t->nfailed);
  if (signal_number) {
    fputs("interrupted; the same command goes on from here\n", stderr);
    return 128 + signal_number;
  }
  if (t->nlost > 0) {
    fprintf(stderr, "%d stopped for reasons from outside; the same command tries them again\n",
            t->nlost);
    return EXIT_SYSTEM;
  }
  return t->nfailed > 0 ? EXIT_CHECK : EXIT_OK;
}

typedef struct partial {
  const manifest *m;
  const char *dir;
} partial;

/* Runs of another version are other runs: they stay where they are, and are not used. */
static void tell_version(const char *dir) {
  manifest *before = NULL;
  if (manifest_read(dir, &before) != COROT_OK) return;
  if (strcmp(before->version, corot_version()) != 0)
    say("%s: made by corot %s; this is %s, and does all of it again\n", dir, before->version,
        corot_version());
  manifest_destroy(before);
}

/* Tables of the runs that are done so far, for whoever looks; what goes wrong here goes wrong at
   the end, too. */
static void write_partial(void *context) {
  const partial *p = context;
  int ndamaged;
  (void)write_tables(p->m, p->dir, true, NULL, &ndamaged);
}

/* In a folder that is ours. */
static corot_status execute_in(study *s, execute_options *o, manifest **m, execute_totals *totals,
                               int *signal_number) {
  COROT_TRY(reference_methods_choose(s, o, m, signal_number));
  if (*signal_number) {
    *totals = (execute_totals){.nrun = (*m)->nrun};
    return COROT_OK;
  }
  partial so_far = {*m, o->dir};
  if (o->nshard == 1) o->tick = write_partial, o->context = &so_far;
  return execute_study(*m, o, totals, signal_number);
}

static int execute_here(study *s, manifest **plan, execute_options *o) {
  const manifest *m = *plan;
  store_lock lock;
  execute_totals totals;
  int signal_number;
  if (!o->quiet) tell_version(o->dir);
  corot_status status = store_enter(o->dir, m, o->shard, o->nshard, o->force, &lock);
  if (status != COROT_OK) return failure(status);
  if (!o->quiet) announce(m, o);
  status = execute_in(s, o, plan, &totals, &signal_number);
  m = *plan;
  if (status == COROT_OK) status = store_check(o->dir, lock);
  int code = status == COROT_OK ? conclude(o, &totals, signal_number) : failure(status);
  if (status == COROT_OK && !signal_number && o->nshard == 1) {
    int ndamaged; /* since they were looked at: the next call does them again */
    status = write_tables(m, o->dir, true, o->quiet ? NULL : stderr, &ndamaged);
    if (status == COROT_OK && !o->quiet) say("corot study table %s\n", o->dir);
    if (status == COROT_OK) status = study_page(o->dir, o->quiet);
    if (status != COROT_OK) code = failure(status);
  }
  store_leave(lock);
  return code;
}

static int run_study(const char *path, arguments *a) {
  study *s = NULL;
  manifest *m = NULL;
  corot_status status = study_read(path, &s);
  status = read_failure(status, path);
  char *folder = status == COROT_OK && !a->o.dir ? folder_path("out", s->name) : NULL;
  if (folder) a->o.dir = folder;
  if (status == COROT_OK && a->o.dir) status = reference_methods_recall(s, a->o.dir);
  if (status == COROT_OK) status = plan_study(s, &m);
  int code;
  if (status != COROT_OK || !a->o.dir)
    code = failure(status);
  else if (a->dry)
    code = (status = execute_dry(m, &a->o, stdout)) == COROT_OK ? EXIT_OK : failure(status);
  else
    code = execute_here(s, &m, &a->o);
  free(folder);
  manifest_destroy(m);
  study_destroy(s);
  return code;
}

static int command_study_run(int argc, char **argv) {
  arguments a = {.o = execute_defaults()};
  a.o.pilot = true;
  int code = -1;
  opterr = 0;
  for (int answer; code < 0 && (answer = getopt_long(argc, argv, ":o:j:qh", options, NULL)) != -1;)
    code = take_option(answer, argv, &a);
  if (code < 0 && argc - optind != 1)
    code = usage_error("corot study", "expected one study, found %d", argc - optind);
  return code < 0 ? run_study(argv[optind], &a) : code;
}

int command_study(int argc, char **argv) {
  static const command verbs[] = {
      {"status", command_study_status},
      {"collect", command_study_collect},
      {"table", command_study_table},
      {"csv", command_study_csv},
      {"export", command_study_export},
      {"schema", command_study_schema},
      {0},
  };
  for (const command *v = verbs; v->name; v++)
    if (argc > 1 && strcmp(argv[1], v->name) == 0) return v->run(argc - 1, argv + 1);
  if (argc > 1) return command_study_run(argc, argv);
  fputs(help, stderr);
  return EXIT_USAGE;
}
