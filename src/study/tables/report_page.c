/* report.html beside what it shows. */
#include "report_page.h"

#include <stdio.h>
#include <stdlib.h>

#include "app/folder/folder.h"
#include "app/text/say.h"
#include "report/command/report.h"

corot_status study_page(const char *dir, bool quiet) {
  char *path = folder_path(dir, "report.html");
  if (!path) return COROT_ENOMEM;
  corot_status status = report_write(dir, path);
  if (status == COROT_OK && !quiet) say("%s: to look at, with any browser\n", path);
  free(path);
  return status;
}
