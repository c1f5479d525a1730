/* The lock is flock's, not the file: a file that a killed process left locks nothing. */
#include "folder_lock.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "folder.h"

enum { OWNER = 320 }; /* a process and the name of a host */
#define OWNER_WORD "process "

/* What the holder has written, up to the end of the line. */
static void read_owner(int fd, char owner[OWNER]) {
  ssize_t size = pread(fd, owner, OWNER - 1, 0);
  owner[size > 0 ? size : 0] = '\0';
  owner[strcspn(owner, "\n")] = '\0';
}

/* Over what stands there, which is cut behind it: at any time it says that the folder is a run's.
 */
static void write_owner(int fd) {
  char host[256] = "", owner[OWNER];
  gethostname(host, sizeof host - 1);
  int length = snprintf(owner, sizeof owner, OWNER_WORD "%ld on %s\n", (long)getpid(), host);
  if (pwrite(fd, owner, (size_t)length, 0) < length || ftruncate(fd, length) != 0)
    (void)ftruncate(fd, 0); /* it is for messages only */
}

/* Whether the file is still the one of this name: who leaves removes it. */
static bool is_current(int fd, const char *path) {
  struct stat held, now;
  return fstat(fd, &held) == 0 && lstat(path, &now) == 0 && held.st_ino == now.st_ino &&
         held.st_dev == now.st_dev;
}

int folder_lock_try(const char *path) {
  for (;;) {
    int fd = open(path, O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (fd < 0) return -1;
    bool held = flock(fd, LOCK_EX | LOCK_NB) == 0;
    int why = errno;
    bool lockless = !held && (why == EOPNOTSUPP || why == ENOLCK);
    if ((held || lockless) && is_current(fd, path)) return fd;
    close(fd);
    errno = why;
    if (!held && !lockless) return -1;
  }
}

/* Whose it is, or was; "" where nobody has written that. */
static corot_status look(const char *path, char owner[OWNER]) {
  owner[0] = '\0';
  int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0 && folder_says_absent(errno)) return COROT_OK;
  if (fd < 0) return corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno));
  read_owner(fd, owner);
  close(fd);
  if (!*owner || strncmp(owner, OWNER_WORD, sizeof OWNER_WORD - 1) == 0) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: is no lock of a run; name another folder, or rename it", path);
}

static corot_status take(const char *dir, folder_lock *l) {
  char owner[OWNER];
  COROT_TRY(look(l->path, owner));
  l->fd = folder_lock_try(l->path);
  int why = errno;
  if (l->fd < 0 && why == EWOULDBLOCK) {
    COROT_TRY(look(l->path, owner));
    return corot_fail(COROT_EIO, "%s: %s is writing there; wait for it, or name another folder",
                      dir, *owner ? owner : "another process");
  }
  if (l->fd < 0) return corot_fail(COROT_EIO, "%s: cannot lock it: %s", l->path, strerror(why));
  read_owner(l->fd, owner);
  if (*owner && !(l->taken = strdup(owner))) return corot_fail(COROT_ENOMEM, "out of memory");
  write_owner(l->fd);
  return COROT_OK;
}

corot_status folder_lock_stands(const char *dir, bool *stands) {
  char *path = folder_path(dir, FOLDER_LOCK_NAME), owner[OWNER];
  if (!path) return COROT_ENOMEM;
  corot_status status = look(path, owner);
  free(path);
  if (status == COROT_OK) *stands = *owner;
  return status;
}

bool folder_lock_is_alive(const char *dir) {
  char *path = folder_path(dir, FOLDER_LOCK_NAME), owner[OWNER] = "", host[256] = "",
       name[257] = "";
  long pid = 0;
  bool known = path && look(path, owner) == COROT_OK &&
               sscanf(owner, OWNER_WORD "%ld on %256s", &pid, name) >= 1 && pid > 0;
  free(path);
  gethostname(host, sizeof host - 1);
  if (known && strcmp(host, name) == 0) return kill((pid_t)pid, 0) == 0 || errno == EPERM;
  return known;
}

corot_status folder_enter(const char *dir, folder_lock *lock) {
  folder_lock l = {.fd = -1};
  COROT_TRY(folder_make(dir));
  l.path = folder_path(dir, FOLDER_LOCK_NAME);
  l.result = folder_path(dir, "result.json");
  corot_status status = l.path && l.result ? take(dir, &l) : COROT_ENOMEM;
  if (status == COROT_OK) {
    *lock = l;
    return COROT_OK;
  }
  if (l.fd >= 0) close(l.fd);
  free(l.path);
  free(l.result);
  free(l.taken);
  return status;
}

void folder_leave(folder_lock *lock) {
  if (!lock->path) return;
  if (!lock->keeps || access(lock->result, F_OK) == 0) unlink(lock->path);
  close(lock->fd);
  free(lock->path);
  free(lock->result);
  free(lock->taken);
  *lock = (folder_lock){.fd = -1};
}
