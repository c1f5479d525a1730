/* Counts what the refined mesh would take before it is made. */
#include "refine.h"

#include <math.h>
#include <unistd.h>

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

/* Infinite where the system does not say. */
static double physical_memory(void) {
#ifdef _SC_PHYS_PAGES
  long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
  if (pages > 0 && size > 0) return (double)pages * (double)size;
#endif
  return INFINITY;
}

corot_status refine_mesh(int nlevel, corot_diagonal diagonal, corot_mesh **mesh,
                         corot_refinement **refinement) {
  corot_mesh *fine;
  COROT_TRY(fits((*mesh)->ntet, corot_mesh_order(*mesh), nlevel, physical_memory()));
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

static corot_status check_room(const corot_mesh *mesh, int order, double memory) {
  double bytes = mesh->ntet * bytes_per_tet[2];
  if (order != 2 || mesh->mid || bytes <= memory) return COROT_OK;
  return corot_fail(COROT_EINVAL, "order 2 needs %.3g GB of memory for %d tets, and there are %.3g",
                    bytes / 1e9, mesh->ntet, memory / 1e9);
}

corot_status change_order(int order, corot_mesh **mesh, corot_refinement *refinement) {
  corot_mesh *changed;
  if (order == corot_mesh_order(*mesh)) return COROT_OK;
  COROT_TRY(check_room(*mesh, order, physical_memory()));
  COROT_TRY(corot_mesh_change_order(*mesh, order, &changed));
  corot_mesh_destroy(*mesh);
  *mesh = changed;
  return refinement ? corot_refinement_raise(refinement, changed) : COROT_OK;
}
