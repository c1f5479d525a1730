/* The edges of a mesh, each once, found by sorting in linear time. */
#include <limits.h>
#include <string.h>

#include "mesh_refine.h"

const int corot_edge_of_mid[6] = {0, 3, 1, 2, 4, 5};

/* An edge as a tet has it. */
typedef struct side {
  int v[2]; /* ascending */
  int at;   /* 6 * tet + its place in the tet */
} side;

static void list_sides(const corot_mesh *mesh, side *s) {
  static const int end[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  for (int at = 0; at < 6 * mesh->ntet; at++) {
    const int *v = mesh->tet[at / 6], a = v[end[at % 6][0]], b = v[end[at % 6][1]];
    s[at] = (side){{a < b ? a : b, a < b ? b : a}, at};
  }
}

/* to = from [n] sorted by node v[k], equal ones in their old order; `start` [nnode + 1]: scratch.
 */
static void sort_by(int k, int n, const side *from, side *to, int nnode, int *start) {
  memset(start, 0, ((size_t)nnode + 1) * sizeof *start);
  for (int i = 0; i < n; i++) start[from[i].v[k] + 1]++;
  for (int i = 0; i < nnode; i++) start[i + 1] += start[i];
  for (int i = 0; i < n; i++) to[start[from[i].v[k]]++] = from[i];
}

static bool is_new(int i, const side *s) {
  return i == 0 || s[i].v[0] != s[i - 1].v[0] || s[i].v[1] != s[i - 1].v[1];
}

/* Numbers the sorted sides [n] of all tets. */
static corot_status number_edges(int n, const side *s, corot_edges *edges) {
  int nedge = 0;
  for (int i = 0; i < n; i++) nedge += is_new(i, s);
  COROT_TRY(COROT_ALLOC(edges->end, nedge));
  COROT_TRY(COROT_ALLOC(edges->tet, n / 6));
  for (int i = 0; i < n; i++) {
    if (is_new(i, s)) memcpy(edges->end[edges->n++], s[i].v, sizeof s[i].v);
    edges->tet[s[i].at / 6][s[i].at % 6] = edges->n - 1;
  }
  return COROT_OK;
}

static corot_status find_middles(const corot_mesh *mesh, corot_edges *edges) {
  COROT_TRY(COROT_ALLOC(edges->middle, edges->n));
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 6; k++)
      edges->middle[edges->tet[e][corot_edge_of_mid[k]]] = mesh->mid[e][k];
  return COROT_OK;
}

corot_status corot_edges_list(const corot_mesh *mesh, corot_edges *edges) {
  if (mesh->ntet > INT_MAX / 6)
    return corot_fail(COROT_EINVAL, "%d tets are too many to list their edges: at most %d",
                      mesh->ntet, INT_MAX / 6);
  int n = 6 * mesh->ntet, *start = NULL;
  side *a = NULL, *b = NULL;
  corot_status status = COROT_ALLOC(a, n);
  if (!status) status = COROT_ALLOC(b, n);
  if (!status) status = COROT_ALLOC(start, (size_t)mesh->nnode + 1);
  if (!status) {
    list_sides(mesh, a);
    sort_by(1, n, a, b, mesh->nnode, start);
    sort_by(0, n, b, a, mesh->nnode, start);
    status = number_edges(n, a, edges);
    edges->nnode = mesh->nnode;
  }
  free(start);
  free(a);
  free(b);
  if (!status && mesh->mid) status = find_middles(mesh, edges);
  return status;
}

void corot_edges_clear(corot_edges *edges) {
  free(edges->end);
  free(edges->tet);
  free(edges->middle);
  memset(edges, 0, sizeof *edges);
}

void corot_edges_place(const corot_mesh *mesh, const corot_edges *edges, double (*x)[3]) {
  for (int i = 0; i < edges->n; i++) {
    const double *a = mesh->x[edges->end[i][0]], *b = mesh->x[edges->end[i][1]];
    for (int c = 0; c < 3; c++) x[i][c] = (a[c] + b[c]) / 2;
  }
}

static int compare_ends(const void *a, const void *b) {
  const int *p = a, *q = b;
  if (p[0] != q[0]) return p[0] < q[0] ? -1 : 1;
  return (p[1] > q[1]) - (p[1] < q[1]);
}

int corot_edges_find(const corot_edges *edges, int a, int b) {
  const int key[2] = {a < b ? a : b, a < b ? b : a};
  const int(*found)[2] =
      bsearch(key, edges->end, (size_t)edges->n, sizeof *edges->end, compare_ends);
  return (int)(found - (const int(*)[2])edges->end);
}
