/* The solid as an ordinary differential equation on its n free degrees of freedom:

     du/dt = v,   M dv/dt = r(t, u, v; R),   r = f_ext(t) - f_int(u; R) - f_damp(u, v; R)

   A consistent mass couples free nodes to those of moving supports, whose acceleration a_s and, with
   mass damping, velocity v_s are then felt: - M_fs a_s - C_fs v_s is a part of f_ext.

   u displacement [m], v velocity [m/s], M mass, lumped or consistent, R one rotation ("frame") a
   tet.
   Arrays u, v, r are [n], ordered by corot_model_dof(), and owned by the caller. COROT_EINVAL of
   corot_residual, corot_rhs, corot_jacobian, corot_jvp, corot_energy, corot_elastic_force and
   corot_frames_update: model or state is NULL, or the state is another model's.

   Strain measures (Hauth & Strasser 2004; F gradient of the deformation, F = R S its polar
   decomposition). Each is a choice of basis B = R or F for the pressure (lambda) term and for the
   shear (mu) term, with e = sym(R'F) - I for B = R and e = (F'F - I)/2 for B = F, and the first
   Piola-Kirchhoff stress P = lambda tr(e_p) B_p + 2 mu B_s e_s:

     name     B_p  B_s  R
     cauchy   R    R    identity: linear elasticity, right for small rotations only
     warp     R    R    Gram-Schmidt on the element's edges (Mueller et al. 2002)
     polar    R    R    polar factor of F
     hybrid   F    R    polar factor of F
     green    F    F    (none): the geometrically exact St. Venant-Kirchhoff solid

   With COROT_DILATATION_NODAL, tr(e_p) in P is mostly that of averages around the nodes: see
   corot_model_def.

   The viscous stress is the same law with the damping coefficients on sym(B' dF/dt).

   A model with a hierarchy (corot/model.h) has two measures: the first in its name on level 0, the
   other on the finest level, in frames handed down.

   Frames are EXACT, found anew from F in every evaluation, so that r is a smooth function of
   (t, u, v); or HELD, those of the last corot_frames_update (the paper's linear systems); or
   EXTRAPOLATED, those turned on at the spin they had then, which r sees as a dependence on t.

   A complete program: tests/examples/ode.c. */
#ifndef COROT_ODE_H
#define COROT_ODE_H

#include <corot/model.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum corot_frames {
  COROT_FRAMES_EXACT,
  COROT_FRAMES_HELD,
  COROT_FRAMES_EXTRAPOLATED,
} corot_frames;

/* What the evaluations of one run need beside the model: frames and scratch. One state belongs
   to one thread at a time; any number of states share a model. */
typedef struct corot_state corot_state;

/* Frames exact; the held frames are those of u = 0. The model must outlive the state. COROT_ENOMEM;
   COROT_EINVAL: there is no model. */
COROT_API corot_status corot_state_create(const corot_model *model, corot_state **state);

/* Takes NULL. */
COROT_API void corot_state_destroy(corot_state *state);

/* Bytes held by the state. */
COROT_API size_t corot_state_bytes(const corot_state *state);

/* From now on n threads share out what is evaluated with this state, and what is solved with a pencil
   of it: n - 1 of the library's own, which wait between two evaluations, and the caller's. Results are
   the same to the last bit for every n. At first n is 1. n = 0: corot_model_threads(). The threads
   belong to the state and end with it; they run no code of the host, and take no signals; a process
   made by fork() has none, and works on alone.

   Not while an evaluation runs. COROT_EINVAL: there is no state, or n is not from 0 to
   COROT_MOST_THREADS. COROT_ENOMEM: no memory, or a thread that the system does not start; with n = 0
   there are fewer instead. After a failure all is as it was. */
#define COROT_MOST_THREADS 256
COROT_API corot_status corot_state_threads(corot_state *state, int n);

/* The same by threads of a host: `run` has to call part(work, k) for every k from 0 to nparts - 1, each
   once, at the same time or not and on threads as it likes, and to return when all of them are done.
   n, from 1 to COROT_MOST_THREADS, is how many parts there mostly are. `host` is handed on to it. The
   parts do not call the host, and do not wait for each other. COROT_EINVAL: there is no state or no
   `run`, or n is not in that range. COROT_ENOMEM. After a failure all is as it was. */
