/* A mesh that owns copies of all arrays. */
#include <corot/mesh.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/sized.h"

/* malloc'd copy of count * size bytes; NULL for none. */
static void *copy_array(const void *from, size_t count, size_t size, bool *failed) {
  if (!count) return NULL;
  void *to = malloc(count * size);
  if (to) memcpy(to, from, count * size);
  *failed |= !to;
  return to;
}

corot_status corot_mesh_copy(const corot_mesh *mesh, corot_mesh **copy) {
  bool failed = false;
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(copy));
  corot_mesh *m = calloc(1, sizeof *m);
  if (!m) goto no_memory;
  m->nnode = mesh->nnode;
  m->x = copy_array(mesh->x, mesh->nnode, sizeof *m->x, &failed);
  m->ntet = mesh->ntet;
  m->tet = copy_array(mesh->tet, mesh->ntet, sizeof *m->tet, &failed);
  if (mesh->mid) m->mid = copy_array(mesh->mid, mesh->ntet, sizeof *m->mid, &failed);
  if (mesh->ngroup) m->group = calloc(mesh->ngroup, sizeof *m->group);
  if (failed || (mesh->ngroup && !m->group)) goto no_memory;

  m->ngroup = mesh->ngroup;
  for (int k = 0; k < mesh->ngroup; k++) {
    const corot_group *from = &mesh->group[k];
    corot_group *to = &m->group[k];
    *to = (corot_group){.nnode = from->nnode, .ntri = from->ntri, .ntet = from->ntet};
    to->name = copy_array(from->name, strlen(from->name) + 1, 1, &failed);
    to->node = copy_array(from->node, from->nnode, sizeof *to->node, &failed);
    to->tri = copy_array(from->tri, from->ntri, sizeof *to->tri, &failed);
    to->tet = copy_array(from->tet, from->ntet, sizeof *to->tet, &failed);
  }
  if (failed) goto no_memory;
  *copy = m;
  return COROT_OK;

no_memory:
  corot_mesh_destroy(m);
  return corot_fail(COROT_ENOMEM, "no memory for a copy of the mesh");
}
