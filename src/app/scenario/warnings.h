/* Warnings: what a scenario may ask for and a run may do, but whoever uses the answer should know.
   They are made here and nowhere else, of three kinds of knowledge; each has a code of the table
   below, a word that stays, and a text of whole sentences with the numbers that matter and what to
   do next. In result.json and other JSON a warning is {"code", "text"}. */
#ifndef COROT_APP_SCENARIO_WARNINGS_H
#define COROT_APP_SCENARIO_WARNINGS_H

#include <corot/modes.h>

#include "scenario.h"

typedef struct observed observed;

typedef enum warning_code {
  /* Before a run. */
  WARNING_MENDED,
  WARNING_CUT,
  WARNING_LOST,
  WARNING_LOCKING,
  WARNING_PARTS,
  WARNING_UNHELD,
  WARNING_PROBE,
  WARNING_INTEGRATOR,
  WARNING_THREADS,
  WARNING_RTOL, /* or after it */
  /* After it. */
  WARNING_ATOL,
  WARNING_LEDGER,
  WARNING_DISSIPATION,
  WARNING_STRAIN,
  WARNING_INVERTED,
  WARNING_SPACE,
  WARNING_BENDING,
  WARNING_STEP,
  WARNING_OUTPUT,
  /* Of modes. */
  WARNING_UNDAMPED,
  WARNING_UNSTABLE,
  WARNING_SYMMETRIC,
  WARNING_QUANTITY,
  WARNING_CODES /* how many */
} warning_code;

typedef struct warning_kind {
  const char *word;  /* the code as people and programs read it */
  const char *about; /* when it is given */
} warning_kind;

/* By code; `corot check --warnings` prints it. */
extern const warning_kind warning_kinds[WARNING_CODES];

typedef struct warning {
  warning_code code;
  char *text;
} warning;

typedef struct warnings {
  int n;
  warning *item; /* [n] */
} warnings;

/* Adds one; printf's rules, cut at 1023 characters. */
corot_status warnings_add(warnings *w, warning_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The list is empty and can be used again. */
void warnings_free(warnings *w);

/* What was mended in a mesh file, or lost in one that was written: MENDED, CUT, LOST. */
corot_status warnings_of_report(const corot_mesh_report *report, warnings *w);

/* What a mesh alone gives rise to: PARTS. */
corot_status warnings_of_mesh(const corot_mesh *mesh, warnings *w);

/* What scenario and model do, before the first step of a run, or of a search for an equilibrium. */
corot_status warnings_before(const scenario *s, const corot_model *model, bool statics,
                             warnings *w);

/* What came of a run, or of a search for an equilibrium (`statics`): see outputs.h. */
corot_status warnings_after(const scenario *s, const corot_model *model, const observed *seen,
                            bool statics, warnings *w);

/* What modes leave out, and what they show. */
corot_status warnings_of_modes(const scenario *s, const corot_modes *modes, warnings *w);

/* [{"code", "text"}, ...], the caller's to json_decref; NULL: no memory. */
json_t *warnings_json(const warnings *w);

/* Those from number `from` on, each on a line of its own: HEAD, the text, the code in brackets. */
void warnings_print(const warnings *w, int from, const char *head, FILE *out);

#endif
