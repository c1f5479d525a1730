/* Faces of tets, matched by sorting: linear in time and memory whatever the mesh. */
#include "mesh.h"

#include <string.h>

const int corot_tet_face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

static void swap_if_greater(int *a, int *b) {
  if (*a > *b) {
    int t = *a;
    *a = *b;
    *b = t;
  }
}

static void list_faces(int ntet, const int (*tet)[4], corot_face *face) {
  for (int side = 0; side < 4 * ntet; side++) {
    const int *local = corot_tet_face[side % 4], *node = tet[side / 4];
    int *v = face[side].v;
    for (int i = 0; i < 3; i++) v[i] = node[local[i]];
    swap_if_greater(&v[0], &v[1]);
    swap_if_greater(&v[1], &v[2]);
    swap_if_greater(&v[0], &v[1]);
    face[side].side = side;
  }
}

/* to = from [n] sorted by node v[k], equal ones in their old order; `start` [nnode + 1]: scratch.
 */
static void sort_by(int k, int n, const corot_face *from, corot_face *to, int nnode, int *start) {
  memset(start, 0, ((size_t)nnode + 1) * sizeof *start);
  for (int i = 0; i < n; i++) start[from[i].v[k] + 1]++;
  for (int i = 0; i < nnode; i++) start[i + 1] += start[i];
  for (int i = 0; i < n; i++) to[start[from[i].v[k]]++] = from[i];
}

corot_status corot_faces_sort(int nnode, int ntet, const int (*tet)[4], corot_face **face) {
  int n = 4 * ntet, *start = NULL;
  corot_face *a = NULL, *b = NULL;
  corot_status status = COROT_ALLOC(a, n);
  if (!status) status = COROT_ALLOC(b, n);
  if (!status) status = COROT_ALLOC(start, (size_t)nnode + 1);
  if (!status) {
    list_faces(ntet, tet, a);
    sort_by(2, n, a, b, nnode, start);
    sort_by(1, n, b, a, nnode, start);
    sort_by(0, n, a, b, nnode, start);
    *face = b;
    b = NULL;
  }
  free(start);
  free(a);
  free(b);
  return status;
}

void corot_face_outward(const corot_face *face, const int (*tet)[4], int tri[3]) {
  const int *local = corot_tet_face[face->side % 4], *node = tet[face->side / 4];
  for (int i = 0; i < 3; i++) tri[i] = node[local[i]];
}

bool corot_tri_ascends(const int tri[3]) {
  return (tri[0] < tri[1]) + (tri[1] < tri[2]) + (tri[2] < tri[0]) == 2;
}

int corot_face_compare(const corot_face *a, const corot_face *b) {
  for (int i = 0; i < 3; i++)
    if (a->v[i] != b->v[i]) return a->v[i] < b->v[i] ? -1 : 1;
  return 0;
}

static int compare_ints(const void *a, const void *b) {
  int p = *(const int *)a, q = *(const int *)b;
  return (p > q) - (p < q);
}

void corot_ints_unique(int *n, int *a) {
  int m = 0;
  qsort(a, (size_t)*n, sizeof *a, compare_ints);
  for (int i = 0; i < *n; i++)
    if (i == 0 || a[i] != a[i - 1]) a[m++] = a[i];
  *n = m;
}

int corot_face_find(int nface, const corot_face *face, const int tri[3]) {
  corot_face key = {{tri[0], tri[1], tri[2]}, 0};
  int low = 0, high = nface;
  qsort(key.v, 3, sizeof *key.v, compare_ints);
  while (low < high) {
    int middle = low + (high - low) / 2;
    if (corot_face_compare(&face[middle], &key) < 0)
      low = middle + 1;
    else
      high = middle;
  }
  return low < nface && corot_face_compare(&face[low], &key) == 0 ? low : -1;
}

void corot_face_orient(const corot_mesh *mesh, const corot_face *face, int f, bool reversed,
                       int tri[3]) {
  int n = 4 * mesh->ntet, outward[3];
  bool inside = f + 1 < n && corot_face_compare(&face[f], &face[f + 1]) == 0;
  corot_face_outward(&face[f], (const int(*)[4])mesh->tet, outward);
  if (inside ? reversed : corot_tri_ascends(tri) != corot_tri_ascends(outward)) {
    int swap = tri[1];
    tri[1] = tri[2];
    tri[2] = swap;
  }
}

static bool is_single(int i, int nface, const corot_face *face) {
  return (i == 0 || corot_face_compare(&face[i - 1], &face[i]) != 0) &&
         (i + 1 == nface || corot_face_compare(&face[i], &face[i + 1]) != 0);
}

corot_status corot_faces_boundary(int nface, const corot_face *face, const int (*tet)[4], int *ntri,
                                  int (**tri)[3]) {
  int n = 0, (*t)[3];
  for (int i = 0; i < nface; i++) n += is_single(i, nface, face);
  COROT_TRY(COROT_ALLOC(t, n));
  n = 0;
  for (int i = 0; i < nface; i++)
    if (is_single(i, nface, face)) corot_face_outward(&face[i], tet, t[n++]);
  *ntri = n;
  *tri = t;
  return COROT_OK;
}

corot_status corot_mesh_boundary(const corot_mesh *mesh, int *ntri, int (**tri)[3]) {
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(ntri));
  COROT_TRY(COROT_GIVEN(tri));
  const int(*tet)[4] = (const int(*)[4])mesh->tet;
  corot_face *face;
  COROT_TRY(corot_faces_sort(mesh->nnode, mesh->ntet, tet, &face));
  corot_status status = corot_faces_boundary(4 * mesh->ntet, face, tet, ntri, tri);
  free(face);
  return status;
}

void corot_corner_tets(const corot_mesh *mesh, int *first, int *tet) {
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 4; k++) first[mesh->tet[e][k] + 1]++;
  for (int n = 0; n < mesh->nnode; n++) first[n + 1] += first[n];
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 4; k++) tet[first[mesh->tet[e][k]]++] = e;
  memmove(first + 1, first, (size_t)mesh->nnode * sizeof *first);
  first[0] = 0;
}
