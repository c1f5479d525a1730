/* The equation of motion as Model Exchange has it: derivatives of the states u and v, and how they
   change with states and inputs. */
#ifndef COROT_FMI_BODY_SLOPES_H
#define COROT_FMI_BODY_SLOPES_H

#include <corot/solve.h>

#include "moment.h"

typedef struct slopes {
  const body *body;
  corot_state *state;   /* exact frames */
  corot_inputs *inputs; /* or NULL */
  corot_mass_solver *mass;
  double *u, *v; /* [ndof] scratch, */
  double *value; /* [ncolumn] of outputs */
} slopes;

/* A direction in which states and inputs change. */
typedef struct direction {
  double *u, *v; /* [ndof] */
  double *load;  /* [ninput] of factors of loads; zero for materials */
} direction;

/* State and inputs must outlive them. COROT_ENOMEM. */
corot_status slopes_create(const body *b, corot_state *state, corot_inputs *inputs, slopes *s);
void slopes_clear(slopes *s);

/* a [ndof] = M^-1 r, the derivative of v; that of u is v. COROT_RETRY: a tet is inverted. */
corot_status slopes_find(slopes *s, const moment *now, double *a);

/* da [ndof] = its change in the direction d: by states that of corot_jvp, by loads, in which r is
   linear, a difference. COROT_RETRY as above. */
corot_status slopes_change(slopes *s, const moment *now, const direction *d, double *da);

/* change [ncolumn] of the outputs in the direction d, by central differences. COROT_RETRY as above.
 */
corot_status slopes_of_outputs(slopes *s, sight *outputs, const moment *now, const direction *d,
                               double *change);

#endif
