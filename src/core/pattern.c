#include "core/pattern.h"

#include <limits.h>
#include <stdlib.h>

/* Each node's slots in the force buffer: count, then fill in the order of the tets. */
static corot_status list_slots(int nnode, const tets *t, pattern *p) {
  size_t nslot = 0;
  for (int b = 0; b < t->nblock; b++) nslot += 4 * (size_t)t->block[b].ntet;
  p->first = calloc(nnode + 2, sizeof *p->first);
  p->slot = malloc(nslot * sizeof *p->slot);
  if (!p->first || !p->slot) return corot_fail(COROT_ENOMEM, "no memory for the node lists");

  int *next = p->first + 1; /* shifted by one while filling, in place after */
  for (int b = 0; b < t->nblock; b++)
    for (int a = 0; a < 4; a++)
      for (int l = 0; l < t->block[b].ntet; l++) next[t->block[b].node[a][l] + 1]++;
  for (int n = 0; n < nnode; n++) next[n + 1] += next[n];
  for (int b = 0; b < t->nblock; b++)
    for (int a = 0; a < 4; a++)
      for (int l = 0; l < t->block[b].ntet; l++)
        p->slot[next[t->block[b].node[a][l]]++] = (b * 4 + a) * 3 * W + l;
  return COROT_OK;
}

/* The nodes >= j that share a tet with node j, ascending: into `list`; returns their number. */
static int column_rows(const tets *t, const pattern *p, int j, int *mark, int *list) {
  int n = 0;
  for (int k = p->first[j]; k < p->first[j + 1]; k++) {
    int slot = p->slot[k], lane = slot % W;
    const tet_block *block = &t->block[slot / (4 * 3 * W)];
    for (int a = 0; a < 4; a++) {
      int i = block->node[a][lane];
      if (i < j || mark[i] == j) continue;
      mark[i] = j;
      int at = n++;
      for (; at > 0 && list[at - 1] > i; at--) list[at] = list[at - 1];
      list[at] = i;
    }
  }
  return n;
}

static corot_status list_blocks(int nnode, const tets *t, pattern *p) {
  int *mark = malloc(nnode * sizeof *mark), *list = malloc(nnode * sizeof *list);
  p->colptr = malloc((nnode + 1) * sizeof *p->colptr);
  if (!mark || !list || !p->colptr) goto no_memory;

  for (int pass = 0; pass < 2; pass++) { /* count, then write */
    for (int n = 0; n < nnode; n++) mark[n] = -1;
    size_t total = 0;
    for (int j = 0; j < nnode; j++) {
      int n = column_rows(t, p, j, mark, list);
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

static int find_block(const pattern *p, int i, int j) {
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

static corot_status place_tets(const tets *t, pattern *p) {
  p->place = malloc(t->nblock * sizeof *p->place);
  if (!p->place) return corot_fail(COROT_ENOMEM, "no memory for the matrix places");
  for (int b = 0; b < t->nblock; b++)
    for (int k = 0; k < NPAIR; k++)
      for (int l = 0; l < W; l++) {
        const tet_block *block = &t->block[b];
        p->place[b][k][l] = find_block(p, block->node[pair_row[k]][l], block->node[pair_col[k]][l]);
      }
  return COROT_OK;
}

corot_status pattern_create(int nnode, const tets *t, pattern *out) {
  pattern p = {.nnode = nnode};
  corot_status status = list_slots(nnode, t, &p);
  if (!status) status = list_blocks(nnode, t, &p);
  if (!status) status = place_tets(t, &p);
  if (status) {
    pattern_clear(&p);
    return status;
  }
  *out = p;
  return COROT_OK;
}

void pattern_clear(pattern *p) {
  free(p->colptr);
  free(p->row);
  free(p->place);
  free(p->first);
  free(p->slot);
  *p = (pattern){0};
}
