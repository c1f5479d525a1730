/* Abaqus' and CalculiX' .inp: groups are sets of nodes and of elements, and surfaces, of one name.
 */
#include <string.h>

#include "mesh_write.h"

static char small(char c) { return c >= 'A' && c <= 'Z' ? (char)(c + 32) : c; }

/* Abaqus does not tell the case of letters. */
static bool is_same(const char *a, const char *b) {
  while (*a && small(*a) == small(*b)) a++, b++;
  return small(*a) == small(*b);
}

/* As a name of Abaqus: without commas, and without blanks around it. */
static void make_name(const char *name, char *to) {
  size_t n = strlen(name);
  strcpy(to, name);
  for (size_t i = 0; i < n; i++)
    if (to[i] == ',' || ((i == 0 || i + 1 == n) && to[i] == ' ')) to[i] = '_';
}

typedef char group_name[COROT_GROUP_NAME_MAX + 1];

static corot_status make_names(corot_writing *w, group_name *name) {
  const corot_mesh *mesh = w->mesh;
  for (int g = 0; g < mesh->ngroup; g++) {
    make_name(mesh->group[g].name, name[g]);
    for (int h = 0; h < g; h++)
      if (is_same(name[h], name[g]))
        return corot_fail(COROT_EINVAL,
                          "groups '%s' and '%s' would be one in an Abaqus file: call one of them "
                          "something else",
                          mesh->group[h].name, mesh->group[g].name);
    if (strcmp(name[g], mesh->group[g].name) != 0)
      COROT_TRY(corot_writing_lose(w, 1, "group %s is called %s in the file", mesh->group[g].name,
                                   name[g]));
  }
  return COROT_OK;
}

static void write_nodes(const corot_writing *w) {
  fputs("*NODE\n", w->file);
  for (int i = 0; i < w->mesh->nnode; i++) {
    const double *x = w->mesh->x[i];
    fprintf(w->file, "%d, %.17g, %.17g, %.17g\n", i + 1, x[0], x[1], x[2]);
  }
}

static void write_tets(const corot_writing *w) {
  fprintf(w->file, "*ELEMENT, TYPE=%s\n", w->mesh->mid ? "C3D10" : "C3D4");
  for (int e = 0; e < w->mesh->ntet; e++) {
    int v[10], n = corot_writing_tet(w, e, v);
    fprintf(w->file, "%d", e + 1);
    for (int k = 0; k < n; k++) fprintf(w->file, ", %d", v[k] + 1);
    fputc('\n', w->file);
  }
}

/* Numbers from 1, ten to a line. */
static void write_set(FILE *f, const char *keyword, const char *name, int n, const int *number) {
  if (n == 0) return;
  fprintf(f, "*%s, %s=%s\n", keyword, keyword, name);
  for (int i = 0; i < n; i++)
    fprintf(f, "%d%s", number[i] + 1, i + 1 == n || i % 10 == 9 ? "\n" : ", ");
}

/* Abaqus' faces wind inward; inside the mesh that of the tet is taken which winds as the triangle.
 */
static void write_surface(const corot_writing *w, const corot_group *g, const char *name) {
  static const int face_of[4] = {3, 4, 2, 1}; /* by the corner opposite to it */
  const corot_mesh *mesh = w->mesh;
  int n = 4 * mesh->ntet;
  if (g->ntri == 0) return;
  fprintf(w->file, "*SURFACE, TYPE=ELEMENT, NAME=%s\n", name);
  for (int i = 0; i < g->ntri; i++) {
    int f = corot_face_find(n, w->face, g->tri[i]), out[3];
    bool inside = f + 1 < n && corot_face_compare(&w->face[f], &w->face[f + 1]) == 0;
    corot_face_outward(&w->face[f], (const int(*)[4])mesh->tet, out);
    if (inside && corot_tri_ascends(out) == corot_tri_ascends(g->tri[i])) f++;
    fprintf(w->file, "%d, S%d\n", w->face[f].side / 4 + 1, face_of[w->face[f].side % 4]);
  }
}

static corot_status write_groups(corot_writing *w, const group_name *name) {
  const corot_mesh *mesh = w->mesh;
  char *mark = NULL;
  int *loose = NULL;
  corot_status status = COROT_ALLOC(mark, mesh->nnode);
  if (!status) status = COROT_ALLOC(loose, mesh->nnode);
  for (int g = 0; g < mesh->ngroup && !status; g++) {
    const corot_group *group = &mesh->group[g];
    write_set(w->file, "NSET", name[g], corot_writing_loose(w, group, mark, loose), loose);
    write_set(w->file, "ELSET", name[g], group->ntet, group->tet);
    write_surface(w, group, name[g]);
  }
  free(mark);
  free(loose);
  return status;
}

corot_status corot_write_inp(corot_writing *w) {
  const corot_mesh *mesh = w->mesh;
  group_name *name;
  COROT_TRY(corot_faces_sort(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &w->face));
  COROT_TRY(COROT_ALLOC(name, mesh->ngroup));
  corot_status status = make_names(w, name);
  if (!status) {
    write_nodes(w);
    write_tets(w);
    status = write_groups(w, (const group_name *)name);
  }
  free(name);
  return status;
}
