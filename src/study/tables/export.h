/* The runs of a study for other engines than ours to carry out, where one machine is too small.
   What they leave in the folder is collected by `corot study collect`. */
#ifndef COROT_STUDY_TABLES_EXPORT_H
#define COROT_STUDY_TABLES_EXPORT_H

#include "study/plan/manifest.h"

typedef struct export_target {
  const char *program, *study, *dir; /* absolute paths */
} export_target;

/* COROT_EINVAL: the format cannot hold one of the names. */
typedef corot_status export_format(const manifest *m, const export_target *t, FILE *out);

/* One command a line, in any order, as for xargs or GNU parallel. */
export_format export_commands;

/* An array job for sbatch: each of its tasks is a shard of the study. */
export_format export_slurm;

/* A Snakefile: a rule for the runs, and one that collects them. */
export_format export_snakemake;

#endif
