/* The nodes of faces of ten-node tets. */
#include "mesh_refine.h"

static corot_status find(const corot_edges *edges, int ntri, const int (*tri)[3], int (**node)[6]) {
  int(*all)[6];
  COROT_TRY(COROT_ALLOC(all, ntri));
  for (int t = 0; t < ntri; t++)
    for (int k = 0; k < 3; k++) {
      all[t][k] = tri[t][k];
      all[t][3 + k] =
          corot_edge_middle(edges, corot_edges_find(edges, tri[t][k], tri[t][(k + 1) % 3]));
    }
  *node = all;
  return COROT_OK;
}

corot_status corot_mesh_face_nodes(const corot_mesh *mesh, int ntri, const int (*tri)[3],
                                   int (**node)[6]) {
  corot_edges edges = {0};
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(node));
  if (!mesh->mid) return corot_fail(COROT_EINVAL, "a mesh of order 1 has no nodes on its edges");
  corot_status status = corot_edges_list(mesh, &edges);
  if (!status) status = find(&edges, ntri, tri, node);
  corot_edges_clear(&edges);
  return status;
}
