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
   as those of corot_inputs_ramp_force are. What you want to know of the inside of a step, ask before
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
corot_status corot_inputs_create(const corot_model *model, corot_inputs **inputs);

/* Takes NULL. No state may use them any more, unless it is only destroyed. */
void corot_inputs_destroy(corot_inputs *inputs);

/* Bytes held by the inputs. */
size_t corot_inputs_bytes(const corot_inputs *inputs);

/* From now on the state sees these inputs, which must outlive its last evaluation; NULL: none. Best
   before an integrator is made of the state; else tell it (corot_integrator_changed).
   COROT_EINVAL: they are of another model. */
corot_status corot_state_use_inputs(corot_state *state, corot_inputs *inputs);

/* --- Forces ----------------------------------------------------------------------------------- */

/* A force on each node [nnode][3] [N], in fixed directions, beside the loads of the model, until it
   is set again; NULL: none. On held components it is taken up by the supports. With
   COROT_COUPLING_ONE_WAY it is that of the node's own equation. In statics it is scaled as loads are.
   COROT_EINVAL: nnode is not that of the mesh, or a number is not finite. */
corot_status corot_inputs_set_force(corot_inputs *inputs, int nnode, const double (*force)[3]);

/* The same along a straight line in time: `from` at t0, `to` at t1, and on beyond them, so that r is
   smooth for a step that goes further. For a window of a coupled loop: where it begins with what the
   last one ended with, nothing jumps, and no integrator begins again. COROT_EINVAL as above, or t0 is
   not before t1. */
corot_status corot_inputs_ramp_force(corot_inputs *inputs, int nnode, double t0,
                                     const double (*from)[3], double t1, const double (*to)[3]);

/* A factor of load k of the model's definition, beside its amplitude, until it is set again; 1 at
   first. COROT_EINVAL: there is no such load, or the factor is not finite. */
corot_status corot_inputs_set_load(corot_inputs *inputs, int k, double factor);

/* The same along a straight line in time, as above. */
corot_status corot_inputs_ramp_load(corot_inputs *inputs, int k, double t0, double from, double t1,
                                    double to);

#ifdef __cplusplus
}
#endif
#endif
