/* Passive comparison: on the states of a run, whatever measure it is integrated with, the internal
   forces of other strain measures against those of green, the geometrically exact one. */
#ifndef COROT_APP_RUN_COMPARE_H
#define COROT_APP_RUN_COMPARE_H

#include "writer.h"

/* compare.csv (write_csv.h) with a row a moment, where the scenario names measures. */
extern const writer_ops comparison_writer;

#endif
