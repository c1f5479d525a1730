/* What is wrong with a mesh, gathered so that it can be told all at once. */
#include <string.h>

#include "mesh.h"

enum { TOLD = 10 };

bool corot_faults_tell(const corot_mesh_faults *faults) { return faults->n < TOLD; }

void corot_faults_add(corot_mesh_faults *faults) {
  size_t n = strlen(corot_error()), room = sizeof faults->text - 1 - faults->length;
  if (faults->n++ >= TOLD || room < 2) return;
  if (faults->length > 0) {
    faults->text[faults->length++] = '\n';
    room--;
  }
  if (n > room) n = room;
  memcpy(faults->text + faults->length, corot_error(), n);
  faults->length += n;
}

corot_status corot_faults_fail(const corot_mesh_faults *faults, corot_status status) {
  if (faults->n == 0) return COROT_OK;
  int length = (int)faults->length;
  if (faults->n <= TOLD) return corot_fail(status, "%.*s", length, faults->text);
  return corot_fail(status, "%.*s\nand %d more", length, faults->text, faults->n - TOLD);
}
