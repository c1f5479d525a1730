/* The files of a run, as result.json vouches for them. */
#ifndef COROT_APP_FOLDER_FOLDER_FILES_H
#define COROT_APP_FOLDER_FOLDER_FILES_H

#include <corot/base.h>
#include <jansson.h>
#include <stdbool.h>

/* [{"name", "size", "sha256"}, ...] of what a run has left in `dir` beside result.json, each of
   which is on the disk by then, which takes as long as reading all of them. With `hasty` it is
   neither that nor is there a "sha256". The caller's to json_decref. COROT_EIO, COROT_ENOMEM. */
corot_status folder_files(const char *dir, bool hasty, json_t **list);

/* Whether they are there and of the size that result.json says: COROT_EFORMAT names the first that
   is not, COROT_EIO what the system does not show. A result without a list of files is taken at its
   word. Their contents are not read: what a failure of power leaves is empty or cut. */
corot_status folder_check(const char *dir, const json_t *result);

/* The same, and that their contents are what they were but for a run that was interrupted; all of
 * them are read, at some 250 MB/s. */
corot_status folder_verify(const char *dir, const json_t *result);

/* That DIR/NAME is what it was; COROT_EFORMAT: it is not, or was not there then. *lost: it was, and
   is not any more. */
corot_status folder_verify_file(const char *dir, const json_t *result, const char *name,
                                bool *lost);

#endif
