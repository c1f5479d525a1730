/* The files of a run that grow with it, each behind the same operations: a row of the table in
   outputs.c. */
#ifndef COROT_APP_RUN_WRITER_H
#define COROT_APP_RUN_WRITER_H

#include "app/folder/write_csv.h"
#include "app/probe/probe.h"
#include "steps_kept.h"

/* What is known before the first moment. It outlives the writers, but for `dir`. */
typedef struct writer_source {
  const char *dir;
  const scenario *scenario;
  const corot_model *model;
  const probes *probes;
  struct history *history; /* which writes history.csv by itself */
  steps_count *steps;      /* of steps.csv, kept up to date until that is closed */
  pack *from;              /* a checkpoint, which the writers go on from; NULL: they begin */
} writer_source;

/* A moment that is written. */
typedef struct moment {
  double t;                                        /* [s] */
  long number;                                     /* from 0 */
  bool last;                                       /* of the run */
  bool still;                                      /* an equilibrium */
  corot_state *state;                              /* for evaluations */
  const double *u, *v;                             /* [n] */
  const double (*displacement)[3], (*velocity)[3]; /* [nnode] */
  const ledger *ledger;
  const double *probed; /* [probes_ncolumn] */
} moment;

/* Who begins it: a run, a search for an equilibrium, or both. */
typedef enum writer_use { WRITER_COMMON, WRITER_OF_RUN, WRITER_OF_STATICS } writer_use;

/* What `open` makes is handed to the others. All but `open` and `close` may be NULL: nothing;
   `synchronise` and `cut` only where there is a table, or of what no run writes. */
typedef struct writer_ops {
  const char *file; /* its name, as in app/folder/inventory.c */
  writer_use use;
  bool (*wanted)(const scenario *s); /* NULL: in any case */
  /* From a checkpoint: the writer as it was then, if its files have all that it had written, which
     it only looks at. */
  corot_status (*open)(const writer_source *source, void **writer);
  /* Everything that can fail by what the body does there, before any file is written. */
  corot_status (*evaluate)(void *writer, const moment *now);
  corot_status (*moment)(void *writer, const moment *now);
  corot_status (*step)(void *writer, const step_row *row);
  /* Checkpoints: what it knows beside its table, then the table; the latter also for the next two.
   */
  corot_status (*pack)(void *writer, pack *p);
  table *(*table)(const void *writer);
  /* Without a table: what is written is on the disk; what was written after the checkpoint that it
     goes on from is taken away. */
  corot_status (*synchronise)(void *writer);
  corot_status (*cut)(void *writer);
  /* Ends the file, reports an error that shows up then, and frees the writer in any case. */
  corot_status (*close)(void *writer);
} writer_ops;

#endif
