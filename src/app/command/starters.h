/* The scenarios that `corot new` writes. */
#ifndef COROT_APP_COMMAND_STARTERS_H
#define COROT_APP_COMMAND_STARTERS_H

typedef struct starter {
  const char *name, *about, *text;
} starter;

extern const starter starters[];
extern const int nstarter;

#endif
