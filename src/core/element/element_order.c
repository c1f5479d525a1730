/* Counting sorts by keys that are made of the nodes' ranks. */
#include "element_order.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/mesh/mesh.h"

/* Scratch of a sort. */
typedef struct sorting {
  int *lowest;       /* [ntet] key of each tet */
  int *count;        /* [keys + 1] */
  int *by_node;      /* [ntet] */
  int *first, *last; /* [nnode] where in the loop a node's tets are */
  int *rank;         /* [nnode] of the nodes; NULL: their numbers */
} sorting;

/* Counting sort; order[k] is the mesh's number of the k-th tet. */
static void sort_tets(const corot_mesh *mesh, const int *key, int nkey, const int *from, int *count,
                      int *order) {
  memset(count, 0, (nkey + 1) * sizeof *count);
  for (int k = 0; k < mesh->ntet; k++) count[key[from ? from[k] : k] + 1]++;
  for (int i = 0; i < nkey; i++) count[i + 1] += count[i];
  for (int k = 0; k < mesh->ntet; k++) {
    int e = from ? from[k] : k;
    order[count[key[e]]++] = e;
  }
}

/* Of the corners of all tets that stay together. */
static void find_lowest(const corot_mesh *mesh, int together, const int *rank, int *lowest) {
  for (int e = 0; e < mesh->ntet; e++) {
    int first = e - e % together;
    for (int k = 0; k < 4; k++) {
      int n = rank ? rank[mesh->tet[e][k]] : mesh->tet[e][k];
      if ((e == first && k == 0) || n < lowest[first]) lowest[first] = n;
    }
  }
  for (int e = 0; e < mesh->ntet; e++) lowest[e] = lowest[e - e % together];
}

static void sort_by(const corot_mesh *mesh, int nmaterial, const int *material, int together,
                    sorting *s, int *order) {
  find_lowest(mesh, together, s->rank, s->lowest);
  sort_tets(mesh, s->lowest, mesh->nnode, NULL, s->count, s->by_node);
  sort_tets(mesh, material, nmaterial, s->by_node, s->count, order);
}

/* How far apart in the loop the first and the last tet of a corner are, on average. */
static double mean_reach(const corot_mesh *mesh, const int *order, sorting *s) {
  double sum = 0;
  int n = 0;
  for (int i = 0; i < mesh->nnode; i++) s->first[i] = -1;
  for (int k = 0; k < mesh->ntet; k++)
    for (int c = 0; c < 4; c++) {
      int i = mesh->tet[order[k]][c];
      if (s->first[i] < 0) s->first[i] = k;
      s->last[i] = k;
    }
  for (int i = 0; i < mesh->nnode; i++)
    if (s->first[i] >= 0) sum += s->last[i] - s->first[i], n++;
  return sum / n;
}

/* --- A search in breadth --- */

/* From a corner on, into queue [from `n` on]; seen [nnode] is `mark` where it has been. Returns the
   queue's end. */
static int search(const corot_mesh *mesh, const int *first, const int *tet, int start, int mark,
                  int *seen, int *queue, int n) {
  int end = n + 1;
  queue[n] = start, seen[start] = mark;
  for (int k = n; k < end; k++)
    for (int p = first[queue[k]]; p < first[queue[k] + 1]; p++)
      for (int c = 0; c < 4; c++) {
        int i = mesh->tet[tet[p]][c];
        if (seen[i] == mark) continue;
        seen[i] = mark;
        queue[end++] = i;
      }
  return end;
}

/* Piece by piece, each from an end that a first search finds. Middles of edges, which are no
   corners, need no rank. */
static void rank_corners(const corot_mesh *mesh, const int *first, const int *tet, int *seen,
                         int *queue, int *rank) {
  int n = 0;
  memset(seen, 0, mesh->nnode * sizeof *seen);
  for (int i = 0; i < mesh->nnode; i++) {
    if (seen[i] == 2 || first[i] == first[i + 1]) continue;
    int end = search(mesh, first, tet, i, 1, seen, queue, n);
    n = search(mesh, first, tet, queue[end - 1], 2, seen, queue, n);
  }
  memset(rank, 0, mesh->nnode * sizeof *rank);
  for (int k = 0; k < n; k++) rank[queue[k]] = k;
}

/* s->rank of the nodes; s->first and s->last are scratch. */
static bool find_ranks(const corot_mesh *mesh, sorting *s) {
  int *first = calloc((size_t)mesh->nnode + 1, sizeof *first);
  int *tet = malloc(4 * (size_t)mesh->ntet * sizeof *tet);
  s->rank = malloc(mesh->nnode * sizeof *s->rank);
  bool room = first && tet && s->rank;
  if (room) {
    corot_corner_tets(mesh, first, tet);
    rank_corners(mesh, first, tet, s->first, s->last, s->rank);
  }
  free(first), free(tet);
  return room;
}

/* Loops of so many tets stay in a cache in any order; and one is taken for jumping where a node's
   tets reach over this part of it on average. */
enum { FEW = 4096 };
static const double far = 0.1;

static bool sort_all(const corot_mesh *mesh, int nmaterial, const int *material, int together,
                     sorting *s, int *order) {
  sort_by(mesh, nmaterial, material, together, s, order);
  if (mesh->ntet < FEW) return true;
  double reach = mean_reach(mesh, order, s);
  if (reach < far * mesh->ntet) return true;
  if (!find_ranks(mesh, s)) return false;
  sort_by(mesh, nmaterial, material, together, s, order);
  if (mean_reach(mesh, order, s) < reach) return true;
  free(s->rank); /* no better */
  s->rank = NULL;
  sort_by(mesh, nmaterial, material, together, s, order);
  return true;
}

corot_status corot_element_order(const corot_mesh *mesh, int nmaterial, const int *material,
                                 int together, int *order) {
  size_t ntet = mesh->ntet, nnode = mesh->nnode;
  size_t nkey = nnode > (size_t)nmaterial ? nnode : (size_t)nmaterial;
  sorting s = {.lowest = malloc(ntet * sizeof *s.lowest),
               .count = malloc((nkey + 1) * sizeof *s.count),
               .by_node = malloc(ntet * sizeof *s.by_node),
               .first = malloc(nnode * sizeof *s.first),
               .last = malloc(nnode * sizeof *s.last)};
  bool room = s.lowest && s.count && s.by_node && s.first && s.last;
  room = room && sort_all(mesh, nmaterial, material, together, &s, order);
  free(s.lowest), free(s.count), free(s.by_node), free(s.first), free(s.last), free(s.rank);
  return room ? COROT_OK : corot_fail(COROT_ENOMEM, "no memory for %d tets", mesh->ntet);
}
