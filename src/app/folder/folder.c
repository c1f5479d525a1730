/* Folders, and files written beside their place, synced, and moved there. */
#include "folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "inventory.h"

static corot_status make_one(const char *path) {
  if (mkdir(path, 0777) == 0) return COROT_OK;
  if (errno != EEXIST)
    return corot_fail(COROT_EIO, "%s: cannot make it: %s", path, strerror(errno));
  struct stat info;
  if (stat(path, &info) == 0 && S_ISDIR(info.st_mode)) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: exists and is not a folder", path);
}

corot_status folder_make(const char *path) {
  char *part = folder_path(path, "");
  if (!part) return COROT_ENOMEM;
  corot_status status = COROT_OK;
  for (char *c = part + 1; *c && status == COROT_OK; c++) {
    if (*c != '/') continue;
    *c = '\0';
    status = make_one(part);
    *c = '/';
  }
  free(part);
  return status;
}

char *folder_path(const char *dir, const char *name) {
  size_t size = strlen(dir) + strlen(name) + 2;
  char *path = malloc(size);
  if (!path) {
    corot_fail(COROT_ENOMEM, "%s/%s: out of memory", dir, name);
    return NULL;
  }
  snprintf(path, size, "%s/%s", dir, name);
  return path;
}

bool folder_says_absent(int why) { return why == ENOENT || why == ENOTDIR; }

corot_status folder_look(const char *path, bool *there) {
  *there = access(path, F_OK) == 0;
  if (*there || folder_says_absent(errno)) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: cannot be looked at: %s", path, strerror(errno));
}

char *folder_default(const char *path, const char *suffix) {
  const char *slash = strrchr(path, '/');
  const char *name = slash ? slash + 1 : path;
  const char *dot = strrchr(name, '.');
  int length = (int)(dot && dot > name ? (size_t)(dot - name) : strlen(name));
  size_t size = (size_t)length + strlen(suffix) + sizeof "out/";
  char *folder = malloc(size);
  if (folder)
    snprintf(folder, size, "out/%.*s%s", length, name, suffix);
  else
    corot_fail(COROT_ENOMEM, "out of memory");
  return folder;
}

/* What is written there replaces nothing. */
static bool is_device(const char *path) {
  struct stat info;
  return stat(path, &info) == 0 && (S_ISCHR(info.st_mode) || S_ISFIFO(info.st_mode));
}

static corot_status refuse(const char *path) {
  return corot_fail(COROT_EIO, "%s: is not a regular file, and stays as it is", path);
}

/* A file that is not there counts as removed. */
static corot_status remove_file(const char *dir, const char *name) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  struct stat info;
  corot_status status = COROT_OK;
  if (lstat(path, &info) == 0 && S_ISSOCK(info.st_mode))
    status = refuse(path);
  else if (!is_device(path) && unlink(path) != 0 && errno != ENOENT)
    status = corot_fail(COROT_EIO, "%s: cannot remove it: %s", path, strerror(errno));
  free(path);
  return status;
}

corot_status folder_remove_frames(const char *fields, long from) {
  DIR *d = opendir(fields);
  if (!d && errno == ENOENT) return COROT_OK;
  if (!d) return corot_fail(COROT_EIO, "%s: cannot list it: %s", fields, strerror(errno));
  corot_status status = COROT_OK;
  for (struct dirent *entry; status == COROT_OK && (entry = readdir(d));)
    if (inventory_is_frame(entry->d_name) && inventory_frame(entry->d_name) >= from)
      status = remove_file(fields, entry->d_name);
  closedir(d);
  return status;
}

corot_status folder_clean(const char *dir) {
  for (int i = 0; i < INVENTORY_SIZE; i++)
    if (inventory[i].cleaned) COROT_TRY(remove_file(dir, inventory[i].name));
  char *fields = folder_path(dir, INVENTORY_FIELDS);
  if (!fields) return COROT_ENOMEM;
  corot_status status = folder_remove_frames(fields, 0);
  free(fields);
  return status;
}

corot_status folder_clean_ends(const char *dir) {
  COROT_TRY(remove_file(dir, "result.json"));
  return remove_file(dir, "report.html");
}

corot_status file_check_regular(const char *path) {
  struct stat info;
  if (stat(path, &info) != 0 || S_ISREG(info.st_mode)) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: is %s, not a file", path,
                    S_ISDIR(info.st_mode) ? "a folder" : "a device or a pipe");
}

/* How a file of ours is opened for writing: never through a link, nor where something other than a
   regular file stands. What is written to a device of characters or to a pipe replaces nothing; a
   pipe must have its reader already. */
static corot_status find_flags(const char *path, int *flags) {
  struct stat info;
  *flags = O_WRONLY | O_CLOEXEC;
  if (is_device(path)) {
    *flags |= O_NONBLOCK;
    return COROT_OK;
  }
  *flags |= O_CREAT | O_NOFOLLOW;
  return lstat(path, &info) != 0 || S_ISREG(info.st_mode) ? COROT_OK : refuse(path);
}

