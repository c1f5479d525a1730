/* The space error in the end of a run, or of a search for an equilibrium, at the moment of the
   largest elastic energy: corot/space.h. It is left out where output.space_error says so and, where
   that says auto, where it may cost more than a tenth of the run and is not over in some 0.05 s,
   which is judged by counts of what was done, not by the clock: the same run always says the same.
 */
#ifndef COROT_APP_RUN_SPACE_H
#define COROT_APP_RUN_SPACE_H

#include <corot/space.h>
#include <jansson.h>

#include "app/probe/probe.h"
#include "run_options.h"

/* What a run has done, for its cost. */
typedef struct run_work {
  long nforce, nassembly, nfactor, nsolve;
  long niteration; /* of an iterative solver, whose factors are none */
} run_work;

/* Whether an estimate on a mesh of that many tets and degrees of freedom costs little beside it. */
bool space_is_cheap(double ntet, double n, const run_work *work);

typedef struct space_seen {
  const char *left_out; /* why there is no estimate, static; NULL: there is one, */
  double t;             /* of this moment [s] */
  corot_space_estimate estimate;
  double *probe;   /* [probes_ncolumn] and what is to be added to the columns of probes that are
                      displacements at a place [m]; NaN: of other probes */
  char worst[256]; /* "; probe NAME lacks (x, y, z) m", of the largest of these; "": of none */
  double wall_s;   /* it has taken [s] */
} space_seen;

/* What is looked at. */
typedef struct space_question {
  const scenario *scenario;
  const corot_model *model;
  const run_options *options;
  bool statics;
  bool ended_well; /* neither failed nor interrupted */
  run_work work;
  double t;            /* of the largest elastic energy [s], and */
  const double *u, *v; /* [ndof] displacement and velocity then */
  const probes *probes;
} space_question;

/* Whether so much memory [byte] will do for an estimate on that many four-node tets. */
bool space_fits(double ntet, double memory);

/* *out is to be released by space_clear. That there is no solution is a reason to leave it out.
   COROT_ENOMEM. */
corot_status space_ask(const space_question *q, space_seen *out);
void space_clear(space_seen *s);

/* "; space error 3.4 %", for a line that says more; "" if it is not known. */
void space_words(const space_seen *seen, size_t size, char *text);

/* What result.json says of it; NULL: no memory. */
json_t *space_json(const probes *p, const space_seen *seen);

#endif
