/* What comes in while a run goes on: forces, factors of loads, paths of supports, factors of
   materials, and a function of your own that pushes back. For partner codes (a fluid, a contact, a
   muscle), controllers, and experiments.

   The model stays what it is, immutable and shared. The inputs belong to a state
   (corot_state_use_inputs), and everything that is evaluated with that state sees them: r, its
   derivative, K and D, energies and powers, the balance of forces, equilibria (corot/statics.h), and
   every integrator. States without inputs, or with others, do not. Modes, and the estimators of
   corot/space.h, are those of the model alone.

   Change inputs between steps, never inside a call of yours that an evaluation makes, and tell the
   integrator afterwards, by corot_integrator_changed: it takes over what has changed, keeps the
   matrices if only forces or paths have, and begins again only if r jumps by more than the next
   step forgives. So a loop of windows does not cost a restart a window if the forces are continuous,
   as those of corot_inputs_ramp_force are; where each window has a constant one, whose jumps are felt, it
   takes about half as much again, and is a window's half behind. What you want to know of the inside of a step, ask before
   you change its inputs.

   A function that refuses leaves the inputs as they were. Inputs, and all states that use them,
   belong to one thread at a time.

   A complete program: tests/examples/inputs.c. */
#ifndef COROT_INPUTS_H
#define COROT_INPUTS_H

#include <corot/ode.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct corot_inputs corot_inputs;

/* None yet: a state with them is as one without. The model must outlive them. COROT_ENOMEM. */
COROT_API corot_status corot_inputs_create(const corot_model *model, corot_inputs **inputs);

/* Takes NULL. No state may use them any more, unless it is only destroyed. */
COROT_API void corot_inputs_destroy(corot_inputs *inputs);

/* Bytes held by the inputs. */
COROT_API size_t corot_inputs_bytes(const corot_inputs *inputs);

/* From now on the state sees these inputs, which must outlive its last evaluation; NULL: none. Best
   before an integrator is made of the state; else tell it (corot_integrator_changed). One inputs a
   state: of several states that share one, the first that is told has the energy of materials.
   COROT_EINVAL: they are of another model; or an integrator has been made of the state, and the old
   ones or the new have factors of materials, whose energy it would miss. */
COROT_API corot_status corot_state_use_inputs(corot_state *state, corot_inputs *inputs);

/* --- Forces ----------------------------------------------------------------------------------- */

/* A force on each node [nnode][3] [N], in fixed directions, beside the loads of the model, until it
   is set again; NULL: none. On held components it is taken up by the supports. With
   COROT_COUPLING_ONE_WAY it is that of the node's own equation. In statics it is scaled as loads are.
   COROT_EINVAL: nnode is not that of the mesh, or a number is not finite. */
COROT_API corot_status corot_inputs_set_force(corot_inputs *inputs, int nnode, const double (*force)[3]);

/* The same along a straight line in time: `from` at t0, `to` at t1, and on beyond them, so that r is
   smooth for a step that goes further. For a window of a coupled loop: where it begins with what the
   last one ended with, nothing jumps, and no integrator begins again. COROT_EINVAL as above, or t0 is
   not before t1. */
COROT_API corot_status corot_inputs_ramp_force(corot_inputs *inputs, int nnode, double t0,
                                     const double (*from)[3], double t1, const double (*to)[3]);

/* A factor of load k of the model's definition, beside its amplitude, until it is set again; 1 at
   first. COROT_EINVAL: there is no such load, or the factor is not finite. */
COROT_API corot_status corot_inputs_set_load(corot_inputs *inputs, int k, double factor);

/* The same along a straight line in time, as of a force. Failures as above, and of the window. */
COROT_API corot_status corot_inputs_ramp_load(corot_inputs *inputs, int k, double t0, double from, double t1,
                                    double to);

/* --- Materials -------------------------------------------------------------------------------- */

/* Factors of a material's coefficients. */
typedef struct corot_material_factors {
  double lambda, mu;                 /* 3 lambda + 2 mu > 0 and mu > 0 of what they make */
  double damping_lambda, damping_mu; /* >= 0; what is zero in the model stays so */
} corot_material_factors;

/* From now on material k of the model's definition has so many times its coefficients; NULL: its own.
   Density and damping_mass stay. A strained body whose stiffness changes gains or loses energy: the
   integrator that is told (the first, if there are several) counts that as external work. What is chosen by the scales of the model
   (tolerances, orders) goes by its own coefficients.
   COROT_EINVAL: there is no such material, a factor is out of range, or lambda, of which a model with
   averaged dilatation leaves so many mu to the tets, would begin to be averaged. COROT_ENOMEM, the
   first time. */
COROT_API corot_status corot_inputs_set_material(corot_inputs *inputs, int k,
                                       const corot_material_factors *factors);

/* --- Paths of supports ------------------------------------------------------------------------ */

/* Where the nodes of a group are at time t, how fast, and how this changes. One row is that of all its
   nodes; else there is a row for each, in the order of the group (corot_mesh_find_group). Of the
   components those count that the model holds, by a fix or a motion, whose place the path takes. */
