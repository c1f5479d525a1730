/* Creation and destruction of meshes. */
#include "mesh.h"

#include <string.h>

static corot_status copy_arrays(corot_mesh *mesh, int nnode, const double (*x)[3], int ntet,
                                const int (*tet)[4]) {
  mesh->nnode = nnode;
  mesh->ntet = ntet;
  COROT_TRY(COROT_ALLOC(mesh->x, nnode));
  COROT_TRY(COROT_ALLOC(mesh->tet, ntet));
  memcpy(mesh->x, x, (size_t)nnode * sizeof *x);
  memcpy(mesh->tet, tet, (size_t)ntet * sizeof *tet);
  return COROT_OK;
}

/* Hands out `m` if `status` is COROT_OK and it is sound, and destroys it otherwise. */
static corot_status finish(corot_status status, corot_mesh *m, corot_mesh **mesh) {
  const corot_mesh_names names = {.tet = "tet"};
  corot_mesh_faults faults = {0};
  corot_face *face = NULL;
  if (!status) status = corot_mesh_check(m, &names, &faults, &face);
  if (!status) status = corot_faults_fail(&faults, COROT_EINVAL);
  free(face);
  if (status)
    corot_mesh_destroy(m);
  else
    *mesh = m;
  return status;
}

corot_status corot_mesh_create(int nnode, const double (*x)[3], int ntet, const int (*tet)[4],
                               corot_mesh **mesh) {
  corot_mesh *m;
  COROT_TRY(corot_mesh_check_counts(nnode, ntet));
  COROT_TRY(COROT_GIVEN(x));
  COROT_TRY(COROT_GIVEN(tet));
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_ALLOC(m, 1));
  return finish(copy_arrays(m, nnode, x, ntet, tet), m, mesh);
}

static corot_status copy_arrays_2(corot_mesh *mesh, int nnode, const double (*x)[3], int ntet,
                                  const int (*tet)[10]) {
  mesh->nnode = nnode;
  mesh->ntet = ntet;
  COROT_TRY(COROT_ALLOC(mesh->x, nnode));
  COROT_TRY(COROT_ALLOC(mesh->tet, ntet));
  COROT_TRY(COROT_ALLOC(mesh->mid, ntet));
  memcpy(mesh->x, x, (size_t)nnode * sizeof *x);
  for (int e = 0; e < ntet; e++) {
    memcpy(mesh->tet[e], tet[e], sizeof *mesh->tet);
    memcpy(mesh->mid[e], tet[e] + 4, sizeof *mesh->mid);
  }
  return COROT_OK;
}

corot_status corot_mesh_create_order_2(int nnode, const double (*x)[3], int ntet,
                                       const int (*tet)[10], corot_mesh **mesh) {
  corot_mesh *m;
  COROT_TRY(corot_mesh_check_counts(nnode, ntet));
  COROT_TRY(COROT_GIVEN(x));
  COROT_TRY(COROT_GIVEN(tet));
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_ALLOC(m, 1));
  return finish(copy_arrays_2(m, nnode, x, ntet, tet), m, mesh);
}

void corot_group_clear(corot_group *group) {
  free(group->name);
  free(group->node);
  free(group->tri);
  free(group->tet);
  memset(group, 0, sizeof *group);
}

void corot_mesh_destroy(corot_mesh *mesh) {
  if (!mesh) return;
  for (int g = 0; g < mesh->ngroup; g++) corot_group_clear(&mesh->group[g]);
  free(mesh->group);
  free(mesh->tet);
  free(mesh->mid);
  free(mesh->x);
  free(mesh);
}

size_t corot_mesh_bytes(const corot_mesh *mesh) {
  size_t bytes = sizeof *mesh + mesh->nnode * sizeof *mesh->x + mesh->ntet * sizeof *mesh->tet;
  if (mesh->mid) bytes += mesh->ntet * sizeof *mesh->mid;
  for (int k = 0; k < mesh->ngroup; k++) {
    const corot_group *g = &mesh->group[k];
    bytes += sizeof *g + strlen(g->name) + 1 + g->nnode * sizeof *g->node +
             g->ntri * sizeof *g->tri + g->ntet * sizeof *g->tet;
  }
  return bytes;
}
