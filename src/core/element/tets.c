/* Sorts the tets into blocks of one material and computes their gradients. */
#include "tets.h"

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "core/lanes/polar.h"
#include "core/mesh/mesh.h"
#include "element_order.h"

void *corot_vector_calloc(size_t count, size_t size) {
  if (size && count > (SIZE_MAX - sizeof(vd)) / size) return NULL;
  size_t bytes = (count * size + sizeof(vd) - 1) / sizeof(vd) * sizeof(vd);
  void *p = aligned_alloc(sizeof(vd), bytes ? bytes : sizeof(vd));
  if (p) memset(p, 0, bytes);
  return p;
}

static void ascending(const int tet[4], int node[4]) {
  for (int a = 0; a < 4; a++) {
    int b = a;
    for (; b > 0 && node[b - 1] > tet[a]; b--) node[b] = node[b - 1];
    node[b] = tet[a];
  }
}

/* The edge between two corners, as the mesh numbers its middles. */
static const int edge_between[4][4] = {{0, 0, 2, 3}, {0, 0, 1, 4}, {2, 1, 0, 5}, {3, 4, 5, 0}};

void corot_tets_nodes(const corot_mesh *mesh, int tet, int node[KIND_NODES]) {
  const int *corner = mesh->tet[tet];
  ascending(corner, node);
  if (!mesh->mid) return;
  int at[4] = {0}; /* where the mesh has the corners */
  for (int a = 0; a < 4; a++)
    while (corner[at[a]] != node[a]) at[a]++;
  for (int k = 0; k < 6; k++)
    node[4 + k] = mesh->mid[tet][edge_between[at[corot_tet_edge[k][0]]][at[corot_tet_edge[k][1]]]];
}

/* Nodes of the lanes of a block by their roles. */
typedef struct lane_nodes {
  int node[KIND_NODES][W];
} lane_nodes;

/* The Jacobian of the map from the reference element at a point: J = sum_a (x_a - x_0) slope_a'. */
static mat3 jacobian_at(const corot_mesh *mesh, const element_kind *kind, const lane_nodes *n,
                        int q) {
  mat3 J;
  for (int l = 0; l < W; l++) {
    const double *x0 = mesh->x[n->node[0][l]];
    EACH_IJ {
      double sum = 0;
      for (int a = 1; a < kind->nnode; a++)
        sum += (mesh->x[n->node[a][l]][i] - x0[i]) * kind->slope[q][a - 1][j];
      J.m[i][j][l] = sum;
    }
  }
  return J;
}

/* The gradients J^-T slope_a of a point by roles. */
static void gradients_at(const element_kind *kind, int q, mat3 inverse, vd (*gradient)[3]) {
  for (int c = 0; c < 3; c++) {
    gradient[0][c] = vd_all(0);
    for (int a = 1; a < kind->nnode; a++) {
      vd sum = vd_all(0);
      for (int k = 0; k < 3; k++) sum += inverse.m[k][c] * kind->slope[q][a - 1][k];
      gradient[a][c] = sum;
      gradient[0][c] -= sum;
    }
  }
}

/* Rest gradients and weights: parts of |det J| / 6, the volume of a tet. */
static void fill_point(const corot_mesh *mesh, const lane_nodes *n, int b, int q, element_set *e) {
  const element_kind *kind = e->kind;
  int at = b * kind->npoint + q;
  mat3 J = jacobian_at(mesh, kind, n, q), C = mat3_cofactor(J);
  vd det = mat3_det(J, C), gradient[KIND_NODES][3];
  gradients_at(kind, q, mat3_scale(1.0 / det, mat3_transpose(C)), gradient);
  block_vd(*slope)[3] = e->slope + (size_t)at * (kind->nnode - 1);
  for (int l = 0; l < W; l++) {
    for (int a = 1; a < kind->nnode; a++)
      for (int c = 0; c < 3; c++) slope[a - 1][c][l] = gradient[role_at(e, b, a, l)][c][l];
    e->weight[at][l] = l < e->block[b].n ? kind->part[q] * fabs(det[l]) / 6 : 0;
  }
}

/* The roles of an element's nodes, which are sorted by their numbers; `node` is by roles. */
static void sort_roles(int nnode, const int *node, int role[KIND_NODES]) {
  for (int a = 0; a < nnode; a++) {
    int at = a;
    for (; at > 0 && node[role[at - 1]] > node[a]; at--) role[at] = role[at - 1];
    role[at] = a;
  }
}

