/* Runs of one scenario that differ in settings which a command makes up. They are carried out as a
   study is, each a process with a folder of its own, and only where they are missing. */
#ifndef COROT_STUDY_EXECUTE_VARIANTS_H
#define COROT_STUDY_EXECUTE_VARIANTS_H

#include "execute.h"

typedef struct variant {
  const char *label; /* unlike any other */
  int nset;
  const char *const *set; /* [nset] "KEY=VALUE", in order */
} variant;

typedef struct variants {
  const char *what; /* they are for: the beginning of the title of the study that they make */
  const scenario *scenario;
  bool still; /* their equilibria, as of corot static */
  int nset;
  const char *const *set; /* [nset] "KEY=VALUE" for all of them, in order; the scenario has them */
  int nvariant;
  const variant *variant; /* [nvariant] */
} variants;

/* Carries out what is missing in options->dir; runs that fail do not stop the others. *out is the
   study; run [nvariant]: manifest.run of each variant. *signal_number: 0, or what ended it early.
   COROT_EFORMAT: a setting makes no scenario. */
corot_status variants_execute(const variants *v, const execute_options *options, manifest **out,
                              int *run, int *signal_number);

#endif
