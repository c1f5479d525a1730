/* What the program says of itself. */
#ifndef COROT_MAIN_HELP_H
#define COROT_MAIN_HELP_H

#include <stdio.h>

/* A command as the list has it. */
typedef struct listed_command {
  const char *name;
  int (*run)(int argc, char **argv);
  const char *group;             /* what this and the following are for; NULL: as the one before */
  const char *arguments, *about; /* about NULL: it is not in the list */
} listed_command;

/* The help of the whole program, around the list of the commands in `table`, which an entry without
   a name ends. */
void print_help(const listed_command *table, FILE *out);

/* `corot --version`: the version, the commit, and the libraries that this process has found. */
int print_version(int argc, char **argv);

#endif
