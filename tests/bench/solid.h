/* The solids that are measured: Kuhn boxes, bent and somewhat strained. */
#ifndef BENCH_SOLID_H
#define BENCH_SOLID_H

#include <corot/ode.h>
#include <stdbool.h>

typedef struct specimen {
  corot_model *model;
  corot_state *state;
  int ntet, n;             /* tets, degrees of freedom */
  double *y, *u, *v;       /* y = (u, v) [2n] */
  double *ydot;            /* [2n] */
  double *r, *du, *dv;     /* [n] */
  double (*K)[9], (*D)[9]; /* [corot_model_nblock()] */
} specimen;

/* A box 0.1 x 0.1 x 0.6 m of about so many tets of that order. */
corot_status solid_mesh(int ntet, int order, corot_mesh **mesh);

/* Fixed at its lowest face, which lies at z = 0; bent about the y axis by up to 0.3 rad, with
   strains of up to 5 %. Either without damping or with that of the second example of Hauth &
   Strasser (2004). The mesh may be destroyed. */
corot_status solid_create(corot_mesh *mesh, const char *strain, bool damped, specimen *out);
/* The same in two steps, and without K and D. */
corot_status solid_define(corot_mesh *mesh, const char *strain, bool damped, specimen *s);
corot_status solid_begin(specimen *s);

void solid_clear(specimen *s);

#endif