typedef void corot_parallel_for(void *host, int nparts, void (*part)(void *work, int k), void *work);
COROT_API corot_status corot_state_parallel(corot_state *state, int n, corot_parallel_for *run,
                                            void *host);

/* How many threads, or parts, there are. */
COROT_API int corot_state_thread_count(const corot_state *state);

/* As many threads as pay on this machine for a model of this size: 1 for small ones, and never more
   than there are processors. */
COROT_API int corot_model_threads(const corot_model *model);

/* How many processors this process may use: 1 where the system does not say. */
COROT_API int corot_processors(void);

COROT_API void corot_state_use(corot_state *state, corot_frames frames);
COROT_API corot_frames corot_state_frames(const corot_state *state);

/* From now on, evaluations belong to the time after t and before the next kink of a load or a motion:
   at a kink itself the velocity of a support, and at a jump a load, has two values, and this says
   which is meant; beyond it the law goes on as it was, so that r is smooth for a step that ends
   there. An integrator that is made, and a host that is opened or restarted, at t enters t; who goes
   back by a loop of their own has to. Call this at each kink (corot_model_kinks) where a step ends;
   until the first call, and after t = NaN, which lets a step cross a kink, each time has its own law,
   at a kink the later. It also ends statics, below. */
COROT_API void corot_state_enter(corot_state *state, double t);

/* From now on evaluations are for statics: the loads are `factor` times those of time t; the time
   of an evaluation says where the supports are, and they have no velocity there, nor has v any
   effect on r. Until corot_state_enter, or an integrator is made of the state. */
COROT_API void corot_state_stand_still(corot_state *state, double t, double factor);

/* r(t, u, v) [N]. COROT_RETRY when a tet is inverted (det F <= 0 or not a number; not asked of
   cauchy, which is linear): the message and corot_state_inverted() name it. COROT_EINVAL when that
   comes from a component of u or v that is not a number, which the message names. */
COROT_API corot_status corot_residual(const corot_model *model, corot_state *state, double t,
                                      const double *u, const double *v, double *r);

/* The same as a first-order system for y = (u, v) [2n]: ydot = (v, M^-1 r). y and ydot may not
   overlap. COROT_RETRY as for corot_residual. COROT_EINVAL with consistent mass, which takes a factor
   of M: see corot/solve.h; and when a component of y is not a number. */
COROT_API corot_status corot_rhs(const corot_model *model, corot_state *state, double t,
                                 const double *y, double *ydot);

/* y = M x [n]; they may not overlap. */
COROT_API void corot_mass_multiply(const corot_model *model, const double *x, double *y);

/* The tet (number in the mesh) whose inversion made the last evaluation fail; -1: none did. With a
   hierarchy, for a tet of a coarser level its first descendant. */
COROT_API int corot_state_inverted(const corot_state *state);

/* How the frames enter the derivative of the elastic force. */
typedef enum corot_tangent {
  COROT_TANGENT_HELD,  /* as if constant: the paper's warped stiffness R K_e R' */
  COROT_TANGENT_EXACT, /* with their own variation dR (polar, hybrid; otherwise the same) */
  COROT_TANGENT_CLAMPED, /* exact, but in each tet what compression makes negative, of the frames'
                            part and of the stress's, is cut off: K is positive semidefinite, no
                            less than the exact one, and the same where nothing is negative */
  COROT_TANGENT_AUTO = -1 /* in definitions: choose */
} corot_tangent;

/* Elastic stiffness K = -dr/du at v = 0 and damping D = -dr/dv, both symmetric, as 3x3 blocks
   [corot_model_nblock()][9] on the model's pattern (below). Either may be NULL.
   What K leaves out, so as to stay symmetric: the change of the viscous force with u, and the
   variation of a warp frame; the turning of a pressure. With a hierarchy the frames handed down are
   held: their variation would couple all nodes below a tet of the frame level. Coupled by nodes,
   `tangent` is for level 0, which couples its nodes; by means, which couple all nodes on the faces
   of a tet, level 0 is left out; one way, so is its effect on finer nodes. corot_jvp has them.
   COROT_RETRY when a tet is inverted; K and D are without meaning then. */
COROT_API corot_status corot_jacobian(const corot_model *model, corot_state *state, double t,
                                      const double *u, const double *v, corot_tangent tangent,
                                      double (*K)[9], double (*D)[9]);

/* K [corot_model_nblock()] += the loads' own part of -dr/du, by which a pressure turns and grows with
   the surface it acts on: its symmetric part, K of corot_jacobian being symmetric. Where the pressed
   surface is closed, or its edge is held, there is no other (Hibbitt 1979). It cannot fail. */
