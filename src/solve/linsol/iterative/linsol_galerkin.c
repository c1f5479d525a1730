/* The pattern of P'AP level by level, found once; then sums. */
#include "linsol_galerkin.h"

#include <stdlib.h>
#include <string.h>

#include "core/lanes/simd.h"

/* --- the nodes of the levels --- */

static corot_status check(const corot_refinement *r) {
  for (int l = 1; l <= r->nlevel; l++)
    for (int i = r->nnode[l - 1]; i < r->nnode[l]; i++) {
      const int *p = r->parent[i - r->nnode[0]];
      if (p[0] < 0 || p[1] < 0 || p[0] >= r->nnode[l - 1] || p[1] >= r->nnode[l - 1])
        return corot_fail(COROT_EINVAL, "refinement: node %d of level %d has the parents %d and %d",
                          i, l, p[0], p[1]);
    }
  return COROT_OK;
}

/* The mesh's number of node i of a refinement. */
static int node_at(const corot_refinement *r, int i) { return r->node ? r->node[i] : i; }

/* Nodes of the mesh become rows of blocks; place [nodes of the mesh] is scratch. */
static void number_nodes(const corot_csc *csc, const node_matrix *A, const corot_refinement *r,
                         int *place, galerkin *g) {
  for (int i = 0; i < r->nnode[r->nlevel]; i++) place[i] = A->n;
  memset(g->held, 7, A->n);
  for (int i = 0; i < csc->n; i++) {
    place[csc->node[i]] = A->slot[i] / 3;
    g->held[A->slot[i] / 3] &= ~(1 << A->slot[i] % 3);
  }
  int n = 0;
  for (int l = 0, i = 0; l <= r->nlevel; l++) {
    for (; i < r->nnode[l]; i++) {
      if (place[node_at(r, i)] == A->n) continue;
      if (l > 0) {
        const int *parent = r->parent[i - r->nnode[0]];
        for (int k = 0; k < 2; k++) g->parent[n - g->level[0].n][k] = place[node_at(r, parent[k])];
      }
      n++;
    }
    g->level[l].n = n;
  }
}

/* --- patterns --- */

/* The nodes of the next coarser level, the first `ncoarse`, of which node i has part: itself, or
   its parents; -1: none. */
static void list_sources(const galerkin *g, int ncoarse, int i, int source[2]) {
  source[0] = i, source[1] = -1;
  if (i < ncoarse) return;
  const int *parent = g->parent[i - g->level[0].n];
  for (int k = 0; k < 2; k++) source[k] = parent[k] < g->n ? parent[k] : -1;
}

/* The pairs of coarse nodes to which a block of row i and column j contributes; a[k] < 0: none. */
static void list_pairs(const galerkin *g, int ncoarse, int i, int j, int a[4], int b[4]) {
  int of_i[2], of_j[2];
  list_sources(g, ncoarse, i, of_i);
  list_sources(g, ncoarse, j, of_j);
  for (int k = 0; k < 4; k++) {
    a[k] = of_i[k / 2], b[k] = of_j[k % 2];
    if (b[k] < 0) a[k] = -1;
  }
}

static int larger(int a, int b) { return a > b ? a : b; }
static int smaller(int a, int b) { return a < b ? a : b; }

/* The columns of the coarse pairs below the diagonal by rows, with repeats: *column, row i from
   first[i] on. Counts only if column is NULL. */
static void collect_pairs(const galerkin *g, const galerkin_level *fine, int ncoarse, int *first,
                          int *column) {
  int a[4], b[4];
  for (int j = 0; j < fine->n; j++)
    for (int k = fine->colptr[j] - 1; k < fine->colptr[j + 1]; k++) {
      list_pairs(g, ncoarse, k < fine->colptr[j] ? j : fine->row[k], j, a, b);
      for (int q = 0; q < 4; q++) {
        if (a[q] < 0 || a[q] == b[q]) continue;
        int at = first[larger(a[q], b[q])]++;
        if (column) column[at] = smaller(a[q], b[q]);
      }
    }
}

/* Leaves the first of equal columns of each row; mark [n] is scratch. Returns how many remain, of
   each column in count [n]. */