static void fill_block(const corot_mesh *mesh, int b, element_set *e) {
  int nnode = e->kind->nnode;
  lane_nodes n;
  for (int l = 0; l < W; l++) {
    int node[KIND_NODES], role[KIND_NODES];
    corot_tets_nodes(mesh, e->number[b * W + l], node);
    sort_roles(nnode, node, role);
    for (int a = 0; a < nnode; a++) {
      n.node[a][l] = node[a];
      e->node[b * nnode + a][l] = node[role[a]];
      if (e->role) e->role[b * nnode + a][l] = (unsigned char)role[a];
    }
  }
  for (int q = 0; q < e->kind->npoint; q++) fill_point(mesh, &n, b, q, e);
}

static corot_status allocate(int with_rest_basis, element_set *e) {
  size_t nblock = e->nblock, npoint = nblock * e->kind->npoint;
  e->block = calloc(nblock, sizeof *e->block);
  e->node = malloc(nblock * e->kind->nnode * sizeof *e->node);
  bool roles = e->kind->order > 1;
  if (roles) e->role = malloc(nblock * e->kind->nnode * sizeof *e->role);
  e->slope = corot_vector_calloc(npoint * (e->kind->nnode - 1), sizeof *e->slope);
  e->weight = corot_vector_calloc(npoint, sizeof *e->weight);
  e->number = malloc(nblock * W * sizeof *e->number);
  if (with_rest_basis) e->rest_basis = corot_vector_calloc(nblock, sizeof *e->rest_basis);
  bool all = e->block && e->node && e->slope && e->weight && e->number;
  all = all && (e->role || !roles) && (e->rest_basis || !with_rest_basis);
  return all ? COROT_OK : COROT_ENOMEM;
}

mat3 corot_tets_rest_basis(const corot_mesh *mesh, const int *number) {
  mat3 D;
  for (int l = 0; l < W; l++) {
    const int *node = mesh->tet[number[l]];
    EACH_IJ D.m[i][j][l] = mesh->x[node[j + 1]][i] - mesh->x[node[0]][i];
  }
  return gram_schmidt(D);
}

corot_status corot_tets_create(const corot_mesh *mesh, int nmaterial, const int *material,
                               int together, int with_rest_basis, element_set *out) {
  return corot_tets_create_ordered(mesh, mesh, nmaterial, material, together, with_rest_basis, out);
}

corot_status corot_tets_create_ordered(const corot_mesh *mesh, const corot_mesh *order_of,
                                       int nmaterial, const int *material, int together,
                                       int with_rest_basis, element_set *out) {
  element_set e = {.kind = &element_kinds[mesh->mid ? TET10 : TET4]};
  if (mesh->ntet > INT_MAX / (e.kind->nnode * 3) - W * nmaterial) /* slots in the force buffer */
    return corot_fail(COROT_EINVAL, "%d tets exceed 32-bit counts", mesh->ntet);
  int ntet = mesh->ntet, *order = malloc(ntet * sizeof *order);
  if (!order) return corot_fail(COROT_ENOMEM, "no memory for %d tets", ntet);
  corot_status status = corot_element_order(order_of, nmaterial, material, together, order);
  if (status) {
    free(order);
    return status;
  }

  /* blocks: W tets in order, a new one where the material changes */
  for (int k = 0, lanes = W; k < ntet; k++, lanes++)
    if (lanes == W || material[order[k]] != material[order[k - 1]]) e.nblock++, lanes = 0;
  if (allocate(with_rest_basis, &e) != COROT_OK) goto no_memory;

  for (int b = 0, k = 0; b < e.nblock; b++) {
    int *number = e.number + (size_t)b * W, m = material[order[k]];
    element_block *block = &e.block[b];
    block->material = m;
    while (block->n < W && k < ntet && material[order[k]] == m) number[block->n++] = order[k++];
    for (int l = block->n; l < W; l++) number[l] = number[block->n - 1];
    fill_block(mesh, b, &e);
    if (with_rest_basis) e.rest_basis[b] = corot_tets_rest_basis(mesh, number);
  }
  free(order);
  *out = e;
  return COROT_OK;

no_memory:
  free(order);
  corot_tets_clear(&e);
  return corot_fail(COROT_ENOMEM, "no memory for %d tets", ntet);
}

void corot_tets_clear(element_set *e) {
  free(e->block);
  free(e->node);
  free(e->role);
  free(e->slope);
  free(e->weight);
  free(e->number);
  free(e->rest_basis);
  *e = (element_set){0};
}
