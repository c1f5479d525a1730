/* The libraries of linear algebra that this process has found. */
#ifndef COROT_SOLVE_LINSOL_LIBRARIES_H
#define COROT_SOLVE_LINSOL_LIBRARIES_H

#include <corot/base.h>

/* Versions as "MAJOR.MINOR.PATCH"; "" and 0: not known, or none. */
typedef struct corot_libraries {
  char suitesparse[32], klu[32], cholmod[32];
  char blas[4096];                      /* the file that its matrix product is in, links followed */
  char blas_config[256], blas_core[64]; /* what OpenBLAS says: how it was built, and the */
  int blas_threads;                     /* processor that it takes its kernels for */
} corot_libraries;

/* COROT_EIO: the system does not say where a file lies. */
corot_status corot_libraries_find(corot_libraries *libraries);

#endif
