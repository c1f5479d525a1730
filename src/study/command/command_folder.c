/* `corot study status`, `collect`, `table`, `csv` and `schema`. */
#include "command_folder.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/command/cli.h"
#include "app/folder/folder.h"
#include "app/text/escape.h"
#include "app/text/say.h"
#include "app/text/suggest.h"
#include "study/execute/reached.h"
#include "study/execute/run_names.h"
#include "study/execute/store.h"
#include "study/measure/collect.h"
#include "study/plan/json_file.h"
#include "study/tables/table_text.h"
#include "study/tables/write_tables.h"

/* One folder, and no options but --help. -1: go on with *dir; otherwise an exit code. */
static int only_folder(const char *program, int argc, char **argv, const char **dir) {
  char name[64];
  snprintf(name, sizeof name, "corot study %s", program);
  if (argc == 2 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
    printf("usage: %s DIR\n\nSee corot study --help.\n", name);
    return EXIT_OK;
  }
  if (argc != 2) return usage_error("corot study", "%s: expected one folder", program);
  if (argv[1][0] == '-') return usage_error("corot study", "unknown option %s", argv[1]);
  *dir = argv[1];
  return -1;
}

/* What there is to say of a run that is not done; *work: of it, what is. */
static corot_status tell_run(const manifest *m, const char *dir, int i, int count[3],
                             double *work) {
  const study_run *run = &m->run[i];
  run_record record;
  COROT_TRY(store_look(dir, run, &record));
  bool alive = record.state == RUN_MISSING && run_is_alive(dir, run);
  double reached = alive ? run_reached(dir, run) : NAN;
  char name[RUN_NAME];
  count[record.state]++;
  *work = record.state == RUN_DONE ? run->work : isfinite(reached) ? reached * run->work : 0;
  run_name(m, i, name);
  if (record.state == RUN_FAILED)
    show("%s failed: %s\n", run->id, record.reason);
  else if (alive)
    show("%s running, %.0f %%: %s\n", run->id, isfinite(reached) ? floor(100 * reached) : 0, name);
  else if (record.state == RUN_MISSING && record.reason)
    show("%s to be tried again: %s\n", run->id, record.reason);
  run_record_free(&record);
  return COROT_OK;
}

int command_study_status(int argc, char **argv) {
  const char *dir = NULL;
  int code = only_folder("status", argc, argv, &dir), count[3] = {0};
  if (code >= 0) return code;
  char title[200];
  manifest *m = NULL;
  corot_status status = manifest_read(dir, &m);
  /* each run that is not done, with its reason, or how far it is */
  double done = 0, all = 0;
  for (int i = 0; status == COROT_OK && i < m->nrun; i++) {
    double work = 0;
    status = tell_run(m, dir, i, count, &work);
    done += work;
    all += m->run[i].work;
  }
  /* all together */
  if (status == COROT_OK)
    show("%s: %d cells, %d runs: %d done, %d failed, %d missing\n",
         escape_line_cut(m->title, sizeof title, title), m->ncell, m->nrun, count[RUN_DONE],
         count[RUN_FAILED], count[RUN_MISSING]);
  if (status == COROT_OK && count[RUN_MISSING] > 0)
    show("about %.0f %% of the work is done\n", floor(100 * done / all));
  if (status == COROT_OK && strcmp(m->version, corot_version()) != 0)
    show("runs by corot %s; this is %s, and would do all of them again\n", m->version,
         corot_version());
  manifest_destroy(m);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

corot_status study_collect(const char *dir, int *ndamaged) {
  manifest *m = NULL;
  COROT_TRY(manifest_read(dir, &m));
  corot_status status = write_tables(m, dir, false, stderr, ndamaged);
  manifest_destroy(m);
  return status;
}

int command_study_collect(int argc, char **argv) {
  const char *dir = NULL;
  int code = only_folder("collect", argc, argv, &dir);
  if (code >= 0) return code;
  int ndamaged = 0;
  corot_status status = study_collect(dir, &ndamaged);
  if (status != COROT_OK) return failure(status);
  if (ndamaged == 0) return EXIT_OK;
  fputs("corot study with this study does again what is not as it was left\n", stderr);
  return EXIT_CHECK;
}

static corot_status write_table(const void *table, FILE *out) { return table_print(table, out); }

/* The table of a folder; of a study that has not collected one yet, what can be said now. */
static corot_status read_table(const char *dir, json_t **table) {
  char *path = folder_path(dir, "table.json");
  manifest *m = NULL;
  bool there;
  int ndamaged;
  if (!path) return COROT_ENOMEM;
  corot_status status = folder_look(path, &there);
  if (status == COROT_OK && !there) status = manifest_read(dir, &m);
  if (status == COROT_OK && there)
    status = json_file_read(path, table);
  else if (status == COROT_OK)
    status = collect_table(m, dir, true, table, &ndamaged);
  else
    status = json_file_read(path, table); /* whose message names it */
  manifest_destroy(m);
  free(path);
  return status;
}

int command_study_table(int argc, char **argv) {
  const char *dir = NULL;
  int code = only_folder("table", argc, argv, &dir);
  if (code >= 0) return code;
  json_t *table = NULL;
  corot_status status = read_table(dir, &table);
  if (status == COROT_OK) status = show_all(write_table, table);
  json_decref(table);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

int command_study_csv(int argc, char **argv) {
  const char *dir = NULL;
  int code = only_folder("csv", argc, argv, &dir);
  if (code >= 0) return code;
  char *path = folder_path(dir, "table.csv");
  corot_status status = path ? file_check_regular(path) : COROT_ENOMEM;
  if (status != COROT_OK) {
    free(path);
    return failure(status);
  }
  FILE *file = fopen(path, "re");
  if (!file) code = failure(corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno)));
  for (int c; file && (c = getc(file)) != EOF;) putchar(c);
  if (file && ferror(file))
    code = failure(corot_fail(COROT_EIO, "%s: cannot be read: %s", path, strerror(errno)));
  if (file) fclose(file);
  free(path);
  return code < 0 ? EXIT_OK : code;
}

int command_study_schema(int argc, char **argv) {
  const char *path[128];
  int n = 0;
  if (argc > 2) return usage_error("corot study", "schema: expected at most one key");
  const char *prefix = argc == 2 ? argv[1] : "";
  if (strcmp(prefix, "--help") == 0 || strcmp(prefix, "-h") == 0) {
    puts("usage: corot study schema [KEY]\n\nSee corot study --help.");
    return EXIT_OK;
  }
  if (schema_print(&study_schema, prefix, stdout) > 0) return EXIT_OK;
  for (; n < study_schema.nkey && n < 128; n++) path[n] = study_schema.key[n].path;
  const char *near = suggest(prefix, n, path);
  if (near) return usage_error("corot study", "no key %s; did you mean %s?", prefix, near);
  return usage_error("corot study", "no key %s", prefix);
}
