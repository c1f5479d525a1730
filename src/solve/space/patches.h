/* Fields recovered from their values at the points of integration (superconvergent patch recovery:
   O. C. Zienkiewicz, J. Z. Zhu, Int. J. Numer. Meth. Engng 33, 1992): around each corner of the
   mesh a polynomial of the elements' own degree, fitted to the points of the tets there, and in a
   tet those of its corners, blended by its volume coordinates (T. Blacker, T. Belytschko, Int. J.
   Numer. Meth. Engng 37, 1994). It is continuous, and has polynomials of that degree exactly.
   Materials do not mix: each has its own. */
#ifndef COROT_SOLVE_SPACE_PATCHES_H
#define COROT_SOLVE_SPACE_PATCHES_H

#include <corot/mesh.h>

/* Terms of a quadratic polynomial; columns of two fields of symmetric tensors. */
enum { PATCH_TERMS = 10, PATCH_COLUMNS = 12 };

/* The points of integration of a tet. */
static inline int points_in_tet(const corot_mesh *mesh) { return mesh->mid ? 4 : 1; }

typedef struct patches {
  const corot_mesh *mesh;
  const int *of_tet; /* [ntet] material */
  int nfield;
  const double (*field[2])[6]; /* [ntet times points] */
  double (*point)[3];          /* [ntet times points] where they are at rest [m] */
  int *first, *around;         /* [nnode + 1]; [4 ntet] the tets at each corner, ascending */
  int *list, *stamp, nstamp;   /* [ntet] tets of a patch; [ntet] by whom they were taken */
  int *corner;                 /* [nnode] the number of each corner; -1: on an edge */
  double *scale;               /* [ncorner] of coordinates in a patch [m] */
  int nterm, ncolumn;          /* of the elements' degree, of all fields */
  double *fitted;              /* [ncorner][nterm][ncolumn] of one material */
} patches;

/* After mesh, materials and fields are set; what is half made is released by clear. COROT_ENOMEM.
 */
corot_status corot_patches_create(patches *p);
void corot_patches_clear(patches *p);

/* Fits the polynomials of a material at all its corners. */
void corot_patches_fit(patches *p, int material);

/* Of the material that was fitted last, at volume coordinates in one of its tets: value
   [PATCH_COLUMNS], six for each field. */
void corot_patches_value(const patches *p, int tet, const double at[4], double *value);

/* Volume coordinates of the points of integration of a tet, q = 0, 1, ... */
void corot_patch_point(const corot_mesh *mesh, int q, double at[4]);

/* The place at rest of volume coordinates in a tet [m]. */
void corot_tet_place(const corot_mesh *mesh, int tet, const double at[4], double x[3]);

#endif
