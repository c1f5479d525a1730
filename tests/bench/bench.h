/* The commands of corot-bench, and what they share. */
#ifndef BENCH_BENCH_H
#define BENCH_BENCH_H

#include <corot/model.h>
#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>

#include "app/command/cli.h"

int command_kernels(int argc, char **argv);
int command_solvers(int argc, char **argv);
int command_example(int argc, char **argv);
int command_memory(int argc, char **argv);
int command_phases(int argc, char **argv);
int command_frames(int argc, char **argv);
int command_threads(int argc, char **argv);
int command_hierarchy(int argc, char **argv);
int command_local(int argc, char **argv);
int command_jitter(int argc, char **argv);
int command_total(int argc, char **argv);
int command_peers(int argc, char **argv);

/* Where the bar of corot-bench run comes from. */
typedef struct bar_source {
  const char *mesh; /* a file; NULL: the box */
  corot_box box;
  double grading; /* of the box: heights above its base, from 0 to 1, are taken to this power; 0:
                     not */
  int order;      /* of its tets: 1 or 2, or 0, as they come */
  const char *strain;
} bar_source;

/* 2 x 2 x 12 cells of 0.1 x 0.1 x 0.6 m. */
bar_source bar_source_default(const char *strain);

corot_status bar_model(const bar_source *source, corot_model **model);

/* The same, its mesh refined so many times; `levels` may be NULL. */
corot_status bar_model_refined(const bar_source *source, int nlevel, corot_model **model,
                               corot_refinement **levels);

/* Takes --mesh ('m'), --cells ('c') or --strain ('s') with its argument. Returns EXIT_OK or the
   exit code of a usage error; -1: `answer` is none of them. */
int take_bar_option(const char *program, int answer, bar_source *source);

/* The argument of --repeat, at most `most`. Returns EXIT_OK, or the exit code of a usage error. */
int take_repeat(const char *program, int most, int *nrun);

/* Options of a command that has none but --json. Returns -1 to go on, else the exit code. */
int only_json(const char *program, const char *help, int argc, char **argv, bool *json);

#endif
