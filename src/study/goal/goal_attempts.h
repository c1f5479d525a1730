/* The runs by which a quantity's error is found: each a run of its own in the folder, made where it
   is missing. */
#ifndef COROT_STUDY_GOAL_GOAL_ATTEMPTS_H
#define COROT_STUDY_GOAL_GOAL_ATTEMPTS_H

#include "app/scenario/scenario.h"
#include "study/execute/execute_options.h"
#include "study/plan/manifest.h"

enum {
  ATTEMPT_MOST = 96, /* more than a search makes: tolerances and meshes end before */
  ATTEMPT_SETTINGS = 16,
  ATTEMPT_SETTING_SIZE = 2 * QUANTITY_TEXT + 16,
  ATTEMPT_LABEL_SIZE = 128,
  ATTEMPT_REASON_SIZE = 256,
};

/* What is varied of the scenario. */
typedef struct attempt_def {
  int order, refine;  /* of the mesh, as mesh.order, mesh.refine */
  int npass;          /* of local refinement */
  const char *method; /* of motion: integrator, and */
  double rtol;
  double until;       /* its end [s] */
  bool tight_algebra; /* the algebraic equations a hundred times as well as they need be */
  bool green;         /* in place of the scenario's strain measure */
} attempt_def;

typedef struct attempt {
  attempt_def def;
  char label[ATTEMPT_LABEL_SIZE];
  int nset;
  char set[ATTEMPT_SETTINGS][ATTEMPT_SETTING_SIZE];
  bool looked; /* the following are known */
  int at;      /* in the manifest */
  bool done;
  char reason[ATTEMPT_REASON_SIZE]; /* why there is no value */
  double value;                     /* NaN: none */
  double when;                      /* of an extreme [s]; NaN */
  int exit_code;                    /* of a run that failed; 0: not known */
  double largest;                   /* absolute value in the columns of its probe; NaN: not known */
  double cpu;                       /* [s] */
  double work;                      /* evaluations of forces and solutions of linear systems */
  double swing;                     /* largest kinetic over largest elastic energy; NaN */
  int tets, dofs;
} attempt;

typedef struct attempts {
  const scenario *scenario;
  const quantity *quantity;
  const char *name;   /* of the quantity */
  const char *column; /* of the quantity */
  bool still;
  int nset; /* of the command line, */
  const char *const *set;
  double cpu_limit; /* [s]; an attempt is ended when more than that may be spent */
  execute_options options;
  int n;
  attempt *all; /* [ATTEMPT_MOST] */
  manifest *manifest;
  char unit[64]; /* of the quantity; "": not yet known, or none */
  int signal_number;
} attempts;

corot_status attempts_begin(attempts *a);
void attempts_end(attempts *a);

/* The number of the attempt of that definition, planned if need be; -1: there are too many. */
int attempts_plan(attempts *a, attempt_def def);

/* Makes what is planned and missing. Where a->signal_number is not 0 afterwards, some are. */
corot_status attempts_make(attempts *a);

/* CPU time of all that are known [s]. */
double attempts_cpu(const attempts *a);

/* Where the run of attempt i lies; the caller's to free. NULL: no memory, which corot_error() says.
 */
char *attempts_folder(const attempts *a, int i);

/* "DIR/marks/N.txt": the passes of local refinement up to N; the caller's to free. */
char *attempts_marks(const attempts *a, int npass);

#endif
