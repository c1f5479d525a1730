/* Names are compared with those of the inventory, and contents only where names do not tell. */
#include "folder_owner.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/text/json_text.h"
#include "checkpoint_file.h"
#include "core/mesh/read/reader.h"
#include "folder.h"
#include "folder_lock.h"
#include "inventory.h"

/* --- A folder of a run --- */

static bool is_result(const json_t *json) {
  const char *status = json_string_value(json_object_get(json, "status"));
  const json_t *versions = json_object_get(json, "versions");
  return status && json_is_integer(json_object_get(json, "exit_code")) &&
         json_is_string(json_object_get(versions, "corot")) &&
         (strcmp(status, "ok") == 0 || strcmp(status, "failed") == 0 ||
          strcmp(status, "interrupted") == 0);
}

/* What is no regular file is not opened: it may be a pipe. */
corot_status folder_result(const char *dir, json_t **out) {
  char *path = folder_path(dir, "result.json"), *text = NULL;
  if (!path) return COROT_ENOMEM;
  struct stat info;
  size_t size;
  json_t *json = NULL;
  corot_status status = COROT_OK;
  if (lstat(path, &info) == 0 && S_ISREG(info.st_mode)) {
    status = corot_file_load(path, &text, &size);
    if (status == COROT_OK) status = json_text_parse(path, text, size, &json);
  }
  free(text);
  free(path);
  if (status == COROT_EFORMAT) status = COROT_OK;
  if (status == COROT_OK && is_result(json)) *out = json_incref(json);
  json_decref(json);
  return status;
}

bool folder_is_over(const json_t *result) {
  const char *status = json_string_value(json_object_get(result, "status"));
  return status && strcmp(status, "ok") == 0;
}

static corot_status has_mark(const char *dir, bool *ours) {
  json_t *result = NULL;
  COROT_TRY(folder_result(dir, &result));
  *ours = result != NULL;
  json_decref(result);
  return *ours ? COROT_OK : checkpoint_file_stands(dir, ours);
}

corot_status folder_is_ours(const char *dir, bool *ours) {
  bool found = false;
  COROT_TRY(folder_lock_stands(dir, &found));
  if (!found) COROT_TRY(has_mark(dir, &found));
  *ours = found;
  return COROT_OK;
}

corot_status folder_is_cut(const char *dir, bool *cut) {
  json_t *result = NULL;
  COROT_TRY(checkpoint_file_stands(dir, cut));
  if (!*cut) return COROT_OK;
  COROT_TRY(folder_result(dir, &result));
  *cut = !folder_is_over(result);
  json_decref(result);
  return COROT_OK;
}

corot_status folder_permit_anew(const char *dir) {
  bool cut = false;
  COROT_TRY(folder_is_cut(dir, &cut));
  if (!cut) return COROT_OK;
  return corot_fail(COROT_EIO,
                    "%s: has the checkpoint of a run that was cut; go on with corot run --resume, "
                    "name another folder, or lose it and say --force",
                    dir);
}

/* --- What would be replaced --- */

static corot_status refuse(const char *path, const char *writer) {
  return corot_fail(COROT_EIO,
                    "%s: is not of corot, whose %s would replace it; name another place, or say "
                    "--force",
                    path, writer);
}

corot_status folder_permit_name(const char *dir, const char *name, const char *writer) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  struct stat info;
  corot_status status = COROT_OK;
  if (lstat(path, &info) == 0)
    status = refuse(path, writer);
  else if (!folder_says_absent(errno))
    status = corot_fail(COROT_EIO, "%s: cannot be looked at: %s", path, strerror(errno));
  free(path);
  return status;
}

static corot_status permit_frames(const char *dir) {
  char *fields = folder_path(dir, INVENTORY_FIELDS);
  if (!fields) return COROT_ENOMEM;
  DIR *d = opendir(fields);
  corot_status status = COROT_OK;
  if (!d && !folder_says_absent(errno))
    status = corot_fail(COROT_EIO, "%s: cannot list it: %s", fields, strerror(errno));
  for (struct dirent *entry; d && status == COROT_OK && (entry = readdir(d));)
    if (inventory_is_frame(entry->d_name))
      status = folder_permit_name(fields, entry->d_name, "run");
  if (d) closedir(d);
  free(fields);
  return status;
}

corot_status folder_permit_page(const char *dir) {
  char *path = folder_path(dir, "report.html");
  if (!path) return COROT_ENOMEM;
  corot_status status = file_permit(path, FOLDER_PAGE_MARK);
  free(path);
  return status;
}

/* One that does not begin as one does is somebody's own, of the same name. */
static corot_status permit_checkpoint(const char *dir) {
  char *path = folder_path(dir, CHECKPOINT_NAME);
  if (!path) return COROT_ENOMEM;
  corot_status status = file_permit(path, CHECKPOINT_MARK);
  free(path);
  return status;
}

corot_status folder_permit(const char *dir, bool locked) {
  bool ours = locked;
  if (!ours) COROT_TRY(has_mark(dir, &ours));
  if (ours) {
    COROT_TRY(permit_checkpoint(dir));
    return folder_permit_page(dir);
  }
  for (int i = 0; i < INVENTORY_SIZE; i++)
    COROT_TRY(folder_permit_name(dir, inventory[i].name, inventory[i].writer));
  return permit_frames(dir);
}

corot_status file_permit(const char *path, const char *mark) {
  char start[1025];
  struct stat info;
  if (lstat(path, &info) != 0 || !S_ISREG(info.st_mode)) return COROT_OK; /* seen to elsewhere */
  int fd = open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  ssize_t got = fd >= 0 ? read(fd, start, sizeof start - 1) : -1;
  int why = errno;
  if (fd >= 0) close(fd);
  if (got < 0) return corot_fail(COROT_EIO, "%s: cannot read it: %s", path, strerror(why));
  start[got] = '\0';
  if (strstr(start, mark)) return COROT_OK;
  return corot_fail(COROT_EIO,
                    "%s: is not a file that corot has written; name another place, or say --force",
                    path);
}
