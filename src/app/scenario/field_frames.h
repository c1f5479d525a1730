/* Which output times of a run have a frame of fields. */
#ifndef COROT_APP_SCENARIO_FIELD_FRAMES_H
#define COROT_APP_SCENARIO_FIELD_FRAMES_H

#include <stddef.h>

#include "scenario.h"

/* All frames of a run together, where output.every does not say how many there are [byte]. */
#define FIELDS_MOST 100e6

typedef struct field_frames {
  int every;     /* so many output times, and the last */
  long ntime, n; /* output times; frames */
  double bytes;  /* of a frame */
  bool thinned;  /* every > 1, and nobody has asked for it */
} field_frames;

/* Of a run, which is the same in every process. A scenario without fields has no frames. */
field_frames field_frames_of(const scenario *s, const corot_mesh *mesh);

/* "of every 5th output time and the last, 21 frames of 2.4 MB; output.every: 1 writes all 101":
   where they are thinned; else "". */
void field_frames_words(const field_frames *f, size_t size, char *text);

#endif