static int drop_repeats(int n, int *first, int *column, int *mark, int *count) {
  int kept = 0, begin = 0;
  for (int j = 0; j < n; j++) mark[j] = -1, count[j] = 0;
  for (int i = 0; i < n; i++) {
    int end = first[i];
    first[i] = kept;
    for (int k = begin; k < end; k++) {
      if (mark[column[k]] == i) continue;
      mark[column[k]] = i;
      count[column[k]]++;
      column[kept++] = column[k];
    }
    begin = end;
  }
  first[n] = kept;
  return kept;
}

/* From rows to columns, which come out ascending. */
static void transpose(int n, const int *first, const int *column, int *next, galerkin_level *out) {
  out->colptr[0] = 0;
  for (int j = 0; j < n; j++) out->colptr[j + 1] = out->colptr[j] + next[j];
  memcpy(next, out->colptr, n * sizeof *next);
  for (int i = 0; i < n; i++)
    for (int k = first[i]; k < first[i + 1]; k++) out->row[next[column[k]]++] = i;
}

static corot_status make_pattern(const galerkin *g, const galerkin_level *fine,
                                 galerkin_level *coarse) {
  int n = coarse->n, *work = calloc(3 * (size_t)n + 1, sizeof *work), *column = NULL;
  if (!work) return corot_fail(COROT_ENOMEM, "no memory for a pattern of %d nodes", n);
  int *first = work, *mark = first + n + 1, *count = mark + n, npair = 0;
  /* how many pairs each coarse node is in, and where they begin */
  collect_pairs(g, fine, n, first, NULL);
  for (int i = 0; i < n; i++) {
    int length = first[i];
    first[i] = npair;
    npair += length;
  }
  /* the pairs, each once, and as columns with ascending rows */
  coarse->colptr = malloc((n + 1) * sizeof *coarse->colptr);
  column = malloc((npair + 1) * sizeof *column);
  if (coarse->colptr && column) {
    collect_pairs(g, fine, n, first, column);
    int nbelow = drop_repeats(n, first, column, mark, count);
    coarse->row = malloc((nbelow + 1) * sizeof *coarse->row);
    if (coarse->row) transpose(n, first, column, count, coarse);
  }
  free(work);
  free(column);
  if (coarse->row) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for a pattern of %d pairs", npair);
}

int corot_galerkin_find(const galerkin_level *level, int i, int j) {
  if (i == j) return i;
  int low = level->colptr[j], high = level->colptr[j + 1];
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (level->row[middle] <= i)
      low = middle;
    else
      high = middle;
  }
  return level->n + low;
}

static void place_blocks(const galerkin *g, galerkin_level *fine, const galerkin_level *coarse) {
  int a[4], b[4];
  for (int j = 0; j < fine->n; j++)
    for (int k = fine->colptr[j] - 1; k < fine->colptr[j + 1]; k++) {
      bool diagonal = k < fine->colptr[j];
      list_pairs(g, coarse->n, diagonal ? j : fine->row[k], j, a, b);
      int *to = fine->to[diagonal ? j : fine->n + k];
      for (int q = 0; q < 4; q++)
        to[q] = a[q] < 0
                    ? -1
                    : 2 * corot_galerkin_find(coarse, larger(a[q], b[q]), smaller(a[q], b[q])) +
                          (a[q] < b[q]);
    }
}

static size_t block_count(const galerkin_level *level) {
  return (size_t)level->n + level->colptr[level->n];
}

static corot_status make_level(const galerkin *g, galerkin_level *fine, galerkin_level *coarse) {
  COROT_TRY(make_pattern(g, fine, coarse));
  fine->to = malloc((block_count(fine) + 1) * sizeof *fine->to);
  coarse->value = calloc(9 * block_count(coarse) + 3, sizeof *coarse->value);
  if (!fine->to || !coarse->value)
    return corot_fail(COROT_ENOMEM, "no memory for a matrix of %zu blocks", block_count(fine));
  place_blocks(g, fine, coarse);
  return COROT_OK;
}

