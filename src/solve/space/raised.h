/* A model on the tets of another with a node on each edge, and states taken over from there. */
#ifndef COROT_SOLVE_SPACE_RAISED_H
#define COROT_SOLVE_SPACE_RAISED_H

#include <corot/space.h>

typedef struct raised {
  corot_mesh *mesh;
  corot_refinement *refinement; /* of one level, which are the nodes on the edges */
  corot_model *model;
  corot_state *state; /* frames exact */
  int n;              /* degrees of freedom */
} raised;

/* What is half made is released by clear. */
corot_status corot_raised_create(const corot_model_def *def, const corot_model *model, raised *r);
void corot_raised_clear(raised *r);

/* The state's evaluations are for that moment. */
void corot_space_enter(const corot_space_moment *at, corot_state *state);

/* The fields of a moment on the ten-node tets. */
typedef struct raised_fields {
  double (*x)[3];    /* [nnode] room, and in the end where the nodes are [m] */
  double *u, *v, *a; /* [n] */
} raised_fields;

/* Takes them over from the model that was raised; `fields` has the room. */
corot_status corot_raised_take(const corot_model *model, const corot_space_moment *at,
                               const raised *r, raised_fields *fields);

#endif
