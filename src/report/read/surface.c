/* Sorts the faces of all tets; those that come once are the surface. */
#include "surface.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/mesh/mesh.h"

typedef struct face {
  int key[3];    /* its nodes, ascending */
  int corner[3]; /* the same, winding outward */
  int middle[3]; /* on its edges 01 12 20, of order 2 */
  int tet;
} face;

void surface_free(surface *s) {
  free(s->corner);
  free(s->middle);
  free(s->tet);
  free(s->node);
  free(s->stands);
  *s = (surface){0};
}

static void swap_if_greater(int *a, int *b) {
  if (*a <= *b) return;
  int keep = *a;
  *a = *b;
  *b = keep;
}

/* mid: NULL of order 1. */
static face face_of(int e, const int *tet, const int *mid, int opposite) {
  static const int outward[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  static const int edge[4][4] = {{-1, 0, 2, 3}, {0, -1, 1, 4}, {2, 1, -1, 5}, {3, 4, 5, -1}};
  const int *out = outward[opposite];
  face f = {.tet = e};
  for (int k = 0; k < 3; k++) {
    f.key[k] = f.corner[k] = tet[out[k]];
    if (mid) f.middle[k] = mid[edge[out[k]][out[(k + 1) % 3]]];
  }
  swap_if_greater(&f.key[0], &f.key[1]);
  swap_if_greater(&f.key[1], &f.key[2]);
  swap_if_greater(&f.key[0], &f.key[1]);
  return f;
}

static int by_key(const void *a, const void *b) {
  const face *p = a, *q = b;
  for (int k = 0; k < 3; k++)
    if (p->key[k] != q->key[k]) return p->key[k] < q->key[k] ? -1 : 1;
  return 0;
}

static int by_tet(const void *a, const void *b) {
  const face *p = a, *q = b;
  if (p->tet != q->tet) return p->tet < q->tet ? -1 : 1;
  return by_key(a, b);
}

/* The faces that occur once, in the order of their tets. */
static corot_status list_single(int nnode, int ntet, const int (*tet)[4], const int (*mid)[6],
                                int *n, face **out) {
  corot_face *all;
  int nface = 4 * ntet, kept = 0;
  COROT_TRY(corot_faces_sort(nnode, ntet, tet, &all));
  for (int i = 0, next; i < nface; i = next) { /* their sides to the front */
    for (next = i + 1; next < nface && corot_face_compare(&all[i], &all[next]) == 0; next++)
      continue;
    if (next == i + 1) all[kept++].side = all[i].side;
  }
  face *f = malloc(((size_t)kept + 1) * sizeof *f);
  for (int i = 0; f && i < kept; i++) {
    int e = all[i].side / 4;
    f[i] = face_of(e, tet[e], mid ? mid[e] : NULL, all[i].side % 4);
  }
  free(all);
  if (!f) return corot_fail(COROT_ENOMEM, "the surface of %d tets: out of memory", ntet);
  qsort(f, (size_t)kept, sizeof *f, by_tet);
  *n = kept;
  *out = f;
  return COROT_OK;
}

/* number [nnode]: 0 to begin with, then one more than each node's number on the surface. */
static void number_nodes(int nnode, int *number, const face *f, surface *s) {
  for (int i = 0; i < s->ntri; i++)
    for (int k = 0; k < 3; k++) {
      number[f[i].corner[k]] = 1;
      if (s->middle) number[f[i].middle[k]] = 1;
    }
  for (int i = 0; i < nnode; i++) {
    if (!number[i]) continue;
    s->node[s->nnode++] = i;
    number[i] = s->nnode;
  }
  for (int i = 0; i < s->ntri; i++) {
    s->tet[i] = f[i].tet;
    for (int k = 0; k < 3; k++) {
      s->corner[i][k] = number[f[i].corner[k]] - 1;
      if (s->middle) s->middle[i][k] = number[f[i].middle[k]] - 1;
    }
  }
}

static bool allocate(int nnode, bool curved, surface *s) {
  size_t ntri = (size_t)s->ntri + 1;
  s->corner = malloc(ntri * sizeof *s->corner);
  if (curved) s->middle = malloc(ntri * sizeof *s->middle);
  s->tet = malloc(ntri * sizeof *s->tet);
  s->node = malloc(((size_t)nnode + 1) * sizeof *s->node);
  return s->corner && (s->middle || !curved) && s->tet && s->node;
}

corot_status surface_create_of_order(int nnode, int ntet, const int (*tet)[4], const int (*mid)[6],
                                     surface *out) {
  surface s = {0};
  face *f = NULL;
  COROT_TRY(list_single(nnode, ntet, tet, mid, &s.ntri, &f));
  int *number = calloc((size_t)nnode + 1, sizeof *number);
  bool complete = number && allocate(nnode, mid, &s);
  if (complete) number_nodes(nnode, number, f, &s);
  free(f);
  free(number);
  if (!complete) {
    surface_free(&s);
    return corot_fail(COROT_ENOMEM, "the surface of %d tets: out of memory", ntet);
  }
  *out = s;
  return COROT_OK;
}

corot_status surface_create(int nnode, int ntet, const int (*tet)[4], surface *out) {
  return surface_create_of_order(nnode, ntet, tet, NULL, out);
}
