/* Named groups made of others: union, intersection, difference, each of nodes, faces and tets. */
#include <string.h>

#include "mesh.h"

/* Whether what is in the result so far stays, given whether it is in the next group. */
static bool stays(corot_set_operation operation, bool in_next) {
  return operation == COROT_UNION || (operation == COROT_INTERSECTION) == in_next;
}

/* mark [count] becomes that of the result with the next, whose numbers are `list` [n]. */
static void combine_marks(corot_set_operation operation, int count, int n, const int *list,
                          char *mark) {
  for (int i = 0; i < n; i++) mark[list[i]] |= 2;
  for (int i = 0; i < count; i++) {
    bool in = mark[i] & 1, in_next = mark[i] & 2;
    mark[i] = (in && stays(operation, in_next)) || (operation == COROT_UNION && in_next);
  }
}

static corot_status list_marked(int count, const char *mark, int *n, int **list) {
  int total = 0;
  for (int i = 0; i < count; i++) total += mark[i];
  COROT_TRY(COROT_ALLOC(*list, total));
  for (int i = 0; i < count; i++)
    if (mark[i]) (*list)[(*n)++] = i;
  return COROT_OK;
}

/* --- Faces --- */

static corot_face face_of(const int tri[3], int side) {
  corot_face f = {.side = side};
  memcpy(f.v, tri, sizeof f.v);
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 2; k++)
      if (f.v[k] > f.v[k + 1]) {
        int swap = f.v[k];
        f.v[k] = f.v[k + 1];
        f.v[k + 1] = swap;
      }
  return f;
}

static int compare(const void *a, const void *b) { return corot_face_compare(a, b); }

/* The faces of triangles in ascending order of their nodes. */
static corot_status sort_faces(int ntri, const int (*tri)[3], corot_face **face) {
  COROT_TRY(COROT_ALLOC(*face, ntri));
  for (int i = 0; i < ntri; i++) (*face)[i] = face_of(tri[i], i);
  if (ntri) qsort(*face, (size_t)ntri, sizeof **face, compare);
  return COROT_OK;
}

static bool is_among(const int tri[3], int n, const corot_face *face) {
  const corot_face key = face_of(tri, 0);
  return n && bsearch(&key, face, (size_t)n, sizeof *face, compare);
}

/* The result's triangles that stay, at the front. */
static void keep_faces(corot_set_operation operation, const corot_group *next,
                       const corot_face *face, corot_group *result) {
  int n = 0;
  for (int i = 0; i < result->ntri; i++) {
    if (!stays(operation, is_among(result->tri[i], next->ntri, face))) continue;
    memmove(result->tri[n++], result->tri[i], sizeof *result->tri);
  }
  result->ntri = n;
}

/* result->tri has room for those of all. */
static corot_status combine_faces(corot_set_operation operation, const corot_group *next,
                                  corot_group *result) {
  corot_face *face = NULL;
  bool all = operation == COROT_UNION;
  const corot_group *sorted = all ? result : next; /* those that the others are looked up in */
  corot_status status = sort_faces(sorted->ntri, (const int(*)[3])sorted->tri, &face);
  int before = result->ntri;
  for (int i = 0; !status && all && i < next->ntri; i++)
    if (!is_among(next->tri[i], before, face))
      memcpy(result->tri[result->ntri++], next->tri[i], sizeof *next->tri);
  if (!status && !all) keep_faces(operation, next, face, result);
  free(face);
  return status;
}

/* --- Groups --- */

static const char *const words[] = {[COROT_UNION] = "union",
                                    [COROT_INTERSECTION] = "intersection",
                                    [COROT_DIFFERENCE] = "difference"};

/* Fills a zeroed group but for its name. `node` [nnode] and `tet` [ntet] are zeroed. */
static corot_status combine(const corot_mesh *mesh, corot_set_operation operation, int n,
                            const corot_group *const *of, char *node, char *tet, corot_group *g) {
  size_t most = 0;
  for (int i = 0; i < n; i++) most += (size_t)of[i]->ntri;
  COROT_TRY(COROT_ALLOC(g->tri, most));
  for (int i = 0; i < n; i++) {
    corot_set_operation now = i ? operation : COROT_UNION;
    combine_marks(now, mesh->nnode, of[i]->nnode, of[i]->node, node);
    combine_marks(now, mesh->ntet, of[i]->ntet, of[i]->tet, tet);
    COROT_TRY(combine_faces(now, of[i], g));
  }
  COROT_TRY(list_marked(mesh->nnode, node, &g->nnode, &g->node));
  return list_marked(mesh->ntet, tet, &g->ntet, &g->tet);
}

static corot_status refuse_empty(const char *name, corot_set_operation operation, int n,
                                 const corot_group *const *of) {
  if (operation == COROT_DIFFERENCE)
    return corot_fail(COROT_EINVAL,
                      "group '%s' has no nodes: each of the %d of group '%s' is in %s%s%s", name,
                      of[0]->nnode, of[0]->name, n > 2 ? "one of the others" : "group '",
                      n > 2 ? "" : of[1]->name, n > 2 ? "" : "'");
  return corot_fail(COROT_EINVAL,
                    "group '%s' has no nodes: none of the %d of group '%s' is in %s%s%s", name,
                    of[0]->nnode, of[0]->name, n > 2 ? "all others" : "group '",
                    n > 2 ? "" : of[1]->name, n > 2 ? "" : "'");
}

static corot_status find_all(const corot_mesh *mesh, const char *name, int n,
                             const char *const *other, const corot_group **of) {
  for (int i = 0; i < n; i++) {
    if (!other[i]) return corot_fail(COROT_EINVAL, "group '%s': name %d is NULL", name, i);
    of[i] = corot_mesh_find_group(mesh, other[i]);
    if (!of[i])
      return corot_fail(COROT_EINVAL, "group '%s': there is no group '%s'", name, other[i]);
  }
  return COROT_OK;
}

/* `of` [n] is scratch. */
static corot_status add_combined(corot_mesh *mesh, const char *name, corot_set_operation operation,
                                 int n, const char *const *other, const corot_group **of) {
  corot_group g = {0};
  char *node = NULL, *tet = NULL;
  COROT_TRY(find_all(mesh, name, n, other, of));
  corot_status status = COROT_ALLOC(node, mesh->nnode);
  if (!status) status = COROT_ALLOC(tet, mesh->ntet);
  if (!status) status = combine(mesh, operation, n, of, node, tet, &g);
  if (!status && g.nnode == 0) status = refuse_empty(name, operation, n, of);
  free(node);
  free(tet);
  return corot_mesh_add_group(status, mesh, name, &g);
}

corot_status corot_mesh_group_combine(corot_mesh *mesh, const char *name,
                                      corot_set_operation operation, int n,
                                      const char *const *other) {
  const corot_group **of;
  COROT_TRY(corot_mesh_check_new_group(mesh, name));
  COROT_TRY(COROT_GIVEN(other));
  if ((unsigned)operation > COROT_DIFFERENCE)
    return corot_fail(COROT_EINVAL, "group '%s': there is no operation %d of sets", name,
                      (int)operation);
  if (n < 2)
    return corot_fail(COROT_EINVAL, "group '%s': %s %s takes two groups or more, not %d", name,
                      operation == COROT_INTERSECTION ? "an" : "a", words[operation], n);
  COROT_TRY(COROT_ALLOC(of, n));
  corot_status status = add_combined(mesh, name, operation, n, other, of);
  free(of);
  return status;
}
