/* TetGen's and MEDIT's files, which have one number for each tet, triangle and node in the place of
   named groups. */
#include <string.h>

#include "mesh_write.h"

/* What a format calls the groups of one kind when it is read. */
typedef struct kind {
  const char *word, *members; /* "region-2" is number 2; members of what is left out */
} kind;

/* The number that a group of that name is to have: of "7" and "WORD-7"; 0: any. */
static int number_in(const char *name, const char *word) {
  size_t n = strlen(word);
  long number = 0;
  if (strncmp(name, word, n) == 0 && name[n] == '-') name += n + 1;
  if (!*name || strlen(name) > 9 || name[strspn(name, "0123456789")] || *name == '0') return 0;
  number = strtol(name, NULL, 10);
  return (int)number;
}

static bool is_taken(int ngroup, const int *number, int candidate) {
  for (int g = 0; g < ngroup; g++)
    if (number[g] == candidate) return true;
  return false;
}

/* number [ngroup] of the groups that have members; those whose names are numbers come first. */
static void choose_numbers(const corot_mesh *mesh, const kind *k, const int *nmember, int *number) {
  int next = 1;
  for (int g = 0; g < mesh->ngroup; g++) {
    int wanted = nmember[g] > 0 ? number_in(mesh->group[g].name, k->word) : 0;
    number[g] = is_taken(g, number, wanted) ? 0 : wanted;
  }
  for (int g = 0; g < mesh->ngroup; g++) {
    if (nmember[g] == 0 || number[g] > 0) continue;
    while (is_taken(mesh->ngroup, number, next)) next++;
    number[g] = next;
  }
}

/* "skin is 2, base is 3" */
static corot_status tell_numbers(corot_writing *w, const kind *k, const int *number) {
  char text[500] = "";
  int n = 0;
  for (int g = 0; g < w->mesh->ngroup; g++) {
    const char *name = w->mesh->group[g].name;
    if (number[g] == 0 || number_in(name, k->word) == number[g]) continue;
    if (n < 8)
      snprintf(text + strlen(text), sizeof text - strlen(text), "%s%.40s is %d", n ? ", " : "",
               name, number[g]);
    n++;
  }
  if (n == 0) return COROT_OK;
  return corot_writing_lose(w, n,
                            "the file has numbers in the place of the names of groups of %s: %s%s",
                            k->members, text, n > 8 ? ", ..." : "");
}

static corot_status tell_shared(corot_writing *w, const kind *k, const char *name, int n) {
  if (n == 0) return COROT_OK;
  return corot_writing_lose(w, 1,
                            "group %s lacks %d of its %s in the file, which has one number for "
                            "each: groups before it have them",
                            name, n, k->members);
}

/* Gives places their group's number where they have none; the value is how many have one. */
static int give(int n, const int *place, int number, int *of) {
  int shared = 0;
  for (int i = 0; i < n; i++) {
    if (of[place[i]] == 0)
      of[place[i]] = number;
    else
      shared += of[place[i]] != number;
  }
  return shared;
}

/* The members of a group of one kind, as places in an array of numbers. `place` has room. */
typedef int list_members(const corot_writing *w, const corot_group *g, char *mark, int *place);

static int list_tets(const corot_writing *w, const corot_group *g, char *mark, int *place) {
  (void)w, (void)mark;
  memcpy(place, g->tet, (size_t)g->ntet * sizeof *place);
  return g->ntet;
}

static int list_faces(const corot_writing *w, const corot_group *g, char *mark, int *place) {
  (void)mark;
  for (int i = 0; i < g->ntri; i++)
    place[i] = corot_face_find(4 * w->mesh->ntet, w->face, g->tri[i]);
  return g->ntri;
}

static int list_nodes(const corot_writing *w, const corot_group *g, char *mark, int *place) {
  return corot_writing_loose(w, g, mark, place);
}

/* of [n] = the numbers of places. */
static corot_status give_numbers(corot_writing *w, const kind *k, list_members *list, int n,
                                 int *of) {
  const corot_mesh *mesh = w->mesh;
  int *nmember = NULL, *number = NULL, *place = NULL;
  char *mark = NULL;
  corot_status status = COROT_ALLOC(nmember, mesh->ngroup);
  if (!status) status = COROT_ALLOC(number, mesh->ngroup);
  if (!status) status = COROT_ALLOC(place, n);
  if (!status) status = COROT_ALLOC(mark, mesh->nnode);
  for (int g = 0; g < mesh->ngroup && !status; g++)
    nmember[g] = list(w, &mesh->group[g], mark, place);
  if (!status) {
    choose_numbers(mesh, k, nmember, number);
    status = tell_numbers(w, k, number);
  }
  for (int g = 0; g < mesh->ngroup && !status; g++) {
    int m = list(w, &mesh->group[g], mark, place);
    status = tell_shared(w, k, mesh->group[g].name, give(m, place, number[g], of));
  }
  free(nmember);
  free(number);
  free(place);
  free(mark);
  return status;
}

static corot_status number_tets(corot_writing *w, const kind *k) {
  COROT_TRY(COROT_ALLOC(w->tet_number, w->mesh->ntet));
  return give_numbers(w, k, list_tets, w->mesh->ntet, w->tet_number);
}

static corot_status number_faces(corot_writing *w, const kind *k) {
  const corot_mesh *mesh = w->mesh;
  COROT_TRY(corot_faces_sort(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &w->face));
  COROT_TRY(COROT_ALLOC(w->face_number, 4 * (size_t)mesh->ntet));
  return give_numbers(w, k, list_faces, 4 * mesh->ntet, w->face_number);
}

