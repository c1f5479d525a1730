/* Requests from outside to end: SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU, and SIGALRM, which is
   the time limit that a study sets.

   A run looks at stop_signal() where it can end in good order. Where it cannot within a second (a
   mesh is read, a large matrix factorised, gigabytes of a run that is over are read for their
   hashes, a disk does not answer), the handler of a timer puts a
   result.json in place that was prepared beforehand, and ends the process. The handlers call
   nothing but what POSIX calls safe in them. */
#ifndef COROT_APP_RUN_STOP_H
#define COROT_APP_RUN_STOP_H

#include <corot/base.h>
#include <stdbool.h>
#include <stddef.h>

enum { STOP_SIGNALS = 6 };
extern const int stop_signals[STOP_SIGNALS];

/* From here on such a signal is a request, not the end. One that is ignored (nohup) stays so, but
   for SIGINT, which shells ignore for what runs in the background. */
void stop_heed(void);

/* Asks for an end; safe in a handler. A second request ends the process at once, unless it follows
   within a fifth of a second: programs that run others may send a signal to the process and to its
   group. */
void stop_request(int signal_number);

/* The signal that asked for an end; 0: none did. */
int stop_signal(void);
void stop_forget(void);

/* The place of the signal's number, and of the time reached, in the text for stop_prepare():
   numbers of which the first occurrences are replaced. */
enum { STOP_NUMBER = 990000001, STOP_CODE = 990000002, STOP_REACHED = 990000003 };

/* What DIR/result.json is to say if the process has to end without being asked again. The text has
   STOP_NUMBER, STOP_CODE and STOP_REACHED in it, in this order. It holds until stop_release().
   It is written only where this process has the folder's lock, or gets it (folder_lock.h).
   COROT_ENOMEM; COROT_EINVAL: one of them is missing. */
corot_status stop_prepare(const char *dir, const char *text);
void stop_release(void);

/* The checkpoint that is to be put in place then, too, complete: the bytes stay until the next call
   or stop_release(); NULL: none is. For a folder that was prepared for. */
void stop_keep(const void *data, size_t size);

/* This process has taken the folder that was prepared for. */
void stop_hold(void);

/* How far the run has come, for that text [s]. */
void stop_reached(double t);

/* The run has seen the request, or puts its own result.json in place: it ends in good order,
   however long it takes. */
void stop_heeded(void);

#endif
