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

/* COROT_EINVAL if the mesh has no such group; `user` says who asked. */
corot_status model_find_group(const corot_mesh *mesh, const char *name, const char *user,
                              const corot_group **group);

/* Free degrees of freedom to all nodes, `stride` doubles each; held components are zero. */
void model_spread(const corot_model *m, const double *values, double *nodal, int stride);

/* m->load from the definition, once the degrees of freedom and the mass are known. */
corot_status loads_create(const corot_model_def *def, corot_model *m);
void loads_destroy(corot_model *m);

/* f [ndof] = external force at time t. */
void loads_force(const corot_model *m, double t, double *f);

#endif
