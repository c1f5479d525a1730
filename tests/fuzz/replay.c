/* Gives every file of some folders to a fuzz target, without libFuzzer: replay FOLDER... */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerInitialize(int *argc, char ***argv) __attribute__((weak));
int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

static void fail(const char *path) {
  perror(path);
  exit(1);
}

/* The input stands in a block of just its size, so that sanitizers see what reads past it. */
static void replay(const char *path) {
  FILE *file = fopen(path, "rb");
  if (!file || fseek(file, 0, SEEK_END) != 0) fail(path);
  long size = ftell(file);
  unsigned char *data = size >= 0 ? malloc((size_t)size + (size == 0)) : NULL;
  rewind(file);
  if (!data || fread(data, 1, (size_t)size, file) != (size_t)size) fail(path);
  fclose(file);
  puts(path);
  fflush(stdout); /* the last line names the input that ended the process */
  LLVMFuzzerTestOneInput(data, (size_t)size);
  free(data);
}

static int is_input(const struct dirent *entry) { return entry->d_name[0] != '.'; }

static int replay_folder(const char *dir) {
  struct dirent **entry;
  int n = scandir(dir, &entry, is_input, alphasort);
  if (n < 0) fail(dir);
  for (int i = 0; i < n; i++) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", dir, entry[i]->d_name);
    replay(path);
    free(entry[i]);
  }
  free(entry);
  return n;
}

int main(int argc, char **argv) {
  int n = 0;
  if (LLVMFuzzerInitialize && LLVMFuzzerInitialize(&argc, &argv) != 0) return 1;
  for (int i = 1; i < argc; i++) n += replay_folder(argv[i]);
  printf("%d inputs\n", n);
  return n > 0 ? 0 : 1;
}
