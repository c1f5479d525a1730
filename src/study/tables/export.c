/* One writer a format; every text is escaped for it. */
#include "export.h"

#include <stdlib.h>
#include <string.h>

#include "app/text/escape.h"
#include "app/text/no_memory.h"
#include "app/text/text_stream.h"

/* A run by itself takes all cores; these share the machine, as those of corot study do. */
#define ONE_THREAD "env OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 "

/* The beginning of a comment. */
static void write_title(const manifest *m, FILE *out) {
  char title[200];
  fprintf(out, "# %s", escape_line_cut(m->title, sizeof title, title));
}

static void write_sets(const study_run *run, FILE *out) {
  for (int k = 0; k < run->nset; k++) {
    fputs(k > 0 ? " --set " : "--set ", out);
    escape_shell(run->set[k], out);
  }
}

static corot_status refuse(const char *name, const char *why) {
  char line[512];
  return corot_fail(COROT_EINVAL, "%s: %s", escape_line_cut(name, sizeof line, line), why);
}

corot_status export_commands(const manifest *m, const export_target *t, FILE *out) {
  const char *const name[] = {t->program, m->base, t->dir};
  for (int i = 0; i < 3; i++)
    if (strpbrk(name[i], "\n\r"))
      return refuse(name[i], "a list of one command a line cannot hold a name with a line break");
  for (int i = 0; i < m->nrun; i++) {
    fputs(ONE_THREAD, out);
    escape_shell(t->program, out);
    fputs(m->still ? " static " : " run ", out);
    escape_shell(m->base, out);
    fputs(" --quiet --lean --force --output ", out);
    escape_shell(t->dir, out);
    fprintf(out, "/runs/%s ", m->run[i].id);
    write_sets(&m->run[i], out);
    fputc('\n', out);
  }
  return COROT_OK;
}

/* Schedulers commonly refuse larger arrays. */
static int task_count(const manifest *m) { return m->nrun < 1000 ? m->nrun : 1000; }

corot_status export_slurm(const manifest *m, const export_target *t, FILE *out) {
  int ntask = task_count(m);
  fputs("#!/bin/sh\n", out);
  write_title(m, out);
  fprintf(out, ": %d runs in %d tasks. When all are over: corot study collect ", m->nrun, ntask);
  escape_line(t->dir, out);
  fputs("\n#SBATCH --job-name=", out);
  escape_name(m->name, out);
  fprintf(out, "\n#SBATCH --array=1-%d\n", ntask);
  fputs("#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\n", out);
  fputs("exec ", out);
  escape_shell(t->program, out);
  fputs(" study ", out);
  escape_shell(t->study, out);
  fputs(" --quiet --jobs 1 --output ", out);
  escape_shell(t->dir, out);
  fprintf(out, " --shard \"$SLURM_ARRAY_TASK_ID/%d\"\n", ntask);
  return COROT_OK;
}

static corot_status write_dictionary(const manifest *m, FILE *out) {
  fputs("RUNS = {\n", out);
  for (int i = 0; i < m->nrun; i++) {
    char *text = NULL;
    size_t size = 0;
    FILE *sets = text_open(&text, &size);
    if (!sets) return no_memory();
    write_sets(&m->run[i], sets);
    if (text_close(sets) != 0) {
      free(text);
      return no_memory();
    }
    fprintf(out, "    \"%s\": ", m->run[i].id);
    escape_python(text, out);
    fputs(",\n", out);
    free(text);
  }
  fputs("}\n", out);
  return COROT_OK;
}

corot_status export_snakemake(const manifest *m, const export_target *t, FILE *out) {
  if (strpbrk(t->dir, "{}\n\r"))
    return refuse(t->dir,
                  "Snakemake cannot write to a folder with a brace or a line break in its name");
  /* what the rules refer to */
  write_title(m, out);
  fprintf(out, ": %d runs. snakemake --snakefile THIS --cores all\n", m->nrun);
  fputs("PROGRAM = ", out);
  escape_python(t->program, out);
  fputs("\nBASE = ", out);
  escape_python(m->base, out);
  fputs("\nDIR = ", out);
  escape_python(t->dir, out);
  fputc('\n', out);
  COROT_TRY(write_dictionary(m, out));
  /* one rule for each run, one that collects them */
  fputs(
      "\nrule all:\n"
      "    input: DIR + \"/table.json\"\n"
      "\n"
      "rule run:\n"
      "    output: DIR + \"/runs/{id}/result.json\"\n"
      "    params: settings=lambda wildcards: RUNS[wildcards.id]\n"
      "    shell: \"" ONE_THREAD "{PROGRAM:q} ",
      out);
  fputs(m->still ? "static" : "run --resume", out);
  fputs(
      " {BASE:q} --quiet --lean --force --output {DIR:q}/runs/{wildcards.id} "
      "{params.settings} || test $? -eq 1\"\n" /* a quantity without a value is no failure */
      "\n"
      "rule collect:\n"
      "    input: expand(DIR + \"/runs/{id}/result.json\", id=RUNS)\n"
      "    output: DIR + \"/table.json\"\n"
      "    shell: \"{PROGRAM:q} study collect {DIR:q}\"\n",
      out);
  return COROT_OK;
}
