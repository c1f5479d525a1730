/* What a failed allocation comes to. */
#ifndef COROT_APP_TEXT_NO_MEMORY_H
#define COROT_APP_TEXT_NO_MEMORY_H

#include <corot/base.h>

static inline corot_status no_memory(void) { return corot_fail(COROT_ENOMEM, "out of memory"); }

#endif
