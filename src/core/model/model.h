/* Inside of a model. */
#ifndef COROT_CORE_MODEL_MODEL_H
#define COROT_CORE_MODEL_MODEL_H

#include <corot/model.h>

#include "amplitude.h"
#include "core/element/strain.h"
#include "core/solid/pattern.h"

typedef struct material {
  double lambda, mu, damping_lambda, damping_mu, damping_mass, density;
  double lambda_local; /* what of lambda acts on each tet's own dilatation */
  double own_share;    /* and as a part of it; 1 where lambda is zero */
} material;

/* What of a force acts on a component that is held. */
typedef struct held_force {
  int node, component;
  double force; /* [N] */
} held_force;

/* A constant force, or a pressure on faces of the deformed body, times amplitude(t). */
typedef struct load {
  double *force; /* [ndof] at amplitude one [N]; NULL: a pressure */
  int nheld;
  held_force *held; /* [nheld] the same of held components, where it is not zero */
  int ntri;
  int (*tri)[3];
  double pressure; /* at amplitude one [Pa] */
  amplitude amplitude;
} load;

/* A time of constant rate in a motion. */
typedef struct motion_span {
  double rate, velocity[3], from, to;
} motion_span;

/* A part of a motion that follows an amplitude. */
typedef struct motion_law {
  double angle, direction[3]; /* at amplitude one [rad], [m] */
  amplitude amplitude;
} motion_law;

/* Nodes on a prescribed path: turning about one axis, or translating, span after span, and by the
   sum of its laws. */
typedef struct motion {
  bool turns; /* about the axis; else it translates */
  char *group;
  int nnode;
  int *node;
  double center[3];
  double axis[3]; /* of length one */
  int nspan;
  motion_span *span; /* [nspan] */
  int nlaw;
  motion_law *law; /* [nlaw] */
} motion;

struct levels;

struct corot_model {
  corot_mesh *mesh;
  int strain; /* index into strain_measures */
  int nmaterial;
  material *material;
  bool damped;      /* some viscous coefficient is not zero */
  bool mass_damped; /* some mass damping is not zero */
  bool objective;   /* viscous law on the stretch's own rate */

  int ndof;
  int (*dof)[3];        /* [nnode] or -1 */
  int body_nnode;       /* energies and momenta are those of the first nodes: of all, or of */
  int body_ndof;        /* a level 0 that has its own; and of the first degrees of freedom */
  double *mass;         /* [ndof] lumped, whichever is in use [kg] */
  double *inverse_mass; /* [ndof] */
  double *mass_damping; /* [ndof] force per velocity [kg/s]; NULL unless mass_damped */
  double *mass_pair;    /* [pattern.nblock] a consistent mass between two nodes, the same in each
                           component [kg]; NULL: lumped */
  double *damping_pair; /* [pattern.nblock] of the mass damping the same [kg/s], NULL as well unless
                           mass_damped */
  double length, frequency, damping_time;

  int nload;
  load *load;
  int nmotion;
  motion *motion;
  int nkink;
  double *kink; /* [nkink] ascending: where a load or a motion changes its law [s] */

  tets tets;
  dilatation dilatation; /* averages, where some material has them */
  pattern pattern;

  struct levels *levels; /* NULL: one strain measure on one mesh; see levels.h */
};

/* Index into strain_measures by name. */
corot_status corot_model_find_strain(const char *name, int *strain);

/* COROT_EINVAL if the mesh has no such group; `user` says who asked. */
corot_status corot_model_find_group(const corot_mesh *mesh, const char *name, const char *user,
                                    const corot_group **group);

/* Displacement and velocity at t of all nodes, `stride` doubles each: the free values, the motions'
   on their nodes, zero on held components. At a kink of a motion, `phase` says which side is meant:
   the law in force just after that time; NaN: just after t. */
void corot_model_displacement(const corot_model *m, double phase, double t, const double *u,
                              double *nodal, int stride);
void corot_model_velocity(const corot_model *m, double phase, double t, const double *v,
                          double *nodal, int stride);

/* The free values alone: zero on every held component. */
void corot_model_spread(const corot_model *m, const double *values, double *nodal, int stride);

/* Mass and mass damping, once degrees of freedom, motions and pattern are known. */
corot_status corot_mass_create(const corot_model_def *def, corot_model *m);

/* nodal [nnode] += the lumped mass [kg] and the mass damping [kg/s] of every node, held ones
   included, and nothing. */
void corot_mass_lump(const corot_model *m, double (*nodal)[3]);

/* f -= C v for the matrix C of the mass damping; nothing if there is none. */
void corot_mass_damp(const corot_model *m, const double *v, double *f);

/* D [pattern.nblock] += C. */
void corot_mass_damping_matrix(const corot_model *m, double (*D)[9]);

/* m->load from the definition, once the degrees of freedom and the mass are known. */
corot_status corot_loads_create(const corot_model_def *def, corot_model *m);
void corot_loads_destroy(corot_model *m);

/* When the loads are looked at: at t, by the law in force just after `phase` (NaN: just after t),
   times `scale`. */
typedef struct load_clock {
  double phase, t, scale;
} load_clock;

/* f [ndof] = the external force, on the body displaced by u [nnode]. */
void corot_loads_force(const corot_model *m, const load_clock *now, const double (*u)[4],
                       double *f);

/* Whether that depends on u. */
bool corot_loads_follow(const corot_model *m);

/* f += its change in the direction du. */
void corot_loads_derivative(const corot_model *m, const load_clock *now, const double (*u)[4],
                            const double (*du)[4], double *f);

/* m->motion from the definition; marks the nodes' components in `held`. */
corot_status corot_motions_create(const corot_model_def *def, corot_model *m, char (*held)[3]);
void corot_motions_destroy(corot_model *m);

/* A rigid motion at a constant rate. */
typedef struct rigid_motion {
  double velocity[3], spin[3], center[3]; /* [m/s], [rad/s], [m] */
} rigid_motion;

/* Whether all that is held moves by one of these, just after `phase`. Not where that is NaN: then
   the supports may stop between two times. */
bool corot_motions_carry(const corot_model *m, double phase, double t, rigid_motion *all);

#endif
