/* Which tets share an average, and who contributes to it. */
#include "dilatation.h"

#include <limits.h>
#include <stdint.h>
#include <stdlib.h>

/* A pool for each element; lanes beyond the last repeat it. */
static void number_elements(const element_set *t, dilatation *d) {
  for (int b = 0; b < t->nblock; b++) {
    int n = t->block[b].n;
    for (int l = 0; l < W; l++) d->pool[b][l] = d->npool + (l < n ? l : n - 1);
    d->npool += n;
  }
}

/* Blocks of one material follow each other: a node's pool is new where its last one belongs to an
   earlier material. `material` and `last` [nnode] are scratch. */
static void number_corners(const corot_mesh *mesh, const element_set *t, int *material, int *last,
                           dilatation *d) {
  for (int n = 0; n < mesh->nnode; n++) material[n] = -1;
  for (int b = 0; b < t->nblock; b++) {
    int node[W][KIND_NODES];
    for (int l = 0; l < W; l++) corot_tets_nodes(mesh, t->number[b * W + l], node[l]);
    for (int k = 0; k < d->per; k++)
      for (int l = 0; l < W; l++) {
        int n = node[l][k];
        if (material[n] != t->block[b].material) {
          material[n] = t->block[b].material;
          last[n] = d->npool++;
        }
        d->pool[b * d->per + k][l] = last[n];
      }
  }
}

static corot_status number_pools(const corot_mesh *mesh, const element_set *t, bool by_element,
                                 dilatation *d) {
  int nnode = mesh->nnode;
  int *material = malloc(nnode * sizeof *material), *last = malloc(nnode * sizeof *last);
  d->per = by_element ? 1 : 4;
  d->pool = malloc((size_t)t->nblock * d->per * sizeof *d->pool);
  bool room = material && last && d->pool;
  if (room && by_element) number_elements(t, d);
  if (room && !by_element) number_corners(mesh, t, material, last, d);
  free(material), free(last);
  return room ? COROT_OK
              : corot_fail(COROT_ENOMEM, "no memory for the averages of %d nodes", nnode);
}

static corot_status weigh_pools(const element_set *t, const double *averaged, dilatation *d) {
  d->volume = calloc(d->npool, sizeof *d->volume);
  d->lambda = malloc(d->npool * sizeof *d->lambda);
  if (!d->volume || !d->lambda)
    return corot_fail(COROT_ENOMEM, "no memory for %d averages", d->npool);
  for (int b = 0; b < t->nblock; b++)
    for (int a = 0; a < d->per; a++)
      for (int l = 0; l < W; l++) {
        int pool = pools_at(d, b, a)[l];
        d->volume[pool] += volume_at(t, b, l);
        d->lambda[pool] = averaged[t->block[b].material];
      }
  return COROT_OK;
}

/* Count, then fill: `next` is shifted by one while filling, in place after. */
static corot_status list_tets(const element_set *t, dilatation *d) {
  size_t n = 0;
  for (int b = 0; b < t->nblock; b++) n += (size_t)d->per * t->block[b].n;
  d->tet_first = calloc((size_t)d->npool + 2, sizeof *d->tet_first);
  d->tet = malloc(n * sizeof *d->tet);
  if (!d->tet_first || !d->tet)
    return corot_fail(COROT_ENOMEM, "no memory for %d averages", d->npool);
  int *next = d->tet_first + 1;
  for (int b = 0; b < t->nblock; b++)
    for (int a = 0; a < d->per; a++)
      for (int l = 0; l < t->block[b].n; l++) next[pools_at(d, b, a)[l] + 1]++;
  for (int p = 0; p < d->npool; p++) next[p + 1] += next[p];
  for (int b = 0; b < t->nblock; b++)
    for (int a = 0; a < d->per; a++)
      for (int l = 0; l < t->block[b].n; l++) d->tet[next[pools_at(d, b, a)[l]]++] = b * W + l;
  return COROT_OK;
}

/* The nodes of a pool's tets, ascending, into `list`; returns their number. */
static int ring_of(const element_set *t, const dilatation *d, int pool, int *mark, int *list) {
  int n = 0;
  for (int k = d->tet_first[pool]; k < d->tet_first[pool + 1]; k++)
    for (int a = 0; a < t->kind->nnode; a++) {
      int i = nodes_at(t, d->tet[k] / W, a)[d->tet[k] % W];
      if (mark[i] == pool) continue;
      mark[i] = pool;
      int at = n++;
      for (; at > 0 && list[at - 1] > i; at--) list[at] = list[at - 1];
      list[at] = i;
    }
  return n;
}

