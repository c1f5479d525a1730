/* One writer a folder: a lock that the system lets go of when the process ends, however it ends. */
#ifndef COROT_APP_FOLDER_FOLDER_LOCK_H
#define COROT_APP_FOLDER_FOLDER_LOCK_H

#include <corot/base.h>
#include <stdbool.h>

typedef struct folder_lock {
  int fd;
  char *path;   /* of the file that holds the lock, and says whose it is; NULL: none is held */
  char *taken;  /* whose it was, if that process ended without leaving; or NULL */
  char *result; /* DIR/result.json */
  bool keeps;   /* if there is no result.json when it is left, the file stays: a mark that what is
                   there   is a run's. Set it when the folder may be written to. */
} folder_lock;

/* Makes the folder and takes it for this process, by DIR/.lock-run. COROT_EIO: another process
   writes there, which the message names; or the folder is not to be written to; or a file of this
   name is no lock of a run. */
corot_status folder_enter(const char *dir, folder_lock *lock);

/* Takes one that holds nothing, too. */
void folder_leave(folder_lock *lock);

/* Whether a run has left its lock there, or holds it. */
corot_status folder_lock_stands(const char *dir, bool *stands);

/* Whether the process that holds it, by what it has written there, lives: one of another machine is
   taken to. Takes no lock. */
bool folder_lock_is_alive(const char *dir);

/* The name of its file in a folder; and the lock itself: a descriptor, or -1 with errno, which is
   EWOULDBLOCK where another process holds it. Safe in a handler of signals. */
#define FOLDER_LOCK_NAME ".lock-run"
int folder_lock_try(const char *path);

#endif
