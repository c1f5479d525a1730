/* The commands of corot-bench, and what they share. */
#ifndef BENCH_BENCH_H
#define BENCH_BENCH_H

#include <corot/model.h>
#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>

#include "app/cli.h"

int command_kernels(int argc, char **argv);
int command_solvers(int argc, char **argv);
int command_example(int argc, char **argv);
int command_memory(int argc, char **argv);
int command_frames(int argc, char **argv);

/* The bar of corot-bench run, as a box. */
corot_status example_model(const corot_box *box, const char *strain, corot_model **model);

/* A whole number from 1 to `most`. */
bool parse_count(const char *text, int most, int *number);

/* Options of a command that has none but --json. Returns -1 to go on, else the exit code. */
int only_json(const char *program, const char *help, int argc, char **argv, bool *json);

#endif
