/* Processes that run side by side, each a program of its own: what becomes of one is no matter to
   the others, nor to us. There is one pool at a time.

   While it exists the signals that ask for an end (app/run/stop.h) are handed on to all of them. If
   this process dies, so do they (Linux). */
#ifndef COROT_STUDY_EXECUTE_POOL_H
#define COROT_STUDY_EXECUTE_POOL_H

#include <corot/base.h>
#include <stdbool.h>

enum { POOL_MAX = 1024 };

/* size: 1 to POOL_MAX, so many processes at once. */
corot_status pool_open(int size);

/* Waits for all that are left, and leaves the signals as they were. */
void pool_close(void);

bool pool_is_full(void);
bool pool_is_empty(void);

/* The signal that asked for an end; 0: none did. No process should be started after it. */
int pool_signal(void);

/* Starts this program anew with arguments of its own (argv[0] its name, NULL at the end). What it
   prints goes to the file `messages`. `job` is for pool_wait. After `timeout` seconds (0: never) it
   gets SIGALRM, and again every few seconds. */
corot_status pool_start(int job, const char *const *argv, const char *messages, double timeout);

/* Waits until one has ended. Stores its job and how it ended: an exit code, or minus the number of
   the signal that killed it. */
corot_status pool_wait(int *job, int *ended);

/* The same, but for so many seconds at most; then *job is -1. */
corot_status pool_wait_for(double seconds, int *job, int *ended);

#endif
