/* Zip files by minizip; where it is missing, the reason why there are none. */
#include "archive.h"

#ifdef COROT_HAVE_MINIZIP

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zip.h>

#include "app/text/no_memory.h"

struct archive {
  zipFile zip;
  char *path, *draft; /* where it is to be, and is until then */
};

enum { JANUARY_1980 = ((1 << 5) | 1) << 16 }; /* the first day that the format knows */

static corot_status refused(const archive *a) {
  return corot_fail(COROT_EIO, "%s: cannot write: %s", a->path,
                    errno ? strerror(errno) : "the zip file was refused");
}

static void release(archive *a) {
  free(a->path);
  free(a->draft);
  free(a);
}

/* As a file of the user's would be, not as mkstemp() makes it. */
static bool make_draft(archive *a) {
  int fd = mkstemp(a->draft);
  if (fd < 0) return false;
  mode_t mask = umask(0);
  umask(mask);
  fchmod(fd, 0666 & ~mask);
  close(fd);
  a->zip = zipOpen64(a->draft, APPEND_STATUS_CREATE);
  if (!a->zip) unlink(a->draft);
  return a->zip != NULL;
}

corot_status archive_open(const char *path, archive **out) {
  size_t size = strlen(path) + 8;
  archive *a = calloc(1, sizeof *a);
  if (!a) return no_memory();
  a->path = strdup(path);
  a->draft = malloc(size);
  corot_status status = a->path && a->draft ? COROT_OK : no_memory();
  if (status == COROT_OK) {
    errno = 0;
    snprintf(a->draft, size, "%s.XXXXXX", path);
    if (!make_draft(a)) status = refused(a);
  }
  if (status)
    release(a);
  else
    *out = a;
  return status;
}

static bool begin(archive *a, const char *name) {
  const zip_fileinfo info = {.dosDate = JANUARY_1980};
  errno = 0;
  return zipOpenNewFileInZip64(a->zip, name, &info, NULL, 0, NULL, 0, NULL, Z_DEFLATED,
                               Z_DEFAULT_COMPRESSION, 1) == ZIP_OK;
}

corot_status archive_add(archive *a, const char *name, const void *data, size_t bytes) {
  const char *at = data;
  if (!begin(a, name)) return refused(a);
  for (size_t left = bytes; left > 0;) {
    unsigned now = left < 1u << 20 ? (unsigned)left : 1u << 20;
    if (zipWriteInFileInZip(a->zip, at, now) != ZIP_OK) return refused(a);
    at += now;
    left -= now;
  }
  return zipCloseFileInZip(a->zip) == ZIP_OK ? COROT_OK : refused(a);
}

corot_status archive_add_file(archive *a, const char *name, const char *path) {
  char buffer[16384];
  FILE *in = fopen(path, "rb");
  if (!in) return corot_fail(COROT_EIO, "%s: cannot read: %s", path, strerror(errno));
  bool written = begin(a, name);
  for (size_t got; written && (got = fread(buffer, 1, sizeof buffer, in)) > 0;)
    written = zipWriteInFileInZip(a->zip, buffer, (unsigned)got) == ZIP_OK;
  bool read = !ferror(in);
  fclose(in);
  if (!read) return corot_fail(COROT_EIO, "%s: cannot read", path);
  return written && zipCloseFileInZip(a->zip) == ZIP_OK ? COROT_OK : refused(a);
}

corot_status archive_close(archive *a) {
  errno = 0;
  bool whole = zipClose(a->zip, NULL) == ZIP_OK;
  corot_status status = whole && rename(a->draft, a->path) == 0 ? COROT_OK : refused(a);
  if (status) unlink(a->draft);
  release(a);
  return status;
}

void archive_abandon(archive *a) {
  if (!a) return;
  zipClose(a->zip, NULL);
  unlink(a->draft);
  release(a);
}

#else

corot_status archive_open(const char *path, archive **out) {
  (void)out;
  return corot_fail(COROT_EIO,
                    "%s: this corot was built without minizip, which writes FMUs: install "
                    "libminizip-dev, and build it again",
                    path);
}

corot_status archive_add(archive *a, const char *name, const void *data, size_t bytes) {
  (void)a, (void)name, (void)data, (void)bytes;
  return COROT_OK;
}

corot_status archive_add_file(archive *a, const char *name, const char *path) {
  (void)a, (void)name, (void)path;
  return COROT_OK;
}

corot_status archive_close(archive *a) {
  (void)a;
  return COROT_OK;
}

void archive_abandon(archive *a) { (void)a; }

#endif
