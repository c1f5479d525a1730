/* Inside of a model. */
#ifndef COROT_CORE_MODEL_MODEL_H
#define COROT_CORE_MODEL_MODEL_H

#include <corot/model.h>

#include "amplitude.h"
#include "core/base/sisters.h"
#include "core/element/face.h"
#include "core/system/system.h"
#include "instant.h"

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
  int nface;
  int (*face)[FACE_NODES]; /* [nface] nodes */
  double pressure;         /* at amplitude one [Pa] */
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

/* What of a consistent mass and of its damping couples one free degree of freedom to the nodes of a
   motion: times the two fields of which their velocities are made (motion.c), and summed. */
typedef struct motion_drag {
  int dof, component;
  double mass[2], damping[2];
} motion_drag;

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
  int ndrag;
  motion_drag *drag; /* [ndrag] ascending in dof */
} motion;

struct corot_model {
  corot_mesh *mesh;
  int nmaterial;
  material *material;
  double local_moduli; /* so many mu of lambda no average takes; infinity: there are none */
  bool mass_damped;    /* some mass damping is not zero */
  solid_system system; /* what deforms; its first term is the solid on the mesh */

  int ndof;
  int (*dof)[3];          /* [nnode] or -1 */
  int body_nnode;         /* energies and momenta are those of the first nodes: of all, or of */
  int body_ndof;          /* a level 0 that has its own; and of the first degrees of freedom */
  double *mass;           /* [ndof] lumped, whichever is in use [kg] */
  double *inverse_mass;   /* [ndof] */
  double *mass_damping;   /* [ndof] force per velocity [kg/s]; NULL unless mass_damped */
  double (*node_mass)[2]; /* [nnode] lumped mass and mass damping of all nodes, held ones too */
  double *mass_pair;      /* [pattern.nblock] a consistent mass between two nodes, the same in each
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
};

/* The solid on the mesh itself, whose pattern the matrices have. */
static inline const solid *solid_of(const corot_model *m) { return &m->system.term[0].body; }

/* m->material from the definition; of_tet [ntet] = the material that fills each tet. *damped: some
   viscous coefficient is not zero. */
corot_status corot_materials_create(const corot_model_def *def, corot_model *m, int *of_tet,
                                    bool *damped);

/* What of a material's lambda acts on each tet's own dilatation. */
void corot_material_share(const corot_model *m, material *a);

/* Nodal masses or loads of the finest level become, on the nodes of level 0, those of level 0 if it
   has its own: T' of corot/hierarchy.h. */
corot_status corot_model_restrict(const corot_model_def *def, int nnode, double (*nodal)[3]);

/* Displacement, velocity and acceleration of all nodes, `stride` doubles each: the free values, the
   motions' on their nodes, zero on held components. Where a velocity jumps, it has no acceleration.
   */
COROT_SISTERS void corot_model_displacement(const corot_model *m, const instant *now,
                                            const double *u, double *nodal, int stride);
COROT_SISTERS void corot_model_velocity(const corot_model *m, const instant *now, const double *v,
                                        double *nodal, int stride);
COROT_SISTERS void corot_model_acceleration(const corot_model *m, const instant *now,
                                            const double *a, double *nodal, int stride);

/* The motions' values alone, on their nodes. */
void corot_motions_displace(const corot_model *m, const instant *now, double *nodal, int stride);
void corot_motions_move(const corot_model *m, const instant *now, double *nodal, int stride);
void corot_motions_accelerate(const corot_model *m, const instant *now, double *nodal, int stride);

/* The free values alone: zero on every held component. */
COROT_SISTERS void corot_model_spread(const corot_model *m, const double *values, double *nodal,
                                      int stride);

/* The same for the nodes from `from` on, before `end`. */
void corot_model_spread_part(const corot_model *m, const double *values, int from, int end,
                             double *nodal, int stride);

/* The k-th derivative of the displacement of supports, 0 <= k <= 2, on their nodes alone. */
void corot_supports_place(const corot_model *m, const instant *now, int k, double *nodal,
                          int stride);

/* Mass and mass damping, once degrees of freedom, motions and pattern are known. */
corot_status corot_mass_create(const corot_model_def *def, corot_model *m);

/* nodal [nnode] += the lumped mass [kg] and the mass damping [kg/s] of every node, held ones
   included, and nothing. */
void corot_mass_lump(const corot_model *m, double (*nodal)[3]);

/* The first column of nodal [nnode] += the row sums of the mass in use, of every node: what a
   uniform acceleration takes [kg]. Of linear tets they are the lumped mass. The rest is scratch. */
corot_status corot_mass_sum_rows(const corot_model *m, double (*nodal)[3]);

/* y [nnode] += M x for the mass in use, of all nodes, held ones too; with `damping` += C x for that
   of the mass damping, if there is any. */
void corot_mass_nodal(const corot_model *m, bool damping, const double (*x)[4], double (*y)[3]);

/* f -= C v for the matrix C of the mass damping; nothing if there is none. */
void corot_mass_damp(const corot_model *m, const double *v, double *f);

/* D [pattern.nblock] += C. */
void corot_mass_damping_matrix(const corot_model *m, double (*D)[9]);

/* As corot_csc_combine, of the columns from `from` on, before `end`. */
COROT_SISTERS void corot_csc_combine_columns(const corot_model *m, const corot_csc *csc, double a,
                                             double b, const double (*D)[9], double c,
                                             const double (*K)[9], int from, int end,
                                             double *value);

/* m->load from the definition, once the degrees of freedom and the mass are known. */
corot_status corot_loads_create(const corot_model_def *def, corot_model *m);
void corot_loads_destroy(corot_model *m);

/* f [ndof] = the external force, on the body displaced by u [nnode], with the drag of motions. */
void corot_loads_force(const corot_model *m, const instant *now, const double (*u)[4], double *f);

/* f [nnode] += the loads on all nodes, held components too, of the body displaced by u. */
void corot_loads_nodal(const corot_model *m, const instant *now, const double (*u)[4],
                       double (*f)[3]);

/* Whether that depends on u. */
bool corot_loads_follow(const corot_model *m);

/* f += its change in the direction du. */
void corot_loads_derivative(const corot_model *m, const instant *now, const double (*u)[4],
                            const double (*du)[4], double *f);

/* K [pattern.nblock] -= the symmetric part of that change as a matrix. */
void corot_loads_stiffness(const corot_model *m, const instant *now, const double (*u)[4],
                           double (*K)[9]);

/* m->motion from the definition; marks the nodes' components in `held`. */
corot_status corot_motions_create(const corot_model_def *def, corot_model *m, char (*held)[3]);
void corot_motions_destroy(corot_model *m);

/* Whether the velocity of a motion jumps. */
bool corot_motion_jolts(const motion *a);

/* The drag of each motion, once the mass is known: nothing where this is lumped. */
corot_status corot_drags_create(corot_model *m);

/* f [ndof] -= M_fs a_s + C_fs v_s: what the accelerations and velocities of moving nodes s take
   from the free ones by way of a consistent mass and its damping. */
void corot_drags_apply(const corot_model *m, const instant *now, double *f);

/* The two fields at X, in component c, and their factors in velocity and acceleration. */
void corot_motion_fields(const motion *a, const double X[3], int c, double field[2]);
void corot_motion_factors(const motion *a, const instant *now, double velocity[3][2],
                          double acceleration[3][2]);

/* A rigid motion at a constant rate. */
typedef struct rigid_motion {
  double velocity[3], spin[3], center[3]; /* [m/s], [rad/s], [m] */
} rigid_motion;

/* Whether all that is held moves by one of these. Not where the side of kinks is open: then the
   supports may stop between two times. */
bool corot_motions_carry(const corot_model *m, const instant *now, rigid_motion *all);

#endif