typedef struct corot_path {
  const char *group;
  double t;              /* [s] */
  int n;                 /* rows: 1, or as many as the group has nodes */
  const double (*x)[3];  /* [n] displacement [m] */
  const double (*v)[3];  /* [n] velocity [m/s]; or NULL, see below */
  const double (*a)[3];  /* [n] acceleration [m/s^2]; or NULL */
} corot_path;

/* From t on, and before it, the group is at x + v s + a s^2 / 2 at time t + s, until it is told
   otherwise; v and a of NULL are zero. A path may not jump: where the group would have been at t
   without it, it still is, to a millionth of the length of the model. Its velocity may; a consistent
   mass, which takes the acceleration, then leaves the blow out (corot_mass of corot/model.h).
   COROT_EINVAL: it jumps, there is no such group, the model holds nothing of it, n is not the number
   of its nodes, or a number is not finite. COROT_ENOMEM, the first time. */
COROT_API corot_status corot_inputs_set_path(corot_inputs *inputs, const corot_path *path);

/* The same wherever the group has been: for the start of a run. Failures as above, but for jumps. */
COROT_API corot_status corot_inputs_start_path(corot_inputs *inputs, const corot_path *path);

/* On from where the group is at t0, so as to reach the path's x at its t: with v NULL in a straight
   line, which is right where the mass is lumped: each window then begins with a jump of the velocity,
   and the blow of that a consistent mass leaves out, so that smaller windows lead to another motion
   (ten per cent off, measured on four-node tets with a consistent mass, half a per cent on ten-node
   ones): give velocities there; with a NULL by the cubic that begins with the velocity at t0 and ends with v; else by the
   polynomial of degree five that has the accelerations, too. For a window of a coupled loop. Failures
   as above, or t0 is not before t. */
COROT_API corot_status corot_inputs_reach(corot_inputs *inputs, double t0, const corot_path *path);

/* Back to what the model says of the group. COROT_EINVAL: there it would jump at t, or there is no
   such group, or the model holds nothing of it. */
COROT_API corot_status corot_inputs_release(corot_inputs *inputs, const char *group, double t);

/* corot_nodal as the state sees it, supports on paths included. */
COROT_API void corot_state_nodal(const corot_model *model, const corot_state *state, double t,
                       const double *u, const double *v, double (*displacement)[3],
                       double (*velocity)[3]);

/* --- Feedback --------------------------------------------------------------------------------- */

/* Where a feedback puts its blocks. */
typedef struct corot_blocks corot_blocks;

/* Adds K = -df_i/du_j [N/m] and D = -df_i/dv_j [N s/m], row-major [9], of the force f_i on node i by
   the motion of node j; NULL: zero. A force between two nodes has four such pairs, (i, i), (i, j),
   (j, i) and (j, j). The matrices of an implicit step are symmetric and take the symmetric part, the
   directional derivative (corot_jvp) takes all of it; so a feedback that is not symmetric takes more
   iterations, and its results are the same.
   COROT_EINVAL: there is no such node, or the two share no block of the pattern (corot_model_nblock),
   as those that share a tet do. COROT_RETRY: a number is not finite. Either is remembered: the
   evaluation fails, whatever your function returns. */
COROT_API corot_status corot_blocks_add(corot_blocks *blocks, int i, int j, const double *K, const double *D);

/* u [m] and v [m/s] of all nodes at t, held ones too, [nnode][3] each. f [nnode][3]: add the force to
   it, which is zero on entry [N]. */
typedef corot_status corot_feedback_force(void *data, double t, const double (*u)[3],
                                          const double (*v)[3], double (*f)[3]);

/* Adds its blocks, by corot_blocks_add. */
typedef corot_status corot_feedback_blocks(void *data, double t, const double (*u)[3],
                                           const double (*v)[3], corot_blocks *blocks);

/* Adds to df the change of the force in the direction (du, dv), all [nnode][3]. */
typedef corot_status corot_feedback_change(void *data, double t, const double (*u)[3],
                                           const double (*v)[3], const double (*du)[3],
                                           const double (*dv)[3], double (*df)[3]);

/* A force that depends on the motion: contact, foundation, muscle, controller. It must be a function
   of (t, u, v) alone: evaluations come in any order, and steps are tried and given up. What it
   remembers, change between steps; then set it once more, or the matrices stay, and call
   corot_integrator_changed. A stiff one needs its blocks:
   without them Newton's iteration does not converge but for tiny steps. Its work counts as external;
   a potential of its own is not in corot_energies.elastic. On held components its force is taken up
   by the supports.

   Each function returns COROT_OK; COROT_RETRY where it cannot be evaluated and a shorter step may
   help; or another status, with which the step ends. Set the message by corot_fail. */
typedef struct corot_feedback {
  const char *name; /* for messages; copied, 47 letters of it */
  void *data;       /* handed to the functions */
  corot_feedback_force *force;
  corot_feedback_blocks *blocks; /* NULL: none, as if the force did not depend on the motion */
  corot_feedback_change *change; /* NULL: what the blocks say, not only their symmetric part */
} corot_feedback;

/* From now on that feedback; NULL: none. COROT_EINVAL: it has no force. COROT_ENOMEM. */
COROT_API corot_status corot_inputs_set_feedback(corot_inputs *inputs, const corot_feedback *feedback);

#ifdef __cplusplus
}
#endif
#endif
