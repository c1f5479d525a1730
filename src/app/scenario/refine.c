/* Counts what the refined mesh would take before it is made. */
#include "refine.h"

#include <math.h>
#include <unistd.h>

#define BYTES_PER_TET 50 /* of the refined mesh, while it is made */

corot_status refine_fits(int ntet, int nlevel, double memory) {
  double most = memory / BYTES_PER_TET, fine = ntet * pow(8, nlevel);
  int times = most > ntet ? (int)(log2(most / ntet) / 3) : 0;
  if (fine <= most) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "refining %d tets %d times makes %.3g, which need %.3g GB of memory, and there "
                    "are %.3g: at most %d",
                    ntet, nlevel, fine, fine * BYTES_PER_TET / 1e9, memory / 1e9, times);
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
  COROT_TRY(refine_fits((*mesh)->ntet, nlevel, physical_memory()));
  COROT_TRY(corot_mesh_refine(*mesh, nlevel, diagonal, &fine, refinement));
  corot_mesh_destroy(*mesh);
  *mesh = fine;
  return COROT_OK;
}
