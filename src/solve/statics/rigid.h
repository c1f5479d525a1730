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

/* The same motions as fields on the degrees of freedom. A part has at most six, and no node of
   another: motion k of every part is in field k. */
typedef struct corot_rigid {
  int npart;
  int *nfree;    /* [npart] motions of a part; its further fields are zero there */
  int *part;     /* [nnode] the part of each node */
  double *field; /* [6][ndof] */
} corot_rigid;

/* Of the body where its nodes are now, x [nnode]. What is half made is released by clear. */
corot_status corot_rigid_create(const corot_model *model, const double (*x)[3], corot_rigid *rigid);
void corot_rigid_clear(corot_rigid *rigid);

/* Diagonalises the symmetric G [6][6] by Jacobi's rotations; the columns of V are its eigenvectors.
 */
void corot_diagonalise(double G[6][6], double V[6][6]);

#endif
