/* The nodes of faces of ten-node tets. */
#include "mesh_refine.h"

/* The node on each edge [edges->n]. */
static corot_status list_middles(const corot_mesh *mesh, const corot_edges *edges, int **middle) {
  COROT_TRY(COROT_ALLOC(*middle, edges->n));
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 6; k++) (*middle)[edges->tet[e][corot_edge_of_mid[k]]] = mesh->mid[e][k];
  return COROT_OK;
}

static corot_status find(const corot_mesh *mesh, const corot_edges *edges, int ntri,
                         const int (*tri)[3], int (**node)[6]) {
  int(*all)[6], *middle = NULL;
  COROT_TRY(COROT_ALLOC(all, ntri));
  corot_status status = list_middles(mesh, edges, &middle);
  for (int t = 0; !status && t < ntri; t++)
    for (int k = 0; k < 3; k++) {
      all[t][k] = tri[t][k];
      all[t][3 + k] = middle[corot_edges_find(edges, tri[t][k], tri[t][(k + 1) % 3])];
    }
  free(middle);
  if (status)
    free(all);
  else
    *node = all;
  return status;
}

corot_status corot_mesh_face_nodes(const corot_mesh *mesh, int ntri, const int (*tri)[3],
                                   int (**node)[6]) {
  corot_edges edges = {0};
  if (!mesh->mid) return corot_fail(COROT_EINVAL, "a mesh of order 1 has no nodes on its edges");
  corot_status status = corot_edges_list(mesh, &edges);
  if (!status) status = find(mesh, &edges, ntri, tri, node);
  corot_edges_clear(&edges);
  return status;
}
