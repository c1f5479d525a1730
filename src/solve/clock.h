/* Wall time for the phases of a run. */
#ifndef COROT_SOLVE_CLOCK_H
#define COROT_SOLVE_CLOCK_H

#include "core/clock.h"

static inline double clock_wall(void) { return corot_wall_clock(); }

#endif
