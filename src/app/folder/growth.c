/* Files are looked at first, and cut when all of them are known to be what they were. */
#include "growth.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "folder.h"

void growth_exchange(pack *p, growth *g) {
  corot_pack_long(p, &g->size);
  corot_pack_bytes(p, &g->sum, sizeof g->sum);
}

static corot_status check_contents(int fd, const char *path, const growth *g) {
  growth found = growth_begin();
  char buffer[16384];
  while (found.size < g->size) {
    size_t left = (size_t)(g->size - found.size);
    ssize_t got = pread(fd, buffer, left < sizeof buffer ? left : sizeof buffer, found.size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return corot_fail(COROT_EIO, "%s: cannot read: %s", path, strerror(errno));
    if (got == 0) break;
    growth_add(&found, buffer, (size_t)got);
  }
  if (found.size == g->size && found.sum == g->sum) return COROT_OK;
  return corot_fail(COROT_EFORMAT, "%s: is not what it was at the checkpoint", path);
}

static corot_status check(int fd, const char *path, const growth *g) {
  struct stat info;
  if (fstat(fd, &info) != 0)
    return corot_fail(COROT_EIO, "%s: cannot read: %s", path, strerror(errno));
  if (info.st_size < g->size)
    return corot_fail(COROT_EFORMAT, "%s: has %lld bytes; it had %ld at the checkpoint", path,
                      (long long)info.st_size, g->size);
  if (g->sum != COROT_CHECKSUM) COROT_TRY(check_contents(fd, path, g));
  if (lseek(fd, g->size, SEEK_SET) == g->size) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: not a file one can write to anywhere", path);
}

corot_status growth_reopen(const char *path, const growth *g, int *fd) {
  struct stat info;
  if (lstat(path, &info) != 0 && folder_says_absent(errno))
    return corot_fail(COROT_EFORMAT, "%s: is not there, and was at the checkpoint", path);
  if (lstat(path, &info) == 0 && !S_ISREG(info.st_mode))
    return corot_fail(COROT_EIO, "%s: is not a regular file, and stays as it is", path);
  int opened = open(path, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  if (opened < 0) return corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno));
  corot_status status = check(opened, path, g);
  if (status == COROT_OK)
    *fd = opened;
  else
    close(opened);
  return status;
}

corot_status growth_cut(int fd, const char *path, const growth *g) {
  if (ftruncate(fd, g->size) == 0) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: cannot cut it to %ld bytes: %s", path, g->size,
                    strerror(errno));
}
