/* The hierarchical basis of a refined mesh (Yserentant, Numer. Math. 49, 1986): a field is given by
   its values at the nodes of level 0, and at every finer node by its difference to the mean of the
   node's two parents,

     u_i = y_i on level 0,   u_i = (u_p + u_q) / 2 + y_i for the middle i of the edge p q,

   in short u = T y. Differences of affine fields are zero.

   Values are vectors at all nodes of the finest level, [nnode[nlevel]][3], in the order of the
   refinement: that of the mesh unless it has a list of nodes. All four functions work
   in place, in one sweep over the nodes. They need no memory, and cannot fail.

   A complete program: tests/examples/hierarchy.c. */
#ifndef COROT_HIERARCHY_H
#define COROT_HIERARCHY_H

#include <corot/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/* v = T v: from hierarchical to nodal values. With all differences zero, v becomes the linear
   interpolation of the values on level 0. */
COROT_API void corot_hierarchy_apply(const corot_refinement *refinement, double (*v)[3]);

/* v = T^-1 v: from nodal to hierarchical values. */
COROT_API void corot_hierarchy_solve(const corot_refinement *refinement, double (*v)[3]);

/* v = T' v: forces on nodal values become forces on hierarchical ones; on level 0 these are what
   the coarse mesh feels. */
COROT_API void corot_hierarchy_apply_transposed(const corot_refinement *refinement, double (*v)[3]);

/* v = T'^-1 v. */
COROT_API void corot_hierarchy_solve_transposed(const corot_refinement *refinement, double (*v)[3]);

#ifdef __cplusplus
}
#endif
#endif
