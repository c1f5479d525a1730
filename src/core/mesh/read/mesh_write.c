/* gmsh 2.2 ASCII. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "core/base/c_locale.h"
#include "core/mesh/refine/mesh_refine.h"

static void write_names(const corot_mesh *mesh, FILE *f) {
  int n = 0;
  for (int g = 0; g < mesh->ngroup; g++)
    n += (mesh->group[g].nnode > 0) + (mesh->group[g].ntri > 0) + (mesh->group[g].ntet > 0);
  if (n == 0) return;
  fprintf(f, "$PhysicalNames\n%d\n", n);
  for (int g = 0; g < mesh->ngroup; g++) {
    const corot_group *group = &mesh->group[g];
    if (group->nnode > 0) fprintf(f, "0 %d \"%s\"\n", g + 1, group->name);
    if (group->ntri > 0) fprintf(f, "2 %d \"%s\"\n", g + 1, group->name);
    if (group->ntet > 0) fprintf(f, "3 %d \"%s\"\n", g + 1, group->name);
  }
  fprintf(f, "$EndPhysicalNames\n");
}

static void write_nodes(const corot_mesh *mesh, FILE *f) {
  fprintf(f, "$Nodes\n%d\n", mesh->nnode);
  for (int i = 0; i < mesh->nnode; i++)
    fprintf(f, "%d %.17g %.17g %.17g\n", i + 1, mesh->x[i][0], mesh->x[i][1], mesh->x[i][2]);
  fprintf(f, "$EndNodes\n");
}

static void write_element(FILE *f, long long number, int type, int physical, int n,
                          const int *node) {
  fprintf(f, "%lld %d 2 %d %d", number, type, physical, physical);
  for (int i = 0; i < n; i++) fprintf(f, " %d", node[i] + 1);
  fprintf(f, "\n");
}

static void write_triangle(const corot_mesh *mesh, const corot_edges *edges, const int tri[3],
                           int physical, long long number, FILE *f) {
  int v[6];
  for (int k = 0; k < 3; k++) {
    v[k] = tri[k];
    if (mesh->mid) v[3 + k] = edges->middle[corot_edges_find(edges, tri[k], tri[(k + 1) % 3])];
  }
  write_element(f, number, mesh->mid ? 9 : 2, physical, mesh->mid ? 6 : 3, v);
}

/* gmsh has the nodes of a tet on the edges 01 12 02 03 23 13. */
static void write_tet(const corot_mesh *mesh, int e, int physical, long long number, FILE *f) {
  static const int place[6] = {0, 1, 2, 3, 5, 4};
  int v[10];
  for (int k = 0; k < 4; k++) v[k] = mesh->tet[e][k];
  for (int k = 0; mesh->mid && k < 6; k++) v[4 + k] = mesh->mid[e][place[k]];
  write_element(f, number, mesh->mid ? 11 : 4, physical, mesh->mid ? 10 : 4, v);
}

/* All tets in order, each in the first of its groups; then once more for each further group.
   first [ntet] is that first group, from 1; 0: none. */
static void write_elements(const corot_mesh *mesh, const corot_edges *edges, const int *first,
                           FILE *f) {
  long long n = mesh->ntet, k = 0;
  for (int g = 0; g < mesh->ngroup; g++) {
    const corot_group *group = &mesh->group[g];
    n += group->nnode + group->ntri;
    for (int i = 0; i < group->ntet; i++) n += first[group->tet[i]] != g + 1;
  }
  fprintf(f, "$Elements\n%lld\n", n);
  for (int g = 0; g < mesh->ngroup; g++) {
    const corot_group *group = &mesh->group[g];
    for (int i = 0; i < group->nnode; i++) write_element(f, ++k, 15, g + 1, 1, &group->node[i]);
    for (int i = 0; i < group->ntri; i++) write_triangle(mesh, edges, group->tri[i], g + 1, ++k, f);
  }
  for (int e = 0; e < mesh->ntet; e++) write_tet(mesh, e, first[e], ++k, f);
  for (int g = 0; g < mesh->ngroup; g++)
    for (int i = 0; i < mesh->group[g].ntet; i++) {
      int e = mesh->group[g].tet[i];
      if (first[e] != g + 1) write_tet(mesh, e, g + 1, ++k, f);
    }
  fprintf(f, "$EndElements\n");
}

static corot_status write_all(const corot_mesh *mesh, FILE *f) {
  corot_edges edges = {0};
  int *first;
  COROT_TRY(COROT_ALLOC(first, mesh->ntet));
  corot_status status = mesh->mid ? corot_edges_list(mesh, &edges) : COROT_OK;
  if (status) {
    free(first);
    return status;
  }
  for (int g = mesh->ngroup - 1; g >= 0; g--)
    for (int i = 0; i < mesh->group[g].ntet; i++) first[mesh->group[g].tet[i]] = g + 1;
  corot_c_locale locale = corot_c_locale_enter();
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  write_names(mesh, f);
  write_nodes(mesh, f);
  write_elements(mesh, &edges, first, f);
  corot_c_locale_leave(locale);
  corot_edges_clear(&edges);
  free(first);
  return COROT_OK;
}

/* A new file beside `path`, with a name of its own: `temporary` [size]. */
static FILE *open_temporary(const char *path, char *temporary, size_t size) {
  FILE *f = NULL;
  for (int i = 0; i < 100 && !f; i++) {
    snprintf(temporary, size, "%s.tmp%d", path, i);
    f = fopen(temporary, "wx");
    if (!f && errno != EEXIST) return NULL;
  }
  return f;
}

static corot_status write_temporary(const corot_mesh *mesh, const char *path, FILE *f) {
  corot_status status = write_all(mesh, f);
  int error = fflush(f) != 0 || ferror(f) ? errno : 0;
  if (fclose(f) != 0 && !error) error = errno;
  if (!status && error) return corot_fail(COROT_EIO, "%s: %s", path, strerror(error));
  return status;
}

/* A link, a device or a folder of that name stays what it is. */
static corot_status check_place(const char *path) {
  struct stat info;
  if (lstat(path, &info) != 0 || S_ISREG(info.st_mode)) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: is not a regular file, and stays as it is", path);
}

corot_status corot_mesh_write(const corot_mesh *mesh, const char *path) {
  char *temporary;
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(path));
  size_t size = strlen(path) + 16;
  COROT_TRY(check_place(path));
  COROT_TRY(COROT_ALLOC(temporary, size));
  corot_status status = COROT_OK;
  FILE *f = open_temporary(path, temporary, size);
  if (!f) {
    status = corot_fail(COROT_EIO, "%s: %s", path, strerror(errno));
  } else {
    status = write_temporary(mesh, path, f);
    if (!status && rename(temporary, path) != 0)
      status = corot_fail(COROT_EIO, "%s: %s", path, strerror(errno));
    if (status) remove(temporary);
  }
  free(temporary);
  return status;
}
