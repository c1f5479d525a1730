/* Whose folder it is, and who is at work there. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/folder/folder_owner.h"
#include "app/text/escape.h"
#include "store.h"

#define SHARD_LOCK ".lock-%d-of-%d" /* the name of its file */

/* A lock passes on to the runs, which hold it until they are over. Those of a study that was killed
   die with it, but not in the same instant: hence a little patience. */
enum { TRIES = 40 };
static void pause_between_tries(void) { nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL); }

/* *lock: a descriptor, or -1: another process holds it. */
static corot_status try_lock(const char *dir, const char *name, int mode, int *lock) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  int fd = open(path, O_RDWR | O_CREAT, 0666);
  bool taken = fd >= 0 && flock(fd, mode | LOCK_NB) == 0;
  corot_status status = COROT_OK;
  if (!taken && (fd < 0 || (errno != EWOULDBLOCK && errno != EINTR)))
    status = corot_fail(COROT_EIO, "%s: cannot be locked: %s", path, strerror(errno));
  free(path);
  if (!taken && fd >= 0) close(fd);
  if (status == COROT_OK) *lock = taken ? fd : -1;
  return status;
}

static corot_status is_busy(const char *dir) {
  return corot_fail(COROT_EINVAL, "%s: another study is at work here", dir);
}

static corot_status take_lock(const char *dir, const char *name, int mode, int *lock) {
  int fd = -1;
  for (int tries = 0; tries < TRIES && fd < 0; tries++) {
    if (tries > 0) pause_between_tries();
    COROT_TRY(try_lock(dir, name, mode, &fd));
  }
  if (fd < 0) return is_busy(dir);
  *lock = fd;
  return COROT_OK;
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

/* In a folder that is no study's: what a study would replace. */
static corot_status permit_files(const char *dir) {
  static const char *const name[] = {"study.json",  "table.json", "table.csv", "index.sqlite",
                                     "budget.json", "limit.json", "solve.json"};
  for (size_t i = 0; i < sizeof name / sizeof *name; i++)
    COROT_TRY(folder_permit_name(dir, name[i], "study"));
  return COROT_OK;
}

/* The study that has the folder; NULL: none has, and it may be taken. */
static corot_status read_owner(const char *dir, bool force, manifest **owner) {
  char *path = folder_path(dir, "study.json");
  if (!path) return COROT_ENOMEM;
  bool there;
  *owner = NULL;
  corot_status status = folder_look(path, &there);
  free(path);
  if (status == COROT_OK && there) status = manifest_read(dir, owner);
  if (status != COROT_OK && status != COROT_EFORMAT) return status;
  if (!*owner && !force) COROT_TRY(permit_files(dir));
  status = force ? COROT_OK : folder_permit_page(dir);
  if (status == COROT_OK) return COROT_OK;
  manifest_destroy(*owner);
  return status;
}

/* Writes study.json if it is new, or says more than it did. */
static corot_status claim(const char *dir, const manifest *m, bool force) {
  manifest *before;
  COROT_TRY(read_owner(dir, force, &before));
  if (!before) return manifest_write(m, dir);
  corot_status status = check_owner(dir, m, before);
  bool same = json_equal(before->root, m->root);
  manifest_destroy(before);
  COROT_TRY(status);
  return same ? COROT_OK : manifest_write(m, dir);
}

void store_leave(store_lock lock) {
  if (lock.whole >= 0) close(lock.whole);
  if (lock.part >= 0) close(lock.part);
}

/* --- Shards --- */

/* A shard that another process holds, of another number of parts; "": there is none. */
static corot_status find_stranger(const char *dir, int nshard, size_t size, char *name) {
  name[0] = '\0';
  DIR *d = opendir(dir);
  if (!d) return corot_fail(COROT_EIO, "%s: cannot list it: %s", dir, strerror(errno));
  corot_status status = COROT_OK;
  for (struct dirent *entry; status == COROT_OK && !*name && (entry = readdir(d));) {
    int i, n, end = 0, fd = -1;
    bool other = sscanf(entry->d_name, SHARD_LOCK "%n", &i, &n, &end) == 2 && !entry->d_name[end] &&
                 n != nshard;
    if (!other) continue;
    status = try_lock(dir, entry->d_name, LOCK_EX, &fd);
    if (status == COROT_OK && fd < 0) snprintf(name, size, "%d/%d", i, n);
    if (status == COROT_OK && fd >= 0) close(fd);
  }
  closedir(d);
  return status;
}

/* While .lock-study is held, of which there is one: whoever looks for others is not looked for. */
static corot_status try_shard(const char *dir, int shard, int nshard, size_t size, char *stranger,
                              int *part) {
  char name[64];
  int looking = -1, fd = -1;
  snprintf(name, sizeof name, SHARD_LOCK, shard, nshard);
  COROT_TRY(take_lock(dir, ".lock-study", LOCK_EX, &looking));
  corot_status status = find_stranger(dir, nshard, size, stranger);
  if (status == COROT_OK && !*stranger) status = try_lock(dir, name, LOCK_EX, &fd);
  close(looking);
  if (status == COROT_OK) *part = fd;
  return status;
}

static corot_status take_shard(const char *dir, int shard, int nshard, int *part) {
  char stranger[32] = "";
  int fd = -1;
  for (int tries = 0; tries < TRIES && fd < 0; tries++) {
    if (tries > 0) pause_between_tries();
    COROT_TRY(try_shard(dir, shard, nshard, sizeof stranger, stranger, &fd));
  }
  if (fd < 0 && *stranger)
    return corot_fail(COROT_EINVAL,
                      "%s: shard %s is at work here, and this is %d/%d: all must be of the same "
                      "number of parts; wait for it, or take that number",
                      dir, stranger, shard, nshard);
  if (fd < 0) return is_busy(dir);
  *part = fd;
  return COROT_OK;
}

/* Shards begin at the same time: one after the other they look at study.json. */
static corot_status enter_shard(const char *dir, const manifest *m, int shard, int nshard,
                                bool force, int *part) {
  int claiming = -1;
  COROT_TRY(take_shard(dir, shard, nshard, part));
  COROT_TRY(take_lock(dir, ".lock-study", LOCK_EX, &claiming));
  corot_status status = claim(dir, m, force);
  close(claiming);
  return status;
}

corot_status store_enter(const char *dir, const manifest *m, int shard, int nshard, bool force,
                         store_lock *lock) {
  bool sharded = nshard > 1;
  store_lock l = {-1, -1};
  COROT_TRY(folder_make(dir));
  COROT_TRY(take_lock(dir, ".lock", sharded ? LOCK_SH : LOCK_EX, &l.whole));
  corot_status status =
      sharded ? enter_shard(dir, m, shard, nshard, force, &l.part) : claim(dir, m, force);
  if (status == COROT_OK)
    *lock = l;
  else
    store_leave(l);
  return status;
}
