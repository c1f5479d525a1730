/* gmsh 2.2 ASCII. */
#include "mesh_write.h"

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

static void write_triangle(const corot_writing *w, const int tri[3], int physical,
                           long long number) {
  int v[6], n = corot_writing_triangle(w, tri, v);
  write_element(w->file, number, n == 6 ? 9 : 2, physical, n, v);
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
static void write_elements(const corot_writing *w, const int *first) {
  const corot_mesh *mesh = w->mesh;
  FILE *f = w->file;
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
    for (int i = 0; i < group->ntri; i++) write_triangle(w, group->tri[i], g + 1, ++k);
  }
  for (int e = 0; e < mesh->ntet; e++) write_tet(mesh, e, first[e], ++k, f);
  for (int g = 0; g < mesh->ngroup; g++)
    for (int i = 0; i < mesh->group[g].ntet; i++) {
      int e = mesh->group[g].tet[i];
      if (first[e] != g + 1) write_tet(mesh, e, g + 1, ++k, f);
    }
  fprintf(f, "$EndElements\n");
}

corot_status corot_write_gmsh_2(corot_writing *w) {
  const corot_mesh *mesh = w->mesh;
  int *first;
  COROT_TRY(COROT_ALLOC(first, mesh->ntet));
  for (int g = mesh->ngroup - 1; g >= 0; g--)
    for (int i = 0; i < mesh->group[g].ntet; i++) first[mesh->group[g].tet[i]] = g + 1;
  fprintf(w->file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  write_names(mesh, w->file);
  write_nodes(mesh, w->file);
  write_elements(w, first);
  free(first);
  return COROT_OK;
}
