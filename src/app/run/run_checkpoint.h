/* Checkpoints of a run (scenario key `checkpoint`), of which `corot run --resume` goes on.

   After every checkpoint.steps steps the integrator begins anew (corot_integrator_save), and all
   that the run is then is packed into memory: a run that goes on and one that was read back are the
   same from there on, to the last bit. That has nothing to do with the clock. Of these states the
   latest is written to DIR/checkpoint.bin when checkpoint.every has passed since the last one was,
   and when a request to stop ends the run. */
#ifndef COROT_APP_RUN_RUN_CHECKPOINT_H
#define COROT_APP_RUN_RUN_CHECKPOINT_H

#include "app/folder/checkpoint_file.h"
#include "outputs.h"
#include "run_options.h"

typedef struct checkpoint checkpoint;

/* For a run whose hash is `run`. *out is NULL where the scenario asks for none. The scenario and
   the options must outlive it. */
corot_status checkpoint_create(const scenario *s, const char run[HASH_SIZE],
                               const run_options *options, checkpoint **out);

/* Takes NULL; the file stays. */
void checkpoint_destroy(checkpoint *c);

/* Whether one is made after so many steps; takes NULL. */
bool checkpoint_is_due(const checkpoint *c, long nstep);

/* Begins the one of time t: the run adds its state to this pack. */
pack *checkpoint_begin(checkpoint *c, double t);

/* It is complete, and is written if it is time. That it cannot be written is said on stderr, and is
   no reason to end the run. COROT_ENOMEM, also of what was packed. */
corot_status checkpoint_keep(checkpoint *c, outputs *o);

/* Writes the latest, unless it is written; takes NULL. */
void checkpoint_write(checkpoint *c, outputs *o);

/* The run goes on from a file that was read, of time t. */
void checkpoint_goes_on(checkpoint *c, double t);

/* The time of the one in the file [s]; NaN: there is none. Takes NULL. */
double checkpoint_written(const checkpoint *c);

/* The run is over: the file goes. Takes NULL. */
void checkpoint_remove(checkpoint *c);

#endif
