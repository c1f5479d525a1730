/* What the supports of a scenario hold the body with, at rest: see reactions.csv in write_csv.h. */
#ifndef COROT_APP_RUN_REACTIONS_H
#define COROT_APP_RUN_REACTIONS_H

#include <jansson.h>

#include "writer.h"

typedef struct reactions reactions;

/* Begins reactions.csv and adds a row a moment, of a state that stands still. */
extern const writer_ops reactions_writer;

/* {"GROUP": [fx, fy, fz], ...} of the last row [N], zeros before the first; NULL: no memory. */
json_t *reactions_last(const reactions *r);

#endif
