/* Supports and loads, as the page draws them on the body: what each is, and where its marks stand.
 */
#ifndef COROT_REPORT_RUN_CONDITIONS_H
#define COROT_REPORT_RUN_CONDITIONS_H

#include <stdio.h>

#include "report/read/fields_file.h"
#include "report/read/run_folder.h"
#include "report/read/surface.h"

/* Marks are at most so many to the longest side of a group: a few show as much as all. */
enum { CONDITIONS_NODES = 10, CONDITIONS_ARROWS = 6 };

/* Writes members of the body's data,

     "supports":[{"text", "moving", "held": [x, y, z], "nodes": [surface node, ...]}, ...],
     "loads":[{"text", "whole", "vector": [3] or "in" or "out" (along the normal),
               "at": [a, b, c, ...], "factor": [one a frame] or null}, ...],

   where "at" has three nodes of the surface for each arrow: a face's, or one node three times;
   "whole": the load acts on all of the body. "factor" is that of the load's amplitude (in statics,
   times the load factor), null where it is not a list of points. Without a groups.json: nothing.
   t [nframe]: of the frames [s]. COROT_ENOMEM. */
corot_status conditions_write(const run_folder *run, const fields *f, const surface *s, int nframe,
                              const double *t, FILE *out);

#endif
