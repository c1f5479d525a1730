/* `corot study export`: the format by its name. */
#define _XOPEN_SOURCE 700 /* realpath */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/command/cli.h"
#include "app/folder/folder.h"
#include "command_folder.h"
#include "reference_methods.h"
#include "study/execute/store.h"
#include "study/plan/plan.h"
#include "study/tables/export.h"

static const char help[] =
    "usage: corot study export STUDY.yaml --format commands|slurm|snakemake [-o DIR]\n"
    "\n"
    "Prints the runs of a study as a list of commands, an array job for sbatch, or a Snakefile, "
    "for\n"
    "other engines than ours to carry out, and prepares the folder. When they are through,\n"
    "`corot study collect DIR` makes the table.\n"
    "\n"
    "  -f, --format WORD   commands: one a line, in any order\n"
    "  -o, --output DIR    the study's folder, made if need be; default: out/STUDY in this folder\n"
    "      --force         as of corot study\n"
    "\n"
    "example: corot study export bar.yaml --format commands | xargs -d '\\n' -n 1 -P 8 sh -c\n";

static const struct option options[] = {
    {"format", required_argument, NULL, 'f'},
    {"output", required_argument, NULL, 'o'},
    {"force", no_argument, NULL, 'F'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

static const struct {
  const char *name;
  export_format *write;
} formats[] = {
    {"commands", export_commands},
    {"slurm", export_slurm},
    {"snakemake", export_snakemake},
};

static export_format *format_named(const char *name) {
  for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
    if (strcmp(formats[i].name, name) == 0) return formats[i].write;
  return NULL;
}

/* With the folder made the study's own, under absolute names. */
static corot_status write_runs(const manifest *m, const char *path, const char *dir, bool force,
                               export_format *write) {
  store_lock lock;
  COROT_TRY(store_enter(dir, m, 1, 1, force, &lock));
  store_leave(lock);
  char *program = realpath("/proc/self/exe", NULL), *study_path = realpath(path, NULL);
  char *folder = realpath(dir, NULL);
  corot_status status = COROT_OK;
  if (program && study_path && folder)
    status = write(m, &(export_target){program, study_path, folder}, stdout);
  else
    status = corot_fail(COROT_EIO, "%s: its absolute name cannot be found", path);
  free(program);
  free(study_path);
  free(folder);
  return status;
}

static int export_study(const char *path, const char *dir, bool force, export_format *write) {
  study *s = NULL;
  manifest *m = NULL;
  corot_status status = study_read(path, &s);
  status = read_failure(status, path);
  char *folder = status == COROT_OK && !dir ? folder_path("out", s->name) : NULL;
  if (status == COROT_OK && (dir || folder))
    status = reference_methods_recall(s, dir ? dir : folder);
  if (status == COROT_OK) status = plan_study(s, &m);
  if (status == COROT_OK && !dir && !folder) status = COROT_ENOMEM;
  if (status == COROT_OK) status = write_runs(m, path, dir ? dir : folder, force, write);
  free(folder);
  manifest_destroy(m);
  study_destroy(s);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

int command_study_export(int argc, char **argv) {
  const char *dir = NULL, *format = NULL;
  bool force = false;
  int code = -1;
  opterr = 0;
  for (int answer; code < 0 && (answer = getopt_long(argc, argv, ":o:f:h", options, NULL)) != -1;) {
    if (answer == 'o')
      dir = optarg;
    else if (answer == 'f')
      format = optarg;
    else if (answer == 'F')
      force = true;
    else if (answer == 'h')
      fputs(help, stdout), code = EXIT_OK;
    else
      code = option_error("corot study export", answer, argv, options);
  }
  /* the study and the format */
  if (code >= 0) return code;
  if (argc - optind != 1)
    return usage_error("corot study export", "expected one study, found %d", argc - optind);
  if (!format) return usage_error("corot study export", "--format is missing");
  export_format *write = format_named(format);
  if (!write)
    return usage_error("corot study export", "--format %s: expected commands, slurm or snakemake",
                       format);
  return export_study(argv[optind], dir, force, write);
}
