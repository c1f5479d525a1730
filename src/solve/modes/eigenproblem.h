/* The eigenproblem K x = lambda M x: its matrices, the factor of K - shift M, and what was found.
 */
#ifndef COROT_SOLVE_MODES_EIGENPROBLEM_H
#define COROT_SOLVE_MODES_EIGENPROBLEM_H

#include <corot/modes.h>

#include "solve/linsol/linsol.h"

typedef struct eigen {
  const corot_modes_def *def;
  const corot_model *model;
  int n;
  double (*K)[9];  /* [nblock] */
  double stiffest; /* largest K_ii [N/m] */
  double zero;     /* an eigenvalue below this in size is rounding */
  linsol solver;
  double shift;

  /* M-orthonormal vectors, and M times each: what searches leave out. */
  int nfound, capacity;
  double *x, *Mx;     /* [capacity][n] */
  double *eigenvalue; /* [capacity] */
  double *work;       /* [2 n] */
  corot_modes_facts facts;
} eigen;

static inline double dot(int n, const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* K from its blocks, which the caller fills, and room for so many vectors. What is half made is
   released by clear. */
corot_status corot_eigen_create(const corot_modes_def *def, const corot_model *model, int capacity,
                                eigen *e);
void corot_eigen_clear(eigen *e);

/* Factors K - shift M for a shift below all eigenvalues, after K was filled. */
corot_status corot_eigen_factor(eigen *e);

/* x [n] = (K - shift M)^-1 x. */
corot_status corot_eigen_solve(eigen *e, double *x);

/* x [n] less its part along what was found. */
void corot_eigen_project(const eigen *e, double *x);

/* Adds x to what was found, made M-orthonormal, with its Rayleigh quotient. False: nothing of it is
   left beside what was found before. */
bool corot_eigen_add(eigen *e, const double *x);

/* The same of a motion that is known to have the eigenvalue 0. */
bool corot_eigen_add_rigid(eigen *e, const double *x);

void corot_eigen_swap(eigen *e, int i, int j);

/* Adds the `count` eigenvectors of least eigenvalue beside what was found: by ARPACK. */
corot_status corot_arpack_search(eigen *e, int count);

#endif
