/* Named groups, selected by their nodes. */
#include <string.h>

#include "core/mesh/refine/mesh_refine.h"

const corot_group *corot_mesh_find_group(const corot_mesh *mesh, const char *name) {
  for (int g = 0; g < mesh->ngroup; g++)
    if (strcmp(mesh->group[g].name, name) == 0) return &mesh->group[g];
  return NULL;
}

corot_status corot_group_name_check(const char *name) {
  size_t n = strlen(name);
  if (n == 0) return corot_fail(COROT_EINVAL, "a group needs a name");
  if (n > COROT_GROUP_NAME_MAX)
    return corot_fail(COROT_EINVAL, "group '%.20s...': a name has at most %d bytes, this one %zu",
                      name, COROT_GROUP_NAME_MAX, n);
  for (const char *p = name; *p; p++)
    if ((unsigned char)*p < 0x20 || *p == 0x7f || *p == '"')
      return corot_fail(COROT_EINVAL,
                        "group '%.20s...': byte %zu of the name is a quote or a control character",
                        name, (size_t)(p - name) + 1);
  return COROT_OK;
}

corot_status corot_mesh_check_new_group(const corot_mesh *mesh, const char *name) {
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(name));
  COROT_TRY(corot_group_name_check(name));
  if (corot_mesh_find_group(mesh, name))
    return corot_fail(COROT_EINVAL, "group '%s' exists already", name);
  return COROT_OK;
}

static corot_status append(corot_mesh *mesh, const char *name, corot_group *g) {
  corot_group *more = realloc(mesh->group, ((size_t)mesh->ngroup + 1) * sizeof *more);
  if (!more) return corot_fail(COROT_ENOMEM, "out of memory: group '%s'", name);
  mesh->group = more;
  COROT_TRY(COROT_ALLOC(g->name, strlen(name) + 1));
  strcpy(g->name, name);
  mesh->group[mesh->ngroup++] = *g;
  return COROT_OK;
}

corot_status corot_mesh_add_group(corot_status status, corot_mesh *mesh, const char *name,
                                  corot_group *g) {
  if (!status) status = append(mesh, name, g);
  if (status) corot_group_clear(g);
  return status;
}

static bool all_marked(int n, const int *node, const char *mark) {
  for (int i = 0; i < n; i++)
    if (!mark[node[i]]) return false;
  return true;
}

/* Fills a zeroed group but for its name; the caller clears it on failure. */
static corot_status collect(const corot_mesh *mesh, const char *mark, int ntri,
                            const int (*boundary)[3], corot_group *g) {
  for (int i = 0; i < mesh->nnode; i++) g->nnode += mark[i] != 0;
  for (int i = 0; i < ntri; i++) g->ntri += all_marked(3, boundary[i], mark);
  for (int e = 0; e < mesh->ntet; e++) g->ntet += all_marked(4, mesh->tet[e], mark);
  COROT_TRY(COROT_ALLOC(g->node, g->nnode));
  COROT_TRY(COROT_ALLOC(g->tri, g->ntri));
  COROT_TRY(COROT_ALLOC(g->tet, g->ntet));

  int n = 0;
  for (int i = 0; i < mesh->nnode; i++)
    if (mark[i]) g->node[n++] = i;
  n = 0;
  for (int i = 0; i < ntri; i++)
    if (all_marked(3, boundary[i], mark)) memcpy(g->tri[n++], boundary[i], sizeof *boundary);
  n = 0;
  for (int e = 0; e < mesh->ntet; e++)
    if (all_marked(4, mesh->tet[e], mark)) g->tet[n++] = e;
  return COROT_OK;
}

corot_status corot_mesh_group_marked(corot_mesh *mesh, const char *name, const char *mark, int ntri,
                                     const int (*boundary)[3]) {
  corot_group g = {0};
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  if (!memchr(mark, 1, (size_t)mesh->nnode))
    return corot_fail(COROT_EINVAL, "group '%s' has no nodes", name);
  corot_status status = collect(mesh, mark, ntri, boundary, &g);
  if (!status && mesh->mid) status = corot_group_add_middles(mesh, ntri, boundary, &g);
  return corot_mesh_add_group(status, mesh, name, &g);
}

corot_status corot_mesh_add_marked(corot_mesh *mesh, const char *name, const char *mark) {
  int ntri, (*tri)[3];
  COROT_TRY(corot_mesh_boundary(mesh, &ntri, &tri));
  corot_status status = corot_mesh_group_marked(mesh, name, mark, ntri, (const int(*)[3])tri);
  free(tri);
  return status;
}

corot_status corot_mesh_group_nodes(corot_mesh *mesh, const char *name, int nnode,
                                    const int *node) {
  char *mark;
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(node));
  for (int i = 0; i < nnode; i++)
    if (node[i] < 0 || node[i] >= mesh->nnode)
      return corot_fail(COROT_EINVAL, "group '%s': node %d does not exist, the last is %d", name,
                        node[i], mesh->nnode - 1);
  COROT_TRY(COROT_ALLOC(mark, mesh->nnode));
  for (int i = 0; i < nnode; i++) mark[node[i]] = 1;
  corot_status status = corot_mesh_add_marked(mesh, name, mark);
  free(mark);
  return status;
}
