/* Counts neighbours, sorts them, and numbers the blocks. */
#include "pattern.h"

#include <limits.h>
#include <stdlib.h>

/* Element forces of a block. */
static int block_slots(const element_set *t) { return t->kind->nnode * 3 * W; }

/* Each node's slots in a force buffer of all blocks: count, then fill in the order of the tets. */
static corot_status list_slots(int nnode, const element_set *t, pattern *p) {
  size_t nslot = 0;
  for (int b = 0; b < t->nblock; b++) nslot += (size_t)t->kind->nnode * t->block[b].n;
  p->first = calloc(nnode + 2, sizeof *p->first);
  p->slot = malloc(nslot * sizeof *p->slot);
  if (!p->first || !p->slot) return corot_fail(COROT_ENOMEM, "no memory for the node lists");

  int *next = p->first + 1; /* shifted by one while filling, in place after */
  for (int b = 0; b < t->nblock; b++)
    for (int a = 0; a < t->kind->nnode; a++)
      for (int l = 0; l < t->block[b].n; l++) next[nodes_at(t, b, a)[l] + 1]++;
  for (int n = 0; n < nnode; n++) next[n + 1] += next[n];
  for (int b = 0; b < t->nblock; b++)
    for (int a = 0; a < t->kind->nnode; a++)
      for (int l = 0; l < t->block[b].n; l++)
        p->slot[next[nodes_at(t, b, a)[l]]++] = b * block_slots(t) + a * 3 * W + l;
  return COROT_OK;
}

/* A column's rows while they are gathered. */
typedef struct column {
  int j;
  int n;
  int *row;  /* [n] ascending */
  int *mark; /* [nnode] j: is there already */
} column;

static void add_row(column *c, int i) {
  if (i < c->j || c->mark[i] == c->j) return;
  c->mark[i] = c->j;
  int at = c->n++;
  for (; at > 0 && c->row[at - 1] > i; at--) c->row[at] = c->row[at - 1];
  c->row[at] = i;
}

/* The nodes >= j that share a tet, an average, or a block of `more` with node j, ascending: into
   `list`; returns their number. */
static int column_rows(const element_set *t, const dilatation *d, const pattern *more,
                       const pattern *p, int j, int *mark, int *list) {
  column c = {.j = j, .row = list, .mark = mark};
  for (int k = p->first[j]; k < p->first[j + 1]; k++) {
    int slot = p->slot[k], lane = slot % W, b = slot / block_slots(t);
    for (int a = 0; a < t->kind->nnode; a++) add_row(&c, nodes_at(t, b, a)[lane]);
    for (int i = 0; d->npool && i < d->per; i++) {
      int pool = pools_at(d, b, i)[lane];
      for (int r = d->ring_first[pool]; r < d->ring_first[pool + 1]; r++) add_row(&c, d->ring[r]);
    }
  }
  if (more && j < more->nnode)
    for (int k = more->colptr[j]; k < more->colptr[j + 1]; k++) add_row(&c, more->row[k]);
  return c.n;
}

static corot_status list_blocks(int nnode, const element_set *t, const dilatation *d,
                                const pattern *more, pattern *p) {
  int *mark = malloc(nnode * sizeof *mark), *list = malloc(nnode * sizeof *list);
  p->colptr = malloc((nnode + 1) * sizeof *p->colptr);
  if (!mark || !list || !p->colptr) goto no_memory;

  for (int pass = 0; pass < 2; pass++) { /* count, then write */
    for (int n = 0; n < nnode; n++) mark[n] = -1;
    size_t total = 0;
    for (int j = 0; j < nnode; j++) {
      int n = column_rows(t, d, more, p, j, mark, list);
      if (pass == 0) p->colptr[j] = (int)total;
      if (pass == 1) memcpy(p->row + p->colptr[j], list, n * sizeof *list);
      total += n;
      if (total > INT_MAX / 9) {
        free(mark), free(list);
        return corot_fail(COROT_EINVAL, "the matrix pattern exceeds 32-bit counts at node %d", j);
      }
    }
    if (pass == 1) break;
    p->nblock = p->colptr[nnode] = (int)total;
    p->row = malloc(total * sizeof *p->row);
    if (!p->row) goto no_memory;
  }
  free(mark), free(list);
  return COROT_OK;

no_memory:
  free(mark), free(list);
  return corot_fail(COROT_ENOMEM, "no memory for the matrix pattern");
}

