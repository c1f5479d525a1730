/* The moving body of a run, for the page's viewer: its surface, displacements and fields frame by
   frame, in 65536 steps of their range each. */
#ifndef COROT_REPORT_BODY_H
#define COROT_REPORT_BODY_H

#include <stdio.h>

#include "fields.h"

/* Frames are left out evenly, the last excepted, until all of them have fewer bytes than this
   (before base64 makes four of three). */
enum { BODY_BYTES = 6500000 };

/* Writes the section with its data. has_frames: the strain measure has frames to speak of. */
corot_status body_write(const fields *f, int has_frames, FILE *out);

#endif
