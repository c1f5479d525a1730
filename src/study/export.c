#include "export.h"

#include <app/json_text.h>
#include <stdlib.h>

/* As one word for a shell. */
static void write_quoted(const char *text, FILE *out) {
  fputc('\'', out);
  for (; *text; text++) {
    if (*text == '\'')
      fputs("'\\''", out);
    else
      fputc(*text, out);
  }
  fputc('\'', out);
}

static void write_sets(const study_run *run, FILE *out) {
  for (int k = 0; k < run->nset; k++) {
    fputs(k > 0 ? " --set " : "--set ", out);
    write_quoted(run->set[k], out);
  }
}

void export_commands(const manifest *m, const export_target *t, FILE *out) {
  for (int i = 0; i < m->nrun; i++) {
    write_quoted(t->program, out);
    fputs(" run ", out);
    write_quoted(m->base, out);
    fputs(" --quiet --output ", out);
    write_quoted(t->dir, out);
    fprintf(out, "/runs/%s ", m->run[i].id);
    write_sets(&m->run[i], out);
    fputc('\n', out);
  }
}

/* Schedulers commonly refuse larger arrays. */
static int task_count(const manifest *m) { return m->nrun < 1000 ? m->nrun : 1000; }

void export_slurm(const manifest *m, const export_target *t, FILE *out) {
  int ntask = task_count(m);
  fputs("#!/bin/sh\n", out);
  fprintf(out, "# %s: %d runs in %d tasks. When all are over: corot study collect ", m->title,
          m->nrun, ntask);
  write_quoted(t->dir, out);
  fprintf(out, "\n#SBATCH --job-name=%s\n#SBATCH --array=1-%d\n", m->name, ntask);
  fputs("#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\n", out);
  fputs("exec ", out);
  write_quoted(t->program, out);
  fputs(" study ", out);
  write_quoted(t->study, out);
  fputs(" --quiet --jobs 1 --output ", out);
  write_quoted(t->dir, out);
  fprintf(out, " --shard \"$SLURM_ARRAY_TASK_ID/%d\"\n", ntask);
}

static void write_dictionary(const manifest *m, FILE *out) {
  fputs("RUNS = {\n", out);
  for (int i = 0; i < m->nrun; i++) {
    char *text = NULL;
    size_t size = 0;
    FILE *sets = open_memstream(&text, &size);
    if (!sets) break;
    write_sets(&m->run[i], sets);
    fclose(sets);
    fprintf(out, "    \"%s\": ", m->run[i].id);
    json_text_quote(text, out);
    fputs(",\n", out);
    free(text);
  }
  fputs("}\n", out);
}

void export_snakemake(const manifest *m, const export_target *t, FILE *out) {
  fprintf(out, "# %s: %d runs. snakemake --snakefile THIS --cores all\n", m->title, m->nrun);
  fputs("PROGRAM = ", out);
  json_text_quote(t->program, out);
  fputs("\nBASE = ", out);
  json_text_quote(m->base, out);
  fputs("\nDIR = ", out);
  json_text_quote(t->dir, out);
  fputc('\n', out);
  write_dictionary(m, out);
  fputs(
      "\nrule all:\n"
      "    input: DIR + \"/table.json\"\n"
      "\n"
      "rule run:\n"
      "    output: DIR + \"/runs/{id}/result.json\"\n"
      "    params: settings=lambda wildcards: RUNS[wildcards.id]\n"
      "    shell: \"{PROGRAM:q} run {BASE:q} --quiet --output {DIR:q}/runs/{wildcards.id} "
      "{params.settings}\"\n"
      "\n"
      "rule collect:\n"
      "    input: expand(DIR + \"/runs/{id}/result.json\", id=RUNS)\n"
      "    output: DIR + \"/table.json\"\n"
      "    shell: \"{PROGRAM:q} study collect {DIR:q}\"\n",
      out);
}
