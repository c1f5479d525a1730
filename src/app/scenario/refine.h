/* Refinement and order as the tool does it: in place, and not beyond the memory of the machine. */
#ifndef COROT_APP_SCENARIO_REFINE_H
#define COROT_APP_SCENARIO_REFINE_H

#include <corot/mesh.h>

#include "core/base/memory_limit.h"

/* Replaces the mesh by what it becomes when it is refined `nlevel` times; `refinement` (or NULL)
   says how, the caller's to destroy. COROT_EINVAL: as corot_mesh_refine, or below. */
corot_status refine_mesh(int nlevel, corot_diagonal diagonal, corot_mesh **mesh,
                         corot_refinement **refinement);

/* The same, where the corners of ten-node tets are a level below. */
corot_status refine_by_levels(int nlevel, corot_diagonal diagonal, corot_mesh **mesh,
                              corot_refinement **refinement);

/* Replaces the mesh by what it becomes when the tet at a point, or nearest to it, and all that
   share a corner with it are cut, and those that are there then, so many times. COROT_EINVAL: as
   corot_mesh_refine_marked. */
corot_status refine_near(const double point[3], int times, corot_mesh **mesh);

/* Replaces the mesh by its copy of order 1 or 2. `refinement` (or NULL) of the mesh gets the level
   that is new at order 2. COROT_EINVAL: as corot_mesh_change_order, or too little memory. */
corot_status change_order(int order, corot_mesh **mesh, corot_refinement *refinement);

/* Whether a run has room for what `ntet` tets become when they are refined so often, on a mesh of
   that order in the end, as far as that can be told from their number: mesh, model and state, but
   no matrix. COROT_EINVAL, with the numbers. */
corot_status run_fits(int ntet, int order, int nlevel, const corot_memory_limit *memory);

/* Whether `ntet` tets of order 1 can be refined so often with so much memory [byte]. */
corot_status refine_fits(int ntet, int nlevel, double memory);

#endif
