/* Counts what the refined mesh would take before it is made. */
#include "refine.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/text/no_memory.h"
#include "core/base/memory_limit.h"

/* Of a mesh of either order, while it is made. */
static const double bytes_per_tet[] = {0, 50, 250};

static corot_status fits(int ntet, int order, int nlevel, double memory) {
  double bytes = bytes_per_tet[order], most = memory / bytes, fine = ntet * pow(8, nlevel);
  int times = most > ntet ? (int)(log2(most / ntet) / 3) : 0;
  if (fine <= most) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "refining %d tets %d times makes %.3g, which need %.3g GB of memory, and there "
                    "are %.3g: at most %d",
                    ntet, nlevel, fine, fine * bytes / 1e9, memory / 1e9, times);
}

corot_status refine_fits(int ntet, int nlevel, double memory) {
  return fits(ntet, 1, nlevel, memory);
}

/* Of a mesh of either order, its model and the state of its evaluations (corot-bench phases). */
static const double bytes_of_run[] = {0, 500, 3400};

corot_status run_fits(int ntet, int order, int nlevel, const corot_memory_limit *memory) {
  double fine = ntet * pow(8, nlevel), bytes = fine * bytes_of_run[order];
  if (bytes <= memory->process) return COROT_OK;
  char refined[80] = "";
  if (nlevel > 0)
    snprintf(refined, sizeof refined, "refining %d tets %d times makes %.3g, ", ntet, nlevel, fine);
  return corot_fail(COROT_EINVAL,
                    "%s%.3g tets of order %d need at least %.3g GB of memory in a run, and %s has "
                    "%.3g",
                    refined, fine, order, bytes / 1e9, memory->what, memory->process / 1e9);
}

corot_status refine_mesh(int nlevel, corot_diagonal diagonal, corot_mesh **mesh,
                         corot_refinement **refinement) {
  corot_mesh *fine;
  COROT_TRY(fits((*mesh)->ntet, corot_mesh_order(*mesh), nlevel, corot_memory_limits().process));
  COROT_TRY(corot_mesh_refine(*mesh, nlevel, diagonal, &fine, refinement));
  corot_mesh_destroy(*mesh);
  *mesh = fine;
  return COROT_OK;
}

corot_status refine_by_levels(int nlevel, corot_diagonal diagonal, corot_mesh **mesh,
                              corot_refinement **refinement) {
  corot_mesh *coarse = NULL;
  if ((*mesh)->mid) COROT_TRY(corot_mesh_copy(*mesh, &coarse));
  corot_status status = refine_mesh(nlevel, diagonal, mesh, refinement);
  if (status == COROT_OK && coarse) status = corot_refinement_lower(*refinement, coarse);
  corot_mesh_destroy(coarse);
  return status;
}

/* mark [ntet] = the tets that share a corner with tet e, itself included. */
static int mark_around(const corot_mesh *mesh, int e, int *mark) {
  const int *v = mesh->tet[e];
  int n = 0;
  for (int i = 0; i < mesh->ntet; i++) {
    bool touches = false;
    for (int k = 0; k < 16; k++) touches |= mesh->tet[i][k / 4] == v[k % 4];
    if (touches) mark[n++] = i;
  }
  return n;
}

static corot_status refine_once_near(const double point[3], corot_mesh **mesh) {
  corot_location at;
  corot_mesh *fine = NULL;
  COROT_TRY(corot_mesh_locate(*mesh, point, &at));
  int *mark = malloc((size_t)(*mesh)->ntet * sizeof *mark);
  if (!mark) return no_memory();
  int n = mark_around(*mesh, at.tet, mark);
  corot_status status = corot_mesh_refine_marked(*mesh, n, mark, &fine, NULL);
  free(mark);
  COROT_TRY(status);
  corot_mesh_destroy(*mesh);
  *mesh = fine;
  return COROT_OK;
}

corot_status refine_near(const double point[3], int times, corot_mesh **mesh) {
  for (int i = 0; i < times; i++) COROT_TRY(refine_once_near(point, mesh));
  return COROT_OK;
}

static corot_status check_room(const corot_mesh *mesh, int order, double memory) {
  double bytes = mesh->ntet * bytes_per_tet[2];
  if (order != 2 || mesh->mid || bytes <= memory) return COROT_OK;
  return corot_fail(COROT_EINVAL, "order 2 needs %.3g GB of memory for %d tets, and there are %.3g",
                    bytes / 1e9, mesh->ntet, memory / 1e9);
}

corot_status change_order(int order, corot_mesh **mesh, corot_refinement *refinement) {
  corot_mesh *changed;
  if (order == corot_mesh_order(*mesh)) return COROT_OK;
  COROT_TRY(check_room(*mesh, order, corot_memory_limits().process));
  COROT_TRY(corot_mesh_change_order(*mesh, order, &changed));
  corot_mesh_destroy(*mesh);
  *mesh = changed;
  return refinement ? corot_refinement_raise(refinement, changed) : COROT_OK;
}
