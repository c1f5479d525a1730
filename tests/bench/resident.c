/* Out of /proc, in kB. */
#include "resident.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

static double status_line(const char *name) {
  FILE *f = fopen("/proc/self/status", "r");
  char line[256];
  double bytes = 0;
  while (f && fgets(line, sizeof line, f))
    if (strncmp(line, name, strlen(name)) == 0) bytes = 1024 * strtod(line + strlen(name), NULL);
  if (f) fclose(f);
  return bytes;
}

double resident_now(void) { return status_line("VmRSS:"); }

double resident_most(void) { return status_line("VmHWM:"); }

/* What was given up goes back to the system first, so that all that is taken from now on shows. */
void resident_begin(void) {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  FILE *f = fopen("/proc/self/clear_refs", "w");
  if (!f) return;
  fputs("5", f);
  fclose(f);
}
