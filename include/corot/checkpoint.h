/* The state of an integration as bytes: to go on in another process as if nothing had happened, or to
   go back and take the same stretch of time once more.

   A complete program: tests/examples/checkpoint.c. */
#ifndef COROT_CHECKPOINT_H
#define COROT_CHECKPOINT_H

#include <corot/integrate.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Takes the state away: the time reached, u and v, the frames and the inputs of the corot_state, the
   frame clock that was made last for this integrator, work and statistics, and what the method knows
   beside u and v. *blob has *bytes bytes, to be freed with corot_blob_free().

   Saving is a new beginning: the integrator goes on from just what the blob says. So whoever restores
   it, in whatever process and however often, gets the same numbers from there on, bit for bit, as the
   integration that was saved and went on; with the same build of the library on the same kind of
   processor. What a beginning costs:
     cvode, ida           the history of the solution, of which SUNDIALS gives nothing away: they begin
                          again at order 1, which takes some ten short steps, each with an error of its
                          own up to the tolerance. Save them seldom
     arkode, erk          K, D and S are made anew; the step is as long as it would have been
     of constant step     the same; bdf2 and bdf3 keep their history
   Only the end of the last step can be asked for afterwards (corot_integrator_at), until the next one.

   Not in the blob, as it is the host's: its functions (a frame hook, a feedback) and their data.

   COROT_EINVAL: the frames or the inputs have changed since the integrator last heard of it
   (corot_integrator_changed). COROT_ENOMEM; COROT_EINTEGRATE, COROT_RETRY as of
   corot_integrator_create. After a failure the integrator is as it was. */
COROT_API corot_status corot_integrator_save(corot_integrator *integrator, void **blob,
                                             size_t *bytes);

/* Puts that state in the place of the integrator's own, forwards or backwards in time. The integrator
   is of the same definition, on a model of the same definition, with inputs if the saved one had some,
   and a frame clock of the same policy if it had one; or it is the saved one itself. Its corot_state
   changes with it: frames, side of kinks, and what the inputs say; corot_integrator_time() is the time
   it is taken to. To take a stretch of time once more with other inputs, restore, set them, and call
   corot_integrator_changed.

   COROT_EINVAL: the blob is cut short or damaged, of another version of its format or another byte
   order, or of another model, definition, policy of frames or linear solver. COROT_ENOMEM;
   COROT_EINTEGRATE, COROT_RETRY as of corot_integrator_create. After a failure everything is as it
   was. */
COROT_API corot_status corot_integrator_restore(corot_integrator *integrator, const void *blob,
                                                size_t bytes);

/* Takes NULL. */
COROT_API void corot_blob_free(void *blob);

#ifdef __cplusplus
}
#endif
#endif
