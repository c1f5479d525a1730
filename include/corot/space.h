/* How much of the deformation a mesh of four-node tets leaves out: the space error, estimated.

   The same definition on ten-node tets, those of the mesh with a node on each edge
   (corot_mesh_change_order), takes over the state (u, v, a), in which a new node has the mean of the
   two ends. What is out of balance there is what the four-node tets could not see, and one linear
   solve tells how far the body gives way to it:

     K2 e = r2(t, u, v) - M2 a,   a = M^-1 r(t, u, v), of an equilibrium 0,

   r2, M2 and K2 residual, mass and tangent stiffness of the ten-node tets, r and M of the given
   model, all with exact frames. The error is that of the deformation under the loads and forces of
   inertia of that moment: u + e is, to first order in e, the shape in which ten-node tets would carry
   them. Of an equilibrium that is linear (cauchy) it is their equilibrium. It is not what has piled
   up in time: a mesh that is too stiff swings too fast, and is soon anywhere in its period.

   e is an estimate of the error as far as ten-node tets are free of it: where they lock, or are too
   coarse themselves, too little, and where faces are plane that should be curved, nothing of that. On
   eleven bodies e at a point is 0.85 to 1.11 times what is missing to finer ten-node tets
   (models/benchmarks). With strong bending, one step of Newton's iteration goes too far: on a bar that
   is bent by half a right angle, of which half is missing, 1.65 times. For ten-node tets themselves
   there is no such estimate.

   It takes some forty microseconds a tet, for model, matrix and six to twelve iterations, and the time
   of one factor of the given model's stiffness.

   A complete program: tests/examples/space.c. */
#ifndef COROT_SPACE_H
#define COROT_SPACE_H

#include <corot/solve.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The state that is looked at. */
typedef struct corot_space_moment {
  double t;        /* [s]; at a kink, see corot_state_enter: by the laws before it */
  const double *u; /* [n] of the model */
  const double *v; /* [n]; of an equilibrium it is not looked at */
  bool still;      /* an equilibrium, under the loads of time load_t */
  double load_t;   /* [s] */
  double factor;   /* times this, as of corot_state_stand_still; of motion these two are not looked at */
} corot_space_moment;

typedef struct corot_space_estimate {
  double error;        /* e, and */
  double displacement; /* u + e: root of the mean square over the mass that is free to move [m] */
  double relative;     /* error / displacement: the part that is missing. 0 where nothing is displaced */
  long niteration;     /* of an iterative solver */
  bool indefinite;     /* K2 is not positive definite, as it may be where four-node tets are under
                          stress for being too stiff: the stiffness of the material alone took its
                          place, in the frames of polar (warp and cauchy: their own) */
} corot_space_estimate;

/* The estimate for a model of linear tets, made by `def` (whose mesh is not looked at).

   Of a part that nothing holds, e has no rigid motion, for which out-of-balance forces and tangent
   are freed of them; and u is its displacement less the rigid motion that fits best. Where supports
   move, u is less the rigid motion of those of a part. Else it is u itself.

   correction [nnode][3] (or NULL) = e at the model's nodes [m]: what is to be added to u there.
   linear NULL: conjugate gradients, to 1e-4, by V-cycles between the two kinds of tets with a factor
   of the linear ones, so that the number of iterations does not grow with the mesh.

   COROT_EINVAL: the model has ten-node tets, or a hierarchy; the definition does not suit ten-node
   tets; a linear solver as for corot_pencil_create. COROT_RETRY, COROT_ESINGULAR: a tet is inverted,
   or the linear system has no solution. COROT_ENOMEM. */
COROT_API corot_status corot_space_error(const corot_model_def *def, const corot_model *model,
                                         const corot_space_moment *at,
                                         const corot_linear_def *linear, double (*correction)[3],
                                         corot_space_estimate *estimate);

/* --- Where the error comes from ---------------------------------------------------------------

   Tet by tet, for four-node and ten-node tets: how far the strain e of the state is from the one e*
   that is recovered of it around each node (src/solve/space/patches.h; Zienkiewicz and Zhu 1992),

     eta_T^2 = integral over T of (e* - e) : C : (e* - e),

   Green's strain in material axes for every strain measure (cauchy: that of small displacements), so
   that turns do not count; recovered apart in each material, whose strains may jump where they meet.
   With averaged dilatations, whose pressure is rough, of the deviators alone.

   With a goal J(u), of which the derivative g [ndof] is given, the same of the dual state z, K z = g,
   K the stiffness at the state: z says how much a force anywhere changes J. What T has to do with the
   error of J is at most eta_T(u) eta_T(z) (J. T. Oden, S. Prudhomme, Comput. Math. Appl. 41, 2001);
   with its sign, summed over the tets, it is an estimate of what J is still to change:

     J(exact) - J(u) = sum_T integral of (e* - e)(u) : C : (e* - e)(z)   to first order.

   That is a guide to which tets to cut, and a rough number: for a body without edges that bend in, the
   root of the energy is 0.9 to 1.2 times the true one (a tube under pressure, six tets through its wall);
   of coarse bending four-node tets the goal's is 0.5 to 0.7 of what is missing, and of ten-node tets at
   such an edge, or a clamped one, 0.45 to 0.75, the more the better these are cut.

   What moves is looked at as if it stood still under the forces of the moment, inertia among them;
   a part that nothing holds has neither goal nor dual state along its rigid motions.

   Curved faces that the mesh has as plane ones are not noticed. */
typedef struct corot_space_total {
  double energy;   /* half the sum of eta_T^2: strain energy that the mesh leaves out [J] */
  double relative; /* root of energy / (energy + that of the strain itself): of corot_stress_jumps,
                      better recovered. 0 where there is no strain but of rounding */
  double goal;     /* estimate of J(exact) - J(u), with its sign; 0 without a goal */
  double bound;    /* sum of eta_T(u) eta_T(z), no less than the size of that; 0 without a goal */
  long niteration; /* of an iterative solver, for z */
  bool indefinite; /* K is not positive definite, and z that of what is left when it is clamped */
} corot_space_total;

/* indicator [ntet]: eta_T(u) eta_T(z), in the unit of J, their sum the bound; goal NULL: eta_T^2 / 2
   [J], their sum the energy. None is negative. Of the moment, u and what says which it is are looked
   at. `linear` NULL: the defaults; it is for z alone. `total` may be NULL.

   It takes some 2 microseconds a four-node tet and 10 a ten-node one, and with a goal one factor of K
   beside.

   COROT_EINVAL: the model has a hierarchy; a linear solver as for corot_pencil_create. COROT_RETRY,
   COROT_ESINGULAR: u is not finite; with a goal, a tet is inverted, or the linear system has no
   solution. COROT_ENOMEM. */
COROT_API corot_status corot_space_indicators(const corot_model *model,
                                              const corot_space_moment *at, const double *goal,
                                              const corot_linear_def *linear, double *indicator,
                                              corot_space_total *total);

/* Which tets to refine (corot_mesh_refine_marked): the fewest that carry this fraction of the sum of the indicators [ntet]
   (Doerfler 1996); of equal ones those of lower numbers. mark [ntet], of which *nmark are set:
   their numbers, ascending. None carries a sum of zero. *nmark / ntet says how concentrated the error is: a
   fraction of a half in a twentieth of the tets is local; in a third, uniform refinement is as
   good. COROT_EINVAL: the fraction is not above 0 and at most 1, or an indicator is negative or not a
   number. COROT_ENOMEM. */
COROT_API corot_status corot_space_mark(int ntet, const double *indicator, double fraction,
                                        int *nmark, int *mark);

#ifdef __cplusplus
}
#endif
#endif
