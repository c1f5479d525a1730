/* Files of mesh.marks of any content: no crash, and what they make of a mesh is sound. */
#include <corot/mesh.h>

#include "app/scenario/marks_file.h"
#include "scratch.h"

#include <stdint.h>
#include <stdio.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc, (void)argv;
  scratch_make();
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0}, COROT_BOX_KUHN};
  corot_mesh *m = NULL, *again = NULL;
  require(corot_mesh_box(&box, &m) == COROT_OK, "no box");
  scratch_write("marks", data, size);
  corot_status status = marks_file_apply(scratch_path("marks"), &m);
  require(status == COROT_OK || status == COROT_EFORMAT, "not a clean failure");
  require(corot_mesh_create(m->nnode, (const double(*)[3])m->x, m->ntet, (const int(*)[4])m->tet,
                            &again) == COROT_OK,
          "an unsound mesh");
  corot_mesh_destroy(again);
  corot_mesh_destroy(m);
  return 0;
}
