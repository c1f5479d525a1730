/* What the supports of a scenario hold the body with, at rest: see reactions.csv in write_csv.h. */
#ifndef COROT_APP_RUN_REACTIONS_H
#define COROT_APP_RUN_REACTIONS_H

#include "app/scenario/scenario.h"

typedef struct reactions reactions;

/* Begins DIR/reactions.csv. Scenario and model must outlive it. */
corot_status reactions_create(const char *dir, const scenario *s, const corot_model *model,
                              reactions **out);

/* Adds a row: of the elastic force `internal` on all nodes [nnode], where they have moved by
   `displacement` [nnode], under the loads of the scenario's end times `factor`. */
corot_status reactions_add(reactions *r, double factor, const double (*displacement)[3],
                           const double (*internal)[3]);

/* {"GROUP": [fx, fy, fz], ...} of the last row [N], zeros before the first; NULL: no memory. */
json_t *reactions_last(const reactions *r);

/* Closes the table and reports an error that shows up then; the last row remains readable. */
corot_status reactions_close(reactions *r);

/* Takes NULL. */
void reactions_destroy(reactions *r);

#endif
