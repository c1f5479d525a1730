/* The folder a run writes to, and files in it that are never seen half-written. */
#ifndef COROT_APP_FOLDER_FOLDER_H
#define COROT_APP_FOLDER_FOLDER_H

#include <corot/base.h>
#include <stdbool.h>
#include <stddef.h>

/* Makes the folder and those above it; one that exists is fine. */
corot_status folder_make(const char *path);

/* Removes what an earlier run left: what inventory.h says, and the frames of fields. All other
   files stay. Call this where folder_owner.h permits it. */
corot_status folder_clean(const char *dir);

/* Removes what is made once a run is over: result.json, and a page of it. */
corot_status folder_clean_ends(const char *dir);

/* Removes the frames in DIR/fields whose number is `from` or above. */
corot_status folder_remove_frames(const char *fields, long from);

/* "DIR/NAME", the caller's to free; NULL where memory ran out (the message is set). */
char *folder_path(const char *dir, const char *name);

/* Whether an errno says that nothing of that name is there. */
bool folder_says_absent(int why);

/* Whether something of that name is there: COROT_EIO where the system does not say. */
corot_status folder_look(const char *path, bool *there);

/* Where results go if nothing is said: "out/NAMESUFFIX" for "some/folder/NAME.yaml"; the caller's
   to free, NULL as above. */
char *folder_default(const char *path, const char *suffix);

/* Fails with COROT_EIO where `path` is there and no regular file: to read a folder gives nonsense,
   and a pipe may keep its reader for ever. */
corot_status file_check_regular(const char *path);

/* Opens `path` for writing from its beginning, made or emptied first. Stores a descriptor.

   This and the following never write through a link to a file, and never replace what is not a
   regular file (a folder, a device, a link): COROT_EIO, and it stays as it is. Nor do they wait for
   somebody to read a pipe of that name: COROT_EIO. */
corot_status file_create(const char *path, int *fd);

/* Writes all of it, however often the system has to be asked. `path` is for the message. */
corot_status file_write(int fd, const char *path, const void *data, size_t size);

/* Closes `fd` (-1: does nothing); a delayed error of the disk shows up here, and that somebody has
   removed the file meanwhile. */
corot_status file_close(int fd, const char *path);

/* Renames `temporary`, which is complete, to `path`; where that fails it is removed. */
corot_status file_put_in_place(const char *temporary, const char *path);

/* Puts a file in place as a whole: `temporary` is written, then renamed to `path`. */
corot_status file_replace(const char *path, const char *temporary, const void *data, size_t size);

/* The same, and on the disk before it returns; the temporary file is PATH.tmp. If all but the last,
   the rename, is known to be on the disk, the file is removed again. */
corot_status file_replace_durably(const char *path, const void *data, size_t size);

/* The same, but for that: the file stays. What is replaced is worth keeping until this one is
   safe, and this one is whole. */
corot_status file_renew_durably(const char *path, const void *data, size_t size);

/* What is in an open file, or in the file or folder of that name, is on the disk. */
corot_status file_synchronise(int fd, const char *path);
corot_status file_synchronise_named(const char *path);

#endif
