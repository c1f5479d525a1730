/* The tables and the binary file of a run as writers; see write_csv.h, history.h and states.h. */
#ifndef COROT_APP_RUN_WRITERS_H
#define COROT_APP_RUN_WRITERS_H

#include "writer.h"

extern const writer_ops probes_writer, energy_writer, steps_writer, history_writer, states_writer;

#endif
