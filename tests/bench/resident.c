/* Out of /proc, in kB. */
#include "resident.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

void resident_begin(void) {
  FILE *f = fopen("/proc/self/clear_refs", "w");
  if (!f) return;
  fputs("5", f);
  fclose(f);
}