COROT_API void corot_load_stiffness(const corot_model *model, corot_state *state, double t,
                                    const double *u, double (*K)[9]);

/* Whether K leaves out so much that it does not tell whether an equilibrium is stable: that of a
   hierarchy does. */
COROT_API bool corot_model_approximate_stiffness(const corot_model *model);

/* The derivative of r in the direction (du, dv): jv = dr/du du + dr/dv dv [N], nothing left out.
   With COROT_TANGENT_HELD the frames are constant, with EXACT and with CLAMPED, which is for
   matrices, they follow F. COROT_RETRY when a tet is inverted. */
COROT_API corot_status corot_jvp(const corot_model *model, corot_state *state, double t,
                                 const double *u, const double *v, corot_tangent tangent,
                                 const double *du, const double *dv, double *jv);

/* What an update of the held frames did, or would do. */
typedef struct corot_frames_change {
  double angle_max;  /* largest angle between old and new frame of a tet [rad] */
  double angle_mean; /* [rad] */
  int angle_tet;     /* the tet that turned furthest */
  double energy;     /* elastic energy with the new frames less that with the old [J] */
} corot_frames_change;

/* Sets the held frames to those of u. `change` may be NULL. COROT_RETRY when a tet is inverted;
   nothing is changed then. */
COROT_API corot_status corot_frames_update(const corot_model *model, corot_state *state, double t,
                                           const double *u, corot_frames_change *change);

/* The same change, from the frames in use at t to those of u, without making it. COROT_RETRY when a
   tet is inverted. */
COROT_API corot_status corot_frames_drift(const corot_model *model, corot_state *state, double t,
                                          const double *u, corot_frames_change *drift);

/* After an update: the spin at which the frames turn on where they are extrapolated, from v; zero
   until this is called. *spin_max (or NULL): the largest [rad/s]. COROT_RETRY when a tet is
   inverted. */
COROT_API corot_status corot_frames_spin(const corot_model *model, corot_state *state, double t,
                                         const double *u, const double *v, double *spin_max);

/* Energies and powers of one instant; with COROT_COUPLING_ONE_WAY those of level 0. Of the kinetic
   energy and the momenta, the part of the free degrees of freedom; the work of a moving support is
   that of the internal and viscous forces on its nodes. What it does beside by way of a consistent
   mass, - v' (M_fs a_s + C_fs v_s), counts among the loads'. */
typedef struct corot_energies {
  double kinetic;          /* 1/2 v' M v [J] */
  double elastic;          /* of the strain energy whose gradient is f_int (warp: whose held-frame
                              gradient is f_int) [J] */
  double power_dissipated; /* by the viscous forces and the mass damping [W] */
  double power_external;   /* of the loads and the moving supports [W] */
  double power_supports;   /* of the moving supports alone [W] */
  double power_carried;    /* of these, what is no change of: */
  double carried;          /* M v along the velocity of the supports' rigid motion, continued through
                              the body [J]; 0 where an amplitude or more than one motion moves
                              supports, others stand still, or no phase was entered */
  double momentum[3];         /* sum m v over free components [kg m/s] */
  double angular_momentum[3]; /* about the origin [kg m^2/s] */
} corot_energies;

/* Energies and powers of (u, v) at t. COROT_RETRY when a tet is inverted. */
COROT_API corot_status corot_energy(const corot_model *model, corot_state *state, double t,
                                    const double *u, const double *v, corot_energies *energies);

/* Displacement and velocity of all nodes, held components included [nnode][3]; either output may
   be NULL. */
COROT_API void corot_nodal(const corot_model *model, double t, const double *u, const double *v,
                           double (*displacement)[3], double (*velocity)[3]);

/* Fields of the tets, in the mesh's order [ntet]; any may be NULL. With a hierarchy, frames are
   those handed down, strain and stress those of the finest level alone. Symmetric tensors are
   stored xx yy zz xy yz xz (not doubled).

   In ten-node tets they vary, and the first four are means over the points of integration, weighted
   by volume; the frame is the rotation nearest to the mean of the frames. The others are the values
   at the four points: point k, next to corner k of the mesh's tet, has the barycentric coordinate
   a = (5 + 3 sqrt 5) / 20 there and b = (5 - sqrt 5) / 20 at each other corner. The linear function
   with the values f at the points is (f_k - b sum f) / (a - b) at corner k. In four-node tets all four
   points have the tet's value. */
