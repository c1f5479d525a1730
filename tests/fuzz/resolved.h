/* What every accepted scenario keeps to. */
#ifndef FUZZ_RESOLVED_H
#define FUZZ_RESOLVED_H

#include "app/scenario/scenario.h"

/* Ends the process unless the scenario's text, with all defaults, reads back as the same. */
void check_resolved(const scenario *s);

#endif
