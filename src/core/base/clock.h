/* A clock for how long things take. */
#ifndef COROT_CORE_BASE_CLOCK_H
#define COROT_CORE_BASE_CLOCK_H

#include "sisters.h"

/* Wall time since some instant [s]. On one thread it never goes back, even if that of the system
   does: what such a jump takes away is added from then on. */
COROT_SISTERS double corot_wall_clock(void);

#endif
