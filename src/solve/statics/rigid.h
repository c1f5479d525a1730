/* The parts of a body that share no node, and their rigid motions that nothing holds. */
#ifndef COROT_SOLVE_STATICS_RIGID_H
#define COROT_SOLVE_STATICS_RIGID_H

#include <corot/model.h>

typedef struct corot_part {
  int first;    /* the part's lowest node */
  int nnode;    /* how many it has */
  int nfree;    /* independent rigid motions that no support hinders: 0 to 6 */
  char can[96]; /* which, in words: "move along x and y and turn about z"; "" without one */
} corot_part;

/* The parts in the order of their first nodes; their motions are left out: nfree is 0. *part
   [*npart] is the caller's to free. */
corot_status corot_mesh_parts(const corot_mesh *mesh, int *npart, corot_part **part);

/* The same with the motions that the model's supports leave free, however small. A support that
   moves holds its nodes as well as one at rest. */
corot_status corot_model_parts(const corot_model *model, int *npart, corot_part **part);

/* The same motions as displacements of the free degrees of freedom, part by part: *count of them,
   at most six a part, *motion [*count][n], the caller's to free. NULL without one. */
corot_status corot_rigid_motions(const corot_model *model, int *count, double **motion);

/* COROT_ESINGULAR if a part has such a motion; the message names the first. */
corot_status corot_rigid_check(const corot_model *model);

#endif
