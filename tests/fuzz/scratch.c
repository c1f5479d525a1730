/* Files are written anew for every input, so all failures here end the process. */
#include "scratch.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <corot/base.h>

enum { PATH = 512 };
static char root[PATH];

void require(bool condition, const char *what) {
  if (condition) return;
  fprintf(stderr, "%s: %s\n", what, corot_error());
  abort();
}

static void remove_below(const char *dir) {
  DIR *d = opendir(dir);
  for (struct dirent *entry; d && (entry = readdir(d));) {
    if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
    char path[2 * PATH];
    if (snprintf(path, sizeof path, "%s/%s", dir, entry->d_name) >= (int)sizeof path) continue;
    if (unlink(path) != 0) remove_below(path);
  }
  if (d) closedir(d);
  rmdir(dir);
}

static void remove_all(void) { remove_below(root); }

const char *scratch_make(void) {
  const char *in = getenv("TMPDIR");
  if (!in || !*in) in = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
  int length = snprintf(root, sizeof root - 200, "%s/corot-fuzz-XXXXXX", in);
  require(length > 0 && (size_t)length < sizeof root - 200 && mkdtemp(root), "no scratch folder");
  atexit(remove_all);
  return root;
}

const char *scratch_path(const char *name) {
  static char path[8][PATH];
  static int next;
  char *p = path[next++ % 8];
  require(snprintf(p, PATH, "%s/%s", root, name) < PATH, "a long path");
  return p;
}

void scratch_write(const char *name, const void *data, size_t size) {
  FILE *file = fopen(scratch_path(name), "wb");
  bool written = file && fwrite(data, 1, size, file) == size;
  require(file && fclose(file) == 0 && written, "no scratch file");
}

char *scratch_read(const char *name, size_t *size) {
  struct stat info;
  FILE *file = fopen(scratch_path(name), "rb");
  if (!file) return NULL;
  require(fstat(fileno(file), &info) == 0, "no size of a scratch file");
  *size = (size_t)info.st_size;
  char *data = malloc(*size + 1);
  require(data && fread(data, 1, *size, file) == *size, "a scratch file cannot be read");
  data[*size] = '\0';
  fclose(file);
  return data;
}

void scratch_remove(const char *name) { unlink(scratch_path(name)); }
