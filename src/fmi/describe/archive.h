/* The archive that an FMU is: a zip file, which appears under its name when it is whole. Its bytes
   depend on nothing but what is put into it. */
#ifndef COROT_FMI_DESCRIBE_ARCHIVE_H
#define COROT_FMI_DESCRIBE_ARCHIVE_H

#include <corot/base.h>
#include <stddef.h>

typedef struct archive archive;

/* Begins a file beside `path`. COROT_EIO: it cannot be made, or this build of corot has no library
   that makes zip files. COROT_ENOMEM. */
corot_status archive_open(const char *path, archive **out);

/* Adds an entry: bytes, or a file. COROT_EIO. */
corot_status archive_add(archive *a, const char *name, const void *data, size_t bytes);
corot_status archive_add_file(archive *a, const char *name, const char *path);

/* Puts it in its place. COROT_EIO. The archive is gone in any case. */
corot_status archive_close(archive *a);

/* Leaves no trace of it. Takes NULL. */
void archive_abandon(archive *a);

#endif
