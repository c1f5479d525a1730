/* report.html beside what it shows. */
#include "page.h"

#include <app/folder.h>
#include <app/say.h>
#include <report/report.h>
#include <stdio.h>
#include <stdlib.h>

corot_status study_page(const char *dir, bool quiet) {
  char *path = folder_path(dir, "report.html");
  if (!path) return COROT_ENOMEM;
  corot_status status = report_write(dir, path);
  if (status == COROT_OK && !quiet) say("%s: to look at, with any browser\n", path);
  free(path);
  return status;
}
