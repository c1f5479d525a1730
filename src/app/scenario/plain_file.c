/* Files that are read whole. */
#include "plain_file.h"

#include <sys/stat.h>

#include "core/mesh/read/reader.h"

enum { MOST_BYTES = 256 << 20 };

corot_status plain_file_load(const char *path, char **text, size_t *size) {
  struct stat about;
  if (stat(path, &about) == 0 && !S_ISREG(about.st_mode))
    return corot_fail(COROT_EIO, "%s: not a file", path);
  if (stat(path, &about) == 0 && about.st_size > MOST_BYTES)
    return corot_fail(COROT_EIO, "%s: larger than %d MiB, the limit of a table", path,
                      MOST_BYTES >> 20);
  return corot_file_load(path, text, size);
}
