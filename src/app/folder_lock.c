/* The lock is flock's, not the file: a file that a killed process left locks nothing. */
#include "folder_lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "folder.h"

enum { OWNER = 320 }; /* a process and the name of a host */

/* What the holder has written, up to the end of the line. */
static void read_owner(int fd, char owner[OWNER]) {
  ssize_t size = pread(fd, owner, OWNER - 1, 0);
  owner[size > 0 ? size : 0] = '\0';
  owner[strcspn(owner, "\n")] = '\0';
}

static void write_owner(int fd) {
  char host[256] = "", owner[OWNER];
  gethostname(host, sizeof host - 1);
  int length = snprintf(owner, sizeof owner, "process %ld on %s\n", (long)getpid(), host);
  if (ftruncate(fd, 0) == 0 && pwrite(fd, owner, (size_t)length, 0) < length)
    (void)ftruncate(fd, 0); /* it is for messages only */
}

/* Whether the file is still the one of this name: who leaves removes it. */
static bool is_current(int fd, const char *path) {
  struct stat held, now;
  return fstat(fd, &held) == 0 && lstat(path, &now) == 0 && held.st_ino == now.st_ino &&
         held.st_dev == now.st_dev;
}

static corot_status take(const char *dir, folder_lock *l) {
  char owner[OWNER];
  for (bool current = false; !current;) {
    l->fd = open(l->path, O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (l->fd < 0) return corot_fail(COROT_EIO, "%s: cannot open it: %s", l->path, strerror(errno));
    bool busy = flock(l->fd, LOCK_EX | LOCK_NB) != 0;
    int why = errno;
    read_owner(l->fd, owner);
    if (busy && why == EWOULDBLOCK)
      return corot_fail(COROT_EIO, "%s: %s is writing there; wait for it, or name another folder",
                        dir, *owner ? owner : "another process");
    if (busy && why != EOPNOTSUPP && why != ENOLCK)
      return corot_fail(COROT_EIO, "%s: cannot lock it: %s", l->path, strerror(why));
    current = is_current(l->fd, l->path);
    if (!current) close(l->fd);
  }
  if (*owner && !(l->taken = strdup(owner))) return corot_fail(COROT_ENOMEM, "out of memory");
  write_owner(l->fd);
  return COROT_OK;
}

corot_status folder_enter(const char *dir, folder_lock *lock) {
  folder_lock l = {.fd = -1};
  COROT_TRY(folder_make(dir));
  if (!(l.path = folder_path(dir, ".lock-run"))) return COROT_ENOMEM;
  corot_status status = take(dir, &l);
  if (status == COROT_OK) {
    *lock = l;
    return COROT_OK;
  }
  if (l.fd >= 0) close(l.fd);
  free(l.path);
  free(l.taken);
  return status;
}

void folder_leave(folder_lock *lock) {
  if (!lock->path) return;
  unlink(lock->path);
  close(lock->fd);
  free(lock->path);
  free(lock->taken);
  *lock = (folder_lock){.fd = -1};
}
