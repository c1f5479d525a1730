/* Wall time for the phases of a run. */
#ifndef COROT_SOLVE_PENCIL_WALL_CLOCK_H
#define COROT_SOLVE_PENCIL_WALL_CLOCK_H

#include "core/base/clock.h"

static inline double clock_wall(void) { return corot_wall_clock(); }

#endif
