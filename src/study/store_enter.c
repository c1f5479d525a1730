/* Whose folder it is, and who is at work there. */
#include <app/escape.h>
#include <app/folder.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#include "store.h"

/* A lock passes on to the runs, which hold it until they are over. Those of a study that was killed
   die with it, but not in the same instant: hence a little patience. */
static corot_status take_lock(const char *dir, const char *name, int mode, int *lock) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  int fd = open(path, O_RDWR | O_CREAT, 0666), taken = -1;
  for (int tries = 0; fd >= 0 && tries < 40 && taken != 0; tries++) {
    if (tries > 0) nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
    taken = flock(fd, mode | LOCK_NB);
    if (taken != 0 && errno != EWOULDBLOCK && errno != EINTR) break;
  }
  corot_status status = COROT_OK;
  if (fd < 0 || (taken != 0 && errno != EWOULDBLOCK))
    status = corot_fail(COROT_EIO, "%s: cannot be locked: %s", path, strerror(errno));
  else if (taken != 0)
    status = corot_fail(COROT_EINVAL, "%s: another study is at work here", dir);
  free(path);
  if (status == COROT_OK)
    *lock = fd;
  else if (fd >= 0)
    close(fd);
  return status;
}

static corot_status check_owner(const char *dir, const manifest *m, const manifest *before) {
  if (strcmp(before->identity, m->identity) == 0) return COROT_OK;
  char title[200];
  if (strcmp(before->title, m->title) != 0)
    return corot_fail(COROT_EINVAL, "%s: belongs to the study \"%s\"; choose another folder", dir,
                      escape_line_cut(before->title, sizeof title, title));
  return corot_fail(COROT_EINVAL,
                    "%s: holds this study for another base, or for %s as it was before it was "
                    "changed; choose another folder",
                    dir, before->base);
}

/* Writes study.json if it is new, or says more than it did. */
static corot_status claim(const char *dir, const manifest *m) {
  manifest *before = NULL;
  char *path = folder_path(dir, "study.json");
  if (!path) return COROT_ENOMEM;
  bool there, same = false;
  corot_status looked = folder_look(path, &there);
  free(path);
  COROT_TRY(looked);
  if (there) {
    COROT_TRY(manifest_read(dir, &before));
    corot_status status = check_owner(dir, m, before);
    same = status == COROT_OK && json_equal(before->root, m->root);
    manifest_destroy(before);
    COROT_TRY(status);
  }
  return same ? COROT_OK : manifest_write(m, dir);
}

void store_leave(store_lock lock) {
  if (lock.whole >= 0) close(lock.whole);
  if (lock.part >= 0) close(lock.part);
}

/* Shards begin at the same time: one after the other they look at study.json. */
static corot_status enter_shard(const char *dir, const manifest *m, int shard, int nshard,
                                int *part) {
  char name[64];
  int claiming;
  snprintf(name, sizeof name, ".lock-%d-of-%d", shard, nshard);
  COROT_TRY(take_lock(dir, name, LOCK_EX, part));
  COROT_TRY(take_lock(dir, ".lock-study", LOCK_EX, &claiming));
  corot_status status = claim(dir, m);
  close(claiming);
  return status;
}

corot_status store_enter(const char *dir, const manifest *m, int shard, int nshard,
                         store_lock *lock) {
  bool sharded = nshard > 1;
  store_lock l = {-1, -1};
  COROT_TRY(folder_make(dir));
  COROT_TRY(take_lock(dir, ".lock", sharded ? LOCK_SH : LOCK_EX, &l.whole));
  corot_status status = sharded ? enter_shard(dir, m, shard, nshard, &l.part) : claim(dir, m);
  if (status == COROT_OK)
    *lock = l;
  else
    store_leave(l);
  return status;
}
