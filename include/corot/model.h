/* The model: a mesh with material, strain measure, supports and loads, made ready for evaluation.

   A model is immutable once created and may be shared by any number of states and threads.
   Units are SI throughout: m, s, kg, Pa.

   A complete program: tests/examples/model.c. */
#ifndef COROT_MODEL_H
#define COROT_MODEL_H

#include <corot/mesh.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Isotropic visco-elastic material: sigma(e) = lambda tr(e) I + 2 mu e, and the same law with the
   damping coefficients on the strain rate (the paper's D). */
typedef struct corot_material {
  const char *group;      /* the tets it fills; NULL: all that no other entry names */
  double lambda, mu;      /* Lame constants [Pa]; mu > 0, 3 lambda + 2 mu > 0 */
  double density;         /* [kg/m^3] > 0 */
  double damping_lambda;  /* [Pa s] >= 0 */
  double damping_mu;      /* [Pa s] >= 0 */
  double damping_mass;    /* Rayleigh's: a force -damping_mass M v [1/s] >= 0 */
} corot_material;

/* Viscous law of terms on a frame basis. COROTATED, the paper's: strain rate sym(R' dF/dt), which
   a spinning deformed body feels a little; it has a moment, by which a body in equilibrium under
   equal pressure begins to spin. OBJECTIVE: the rate dS/dt of the stretch of F = R S itself, which
   is exactly zero in any rigid motion; polar and hybrid only. Its matrix depends on the deformation
   too, COROTATED's on the frames alone; and it needs frames that lag by less than a right angle,
   for it divides by s_j + s_k, sums of two eigenvalues of sym(R'F), which are positive in exact
   frames. AUTO: OBJECTIVE with polar and hybrid unless there is a hierarchy, else COROTATED. */
typedef enum corot_viscosity {
  COROT_COROTATED,
  COROT_OBJECTIVE,
  COROT_VISCOSITY_AUTO,
} corot_viscosity;

/* How a factor changes in time. */
typedef enum corot_curve {
  COROT_CURVE_LINEAR, /* linear between points, constant beyond the first and the last. Two points at
                         one time are a jump: the value of the first before it, that of the second
                         from that time on; three at one time are refused */
  COROT_CURVE_SMOOTH, /* the cubic spline through the points, with a continuous second derivative
                         between them and slope zero at the first and the last, where constants
                         continue it: smooth everywhere, it has no kinks. It may swing beyond its
                         points, which is refused where it is by more than their whole range, as
                         beside a long rest between few points. What is cut off on a slope bends to
                         flat between the last points; elsewhere the error falls with the fourth
                         power of their distance */
  COROT_CURVE_SINE,   /* offset + sin(2 pi frequency t + phase), at all times */
} corot_curve;

/* A factor in time. All zero: one at all times. */
typedef struct corot_amplitude {
  int n;               /* points of LINEAR or SMOOTH; 0: one at all times */
  const double *time;  /* [n] ascending [s] */
  const double *value; /* [n] */
  corot_curve curve;
  double frequency; /* of SINE [Hz] > 0 */
  double phase;     /* [rad] */
  double offset;
} corot_amplitude;

/* LUMPED: row sums at the nodes (the paper's); of ten-node tets, whose row sums at corners are
   negative, in proportion to the diagonal: 1/36 of a tet's mass at a corner, 4/27 on an edge (Hinton,
   Rock & Zienkiewicz 1976). CONSISTENT: the shape functions' own, which couples neighbours, those of
   moving supports too: these hand on their acceleration (corot/ode.h). A support whose velocity may
   jump, which is of constant rate or follows a LINEAR amplitude, would hand that on as an impulse:
   elements with a node on it are lumped. What that changes is of third order in their size, unless the
   body moves relative to the support as little as in bending: then of fifth. AUTO: lumped for
   four-node tets, consistent for ten-node ones, which need it for their order of accuracy: lumped, the
   first frequency of torsion of a square bar is 6 per cent lower with two cells across, 1.6 with
   four; with COROT_COUPLING_ONE_WAY lumped in either case. */
typedef enum corot_mass { COROT_MASS_LUMPED, COROT_MASS_CONSISTENT, COROT_MASS_AUTO } corot_mass;

/* What the pressure (lambda) term acts on. LOCAL: each tet's own dilatation, which locks as lambda
   grows: near incompressibility linear tets come out several times too stiff. NODAL: mostly its
   averages over the tets around each node (Bonet & Burton 1998), as the gradient of an energy, for
   every strain measure; a node between materials has an average of each. Displacements then converge
   as those of compressible solids do; the pressure stays rough from node to node. The damping's
   first coefficient acts on each tet's own rate all the same. K couples nodes two tets apart and has
   nearly four times the entries; forces take twice the time. Of ten-node tets the nodes are the
   corners. ELEMENT: the mean over the points of each ten-node tet, which is stable there and does not
   lock; K keeps its pattern. For linear tets, which have one point, it is the same as LOCAL. With
   LOCAL ten-node tets lock on coarse meshes: at a Poisson's ratio of 0.45, 0.49 and 0.4999 Cook's
   membrane (tests/models/test_locking.c) of 4 cells a side bends 6, 12 and 19 % less than one of 32
   cells with ELEMENT, of 8 cells 1.7, 3.2 and 6.3 %, of 16 cells 0.6, 1.0 and 2.0 %; with ELEMENT or
   NODAL 1.0 to 2.5 % of 4 cells, below 0.9 % of 8. The slender bar of models/bar, two tets thick,
   bends 1.3, 2.3 and 4.5 % less with LOCAL than refined with ELEMENT. */
typedef enum corot_dilatation {
  COROT_DILATATION_LOCAL,
  COROT_DILATATION_NODAL,
  COROT_DILATATION_ELEMENT,
} corot_dilatation;

typedef enum corot_load_kind {
  COROT_TRACTION, /* force per rest area on the group's triangles, fixed direction [Pa] */
  COROT_GRAVITY,  /* acceleration of the whole body [m/s^2]; the group is ignored */
  COROT_FORCE,    /* total force, spread evenly over the group's nodes, fixed direction [N] */
  COROT_PRESSURE, /* value[0], on the deformed area of the group's triangles, against their outward
                     normal: it follows the surface [Pa] */
} corot_load_kind;

typedef struct corot_load {
  corot_load_kind kind;
  const char *group;
  double value[3];
  corot_amplitude amplitude;
} corot_load;

/* Displacement components of a group's nodes held at zero. */
typedef struct corot_fix {
  const char *group;
  bool component[3];
} corot_fix;

typedef enum corot_motion_kind {
  COROT_ROTATE,    /* about an axis through `center`, at `rate`, right-handed */
  COROT_TRANSLATE, /* at `velocity` */
  COROT_TURN,      /* about an axis through `center`, right-handed, by amplitude(t) times `angle` */
  COROT_MOVE,      /* displaced by amplitude(t) times `direction` */
} corot_motion_kind;

/* Nodes of a group on a prescribed path, which holds all three components. ROTATE and TRANSLATE: at
   rest until `from`, then at constant rate, at rest again from `to`. TURN and MOVE: where the
   amplitude puts them, with its derivative as velocity; it may have kinks, at which the velocity
   jumps, but no jumps. Where it is not zero at the start of a run, the support stands displaced
   there, and stretches a body that is not; where its derivative is not zero, as of a sine of phase
   zero, it sets out with a jolt.

   Several motions of one group add up, be they turns about one and the same axis or translations;
   two of constant rate at times that do not overlap. */
typedef struct corot_motion {
  corot_motion_kind kind;
  const char *group;
  double axis[3];   /* not zero */
  double center[3]; /* [m] */
  double rate;      /* [rad/s] */
  double velocity[3]; /* [m/s] */
  double from, to;  /* [s] from < to; to may be INFINITY */
  double angle;     /* of TURN [rad] */
  double direction[3]; /* of MOVE [m] */
  corot_amplitude amplitude; /* of TURN and MOVE */
} corot_motion;

/* How level 0 of a hierarchical model follows the motion u of the finest level. MEAN: each of its
   tets c by the mean of the gradient F over it,

     E(u) = E_fine(u; R) + sum_c V_c [psi_coarse(Fm_c) - psi_model(Fm_c; R_c)],
     Fm_c = 1/V_c sum_i V_i F_i over the descendants i of c,

   which the means of u over the faces of c decide; of ten-node tets, the mean over their points.
   NODES: by its own nodes,

     E(u) = E_fine(u; R) + E_coarse(u_0) - E_linear(u_0),

   u_0 their displacement, E_linear of level 0 under the model's measure. ONE_WAY, the paper's words
   taken literally: level 0 is a mesh of its own, which moves as if there were no other, and the
   finer nodes follow,

     M_0 u_0'' = f_0 - dE_coarse/du_0,   M_i u_i'' = f_i - dE_fine(u; R)/du_i on finer nodes,

   M_0 and f_0 the lumped mass and the loads of level 0, T' of corot/hierarchy.h times those of all
   nodes: to the detail its nodes are moving supports, and they feel nothing of it. */
typedef enum corot_coupling {
  COROT_COUPLING_MEAN,
  COROT_COUPLING_NODES,
  COROT_COUPLING_ONE_WAY,
} corot_coupling;

/* A strain measure of its own for level 0 of a refined mesh: nonlinear where the mesh is coarse,
   and on the finest level the model's, linear in frames that a coarser tet hands down to all its
   descendants (Hauth & Strasser 2004, their hierarchical simulation; the paper leaves the combined
   system open). It is that of one of the energies above: psi_coarse of the coarse measure, E_fine
   and psi_model of the model's, R the frames of the tets of the frame level, with MEAN of their
   mean gradients. The viscous forces are put together from the same terms.

   With MEAN and NODES, where the whole body moves as level 0 does (the differences of
   corot/hierarchy.h are zero), the fine and the linear term cancel, and E is that of the coarse
   mesh; with the same measure on both, and frame level = nlevel, E is that of the plain model on
   the refined mesh. With nlevel = 0 any is the plain model of the coarse measure.

   The last level may be that of ten-node tets, by corot_refinement_raise: the detail is then
   quadratic on the same tets, and each of their points is linear in the frame of the tet above it,
   or, of frame level nlevel, in its own. Without octasection level 0 has the same tets with four
   nodes. With ONE_WAY the mass is then the lumped one, also for AUTO: as 1/36 of a tet's mass at a
   corner and half of 4/27 on each of three edges make a quarter, level 0 has that of four-node tets.

   With MEAN and frames of level 0, E = sum_c V_c psi_coarse(Fm_c) + E_detail, where E_detail is
   quadratic in the detail F_i - Fm_c and not negative: such a body is as stable as one of the
   coarse measure alone. With NODES, E_coarse - E_linear is of third order in the strain, of either
   sign, and acts on the nodes of level 0 alone, which E_fine holds the more weakly the finer the
   mesh is. Measured with green and polar, on a bar of 18 tets held at both ends in simple shear:
   with MEAN the energy is convex about the state up to a shear strain of 1.5, the largest tried,
   with one level and with two and for every frame level, like plain green; with NODES to 0.2 with
   one level and 0.06 with two, and not far beyond, the nodes of level 0 leave their surroundings,
   and tets invert. With ten-node tets as the only level, and after one octasection, it is 1.5 with
   MEAN, too, and with NODES 0.10 and 0.04. Pressed together, either gives up at the latest where
   a level 0 of green alone would; polar there does not.

   With MEAN the matrices are those of E_fine with the frames held, on the plain model's pattern: K
   lacks what the coarse measure adds, a part of the size of its strains, as well as the turning of
   the frames. Implicit time steps hardly notice; equilibria are found by more iterations, and only
   for moderate strains.

   With ONE_WAY there is no energy of the whole. Energies, powers and momenta are those of level 0
   alone, whose balance closes; mass and forces on its nodes are those of level 0, too, and a sum
   over all nodes counts the body twice. K and D are block diagonal: they leave out what a motion of
   level 0 does to the finer nodes. Not with consistent mass, nor under a pressure, which acts on a
   surface that level 0 does not have. */
typedef struct corot_hierarchy_def {
  size_t bytes; /* sizeof of this, as the defaults set it: see corot/base.h */
  const corot_refinement *refinement; /* how the model's mesh was made, by corot_mesh_refine from
                                         one of order 1, and raised by corot_refinement_raise or
                                         not; the descendants of a tet of level 0 have one material */
  const char *coarse_strain;          /* any */
  int frame_level;                    /* 0 to nlevel; 0: one frame for a tet of level 0; for warp,
                                         whose frames depend on a tet's edges, 0 only */
  /* The elastic force is the gradient of E, with the part by which R follows u: energy, momentum
     and angular momentum are conserved. False: that part is left out, as the paper does; a little
     cheaper, and off by the product of strain and difference, in a torque on each frame's tet.
     Without meaning where frames are held, and with ONE_WAY. Needs polar (or cauchy, whose frames
     do not turn). */
  bool conservative;
  corot_coupling coupling;
} corot_hierarchy_def;

/* As in the paper, coarse strain green and frame level 0; conservative, coupling MEAN; no
   refinement. */
COROT_API void corot_hierarchy_set_defaults(corot_hierarchy_def *def, size_t bytes);
static inline corot_hierarchy_def corot_hierarchy_defaults(void) {
  corot_hierarchy_def def;
  corot_hierarchy_set_defaults(&def, sizeof def);
  return def;
}

/* What a model is made of; everything in it is copied. */
typedef struct corot_model_def {
  size_t bytes; /* sizeof of this, as the defaults set it: see corot/base.h */
  const corot_mesh *mesh;
  const char *strain; /* cauchy | warp | polar | hybrid | green; see corot/ode.h */
  int nmaterial;
  const corot_material *material; /* [nmaterial] every tet must be covered exactly once */
  const int *tet_material; /* [mesh->ntet] the entry of `material` that fills each tet, as from an
                              image or a table; no entry then names a group. NULL: groups say it.
                              Tets are computed eight at a time, of one material: thousands of
                              materials of a few tets each cost several times as much, which bins
                              of equal ones avoid */
  int nfix;
  const corot_fix *fix; /* [nfix] none: a free body */
  int nmotion;
  const corot_motion *motion; /* [nmotion] on nodes that nothing else holds */
  int nload;
  const corot_load *load; /* [nload] */
  corot_viscosity viscosity;
  corot_mass mass;
  const corot_hierarchy_def *hierarchy; /* NULL: `strain` everywhere. Else `strain` is that of the
                                           finest level, which must be linear in a given frame:
                                           cauchy, warp or polar; viscosity COROTATED
                                           or AUTO,                                           dilatation LOCAL */
  corot_dilatation dilatation;
  double dilatation_local; /* NODAL: so many mu of lambda are left to each tet's own dilatation, for
                              the patterns of swelling and shrinking that averages do not see; a
                              material with no more lambda than that keeps all of it. In mu, for a
                              fraction of lambda would lock again. >= 0 */
} corot_model_def;

/* Strain polar, viscosity and mass AUTO, dilatation local (if nodal, with one mu left), nothing else. */
COROT_API void corot_model_set_defaults(corot_model_def *def, size_t bytes);
static inline corot_model_def corot_model_defaults(void) {
  corot_model_def def;
  corot_model_set_defaults(&def, sizeof def);
  return def;
}

/* What a strain measure is like. */
typedef struct corot_strain_kind {
  const char *name;
  bool frames;           /* its force turns with an element rotation: warp, polar, hybrid */
  bool polar;            /* which is the polar rotation; the viscous law may be OBJECTIVE */
  bool linear_in_frames; /* the force is linear in u while the frames are given: cauchy, warp, polar */
  bool linear;           /* and there are none: cauchy, which no inverted tet stops */
  bool exact;            /* Green's strain in every term: green (St. Venant-Kirchhoff) */
} corot_strain_kind;

/* The strain measures, i = 0, 1, ...; NULL beyond the last. */
COROT_API const corot_strain_kind *corot_strain_traits(int i);

/* The one of this name; NULL: there is none. */
COROT_API const corot_strain_kind *corot_strain_find(const char *name);

typedef struct corot_model corot_model;

/* COROT_EINVAL names what does not fit, an entry of a list by its index ("material 1: mu = 0 is not
   positive"): an unknown group or strain, a coefficient out of range, a tet without material, a
   traction on a group without triangles, a support on a group without nodes.
   COROT_ENOMEM. */
COROT_API corot_status corot_model_create(const corot_model_def *def, corot_model **model);

/* Takes NULL. */
COROT_API void corot_model_destroy(corot_model *model);

/* The model's copy of the mesh. */
COROT_API const corot_mesh *corot_model_mesh(const corot_model *model);

/* The name of the strain measure; with a hierarchy both, as "green+polar". */
COROT_API const char *corot_model_strain(const corot_model *model);

/* The viscous law in use: COROTATED or OBJECTIVE. */
COROT_API corot_viscosity corot_model_viscosity(const corot_model *model);

/* Whether the stiffness and damping matrices depend on the frames alone, and stay while these are
   held: with polar, warp and cauchy, unless there is damping by the objective law; and under a hierarchy with coupling MEAN of these on the finest
   level, whatever the coarse measure. */
COROT_API bool corot_model_matrices_by_frames(const corot_model *model);

/* Number n of free degrees of freedom: the length of u, v and r everywhere. */
COROT_API int corot_model_ndof(const corot_model *model);

/* [nnode][3] the degree of freedom of each node's components; -1: held. */
COROT_API const int (*corot_model_dof(const corot_model *model))[3];

/* [n] lumped mass (row sums) of each degree of freedom [kg], whichever mass is in use; positive.
   With COROT_COUPLING_ONE_WAY on nodes of level 0 that of level 0. */
COROT_API const double *corot_model_mass(const corot_model *model);

COROT_API corot_mass corot_model_mass_kind(const corot_model *model);

/* The times strictly between t0 and t1 where a load or a motion has a kink or a load jumps, ascending,
   each once; at most `max` are written to `time` (which may be NULL if max is 0). Returns how many
   there are. Sines and splines have none, but for the ends of a spline by which a support drags a
   consistent mass: its acceleration jumps there. */
COROT_API int corot_model_kinks(const corot_model *model, double t0, double t1, int max,
                                double *time);

/* The latest time to which one step from t should go, so as not to pass over what a smooth amplitude
   does meanwhile: error control sees only what a step has met. It is a quarter of a sine's period
   away; half of the way that a spline takes from one extreme to the next, and where the spline
   rests, the time at which it sets out. INFINITY: as far as any amplitude is concerned. Later than
   t. The integrators of corot/integrate.h that control their error keep to it by themselves. */
COROT_API double corot_model_horizon(const corot_model *model, double t);

/* Scales for tolerances, the same however the body is turned: its length, twice the largest
   distance from its centroid [m]; the smallest shear wave speed sqrt(mu/density) over it [1/s]; and
   the smallest ratio of damping to stiffness over all materials and both coefficients [s]. */
COROT_API double corot_model_length(const corot_model *model);
COROT_API double corot_model_frequency(const corot_model *model);
COROT_API double corot_model_damping_time(const corot_model *model);

/* Whether supports move. */
COROT_API bool corot_model_moves(const corot_model *model);

/* Bytes held by the model. */
COROT_API size_t corot_model_bytes(const corot_model *model);

#ifdef __cplusplus
}
#endif
#endif
