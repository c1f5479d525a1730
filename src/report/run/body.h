/* The moving body of a run, for the page's viewer: its surface, displacements and fields frame by
   frame, in 65536 steps of their range each. */
#ifndef COROT_REPORT_RUN_BODY_H
#define COROT_REPORT_RUN_BODY_H

#include <stdio.h>

#include "report/read/fields_file.h"
#include "report/read/run_folder.h"

/* Frames are left out evenly, the last excepted, until all of them have fewer bytes than this
   (before base64 makes four of three). */
enum { BODY_BYTES = 6500000 };

/* A surface of more triangles is thinned. */
enum { BODY_TRIANGLES = 30000 };

/* Writes the section with its data: of the fields, and of the run that they belong to what is done
   to the body. */
corot_status body_write(const fields *f, const run_folder *run, FILE *out);

#endif
