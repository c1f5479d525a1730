/* Names in the order of the table below, then the frames by number. */
#include "folder_files.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "folder.h"
#include "hash.h"
#include "json_text.h"

static const char *const names[] = {"probes.csv",  "energy.csv",  "steps.csv",
                                    "history.csv", "compare.csv", "reactions.csv",
                                    "groups.json", "states.bin",  "fields.pvd"};
enum { NNAME = sizeof names / sizeof *names };

/* Its entry for an open file; NULL: no memory. */
static corot_status describe(int fd, const char *path, const char *name, json_t **entry) {
  char digest[HASH_SIZE];
  long long size;
  if (fsync(fd) != 0 && errno != EINVAL)
    return corot_fail(COROT_EIO, "%s: cannot write to the disk: %s", path, strerror(errno));
  COROT_TRY(hash_file(fd, path, &size, digest));
  *entry = json_pack("{s:s, s:I, s:s}", "name", name, "size", (json_int_t)size, "sha256", digest);
  return *entry ? COROT_OK : corot_fail(COROT_ENOMEM, "%s: out of memory", path);
}

/* Adds a file if it is there, which *found tells. What is no regular file has no contents. */
static corot_status add(const char *dir, const char *name, json_t *list, bool *found) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  struct stat info;
  json_t *entry = NULL;
  corot_status status = COROT_OK;
  bool there = lstat(path, &info) == 0;
  if (!there && errno != ENOENT && errno != ENOTDIR)
    status = corot_fail(COROT_EIO, "%s: cannot be looked at: %s", path, strerror(errno));
  *found = there && S_ISREG(info.st_mode);
  int fd = *found ? open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC) : -1;
  if (*found && fd < 0)
    status = corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno));
  if (fd >= 0) {
    status = describe(fd, path, name, &entry);
    close(fd);
  }
  if (entry && json_array_append_new(list, entry))
    status = corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  free(path);
  return status;
}

corot_status folder_files(const char *dir, json_t **list) {
  json_t *made = json_array();
  bool found = true;
  char frame[64];
  corot_status status = made ? COROT_OK : corot_fail(COROT_ENOMEM, "%s: out of memory", dir);
  for (int i = 0; i < NNAME && status == COROT_OK; i++) status = add(dir, names[i], made, &found);
  found = true;
  for (int i = 0; found && status == COROT_OK; i++) {
    snprintf(frame, sizeof frame, "fields/fields_%06d.vtu", i);
    status = add(dir, frame, made, &found);
  }
  if (status == COROT_OK)
    *list = made;
  else
    json_decref(made);
  return status;
}

static corot_status check_one(const char *dir, const json_t *file) {
  const char *name = json_string_value(json_object_get(file, "name"));
  json_int_t size = json_integer_value(json_object_get(file, "size"));
  if (!name) return corot_fail(COROT_EFORMAT, "%s/result.json: a file has no name", dir);
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  struct stat info;
  corot_status status = COROT_OK;
  bool there = stat(path, &info) == 0;
  if (!there && errno != ENOENT && errno != ENOTDIR)
    status = corot_fail(COROT_EIO, "%s: cannot be looked at: %s", path, strerror(errno));
  else if (!there)
    status = corot_fail(COROT_EFORMAT, "%s: result.json lists it, and it is not there", path);
  else if (info.st_size != (off_t)size)
    status = corot_fail(COROT_EFORMAT, "%s: has %lld bytes where result.json says %lld", path,
                        (long long)info.st_size, (long long)size);
  free(path);
  return status;
}

corot_status folder_check(const char *dir, const json_t *result) {
  const json_t *file;
  size_t i;
  json_array_foreach(json_object_get(result, "files"), i, file) { COROT_TRY(check_one(dir, file)); }
  return COROT_OK;
}
