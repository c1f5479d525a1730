/* One writer a folder: a lock that the system lets go of when the process ends, however it ends. */
#ifndef COROT_APP_FOLDER_LOCK_H
#define COROT_APP_FOLDER_LOCK_H

#include <corot/base.h>

typedef struct folder_lock {
  int fd;
  char *path;  /* of the file that holds the lock, and says whose it is; NULL: none is held */
  char *taken; /* whose it was, if that process ended without leaving; or NULL */
} folder_lock;

/* Makes the folder and takes it for this process, by DIR/.lock-run. COROT_EIO: another process
   writes there, which the message names; or the folder is not to be written to. */
corot_status folder_enter(const char *dir, folder_lock *lock);

/* Takes one that holds nothing, too. */
void folder_leave(folder_lock *lock);

#endif
