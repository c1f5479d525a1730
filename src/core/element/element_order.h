/* The order of the elements in the kernels' loop: neighbours in the loop share nodes in the cache,
   and threads that take parts of it meet in few nodes. */
#ifndef COROT_CORE_ELEMENT_ELEMENT_ORDER_H
#define COROT_CORE_ELEMENT_ELEMENT_ORDER_H

#include <corot/mesh.h>

/* order [mesh->ntet]: by material, 0 <= material [ntet] < nmaterial, then by the lowest of their
   nodes; each `together` tets from the first on follow one another where they are of one material.
   Nodes go by their numbers in the mesh or, where these jump to and fro through the body, as in a
   refined one, by a search in breadth (Cuthill & McKee 1969). COROT_ENOMEM */
corot_status corot_element_order(const corot_mesh *mesh, int nmaterial, const int *material,
                                 int together, int *order);

#endif
