/* Repetitions for the clock. */
#ifndef COROT_STUDY_EXECUTE_EXECUTE_TIMED_H
#define COROT_STUDY_EXECUTE_EXECUTE_TIMED_H

#include "execute_one.h"

/* The timed repetitions that are missing, one at a time. */
corot_status execution_time(execution *e);

#endif