int corot_pattern_find(const pattern *p, int i, int j) {
  int low = p->colptr[j], high = p->colptr[j + 1] - 1;
  while (low < high) {
    int mid = low + (high - low) / 2;
    if (p->row[mid] < i)
      low = mid + 1;
    else
      high = mid;
  }
  return low;
}

static corot_status place_tets(const element_set *t, pattern *p) {
  int npair = t->kind->npair;
  p->place = malloc((size_t)t->nblock * npair * sizeof *p->place);
  if (!p->place) return corot_fail(COROT_ENOMEM, "no memory for the matrix places");
  for (int b = 0; b < t->nblock; b++)
    for (int k = 0; k < npair; k++)
      for (int l = 0; l < W; l++)
        p->place[b * npair + k][l] = corot_pattern_find(p, nodes_at(t, b, t->kind->pair[k][0])[l],
                                                        nodes_at(t, b, t->kind->pair[k][1])[l]);
  return COROT_OK;
}

static int chunk_end(const element_set *t, int chunk) {
  return chunk < t->nblock / CHUNK ? (chunk + 1) * CHUNK : t->nblock;
}

/* The chunk of a node's last tet. */
static int last_chunk(const element_set *t, const pattern *p, int node) {
  return p->slot[p->first[node + 1] - 1] / block_slots(t) / CHUNK;
}

/* The blocks of each row that stand before its diagonal: count, then fill by columns. */
static corot_status list_left(int nnode, pattern *p) {
  p->left_first = calloc(nnode + 2, sizeof *p->left_first);
  p->left = malloc((p->nblock - nnode + 1) * sizeof *p->left);
  if (!p->left_first || !p->left)
    return corot_fail(COROT_ENOMEM, "no memory for a pattern of %d blocks", p->nblock);
  int *next = p->left_first + 1; /* shifted by one while filling, in place after */
  for (int j = 0; j < nnode; j++)
    for (int k = p->colptr[j] + 1; k < p->colptr[j + 1]; k++) next[p->row[k] + 1]++;
  for (int n = 0; n < nnode; n++) next[n + 1] += next[n];
  for (int j = 0; j < nnode; j++)
    for (int k = p->colptr[j] + 1; k < p->colptr[j + 1]; k++) p->left[next[p->row[k]]++] = k;
  return COROT_OK;
}

/* Sorts the nodes by their last chunk, and finds how far back each one's tets reach from there. */
static corot_status plan_sums(int nnode, const element_set *t, pattern *p) {
  p->nchunk = (t->nblock + CHUNK - 1) / CHUNK;
  p->due = calloc(p->nchunk + 2, sizeof *p->due);
  p->turn = malloc(nnode * sizeof *p->turn);
  if (!p->due || !p->turn) return corot_fail(COROT_ENOMEM, "no memory for the order of the sums");
  int *next = p->due + 1; /* shifted by one while filling, in place after */
  for (int n = 0; n < nnode; n++) next[last_chunk(t, p, n) + 1]++;
  for (int c = 0; c < p->nchunk; c++) next[c + 1] += next[c];
  for (int n = 0; n < nnode; n++) {
    int c = last_chunk(t, p, n);
    int back = chunk_end(t, c) - p->slot[p->first[n]] / block_slots(t);
    if (back > p->window) p->window = back;
    p->turn[next[c]++] = n;
  }
  return COROT_OK;
}

/* The buffer is used again and again: no more than a window of it is needed at a time. */
static void wrap_slots(int nnode, const element_set *t, pattern *p) {
  int size = p->window * block_slots(t);
  for (int k = 0; k < p->first[nnode]; k++) p->slot[k] %= size;
}

corot_status corot_pattern_create(int nnode, const element_set *t, const dilatation *d,
                                  const pattern *more, pattern *out) {
  pattern p = {.nnode = nnode};
  corot_status status = list_slots(nnode, t, &p);
  if (!status) status = list_blocks(nnode, t, d, more, &p);
  if (!status) status = place_tets(t, &p);
  if (!status) status = list_left(nnode, &p);
  if (!status) status = plan_sums(nnode, t, &p);
  if (status) {
    corot_pattern_clear(&p);
    return status;
  }
  wrap_slots(nnode, t, &p);
  *out = p;
  return COROT_OK;
}

void corot_pattern_clear(pattern *p) {
  free(p->colptr);
  free(p->row);
  free(p->place);
  free(p->left_first);
  free(p->left);
  free(p->due);
  free(p->turn);
  free(p->first);
  free(p->slot);
  *p = (pattern){0};
}
