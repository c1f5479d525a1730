/* What an error budget runs: a scenario, and the same with one approximation after the other taken
   away. */
#ifndef COROT_STUDY_BUDGET_BUDGET_PLAN_H
#define COROT_STUDY_BUDGET_BUDGET_PLAN_H

#include "app/scenario/scenario.h"

typedef enum budget_kind {
  BUDGET_ALGEBRA,    /* Newton's and the linear solver's tolerance */
  BUDGET_TIME,       /* the steps */
  BUDGET_LOAD_STEPS, /* of an equilibrium: the whole load at once, for short steps of it */
  BUDGET_FRAME_AGE,  /* held or extrapolated frames, for those found in every evaluation */
  BUDGET_FRAME_RULE, /* warp frames, for polar ones */
  BUDGET_HIERARCHY,  /* frames of coarser tets, for each tet's own */
  BUDGET_STRAIN,     /* the measure, for green */
  BUDGET_SPACE,      /* the mesh: of four-node tets for ten-node ones, of these for the next
                        octasection */
  BUDGET_KINDS,
} budget_kind;

enum {
  BUDGET_SETTINGS = 4,
  BUDGET_SETTING_SIZE = 192,
  BUDGET_TRIES = 2, /* to find a reference of time that is better than what it judges */
};

/* What takes one approximation away. */
typedef struct budget_part {
  budget_kind kind;
  int nset;
  char set[BUDGET_SETTINGS][BUDGET_SETTING_SIZE]; /* as after --set, in order */
} budget_part;

typedef struct budget_plan {
  int npart;
  budget_part part[BUDGET_KINDS]; /* those that the scenario makes, in the order of budget_kind;
                                     the age of frames before time, if steps are what ends it */
  bool by_order;                  /* the part of space is that to ten-node tets */
  budget_part check;         /* replaces part TIME: an independent method, for how far that is to be
                                trusted; nset = 0: there is none */
  budget_part algebra_check; /* the same of part ALGEBRA: tolerances ten times those of the part */
} budget_plan;

/* What is asked for. */
typedef struct budget_options {
  bool skip[BUDGET_KINDS]; /* parts that are not looked at */
  bool still;              /* of the equilibrium, as corot static finds it */
  int levels;              /* of the mesh: 2, 3, or 0: three if they can be paid for */
} budget_options;

extern const char *const budget_names[BUDGET_KINDS]; /* "time integration" */

/* What to change if that part of the plan is the largest, of a run or of an equilibrium. */
const char *budget_remedy(const budget_plan *plan, budget_kind kind, bool still);

/* Relative tolerance that stands for no error of time, against that of the scenario. */
double budget_tight_rtol(const scenario *s);

/* `order`: of the tets of its mesh. */
void budget_plan_make(const scenario *s, int order, budget_plan *plan);

/* The same for the scenario's equilibrium, which knows no time. */
void budget_plan_make_static(const scenario *s, int order, budget_plan *plan);

/* What replaces the part of time and its check where the first tolerance was too coarse to judge
   the run: `attempt` from 1 on, each a hundredth of the one before. Returns the tolerance, or 0
   where there is none that double precision could keep. */
double budget_plan_tighten(const scenario *s, int attempt, budget_part *reference,
                           budget_part *check);

/* The settings of a finer mesh, level 1 or 2: so many octasections on, or the first of these is the
   step to ten-node tets. A mass that is lumped on request is consistent there, as it is by default:
   lumped, they would not be the better ones. */
void budget_plan_finer(const budget_plan *plan, const scenario *s, int level, budget_part *part);

/* A ten-node tet counts as so many four-node ones, where it is asked whether a finer mesh can be
   afforded: a guess, of the work of a step. */
#define BUDGET_TETS_PER_TET10 10

/* Whether a run is made unasked: `work` is its steps, of an equilibrium Newton iterations, times
   tets; some minutes on one processor are. NaN is not. */
bool budget_plan_affords(bool still, double work, double tets);

/* Takes a kind of part out of the plan, if it is there. */
void budget_plan_skip(budget_plan *plan, budget_kind kind);

#endif