static corot_status number_nodes(corot_writing *w, const kind *k) {
  COROT_TRY(COROT_ALLOC(w->node_number, w->mesh->nnode));
  return give_numbers(w, k, list_nodes, w->mesh->nnode, w->node_number);
}

/* Calls `write` for the triangles that have a number, as the first group has them; the value is how
   many there are. `write` may be NULL. */
static int for_triangles(const corot_writing *w, void (*write)(const corot_writing *w, int k,
                                                               const int tri[3], int number)) {
  const corot_mesh *mesh = w->mesh;
  int n = 0, nface = 4 * mesh->ntet;
  for (int g = 0; g < mesh->ngroup; g++)
    for (int i = 0; i < mesh->group[g].ntri; i++) {
      int *number = &w->face_number[corot_face_find(nface, w->face, mesh->group[g].tri[i])];
      if (*number <= 0) continue;
      if (write) write(w, n + 1, mesh->group[g].tri[i], *number);
      *number = -*number; /* it is done */
      n++;
    }
  for (int f = 0; f < nface; f++)
    if (w->face_number[f] < 0) w->face_number[f] = -w->face_number[f];
  return n;
}

/* --- TetGen --- */

corot_status corot_write_tetgen_node(corot_writing *w) {
  static const kind nodes = {"marker", "nodes"};
  const corot_mesh *mesh = w->mesh;
  COROT_TRY(number_nodes(w, &nodes));
  fprintf(w->file, "%d 3 0 1\n", mesh->nnode);
  for (int i = 0; i < mesh->nnode; i++)
    fprintf(w->file, "%d %.17g %.17g %.17g %d\n", i + 1, mesh->x[i][0], mesh->x[i][1],
            mesh->x[i][2], w->node_number[i]);
  return COROT_OK;
}

corot_status corot_write_tetgen_ele(corot_writing *w) {
  static const kind tets = {"region", "tets"};
  const corot_mesh *mesh = w->mesh;
  COROT_TRY(number_tets(w, &tets));
  fprintf(w->file, "%d %d 1\n", mesh->ntet, mesh->mid ? 10 : 4);
  for (int e = 0; e < mesh->ntet; e++) {
    int v[10], n = corot_writing_tet(w, e, v);
    fprintf(w->file, "%d", e + 1);
    for (int k = 0; k < n; k++) fprintf(w->file, " %d", v[k] + 1);
    fprintf(w->file, " %d\n", w->tet_number[e]);
  }
  return COROT_OK;
}

static void write_face(const corot_writing *w, int k, const int tri[3], int number) {
  fprintf(w->file, "%d %d %d %d %d\n", k, tri[0] + 1, tri[1] + 1, tri[2] + 1, number);
}

corot_status corot_write_tetgen_face(corot_writing *w) {
  static const kind faces = {"face", "triangles"};
  COROT_TRY(number_faces(w, &faces));
  fprintf(w->file, "%d 1\n", for_triangles(w, NULL));
  for_triangles(w, write_face);
  return COROT_OK;
}

/* --- MEDIT --- */

static void write_triangle(const corot_writing *w, int k, const int tri[3], int number) {
  int v[6], n = corot_writing_triangle(w, tri, v);
  (void)k;
  for (int i = 0; i < n; i++) fprintf(w->file, "%d ", v[i] + 1);
  fprintf(w->file, "%d\n", number);
}

static corot_status tell_nodes(corot_writing *w) {
  char *mark = NULL;
  int *loose = NULL;
  corot_status status = COROT_ALLOC(mark, w->mesh->nnode);
  if (!status) status = COROT_ALLOC(loose, w->mesh->nnode);
  for (int g = 0; g < w->mesh->ngroup && !status; g++) {
    int n = corot_writing_loose(w, &w->mesh->group[g], mark, loose);
    if (n > 0)
      status = corot_writing_lose(w, 1,
                                  "%d nodes of group %s are of no triangle or tet of it, and left "
                                  "out: MEDIT files have no groups of nodes",
                                  n, w->mesh->group[g].name);
  }
  free(mark);
  free(loose);
  return status;
}

corot_status corot_write_medit(corot_writing *w) {
  static const kind tets = {"volume", "tets"}, faces = {"surface", "triangles"};
  const corot_mesh *mesh = w->mesh;
  COROT_TRY(number_tets(w, &tets));
  COROT_TRY(number_faces(w, &faces));
  COROT_TRY(tell_nodes(w));
  fprintf(w->file, "MeshVersionFormatted 2\nDimension 3\nVertices\n%d\n", mesh->nnode);
  for (int i = 0; i < mesh->nnode; i++)
    fprintf(w->file, "%.17g %.17g %.17g 0\n", mesh->x[i][0], mesh->x[i][1], mesh->x[i][2]);
  int ntri = for_triangles(w, NULL);
  if (ntri > 0) {
    fprintf(w->file, "%s\n%d\n", mesh->mid ? "TrianglesP2" : "Triangles", ntri);
    for_triangles(w, write_triangle);
  }
  fprintf(w->file, "%s\n%d\n", mesh->mid ? "TetrahedraP2" : "Tetrahedra", mesh->ntet);
  for (int e = 0; e < mesh->ntet; e++) {
    int v[10], n = corot_writing_tet(w, e, v);
    for (int k = 0; k < n; k++) fprintf(w->file, "%d ", v[k] + 1);
    fprintf(w->file, "%d\n", w->tet_number[e]);
  }
  fputs("End\n", w->file);
  return COROT_OK;
}
