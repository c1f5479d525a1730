/* The last time in a table of a run, and the lock beside it. */
#define _GNU_SOURCE /* memrchr */
#include "reached.h"

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/folder/folder_lock.h"
#include "store.h"

enum { TAIL = 1 << 14 }; /* bytes: a row, and more */

/* The first cell of the last line, if it is whole, and is not the header; NaN: there is none. */
static double last_time(char *text, size_t size) {
  while (size > 0 && text[size - 1] != '\n') size--;
  if (size == 0) return NAN;
  text[--size] = '\0';
  char *line = memrchr(text, '\n', size), *end;
  if (!line) return NAN;
  double t = strtod(line + 1, &end);
  return end > line + 1 && (*end == ',' || *end == '\0') ? t : NAN;
}

double run_reached(const char *dir, const study_run *run) {
  char text[TAIL + 1];
  char *path = store_path(dir, run, "probes.csv");
  int fd = path ? open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC) : -1;
  free(path);
  if (fd < 0) return NAN;
  struct stat info;
  double t = NAN;
  if (fstat(fd, &info) == 0 && S_ISREG(info.st_mode)) {
    off_t from = info.st_size > TAIL ? info.st_size - TAIL : 0;
    ssize_t size = pread(fd, text, TAIL, from);
    if (size > 0) t = last_time(text, (size_t)size);
  }
  close(fd);
  double part = t / run->t_end; /* may be NaN */
  return part > 1 ? 1 : part;
}

bool run_is_alive(const char *dir, const study_run *run) {
  char *path = store_path(dir, run, "");
  bool alive = path && folder_lock_is_alive(path);
  free(path);
  return alive;
}
