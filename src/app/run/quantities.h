/* The quantities of a scenario over the columns of its probes and energies: those of history.csv,
   at every step whether it is written or not. In result.json:

     quantities  {NAME: {of: the quantity as it was understood, value, t: when that was, of extremes
                 and values at a time [s], unit}}; where there is no value it is null, and `reason`
                 says why */
#ifndef COROT_APP_RUN_QUANTITIES_H
#define COROT_APP_RUN_QUANTITIES_H

#include <jansson.h>

#include "app/probe/probe.h"
#include "app/scenario/warnings.h"

typedef struct quantities quantities;

/* COROT_EFORMAT: one of them is of no column there is, or of none that statics have; the message
   has its place. For a scenario whose model stands, before a run. */
corot_status quantities_check(const scenario *s, const corot_model *model, bool statics);

/* The scenario and the probes must outlive them. */
corot_status quantities_create(const scenario *s, const probes *p, quantities **out);

/* Takes NULL. */
void quantities_destroy(quantities *q);

/* A row of the history: the ledger, the probes' columns, and the velocity of all nodes [nnode],
   NULL: none that goes with t. */
void quantities_row(quantities *q, const ledger *now, const double *probed,
                    const double (*velocity)[3]);

/* Whether there are any. */
bool quantities_wanted(const quantities *q);

/* Loads or supports bend or jump at the time of the last row. */
void quantities_break(quantities *q);

/* Writes or reads what has been seen so far, of the same quantities. */
void quantities_exchange(pack *p, quantities *q);

/* After the last row; before what follows. */
void quantities_close(quantities *q);

/* How many there are that have no value although the answer reaches far enough; and a warning for
   each. */
int quantities_unanswered(const quantities *q);
corot_status quantities_warn(const quantities *q, warnings *w);

/* A line for each on stderr. */
void quantities_tell(const quantities *q);

/* The part of result.json, the caller's to json_decref; NULL: no memory. */
json_t *quantities_json(const quantities *q);

#endif
