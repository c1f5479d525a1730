/* How much memory there can be for this process. */
#ifndef COROT_CORE_BASE_MEMORY_LIMIT_H
#define COROT_CORE_BASE_MEMORY_LIMIT_H

#include "sisters.h"

typedef struct corot_memory_limit {
  double machine;   /* [byte] of the machine, or of the control group that the process is in */
  double process;   /* [byte] the same, or less where the address space is limited */
  const char *what; /* what limits the process, for messages; static */
} corot_memory_limit;

/* Infinite where the system does not say. What is in use at the moment does not count: a choice
   that depends on this is the same in the next run. */
COROT_SISTERS corot_memory_limit corot_memory_limits(void);

#endif
