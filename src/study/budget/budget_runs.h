/* The runs of an error budget: planned, made, and read. */
#ifndef COROT_STUDY_BUDGET_BUDGET_RUNS_H
#define COROT_STUDY_BUDGET_BUDGET_RUNS_H

#include "budget_plan.h"
#include "study/execute/builds.h"
#include "study/execute/execute_options.h"
#include "study/measure/claim.h"

/* Runs: as given; the chain, one more approximation gone in each; each gone alone; the checks;
   finer references of time with a check each; the third level of the mesh. */
enum {
  NRUN_MAX = 2 * BUDGET_KINDS + 3 + 2 * BUDGET_TRIES + 1,
  NSET_MAX = (BUDGET_KINDS + 1) * BUDGET_SETTINGS,
  LABEL_SIZE = 64,
};

typedef struct budget_run {
  char label[LABEL_SIZE];
  int nset;
  const char *set[NSET_MAX]; /* [nset] the plan's */
  bool spare;                /* a try: if it fails, nothing is missing */
  bool looked;               /* the following are known */
  int at;                    /* in the manifest */
  trajectory states;         /* without records where the run failed */
  double cpu;                /* [s]; NaN: failed */
  double work;               /* steps, of an equilibrium Newton iterations, times tets; NaN */
  double tets;
  double *quantity; /* [scenario's nquantity]; NULL: failed */
  const char *status;
} budget_run;

typedef struct budgeting {
  const scenario *scenario;
  const budget_options *options;
  budget_plan plan;
  budget_part finer[BUDGET_TRIES][2]; /* references of time, and their checks */
  budget_part third;                  /* the third level */
  int place[BUDGET_KINDS];            /* of each kind in plan.part; -1: it is not there */
  int nrun;
  budget_run run[NRUN_MAX];
  int algebra_check, third_run;                                 /* runs; -1: there is none */
  int ntight, tight[BUDGET_TRIES + 1], check[BUDGET_TRIES + 1]; /* runs, ever finer */
  bool third_is_loose;                                          /* its steps are as given */
  char left_out[256]; /* why there is no third level; "": there is one */
  manifest *manifest;
  builds builds; /* of the runs that are done */
  yardstick *yardstick;
} budgeting;

/* Plans and makes all runs; where *signal_number is not 0 afterwards, some are missing. */
corot_status budget_runs_make(budgeting *b, int nset, const char *const *set,
                              const execute_options *options, int *signal_number);

/* What a run left; NULL: it failed, or `run` is -1. */
const trajectory *budget_states(const budgeting *b, int run);

int budget_chain_run(const budgeting *b, int part); /* without the approximation and those before */
int budget_before_run(const budgeting *b, int part); /* with it: its neighbour in the chain */
int budget_alone_run(const budgeting *b, int part);

/* Distances of two runs, the second taken as exact; n = 0 where either is not known. */
corot_status budget_distance(const budgeting *b, const trajectory *run, const trajectory *reference,
                             errors *out);

#endif