typedef struct corot_element_fields {
  double (*frame)[9];  /* R, row-major: the frame the model uses now */
  double (*strain)[6]; /* shear-term strain e_s, in the frame (B = R) or material axes (B = F) */
  double *von_mises;   /* of the Cauchy stress P F' / det F [Pa]; for cauchy of P itself */
  double *det;         /* det F; as a mean, volume over rest volume */
  double (*frame_at)[4][9], (*strain_at)[4][6]; /* the same at the points */
  double (*von_mises_at)[4], (*det_at)[4];
  /* Likewise, means and at the points: the stress of von_mises, in fixed axes, and its eigenvalues,
     the largest first [Pa]. */
  double (*stress)[6], (*principal)[3];
  double (*stress_at)[4][6], (*principal_at)[4][3];
  double *energy, *volume; /* strain energy [J]; rest volume [m^3]: of the whole tet */
} corot_element_fields;

/* COROT_RETRY if a tet is inverted; the fields are set all the same, its own without meaning (and
   with COROT_DILATATION_NODAL its neighbours' von Mises stress). */
COROT_API corot_status corot_elements(const corot_model *model, corot_state *state, double t,
                                      const double *u, const corot_element_fields *fields);

/* Places in the body at which such fields are looked at one by one. */
typedef struct corot_points corot_points;

/* tet [n], at [n]: tets and volume coordinates in them, as in corot_location. The model must outlive
   the points. COROT_EINVAL: there is no such tet. COROT_ENOMEM. */
COROT_API corot_status corot_points_create(const corot_model *model, int n, const int *tet,
                                           const double (*at)[4], corot_points **points);

/* Takes NULL. */
COROT_API void corot_points_destroy(corot_points *points);

/* As of the tets, each [n]; any may be NULL. F and with it strain and stress are those of the shape
   functions at the point. A frame that is given (held, extrapolated, handed down) and an averaged
   dilatation are those of the tet: of a ten-node tet the linear function through its points of
   integration. */
typedef struct corot_point_fields {
  double (*frame)[9], (*strain)[6], (*stress)[6], (*principal)[3];
  double *von_mises, *det;
} corot_point_fields;

/* COROT_RETRY if the body is inverted at one of the points (the fields are set all the same). */
COROT_API corot_status corot_points_evaluate(const corot_points *points, corot_state *state,
                                             double t, const double *u,
                                             const corot_point_fields *fields);

/* How far a displacement is from small strains and turns. What is below the limits is not counted,
   so that a body hardly deformed costs little. */
typedef struct corot_deformation {
  double strained; /* part of the volume where a principal stretch is off one by more than the
                      limit */
  double stretch_min, stretch_max; /* of the principal stretches there; 1 if there is none */
  double turned;   /* part of the volume turned by more than the limit */
  double turn_max; /* largest turn there, the angle of the polar factor [rad]; 0 if there is none */
  double det_min;  /* the smallest det F of all tets, and whose it is */
  int det_tet;
  int ninverted;   /* tets with det F <= 0, which the rest leaves out */
} corot_deformation;

/* Of the displacement at t alone, whatever the strain measure; with a hierarchy, of the finest
   level. strain_limit: 0 to 1; turn_limit [rad]: INFINITY, if turns do not matter. */
COROT_API void corot_deformation_measure(const corot_model *model, corot_state *state, double t,
                                         const double *u, double strain_limit, double turn_limit,
                                         corot_deformation *deformation);

/* How much the stress, which is constant in each tet, jumps between tets: an indicator of what the
   mesh leaves out. With the stress S in material axes, and S* its continuous recovery, linear between
   averages around the nodes (each material has its own),

     *share = e / sqrt(|S|^2 + e^2),  e = |S* - S|

   in the norm of the strain energy (Zienkiewicz & Zhu 1987, whose estimator of the relative error
   this is). Where dilatations are averaged, of the deviator alone. 0 for a body without stress but
   what rounding leaves. COROT_ENOMEM. */
COROT_API corot_status corot_stress_jumps(const corot_model *model, corot_state *state, double t,
                                          const double *u, double *share);

/* Elastic force of the model on all nodes [nnode][3] [N], held ones included, with exact frames.
   COROT_RETRY as for corot_residual. */
