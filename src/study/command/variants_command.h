/* What the commands that make runs of one scenario share: their arguments, and how they end. */
#ifndef COROT_STUDY_COMMAND_VARIANTS_COMMAND_H
#define COROT_STUDY_COMMAND_VARIANTS_COMMAND_H

#include <getopt.h>

#include "app/scenario/scenario.h"
#include "study/execute/execute.h"

typedef struct variants_arguments {
  execute_options options;
  int nset;
  const char **set;     /* [nset] "KEY=VALUE" */
  int nasked;           /* so many of the last ask for a --quantity */
  const char *asked_by; /* the option that asked for them; NULL: --quantity */
  bool json;
} variants_arguments;

typedef struct variants_command {
  const char *program, *help;
  const char *suffix;        /* of the default folder, out/MODELSUFFIX */
  const struct option *more; /* options of its own, or NULL */
  int (*take)(void *context, int option, const char *value); /* one of them: -1, or an exit code */
  /* After all options, NULL or: -1, or an exit code. May add a setting for each option with a
     value of its own that was given. */
  int (*ready)(void *context, variants_arguments *a);
  /* The scenario has the settings. Returns the exit code. */
  int (*go)(void *context, const scenario *s, const variants_arguments *a);
  void *context;
} variants_command;

/* The whole command; returns the exit code. */
int variants_command_run(const variants_command *c, int argc, char **argv);

/* A quantity of the command line, and the setting that asks a scenario for it. */
typedef struct quantity_option {
  char text[QUANTITY_TEXT], name[QUANTITY_TEXT]; /* as it is printed; of its key */
  char setting[2 * QUANTITY_TEXT + 16];
} quantity_option;

/* --quantity TEXT: -1, or an exit code. */
int variants_take_quantity(const char *program, const char *text, quantity_option *out);

/* The same of an option of another name. */
int variants_take_option(const char *program, const char *option, const char *text,
                         quantity_option *out);

/* A failure of the scenario: of a --quantity by that name, not by the setting that asks for it. */
corot_status variants_retell(const variants_arguments *a, corot_status status);

/* Words and exit code of one that a signal ended. */
int variants_interrupted(int signal_number);

#endif
