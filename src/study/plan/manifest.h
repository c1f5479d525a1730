/* study.json: a study in full, every run with its identity, as it stands in the study's folder. All
   that is done with a folder can be done from it. */
#ifndef COROT_STUDY_PLAN_MANIFEST_H
#define COROT_STUDY_PLAN_MANIFEST_H

#include "study.h"

/* One run of the program. */
typedef struct study_run {
  const char
      *hash; /* of resolved scenario, mesh, version and command: hashes.run of its result.json */
  const char *id; /* the first 16 digits, the name of its folder */
  int nset;
  const char **set; /* [nset] "KEY=VALUE" */
  double t_end;     /* of its scenario [s]; NaN: an older study.json does not say */
  double work; /* how much it is, as far as can be told beforehand, in a unit of its own (plan.h):
                  1 where the file does not say */
} study_run;

typedef struct study_cell {
  int run;                /* several cells may share one */
  const json_t *settings; /* an object: column and value */
  const char *series;
  double tolerance;          /* NaN: none */
  const char *tolerance_key; /* NULL: none */
  int reference;             /* -1: none */
} study_cell;

/* Two tight runs of the solid of some cells. */
typedef struct study_reference {
  int run[2];
  const char *method[2];
  double rtol;
  const json_t *settings; /* an object: what they have beside the base's values */
} study_reference;

typedef struct manifest {
  const char *title, *name, *base, *version; /* base: the scenario's path, absolute */
  const char *identity;                      /* the same: the same study, be it extended */
  const char *cost, *measure;
  int nquantity;
  study_quantity *quantity; /* [nquantity] that every run is asked for */
  int repeat;
  bool still; /* runs are searches for equilibria */
  int ncolumn;
  const char **column; /* [ncolumn] of the cells, in alphabetical order */
  int nrun, ncell, nreference;
  study_run *run;             /* [nrun] */
  study_cell *cell;           /* [ncell] by series, then from coarse to fine */
  study_reference *reference; /* [nreference] */
  json_t *root;               /* all of it; owns the texts */
} manifest;

/* Takes over the JSON; on failure, too. `where` begins the message of COROT_EFORMAT. */
corot_status manifest_from_json(json_t *root, const char *where, manifest **out);

/* DIR/study.json. COROT_EIO: there is none. */
corot_status manifest_read(const char *dir, manifest **out);
corot_status manifest_write(const manifest *m, const char *dir);

/* Takes NULL. */
void manifest_destroy(manifest *m);

#endif