corot_status corot_galerkin_create(const corot_csc *csc, const node_matrix *A,
                                   const corot_refinement *r, galerkin *g) {
  *g = (galerkin){.n = A->n};
  COROT_TRY(check(r));
  int *place = malloc(r->nnode[r->nlevel] * sizeof *place);
  g->level = calloc(r->nlevel + 1, sizeof *g->level);
  g->parent = malloc(A->n * sizeof *g->parent);
  g->held = malloc(A->n);
  bool enough = place && g->level && g->parent && g->held;
  if (enough) {
    g->nlevel = r->nlevel;
    number_nodes(csc, A, r, place, g);
  }
  free(place);
  if (!enough) return corot_fail(COROT_ENOMEM, "no memory for the levels of %d nodes", A->n);
  galerkin_level *last = &g->level[g->nlevel];
  last->colptr = A->colptr, last->row = A->row, last->value = A->value;
  for (int l = g->nlevel; l > 0; l--) COROT_TRY(make_level(g, &g->level[l], &g->level[l - 1]));
  return COROT_OK;
}

void corot_galerkin_clear(galerkin *g) {
  for (int l = 0; l <= g->nlevel && g->level; l++) {
    galerkin_level *level = &g->level[l];
    free(level->to);
    if (l == g->nlevel) continue;
    free(level->colptr), free(level->row), free(level->value);
  }
  free(g->level), free(g->parent), free(g->held);
}

/* --- values --- */

/* Rows and columns of held components become zero. */
COROT_INLINE void mask(double *B, int row_held, int column_held) {
  if (!(row_held | column_held)) return;
  for (int c = 0; c < 3; c++)
    for (int r = 0; r < 3; r++)
      if (row_held >> r & 1 || column_held >> c & 1) B[3 * c + r] = 0;
}

/* The parts of `weight` B. */
COROT_INLINE void add_parts(const double *B, double weight, const int to[4], double *value) {
  double both[2][9];
  for (int c = 0; c < 3; c++)
    for (int r = 0; r < 3; r++) both[0][3 * c + r] = both[1][3 * r + c] = weight * B[3 * c + r];
  for (int q = 0; q < 4; q++) {
    if (to[q] < 0) continue;
    const double *part = both[to[q] & 1];
    double *sum = value + 9 * (size_t)(to[q] >> 1);
    for (int k = 0; k < 9; k++) sum[k] += part[k];
  }
}

/* With A = H + H', H of the blocks below the diagonal and the halves of those on it: P' A P is
   P' H P and its transpose, which coincide on the diagonal. */
static COROT_CLONES void restrict_to(const galerkin *g, const galerkin_level *fine,
                                     galerkin_level *coarse) {
  int ncoarse = coarse->n;
  memset(coarse->value, 0, 9 * block_count(coarse) * sizeof *coarse->value);
  /* P' H P */
  for (int j = 0; j < fine->n; j++) {
    double weight = j < ncoarse ? 1 : 0.5, D[9];
    memcpy(D, fine->value + 9 * (size_t)j, sizeof D);
    mask(D, g->held[j], g->held[j]);
    add_parts(D, 0.5 * weight * weight, fine->to[j], coarse->value);
    for (int k = fine->colptr[j]; k < fine->colptr[j + 1]; k++) {
      size_t block = (size_t)fine->n + k;
      add_parts(fine->value + 9 * block, fine->row[k] < ncoarse ? weight : 0.5 * weight,
                fine->to[block], coarse->value);
    }
  }
  /* its transpose; rows and columns of what is held stay empty */
  for (int j = 0; j < ncoarse; j++) {
    double *D = coarse->value + 9 * (size_t)j, H[9];
    memcpy(H, D, sizeof H);
    for (int c = 0; c < 3; c++)
      for (int r = 0; r < 3; r++) D[3 * c + r] = H[3 * c + r] + H[3 * r + c];
    mask(D, g->held[j], g->held[j]);
    for (int k = coarse->colptr[j]; k < coarse->colptr[j + 1]; k++)
      mask(coarse->value + 9 * ((size_t)ncoarse + k), g->held[coarse->row[k]], g->held[j]);
  }
}

void corot_galerkin_load(galerkin *g) {
  for (int l = g->nlevel; l > 0; l--) restrict_to(g, &g->level[l], &g->level[l - 1]);
}

int corot_galerkin_invert(const galerkin *g, int l, int first, double (*inverse)[9]) {
  const galerkin_level *level = &g->level[l];
  for (int i = first; i < level->n; i++) {
    double D[9];
    memcpy(D, level->value + 9 * (size_t)i, sizeof D);
    for (int c = 0; c < 3; c++)
      if (g->held[i] >> c & 1) D[4 * c] = 1;
    if (!corot_nodes_invert(D, inverse[i - first])) return i;
  }
  return -1;
}
