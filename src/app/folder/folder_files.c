/* Names in the order of the inventory, then the frames by number. */
#include "folder_files.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/text/json_text.h"
#include "folder.h"
#include "hash.h"
#include "inventory.h"

/* Its entry for an open file of so many bytes. */
static corot_status describe(int fd, const char *path, const char *name, long long size, bool hasty,
                             json_t **entry) {
  char digest[HASH_SIZE];
  if (hasty) {
    *entry = json_pack("{s:s, s:I}", "name", name, "size", (json_int_t)size);
    return *entry ? COROT_OK : corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  }
  if (fsync(fd) != 0 && errno != EINVAL)
    return corot_fail(COROT_EIO, "%s: cannot write to the disk: %s", path, strerror(errno));
  COROT_TRY(hash_file(fd, path, &size, digest));
  *entry = json_pack("{s:s, s:I, s:s}", "name", name, "size", (json_int_t)size, "sha256", digest);
  return *entry ? COROT_OK : corot_fail(COROT_ENOMEM, "%s: out of memory", path);
}

/* Adds a file if it is there, which *found tells. What is no regular file has no contents. */
static corot_status add(const char *dir, const char *name, bool hasty, json_t *list, bool *found) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  struct stat info;
  json_t *entry = NULL;
  corot_status status = COROT_OK;
  /* links are not followed: only what the run itself has written counts */
  bool there = lstat(path, &info) == 0;
  if (!there && !folder_says_absent(errno))
    status = corot_fail(COROT_EIO, "%s: cannot be looked at: %s", path, strerror(errno));
  *found = there && S_ISREG(info.st_mode);
  int fd = *found ? open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC) : -1;
  if (*found && fd < 0)
    status = corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno));
  if (fd >= 0) {
    status = describe(fd, path, name, (long long)info.st_size, hasty, &entry);
    close(fd);
  }
  if (entry && json_array_append_new(list, entry))
    status = corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  free(path);
  return status;
}

corot_status folder_files(const char *dir, bool hasty, json_t **list) {
  json_t *made = json_array();
  bool found = true;
  char frame[64];
  corot_status status = made ? COROT_OK : corot_fail(COROT_ENOMEM, "%s: out of memory", dir);
  for (int i = 0; i < INVENTORY_SIZE && status == COROT_OK; i++)
    if (inventory[i].listed) status = add(dir, inventory[i].name, hasty, made, &found);
  found = true;
  for (int i = 0; found && status == COROT_OK; i++) {
    snprintf(frame, sizeof frame, "fields/fields_%06d.vtu", i);
    status = add(dir, frame, hasty, made, &found);
  }
  if (status == COROT_OK)
    *list = made;
  else
    json_decref(made);
  return status;
}

/* --- Whether they are what they were --- */

/* That its contents are those of an entry. */
static corot_status check_contents(const char *path, const json_t *file) {
  const char *listed = json_string_value(json_object_get(file, "sha256"));
  char digest[HASH_SIZE];
  long long size;
  int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno));
  corot_status status = hash_file(fd, path, &size, digest);
  close(fd);
  COROT_TRY(status);
  if (listed && strcmp(listed, digest) == 0) return COROT_OK;
  return corot_fail(COROT_EFORMAT, "%s: has other contents than when result.json was written",
                    path);
}

/* COROT_EFORMAT: it is not as listed. *there is set in any case. */
static corot_status check_one(const char *dir, const json_t *file, bool contents, bool *there) {
  const char *name = json_string_value(json_object_get(file, "name"));
  json_int_t size = json_integer_value(json_object_get(file, "size"));
  *there = false;
  if (!name) return corot_fail(COROT_EFORMAT, "%s/result.json: a file has no name", dir);
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  struct stat info;
  corot_status status = COROT_OK;
  /* from what costs least to what reads the file */
  *there = stat(path, &info) == 0;
  if (!*there && !folder_says_absent(errno))
    status = corot_fail(COROT_EIO, "%s: cannot be looked at: %s", path, strerror(errno));
  else if (!*there)
    status = corot_fail(COROT_EFORMAT, "%s: result.json lists it, and it is not there", path);
  else if (info.st_size != (off_t)size)
    status = corot_fail(COROT_EFORMAT, "%s: has %lld bytes where result.json says %lld", path,
                        (long long)info.st_size, (long long)size);
  else if (contents)
    status = check_contents(path, file);
  free(path);
  return status;
}

/* One that was made in haste: sizes must do. */
static bool is_interrupted(const json_t *result) {
  const char *status = json_string_value(json_object_get(result, "status"));
  return status && strcmp(status, "interrupted") == 0;
}

static corot_status check_all(const char *dir, const json_t *result, bool contents) {
  const json_t *file;
  size_t i;
  bool there;
  json_array_foreach(json_object_get(result, "files"), i, file) {
    COROT_TRY(check_one(dir, file, contents, &there));
  }
  return COROT_OK;
}

corot_status folder_check(const char *dir, const json_t *result) {
  return check_all(dir, result, false);
}

corot_status folder_verify(const char *dir, const json_t *result) {
  return check_all(dir, result, !is_interrupted(result));
}

corot_status folder_verify_file(const char *dir, const json_t *result, const char *name,
                                bool *lost) {
  const json_t *files = json_object_get(result, "files"), *file;
  size_t i;
  bool there;
  *lost = false;
  if (!json_is_array(files)) return COROT_OK;
  json_array_foreach(files, i, file) {
    const char *listed = json_string_value(json_object_get(file, "name"));
    if (!listed || strcmp(listed, name) != 0) continue;
    corot_status status = check_one(dir, file, !is_interrupted(result), &there);
    *lost = status == COROT_EFORMAT && !there;
    return *lost ? COROT_OK : status;
  }
  /* what is not listed must not be there */
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  corot_status status = folder_look(path, &there);
  if (status == COROT_OK && there)
    status = corot_fail(COROT_EFORMAT, "%s: is not among the files that result.json lists", path);
  free(path);
  return status;
}
