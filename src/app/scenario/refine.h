/* Refinement as the tool does it: in place, and not beyond the memory of the machine. */
#ifndef COROT_APP_SCENARIO_REFINE_H
#define COROT_APP_SCENARIO_REFINE_H

#include <corot/mesh.h>

/* Replaces the mesh by what it becomes when it is refined `nlevel` times; `refinement` (or NULL)
   says how, the caller's to destroy. COROT_EINVAL: as corot_mesh_refine, or below. */
corot_status refine_mesh(int nlevel, corot_diagonal diagonal, corot_mesh **mesh,
                         corot_refinement **refinement);

/* Whether `ntet` tets can be refined so often with so much memory [byte]. */
corot_status refine_fits(int ntet, int nlevel, double memory);

#endif
