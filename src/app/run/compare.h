/* Passive comparison: on the states of a run, whatever measure it is integrated with, the internal
   forces of other strain measures against those of green, the geometrically exact one. */
#ifndef COROT_APP_RUN_COMPARE_H
#define COROT_APP_RUN_COMPARE_H

#include <corot/ode.h>

typedef struct comparison comparison;

/* Begins DIR/compare.csv (write_csv.h) for `measure` [nmeasure]. The model and the names must
   outlive the comparison. */
corot_status comparison_open(const char *dir, const corot_model *model, int nmeasure,
                             const char *const *measure, comparison **out);

/* Adds the row of one moment; u is [n]. */
corot_status comparison_row(comparison *c, corot_state *state, double t, const double *u);

/* Reports an error that shows up on closing the file. Takes NULL; the comparison is gone either
   way. */
corot_status comparison_close(comparison *c);

#endif
