/* Inside of a model. */
#ifndef COROT_CORE_MODEL_H
#define COROT_CORE_MODEL_H

#include <corot/model.h>

#include "core/pattern.h"
#include "core/strain.h"

typedef struct material {
  double lambda, mu, damping_lambda, damping_mu, density;
} material;

/* A load that keeps its direction: amplitude(t) times a constant force. */
typedef struct dead_load {
  double *force; /* [ndof] at amplitude one [N] */
  int n;         /* points of the amplitude; 0: one at all times */
  double *time, *value;
} dead_load;

struct corot_model {
  corot_mesh *mesh;
  int strain; /* index into strain_measures */
  int nmaterial;
  material *material;
  bool damped; /* some damping coefficient is not zero */

  int ndof;
  int (*dof)[3];        /* [nnode] or -1 */
  double *mass;         /* [ndof] [kg] */
  double *inverse_mass; /* [ndof] */
  double length, frequency, damping_time;

  int nload;
  dead_load *load;

  tets tets;
  pattern pattern;
};

double amplitude_at(const dead_load *load, double t);

#endif
