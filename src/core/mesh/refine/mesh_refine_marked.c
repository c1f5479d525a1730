/* Local refinement: the mesh of the tets that bisection leaves. */
#include <limits.h>
#include <string.h>

#include "bisection.h"

static corot_status check_marks(const corot_mesh *mesh, int nmark, const int *mark) {
  for (int i = 0; i < nmark; i++)
    if (mark[i] < 0 || mark[i] >= mesh->ntet)
      return corot_fail(COROT_EINVAL, "marked tet %d does not exist, the last is %d", mark[i],
                        mesh->ntet - 1);
  return COROT_OK;
}

static corot_status check_counts(const corot_mesh *mesh, int nnode, int ntet) {
  COROT_TRY(corot_mesh_check_counts(nnode, ntet));
  if (!mesh->mid || ntet <= INT_MAX / 10) return COROT_OK;
  return corot_fail(COROT_EINVAL, "%d ten-node tets are too many: at most %d", ntet, INT_MAX / 10);
}

/* Appends the uncut parts of tet t, those on the side of the lower end of its edge first. */
static void put_parts(const bisection *b, int t, int *parent, corot_mesh *fine) {
  const cut_tet *tet = &b->tet[t];
  if (tet->child >= 0) {
    put_parts(b, tet->child, parent, fine);
    put_parts(b, tet->child + 1, parent, fine);
    return;
  }
  parent[fine->ntet] = tet->root;
  memcpy(fine->tet[fine->ntet], tet->v, sizeof tet->v);
  for (int k = 0; fine->mid && k < 6; k++)
    fine->mid[fine->ntet][k] = b->edge[tet->edge[corot_edge_of_mid[k]]].middle;
  fine->ntet++;
}

/* Fills the zeroed mesh without groups, and *parent, which is the caller's to free. */
static corot_status put_tets(const bisection *b, int **parent, corot_mesh *fine) {
  int n = 0;
  for (int t = 0; t < b->ntet; t++) n += b->tet[t].child < 0;
  COROT_TRY(check_counts(b->mesh, b->nnode, n));
  COROT_TRY(COROT_ALLOC(*parent, n));
  COROT_TRY(COROT_ALLOC(fine->x, b->nnode));
  COROT_TRY(COROT_ALLOC(fine->tet, n));
  if (b->mesh->mid) COROT_TRY(COROT_ALLOC(fine->mid, n));
  fine->nnode = b->nnode;
  memcpy(fine->x, b->x, (size_t)b->nnode * sizeof *b->x);
  for (int t = 0; t < b->mesh->ntet; t++) put_parts(b, t, *parent, fine);
  return corot_mesh_check_volumes(fine);
}

static corot_status refine(const corot_edges *edges, bisection *b, int **parent, corot_mesh *fine) {
  COROT_TRY(corot_bisection_run(b));
  COROT_TRY(put_tets(b, parent, fine));
  return corot_bisection_groups(b, edges, *parent, fine);
}

corot_status corot_mesh_refine_marked(const corot_mesh *mesh, int nmark, const int *mark,
                                      corot_mesh **fine, int **parent) {
  corot_edges edges = {0};
  bisection b = {0};
  int *from = NULL;
  corot_mesh *m;
  COROT_TRY(COROT_GIVEN(mesh));
  if (nmark > 0) COROT_TRY(COROT_GIVEN(mark));
  COROT_TRY(COROT_GIVEN(fine));
  COROT_TRY(check_marks(mesh, nmark, mark));
  COROT_TRY(COROT_ALLOC(m, 1));
  corot_status status = corot_edges_list(mesh, &edges);
  if (!status) status = corot_bisection_begin(mesh, &edges, nmark, mark, &b);
  if (!status) status = refine(&edges, &b, &from, m);
  corot_bisection_clear(&b);
  corot_edges_clear(&edges);
  if (status || !parent) free(from);
  if (status) {
    corot_mesh_destroy(m);
    return status;
  }
  *fine = m;
  if (parent) *parent = from;
  return COROT_OK;
}
