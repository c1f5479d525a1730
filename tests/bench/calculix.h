/* The bar by CalculiX, where its program ccx is installed (Debian: calculix-ccx). */
#ifndef BENCH_CALCULIX_H
#define BENCH_CALCULIX_H

#include <corot/base.h>
#include <stdbool.h>

/* A body of one kind of element, held at some nodes and pulled at others. */
typedef struct calculix_body {
  const char *type; /* as CalculiX calls the elements */
  int nnode;
  double (*x)[3];     /* [nnode] at rest [m] */
  double (*force)[3]; /* [nnode] under the full load [N] */
  bool *held;         /* [nnode] in all directions */
  int nelement, size; /* nodes of an element, in its order */
  int *node;          /* [nelement * size] */
  int probe;          /* whose ux is printed */
} calculix_body;

/* Whether there is a ccx that can be run. */
bool calculix_found(void);

/* 40 s of a body of the bar's material, without damping, under a load that rises over 10 s:
   *DYNAMIC with steps of at most `step` [s]; large displacements, Green's strain. At most `most`
   pairs of time [s] and ux of the probe [m]; CPU time of the whole process, on one thread [s].
   COROT_EINTEGRATE: it has not come to its end. COROT_EIO, COROT_ENOMEM. */
corot_status calculix_run(const calculix_body *body, double step, int most, double (*out)[2],
                          int *count, double *cpu);

#endif
