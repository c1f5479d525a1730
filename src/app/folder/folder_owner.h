/* Whose folder it is: a run replaces what a run has left, and nothing of anybody else.

   A folder is a run's if its result.json is: a map with the status of a run, an exit code and the
   version of corot. Or if a run that was killed has left its lock or its checkpoint there. One that
   is cut, or is of another program, is somebody's own. Files with names that are not in inventory.h
   make no folder foreign: they stay where they are. */
#ifndef COROT_APP_FOLDER_FOLDER_OWNER_H
#define COROT_APP_FOLDER_FOLDER_OWNER_H

#include <corot/base.h>
#include <jansson.h>
#include <stdbool.h>

/* Whether the folder is one that a run has left. COROT_ENOMEM, COROT_EIO: that cannot be told. */
corot_status folder_is_ours(const char *dir, bool *ours);

/* The result.json that a run has left; *result stays as it is where there is none. The caller's to
   json_decref. And whether its run ended well. */
corot_status folder_result(const char *dir, json_t **result);
bool folder_is_over(const json_t *result);

/* Whether there is the checkpoint of a run that has not ended well. COROT_ENOMEM, COROT_EIO. And
   COROT_EIO if so: what takes the folder for something else would lose it. */
corot_status folder_is_cut(const char *dir, bool *cut);
corot_status folder_permit_anew(const char *dir);

/* Whether a run may write there. COROT_EIO names the first file that it would replace though no run
   has left it, such as a report.html that is no page of corot's. `locked`: a lock of a run was
   there; the process may hold its own by now. */
corot_status folder_permit(const char *dir, bool locked);

/* Of a folder that is not corot's: there is no file of that name, which `writer`, a command, would
   replace. And of any: its report.html is a page of corot's, or not there. COROT_EIO as above. */
corot_status folder_permit_name(const char *dir, const char *name, const char *writer);
corot_status folder_permit_page(const char *dir);

/* Whether a file that corot is to replace at `path` is its own, by how it begins: `mark` stands
   in its first 1024 bytes. One that is not there is. COROT_EIO: it is somebody else's. */
corot_status file_permit(const char *path, const char *mark);

/* The mark of the pages that corot writes. */
#define FOLDER_PAGE_MARK "<meta name=\"generator\" content=\"corot\">"

#endif
