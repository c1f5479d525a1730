/* The processors of this machine. */
#ifndef COROT_CORE_BASE_PROCESSORS_H
#define COROT_CORE_BASE_PROCESSORS_H

/* Those that this process may use; at least 1. */
int corot_processor_count(void);

#endif