static corot_status list_rings(int nnode, const element_set *t, dilatation *d) {
  int *mark = malloc(nnode * sizeof *mark), *list = malloc(nnode * sizeof *list);
  d->ring_first = calloc((size_t)d->npool + 1, sizeof *d->ring_first);
  if (!mark || !list || !d->ring_first) goto no_memory;

  for (int pass = 0; pass < 2; pass++) { /* count, then write */
    for (int n = 0; n < nnode; n++) mark[n] = -1;
    size_t total = 0;
    for (int p = 0; p < d->npool; p++) {
      int n = d->lambda[p] > 0 ? ring_of(t, d, p, mark, list) : 0;
      if (pass == 1) memcpy(d->ring + d->ring_first[p], list, n * sizeof *list);
      total += n;
      if (total > INT_MAX) {
        free(mark), free(list);
        return corot_fail(COROT_EINVAL, "the averages exceed 32-bit counts at number %d", p);
      }
      d->ring_first[p + 1] = (int)total;
    }
    if (pass == 1) break;
    d->ring = malloc((total + 1) * sizeof *d->ring);
    if (!d->ring) goto no_memory;
  }
  free(mark), free(list);
  return COROT_OK;

no_memory:
  free(mark), free(list);
  return corot_fail(COROT_ENOMEM, "no memory for the nodes of %d averages", d->npool);
}

/* The first colour that no node of the batch's rings has got from another; MOST_COLOURS: there is
   none. `taken` [nnode]: bit c: colour c. */
static int colour_batch(const dilatation *d, int batch, uint64_t *taken) {
  uint64_t all = 0;
  int colour = 0;
  int from = d->ring_first[batch * BATCH], end = d->ring_first[batch_end(d, batch)];
  for (int r = from; r < end; r++) all |= taken[d->ring[r]];
  while (colour < MOST_COLOURS && (all >> colour & 1)) colour++;
  for (int r = from; r < end && colour < MOST_COLOURS; r++)
    taken[d->ring[r]] |= (uint64_t)1 << colour;
  return colour;
}

static corot_status colour_batches(int nnode, dilatation *d) {
  int nbatch = (d->npool + BATCH - 1) / BATCH, n = 0;
  uint64_t *taken = calloc(nnode, sizeof *taken);
  int *colour = malloc(((size_t)nbatch + 1) * sizeof *colour);
  d->batch = malloc(((size_t)nbatch + 1) * sizeof *d->batch);
  bool room = taken && colour && d->batch;
  for (int b = 0; b < nbatch && room; b++) {
    colour[b] = colour_batch(d, b, taken);
    if (colour[b] < MOST_COLOURS && colour[b] >= d->ncolour) d->ncolour = colour[b] + 1;
  }
  for (int c = 0; c <= d->ncolour && room; c++) {
    d->first[c] = n;
    for (int b = 0; b < nbatch; b++)
      if (colour[b] == (c < d->ncolour ? c : MOST_COLOURS)) d->batch[n++] = b;
  }
  d->first[d->ncolour + 1] = n;
  free(taken), free(colour);
  return room ? COROT_OK : corot_fail(COROT_ENOMEM, "no memory for %d averages", d->npool);
}

corot_status corot_dilatation_create(const corot_mesh *mesh, const element_set *t, bool by_element,
                                     const double *averaged, dilatation *out) {
  dilatation d = {0};
  corot_status status = number_pools(mesh, t, by_element, &d);
  if (!status) status = weigh_pools(t, averaged, &d);
  if (!status) status = list_tets(t, &d);
  if (!status) status = list_rings(mesh->nnode, t, &d);
  if (!status) status = colour_batches(mesh->nnode, &d);
  if (status) {
    corot_dilatation_clear(&d);
    return status;
  }
  *out = d;
  return COROT_OK;
}

void corot_dilatation_clear(dilatation *d) {
  free(d->pool);
  free(d->volume);
  free(d->lambda);
  free(d->tet_first);
  free(d->tet);
  free(d->ring_first);
  free(d->ring);
  free(d->batch);
  *d = (dilatation){0};
}

size_t corot_dilatation_bytes(const dilatation *d, const element_set *t) {
  if (!d->npool) return 0;
  size_t lists = 2 * ((size_t)d->npool + 1) + d->tet_first[d->npool] + d->ring_first[d->npool] +
                 d->first[d->ncolour + 1];
  return (size_t)t->nblock * d->per * sizeof *d->pool + d->npool * 2 * sizeof(double) +
         lists * sizeof(int);
}
