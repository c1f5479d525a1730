/* Names for runs that a person can read: of cells what they set, of references their number and
   method. */
#ifndef COROT_STUDY_EXECUTE_RUN_NAMES_H
#define COROT_STUDY_EXECUTE_RUN_NAMES_H

#include "study/plan/manifest.h"

enum { RUN_NAME = 200 }; /* bytes, with the end */

/* Of a cell: "method=cvode,rtol=0.001"; of a reference's run (which: 0 or 1):
   "reference-0-cvode". Made of letters, digits and "._+=,-" alone. */
void cell_name(const manifest *m, int index, char name[RUN_NAME]);
void reference_name(const manifest *m, int reference, int which, char name[RUN_NAME]);

/* Of a run: that of the first cell that has it, or of a reference's. */
void run_name(const manifest *m, int run, char name[RUN_NAME]);

/* Makes DIR/names/NAME, a link to the folder of the run, for each cell and reference. What stands
   there and is no link stays; where there are no links, there are none. */
void names_link(const manifest *m, const char *dir);

#endif
