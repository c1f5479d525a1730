/* What was mended in a mesh, in words. */
#include <string.h>

#include "mesh.h"

corot_status corot_report_add(corot_mesh_report *report, corot_mended what, int count,
                              const char *text) {
  corot_remark *more = realloc(report->remark, ((size_t)report->nremark + 1) * sizeof *more);
  if (more) report->remark = more;
  char *copy = malloc(strlen(text) + 1);
  if (!more || !copy) {
    free(copy);
    return corot_fail(COROT_ENOMEM, "out of memory: a remark about a mesh");
  }
  report->remark[report->nremark++] =
      (corot_remark){.what = what, .count = count, .text = strcpy(copy, text)};
  return COROT_OK;
}

void corot_mesh_report_destroy(corot_mesh_report *report) {
  if (!report) return;
  for (int i = 0; i < report->nremark; i++) free(report->remark[i].text);
  free(report->remark);
  free(report);
}