COROT_API corot_status corot_elastic_force(const corot_model *model, corot_state *state, double t,
                                           const double *u, double (*f)[3]);

/* The same of any one strain measure on the model's mesh, whatever the model's is:
   f = lambda_part * (lambda term) + mu_part * (mu term). Dilatations are averaged if the model's
   are. COROT_RETRY as for corot_residual. COROT_EINVAL: there is no measure of that name. */
COROT_API corot_status corot_internal_force(const corot_model *model, corot_state *state, double t,
                                            const double *u, const char *strain, double lambda_part,
                                            double mu_part, double (*f)[3]);

/* The parts of the balance of forces at all nodes [nnode][3] [N], held components included; any may
   be NULL. In the frames and by the laws that the state is in:

     internal + viscous + inertial - load = reaction

   is the force of the supports on the body. On free components it is zero, but for rounding, where
   M a = r is what `a` was found from. With COROT_COUPLING_ONE_WAY they are those of level 0, and zero
   on other nodes. */
typedef struct corot_nodal_forces {
  double (*internal)[3]; /* the elastic force; if `viscous` is NULL, plus that, at no more cost */
  double (*viscous)[3];  /* of viscous stresses and of the mass damping */
  double (*inertial)[3]; /* the mass in use times the acceleration of all nodes */
  double (*load)[3];
} corot_nodal_forces;

/* u, v and a [n]: displacement, velocity, acceleration. In statics (corot_state_stand_still) nothing
   has a velocity or an acceleration, and v and a may be NULL. COROT_RETRY as for corot_residual; the
   fields are without meaning then. */
COROT_API corot_status corot_forces(const corot_model *model, corot_state *state, double t,
                                    const double *u, const double *v, const double *a,
                                    const corot_nodal_forces *forces);

/* Velocity and acceleration of all nodes [nnode][3], of which v and a [n] are the free ones, by the
   laws that the state is in; either output may be NULL, and then its input. */
COROT_API void corot_nodal_motion(const corot_model *model, const corot_state *state, double t,
                                  const double *v, const double *a, double (*velocity)[3],
                                  double (*acceleration)[3]);

/* Loads of time t, times `factor`, on all nodes [nnode][3] [N], held components included, of the
   body displaced by `displacement` [nnode], which says where a pressure acts. What falls on held
   components is taken up by the supports: at rest, the force of a support on the body is the elastic
   force less this. COROT_ENOMEM. */
COROT_API corot_status corot_load_force(const corot_model *model, double t, double factor,
                                        const double (*displacement)[3], double (*f)[3]);

/* --- The matrices' pattern ------------------------------------------------------------------- */

/* Number of stored 3x3 blocks: the diagonal and the lower triangle over pairs of nodes that share
   a tet or, with COROT_DILATATION_NODAL, an average: those two tets apart; with a hierarchy coupled
   by nodes, if the measures differ, or one way, also a tet of level 0. Blocks of held nodes are
   stored but mean nothing. */
COROT_API int corot_model_nblock(const corot_model *model);

/* y = A x for blocks A [nblock][9]; x and y are [n] and may not overlap. */
COROT_API void corot_block_multiply(const corot_model *model, const double (*A)[9], const double *x,
                                    double *y);

typedef enum corot_triangle { COROT_FULL, COROT_LOWER } corot_triangle;

/* Compressed sparse columns over the free degrees of freedom, rows ascending. */
typedef struct corot_csc {
  int n;
  int nnz;
  int *colptr; /* [n + 1] */
  int *row;    /* [nnz] */
  int *source; /* [nnz] where the entry stands in the blocks, counted in doubles */
  int *diagonal; /* [n] the entry of each column's diagonal */
  int *node;     /* [n] the mesh node each degree of freedom belongs to; ascending */
} corot_csc;

/* COROT_EINVAL: there are more entries than an int counts. COROT_ENOMEM. */
COROT_API corot_status corot_csc_create(const corot_model *model, corot_triangle triangle,
                                        corot_csc **csc);

/* Takes NULL. */
COROT_API void corot_csc_destroy(corot_csc *csc);

/* value [nnz] = a M + b D + c K with the model's own M; D and K may be NULL where their factor is zero. */
COROT_API void corot_csc_combine(const corot_model *model, const corot_csc *csc, double a, double b,
                                 const double (*D)[9], double c, const double (*K)[9],
                                 double *value);

#ifdef __cplusplus
}
#endif
#endif
