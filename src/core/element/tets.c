/* Sorts the tets into blocks of one material and computes their gradients. */
#include "tets.h"

#include <limits.h>
#include <stdint.h>
#include <stdlib.h>

#include "core/lanes/polar.h"

void *corot_vector_calloc(size_t count, size_t size) {
  if (size && count > (SIZE_MAX - sizeof(vd)) / size) return NULL;
  size_t bytes = (count * size + sizeof(vd) - 1) / sizeof(vd) * sizeof(vd);
  void *p = aligned_alloc(sizeof(vd), bytes ? bytes : sizeof(vd));
  if (p) memset(p, 0, bytes);
  return p;
}

/* Order of the kernels' loop: by material, then by lowest node, so that neighbours in the loop
   share nodes in the cache. Counting sort; order[k] is the mesh's number of the k-th tet. */
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

static void ascending(const int tet[4], int node[4]) {
  for (int a = 0; a < 4; a++) {
    int b = a;
    for (; b > 0 && node[b - 1] > tet[a]; b--) node[b] = node[b - 1];
    node[b] = tet[a];
  }
}

/* Rest gradients: the rows of D^-1 for D = [x1 - x0, x2 - x0, x3 - x0]; volume |det D| / 6. */
static void fill_block(const corot_mesh *mesh, const int *number, tet_block *block) {
  mat3 D;
  for (int l = 0; l < W; l++) {
    int node[4];
    ascending(mesh->tet[number[l]], node);
    for (int a = 0; a < 4; a++) block->node[a][l] = node[a];
    EACH_IJ D.m[i][j][l] = mesh->x[node[j + 1]][i] - mesh->x[node[0]][i];
  }
  mat3 C = mat3_cofactor(D);
  vd det = mat3_det(D, C);
  block->g = mat3_scale(1.0 / det, mat3_transpose(C));
  for (int l = 0; l < W; l++) block->volume[l] = l < block->ntet ? fabs(det[l]) / 6 : 0;
}

mat3 corot_tets_rest_basis(const corot_mesh *mesh, const int *number) {
  mat3 D;
  for (int l = 0; l < W; l++) {
    const int *node = mesh->tet[number[l]];
    EACH_IJ D.m[i][j][l] = mesh->x[node[j + 1]][i] - mesh->x[node[0]][i];
  }
  return gram_schmidt(D);
}

/* Of the nodes of all tets that stay together. */
static void find_lowest(const corot_mesh *mesh, int together, int *lowest) {
  for (int e = 0; e < mesh->ntet; e++) {
    const int *n = mesh->tet[e];
    int low01 = n[0] < n[1] ? n[0] : n[1], low23 = n[2] < n[3] ? n[2] : n[3];
    int low = low01 < low23 ? low01 : low23, first = e - e % together;
    if (e == first || low < lowest[first]) lowest[first] = low;
  }
  for (int e = 0; e < mesh->ntet; e++) lowest[e] = lowest[e - e % together];
}

corot_status corot_tets_create(const corot_mesh *mesh, int nmaterial, const int *material,
                               int together, int with_rest_basis, tets *out) {
  tets t = {0};
  if (mesh->ntet > INT_MAX / (4 * 3) - W * nmaterial) /* slots in the force buffer */
    return corot_fail(COROT_EINVAL, "%d tets exceed 32-bit counts", mesh->ntet);
  int ntet = mesh->ntet, nkey = mesh->nnode > nmaterial ? mesh->nnode : nmaterial;
  int *lowest = calloc(ntet, sizeof *lowest), *count = malloc((nkey + 1) * sizeof *count);
  int *by_node = malloc(ntet * sizeof *by_node), *order = malloc(ntet * sizeof *order);
  if (!lowest || !count || !by_node || !order) goto no_memory;

  find_lowest(mesh, together, lowest);
  sort_tets(mesh, lowest, mesh->nnode, NULL, count, by_node);
  sort_tets(mesh, material, nmaterial, by_node, count, order);

  /* blocks: W tets in order, a new one where the material changes */
  for (int k = 0, lanes = W; k < ntet; k++, lanes++)
    if (lanes == W || material[order[k]] != material[order[k - 1]]) t.nblock++, lanes = 0;
  t.block = corot_vector_calloc(t.nblock, sizeof *t.block);
  t.number = malloc((size_t)t.nblock * W * sizeof *t.number);
  if (with_rest_basis) t.rest_basis = corot_vector_calloc(t.nblock, sizeof *t.rest_basis);
  if (!t.block || !t.number || (with_rest_basis && !t.rest_basis)) goto no_memory;

  for (int b = 0, k = 0; b < t.nblock; b++) {
    int *number = t.number + (size_t)b * W, m = material[order[k]];
    tet_block *block = &t.block[b];
    block->material = m;
    while (block->ntet < W && k < ntet && material[order[k]] == m)
      number[block->ntet++] = order[k++];
    for (int l = block->ntet; l < W; l++) number[l] = number[block->ntet - 1];
    fill_block(mesh, number, block);
    if (with_rest_basis) t.rest_basis[b] = corot_tets_rest_basis(mesh, number);
  }
  free(lowest), free(count), free(by_node), free(order);
  *out = t;
  return COROT_OK;

no_memory:
  free(lowest), free(count), free(by_node), free(order);
  corot_tets_clear(&t);
  return corot_fail(COROT_ENOMEM, "no memory for %d tets", ntet);
}

void corot_tets_clear(tets *t) {
  free(t->block);
  free(t->number);
  free(t->rest_basis);
  *t = (tets){0};
}