/* Only to open it does not wait. */
static corot_status open_to_write(const char *path, int flags, int *fd) {
  int made = open(path, flags, 0666);
  if (made < 0 && errno == ENXIO && flags & O_NONBLOCK)
    return corot_fail(COROT_EIO, "%s: is a pipe that nobody reads", path);
  if (made < 0) return corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno));
  if (flags & O_NONBLOCK) fcntl(made, F_SETFL, fcntl(made, F_GETFL) & ~O_NONBLOCK);
  *fd = made;
  return COROT_OK;
}

corot_status file_create(const char *path, int *fd) {
  int flags;
  COROT_TRY(find_flags(path, &flags));
  return open_to_write(path, flags | (flags & O_CREAT ? O_TRUNC : 0), fd);
}

corot_status file_write(int fd, const char *path, const void *data, size_t size) {
  const char *rest = data;
  while (size > 0) {
    ssize_t written = write(fd, rest, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return corot_fail(COROT_EIO, "%s: cannot write: %s", path, strerror(errno));
    rest += written;
    size -= (size_t)written;
  }
  return COROT_OK;
}

static corot_status removed(const char *path) {
  return corot_fail(COROT_EIO, "%s: has been removed while it was written", path);
}

corot_status file_close(int fd, const char *path) {
  if (fd < 0) return COROT_OK;
  struct stat info;
  bool lost = fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_nlink == 0;
  bool closed = close(fd) == 0 || errno == EINTR;
  if (closed && lost) return removed(path);
  if (closed) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: cannot write: %s", path, strerror(errno));
}

/* A descriptor that cannot be synchronised (EINVAL: a pipe, some network folders) is no error. */
corot_status file_synchronise(int fd, const char *path) {
  if (fsync(fd) == 0 || errno == EINVAL) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: cannot write to the disk: %s", path, strerror(errno));
}

/* A file that a killed process left is taken away first: it may be somebody's other name of a file
   that is not to be written to. */
static corot_status create_temporary(const char *path, int *fd) {
  struct stat info;
  if (lstat(path, &info) == 0 && S_ISFIFO(info.st_mode)) return refuse(path); /* or wait for ever */
  int flags;
  COROT_TRY(find_flags(path, &flags));
  if (flags & O_CREAT) {
    unlink(path);
    flags |= O_EXCL;
  }
  return open_to_write(path, flags, fd);
}

static corot_status write_whole(const char *path, const void *data, size_t size, bool durable) {
  int fd = -1;
  COROT_TRY(create_temporary(path, &fd));
  corot_status status = file_write(fd, path, data, size);
  if (status == COROT_OK && durable) status = file_synchronise(fd, path);
  corot_status closed = file_close(fd, path);
  if (status == COROT_OK) status = closed;
  if (status != COROT_OK) unlink(path);
  return status;
}

corot_status file_put_in_place(const char *temporary, const char *path) {
  struct stat info;
  corot_status status = COROT_OK;
  if (lstat(path, &info) == 0 && !S_ISREG(info.st_mode))
    status = refuse(path);
  else if (lstat(temporary, &info) != 0)
    status = removed(temporary);
  else if (!S_ISREG(info.st_mode))
    status = refuse(temporary);
  else if (rename(temporary, path) != 0)
    status =
        corot_fail(COROT_EIO, "%s: cannot rename %s to it: %s", path, temporary, strerror(errno));
  if (status != COROT_OK) unlink(temporary);
  return status;
}

corot_status file_replace(const char *path, const char *temporary, const void *data, size_t size) {
  COROT_TRY(write_whole(temporary, data, size, false));
  return file_put_in_place(temporary, path);
}

/* The rename itself is durable once the folder is. */
static corot_status synchronise_folder_of(const char *path) {
  char *copy = folder_path(path, "");
  if (!copy) return COROT_ENOMEM;
  int fd = open(dirname(copy), O_RDONLY | O_CLOEXEC);
  free(copy);
  if (fd < 0) return COROT_OK; /* a folder that may be written but not read */
  corot_status status = file_synchronise(fd, path);
  close(fd);
  return status;
}

corot_status file_synchronise_named(const char *path) {
  int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno));
  corot_status status = file_synchronise(fd, path);
  close(fd);
  return status;
}

static corot_status put_durably(const char *path, const void *data, size_t size) {
  size_t length = strlen(path);
  char *temporary = malloc(length + 5);
  if (!temporary) return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  memcpy(temporary, path, length);
  memcpy(temporary + length, ".tmp", 5);

  corot_status status = write_whole(temporary, data, size, true);
  if (status == COROT_OK) status = file_put_in_place(temporary, path);
  free(temporary);
  return status;
}

corot_status file_replace_durably(const char *path, const void *data, size_t size) {
  COROT_TRY(put_durably(path, data, size));
  corot_status status = synchronise_folder_of(path);
  if (status != COROT_OK) unlink(path); /* what is said to have failed must not be found */
  return status;
}

corot_status file_renew_durably(const char *path, const void *data, size_t size) {
  COROT_TRY(put_durably(path, data, size));
  return synchronise_folder_of(path);
}
